!> Adaptive steps of chains, and of a block for which Newmark's (or the generalised-alpha) method is
!> asked for.
!>
!> A step is taken as a whole and in two halves. The leading term of the error is extrapolated away
!> (Richardson); how much the whole step matters in that estimates the error.
module adaptive_steps
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use abstract_integrator, only : integrator, step_report
    use archive_file, only : archive
    use chain_parts, only : choose_method
    use contact_forces, only : apply_normal_traction
    use energies, only : account
    use friction_mod, only : facts => law_facts, friction_coefficient_change, friction_facts, &
        friction_no_convergence, prop_alpha_n, statev_dissipation, statev_mu, statev_r, &
        statev_slip, statev_status, statev_u_n
    use law_facts, only : pressure_effect
    use run_settings, only : settings
    use slider_system, only : set_accelerations, slider, slider_state
    use step_ends, only : end_of_step, find_opening, load_at, next_limit, none_below, &
        vanishing_part, why_too_short, within_range
    use time_integrator, only : newmark
    use turning_times, only : turn
    implicit none
    private

    public :: adaptive

    !> Part of the time that no adaptive step is shorter than: a third of it is still more than
    !> round-off.
    real(dp), parameter :: shortest = 1.0e-14_dp
    real(dp), parameter :: swing = 0.1_dp   !! that does not matter, part of the tolerated error

    type, extends(integrator) :: adaptive
        class(newmark), allocatable :: method
        type(facts), allocatable :: laws(:)   !! of each block; one, if all are alike
        real(dp) :: tolerated = 0.0_dp     !! error in a step, as a spring force [F]
        real(dp) :: pressing = 0.0_dp      !! largest normal force [F]
        real(dp) :: open_below = 0.0_dp    !! normal traction that counts as none, where it varies
                                           !! [F/L^2]
        integer :: order = 1               !! of the method, with the friction law in it
        real(dp) :: stiffness = 0.0_dp     !! against displacements in the last step [F/L]
        real(dp) :: last_error = 1.0_dp    !! of the step before, part of the tolerated one
        type(slider_state) :: middle       !! half-way through the last step
        real(dp), private :: part = 0.0_dp        !! of the error of the whole step that is left in
                                                  !! the halves
        type(slider_state), private :: ends(2)    !! by one step, by two halves
        type(slider_state), private :: error      !! room for an estimate
    contains
        procedure :: prepare, step, visit, why_stopped
        procedure, private :: try, try_twice, error_of, extrapolate, reversal
    end type adaptive

contains

    subroutine prepare(self, run, system, start)
        class(adaptive), intent(inout) :: self
        type(settings), intent(in) :: run
        type(slider), intent(in) :: system
        type(slider_state), intent(in) :: start
        type(facts) :: law
        integer :: i

        call self%take_run(run, system, start)
        call choose_method(run, self%method)
        self%order = run%order
        self%pressing = run%area * run%drive%largest_normal()
        law = friction_facts(run%props)
        self%laws = [law]
        if (allocated(system%constants)) self%laws = [(friction_facts(system%constants(i, :)), &
            i = 1, size(system%constants, 1))]
        self%tolerated = run%rtol * max(law%typical_coefficient * self%pressing + run%area &
            * law%cohesion, tiny(1.0_dp) / epsilon(1.0_dp))
        if (.not. (any(self%laws%cohesion > 0.0_dp) .or. run%across%free())) self%open_below &
            = run%drive%largest_normal() * max(vanishing_part(law%traits%stiff, run%rtol), &
            within_range(pressure_effect(system%props, system%constants)))
        self%part = 1.0_dp / (2.0_dp**self%order - 1.0_dp)
        self%middle = start
        self%error = start
        self%ends = start
    end subroutine prepare

    subroutine visit(self, file)
        class(adaptive), intent(inout) :: self
        type(archive), intent(inout) :: file

        call self%visit_counts(file)
        call file%visit(self%dt, self%last_error)
    end subroutine visit

    subroutine why_stopped(self, status, why)
        class(adaptive), intent(in) :: self
        integer, intent(in) :: status
        character(len=:), allocatable, intent(out) :: why

        call self%explain_status(status, why_too_short(self%dt_min), why)
    end subroutine why_stopped

    !> One step from `old` to `time`, in one piece of the programme.
    subroutine try(self, old, time, piece, new, report, guess)
        class(adaptive), intent(inout) :: self
        type(slider_state), intent(in) :: old
        real(dp), intent(in) :: time   !! [T]
        integer, intent(in) :: piece
        type(slider_state), intent(inout) :: new
        type(step_report), intent(out) :: report
        real(dp), intent(in), optional :: guess(:)   !! of the displacements [L]

        call self%method%step(self%system, self%origin + self%drive%position(time), &
            load_at(self%drive, time, piece, self%open_below), time - old%time, old, new, report, &
            guess)
        if (report%status >= 0) call account(self%system, self%method%sums(self%system, old, new), &
            old, new)
        new%time = time
        call self%count_iterations(report%iterations)
    end subroutine try

    subroutine step(self, old, new, report)
        class(adaptive), intent(inout) :: self
        type(slider_state), intent(inout) :: old
        type(slider_state), intent(inout) :: new
        type(step_report), intent(out) :: report
        real(dp), parameter :: safety = 0.9_dp, most_cut = 0.2_dp
        real(dp) :: limit, end, dt, error, power, event, kink, after
        integer, parameter :: most_cuts = 3   !! of a step, at an event found more and more exactly
        integer :: piece, cuts
        logical :: pressed   !! false: this step has to apply the sudden normal traction

        power = 1.0_dp / (self%order + 1)
        piece = self%drive%piece(old%time)
        limit = next_limit(self%drive, self%every, self%t_end, shortest, old%time)
        call apply_normal_traction(self%system, load_at(self%drive, old%time, piece, &
            self%open_below), old, pressed)
        event = huge(event)
        cuts = 0
        do
            end = end_of_step(old%time, min(old%time + self%dt, event) - old%time, limit)
            call find_opening(self%drive, piece, none_below(self%drive, piece, self%open_below), &
                old%normal <= 0.0_dp, old%time, end, kink, after)
            if (old%normal <= 0.0_dp .and. self%open_below > 0.0_dp) kink = after   ! as it opened
            if (matters(kink) .and. .not. self%system%across%free()) end = kink
            dt = end - old%time
            call self%try_twice(old, end, piece, report)
            self%stiffness = max(self%system%stiffness, report%stiffness)
            if (report%status >= 0) then
                error = self%error_of()
                if (error <= 1.0_dp) then
                    event = self%reversal(old)
                    if (.not. matters(event) .or. cuts == most_cuts) exit
                    cuts = cuts + 1
                    cycle
                end if
                self%dt = dt * max(most_cut, safety * error**(-power))
            else
                self%dt = 0.25_dp * dt
            end if
            self%rejected = self%rejected + 1
            if (.not. self%dt > max(self%dt_min, shortest * old%time)) then
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

    !> The step in halves, and as a whole; `middle` is the end of the first half.
    subroutine try_twice(self, old, end, piece, report)
        class(adaptive), intent(inout) :: self
        type(slider_state), intent(in) :: old
        real(dp), intent(in) :: end         !! of the step [T]
        integer, intent(in) :: piece
        type(step_report), intent(out) :: report

        call self%try(old, old%time + 0.5_dp * (end - old%time), piece, self%middle, report)
        if (report%status < 0) return
        call self%try(self%middle, end, piece, self%ends(2), report)
        if (report%status < 0) return
        call self%try(old, end, piece, self%ends(1), report, guess=self%ends(2)%x)
    end subroutine try_twice

    !> Estimate of the error, part of the tolerated one: displacement and slip as the force that
    !> they mean to the spring, velocity by the amplitude that it becomes, what the law remembers by
    !> the friction force that it changes.
    function error_of(self) result(error)
        class(adaptive), intent(inout) :: self
        real(dp) :: error
        integer :: i

        call blend(self%ends, [-self%part, self%part], self%error)
        associate (e => self%error, s => self%system)
            error = maxval(max(s%stiffness * abs(e%x), &
                s%stiffness * sqrt(s%mass / self%stiffness) * abs(e%v), &
                s%stiffness * abs(e%statev(:, statev_slip))))
            do i = 1, size(e%x)
                error = max(error, self%pressing * friction_coefficient_change( &
                    self%laws(min(i, size(self%laws)))%traits, self%ends(2)%statev(i, statev_r), &
                    e%statev(i, statev_mu), e%statev(i, statev_r)))
            end do
            if (s%across%free()) error = max(error, self%laws(1)%typical_coefficient * s%area &
                * s%props(prop_alpha_n) * max(abs(e%statev(1, statev_u_n)), abs(e%v_n) &
                * sqrt(s%across%mass / (s%across%stiffness + s%area * s%props(prop_alpha_n)))))
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
        integer :: i

        associate (finest_end => self%ends(2))
            new%time = finest_end%time
            new%drive = finest_end%drive
            new%normal = finest_end%normal
            new%load = finest_end%load
            if ((self%system%mass > 0.0_dp .and. self%stiffness * (new%time - old%time)**2 &
                > self%system%mass) .or. (self%system%across%free() .and. any((self%ends%normal &
                > 0.0_dp) .neqv. old%normal > 0.0_dp))) then   ! it leaves the base or comes back
                call blend(self%ends, finest, new)
            else
                call blend(self%ends, [-self%part, 1.0_dp + self%part], new)
            end if
            do i = 1, size(new%x)
                associate (mu => new%statev(i, statev_mu), r => new%statev(i, statev_r), &
                    law => self%laws(min(i, size(self%laws))))
                    if (nint(self%ends(1)%statev(i, statev_status)) /= nint(finest_end%statev(i, &
                        statev_status)) .or. is_beyond(law, mu)) then
                        ! where it sticks in the whole step and slips in the halves, or the other
                        ! way round, they are not of one smooth motion
                        new%x(i) = finest_end%x(i)
                        new%v(i) = finest_end%v(i)
                        new%v_n = finest_end%v_n
                        new%friction(i) = finest_end%friction(i)
                        new%statev(i, :) = finest_end%statev(i, :)
                    end if
                    if (law%traits%memory == 1) then
                        mu = min(law%largest_coefficient, max(law%kinetic_coefficient, mu))
                        r = min(1.0_dp, max(0.0_dp, r))
                    else
                        mu = max(0.0_dp, mu)
                        r = max(0.5_dp * finest_end%statev(i, statev_r), r)
                    end if
                end associate
            end do
        end associate
        new%statev(:, statev_status) = self%ends(2)%statev(:, statev_status)
        ! what accumulates never falls, not even by round-off
        new%statev(:, statev_slip) = max(old%statev(:, statev_slip), new%statev(:, statev_slip))
        new%statev(:, statev_dissipation) = max(old%statev(:, statev_dissipation), &
            new%statev(:, statev_dissipation))
        associate (u_n => new%statev(:, statev_u_n))
            new%spring = self%system%pull(new%drive, new%x, u_n)
            if (self%system%across%free()) new%normal = self%system%carried_pressure(u_n(1))
        end associate
        call set_accelerations(self%system, new)
    end subroutine extrapolate

    !> Is it no friction coefficient of a law that remembers none, but for round-off?
    pure function is_beyond(law, mu) result(yes)
        type(facts), intent(in) :: law
        real(dp), intent(in) :: mu   !! [-]
        logical :: yes
        real(dp), parameter :: round_off = 1.0e-9_dp   !! part

        yes = law%traits%memory /= 1 .and. law%largest_coefficient < huge(mu) .and. (mu &
            - law%largest_coefficient > round_off * law%largest_coefficient .or. &
            law%kinetic_coefficient - mu > round_off * law%kinetic_coefficient)
    end function is_beyond

    !> Weighted sum of states, but for their times, drives and loads.
    pure subroutine blend(states, weights, mixed)
        type(slider_state), intent(in) :: states(:)
        real(dp), intent(in) :: weights(:)           !! one for each state [-]
        type(slider_state), intent(inout) :: mixed   !! allocated like the states
        integer :: k

        mixed%drive_work = dot_product(weights, states%drive_work)
        mixed%damped = dot_product(weights, states%damped)
        mixed%v_n = dot_product(weights, states%v_n)
        mixed%x(:) = weights(1) * states(1)%x
        mixed%v(:) = weights(1) * states(1)%v
        mixed%friction(:) = weights(1) * states(1)%friction
        mixed%statev(:, :) = weights(1) * states(1)%statev
        do k = 2, size(states)
            mixed%x(:) = mixed%x + weights(k) * states(k)%x
            mixed%v(:) = mixed%v + weights(k) * states(k)%v
            mixed%friction(:) = mixed%friction + weights(k) * states(k)%friction
            mixed%statev(:, :) = mixed%statev + weights(k) * states(k)%statev
        end do
    end subroutine blend

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
            if (all(nint(before) == nint(after))) return
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

end module adaptive_steps
