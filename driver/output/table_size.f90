!> How much room on disk the tables of a run will take.
module table_size
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use chain_fields, only : chain_record_bytes
    use number_text, only : rounded_text
    use run_rows, only : series_size
    use run_settings, only : settings
    use text_file, only : gigabyte
    implicit none
    private

    public :: check_table_size, expected_bytes

contains

    !> As far as it is known before the run: the number of adaptive steps is unknown.
    pure real(dp) function expected_bytes(run) result(bytes)
        type(settings), intent(in) :: run
        real(dp), parameter :: number = 24.0_dp   !! bytes of one with its comma
        real(dp) :: rows

        rows = 1.0_dp
        if (run%every > 0.0_dp) then
            rows = run%t_end / run%every
        else if (.not. run%adaptive) then
            rows = real(run%n_steps, dp) / run%interval
        end if
        bytes = rows * number * series_size(run)
        if (run%fields > 0 .and. .not. run%adaptive) bytes = bytes + real(run%n_steps, dp) &
            / run%fields * real(chain_record_bytes(run%chain%n_blocks), dp)
    end function expected_bytes

    !> `problem` is empty, or says that the tables are going to be larger than they may.
    subroutine check_table_size(run, problem)
        type(settings), intent(in) :: run
        character(len=:), allocatable, intent(out) :: problem

        problem = ''
        if (expected_bytes(run) <= run%table_limit * gigabyte) return
        problem = '&output table_limit: the tables are going to take' &
            // rounded_text(expected_bytes(run) / gigabyte, 9, 2) // ' GB, more than' &
            // rounded_text(run%table_limit, 9, 2) // ' GB: choose a larger interval (or every, ' &
            // 'fields), or raise table_limit'
    end subroutine check_table_size

end module table_size
