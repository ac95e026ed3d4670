!> The verb run: simulates what an input file describes, and reports.
module study
    use, intrinsic :: iso_fortran_env, only : dp => real64, error_unit
    use block_table, only : block_columns, write_blocks
    use checkpoint, only : checkpoint_writer, read_checkpoint
    use command_line, only : command
    use namelist_input, only : namelist_file
    use piece_table, only : write_pieces
    use platform, only : remove_file, seconds, watch_for_interrupts
    use progress_observer, only : progress_watch
    use recorder, only : csv_recorder
    use result_files, only : of_run, remove_results
    use run_observer, only : observer_slot
    use run_outcome, only : outcome
    use run_pictures, only : draw_blocks, draw_catalogue, draw_fields, draw_run
    use run_reader, only : read_settings
    use run_settings, only : settings
    use simulation, only : simulate, simulation_run, start_run
    use summary, only : print_event_times, print_summary, print_warnings
    use table_size, only : check_table_size
    use verb_common, only : directory_is_ready, exit_bad_input, has_faults, is_for, tell_failure
    implicit none
    private

    public :: run_input

contains

    !> Reads, validates, runs and reports. What has been computed stays on disk, whatever happens.
    subroutine run_input(wanted, exit_status)
        type(command), intent(in) :: wanted
        integer, intent(out) :: exit_status
        type(settings), target :: run
        type(simulation_run), target :: live
        type(csv_recorder), target :: records
        type(outcome) :: result
        type(namelist_file) :: file
        character(len=:), allocatable :: problem, base
        logical :: written

        exit_status = exit_bad_input
        if (.not. is_for('run', wanted%input, file)) return
        call read_settings(file, run)
        if (has_faults(file)) return
        call check_table_size(run, problem)
        if (len(problem) > 0) then
            write (error_unit, '(3a)') wanted%input, ': ', problem
            return
        end if
        base = wanted%output // '/' // wanted%stem
        if (.not. directory_is_ready(wanted%output, wanted%stem, file)) return
        call start_run(run, live)
        call records%prepare(run, base)
        if (wanted%resume) then
            call read_checkpoint(base // '.checkpoint', run, live, records, problem)
            if (len(problem) > 0) then
                write (error_unit, '(2a)') 'stickslip: cannot resume: ', problem
                return
            end if
        else
            call remove_results(base, of_run)
            call records%open()
        end if
        call write_blocks(base, run, written)
        if (records%failed() .or. .not. written) then
            write (error_unit, '(3a)') 'stickslip: cannot write ', base, '.csv'
            return
        end if

        call watch_for_interrupts()
        call watched_run(wanted, base, run, live, records, result)
        if (.not. wanted%quiet) call print_summary(run, result, base // '.csv')
        call print_warnings(wanted%input, run, result)
        if (len(result%failure) == 0) call remove_file(base // '.checkpoint')
        if (wanted%verify .and. len(result%failure) == 0) call verify_events(run, result)
        call tell_failure(wanted%input, result%failure, base, exit_status)
        if (wanted%plot .and. .not. result%interrupted) call draw_pictures(wanted, run, &
            records%picture_file(), result)
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
        logical :: written

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
        call write_pieces(base // '_pieces.csv', run, result, written)
        if (.not. written .and. len(result%failure) == 0) result%failure = &
            'at its end: cannot write the table of pieces (disk full?)'
    end subroutine watched_run

    subroutine draw_pictures(wanted, run, file, result)
        type(command), intent(in) :: wanted
        type(settings), intent(in) :: run
        character(len=*), intent(in) :: file   !! with the time series
        type(outcome), intent(in) :: result
        character(len=:), allocatable :: problem

        call draw_run(run, wanted%output, wanted%stem, file, problem)
        if (len(problem) == 0 .and. result%chain_events > 0) call draw_catalogue(run, &
            wanted%output, wanted%stem, problem)
        if (len(problem) == 0 .and. run%fields > 0) call draw_fields(run, wanted%output, &
            wanted%stem, problem)
        if (len(problem) == 0 .and. size(block_columns(run)) > 0) call draw_blocks(run, &
            wanted%output, wanted%stem, problem)
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
        type(observer_slot) :: no_observers(0)

        tighter = run
        if (run%adaptive) then
            tighter%rtol = 0.1_dp * run%rtol
        else
            tighter%dt = 0.5_dp * run%dt
        end if
        call start_run(tighter, live)
        call simulate(live, no_observers, reference)
        if (len(reference%failure) > 0) then
            write (error_unit, '(2a)') 'stickslip: the tighter run failed ', reference%failure
        else
            call print_event_times(result%onsets, reference%onsets)
        end if
    end subroutine verify_events

end module study
