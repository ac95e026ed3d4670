!> Chooses the steps in time by their error, and repeats those that fail.
!>
!> Adaptive steps are taken as a whole and in two halves, those of the exponential rule in three
!> thirds as well. From these the leading terms of the error are extrapolated away (Richardson); how
!> much the coarsest one matters in that estimates the error.
module adaptive_steps
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use abstract_integrator, only : integrator, step_report
    use archive_file, only : archive
    use chain_parts, only : choose_method
    use exponential_rule, only : exponential
    use friction_mod, only : friction_message, friction_no_convergence, statev_dissipation, &
        statev_mu, statev_r, statev_slip, statev_status
    use law_facts, only : coefficient_error, is_subloading, typical_coefficient
    use run_settings, only : next_row, settings
    use slider_system, only : apply_normal_traction, blend, set_accelerations, slider, &
        slider_state
    use time_integrator, only : newmark
    use turning_times, only : next_turn, oscillation_of, turn, visible_swing
    implicit none
    private

    public :: adaptive

    integer, parameter :: most_levels = 3
    !> Part of the time that no adaptive step is shorter than: a third of it is still more than
    !> round-off.
    real(dp), parameter :: shortest = 1.0e-14_dp
    real(dp), parameter :: swing = 0.1_dp   !! that does not matter, part of the tolerated error

    type, extends(integrator) :: adaptive
        class(newmark), allocatable :: method
        real(dp) :: dt = 0.0_dp        !! next to try [T]
        real(dp) :: dt_min = 0.0_dp, dt_max = 0.0_dp   !! [T]
        real(dp) :: every = 0.0_dp     !! steps end at multiples of this time, unless it is 0 [T]
        logical :: exponential = .false.   !! steps by the exponential rule, not by `method`
        type(exponential) :: rule
        real(dp) :: tolerated = 0.0_dp     !! error in a step, as a spring force [F]
        real(dp) :: noticed = 0.0_dp       !! swing of the drive spring that steps have to show [F]
        real(dp) :: pressing = 0.0_dp      !! largest normal force [F]
        integer :: order = 1               !! of the method, with the friction law in it
        real(dp) :: stiffness = 0.0_dp     !! against displacements in the last step [F/L]
        real(dp) :: last_error = 1.0_dp    !! of the step before, part of the tolerated one
        type(slider_state) :: middle       !! half-way through the last step
        integer, private :: levels = 2     !! ways in which each step is taken
        real(dp), private :: weights(most_levels) = 0.0_dp   !! of its ends, to extrapolate
        real(dp), private :: doubts(most_levels) = 0.0_dp    !! likewise, to estimate the error
        type(slider_state), private :: ends(most_levels)   !! by one step, two halves, three thirds
        type(slider_state), private :: passing             !! room for a state
    contains
        procedure :: prepare, step, visit, why_stopped
        procedure, private :: choose_rule, next_end, try, try_levels, error_of, extrapolate, &
            next_limit, reversal, opening
    end type adaptive

contains

    subroutine prepare(self, run, system, start)
        class(adaptive), intent(inout) :: self
        type(settings), intent(in) :: run
        type(slider), intent(in) :: system
        type(slider_state), intent(in) :: start
        real(dp), parameter :: noticed = 1.0e-3_dp   !! part of the static friction force; slip
                                                     !! events begin at ten times as much

        call self%take_run(run, system, start)
        call choose_method(run, self%method)
        self%dt = run%dt
        self%dt_min = run%dt_min
        self%dt_max = run%dt_max
        self%every = run%every
        self%order = run%order
        self%pressing = run%area * run%drive%largest_normal()
        self%tolerated = run%rtol * max(typical_coefficient(run%props) * self%pressing, &
            tiny(1.0_dp) / epsilon(1.0_dp))
        self%noticed = noticed * self%tolerated / run%rtol
        call self%choose_rule(run, size(start%x))
        self%middle = start
        self%passing = start
        self%ends = start
    end subroutine prepare

    !> The exponential rule serves one block with a mass, unless another method is asked for.
    subroutine choose_rule(self, run, blocks)
        class(adaptive), intent(inout) :: self
        type(settings), intent(in) :: run
        integer, intent(in) :: blocks
        real(dp), parameter :: negligible = 1.0e-6_dp   !! part of the tolerated error
        type(newmark) :: default
        integer :: k

        self%exponential = blocks == 1 .and. run%mass > 0.0_dp .and. run%rho_infinity < 0.0_dp &
            .and. .not. (abs(run%beta - default%beta) > 0.0_dp &
            .or. abs(run%gamma - default%gamma) > 0.0_dp)
        if (self%exponential) self%levels = 3
        self%rule%tolerance = run%tolerance
        self%rule%max_iterations = run%max_iterations
        self%rule%negligible = negligible * self%tolerated / run%stiffness
        self%weights(:self%levels) = [(extrapolation_weight(k, 1), k = 1, self%levels)]
        self%doubts(1) = self%weights(1)
        self%doubts(2:self%levels) = self%weights(2:self%levels) &
            - [(extrapolation_weight(k, 2), k = 2, self%levels)]

    contains

        !> Weight of the end by k parts among those by `first` to `levels` parts: the polynomial in
        !> a power of the step that passes through them, at step 0.
        pure function extrapolation_weight(k, first) result(weight)
            integer, intent(in) :: k, first
            real(dp) :: weight
            integer :: j

            weight = 1.0_dp
            do j = first, self%levels
                if (j /= k) weight = weight / (1.0_dp - (real(j, dp) / k)**self%order)
            end do
        end function extrapolation_weight

    end subroutine choose_rule

    subroutine visit(self, file)
        class(adaptive), intent(inout) :: self
        type(archive), intent(inout) :: file

        call self%visit_counts(file)
        call file%visit(self%dt)
        call file%visit(self%last_error)
        call file%visit(self%rule%contact)
    end subroutine visit

    subroutine why_stopped(self, status, why)
        class(adaptive), intent(in) :: self
        integer, intent(in) :: status
        character(len=:), allocatable, intent(out) :: why

        if (status /= friction_no_convergence) then
            why = trim(friction_message(status))
        else if (self%system%mass <= 0.0_dp) then
            why = 'the slider is unstable without inertia: friction falls faster than the spring ' &
                // 'unloads. Give it a mass to see the jump, or a stiffer spring'
        else
            why = 'not within the tolerance by steps as short as dt_min'
        end if
    end subroutine why_stopped

    !> One step from `old` to `time`, in one piece of the programme.
    subroutine try(self, old, time, piece, new, report, guess, first)
        class(adaptive), intent(inout) :: self
        type(slider_state), intent(in) :: old
        real(dp), intent(in) :: time   !! [T]
        integer, intent(in) :: piece
        type(slider_state), intent(inout) :: new
        type(step_report), intent(out) :: report
        real(dp), intent(in), optional :: guess(:)   !! of the displacements [L]
        logical, intent(in), optional :: first   !! of an adaptive step: the rule is fitted to it
        real(dp) :: drive, normal

        drive = self%origin + self%drive%position(time)
        normal = self%drive%normal_traction(time, piece)
        if (self%exponential) then
            call self%rule%step(self%system, drive, normal, time - old%time, old, new, report, &
                present(first), guess)
        else
            call self%method%step(self%system, drive, normal, time - old%time, old, new, report, &
                guess)
            if (report%status >= 0) call self%system%account(old, new)
        end if
        new%time = time
        call self%count_iterations(report%iterations)
    end subroutine try

    subroutine step(self, old, new, report)
        class(adaptive), intent(inout) :: self
        type(slider_state), intent(inout) :: old
        type(slider_state), intent(inout) :: new
        type(step_report), intent(out) :: report
        real(dp), parameter :: safety = 0.9_dp, most_cut = 0.2_dp
        real(dp) :: limit, end, dt, error, power, event, kink
        integer, parameter :: most_cuts = 3   !! of a step, at an event found more and more exactly
        integer :: piece, cuts
        logical :: pressed   !! false: this step has to apply the sudden normal traction

        power = 1.0_dp / (self%order * (self%levels - 1) + 1)
        piece = self%drive%piece(old%time)
        limit = self%next_limit(old%time)
        call apply_normal_traction(self%system, self%drive%normal_traction(old%time, piece), old, &
            pressed)
        if (old%normal <= 0.0_dp) then
            self%rule%contact = 0.0_dp
        else if (self%exponential) then
            call expect_stick_after_turn(self%system, old, self%rule%contact)
        end if
        event = huge(event)
        cuts = 0
        do
            end = end_of_step(old%time, min(self%next_end(old, piece), event) - old%time, limit)
            kink = self%opening(old, end, piece)
            if (matters(kink)) end = kink
            dt = end - old%time
            call self%try_levels(old, end, piece, report)
            self%stiffness = max(self%system%stiffness, report%stiffness)
            if (report%status >= 0) then
                error = self%error_of()
                if (error <= 1.0_dp) then
                    event = self%reversal(old)
                    if (.not. matters(event)) exit
                    if (cuts == most_cuts) exit
                    cuts = cuts + 1
                    cycle
                end if
                self%dt = dt * max(most_cut, safety * error**(-power))
            else
                self%dt = 0.25_dp * dt
            end if
            self%rejected = self%rejected + 1
            if (self%dt < max(self%dt_min, shortest * old%time)) then
                ! friction that meets a sudden load slips by the logarithm of the time it has: no
                ! step is short enough for that
                error = 1.0_dp
                if (report%status >= 0 .and. .not. pressed) exit
                if (report%status >= 0) report%status = friction_no_convergence
                return
            end if
        end do
        call lengthen()
        call self%extrapolate(old, new)

    contains

        !> The next step, by the errors of the last two. One that an event has cut says nothing
        !> against the one that was to be taken.
        subroutine lengthen()
            real(dp), parameter :: most_growth = 4.0_dp

            error = max(error, 1.0e-4_dp)
            dt = dt * min(most_growth, safety * error**(-0.7_dp * power) &
                * self%last_error**(0.4_dp * power))
            if (end < old%time + 0.99_dp * self%dt) dt = max(dt, self%dt)
            self%dt = min(self%dt_max, dt)
            self%last_error = error
        end subroutine lengthen

        !> Is a time so far into the step, and so far from its end, that it should end there?
        pure function matters(time) result(yes)
            real(dp), intent(in) :: time   !! [T]
            logical :: yes

            yes = time - old%time > max(1.0e-3_dp * (end - old%time), shortest * old%time) &
                .and. end - time > shortest * end
        end function matters

    end subroutine step

    !> Where a step from a time ends at the latest: at the next piece, the next row, or the end of
    !> the run. Of those that are no step apart it is the last.
    pure function next_limit(self, time) result(limit)
        class(adaptive), intent(in) :: self
        real(dp), intent(in) :: time   !! [T]
        real(dp) :: limit              !! [T]
        real(dp) :: next

        next = time
        do
            limit = next
            next = min(self%drive%next_start(limit), next_row(self%every, limit), self%t_end)
            if (limit >= self%t_end) return
            if (limit > time .and. next > limit * (1.0_dp + shortest)) return
        end do
    end function next_limit

    !> Where the step should end by its error and by the oscillation.
    pure function next_end(self, old, piece) result(end)
        class(adaptive), intent(in) :: self
        type(slider_state), intent(in) :: old
        integer, intent(in) :: piece
        real(dp) :: end   !! [T]

        end = old%time + self%dt
        if (.not. self%exponential) return
        associate (now => oscillation_of(self%system, old, self%rule%contact, &
            self%drive%drive_velocity(old%time, piece)))
            end = min(end, old%time + visible_swing(self%system, now, self%noticed))
            if (old%normal > 0.0_dp) end = min(end, next_turn(self%system, old, now, &
                swing * self%tolerated))
        end associate
    end function next_end

    !> A block that has just turned round is carried elastically at first.
    pure subroutine expect_stick_after_turn(system, state, contact)
        type(slider), intent(in) :: system
        type(slider_state), intent(in) :: state   !! of one block
        real(dp), intent(inout) :: contact        !! expected stiffness of the contact [F/L]
        real(dp), parameter :: slow = 0.1_dp      !! part of the velocity that is to come
        real(dp) :: elastic

        elastic = system%area * system%props(3)
        if (elastic * state%v(1)**2 < slow**2 * system%mass * state%a(1)**2) contact = elastic
    end subroutine expect_stick_after_turn

    !> No step is left that is much shorter than the one before the limit.
    pure function end_of_step(start, dt, limit) result(end)
        real(dp), intent(in) :: start, dt, limit   !! [T]
        real(dp) :: end                            !! [T]

        end = start + dt
        if (end >= limit - 1.0e-3_dp * dt) then
            end = limit
        else if (end > limit - dt) then
            end = start + 0.5_dp * (limit - start)
        end if
    end function end_of_step

    !> The step as a whole, in halves, and in thirds; `middle` is the end of the first half.
    subroutine try_levels(self, old, end, piece, report)
        class(adaptive), intent(inout) :: self
        type(slider_state), intent(in) :: old
        real(dp), intent(in) :: end         !! of the step [T]
        integer, intent(in) :: piece
        type(step_report), intent(out) :: report
        real(dp) :: third

        call self%try(old, old%time + 0.5_dp * (end - old%time), piece, self%middle, report, &
            first=.true.)
        if (report%status < 0) return
        call self%try(self%middle, end, piece, self%ends(2), report)
        if (report%status < 0) return
        call self%try(old, end, piece, self%ends(1), report, guess=self%ends(2)%x)
        if (report%status < 0 .or. self%levels < 3) return
        third = (end - old%time) / 3.0_dp
        call self%try(old, old%time + third, piece, self%ends(3), report)
        if (report%status < 0) return
        call self%try(self%ends(3), end - third, piece, self%passing, report)
        if (report%status < 0) return
        call self%try(self%passing, end, piece, self%ends(3), report, guess=self%ends(2)%x)
    end subroutine try_levels

    !> Estimate of the error, part of the tolerated one: displacement and slip as the force that
    !> they mean to the spring, velocity by the amplitude that it becomes, what the law remembers by
    !> the friction force that it changes.
    function error_of(self) result(error)
        class(adaptive), intent(inout) :: self
        real(dp) :: error

        call blend(self%ends(:self%levels), self%doubts(:self%levels), self%passing)
        associate (e => self%passing, s => self%system)
            error = maxval(max(s%stiffness * abs(e%x), &
                s%stiffness * sqrt(s%mass / self%stiffness) * abs(e%v), &
                s%stiffness * abs(e%statev(:, statev_slip))))
            error = max(error, self%pressing * maxval(coefficient_error(s%props, &
                self%ends(2)%statev, e%statev)))
        end associate
        error = error / self%tolerated
    end function error_of

    !> The best of what is known about the end of the step. Extrapolation would amplify an
    !> oscillation that is faster than a step of Newmark's, which takes a mass, and must not leave
    !> the range of the law's variables.
    subroutine extrapolate(self, old, new)
        class(adaptive), intent(inout) :: self
        type(slider_state), intent(in) :: old
        type(slider_state), intent(inout) :: new
        real(dp), parameter :: finest(2) = [0.0_dp, 1.0_dp]

        associate (finest_end => self%ends(self%levels))
            new%time = finest_end%time
            new%drive = finest_end%drive
            new%normal = finest_end%normal
            if (.not. self%exponential .and. self%system%mass > 0.0_dp &
                .and. self%stiffness * (new%time - old%time)**2 > self%system%mass) then
                call blend(self%ends(:2), finest, new)
            else
                call blend(self%ends(:self%levels), self%weights(:self%levels), new)
            end if
            new%statev(:, statev_status) = finest_end%statev(:, statev_status)
            associate (mu => new%statev(:, statev_mu), r => new%statev(:, statev_r))
                if (is_subloading(self%system%props)) then
                    mu = min(self%system%props(4), max(self%system%props(5), mu))
                    r = min(1.0_dp, max(0.0_dp, r))
                else
                    mu = max(0.0_dp, mu)
                    r = max(0.5_dp * finest_end%statev(:, statev_r), r)
                end if
            end associate
        end associate
        ! what accumulates never falls, not even by round-off
        new%statev(:, statev_slip) = max(old%statev(:, statev_slip), new%statev(:, statev_slip))
        new%statev(:, statev_dissipation) = max(old%statev(:, statev_dissipation), &
            new%statev(:, statev_dissipation))
        new%spring = self%system%stiffness * (new%drive - new%x)
        call set_accelerations(self%system, new)
    end subroutine extrapolate

    !> When slip began or ended within the last step, unless next to its ends: friction has a kink
    !> there. In steps of Newmark's it counts if a block stuck or slipped differently since.
    pure function reversal(self, old) result(time)
        class(adaptive), intent(in) :: self
        type(slider_state), intent(in) :: old
        real(dp) :: time   !! [T]; huge without such a moment

        time = huge(time)
        if (old%normal <= 0.0_dp) return
        associate (before => old%statev(:, statev_status), &
            after => self%ends(2)%statev(:, statev_status))
            if (.not. self%exponential .and. all(nint(before) == nint(after))) return
        end associate
        time = turn(self%system, old, self%middle)
        if (time < huge(time)) then
            if (moved(old, time - old%time) > swing * self%tolerated) return
        end if
        time = turn(self%system, self%middle, self%ends(2))
        if (time >= huge(time)) return
        if (moved(self%ends(2), self%ends(2)%time - time) > swing * self%tolerated) return
        time = huge(time)

    contains

        !> What blocks as fast as in a state move in a time, as a spring force.
        pure function moved(state, dt) result(force)
            type(slider_state), intent(in) :: state
            real(dp), intent(in) :: dt   !! [T]
            real(dp) :: force            !! [F]

            force = self%system%stiffness * maxval(abs(state%v)) * dt
        end function moved

    end function reversal

    !> When the normal traction vanishes, or comes back, within a step; huge if neither. The last
    !> moment before: a part of a step that ends behind it slips all the way, or not at all.
    pure function opening(self, old, end, piece) result(time)
        class(adaptive), intent(in) :: self
        type(slider_state), intent(in) :: old
        real(dp), intent(in) :: end       !! of the step [T]
        integer, intent(in) :: piece
        real(dp) :: time                  !! [T]
        real(dp) :: middle, high
        logical :: open_before
        integer :: k

        time = huge(time)
        open_before = old%normal <= 0.0_dp
        if (open_before .eqv. self%drive%normal_traction(end, piece) <= 0.0_dp) return
        time = old%time
        high = end
        do k = 1, 52
            middle = 0.5_dp * (time + high)
            if ((self%drive%normal_traction(middle, piece) <= 0.0_dp) .eqv. open_before) then
                time = middle
            else
                high = middle
            end if
        end do
    end function opening

end module adaptive_steps
