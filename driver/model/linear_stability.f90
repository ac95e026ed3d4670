!> Is steady sliding stable? Eigenvalues of the rate equations of one block about it, and the values
!> of a key of the input at which that changes (docs/stability.md).
module linear_stability
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use friction_mod, only : prop_alpha_n, prop_alpha_t
    use lapack_interface, only : dgebal, dgeev
    use smooth_function, only : find_root, function_of_one, values
    use steady_sliding, only : contact_response, find_steady_sliding, sliding_case
    implicit none
    private

    public :: analyse, critical_value, find_critical, stability

    integer, parameter :: most_states = 7

    !> What becomes of small disturbances.
    integer, parameter, public :: undecided = 0   !! there is no steady sliding
    integer, parameter, public :: stable = 1      !! they die away
    integer, parameter, public :: neutral = 2     !! they neither grow nor die away
    integer, parameter, public :: unstable = 3    !! they grow
    character(len=8), parameter, public :: verdicts(0:3) = [character(len=8) :: 'none', 'stable', &
        'neutral', 'unstable']

    type :: stability
        type(contact_response) :: contact
        complex(dp), allocatable :: eigenvalues(:)   !! the one that grows fastest comes first [1/T]
        real(dp), allocatable :: uncertain(:)        !! how far round-off may have moved them [1/T]
        real(dp) :: growth = 0.0_dp       !! the largest real part [1/T]
        real(dp) :: frequency = 0.0_dp    !! of that disturbance; 0: it does not swing [1/T]
        integer :: verdict = undecided
        character(len=:), allocatable :: problem   !! why there is no steady sliding; or empty
    end type stability

    !> A disturbance of a state or, in its place, its rate. What follows from the rest is left out.
    type :: disturbance
        real(dp) :: extension = 0.0_dp   !! of the drive spring [L]
        real(dp) :: velocity = 0.0_dp    !! of the block; no state without mass [L/T]
        real(dp) :: traction = 0.0_dp    !! of the contact spring; a state where friction depends on
                                         !! the slip rate, or beside a damper [F/L^2]
        real(dp) :: memory(2) = 0.0_dp   !! of the law
        real(dp) :: away = 0.0_dp        !! of a block that moves across the interface [L]
        real(dp) :: rising = 0.0_dp      !! its velocity [L/T]
    end type disturbance

    !> A value of a key at which steady sliding becomes stable or unstable.
    type :: critical_value
        real(dp) :: value = 0.0_dp
        logical :: stable_above = .false.
    end type critical_value

    !> Growth over the logarithm of a key's value.
    type, extends(function_of_one) :: growth_over
        type(sliding_case), pointer :: this => null()   !! changed, and given back as it was
        character(len=:), allocatable :: key
        type(stability), pointer :: result => null()    !! at the last value asked for
        logical :: same_contact = .false.   !! whatever the value: it is known
        logical :: by_verdict = .false.     !! 1 where unstable, else -1, in place of the growth
    contains
        procedure :: at => growth_at
    end type growth_over

contains

    !> Steady sliding of a case, and its eigenvalues.
    subroutine analyse(this, result)
        type(sliding_case), intent(in) :: this   !! prepared
        type(stability), intent(out) :: result

        allocate (result%eigenvalues(0))
        call find_steady_sliding(this, result%contact, result%problem)
        if (len(result%problem) == 0) call judge(this, result)
    end subroutine analyse

    !> Stable or not, once it is known how the contact answers.
    subroutine judge(this, result)
        type(sliding_case), intent(in) :: this
        type(stability), intent(inout) :: result   !! with its contact
        real(dp) :: jacobian(most_states, most_states)
        integer :: n

        result%verdict = undecided
        call fill_jacobian(this, result%contact, jacobian, n, result%problem)
        if (len(result%problem) == 0) call find_eigenvalues(jacobian, n, result)
        if (len(result%problem) > 0) return
        result%growth = real(result%eigenvalues(1), dp)
        result%frequency = abs(aimag(result%eigenvalues(1))) / (8.0_dp * atan(1.0_dp))
        result%verdict = stable
        associate (growth => real(result%eigenvalues, dp))
            if (any(growth >= -result%uncertain)) result%verdict = neutral
            if (any(growth > result%uncertain)) result%verdict = unstable
            if (snaps_back(this, result%contact)) result%verdict = unstable
        end associate
    end subroutine judge

    !> Does friction fall faster with slip than the contact spring unloads, or with the slip rate
    !> than a damper beside it? Then it jumps, whatever the block does.
    pure logical function snaps_back(this, contact) result(snaps)
        type(sliding_case), intent(in) :: this
        type(contact_response), intent(in) :: contact

        snaps = .false.
        if (contact%damper > 0.0_dp) then
            snaps = contact%damper + contact%by_rate <= 0.0_dp
        else if (.not. (contact%follows_velocity .or. depends_on_rate(contact))) then
            snaps = this%props(prop_alpha_t) + dot_product(contact%by_memory, &
                contact%rate_by_rate) <= 0.0_dp
        end if
    end function snaps_back

    pure logical function depends_on_rate(contact) result(depends)
        type(contact_response), intent(in) :: contact

        depends = abs(contact%by_rate) > 0.0_dp
    end function depends_on_rate

    !> Do the forces of the two springs alone decide the motion, without mass and damper?
    pure logical function in_series(this) result(yes)
        type(sliding_case), intent(in) :: this

        yes = .not. (this%mass > 0.0_dp .or. this%damping > 0.0_dp)
    end function in_series

    !> The rates of disturbances of one state after the other.
    subroutine fill_jacobian(this, contact, jacobian, n, problem)
        type(sliding_case), intent(in) :: this
        type(contact_response), intent(in) :: contact
        real(dp), intent(out) :: jacobian(most_states, most_states)
        integer, intent(out) :: n                                !! states
        character(len=:), allocatable, intent(out) :: problem
        type(disturbance) :: rates
        logical :: failed
        integer :: i, j

        problem = ''
        jacobian = 0.0_dp
        n = size(packed(this, contact, rates))
        if (n == 0) problem = 'disturbances vanish at once: nothing has inertia, damping or memory'
        do i = 1, n
            call rates_of(this, contact, unpacked(this, contact, [(merge(1.0_dp, 0.0_dp, j == i), &
                j = 1, n)]), rates, failed)
            if (failed) then
                problem = 'nothing but the velocity of the drive moves the block: it needs a mass'
                return
            end if
            jacobian(:n, i) = packed(this, contact, rates)
        end do
    end subroutine fill_jacobian

    !> What is a state of its own, one number after the other.
    pure function packed(this, contact, d) result(x)
        type(sliding_case), intent(in) :: this
        type(contact_response), intent(in) :: contact
        type(disturbance), intent(in) :: d
        real(dp), allocatable :: x(:)

        x = pack([d%extension, d%velocity, d%traction, d%memory, d%away, d%rising], states(this, &
            contact))
    end function packed

    pure type(disturbance) function unpacked(this, contact, x) result(d)
        type(sliding_case), intent(in) :: this
        type(contact_response), intent(in) :: contact
        real(dp), intent(in) :: x(:)
        real(dp) :: all(most_states)

        all = unpack(x, states(this, contact), 0.0_dp)
        d = disturbance(all(1), all(2), all(3), all(4:5), all(6), all(7))
    end function unpacked

    !> Is the traction of the contact spring a state of its own?
    pure logical function states_traction(this, contact) result(yes)
        type(sliding_case), intent(in) :: this
        type(contact_response), intent(in) :: contact

        yes = contact%damper > 0.0_dp .or. (.not. contact%follows_velocity .and. &
            depends_on_rate(contact) .and. .not. in_series(this))
    end function states_traction

    pure function states(this, contact) result(are)
        type(sliding_case), intent(in) :: this
        type(contact_response), intent(in) :: contact
        logical :: are(most_states)
        logical :: sprung

        sprung = .not. contact%follows_velocity
        are = [.not. in_series(this) .or. .not. sprung .or. depends_on_rate(contact) .or. &
            contact%damper > 0.0_dp, &
            this%mass > 0.0_dp, states_traction(this, contact), &
            contact%remembered >= 1, contact%remembered >= 2, this%across%free(), &
            this%across%free()]
    end function states

    !> The rate equations in small disturbances d. Forces and velocities along the interface count
    !> in the sense of the slip.
    pure subroutine rates_of(this, contact, d, rates, failed)
        type(sliding_case), intent(in) :: this
        type(contact_response), intent(in) :: contact
        type(disturbance), intent(in) :: d
        type(disturbance), intent(out) :: rates
        logical, intent(out) :: failed   !! no velocity follows
        real(dp) :: pull, pressure(2), drift(2), motion(3), tilt

        tilt = sign(1.0_dp, this%velocity) * this%across%tilt
        pull = this%stiffness * d%extension - tilt * d%away
        pressure = -this%props(prop_alpha_n) * [d%away, d%rising]   ! and its rate
        drift = matmul(contact%rate_by_memory, d%memory) + contact%rate_by_pressure * pressure(1) &
            + contact%rate_by_loading * pressure(2)   ! of the memory, without slip
        call contact_motion(this, contact, d, pull, pressure, drift, motion, failed)
        if (failed) return
        associate (v => motion(1), slip => motion(2), traction => motion(3))
            rates%extension = -v
            if (states_traction(this, contact)) rates%traction = this%props(prop_alpha_t) &
                * (v - slip)
            if (this%mass > 0.0_dp) rates%velocity = (pull - this%damping * v - this%area &
                * traction) / this%mass
            rates%memory = drift + contact%rate_by_rate * slip
        end associate
        if (.not. this%across%free()) return
        rates%away = d%rising
        rates%rising = (tilt * d%extension - this%across%stiffness * d%away &
            - this%across%damping * d%rising + this%area * pressure(1)) / this%across%mass
    end subroutine rates_of

    !> Velocity of the block, slip rate and traction.
    pure subroutine contact_motion(this, contact, d, pull, pressure, drift, motion, failed)
        type(sliding_case), intent(in) :: this
        type(contact_response), intent(in) :: contact
        type(disturbance), intent(in) :: d
        real(dp), intent(in) :: pull          !! of the drive spring [F]
        real(dp), intent(in) :: pressure(2)   !! and its rate [F/L^2], [F/L^2/T]
        real(dp), intent(in) :: drift(2)      !! of the memory, without slip
        real(dp), intent(out) :: motion(3)
        logical, intent(out) :: failed        !! no velocity follows
        real(dp) :: at_rest, rising, v, slip, traction, softer, both, unloading

        failed = .false.
        at_rest = dot_product(contact%by_memory, d%memory) + contact%by_pressure * pressure(1)
        rising = dot_product(contact%by_memory, drift) + contact%by_pressure * pressure(2)
        v = d%velocity
        associate (alpha => this%props(prop_alpha_t), s => this%area, c => this%damping)
            softer = alpha / (alpha + this%stiffness / s)   ! both springs in series, of the contact
            if (contact%follows_velocity) then
                failed = .not. this%mass > 0.0_dp .and. .not. abs(c + s * contact%by_rate) > 0.0_dp
                if (failed) return
                if (.not. this%mass > 0.0_dp) v = (pull - s * at_rest) / (c + s * contact%by_rate)
                slip = v
                traction = contact%by_rate * slip + at_rest
            else if (contact%damper > 0.0_dp) then
                call damped_motion(this, contact, d%traction, pull, at_rest, v, slip, failed)
                traction = contact%by_rate * slip + at_rest
            else if (depends_on_rate(contact)) then
                traction = d%traction
                if (in_series(this)) traction = pull / s
                slip = (traction - at_rest) / contact%by_rate
                if (.not. this%mass > 0.0_dp .and. c > 0.0_dp) v = (pull - s * traction) / c
                if (in_series(this)) v = softer * slip
            else
                traction = at_rest
                if (.not. this%mass > 0.0_dp .and. c > 0.0_dp) v = (pull - s * traction) / c
                both = alpha
                if (in_series(this)) both = softer * this%stiffness / s
                unloading = both + dot_product(contact%by_memory, contact%rate_by_rate)
                failed = .not. abs(unloading) > 0.0_dp
                if (failed) return
                slip = -rising
                if (.not. in_series(this)) slip = slip + alpha * v
                slip = slip / unloading
                if (in_series(this)) v = softer * slip
            end if
        end associate
        motion = [v, slip, traction]
    end subroutine contact_motion

    !> Velocity and slip rate of a contact with a damper beside its spring.
    pure subroutine damped_motion(this, contact, sprung, pull, at_rest, v, slip, failed)
        type(sliding_case), intent(in) :: this
        type(contact_response), intent(in) :: contact
        real(dp), intent(in) :: sprung    !! traction of the spring [F/L^2]
        real(dp), intent(in) :: pull      !! of the drive spring [F]
        real(dp), intent(in) :: at_rest   !! traction without slip [F/L^2]
        real(dp), intent(inout) :: v      !! known for a block with a mass [L/T]
        real(dp), intent(out) :: slip     !! slip rate [L/T]
        logical, intent(out) :: failed    !! no velocity follows
        real(dp) :: both, part, drag

        slip = 0.0_dp
        both = contact%damper + contact%by_rate
        failed = .not. abs(both) > 0.0_dp
        if (failed) return
        part = contact%by_rate / both
        if (.not. this%mass > 0.0_dp) then
            drag = this%damping + this%area * part * contact%damper
            failed = .not. abs(drag) > 0.0_dp
            if (failed) return
            v = (pull - this%area * (part * (sprung - at_rest) + at_rest)) / drag
        end if
        slip = (sprung + contact%damper * v - at_rest) / both
    end subroutine damped_motion

    !> Eigenvalues, the largest real part first. Each is improved by its two eigenvectors: what is
    !> left of round-off is that of the matrix entry by entry, however far its numbers are apart.
    !> Whether two have met shows in units of the states that make its entries alike.
    subroutine find_eigenvalues(jacobian, n, result)
        real(dp), intent(in) :: jacobian(most_states, most_states)
        integer, intent(in) :: n
        type(stability), intent(inout) :: result
        real(dp), dimension(most_states, most_states) :: alike, matrix, left, right
        real(dp) :: re(most_states), im(most_states), work(16 * most_states)
        complex(dp) :: x(n), y(n), product
        integer :: info, i, first

        info = 1
        alike = jacobian
        if (all(abs(jacobian) <= sqrt(huge(work)))) call dgebal('S', n, alike, most_states, i, &
            first, work, info)
        matrix = alike
        if (info == 0) call dgeev('V', 'V', n, matrix, most_states, re, im, left, most_states, &
            right, most_states, work, size(work), info)
        if (info /= 0) then
            result%problem = 'the eigenvalues were not found'
            return
        end if
        result%eigenvalues = cmplx(re(:n), im(:n), dp)
        result%uncertain = abs(result%eigenvalues)
        do i = 1, n
            x = vector(right, i)
            y = conjg(vector(left, i))
            product = sum(y * x)
            if (.not. abs(product) > 1.0e4_dp * epsilon(re)) cycle   ! two have met
            result%eigenvalues(i) = sum(y * matmul(alike(:n, :n), x)) / product
            result%uncertain(i) = 16.0_dp * epsilon(re) * dot_product(abs(y), &
                matmul(abs(alike(:n, :n)), abs(x))) / abs(product)
        end do
        do i = 1, n
            first = i - 1 + maxloc(real(result%eigenvalues(i:), dp), 1)
            result%eigenvalues(i:first) = cshift(result%eigenvalues(i:first), -1)
            result%uncertain(i:first) = cshift(result%uncertain(i:first), -1)
        end do

    contains

        !> An eigenvector; those of a pair are kept as real and imaginary part.
        function vector(table, k)
            real(dp), intent(in) :: table(:, :)
            integer, intent(in) :: k
            complex(dp) :: vector(n)

            if (im(k) > 0.0_dp) then
                vector = cmplx(table(:n, k), table(:n, k + 1), dp)
            else if (im(k) < 0.0_dp) then
                vector = cmplx(table(:n, k - 1), -table(:n, k), dp)
            else
                vector = cmplx(table(:n, k), 0.0_dp, dp)
            end if
        end function vector

    end subroutine find_eigenvalues

    !> Values of a key between two others at which steady sliding becomes stable or unstable,
    !> looked for on a logarithmic grid: those that stand closer together than that are missed.
    subroutine find_critical(this, key, range, steps, found)
        type(sliding_case), target, intent(inout) :: this   !! is given back as it was
        character(len=*), intent(in) :: key                 !! that `this` knows
        real(dp), intent(in) :: range(2)                    !! lowest and highest value, > 0
        integer, intent(in) :: steps                        !! of the grid
        type(critical_value), allocatable, intent(out) :: found(:)   !! rising
        type(growth_over) :: growth
        type(stability), target :: result
        real(dp) :: x(2), y(values), sides(2), before
        integer :: i

        allocate (found(0))
        before = this%value_of(key)
        call prepare_growth(growth, this, key, result)
        x = 0.0_dp
        sides = 0.0_dp   ! the first place has none before it
        do i = 0, steps
            x = [x(2), log(range(1)) + i * (log(range(2) / range(1)) / steps)]
            y = growth%at(x(2))
            sides = [sides(2), y(1)]
            if (.not. sides(1) * sides(2) < 0.0_dp) cycle
            found = [found, critical_value(exp(change_between(growth, x)), sides(1) > 0.0_dp)]
        end do
        call this%set(key, before)
    end subroutine find_critical

    !> Growth that is taken by its verdict alone.
    subroutine prepare_growth(growth, this, key, result)
        type(growth_over), intent(out) :: growth
        type(sliding_case), target, intent(in) :: this
        character(len=*), intent(in) :: key
        type(stability), target, intent(inout) :: result

        growth%this => this
        growth%key = key
        growth%result => result
        growth%by_verdict = .true.
        growth%same_contact = .not. this%across%free() .and. any(key == [character(len=16) :: &
            'slider%mass', 'slider%stiffness', 'slider%damping', 'slider%area'])
        call analyse(this, result)
        if (len(result%problem) > 0) growth%same_contact = .false.
    end subroutine prepare_growth

    !> Where the growth changes its sign or, if on one side nothing grows or dies away, where the
    !> verdict changes.
    real(dp) function change_between(growth, x) result(place)
        type(growth_over), intent(in) :: growth
        real(dp), intent(in) :: x(2)
        type(growth_over) :: smooth
        real(dp) :: low(values), high(values)

        smooth = growth
        smooth%by_verdict = .false.
        low = smooth%at(x(1))
        high = smooth%at(x(2))
        if (low(1) * high(1) < 0.0_dp .and. low(2) * high(2) < 0.0_dp) then
            place = find_root(smooth, x(1), x(2))
        else
            place = find_root(growth, x(1), x(2))
        end if
    end function change_between

    !> The growth; and -1 where stable, 1 where unstable. 0 where nothing slides steadily.
    function growth_at(self, x) result(y)
        class(growth_over), intent(in) :: self
        real(dp), intent(in) :: x   !! logarithm of the key's value
        real(dp) :: y(values)

        y = 0.0_dp
        call self%this%set(self%key, exp(x))
        if (self%same_contact) then
            call judge(self%this, self%result)
        else
            call analyse(self%this, self%result)
        end if
        if (self%result%verdict == undecided) return
        y(1) = merge(1.0_dp, -1.0_dp, self%result%verdict == unstable)
        if (self%result%verdict /= neutral) y(2) = y(1)
        if (.not. self%by_verdict) y(1) = self%result%growth
    end function growth_at

end module linear_stability
