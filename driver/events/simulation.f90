!> Runs the slider through its programme: a loop of steps that observers watch. It reads and writes
!> nothing, and keeps nothing outside its arguments: several can run at once, each in its thread.
module simulation
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use abstract_integrator, only : integrator, step_report
    use archive_file, only : archive
    use chain_observer, only : chain_watch
    use chain_settings, only : displaced, load_factors
    use energies, only : energy_balance, take_stock
    use friction_mod, only : friction_message, friction_snap_back, prop_alpha_n, statev_u_et
    use initial_states, only : displace, initial_state, place
    use integrator_choice, only : choose_integrator
    use number_text, only : rounded_text
    use run_observer, only : observer_slot, step_news
    use run_outcome, only : outcome
    use run_settings, only : settings
    use slider_system, only : slider, slider_state, swap_states
    use slip_observer, only : slip_watch
    implicit none
    private

    public :: simulate, simulation_run, start_run

    !> A run between two steps: all that it needs to go on.
    type :: simulation_run
        type(slider_state), allocatable :: state
        type(slider_state), allocatable, private :: other   !! the one before, or room for the next
        class(integrator), allocatable :: steps
        type(slip_watch) :: slip_events
        type(chain_watch) :: chain_events
        integer :: taken = 0                   !! steps
        integer :: snap_backs = 0              !! steps that had several equilibria
        real(dp) :: energy_at_start = 0.0_dp   !! held then, in all forms [F L]
        real(dp) :: let_go = 0.0_dp            !! lost by contact springs when they opened or
                                               !! jumped, beyond what states of friction tell [F L]
        real(dp) :: most_work = 0.0_dp         !! of the drive, whichever way [F L]
        logical :: resumed = .false.           !! it has been read from a checkpoint
        character(len=:), allocatable :: problem   !! why it cannot start; or empty
    contains
        procedure :: visit
    end type simulation_run

contains

    !> A run before its first step.
    subroutine start_run(run, live)
        type(settings), intent(in) :: run
        type(simulation_run), intent(out) :: live
        type(slider) :: system
        type(energy_balance) :: energy
        integer :: status

        system = slider(run%mass, run%stiffness, run%damping, run%area, run%props, &
            run%chain%coupling, run%chain%ends)
        system%across = run%across
        system%across%rest = -max(0.0_dp, run%drive%normal_traction(0.0_dp, 1)) &
            / run%props(prop_alpha_n)
        if (run%chain%loads_differ()) system%load = load_factors(run%chain)
        if (allocated(run%chain%constants)) system%constants = run%chain%constants
        call live%chain_events%prepare(run)
        call live%slip_events%prepare(run)
        live%problem = ''
        allocate (live%state)
        call initial_state(system, run%chain%n_blocks, run%drive%normal_traction(0.0_dp, 1), &
            live%state, status)
        if (status < 0) live%problem = 'at the start: ' // friction_message(status)
        call place(system, run%initial, live%state)
        if (run%chain%displacement_scatter > 0.0_dp) call displace(system, displaced(run%chain), &
            live%state)
        if (run%rigid_contact) live%state%statev(:, statev_u_et) = 0.0_dp
        call choose_integrator(run, system, live%state, live%steps)
        call take_stock(system, live%state, energy)
        live%energy_at_start = energy%held()
    end subroutine start_run

    !> Takes the steps that are left. `failure` of the outcome says when and why, if the run ends
    !> before its time.
    subroutine simulate(live, observers, result)
        type(simulation_run), intent(inout) :: live
        type(observer_slot), intent(inout) :: observers(:)   !! each sees what those before it found
        type(outcome), intent(out) :: result
        type(step_news) :: news
        type(step_report) :: report
        character(len=:), allocatable :: why

        call news%clear()
        live%other = live%state
        if (.not. live%resumed) call begin_all(live, observers, news)
        call live%state%use_large_pages()
        call live%other%use_large_pages()
        do while (len(live%problem) == 0 .and. .not. live%steps%finished(live%state))
            call live%steps%step(live%state, live%other, report)
            if (report%status < 0) then
                call live%steps%why_stopped(report%status, why)
                call tell_when(live, why)
                exit
            end if
            if (report%status == friction_snap_back) live%snap_backs = live%snap_backs + 1
            live%taken = live%taken + 1
            call live%steps%sums(live%state, live%other, news%sums)
            live%let_go = live%let_go + news%sums%let_go
            if (.not. live%steps%in_rates) live%let_go = live%let_go + news%sums%jumped
            live%most_work = max(live%most_work, abs(live%other%drive_work))
            call swap_states(live%state, live%other)
            news%complete = report%complete
            call show_all(live, observers, news)
            if (len(news%problem) > 0) call tell_when(live, news%problem)
        end do
        call finish_all(live, observers, news)
        call sum_up(live, result)
        result%interrupted = news%interrupted
    end subroutine simulate

    subroutine begin_all(live, observers, news)
        type(simulation_run), intent(inout) :: live
        type(observer_slot), intent(inout) :: observers(:)
        type(step_news), intent(inout) :: news
        integer :: i

        do i = 1, size(observers)
            call observers(i)%it%begin(live%state, news)
        end do
        if (len(news%problem) > 0 .and. len(live%problem) == 0) call tell_when(live, news%problem)
    end subroutine begin_all

    subroutine show_all(live, observers, news)
        type(simulation_run), intent(inout) :: live
        type(observer_slot), intent(inout) :: observers(:)
        type(step_news), intent(inout) :: news
        integer :: i

        call news%clear()
        news%steps = live%taken
        news%last = live%steps%finished(live%state)
        call live%slip_events%see(live%other, live%state, news)
        call live%chain_events%see(live%other, live%state, news)
        do i = 1, size(observers)
            call observers(i)%it%see(live%other, live%state, news)
        end do
    end subroutine show_all

    subroutine finish_all(live, observers, news)
        type(simulation_run), intent(inout) :: live
        type(observer_slot), intent(inout) :: observers(:)
        type(step_news), intent(inout) :: news
        integer :: i

        call news%clear()
        call live%chain_events%finish(live%state, news)
        do i = 1, size(observers)
            call observers(i)%it%finish(live%state, news)
        end do
        if (len(news%problem) > 0 .and. len(live%problem) == 0) call tell_when(live, news%problem)
    end subroutine finish_all

    !> Says when the run has come to its end.
    subroutine tell_when(live, why)
        type(simulation_run), intent(inout) :: live
        character(len=*), intent(in) :: why
        character(len=80) :: when

        write (when, '(3a, i0, a)') 'at time ', rounded_text(max(live%state%time, &
            live%other%time), 13, 6), ', step ', live%taken + 1, ': '
        live%problem = trim(when) // ' ' // why
    end subroutine tell_when

    subroutine sum_up(live, result)
        type(simulation_run), intent(in) :: live
        type(outcome), intent(inout) :: result

        result%failure = live%problem
        result%time = live%state%time
        result%steps = live%taken
        result%snap_backs = live%snap_backs
        result%iterations = live%steps%iterations
        result%most_iterations = live%steps%most_iterations
        result%in_rates = live%steps%in_rates
        result%rejected = live%steps%rejected
        result%onsets = live%slip_events%onsets(:live%slip_events%events)
        result%pieces = live%slip_events%pieces
        result%friction = live%slip_events%friction
        result%peak_velocity = live%slip_events%peak_velocity
        result%chain_events = live%chain_events%ended
        result%largest_moment = live%chain_events%largest_moment
        result%cut_events = live%chain_events%cut_short
        result%unresolved = live%chain_events%finder%unresolved
        call take_stock(live%steps%system, live%state, result%energy)
        result%energy%at_start = live%energy_at_start
        result%energy%dissipated = result%energy%dissipated + live%let_go
        result%energy%most_work = live%most_work
    end subroutine sum_up

    !> Reads or writes what has to be kept to go on; to read, the run must have been started.
    subroutine visit(self, file)
        class(simulation_run), intent(inout) :: self
        type(archive), intent(inout) :: file

        call self%state%visit(file)
        call self%steps%visit(file)
        call self%slip_events%visit(file)
        call self%chain_events%visit(file)
        call file%visit(self%taken, self%snap_backs, self%energy_at_start, self%let_go, &
            self%most_work)
    end subroutine visit

end module simulation
