!> A run of the fault from its start, or from a checkpoint, to its end.
module fault_run
    use, intrinsic :: iso_fortran_env, only : dp => real64, error_unit, int64
    use fault_checkpoint, only : read_checkpoint, write_checkpoint
    use fault_energy, only : energies
    use fault_events, only : event_watch
    use fault_fields, only : fault_field_file
    use fault_explicit, only : explicit_steps
    use fault_implicit, only : implicit_steps
    use fault_problem, only : fault, fault_state, step_start
    use fault_recorder, only : recorder
    use fault_settings, only : fault_plan
    use fault_stepper, only : stepper
    use number_text, only : rounded_text, six_digits
    use platform, only : interrupted, remove_file, report, seconds
    use processes, only : team
    use progress_bar, only : progress
    use text_file, only : gigabyte
    implicit none
    private

    public :: run_fault

    integer, parameter :: steps_between_looks = 16   !! at the clock
    character(len=*), parameter :: tables_are_full = &
        'the tables have reached &output table_limit: use --resume with a larger limit'
    integer, parameter :: own_numbers = 17           !! of a checkpoint's header

    !> All that a run is made of.
    type :: live_run
        type(fault) :: here
        type(fault_state) :: state
        class(stepper), allocatable :: steps
        type(event_watch) :: watch
        type(recorder) :: records
        type(fault_field_file) :: fields
        character(len=:), allocatable :: base    !! of the files' names, with the directory
    end type live_run

contains

    !> `problem` is empty unless the run failed or was interrupted; it is the same on all processes.
    subroutine run_fault(plan, together, base, resume, quiet, problem)
        type(fault_plan), intent(in) :: plan
        type(team), intent(inout) :: together
        character(len=*), intent(in) :: base
        logical, intent(in) :: resume, quiet
        character(len=:), allocatable, intent(out) :: problem
        type(live_run), allocatable :: live
        real(dp) :: begun, most_slip
        logical :: sound

        allocate (live)
        live%base = base
        begun = seconds()
        call live%here%create(plan, together)
        call live%records%prepare(live%here, together, base)
        if (plan%explicit) then
            allocate (explicit_steps :: live%steps)
        else
            allocate (implicit_steps :: live%steps)
        end if
        call live%steps%start(live%here, together, live%state, problem)
        if (len(problem) > 0) return
        call live%watch%start(live%here, together, live%state)
        if (resume) call take_checkpoint(live, together, problem)
        if (len(problem) > 0) return
        if (together%rank == 0) call warn(live%here)
        call live%steps%begin(live%here, together, live%state, sound)
        if (.not. sound) then
            problem = 'no slip rate is found for the state at the start'
            return
        end if
        if (.not. resume) then
            call live%records%create(live%here)
            live%watch%largest_rate = together%largest(maxval(live%state%rate))
            call live%records%begin(live%here, together, live%state, live%watch)
            if (plan%fields > 0) then
                call live%fields%prepare(live%here, base)
                call live%fields%write_record(live%here, together, live%state)
            end if
            call leave_checkpoint(live, together, problem)   ! a launcher may give no time for one
        end if
        call go(live, together, quiet, problem)
        call live%records%finish()
        if (together%any_of(live%records%failed()) .and. len(problem) == 0) then
            problem = 'cannot write to ' // base // '_*.csv (disk full?)'
        end if
        if (plan%fields > 0) call live%fields%save(live%here, together)
        if (live%fields%parts%failed .and. len(problem) == 0) problem = 'cannot write to ' // base &
            // '_fields* (disk full?)'
        most_slip = together%largest(maxval(live%state%slip))
        live%state%energy%elastic = live%here%elastic_energy(together, live%state)
        if (together%rank == 0 .and. len(problem) == 0) then
            call remove_file(base // '.checkpoint')
            if (.not. quiet) call print_summary(live, most_slip, seconds() - begun)
            call warn_of_energy(live%state%energy)
            if (live%watch%on) write (error_unit, '(3a)') 'stickslip: warning: an event is ' &
                // 'still in progress at t_end: it is not in ', base, '_events.csv'
        end if
        call live%here%surroundings%free()
    end subroutine run_fault

    !> Steps to the end.
    subroutine go(live, together, quiet, problem)
        type(live_run), intent(inout) :: live
        type(team), intent(in) :: together
        logical, intent(in) :: quiet
        character(len=:), allocatable, intent(inout) :: problem
        type(progress) :: bar
        real(dp) :: last
        logical :: sound, ended

        associate (plan => live%here%plan, state => live%state, records => live%records)
            call bar%begin(together%rank == 0 .and. .not. quiet, state%time / plan%t_end, &
                by_lines=together%members > 1)
            last = seconds()
            do while (state%time < plan%t_end .and. len(problem) == 0)
                records%before = step_start(time=state%time, slip=state%slip, rate=state%rate)
                call live%steps%step(live%here, together, state, sound)
                if (.not. sound) then
                    problem = 'at time ' // six_digits(state%time) // ': no step is short enough'
                    exit
                end if
                call live%watch%see(live%here, together, records%before, state, ended)
                call records%see(live%here, together, state, live%watch, ended)
                if (records%full) then   ! within the step: the checkpoint is one before it
                    problem = tables_are_full
                    exit
                end if
                if (plan%fields > 0) then
                    if (mod(state%steps, int(plan%fields, int64)) == 0) call &
                        live%fields%write_record(live%here, together, state)
                end if
                call bar%show(state%time / plan%t_end)
                call look(live, together, last, problem)
            end do
            call bar%clear()
            if (len(problem) > 0) call records%show_last(live%here, together, state, live%watch)
        end associate
    end subroutine go

    !> Is it time for a checkpoint, or to stop?
    subroutine look(live, together, last, problem)
        type(live_run), intent(inout) :: live
        type(team), intent(in) :: together
        real(dp), intent(inout) :: last   !! clock at the last checkpoint
        character(len=:), allocatable, intent(inout) :: problem
        logical :: stop_now, full

        full = sum(live%records%sizes()) + real(live%fields%bytes(live%here), dp) > gigabyte &
            * live%here%plan%table_limit   ! the first process knows
        stop_now = together%any_of(full .or. interrupted())
        if (.not. stop_now) then
            if (mod(live%state%steps, int(steps_between_looks, int64)) /= 0) return
            if (.not. together%any_of(together%rank == 0 .and. seconds() - last &
                >= live%here%plan%checkpoint)) return
        end if
        last = seconds()
        call leave_checkpoint(live, together, problem)
        if (len(problem) > 0 .or. .not. stop_now) return
        full = together%any_of(full)
        problem = 'interrupted; stickslip fault with --resume goes on from here'
        if (full) problem = tables_are_full
    end subroutine look

    subroutine leave_checkpoint(live, together, problem)
        type(live_run), intent(inout) :: live
        type(team), intent(in) :: together
        character(len=:), allocatable, intent(inout) :: problem
        real(dp) :: header(own_numbers + size(live%records%sizes()))
        real(dp), allocatable :: columns(:, :)
        integer :: n
        logical :: done

        call live%records%flush_all()
        if (live%here%plan%fields > 0) call live%fields%save(live%here, together)
        if (live%fields%parts%failed) then
            problem = 'cannot write to ' // live%base // '_fields* (disk full?)'
            return
        end if
        if (together%any_of(live%records%failed())) then
            problem = 'cannot write to ' // live%base // '_*.csv (disk full?)'
            return
        end if
        associate (state => live%state, watch => live%watch, event => live%watch%event)
            header = 0.0_dp
            header(14) = real(live%fields%parts%records, dp)
            header(15:17) = [state%energy%loading, state%energy%dissipated, state%energy%radiated]
            header(:13) = [state%time, state%dt, real(state%steps, dp), real(state%rejected, dp), &
                merge(1.0_dp, 0.0_dp, watch%on), real(watch%events, dp), watch%largest_rate, &
                event%onset, event%peak_rate, real(event%first_cell, dp), &
                live%records%next_contour, state%error, 0.0_dp]
            n = live%steps%columns()
            allocate (columns(live%here%n, n + 2))
            call live%steps%keep(state, columns(:, :n), header(13))
            columns(:, n + 1) = watch%slip_before
            columns(:, n + 2) = watch%took_part
            header(own_numbers + 1:) = live%records%sizes()
            call together%share(header)   ! lengths of files are the first process's
            call write_checkpoint(live%base // '.checkpoint', together, live%here%part, &
                live%here%plan%fingerprint, header, columns, done)
        end associate
        if (.not. done) problem = 'cannot write ' // live%base // '.checkpoint (disk full?)'
    end subroutine leave_checkpoint

    subroutine take_checkpoint(live, together, problem)
        type(live_run), intent(inout) :: live
        type(team), intent(in) :: together
        character(len=:), allocatable, intent(inout) :: problem
        real(dp) :: header(own_numbers + size(live%records%sizes())), &
            columns(live%here%n, live%steps%columns() + 2)
        integer :: n

        call read_checkpoint(live%base // '.checkpoint', together, live%here%part, &
            live%here%plan%fingerprint, header, columns, problem)
        if (len(problem) > 0) return
        associate (state => live%state, watch => live%watch, event => live%watch%event)
            state%time = header(1)
            state%dt = header(2)
            state%steps = int(header(3), int64)
            state%rejected = int(header(4), int64)
            watch%on = header(5) > 0.0_dp
            watch%events = int(header(6))
            watch%largest_rate = header(7)
            event%onset = header(8)
            event%peak_rate = header(9)
            event%first_cell = int(header(10), int64)
            live%records%next_contour = header(11)
            state%error = header(12)
            state%energy = energies(loading=header(15), dissipated=header(16), radiated=header(17))
            n = live%steps%columns()
            call live%steps%take(state, columns(:, :n), header(13))
            watch%slip_before = columns(:, n + 1)
            watch%took_part = columns(:, n + 2)
        end associate
        if (live%here%plan%fields > 0) call live%fields%go_on(live%here, together, live%base, &
            int(header(14), int64))
        if (live%fields%parts%failed) then
            problem = 'the files ' // live%base // '_fields*'
        else
            call live%records%go_on(header(own_numbers + 1:))
            if (together%any_of(live%records%failed())) problem = 'the files ' // live%base &
                // '_*.csv'
        end if
        if (len(problem) > 0) problem = problem &
            // ' are not those that the checkpoint goes on with'
    end subroutine take_checkpoint

    !> What makes results doubtful, on standard error.
    subroutine warn(here)
        type(fault), intent(in) :: here
        real(dp), parameter :: least_cells = 3.0_dp
        real(dp) :: cell

        cell = here%plan%dz()
        if (here%plan%nx > 1) cell = max(cell, here%plan%dx())
        if (here%cohesive_length < least_cells * cell) write (error_unit, '(5a, f0.1, a)') &
            'stickslip: warning: cells of ', six_digits(cell), ' do not resolve the cohesive ' &
            // 'length of ', six_digits(here%cohesive_length), ': use ', least_cells, &
            ' or more cells per cohesive length'
    end subroutine warn

    subroutine warn_of_energy(energy)
        type(energies), intent(in) :: energy
        real(dp), parameter :: allowed = 0.02_dp

        if (energy%unbalanced() > allowed) write (error_unit, '(a, f0.1, a)') &
            'stickslip: warning: the energy balance has an error of ', 100.0_dp &
            * energy%unbalanced(), ' %: use a smaller rtol'
    end subroutine warn_of_energy

    subroutine print_summary(live, most_slip, elapsed)
        type(live_run), intent(in) :: live
        real(dp), intent(in) :: most_slip
        real(dp), intent(in) :: elapsed   !! [s]

        write (report, '(a, i0, a, i0, a)') 'steps          ', live%state%steps, ' (', &
            live%state%rejected, ' rejected)'
        write (report, '(a, i0)') 'events         ', live%watch%events
        write (report, '(2a)') 'largest slip   ', six_digits(most_slip)
        associate (energy => live%state%energy)
            write (report, '(8a)') 'energy         loading ', six_digits(energy%loading), &
                ' = elastic ', six_digits(energy%elastic), ' + dissipated ', &
                six_digits(energy%dissipated), ' + radiated ', six_digits(energy%radiated)
            write (report, '(3a)') '               error ', &
                trim(adjustl(rounded_text(energy%unbalanced(), 8, 1))), ' of the largest term'
        end associate
        write (report, '(2a)') 'wall clock, s  ', six_digits(elapsed)
        write (report, '(3a)') 'results        ', live%base, '_events.csv, _global.csv and others'
    end subroutine print_summary

end module fault_run
