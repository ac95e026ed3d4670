!> The verb `fault`: hands over to the fault engine, a program of its own beside this one.
module fault_study
    use, intrinsic :: iso_fortran_env, only : error_unit
    use command_line, only : command
    use launcher, only : is_companion
    use platform, only : program_beside, replace_program
    use verb_common, only : exit_done, exit_failed
    implicit none
    private

    public :: check_by_engine, run_fault_engine

contains

    !> Has the engine check an input with files that it alone reads. Returns only if there is none.
    subroutine check_by_engine(input)
        character(len=*), intent(in) :: input
        character(len=max(len(input), 5)) :: arguments(4)

        arguments = ''
        arguments(1) = input
        arguments(4) = 'check'
        call replace_program(program_beside('stickslip-fault'), arguments)
    end subroutine check_by_engine

    !> Returns only if there is no engine.
    subroutine run_fault_engine(wanted, exit_status)
        type(command), intent(in) :: wanted
        integer, intent(out) :: exit_status
        character(len=:), allocatable :: engine, options
        character(len=max(len(wanted%input), len(wanted%output), len(wanted%stem), 40)) :: &
            arguments(4)

        engine = program_beside('stickslip-fault')
        options = 'options'
        if (wanted%resume) options = options // ' resume'
        if (wanted%quiet) options = options // ' quiet'
        if (.not. wanted%plot) options = options // ' no-plot'
        arguments = [character(len=len(arguments)) :: wanted%input, wanted%output, wanted%stem, &
            options]
        call replace_program(engine, arguments)
        exit_status = exit_done
        if (is_companion()) return   ! the first process tells it, and fails
        write (error_unit, '(2a)') 'stickslip: there is no fault engine ', engine
        write (error_unit, '(a)') &
            '  it is built where CMake finds FFTW; for several processes, MPI and FFTW for it.', &
            '  Debian: apt-get install libfftw3-dev libfftw3-mpi-dev libopenmpi-dev openmpi-bin', &
            '  then build again: docs/fault.md'
        exit_status = exit_failed
    end subroutine run_fault_engine

end module fault_study
