!> Runs the slider through its programme: steps in time, rows on disk, events found, energy booked.
module simulation
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use friction_mod, only : friction_message, friction_snap_back, statev_slip
    use progress_bar, only : progress
    use recorder, only : csv_recorder
    use run_settings, only : settings
    use slider_system, only : energy_balance, initial_state, slider, slider_state
    use slip_events, only : event_finder, moment, slip_event
    use time_integrator, only : newmark, step_report
    implicit none
    private

    public :: event_totals, outcome, simulate

    !> Sums over the events of one piece of the programme.
    type :: event_totals
        integer :: events = 0, recurrences = 0
        real(dp) :: period = 0.0_dp, force_drop = 0.0_dp   !! sums; see `recurrences` and `events`
        real(dp) :: peak_velocity = 0.0_dp
    end type event_totals

    !> What a run has come to.
    type :: outcome
        character(len=:), allocatable :: failure   !! empty if the run reached its end
        integer :: steps = 0                       !! taken
        integer :: iterations = 0, most_iterations = 0
        integer :: snap_backs = 0                  !! steps that saw several equilibria
        real(dp) :: time = 0.0_dp                  !! reached [T]
        real(dp) :: peak_velocity = 0.0_dp         !! [L/T]
        type(energy_balance) :: energy
        type(event_totals), allocatable :: pieces(:)
    end type outcome

    !> A fall of the spring force counts as a slip event from this part of the static friction force
    !> on.
    real(dp), parameter :: smallest_drop = 0.01_dp

contains

    !> `failure` of the outcome says when and why, if the run ends before its time.
    subroutine simulate(run, records, show_progress, result)
        type(settings), intent(in) :: run
        type(csv_recorder), intent(inout) :: records
        logical, intent(in) :: show_progress
        type(outcome), intent(out) :: result
        type(slider) :: system
        type(newmark) :: method
        type(slider_state) :: old, new
        type(step_report) :: report
        type(event_finder) :: finder
        type(progress) :: bar
        real(dp) :: time
        integer :: k, status

        system = slider(run%mass, run%stiffness, run%damping, run%area, run%props)
        method = newmark(run%beta, run%gamma, run%tolerance, run%max_iterations)
        finder%threshold = smallest_drop * run%area * run%props(4) * maxval(run%drive%normal)
        allocate (result%pieces(size(run%drive%start)))
        result%failure = ''

        call initial_state(system, 1, run%drive%normal(1), old, status)
        if (status < 0) result%failure = 'at the start: ' // friction_message(status)
        new = old
        call record(old)
        call bar%begin(show_progress)
        do k = 1, run%n_steps
            if (len(result%failure) > 0) exit
            time = min(k * run%dt, run%t_end)
            call method%step(system, run%drive%position(time), &
                run%drive%normal(run%drive%piece(time)), time - (k - 1) * run%dt, old, new, report)
            if (report%status < 0) then
                call fail(friction_message(report%status))
                exit
            end if
            new%time = time
            if (report%status == friction_snap_back) result%snap_backs = result%snap_backs + 1
            result%steps = k
            result%iterations = result%iterations + report%iterations
            result%most_iterations = max(result%most_iterations, report%iterations)
            call system%account(old, new, result%energy)
            if (mod(k, run%interval) == 0 .or. k == run%n_steps) call record(new)
            call watch(new)
            old = new
            call bar%show(real(k, dp) / run%n_steps)
        end do
        call bar%clear()
        result%time = old%time

    contains

        subroutine record(state)
            type(slider_state), intent(in) :: state

            call records%write_state(state)
            if (records%failed()) call fail('cannot write the time series (disk full?)')
        end subroutine record

        subroutine watch(state)
            type(slider_state), intent(in) :: state
            type(slip_event) :: event
            logical :: found

            result%peak_velocity = max(result%peak_velocity, maxval(state%v))
            call finder%look(moment(state%time, state%spring(1), state%statev(statev_slip, 1), &
                state%v(1)), event, found)
            if (.not. found) return
            call add_event(result%pieces(run%drive%piece(event%onset)), event, &
                run%drive%start(run%drive%piece(event%onset)))
            call records%write_event(event, run%area)
            if (records%failed()) call fail('cannot write the events (disk full?)')
        end subroutine watch

        subroutine fail(why)
            character(len=*), intent(in) :: why
            character(len=80) :: place

            write (place, '(a, es13.6, a, i0, a)') 'at time ', min(k * run%dt, run%t_end), &
                ', step ', k, ': '
            result%failure = trim(place) // ' ' // why
        end subroutine fail

    end subroutine simulate

    !> Books an event in the piece of the programme that starts at `piece_start`. A recurrence time
    !> that began in the piece before says nothing about either.
    pure subroutine add_event(totals, event, piece_start)
        type(event_totals), intent(inout) :: totals
        type(slip_event), intent(in) :: event
        real(dp), intent(in) :: piece_start

        totals%events = totals%events + 1
        totals%force_drop = totals%force_drop + event%force_drop
        totals%peak_velocity = max(totals%peak_velocity, event%peak_velocity)
        if (event%first .or. event%onset - event%recurrence < piece_start) return
        totals%recurrences = totals%recurrences + 1
        totals%period = totals%period + event%recurrence
    end subroutine add_event

end module simulation
