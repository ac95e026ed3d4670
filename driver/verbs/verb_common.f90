!> What all verbs share: exit statuses, an input that can be read, a directory that is ready.
module verb_common
    use, intrinsic :: iso_fortran_env, only : error_unit
    use input_kind, only : refuse_other_verb
    use namelist_input, only : namelist_file, read_namelist_file
    use result_files, only : prepare_output
    implicit none
    private

    public :: directory_is_ready, has_faults, is_for, is_readable, tell_failure

    integer, parameter, public :: exit_done = 0, exit_failed = 1, exit_bad_input = 2

contains

    !> Reads a file, or says why it cannot be read.
    logical function is_readable(name, file) result(readable)
        character(len=*), intent(in) :: name
        type(namelist_file), intent(out) :: file
        character(len=:), allocatable :: problem

        call read_namelist_file(name, file, problem)
        readable = len(problem) == 0
        if (.not. readable) write (error_unit, '(4a)') 'stickslip: ', name, ': ', problem
    end function is_readable

    !> Reads an input of a verb. One of another verb is told which one, and nothing else.
    logical function is_for(verb, name, file) result(right)
        character(len=*), intent(in) :: verb, name
        type(namelist_file), intent(out) :: file
        logical :: refused

        right = is_readable(name, file)
        if (.not. right) return
        call refuse_other_verb(verb, file, refused)
        if (refused) right = .not. has_faults(file)
    end function is_for

    !> Tells all faults of an input.
    logical function has_faults(file) result(any_faults)
        type(namelist_file), intent(in) :: file

        any_faults = size(file%faults) > 0
        if (any_faults) write (error_unit, '(a)', advance='no') file%describe_faults()
    end function has_faults

    !> Makes the directory of the output, or says why the results cannot go there.
    logical function directory_is_ready(directory, stem, file) result(ready)
        character(len=*), intent(in) :: directory, stem
        type(namelist_file), intent(in) :: file
        character(len=:), allocatable :: problem

        call prepare_output(file, directory, stem, problem)
        ready = len(problem) == 0
        if (.not. ready) write (error_unit, '(a)') problem
    end function directory_is_ready

    !> The exit status of a run; tells why it failed, if it did.
    subroutine tell_failure(input, failure, base, exit_status)
        character(len=*), intent(in) :: input
        character(len=*), intent(in) :: failure   !! empty if there was none
        character(len=*), intent(in) :: base      !! of the names of the files that were written
        integer, intent(out) :: exit_status

        exit_status = merge(exit_done, exit_failed, len(failure) == 0)
        if (exit_status == exit_done) return
        write (error_unit, '(4a)') 'stickslip: ', input, ': the run failed ', failure
        write (error_unit, '(3a)') '  what was computed so far is in ', base, '.csv'
    end subroutine tell_failure

end module verb_common
