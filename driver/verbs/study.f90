!> The program's two verbs: check an input file, and run it.
module study
    use, intrinsic :: iso_fortran_env, only : dp => real64, error_unit, output_unit
    use chain_picture, only : draw_catalogue, draw_fields
    use checkpoint, only : checkpoint_writer, read_checkpoint
    use command_line, only : command
    use field_file, only : netcdf_available
    use namelist_input, only : namelist_file
    use picture, only : draw_picture
    use platform, only : remove_file, seconds, watch_for_interrupts
    use progress_observer, only : progress_watch
    use recorder, only : csv_recorder, most_in_csv
    use run_observer, only : observer_slot
    use run_outcome, only : outcome
    use run_reader, only : read_settings
    use run_settings, only : settings
    use simulation, only : simulate, simulation_run, start_run
    use summary, only : print_event_times, print_summary
    use sweep_reader, only : read_sweep
    use sweep_settings, only : sweep_plan
    use verb_common, only : directory_is_ready, exit_bad_input, exit_done, exit_failed, &
        is_readable, tell_failure
    implicit none
    private

    public :: check_input, run_input

contains

    !> Reads and validates; says what is wrong, all of it.
    subroutine check_input(wanted, run, exit_status)
        type(command), intent(in) :: wanted
        type(settings), intent(out) :: run
        integer, intent(out) :: exit_status
        type(namelist_file) :: file
        type(sweep_plan) :: plan
        logical :: swept

        exit_status = exit_bad_input
        if (.not. is_readable(wanted%input, file)) return
        swept = .false.
        if (wanted%verb == 'check') swept = file%has_group('sweep')
        if (swept) then
            call read_sweep(file, plan)
        else
            call read_settings(file, run)
            if (run%fields > 0 .and. run%chain%n_blocks > most_in_csv .and. &
                .not. netcdf_available) call file%reject('output', 'fields', 'of more than 1000 ' &
                // 'blocks needs NetCDF, which this program was built without')
        end if
        if (size(file%faults) > 0) then
            write (error_unit, '(a)', advance='no') file%describe_faults()
            if (file%has_group('point')) call tell_verb('point', wanted%input)
            if (.not. swept .and. file%has_group('sweep')) call tell_verb('sweep', wanted%input)
            return
        end if
        exit_status = exit_done
        if (wanted%verb /= 'check') return
        if (swept) then
            write (output_unit, '(2a, i0, a)') wanted%input, ': valid, ', size(plan%runs), &
                ' combinations'
        else if (run%adaptive) then
            write (output_unit, '(2a)') wanted%input, ': valid, adaptive steps'
        else
            write (output_unit, '(2a, i0, a)') wanted%input, ': valid, ', run%n_steps, ' steps'
        end if
    end subroutine check_input

    !> An input of another verb was given.
    subroutine tell_verb(verb, input)
        character(len=*), intent(in) :: verb, input

        write (error_unit, '(6a)') 'stickslip: for the group &', verb, ': stickslip ', verb, ' ', &
            input
    end subroutine tell_verb

    !> Reads, validates, runs and reports. What has been computed stays on disk, whatever happens.
    subroutine run_input(wanted, exit_status)
        type(command), intent(in) :: wanted
        integer, intent(out) :: exit_status
        type(settings), target :: run
        type(simulation_run), target :: live
        type(csv_recorder), target :: records
        type(outcome) :: result
        character(len=:), allocatable :: problem, base

        call check_input(wanted, run, exit_status)
        if (exit_status /= exit_done) return

        exit_status = exit_bad_input
        base = wanted%output // '/' // wanted%stem
        if (.not. directory_is_ready(wanted%output)) return
        call start_run(run, live)
        call records%prepare(run, base)
        if (wanted%resume) then
            call read_checkpoint(base // '.checkpoint', run, live, records, problem)
            if (len(problem) > 0) then
                write (error_unit, '(2a)') 'stickslip: cannot resume: ', problem
                return
            end if
        else
            call records%open()
        end if
        if (records%failed()) then
            write (error_unit, '(3a)') 'stickslip: cannot write ', base, '.csv'
            return
        end if

        call watch_for_interrupts()
        call watched_run(wanted, base, run, live, records, result)
        if (.not. wanted%quiet) call print_summary(run, result, base // '.csv')
        if (len(result%failure) == 0) call remove_file(base // '.checkpoint')
        if (wanted%verify .and. len(result%failure) == 0) call verify_events(run, result)
        exit_status = exit_done
        if (len(result%failure) > 0) then
            call tell_failure(wanted%input, result%failure, base)
            exit_status = exit_failed
        end if
        if (wanted%plot .and. .not. result%interrupted) call draw_pictures(wanted, run, result)
    end subroutine run_input

    !> Simulates with all that watches: files, checkpoints, the progress bar.
    subroutine watched_run(wanted, base, run, live, records, result)
        type(command), intent(in) :: wanted
        character(len=*), intent(in) :: base
        type(settings), target, intent(inout) :: run
        type(simulation_run), target, intent(inout) :: live
        type(csv_recorder), target, intent(inout) :: records
        type(outcome), intent(out) :: result
        type(checkpoint_writer), target :: checkpoints
        type(progress_watch), target :: bar
        type(observer_slot) :: observers(3)

        checkpoints%name = base // '.checkpoint'
        checkpoints%run => run
        checkpoints%live => live
        checkpoints%records => records
        checkpoints%last = seconds()
        call bar%prepare(.not. wanted%quiet, live%state%time, run%t_end)
        observers(1)%it => records
        observers(2)%it => bar
        observers(3)%it => checkpoints
        call simulate(live, observers, result)
    end subroutine watched_run

    subroutine draw_pictures(wanted, run, result)
        type(command), intent(in) :: wanted
        type(settings), intent(in) :: run
        type(outcome), intent(in) :: result
        character(len=:), allocatable :: problem

        call draw_picture(wanted%output, wanted%stem, problem)
        if (len(problem) == 0 .and. result%chain_events > 0) call draw_catalogue(wanted%output, &
            wanted%stem, problem)
        if (len(problem) == 0 .and. run%fields > 0 .and. run%chain%n_blocks <= most_in_csv) then
            call draw_fields(wanted%output, wanted%stem, run%chain%slip_rate, problem)
        end if
        if (len(problem) > 0) write (error_unit, '(2a)') 'stickslip: ', problem
    end subroutine draw_pictures

    !> A second run, at a tenth of the tolerance or half of the step, that leaves no files: how far
    !> its events are from those of the first is about the error of these.
    subroutine verify_events(run, result)
        type(settings), intent(in) :: run
        type(outcome), intent(in) :: result
        type(settings) :: tighter
        type(outcome) :: reference
        type(simulation_run) :: live
        type(observer_slot) :: nobody(0)

        tighter = run
        if (run%adaptive) then
            tighter%rtol = 0.1_dp * run%rtol
        else
            tighter%dt = 0.5_dp * run%dt
        end if
        call start_run(tighter, live)
        call simulate(live, nobody, reference)
        if (len(reference%failure) > 0) then
            write (error_unit, '(2a)') 'stickslip: the tighter run failed ', reference%failure
        else
            call print_event_times(result%onsets, reference%onsets)
        end if
    end subroutine verify_events

end module study
