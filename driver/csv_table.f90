!> Reads a table of numbers from a CSV file: a line of names, then a line a row. Every fault is
!> told, with its line.
module csv_table
    use, intrinsic :: ieee_arithmetic, only : ieee_is_finite
    use, intrinsic :: iso_fortran_env, only : dp => real64, iostat_end, iostat_eor
    use namelist_input, only : read_number
    implicit none
    private

    public :: name_length, number_table, read_csv_table

    integer, parameter :: name_length = 32       !! of a column
    integer, parameter :: line_length = 2000
    integer, parameter :: fault_length = 160
    integer, parameter :: most_faults = 20       !! told; a wrong file has one in every line

    type :: number_table
        character(len=name_length), allocatable :: names(:)   !! of the columns
        integer :: rows = 0
        real(dp), allocatable :: values(:, :)   !! (column, row); may hold more rows than there are
        integer, allocatable :: lines(:)        !! of the file, where the rows stand
        character(len=fault_length), allocatable :: faults(:)
    contains
        procedure :: column, add_fault
    end type number_table

contains

    !> Reads a file; what is wrong with it is left in `table%faults`.
    subroutine read_csv_table(name, table)
        character(len=*), intent(in) :: name
        type(number_table), intent(out) :: table
        character(len=line_length) :: line
        character(len=256) :: message
        integer :: unit, status, number

        allocate (table%names(0), table%values(0, 0), table%lines(0), table%faults(0))
        open (newunit=unit, file=name, status='old', action='read', iostat=status, iomsg=message)
        if (status /= 0) then
            call table%add_fault(0, trim(message))
            return
        end if
        number = 0
        do while (size(table%faults) < most_faults)
            call next_line(unit, line, number, status, table)
            if (status /= 0) exit
            if (size(table%names) == 0) then
                call read_names(line, number, table)
            else
                call read_row(line, number, table)
            end if
        end do
        close (unit)
        if (size(table%faults) == 0 .and. table%rows == 0) call table%add_fault(0, &
            'must hold a line of names and rows of numbers below it')
    end subroutine read_csv_table

    !> The next line that is not blank. `status` is 0 until the end of the file.
    subroutine next_line(unit, line, number, status, table)
        integer, intent(in) :: unit
        character(len=line_length), intent(out) :: line
        integer, intent(inout) :: number
        integer, intent(out) :: status
        type(number_table), intent(inout) :: table
        integer :: length

        do
            number = number + 1
            length = 0
            read (unit, '(a)', advance='no', size=length, iostat=status) line
            if (status == 0) then
                call table%add_fault(number, 'the line is too long')
                status = iostat_end
            end if
            if (status == iostat_end .and. length > 0) status = iostat_eor
            if (status /= iostat_eor) return
            status = 0
            line(length + 1:) = ''
            if (length > 0) then
                if (line(length:length) == achar(13)) line(length:length) = ' '
            end if
            if (len_trim(line) > 0) return
        end do
    end subroutine next_line

    subroutine read_names(line, number, table)
        character(len=*), intent(in) :: line
        integer, intent(in) :: number
        type(number_table), intent(inout) :: table
        integer :: i

        deallocate (table%names, table%values)
        allocate (table%names(fields(line)), table%values(fields(line), 0))
        do i = 1, size(table%names)
            table%names(i) = field(line, i)
            if (.not. any(table%names(:i - 1) == table%names(i))) cycle
            call table%add_fault(number, "column '" // field(line, i) // "' is given twice")
        end do
    end subroutine read_names

    subroutine read_row(line, number, table)
        character(len=*), intent(in) :: line
        integer, intent(in) :: number
        type(number_table), intent(inout) :: table
        real(dp) :: row(size(table%names))
        integer :: i
        logical :: ok

        if (fields(line) /= size(row)) then
            call table%add_fault(number, 'must have as many values as there are names')
            return
        end if
        do i = 1, size(row)
            call read_number(field(line, i), row(i), ok)
            if (.not. ok) then
                call table%add_fault(number, trim(table%names(i)) // ' = ' // field(line, i) &
                    // ': must be a number')
            else if (.not. ieee_is_finite(row(i))) then
                call table%add_fault(number, trim(table%names(i)) // ' = ' // field(line, i) &
                    // ': must be finite')
            end if
        end do
        call append(table, row, number)
    end subroutine read_row

    pure subroutine append(table, row, line)
        type(number_table), intent(inout) :: table
        real(dp), intent(in) :: row(:)
        integer, intent(in) :: line
        real(dp), allocatable :: values(:, :)
        integer, allocatable :: lines(:)

        if (table%rows == size(table%lines)) then   ! double: every row is copied twice at most
            allocate (values(size(row), 2 * table%rows + 64), lines(2 * table%rows + 64))
            values(:, :table%rows) = table%values(:, :table%rows)
            lines(:table%rows) = table%lines
            call move_alloc(values, table%values)
            call move_alloc(lines, table%lines)
        end if
        table%rows = table%rows + 1
        table%values(:, table%rows) = row
        table%lines(table%rows) = line
    end subroutine append

    !> How many values does a line have?
    pure function fields(line) result(n)
        character(len=*), intent(in) :: line
        integer :: n, i

        n = 1
        do i = 1, len_trim(line)
            if (line(i:i) == ',') n = n + 1
        end do
    end function fields

    !> The n-th value of a line, without the blanks around it.
    pure function field(line, n) result(text)
        character(len=*), intent(in) :: line
        integer, intent(in) :: n
        character(len=:), allocatable :: text
        integer :: first, length, i

        first = 1
        do i = 2, n
            first = first + index(line(first:), ',')
        end do
        length = index(line(first:) // ',', ',') - 1
        text = trim(adjustl(line(first:first + length - 1)))
    end function field

    !> The place of a column; 0: there is none of that name.
    pure function column(self, name) result(place)
        class(number_table), intent(in) :: self
        character(len=*), intent(in) :: name
        integer :: place

        do place = size(self%names), 1, -1
            if (self%names(place) == name) return
        end do
    end function column

    !> Notes a fault in a line; line 0 is the file as a whole.
    pure subroutine add_fault(self, line, text)
        class(number_table), intent(inout) :: self
        integer, intent(in) :: line
        character(len=*), intent(in) :: text
        character(len=fault_length) :: fault

        fault = text
        if (line > 0) write (fault, '(a, i0, 2a)') 'line ', line, ': ', &
            text(:min(len(text), fault_length - 20))
        self%faults = [character(len=fault_length) :: self%faults, fault]
    end subroutine add_fault

end module csv_table
