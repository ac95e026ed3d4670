!> The reference problem of the driver's bars, and its runs with fixed steps.
module reference_problem
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use abstract_integrator, only : step_report
    use friction_mod, only : statev_slip
    use loading_programme, only : programme
    use run_settings, only : settings
    use simulation, only : simulation_run, start_run
    use slider_system, only : slider_state
    use slip_events, only : event_finder, moment, slip_event, turning_point
    implicit none
    private

    public :: last_peak, problem

contains

    !> Steps are adaptive where `rtol` is given.
    function problem(damping, t_end, scheme, rtol, dt) result(run)
        real(dp), intent(in) :: damping, t_end
        integer, intent(in), optional :: scheme
        real(dp), intent(in), optional :: rtol, dt
        type(settings) :: run

        allocate (run%props(10), source=[1.0_dp, 1.0e3_dp, 1.0e3_dp, 0.4_dp, 0.2_dp, 10.0_dp, &
            10.0_dp, 1.0e3_dp, 0.4_dp, 0.0_dp])
        if (present(scheme)) run%props(10) = scheme
        run%mass = 1.0e-3_dp
        run%stiffness = 1.0_dp
        run%damping = damping
        run%drive = programme(start=[0.0_dp], travel=[0.0_dp], velocity=[1.0_dp], &
            acceleration=[0.0_dp], normal=[10.0_dp], normal_rate=[0.0_dp])
        run%event_drop = 0.01_dp
        run%t_end = t_end
        run%dt = 1.0e-6_dp * t_end
        run%adaptive = present(rtol)
        if (present(dt)) run%dt = dt
        if (present(rtol)) run%rtol = rtol
        run%dt_max = t_end
        run%order = 1 + nint(run%props(10))
        run%interval = huge(run%interval)
        run%n_steps = nint(t_end / run%dt)
    end function problem

    !> Time and force of the peak before an event.
    subroutine last_peak(run, event, onset, peak)
        type(settings), intent(in) :: run
        integer, intent(in) :: event
        real(dp), intent(out) :: onset   !! [T]
        real(dp), intent(out) :: peak    !! [F]
        type(simulation_run) :: live
        type(slider_state) :: new
        type(step_report) :: report
        type(event_finder) :: finder
        type(slip_event), allocatable :: ended(:)
        type(moment) :: before, now, turn
        integer :: events
        logical :: found

        call start_run(run, live)
        finder = live%slip_events%finder
        new = live%state
        events = 0
        peak = 0.0_dp
        allocate (ended(0))
        before = seen(run, live%state)
        do while (.not. live%steps%finished(live%state))
            call live%steps%step(live%state, new, report)
            if (report%status < 0) exit
            now = seen(run, new)
            call turning_point(before, now, turn, found)
            if (found) peak = max(peak, turn%force)
            peak = max(peak, now%force)
            call finder%follow(before, now, .false., ended)
            if (size(ended) > 0) then
                events = events + size(ended)
                onset = ended(size(ended))%onset
                if (events >= event) exit
                peak = now%force
                ended = ended(:0)
            end if
            before = now
            live%state = new
        end do
    end subroutine last_peak

    pure function seen(run, state) result(now)
        type(settings), intent(in) :: run
        type(slider_state), intent(in) :: state
        type(moment) :: now

        now%time = state%time
        now%force = state%spring(1)
        now%velocity = state%v(1)
        now%rate = run%stiffness * (run%drive%velocity(1) - state%v(1))
        now%drive = state%drive
        now%slip = state%statev(1, statev_slip)
    end function seen

end module reference_problem
