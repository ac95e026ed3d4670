!> The program's two verbs: check an input file, and run it.
module study
    use, intrinsic :: iso_fortran_env, only : dp => real64, error_unit, int64, output_unit
    use chain_picture, only : draw_catalogue, draw_fields
    use checkpoint, only : read_checkpoint, snapshot
    use command_line, only : command
    use field_file, only : netcdf_available
    use namelist_input, only : namelist_file, read_namelist_file
    use picture, only : draw_picture
    use platform, only : make_directory, remove_file, watch_for_interrupts
    use recorder, only : csv_recorder, most_in_csv
    use run_reader, only : read_settings
    use run_settings, only : settings
    use simulation, only : outcome, simulate, start_run
    use summary, only : print_event_times, print_summary
    use sweep_reader, only : read_sweep
    use sweep_settings, only : sweep_plan
    implicit none
    private

    public :: check_input, directory_is_ready, is_readable, run_input, tell_failure

    integer, parameter, public :: exit_done = 0, exit_failed = 1, exit_bad_input = 2

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

    !> Reads a file, or says why it cannot be read.
    function is_readable(name, file) result(readable)
        character(len=*), intent(in) :: name
        type(namelist_file), intent(out) :: file
        logical :: readable
        character(len=:), allocatable :: problem

        call read_namelist_file(name, file, problem)
        readable = len(problem) == 0
        if (.not. readable) write (error_unit, '(4a)') 'stickslip: ', name, ': ', problem
    end function is_readable

    !> Makes the directory of the output, or says that it cannot be written to.
    function directory_is_ready(name) result(ready)
        character(len=*), intent(in) :: name
        logical :: ready

        ready = make_directory(name)
        if (.not. ready) write (error_unit, '(3a)') &
            "stickslip: cannot write to the directory '", name, "'"
    end function directory_is_ready

    subroutine tell_failure(input, failure, base)
        character(len=*), intent(in) :: input, failure
        character(len=*), intent(in) :: base   !! of the names of the files that were written

        write (error_unit, '(4a)') 'stickslip: ', input, ': the run failed ', failure
        write (error_unit, '(3a)') '  what was computed so far is in ', base, '.csv'
    end subroutine tell_failure

    !> Reads, validates, runs and reports. What has been computed stays on disk, whatever happens.
    subroutine run_input(wanted, exit_status)
        type(command), intent(in) :: wanted
        integer, intent(out) :: exit_status
        type(settings) :: run
        type(csv_recorder) :: records
        type(outcome) :: result
        type(snapshot) :: from
        character(len=:), allocatable :: problem, base, fields
        integer(int64) :: bytes(3)
        integer :: rows

        call check_input(wanted, run, exit_status)
        if (exit_status /= exit_done) return

        exit_status = exit_bad_input
        base = wanted%output // '/' // wanted%stem
        fields = ''
        if (run%fields > 0) fields = base // '_fields.csv'
        if (run%fields > 0 .and. run%chain%n_blocks > most_in_csv) fields = base // '_fields.nc'
        if (.not. directory_is_ready(wanted%output)) return
        if (wanted%resume) then
            call start_run(run, from)
            call read_checkpoint(base // '.checkpoint', run, from, rows, bytes, problem)
            if (len(problem) > 0) then
                write (error_unit, '(2a)') 'stickslip: cannot resume: ', problem
                return
            end if
            call records%go_on(base // '.csv', base // '_events.csv', fields, rows, bytes)
        else
            call records%start(base // '.csv', base // '_events.csv', run%chain%n_blocks, &
                fields)
        end if
        if (records%failed()) then
            write (error_unit, '(3a)') 'stickslip: cannot write ', base, '.csv'
            return
        end if

        call watch_for_interrupts()
        if (wanted%resume) then
            call simulate(run, records, .not. wanted%quiet, result, base // '.checkpoint', from)
        else
            call simulate(run, records, .not. wanted%quiet, result, base // '.checkpoint')
        end if
        call records%finish()
        if (records%failed() .and. len(result%failure) == 0) result%failure = &
            'at its end: cannot write the last rows (disk full?)'
        if (.not. wanted%quiet) call print_summary(run, result, base // '.csv')
        if (len(result%failure) == 0) call remove_file(base // '.checkpoint')
        if (wanted%verify .and. len(result%failure) == 0) call verify_events(run, result)
        exit_status = exit_done
        if (len(result%failure) > 0) then
            call tell_failure(wanted%input, result%failure, base)
            exit_status = exit_failed
        end if
        if (.not. wanted%plot) return
        call draw_picture(wanted%output, wanted%stem, problem)
        if (len(problem) == 0 .and. result%chain_events > 0) call draw_catalogue(wanted%output, &
            wanted%stem, problem)
        if (len(problem) == 0 .and. index(fields, '.csv') > 0) call draw_fields(wanted%output, &
            wanted%stem, run%chain%slip_rate, problem)
        if (len(problem) > 0) write (error_unit, '(2a)') 'stickslip: ', problem
    end subroutine run_input

    !> A second run, at a tenth of the tolerance or half of the step, that leaves no files: how far
    !> its events are from those of the first is about the error of these.
    subroutine verify_events(run, result)
        type(settings), intent(in) :: run
        type(outcome), intent(in) :: result
        type(settings) :: tighter
        type(outcome) :: reference
        type(csv_recorder) :: nowhere

        tighter = run
        if (run%adaptive) then
            tighter%rtol = 0.1_dp * run%rtol
        else
            tighter%dt = 0.5_dp * run%dt
        end if
        call nowhere%start('/dev/null', '/dev/null', 1, '')
        tighter%fields = 0
        call simulate(tighter, nowhere, .false., reference)
        call nowhere%finish()
        if (len(reference%failure) > 0) then
            write (error_unit, '(2a)') 'stickslip: the tighter run failed ', reference%failure
        else
            call print_event_times(result%onsets, reference%onsets)
        end if
    end subroutine verify_events

end module study
