!> stickslip: a spring-slider on the friction routine that finite-element codes use.
program stickslip
    use, intrinsic :: iso_fortran_env, only : error_unit
    use check, only : check_input
    use command_line, only : command, print_help, print_version, read_command_line
    use fault_study, only : run_fault_engine
    use launcher, only : is_companion
    use platform, only : exit_program, hold_output
    use point_study, only : run_point
    use stability_study, only : stability_of_input
    use study, only : run_input
    use sweep, only : sweep_input
    use verb_common, only : exit_bad_input, exit_done
    implicit none
    type(command) :: wanted
    integer :: exit_status

    call hold_output()
    call read_command_line(wanted)
    ! The first process tells it and fails. One that failed before would have the launcher end it.
    if (is_told_once(wanted) .and. is_companion()) call exit_program(exit_done)
    if (len(wanted%problem) > 0) then
        write (error_unit, '(2a)') 'stickslip: ', wanted%problem
        call print_help(to_error=.true.)
        call exit_program(exit_bad_input)
    end if

    exit_status = exit_done
    select case (wanted%verb)
    case ('run')
        call run_input(wanted, exit_status)
    case ('point')
        call run_point(wanted, exit_status)
    case ('sweep')
        call sweep_input(wanted, exit_status)
    case ('stability')
        call stability_of_input(wanted, exit_status)
    case ('fault')
        call run_fault_engine(wanted, exit_status)
    case ('check')
        call check_input(wanted%input, exit_status)
    case ('--version')
        call print_version()
    case default
        call print_help(to_error=.false.)
    end select
    call exit_program(exit_status)

contains

    !> Have all processes that a launcher has started the same to tell? Those of other verbs than
    !> `fault` have nothing to do with each other.
    pure logical function is_told_once(wanted) result(yes)
        type(command), intent(in) :: wanted

        select case (wanted%verb)
        case ('run', 'point', 'sweep', 'stability', 'check')
            yes = .false.
        case ('fault')
            yes = len(wanted%problem) > 0
        case default
            yes = .true.
        end select
    end function is_told_once

end program stickslip
