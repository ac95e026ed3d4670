!> The keys of a group that choose the columns of a table: for a column `time` they are
!> `time_column`, its name in the file, and `time_factor`, by which its numbers are multiplied.
module column_keys
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use csv_table, only : column_request, csv => table
    use namelist_input, only : namelist_file, not_zero
    implicit none
    private

    public :: check_factors, read_column_keys, refuse_column_keys, refuse_table

contains

    !> Every fault is left in `file%faults`.
    subroutine read_column_keys(file, group, names, requests)
        type(namelist_file), intent(inout) :: file
        character(len=*), intent(in) :: group
        character(len=*), intent(in) :: names(:)   !! of the columns that the group can use
        type(column_request), allocatable, intent(out) :: requests(:)
        character(len=:), allocatable :: name
        integer :: i

        allocate (requests(size(names)))
        do i = 1, size(names)
            name = trim(names(i))
            requests(i)%name = name
            call file%get_text(group, name // '_column', requests(i)%title)
            requests(i)%needed = len(requests(i)%title) > 0
            call file%get_real(group, name // '_factor', requests(i)%factor, not_zero(), &
                default=1.0_dp)
        end do
    end subroutine read_column_keys

    !> Without a file there are no columns.
    subroutine refuse_column_keys(file, group, names)
        type(namelist_file), intent(inout) :: file
        character(len=*), intent(in) :: group, names(:)
        integer :: i

        do i = 1, size(names)
            call file%refuse(group, trim(names(i)) // '_column', 'needs a file')
            call file%refuse(group, trim(names(i)) // '_factor', 'needs a file')
        end do
    end subroutine refuse_column_keys

    !> A factor needs its column.
    subroutine check_factors(file, group, names, table)
        type(namelist_file), intent(inout) :: file
        character(len=*), intent(in) :: group, names(:)
        type(csv), intent(inout) :: table
        integer :: i

        do i = 1, size(names)
            if (table%column(trim(names(i))) == 0 .and. file%given(group, trim(names(i)) &
                // '_factor')) call table%add_fault(table%header_line, "no column '" &
                // trim(names(i)) // "' for its factor")
        end do
    end subroutine check_factors

    !> The faults of a table are those of the key that names it.
    subroutine refuse_table(file, group, key, table)
        type(namelist_file), intent(inout) :: file
        character(len=*), intent(in) :: group, key
        type(csv), intent(in) :: table
        integer :: i

        do i = 1, size(table%faults)
            call file%reject(group, key, table%faults(i)%text)
        end do
    end subroutine refuse_table

end module column_keys
