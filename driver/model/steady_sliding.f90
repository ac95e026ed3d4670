!> One block that slides steadily, and what its contact answers to small disturbances: derivatives
!> of the law's resistance and of the rates of what it remembers (docs/stability.md).
module steady_sliding
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use friction_mod, only : facts => law_facts, friction_facts, friction_law_of, friction_ok, &
        friction_place, law_state, load_rates, onset_drops, prop_alpha_n, read_surface, &
        sliding_surface
    use run_settings, only : settings
    use slider_system, only : normal_motion
    use smooth_function, only : derivative, find_root, function_of_one, values
    implicit none
    private

    public :: contact_response, find_steady_sliding, sliding_case, take_piece

    !> What steady sliding and its stability depend on.
    type :: sliding_case
        real(dp) :: mass = 0.0_dp, stiffness = 0.0_dp, damping = 0.0_dp   !! as of `slider`
        real(dp) :: area = 1.0_dp                    !! [L^2]
        real(dp) :: velocity = 0.0_dp                !! of the drive [L/T]
        real(dp) :: normal = 0.0_dp                  !! normal traction that is applied [F/L^2]
        real(dp) :: normal_at_start = 0.0_dp         !! of the programme [F/L^2]
        type(normal_motion) :: across                !! the interface
        logical :: rigid = .false.                   !! the contact has no spring
        real(dp), allocatable :: props(:)            !! constants of the friction routine
        type(sliding_surface), private :: surface    !! made of these
        integer, private :: status = friction_ok     !! negative if they do not fit together
        real(dp), private :: damper = 0.0_dp         !! beside the contact spring [F T/L^3]
        real(dp), private :: bounds(2) = 0.0_dp      !! of a coefficient that the law remembers [-]
        character(len=:), allocatable :: problem     !! why there can be no steady sliding; or empty
    contains
        procedure :: knows, set, value_of
        procedure, private :: take_constants
    end type sliding_case

    !> A contact about steady sliding. In small disturbances of traction tau, slip rate s', pressure
    !> p and memory y,
    !>
    !>     tau = by_rate s' + by_memory . y + by_pressure p
    !>     y'  = rate_by_rate s' + rate_by_memory y + rate_by_pressure p + rate_by_loading p'
    type :: contact_response
        real(dp) :: traction = 0.0_dp          !! of steady sliding [F/L^2]
        real(dp) :: pressure = 0.0_dp          !! [F/L^2]
        type(law_state) :: state               !! what the law remembers then
        logical :: capped = .false.            !! the shear cap holds the traction
        logical :: follows_velocity = .false.  !! s' is the block's velocity: without a contact
                                               !! spring, or under friction that drops at once
        real(dp) :: damper = 0.0_dp            !! beside the contact spring; then s' follows from
                                               !! the balance of both with the law [F T/L^3]
        integer :: remembered = 0              !! size of y
        real(dp) :: by_rate = 0.0_dp, by_memory(2) = 0.0_dp, by_pressure = 0.0_dp
        real(dp), dimension(2) :: rate_by_rate = 0.0_dp, rate_by_pressure = 0.0_dp, &
            rate_by_loading = 0.0_dp
        real(dp) :: rate_by_memory(2, 2) = 0.0_dp
    end type contact_response

    !> What a law's traction and rates can be taken to depend on.
    integer, parameter :: on_mu = 1, on_ratio = 2, on_memory = 3, on_ln_memory = 4, &
        on_ln_rate = 5, on_pressure = 6, on_loading = 7

    !> Resistance of a law and rates of its memory, over one of these.
    type, extends(function_of_one) :: law_about
        type(sliding_surface), pointer :: surface => null()
        type(law_state) :: state
        real(dp) :: rate = 0.0_dp       !! slip rate, > 0 [L/T]
        real(dp) :: pressure = 0.0_dp   !! > 0 [F/L^2]
        integer :: variable = 0
    contains
        procedure :: at => resistance_and_rates
    end type law_about

    !> The balance of forces across the interface, over the pressure.
    type, extends(function_of_one) :: balance_across
        type(sliding_case), pointer :: this => null()
        type(law_about) :: law
    contains
        procedure :: at => force_across
    end type balance_across

    !> The rate of what the law remembers, as a function of that.
    type, extends(law_about) :: memory_rate
    contains
        procedure :: at => first_rate
    end type memory_rate

contains

    !> The case of a run in one piece of its programme.
    subroutine take_piece(this, run, piece)
        type(sliding_case), intent(out) :: this
        type(settings), intent(in) :: run
        integer, intent(in) :: piece

        this%mass = run%mass
        this%stiffness = run%stiffness
        this%damping = run%damping
        this%area = run%area
        this%velocity = run%drive%velocity(piece)
        this%normal = run%drive%normal(piece)
        this%normal_at_start = run%drive%normal(1)
        this%across = run%across
        this%rigid = run%rigid_contact
        this%props = run%props
        call this%take_constants()
        this%problem = ''
        if (run%drive%measured_until < huge(1.0_dp)) then
            this%problem = 'the drive follows a file'
        else if (run%chain%n_blocks > 1) then
            this%problem = 'a chain of blocks: stability is that of one'
        else if (abs(run%drive%acceleration(piece)) > 0.0_dp) then
            this%problem = 'the velocity of the drive changes all the time'
        else if (abs(run%drive%normal_rate(piece)) > 0.0_dp .or. run%drive%amplitude > 0.0_dp) then
            this%problem = 'the normal traction changes all the time'
        end if
    end subroutine take_piece

    !> Does steady sliding depend on a key of the input, and does this program know how?
    logical function knows(self, key) result(known)
        class(sliding_case), target, intent(in) :: self
        character(len=*), intent(in) :: key   !! group%key
        real(dp), pointer :: number

        call find_number(self, key, number)
        known = associated(number)
    end function knows

    !> The value of a key that is known.
    real(dp) function value_of(self, key) result(value)
        class(sliding_case), target, intent(in) :: self
        character(len=*), intent(in) :: key   !! group%key
        real(dp), pointer :: number

        call find_number(self, key, number)
        value = number
    end function value_of

    !> Gives a key that is known another value; a velocity keeps its sense.
    subroutine set(self, key, value)
        class(sliding_case), target, intent(inout) :: self
        character(len=*), intent(in) :: key   !! group%key
        real(dp), intent(in) :: value
        real(dp), pointer :: number

        call find_number(self, key, number)
        number = merge(sign(value, number), value, key == 'drive%velocity')
        if (key == 'slider%normal_traction' .or. key == 'drive%normal') self%normal_at_start = value
        if (place_of(self, key) > 0) call self%take_constants()
    end subroutine set

    !> Where the value of a key is kept, on which steady sliding depends; null for another key.
    subroutine find_number(this, key, number)
        type(sliding_case), target, intent(in) :: this
        character(len=*), intent(in) :: key   !! group%key
        real(dp), pointer, intent(out) :: number

        nullify (number)
        select case (key)
        case ('slider%mass')
            number => this%mass
        case ('slider%stiffness')
            number => this%stiffness
        case ('slider%damping')
            number => this%damping
        case ('slider%area')
            number => this%area
        case ('slider%normal_traction', 'drive%normal')
            number => this%normal
        case ('drive%velocity')
            number => this%velocity
        case ('slider%normal_mass')
            number => this%across%mass
        case ('slider%normal_stiffness')
            number => this%across%stiffness
        case ('slider%normal_damping')
            number => this%across%damping
        case ('slider%tilt_stiffness')
            number => this%across%tilt
        case default
            if (place_of(this, key) > 0) number => this%props(place_of(this, key))
        end select
    end subroutine find_number

    !> After a change of the law's constants.
    subroutine take_constants(self)
        class(sliding_case), intent(inout) :: self
        type(facts) :: known

        call read_surface(self%props, self%surface, self%status)
        known = friction_facts(self%props)
        self%bounds = [known%kinetic_coefficient, known%largest_coefficient]
        self%damper = known%damping
    end subroutine take_constants

    !> Where a constant of the law stands; 0 for another key.
    pure integer function place_of(self, key) result(place)
        type(sliding_case), intent(in) :: self
        character(len=*), intent(in) :: key   !! group%key

        place = 0
        if (index(key, 'friction%') == 1) place = friction_place(friction_law_of(self%props), &
            key(len('friction%') + 1:))
    end function place_of

    !> Steady sliding and the answer of the contact. `problem` says why there is none; else it is
    !> empty.
    subroutine find_steady_sliding(this, contact, problem)
        type(sliding_case), target, intent(in) :: this
        type(contact_response), intent(out) :: contact
        character(len=:), allocatable, intent(out) :: problem
        type(law_about) :: law
        real(dp), parameter :: nothing = 1.0e-100_dp   !! that friction changes with the slip rate
        real(dp) :: by_rate

        problem = this%problem
        if (this%status < 0) problem = 'the constants of the friction law do not fit together'
        if (.not. this%normal > 0.0_dp) problem = 'the contact is open: it has no normal traction'
        if (.not. abs(this%velocity) > 0.0_dp) problem = 'the drive stands still'
        if (len(problem) > 0) return
        law%surface => this%surface
        law%rate = abs(this%velocity)
        law%pressure = this%normal
        associate (traits => this%surface%traits)
            if (.not. this%rigid) contact%damper = this%damper
            contact%follows_velocity = this%rigid .or. (traits%onset == onset_drops &
                .and. .not. contact%damper > 0.0_dp)
            contact%remembered = merge(2, traits%memory / 2, traits%memory == 1)
            call settle_memory(this%bounds, law, contact%remembered, problem)
            if (len(problem) > 0) return
            if (this%across%free()) call find_pressure(this, law, problem)
            if (len(problem) > 0) return
            contact%pressure = law%pressure
            contact%state = law%state
            call this%surface%resistance_at(law%state, law%rate, law%pressure, &
                contact%traction, by_rate)
            contact%capped = contact%traction >= this%surface%tau_max
            call differentiate(this%bounds, law, contact)
        end associate
        if (abs(by_rate) * law%rate > nothing * law%pressure) contact%by_rate = by_rate
        if (.not. contact%capped) return
        contact%traction = this%surface%tau_max
        contact%by_rate = 0.0_dp
        contact%by_memory = 0.0_dp
        contact%by_pressure = 0.0_dp
    end subroutine find_steady_sliding

    !> The pressure with which a block that is free to move across the interface slides steadily.
    !> What the law remembers then does not depend on it.
    subroutine find_pressure(this, law, problem)
        type(sliding_case), target, intent(in) :: this
        type(law_about), intent(inout) :: law
        character(len=:), allocatable, intent(out) :: problem
        real(dp), parameter :: highest = 1.0e6_dp   !! pressure, part of the normal traction
        type(balance_across) :: balance
        real(dp) :: upper, y(values)

        problem = ''
        balance%this => this
        balance%law = law
        y = balance%at(0.0_dp)
        if (y(1) >= 0.0_dp) then
            problem = 'the drive spring would lift the block off the base'
            return
        end if
        upper = this%normal
        do while (upper < highest * this%normal)
            y = balance%at(upper)
            if (y(1) > 0.0_dp) exit
            upper = 2.0_dp * upper
        end do
        if (y(1) > 0.0_dp) then
            law%pressure = find_root(balance, 0.0_dp, upper)
        else
            problem = 'friction would press the block on the base ever harder: it locks'
        end if
    end subroutine find_pressure

    !> Force on the block away from the base, in steady sliding under a pressure.
    function force_across(self, x) result(y)
        class(balance_across), intent(in) :: self
        real(dp), intent(in) :: x   !! [F/L^2]
        real(dp) :: y(values)
        real(dp) :: traction, by_rate, away, stretch

        call self%law%surface%resistance_at(self%law%state, self%law%rate, x, traction, by_rate)
        traction = min(traction, self%law%surface%tau_max)
        associate (this => self%this, across => self%this%across)
            away = (this%normal_at_start - x) / this%props(prop_alpha_n)
            stretch = (sign(1.0_dp, this%velocity) * (this%area * traction + this%damping &
                * self%law%rate) + across%tilt * away) / this%stiffness
            y = 0.0_dp
            y(1) = across%tilt * stretch - across%stiffness * away + this%area * (x - this%normal)
        end associate
    end function force_across

    !> What the law remembers when it has slid for ever. What does not count any more by then is
    !> not among what is remembered.
    subroutine settle_memory(coefficients, law, remembered, problem)
        real(dp), intent(in) :: coefficients(2)   !! least and largest that a law remembers [-]
        type(law_about), intent(inout) :: law
        integer, intent(inout) :: remembered
        character(len=:), allocatable, intent(out) :: problem
        type(memory_rate) :: rate
        real(dp) :: bounds(2), y(values)

        problem = ''
        law%state = law_state(mu=0.0_dp, r=0.0_dp)
        associate (traits => law%surface%traits)
            select case (traits%memory)
            case (1)
                law%state = law_state(mu=0.0_dp, r=1.0_dp)
                law%variable = on_mu
                bounds = coefficients
            case (2)
                if (traits%logarithmic) then
                    law%variable = on_ln_memory
                    bounds = log(traits%slip_scale / law%rate) + [-1.0_dp, 1.0_dp]
                else
                    law%variable = on_memory
                    bounds = [0.0_dp, traits%kink]
                end if
            case default
                return
            end select
            rate%law_about = law
            y = rate%at(bounds(2))
            if (law%variable == on_memory .and. y(1) >= 0.0_dp) then
                ! it has grown to where it no longer counts
                if (bounds(2) >= huge(y)) problem = 'friction never becomes constant: there is ' &
                    // 'no steady sliding'
                law%state%r = bounds(2)
                remembered = 0
                return
            end if
            if (law%variable == on_ln_memory) call widen(rate, bounds)
            call put(law%state, law%variable, root_between(rate, bounds))
        end associate
    end subroutine settle_memory

    !> Moves the bounds apart until a rate that falls changes its sign between them.
    subroutine widen(rate, bounds)
        type(memory_rate), intent(in) :: rate
        real(dp), intent(inout) :: bounds(2)
        real(dp), parameter :: farthest = 600.0_dp   !! logarithm of what arithmetic can hold
        real(dp) :: y(values)
        integer :: i

        do i = 1, size(bounds)
            do while (abs(bounds(i)) < farthest)
                y = rate%at(bounds(i))
                if (y(1) * (1.5_dp - i) >= 0.0_dp) exit
                bounds(i) = bounds(i) + (2 * i - 3) * 2.0_dp
            end do
        end do
    end subroutine widen

    !> Where the rate is 0, or that end at which it comes closest.
    real(dp) function root_between(rate, bounds) result(x)
        type(memory_rate), intent(in) :: rate
        real(dp), intent(in) :: bounds(2)
        real(dp) :: lower(values), upper(values)

        lower = rate%at(bounds(1))
        upper = rate%at(bounds(2))
        if (lower(1) * upper(1) < 0.0_dp) then
            x = find_root(rate, bounds(1), bounds(2))
        else
            x = bounds(merge(1, 2, abs(lower(1)) < abs(upper(1))))
        end if
    end function root_between

    !> All derivatives but that by the slip rate.
    subroutine differentiate(coefficients, law, contact)
        real(dp), intent(in) :: coefficients(2)   !! least and largest that a law remembers [-]
        type(law_about), intent(inout) :: law
        type(contact_response), intent(inout) :: contact
        real(dp), parameter :: long = 0.5_dp   !! first step, as part of the variable
        real(dp) :: slope(values), step
        integer :: i

        law%variable = on_ln_rate
        slope = derivative(law, log(law%rate), long, .false.) / law%rate
        contact%rate_by_rate = slope(2:)
        law%variable = on_pressure
        slope = derivative(law, law%pressure, long * law%pressure, .false.)
        contact%by_pressure = slope(1)
        contact%rate_by_pressure = slope(2:)
        law%variable = on_loading
        if (contact%remembered > 0) slope = derivative(law, 0.0_dp, law%pressure * law%rate &
            / law%surface%traits%slip_scale, .false.)
        contact%rate_by_loading = slope(2:)
        do i = 1, contact%remembered
            associate (traits => law%surface%traits, lower => coefficients(1), &
                upper => coefficients(2))
                if (traits%memory == 1 .and. i == 1) then
                    law%variable = on_mu
                    step = long * roomy(law%state%mu, lower, upper)
                    if (.not. abs(step) > 0.0_dp) step = long   ! friction does not depend on it
                    slope = derivative(law, law%state%mu, step, .true.)
                else if (traits%memory == 1) then
                    law%variable = on_ratio
                    slope = derivative(law, 1.0_dp, long, .false.)
                else if (traits%logarithmic) then
                    law%variable = on_ln_memory
                    slope = derivative(law, log(law%state%r), long, .false.)
                else
                    law%variable = on_memory
                    slope = derivative(law, law%state%r, long * roomy(law%state%r, 0.0_dp, &
                        traits%kink), .true.)
                end if
            end associate
            contact%by_memory(i) = slope(1)
            contact%rate_by_memory(:, i) = slope(2:)
        end do
    end subroutine differentiate

    !> The way to the farther of two bounds, on whose other sides a law is another one.
    pure real(dp) function roomy(x, lower, upper) result(way)
        real(dp), intent(in) :: x, lower, upper

        way = upper - x
        if (x - lower > way) way = lower - x
    end function roomy

    !> Traction, and rates of the first and second of what is remembered.
    function resistance_and_rates(self, x) result(y)
        class(law_about), intent(in) :: self
        real(dp), intent(in) :: x
        real(dp) :: y(values)
        type(law_state) :: state, rates
        type(load_rates) :: load
        real(dp) :: rate, by_rate

        state = self%state
        rate = self%rate
        load = load_rates(0.0_dp, 0.0_dp, 1.0_dp, self%pressure, 0.0_dp, .true.)
        select case (self%variable)
        case (on_ln_rate)
            rate = exp(x)
        case (on_pressure)
            load%pressure = x
        case (on_loading)
            load%pressure_rate = x
        case default
            call put(state, self%variable, x)
        end select
        call self%surface%resistance_at(state, rate, load%pressure, load%traction, by_rate)
        rates = self%surface%state_rates(state, load, rate)
        y(1) = load%traction
        y(2:) = [rates%r, 0.0_dp]
        if (self%surface%traits%memory == 1) y(2:) = [rates%mu, rates%r]
        if (self%surface%traits%logarithmic) y(2) = rates%r / state%r
    end function resistance_and_rates

    function first_rate(self, x) result(y)
        class(memory_rate), intent(in) :: self
        real(dp), intent(in) :: x
        real(dp) :: y(values)

        y = resistance_and_rates(self, x)
        y = cshift(y, 1)
    end function first_rate

    pure subroutine put(state, variable, x)
        type(law_state), intent(inout) :: state
        integer, intent(in) :: variable
        real(dp), intent(in) :: x

        select case (variable)
        case (on_mu)
            state%mu = x
        case (on_ln_memory)
            state%r = exp(x)
        case default
            state%r = x
        end select
    end subroutine put

end module steady_sliding
