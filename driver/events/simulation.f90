!> Runs the slider through its programme: steps in time, rows on disk, events found, energy booked.
module simulation
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use chain_events, only : chain_event
    use chain_settings, only : scattered
    use checkpoint, only : snapshot, write_checkpoint
    use friction_mod, only : friction_message, friction_no_convergence, friction_snap_back, &
        statev_slip
    use law_facts, only : typical_coefficient
    use platform, only : interrupted, seconds
    use progress_bar, only : progress
    use recorder, only : csv_recorder
    use run_outcome, only : event_totals, outcome
    use run_settings, only : settings
    use slider_system, only : ends_periodic, initial_state, place, slider, slider_state, swap_states
    use slip_events, only : moment, slip_event, turning_point
    use step_control, only : next_row
    use time_integrator, only : step_report
    implicit none
    private

    public :: event_totals, outcome, simulate, start_run

    !> A fall of the spring force counts as a slip event from this part of the static friction force
    !> on.
    real(dp), parameter :: smallest_drop = 0.01_dp

contains

    !> `failure` of the outcome says when and why, if the run ends before its time. With a name for
    !> checkpoints it leaves one now and then, and when it is interrupted; from that it can go on.
    subroutine simulate(run, records, show_progress, result, checkpoint_name, from)
        type(settings), intent(in) :: run
        type(csv_recorder), intent(inout) :: records
        logical, intent(in) :: show_progress
        type(outcome), intent(out) :: result
        character(len=*), intent(in), optional :: checkpoint_name
        type(snapshot), intent(in), optional :: from   !! an interrupted run of the same settings
        type(snapshot) :: live
        type(slider_state) :: new
        type(step_report) :: report
        type(progress) :: bar
        real(dp) :: last_checkpoint
        logical :: complete, paused

        paused = .false.
        if (present(from)) then
            live = from
        else
            call start_run(run, live)
            call record(live%state)
            if (run%fields > 0) call records%write_fields(live%state, live%state)
        end if
        new = live%state
        last_checkpoint = seconds()
        call bar%begin(show_progress, live%state%time / run%t_end)
        do while (.not. live%steps%finished(live%state))
            if (len(live%result%failure) > 0) exit
            call live%steps%take_step(live%state, new, report, complete)
            if (report%status < 0) then
                call fail(why_stopped(run, report%status))
                exit
            end if
            if (report%status == friction_snap_back) live%result%snap_backs = &
                live%result%snap_backs + 1
            live%result%steps = live%result%steps + 1
            if (complete) live%rows_due = live%rows_due + 1
            if (row_is_due(live%state, new)) call record(new)
            if (live%rows_due == run%interval) live%rows_due = 0
            call record_fields(live%state, new)
            call watch(live%state, new)
            if (run%chain%n_blocks > 1) call list_events(live%state, new)
            call swap_states(live%state, new)
            call bar%show(live%state%time / run%t_end)
            if (present(checkpoint_name)) call keep()
        end do
        call bar%clear()
        if (run%chain%n_blocks > 1 .and. .not. paused) call list_rest(live%state)
        call live%steps%system%take_stock(live%state, live%result%energy)
        result = live%result
        result%iterations = live%steps%iterations
        result%most_iterations = live%steps%most_iterations
        result%rejected = live%steps%rejected
        result%time = live%state%time

    contains

        pure function row_is_due(before, now) result(due)
            type(slider_state), intent(in) :: before, now
            logical :: due

            due = live%rows_due == run%interval .or. live%steps%finished(now) &
                .or. next_row(run%every, before%time) <= now%time
        end function row_is_due

        !> A checkpoint, if it is time for one.
        subroutine keep()
            integer, parameter :: steps_between_looks = 64

            if (interrupted()) then
                call write_checkpoint(checkpoint_name, run, live, records)
                paused = .true.
                call fail('interrupted; stickslip run with --resume goes on from here')
            else if (mod(live%result%steps, steps_between_looks) == 0) then
                if (seconds() - last_checkpoint < run%checkpoint) return
                call write_checkpoint(checkpoint_name, run, live, records)
                last_checkpoint = seconds()
            end if
        end subroutine keep

        subroutine record(state)
            type(slider_state), intent(in) :: state

            call records%write_state(state)
            if (records%failed()) call fail('cannot write the time series (disk full?)')
        end subroutine record

        !> The fields, if it is time for them.
        subroutine record_fields(before, now)
            type(slider_state), intent(in) :: before, now

            if (run%fields == 0) return
            live%fields_due = live%fields_due + 1
            if (live%fields_due < run%fields) return
            call records%write_fields(before, now)
            live%fields_due = 0
            if (records%failed()) call fail('cannot write the fields (disk full?)')
        end subroutine record_fields

        !> The events of a chain that have ended.
        subroutine list_events(before, now)
            type(slider_state), intent(in) :: before, now
            type(chain_event), allocatable :: ended(:)
            integer :: i

            call live%chain%look(before, now, ended)
            do i = 1, size(ended)
                call records%write_chain_event(ended(i), run%area, ended=.true.)
                live%result%chain_events = live%result%chain_events + 1
                live%result%largest_moment = max(live%result%largest_moment, &
                    run%area * ended(i)%slip)
            end do
            if (records%failed()) call fail('cannot write the events (disk full?)')
        end subroutine list_events

        !> The events of a chain that the end of the run cuts short.
        subroutine list_rest(state)
            type(slider_state), intent(in) :: state
            type(chain_event), allocatable :: rest(:)
            integer :: i

            call live%chain%give_up(size(state%x), rest)
            do i = 1, size(rest)
                call records%write_chain_event(rest(i), run%area, ended=.false.)
            end do
            live%result%cut_events = size(rest)
            if (records%failed()) call fail('cannot write the events (disk full?)')
        end subroutine list_rest

        !> Looks for slip events, at the end of a step and where the force turns within.
        subroutine watch(before, now)
            type(slider_state), intent(in) :: before, now
            type(moment) :: turn, seen_now
            logical :: found
            integer :: i

            i = run%drive%piece(before%time)
            seen_now = seen(now, i)
            call turning_point(seen(before, i), seen_now, turn, found)
            if (found .and. now%time <= run%drive%next_start(before%time)) call look(turn)
            call look(seen_now)
            live%result%peak_velocity = max(live%result%peak_velocity, maxval(now%v))
        end subroutine watch

        pure function seen(state, i) result(now)
            type(slider_state), intent(in) :: state
            integer, intent(in) :: i   !! piece of the programme
            type(moment) :: now
            real(dp) :: velocity, spring, slip   ! sums, then means over the blocks
            integer :: n, k

            n = size(state%x)
            velocity = 0.0_dp
            spring = 0.0_dp
            slip = 0.0_dp
            do k = 1, n
                velocity = velocity + state%v(k)
                spring = spring + state%spring(k)
                slip = slip + state%statev(k, statev_slip)
            end do
            velocity = velocity / n
            now = moment(state%time, spring / n, slip / n, velocity, &
                run%stiffness * (run%drive%drive_velocity(state%time, i) - velocity))
        end function seen

        subroutine look(now)
            type(moment), intent(in) :: now
            type(slip_event) :: event
            logical :: found
            integer :: i

            call live%finder%look(now, event, found)
            if (.not. found) return
            i = min(run%drive%piece(event%onset), run%drive%listed)
            call add_event(live%result%pieces(i), event, run%drive%start(i))
            live%result%onsets = [live%result%onsets, event%onset]
            if (run%chain%n_blocks == 1) call records%write_event(event, run%area)
            if (records%failed()) call fail('cannot write the events (disk full?)')
        end subroutine look

        subroutine fail(why)
            character(len=*), intent(in) :: why
            character(len=80) :: where

            write (where, '(a, es13.6, a, i0, a)') 'at time ', max(live%state%time, new%time), &
                ', step ', live%result%steps + 1, ': '
            live%result%failure = trim(where) // ' ' // why
        end subroutine fail

    end subroutine simulate

    !> A run before its first step.
    subroutine start_run(run, live)
        type(settings), intent(in) :: run
        type(snapshot), intent(out) :: live
        type(slider) :: system
        integer :: status

        system = slider(run%mass, run%stiffness, run%damping, run%area, run%props, &
            run%chain%coupling, run%chain%ends)
        if (run%chain%scatter > 0.0_dp) system%load = scattered(run%chain)
        live%chain%slip_rate = run%chain%slip_rate
        live%chain%ring = run%chain%ends == ends_periodic
        allocate (live%chain%events(16))
        live%finder%threshold = smallest_drop * run%area &
            * typical_coefficient(run%props) * run%drive%largest_normal()
        allocate (live%result%pieces(run%drive%listed), live%result%onsets(0))
        live%result%failure = ''
        call initial_state(system, run%chain%n_blocks, run%drive%normal_traction(0.0_dp, 1), &
            live%state, status)
        if (status < 0) live%result%failure = 'at the start: ' // friction_message(status)
        call place(system, run%initial, live%state)
        call system%take_stock(live%state, live%result%energy)
        live%result%energy%at_start = live%result%energy%held()
        call live%steps%begin(run, system, live%state)
    end subroutine start_run

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
        else
            why = 'Newton''s method finds no balance of forces at the end of the step: take a ' &
                // 'smaller dt, or adaptive steps (rtol)'
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
