!> One step of a block in continuous time: taken by the method in use, and ended where a phase of
!> the contact ends.
module block_steps
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use abstract_integrator, only : integrator
    use block_motion, only : moving_block
    use explicit_pairs, only : dormand_prince, explicit_pair, explicit_step
    use free_swing, only : swing
    use friction_mod, only : onset_gradual
    use phase_changes, only : between, first_root, lifts, root_bracket, switch_values, switches
    use rosenbrock, only : growth_rate, rosenbrock_step
    use slider_rates, only : controlled, elastic, extension, memory, phase_capped, phase_slide, &
        phase_stick, place, slider_equations, slip, velocity
    use trial_step, only : look_at, trial
    implicit none
    private

    public :: block_integrator, is_short

    integer, parameter, public :: implicit_rates = 11   !! evaluations of a block's in a step
    !> Part of the time that no step is shorter than.
    real(dp), parameter, public :: shortest = 4.0_dp * epsilon(1.0_dp)

    !> What a step hangs on. Who extends it chooses how long steps are, and by which method.
    type, abstract, extends(integrator) :: block_integrator
        type(moving_block) :: block
        real(dp) :: natural(controlled) = 0.0_dp    !! sizes of the unknowns
        real(dp) :: weights(controlled) = 0.0_dp    !! inverse of the errors tolerated in a step
        type(explicit_pair) :: pair = dormand_prince   !! the explicit method
        logical :: implicit = .false.           !! steps by Rodas4
        logical :: jumped = .false.             !! slip had no rate in the last attempt
        real(dp) :: pressed = 1.0_dp            !! normal traction of the step's start, part of the
                                                !! largest; but 1 where slip rates do not go through
                                                !! decades
        type(swing) :: free                     !! of a block whose contact rests
        logical :: swings = .false.             !! the step is of that, in closed form
    contains
        procedure, non_overridable :: attempt, damper_velocity, locate, free_amplitude
    end type block_integrator

contains

    !> Takes a step by the method in use.
    subroutine attempt(self, t, tried)
        class(block_integrator), intent(inout) :: self
        real(dp), intent(in) :: t             !! [T]
        type(trial), intent(inout) :: tried   !! its length is given
        real(dp) :: scales(controlled, 2), growth
        integer, parameter :: explicit_rates = 6   !! evaluations of them in a step
        real(dp), parameter :: refused = 1.0e4_dp  !! error of a step that is to be far shorter

        tried%switch = 0
        tried%error = huge(tried%error)
        self%jumped = .not. self%block%known
        if (.not. self%block%known) return
        if (self%swings) then
            call swing_on(self, t, tried)
            return
        end if
        if (self%implicit) then
            scales(:, 1) = self%weights
            scales(:, 2) = self%natural
            scales(elastic, 2) = self%natural(elastic) * self%pressed
            associate (block => self%block)
                if (block%equations%slides_damped()) scales(velocity, 2) = min(scales(velocity, &
                    2), self%damper_velocity())
                call rosenbrock_step(block%equations, t, tried%h, block%y, block%first, scales, &
                    tried%y, tried%error, growth)
                tried%stiffness = tried%h * growth
                if (tried%error <= 1.0_dp) call look_at(block, t, self%weights, tried)
                if (tried%error <= 1.0_dp .and. tried%stiffness > 5.0_dp .and. may_grow( &
                    block%equations)) tried%error = max(tried%error, (tried%h * growth_rate( &
                    block%equations, t + tried%h, tried%y, tried%last, self%natural))**4)
            end associate
        else
            call explicit_step(self%pair, self%block%equations, t, tried%h, self%block%y, &
                self%block%first, self%weights, tried%y, tried%last, tried%error, tried%stiffness)
            ! near the bound of stability errors oscillate as large as they may be, and add up
            tried%error = tried%error * max(1.0_dp, tried%stiffness)
        end if
        call self%count_iterations(merge(implicit_rates, explicit_rates, self%implicit))
        self%jumped = .not. tried%error < huge(tried%error)
        if (tried%error <= 1.0_dp) then
            if (slips_back(self, t, tried)) tried%error = refused
        end if
    end subroutine attempt

    !> Has a contact gone back while it slides, by more than the tolerated error, though its slip
    !> rate at the end says it has not? Velocities of slow drives are less than their tolerated
    !> error: a long step would miss the end of slip.
    pure function slips_back(self, t, tried) result(yes)
        class(block_integrator), intent(in) :: self
        real(dp), intent(in) :: t   !! [T]
        type(trial), intent(in) :: tried
        logical :: yes
        real(dp) :: way, change   ! of the block, of the contact's elastic displacement [L]

        associate (eq => self%block%equations, y => self%block%y)
            yes = (eq%phase == phase_capped .or. eq%phase == phase_slide .and. &
                eq%surface%traits%onset /= onset_gradual) .and. eq%mass > 0.0_dp .and. &
                tried%last(slip) >= 0.0_dp
            if (.not. yes) return
            way = self%drive%position(t + tried%h) - self%drive%position(t) - (tried%y(extension) &
                - y(extension))
            change = tried%y(elastic) - y(elastic)
            if (eq%rigid) change = 0.0_dp
            yes = eq%sense * (way - change) < -(1.0_dp / self%weights(extension) + 1.0_dp &
                / self%weights(elastic))
        end associate
    end function slips_back

    !> May a disturbance grow that the tolerated error does not see? Long steps of Rodas4 would damp
    !> it: a block would slide steadily that is going to stick. Creep has steps for it anyway.
    pure function may_grow(eq) result(yes)
        type(slider_equations), intent(in) :: eq
        logical :: yes

        yes = eq%across%free() .or. eq%phase == phase_slide .and. .not. eq%surface%traits%stiff
    end function may_grow

    !> How far the block would swing on both springs if its contact rested [L].
    pure function free_amplitude(self) result(size)
        class(block_integrator), intent(in) :: self
        real(dp) :: size

        associate (y => self%block%y)
            size = self%free%amplitude(y(:controlled), y(velocity) + self%block%first(extension))
        end associate
    end function free_amplitude

    !> At which a damper of the contact alone carries what the surface can, mu p/eta_t [L/T].
    pure real(dp) function damper_velocity(self)
        class(block_integrator), intent(in) :: self

        associate (eq => self%block%equations)
            damper_velocity = self%natural(elastic) * eq%alpha / eq%damper
        end associate
    end function damper_velocity

    !> Takes a step of the block on its springs alone. It ends where the block is fastest in the
    !> sense of the traction, where the drive spring turns, and where the block turns back from
    !> beyond zero traction, or slip between two ends would not be seen.
    subroutine swing_on(self, t, tried)
        class(block_integrator), intent(inout) :: self
        real(dp), intent(in) :: t             !! [T]
        type(trial), intent(inout) :: tried   !! its length is given
        real(dp), parameter :: far = 1.0e-3_dp   !! part of the step
        real(dp) :: v_drive, turn
        type(trial) :: there
        logical :: failed, found

        associate (block => self%block, eq => self%block%equations)
            v_drive = block%y(velocity) + block%first(extension)
            if (eq%sense * block%first(velocity) > 0.0_dp) then
                turn = self%free%until_it_turns(block%y(:controlled), v_drive, eq%sense)
                if (turn > far * tried%h) tried%h = min(tried%h, turn)
            end if
            call self%free%go_on(tried%h, block%y, v_drive, block%first(memory), tried%y)
            call pass_speed(self, v_drive, v_drive, tried, there, found)
            if (found .and. there%h > far * tried%h) tried = there
            if (eq%sense * block%y(velocity) < 0.0_dp) then
                call pass_speed(self, v_drive, 0.0_dp, tried, there, found)
                if (found .and. eq%sense * there%y(elastic) < 0.0_dp) tried = there
            end if
            call eq%rates(t + tried%h, tried%y, tried%last, failed)
        end associate
        tried%error = 0.0_dp
        tried%stiffness = 0.0_dp
        call self%count_iterations(1)
        self%jumped = .false.
    end subroutine swing_on

    !> The step that ends where the block passes a velocity within one, if it does.
    subroutine pass_speed(self, v_drive, speed, whole, part, found)
        class(block_integrator), intent(in) :: self
        real(dp), intent(in) :: v_drive       !! [L/T]
        real(dp), intent(in) :: speed         !! that it passes [L/T]
        type(trial), intent(in) :: whole
        type(trial), intent(out) :: part
        logical, intent(out) :: found
        integer, parameter :: most_tries = 40
        real(dp), parameter :: close = 1.0e-12_dp
        type(root_bracket) :: bracket
        real(dp) :: h, sense
        integer :: i

        associate (block => self%block)
            sense = sign(1.0_dp, whole%y(velocity) - speed)
            bracket%high = whole%h
            bracket%g_low = sense * (block%y(velocity) - speed)
            bracket%g_high = sense * (whole%y(velocity) - speed)
            found = bracket%g_low < 0.0_dp
            part = whole
            if (.not. found) return
            h = bracket%guess()
            do i = 1, most_tries
                part%h = h
                call self%free%go_on(h, block%y, v_drive, block%first(memory), part%y)
                call bracket%take(h, sense * (part%y(velocity) - speed))
                h = bracket%guess()
                if (abs(h - part%h) <= close * whole%h) exit
            end do
        end associate
    end subroutine pass_speed

    !> Ends a step where its phase does, if it has ended. What has ended and come back before that
    !> is looked for in the step that is left.
    subroutine locate(self, t, tried)
        class(block_integrator), intent(inout) :: self
        real(dp), intent(in) :: t                 !! [T]
        type(trial), intent(inout) :: tried
        real(dp) :: g(switches)

        call switch_values(self%block%equations, t + tried%h, tried%y, tried%last, g)
        if (self%block%y(memory) >= self%block%equations%surface%traits%kink) g(3) = -1.0_dp
        if (all(g <= 0.0_dp)) call look_between(self, t, tried, g)
        if (all(g <= 0.0_dp)) return
        call end_with_phase(self, t, tried, g)
        if (tried%switch == 0) return
        call switch_values(self%block%equations, t + tried%h, tried%y, tried%last, g)
        call look_between(self, t, tried, g)
        if (tried%switch == 0 .and. tried%error <= 1.0_dp) call end_with_phase(self, t, tried, g)
    end subroutine locate

    !> Ends a step where the first of the phases that have ended at its end does. The error of a
    !> shorter step can be larger: then it is not taken.
    subroutine end_with_phase(self, t, tried, g)
        class(block_integrator), intent(inout) :: self
        real(dp), intent(in) :: t                 !! [T]
        type(trial), intent(inout) :: tried
        real(dp), intent(inout) :: g(switches)    !! at its end
        integer, parameter :: most_tries = 40
        real(dp), parameter :: close = 1.0e-12_dp
        real(dp), parameter :: unseen = 0.02_dp   !! part of the tolerated error
        real(dp), parameter :: late = 0.03_dp     !! part of a swing's speed
        type(trial) :: again
        type(root_bracket) :: bracket
        real(dp) :: before(switches), middle, share, enough
        integer :: i, which

        which = 0
        share = 2.0_dp
        do i = 1, switches
            if (g(i) <= 0.0_dp) cycle
            middle = 1.0_dp
            if (.not. self%swings) middle = first_root(self%block, t, tried%h, tried%y, &
                tried%last, i)
            if (middle <= share) which = i
            share = min(share, middle)
        end do
        enough = 0.0_dp
        if (self%block%equations%rests .and. which == 1) enough = min(sqrt(unseen * g(which) &
            / (tried%h * self%weights(elastic))), late * self%free%frequency &
            * self%free_amplitude())
        bracket%high = tried%h
        bracket%g_low = -g(which)   ! the start is before the end of the phase, whatever round-off
                                    ! says
        bracket%g_high = g(which) - 0.5_dp * enough
        again = tried
        middle = tried%h * (share + (1.0_dp - share) * min(1.0_dp, 0.5_dp * enough / g(which)))
        if (self%swings) then   ! a step in closed form costs no more than a guess
            call switch_values(self%block%equations, t, self%block%y, self%block%first, before)
            bracket%g_low = min(before(which), 0.0_dp) - 0.5_dp * enough
            middle = bracket%guess()
        end if
        do i = 1, most_tries
            again%h = middle
            call self%attempt(t, again)
            if (.not. again%error < huge(again%error)) exit
            if (again%error > 1.0_dp) then
                tried = again
                return
            end if
            call switch_values(self%block%equations, t + middle, again%y, again%last, g)
            call bracket%take(middle, g(which) - 0.5_dp * enough)
            tried = again
            if (g(which) > 0.0_dp .and. g(which) <= enough) exit
            middle = bracket%guess()
            if (abs(middle - again%h) <= max(close * again%h, 0.5_dp * told(t, bracket%high))) exit
        end do
        if (g(which) <= 0.0_dp) call pass(self, t, which, bracket%high, tried)
        tried%switch = which
    end subroutine end_with_phase

    !> A phase may end within a step and come back before its end: a traction that just passes the
    !> strength in a swing, a sliding block that just turns, one that just leaves the base. Then the
    !> step ends where it has ended most.
    subroutine look_between(self, t, tried, g)
        class(block_integrator), intent(inout) :: self
        real(dp), intent(in) :: t                   !! [T]
        type(trial), intent(inout) :: tried
        real(dp), intent(inout) :: g(switches)      !! at its end
        integer, parameter :: parts = 4
        real(dp), parameter :: unseen = 0.02_dp     !! part of the tolerated error
        integer, parameter :: ways(2) = [1, lifts]  !! that are looked for
        type(trial) :: again
        real(dp) :: at(switches, 0:parts), least(switches), share, peak
        logical :: slides   !! to a point at which it stops
        integer :: i, which

        associate (block => self%block, eq => self%block%equations)
            slides = eq%phase == phase_capped .or. eq%surface%traits%onset /= onset_gradual
            if (self%implicit .or. .not. eq%mass > 0.0_dp .or. eq%rests .or. eq%follows_share() &
                .or. .not. (slides .or. eq%across%free())) return
            if (stays_away(self, t, tried)) return
            call switch_values(eq, t, block%y, block%first, at(:, 0))
            do i = 1, parts - 1
                share = real(i, dp) / parts
                call switch_values(eq, t + share * tried%h, between(block, tried%h, tried%y, &
                    tried%last, share), tried%last, at(:, i))
            end do
            at(:, parts) = g
            least = unseen * eq%alpha / self%weights(elastic)
            least(lifts) = unseen * eq%alpha_n / self%weights(place)
            if (slides .and. eq%phase > phase_stick .and. .not. eq%damper > 0.0_dp) then
                least(1) = unseen / (self%weights(extension) * tried%h)
                at(1, :) = -slip_rates(parts, block%first(slip), (tried%y(slip) - block%y(slip)) &
                    / tried%h, tried%last(slip))
            end if
            which = 0
            do i = 1, size(ways)
                call find_peak(parts, at(ways(i), :), share, peak)
                if (peak > least(ways(i))) which = ways(i)
                if (which > 0) exit
            end do
        end associate
        if (which == 0) return
        again = tried
        again%h = share * tried%h
        call self%attempt(t, again)
        if (.not. again%error < huge(again%error)) return
        if (again%error <= 1.0_dp) then
            call switch_values(self%block%equations, t + again%h, again%y, again%last, at(:, 0))
            if (.not. at(which, 0) > 0.0_dp) return
            g = min(g, at(:, 0))
            g(which) = at(which, 0)
        end if
        tried = again
    end subroutine look_between

    !> Is it plain that the phase cannot end between the ends of the step? Of most steps it is, and
    !> takes a tenth of the time of a look.
    pure logical function stays_away(self, t, tried) result(yes)
        class(block_integrator), intent(in) :: self
        real(dp), intent(in) :: t                   !! [T]
        type(trial), intent(in) :: tried
        real(dp) :: corners(4), v_drive, pressure, pressure_rate, mean

        associate (block => self%block, eq => self%block%equations, h => tried%h)
            yes = .false.
            if (eq%across%free() .or. eq%damper > 0.0_dp .or. eq%rigid) return
            if (eq%phase == phase_stick) then
                if (.not. eq%steady) return
                ! a cubic is within its corners, and strength at rest does not fall
                corners = [block%y(elastic), block%y(elastic) + h / 3.0_dp * block%first(elastic), &
                    tried%y(elastic) - h / 3.0_dp * tried%last(elastic), tried%y(elastic)]
                call eq%inputs(t, block%y, v_drive, pressure, pressure_rate)
                yes = eq%alpha * maxval(abs(corners)) < min(eq%surface%tau_max, &
                    eq%strength(block%y, pressure))
            else   ! the parabola of slip rates has no least value between its ends
                mean = (tried%y(slip) - block%y(slip)) / h
                yes = 3.0_dp * mean >= min(2.0_dp * block%first(slip) + tried%last(slip), &
                    block%first(slip) + 2.0_dp * tried%last(slip))
            end if
        end associate
    end function stays_away

    !> Slip rates at even parts of a step: the parabola of its ends and its mean [L/T].
    pure function slip_rates(parts, first, mean, last) result(rates)
        integer, intent(in) :: parts
        real(dp), intent(in) :: first, mean, last   !! [L/T]
        real(dp) :: rates(0:parts), share
        integer :: i

        do i = 0, parts
            share = real(i, dp) / parts
            rates(i) = first * (1.0_dp - share) * (1.0_dp - 3.0_dp * share) + last * share &
                * (3.0_dp * share - 2.0_dp) + 6.0_dp * mean * share * (1.0_dp - share)
        end do
    end function slip_rates

    !> Where values at even parts of a step have a peak between its ends, by a parabola.
    pure subroutine find_peak(parts, values, share, peak)
        integer, intent(in) :: parts
        real(dp), intent(in) :: values(0:parts)
        real(dp), intent(out) :: share   !! part of the step
        real(dp), intent(out) :: peak    !! the value there; without a peak less than any
        real(dp) :: slope, bend
        integer :: i

        share = 1.0_dp
        peak = -huge(peak)
        i = maxloc(values, dim=1) - 1
        if (i == 0 .or. i == parts) return
        slope = 0.5_dp * (values(i + 1) - values(i - 1))
        bend = values(i + 1) - 2.0_dp * values(i) + values(i - 1)
        if (.not. bend < 0.0_dp) return
        share = (real(i, dp) - slope / bend) / parts
        peak = values(i) - 0.5_dp * slope**2 / bend
    end subroutine find_peak

    !> What a time can tell, in a step that is not a part of one [T].
    pure function told(t, h) result(dt)
        real(dp), intent(in) :: t, h   !! time, length of the step [T]
        real(dp) :: dt

        dt = shortest * t
        if (is_short(t, h)) dt = 0.0_dp
    end function told

    !> Takes a step that ends before its phase does again, until it ends just after: the next phase
    !> starts where this one has ended. A phase that starts at its end, as a contact does that comes
    !> to rest because its strength grows, may end anywhere in the step.
    subroutine pass(self, t, which, latest, tried)
        class(block_integrator), intent(inout) :: self
        real(dp), intent(in) :: t        !! [T]
        integer, intent(in) :: which     !! way in which the phase ends
        real(dp), intent(in) :: latest   !! length of a step that is long enough [T]
        type(trial), intent(inout) :: tried
        integer, parameter :: most_tries = 120
        real(dp), parameter :: close = 1.0e-12_dp
        type(trial) :: again
        real(dp) :: nudge, before, g(switches)
        logical :: passed
        integer :: i

        again = tried
        before = tried%h   ! the longest step known to end before the phase
        nudge = max(close * before, told(t, latest))
        passed = .false.
        do i = 1, most_tries
            again%h = min(latest, before + nudge)
            if (passed) again%h = 0.5_dp * (before + tried%h)
            nudge = 2.0_dp * nudge
            call self%attempt(t, again)
            if (.not. again%error < huge(again%error)) return
            if (again%error > 1.0_dp) then
                tried = again
                return
            end if
            call switch_values(self%block%equations, t + again%h, again%y, again%last, g)
            if (g(which) <= 0.0_dp) before = again%h
            if (g(which) > 0.0_dp .or. .not. passed) tried = again
            passed = passed .or. g(which) > 0.0_dp .or. again%h >= latest
            if (passed .and. tried%h - before <= max(close * before, told(t, latest))) return
        end do
    end subroutine pass

    !> Is a step not much longer than what its time can tell?
    pure function is_short(t, h) result(yes)
        real(dp), intent(in) :: t, h   !! [T]
        logical :: yes

        yes = h < 4.0_dp * shortest * t
    end function is_short

end module block_steps
