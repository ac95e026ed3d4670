!> Runs the slider through its programme: steps in time, rows on disk, events found, energy booked.
module simulation
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use friction_mod, only : friction_message, friction_no_convergence, friction_snap_back, &
        statev_slip
    use progress_bar, only : progress
    use recorder, only : csv_recorder
    use run_settings, only : settings
    use slider_system, only : energy_balance, initial_state, place, slider, slider_state
    use slip_events, only : event_finder, moment, slip_event, turning_point
    use step_control, only : stepper
    use time_integrator, only : step_report
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
        integer :: rejected = 0                    !! steps tried in vain
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
        type(stepper) :: steps
        type(slider_state) :: old, new
        type(step_report) :: report
        type(event_finder) :: finder
        type(progress) :: bar
        logical :: complete
        integer :: status, rows_due

        system = slider(run%mass, run%stiffness, run%damping, run%area, run%props)
        finder%threshold = smallest_drop * run%area * run%props(4) * run%drive%largest_normal()
        allocate (result%pieces(run%drive%listed))
        result%failure = ''

        call initial_state(system, 1, run%drive%normal_traction(0.0_dp, 1), old, status)
        if (status < 0) result%failure = 'at the start: ' // friction_message(status)
        call place(system, run%initial, old)
        result%energy%at_start = system%stored(old)
        call steps%begin(run, system, old)
        new = old
        rows_due = 0
        call record(old)
        call bar%begin(show_progress)
        do while (.not. steps%finished(old))
            if (len(result%failure) > 0) exit
            call steps%take_step(old, new, report, complete)
            if (report%status < 0) then
                call fail(why_stopped(run, report%status))
                exit
            end if
            if (report%status == friction_snap_back) result%snap_backs = result%snap_backs + 1
            result%steps = result%steps + 1
            if (complete) rows_due = rows_due + 1
            if (run%adaptive) then
                call system%account(old, new, result%energy, steps%middle)
            else
                call system%account(old, new, result%energy)
            end if
            if (rows_due == run%interval .or. steps%finished(new)) call record(new)
            if (rows_due == run%interval) rows_due = 0
            call watch(old, new)
            old = new
            call bar%show(old%time / run%t_end)
        end do
        result%iterations = steps%iterations
        result%most_iterations = steps%most_iterations
        result%rejected = steps%rejected
        call bar%clear()
        result%time = old%time

    contains

        subroutine record(state)
            type(slider_state), intent(in) :: state

            call records%write_state(state)
            if (records%failed()) call fail('cannot write the time series (disk full?)')
        end subroutine record

        !> Looks for slip events, at the end of a step and where the force turns within.
        subroutine watch(before, now)
            type(slider_state), intent(in) :: before, now
            type(moment) :: turn
            logical :: found
            integer :: i

            i = run%drive%piece(before%time)
            call turning_point(seen(before, i), seen(now, i), turn, found)
            if (found .and. now%time <= run%drive%next_start(before%time)) call look(turn)
            call look(seen(now, i))
            result%peak_velocity = max(result%peak_velocity, maxval(now%v))
        end subroutine watch

        pure function seen(state, i) result(now)
            type(slider_state), intent(in) :: state
            integer, intent(in) :: i   !! piece of the programme
            type(moment) :: now

            now = moment(state%time, state%spring(1), state%statev(statev_slip, 1), state%v(1), &
                run%stiffness * (run%drive%drive_velocity(state%time, i) - state%v(1)))
        end function seen

        subroutine look(now)
            type(moment), intent(in) :: now
            type(slip_event) :: event
            logical :: found
            integer :: i

            call finder%look(now, event, found)
            if (.not. found) return
            i = min(run%drive%piece(event%onset), run%drive%listed)
            call add_event(result%pieces(i), event, run%drive%start(i))
            call records%write_event(event, run%area)
            if (records%failed()) call fail('cannot write the events (disk full?)')
        end subroutine look

        subroutine fail(why)
            character(len=*), intent(in) :: why
            character(len=80) :: where

            write (where, '(a, es13.6, a, i0, a)') 'at time ', new%time, ', step ', &
                result%steps + 1, ': '
            result%failure = trim(where) // ' ' // why
        end subroutine fail

    end subroutine simulate

    !> What stands behind a step that cannot be taken.
    pure function why_stopped(run, status) result(why)
        type(settings), intent(in) :: run
        integer, intent(in) :: status
        character(len=:), allocatable :: why

        why = friction_message(status)
        if (status /= friction_no_convergence) return
        if (run%mass <= 0.0_dp) then
            why = 'the slider is unstable without inertia: friction falls faster than the spring ' &
                // 'unloads. Give it a mass to see the jump, or a stiffer spring'
        else if (run%adaptive) then
            why = 'not within the tolerance by steps as short as dt_min'
        end if
    end function why_stopped

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
