!> The verb check: reads and validates an input of any verb, and runs nothing.
module check
    use, intrinsic :: iso_fortran_env, only : dp => real64, error_unit
    use fault_reader, only : read_fault_plan
    use fault_settings, only : fault_plan
    use fault_study, only : check_by_engine
    use input_kind, only : fitting, refuse_other_verb, verb_of
    use loading_path, only : point_run
    use namelist_input, only : namelist_file
    use number_text, only : whole_text
    use platform, only : report
    use profile_reader, only : names_netcdf
    use point_reader, only : read_point_settings
    use run_reader, only : read_settings
    use run_settings, only : settings
    use sweep_reader, only : read_sweep
    use sweep_settings, only : sweep_plan
    use table_size, only : check_table_size, expected_bytes
    use text_file, only : gigabyte
    use verb_common, only : exit_bad_input, exit_done, has_faults, is_readable
    implicit none
    private

    public :: check_input

contains

    !> Says what is wrong, all of it, or which verb the input is for. It is read once: it may come
    !> from a pipe.
    subroutine check_input(input, exit_status)
        character(len=*), intent(in) :: input
        integer, intent(out) :: exit_status
        type(namelist_file) :: file
        type(point_run) :: path
        type(sweep_plan) :: plan
        type(fault_plan) :: plane
        type(settings) :: run
        character(len=:), allocatable :: verb
        real(dp), parameter :: worth_telling = 0.1_dp   !! [GB]
        character(len=:), allocatable :: problem
        character(len=:), allocatable :: extent
        character(len=80) :: size_text
        logical :: refused

        exit_status = exit_bad_input
        if (.not. is_readable(input, file)) return
        verb = verb_of(file)
        select case (verb)
        case (fitting)
            call refuse_other_verb('check', file, refused)
            if (has_faults(file)) return
        case ('point')
            call read_point_settings(file, path)
            if (has_faults(file)) return
            extent = whole_text(nint(path%loading%increments())) // ' increments'
        case ('sweep')
            call read_sweep(file, plan)
            if (has_faults(file)) return
            extent = whole_text(size(plan%runs)) // ' combinations'
        case ('fault')
            if (names_netcdf(file)) call check_by_engine(input)
            call read_fault_plan(file, plane)
            if (has_faults(file)) return
            extent = whole_text(plane%nx) // ' x ' // whole_text(plane%nz) // ' cells'
        case default
            call read_settings(file, run)
            if (has_faults(file)) return
            extent = 'adaptive steps'
            if (.not. run%adaptive) extent = whole_text(run%n_steps) // ' steps'
            size_text = ''
            if (expected_bytes(run) > worth_telling * gigabyte) write (size_text, '(a, f0.2, a)') &
                ', tables of about ', expected_bytes(run) / gigabyte, ' GB'
            extent = extent // trim(size_text)
            call check_table_size(run, problem)
            if (len(problem) > 0) then
                write (error_unit, '(3a)') input, ': ', problem
                return
            end if
        end select
        write (report, '(5a)') input, ': valid, ', extent, ', for stickslip ', verb
        exit_status = exit_done
    end subroutine check_input

end module check
