!> The program's two verbs: check an input file, and run it.
module study
    use, intrinsic :: iso_fortran_env, only : error_unit, output_unit
    use command_line, only : command
    use namelist_input, only : namelist_file, read_namelist_file
    use picture, only : draw_picture
    use platform, only : make_directory
    use recorder, only : csv_recorder
    use run_settings, only : read_settings, settings
    use simulation, only : outcome, simulate
    use summary, only : print_summary
    implicit none
    private

    public :: check_input, run_input

    integer, parameter, public :: exit_done = 0, exit_failed = 1, exit_bad_input = 2

contains

    !> Reads and validates; says what is wrong, all of it.
    subroutine check_input(wanted, run, exit_status)
        type(command), intent(in) :: wanted
        type(settings), intent(out) :: run
        integer, intent(out) :: exit_status
        type(namelist_file) :: file
        character(len=:), allocatable :: problem

        exit_status = exit_bad_input
        call read_namelist_file(wanted%input, file, problem)
        if (len(problem) > 0) then
            write (error_unit, '(4a)') 'stickslip: ', wanted%input, ': ', problem
            return
        end if
        call read_settings(file, run)
        if (size(file%faults) > 0) then
            write (error_unit, '(a)', advance='no') file%describe_faults()
            return
        end if
        exit_status = exit_done
        if (wanted%verb /= 'check') return
        if (run%adaptive) then
            write (output_unit, '(2a)') wanted%input, ': valid, adaptive steps'
        else
            write (output_unit, '(2a, i0, a)') wanted%input, ': valid, ', run%n_steps, ' steps'
        end if
    end subroutine check_input

    !> Reads, validates, runs and reports. What has been computed stays on disk, whatever happens.
    subroutine run_input(wanted, exit_status)
        type(command), intent(in) :: wanted
        integer, intent(out) :: exit_status
        type(settings) :: run
        type(csv_recorder) :: records
        type(outcome) :: result
        character(len=:), allocatable :: problem, base

        call check_input(wanted, run, exit_status)
        if (exit_status /= exit_done) return

        exit_status = exit_bad_input
        base = wanted%output // '/' // wanted%stem
        if (.not. make_directory(wanted%output)) then
            write (error_unit, '(3a)') "stickslip: cannot write to the directory '", &
                wanted%output, "'"
            return
        end if
        call records%start(base // '.csv', base // '_events.csv')
        if (records%failed()) then
            write (error_unit, '(3a)') 'stickslip: cannot write ', base, '.csv'
            return
        end if

        call simulate(run, records, .not. wanted%quiet, result)
        call records%finish()
        if (records%failed() .and. len(result%failure) == 0) result%failure = &
            'at its end: cannot write the last rows (disk full?)'
        if (.not. wanted%quiet) call print_summary(run, result)
        exit_status = exit_done
        if (len(result%failure) > 0) then
            write (error_unit, '(4a)') 'stickslip: ', wanted%input, ': the run failed ', &
                result%failure
            write (error_unit, '(3a)') '  what was computed so far is in ', base, '.csv'
            exit_status = exit_failed
        end if
        if (.not. wanted%plot) return
        call draw_picture(wanted%output, wanted%stem, problem)
        if (len(problem) > 0) write (error_unit, '(2a)') 'stickslip: ', problem
    end subroutine run_input

end module study
