!> Reads tables of numbers from CSV files and finds every fault in them, with line and column.
!>
!> The first line names the columns. Empty lines and lines that start with # do not count.
module csv_table
    use, intrinsic :: ieee_arithmetic, only : ieee_is_finite
    use, intrinsic :: iso_fortran_env, only : dp => real64, iostat_end
    use number_reader, only : read_number
    use platform, only : is_directory
    implicit none
    private

    public :: line_text, name_length, read_table, table

    integer, parameter :: name_length = 40
    integer, parameter :: line_length = 4096
    integer, parameter :: most_faults = 20

    type :: line_text
        character(len=:), allocatable :: text
    end type line_text

    type :: table
        character(len=name_length), allocatable :: names(:)   !! of the columns
        real(dp), allocatable :: values(:, :)                 !! column, row
        integer, allocatable :: lines(:)                      !! of the file, one a row
        type(line_text), allocatable :: faults(:)             !! each with its line
    contains
        procedure :: column, add_fault
    end type table

contains

    !> Takes a whole file; what is wrong with it is left in `read%faults`.
    subroutine read_table(path, read_in)
        character(len=*), intent(in) :: path
        type(table), intent(out) :: read_in
        character(len=line_length) :: line
        character(len=256) :: message
        integer :: unit, status, number, rows

        allocate (read_in%names(0), read_in%values(0, 0), read_in%lines(0), read_in%faults(0))
        if (is_directory(path)) then
            call read_in%add_fault(0, 'is a directory')
            return
        end if
        open (newunit=unit, file=path, status='old', action='read', iostat=status, iomsg=message)
        if (status /= 0) then
            call read_in%add_fault(0, trim(message))
            return
        end if
        number = 0
        rows = 0
        do
            read (unit, '(a)', iostat=status, iomsg=message) line
            if (status /= 0) exit
            number = number + 1
            if (number == 1 .and. line(:3) == char(239) // char(187) // char(191)) line = line(4:)
            if (len_trim(line) == 0 .or. line(1:1) == '#') cycle
            if (line(line_length:) /= ' ') then
                call read_in%add_fault(number, 'the line is too long')
            else if (size(read_in%names) == 0) then
                if (scan(line, ';' // achar(9)) > 0 .and. index(line, ',') == 0) then
                    call read_in%add_fault(number, 'the cells must be separated by commas')
                    exit
                end if
                call take_header(line, read_in)
            else
                call take_row(line, number, rows, read_in)
            end if
            if (size(read_in%faults) > most_faults) exit
        end do
        if (status > 0) call read_in%add_fault(number, trim(message))
        if (status == iostat_end .and. size(read_in%names) == 0) then
            call read_in%add_fault(0, 'is empty')
        end if
        close (unit)
        read_in%values = read_in%values(:, :rows)
        read_in%lines = read_in%lines(:rows)
    end subroutine read_table

    subroutine take_header(line, read_in)
        character(len=*), intent(in) :: line
        type(table), intent(inout) :: read_in
        integer :: i

        deallocate (read_in%names, read_in%values, read_in%lines)
        allocate (read_in%names(cells_in(line)))
        do i = 1, size(read_in%names)
            read_in%names(i) = cell(line, i)
        end do
        do i = 2, size(read_in%names)
            if (any(read_in%names(:i - 1) == read_in%names(i))) call read_in%add_fault(0, &
                "column '" // trim(read_in%names(i)) // "' is given twice")
        end do
        allocate (read_in%values(size(read_in%names), 64), read_in%lines(64))
    end subroutine take_header

    subroutine take_row(line, number, rows, read_in)
        character(len=*), intent(in) :: line
        integer, intent(in) :: number      !! of the line in the file
        integer, intent(inout) :: rows     !! taken so far
        type(table), intent(inout) :: read_in
        character(len=name_length) :: word
        integer :: i
        logical :: ok, small

        if (cells_in(line) /= size(read_in%names)) then
            call read_in%add_fault(number, 'has not as many cells as the header')
            return
        end if
        if (rows == size(read_in%lines)) call double_room(read_in)
        rows = rows + 1
        read_in%lines(rows) = number
        do i = 1, size(read_in%names)
            word = cell(line, i)
            call read_number(trim(word), read_in%values(i, rows), ok, small)
            if (ok) ok = ieee_is_finite(read_in%values(i, rows))
            if (ok) cycle
            read_in%values(i, rows) = 0.0_dp
            call read_in%add_fault(number, trim(read_in%names(i)) // " = '" // trim(word) &
                // "': must be a finite number")
        end do
    end subroutine take_row

    subroutine double_room(read_in)
        type(table), intent(inout) :: read_in
        real(dp), allocatable :: values(:, :)
        integer, allocatable :: lines(:)
        integer :: n

        n = size(read_in%lines)
        allocate (values(size(read_in%names), 2 * n), lines(2 * n))
        values(:, :n) = read_in%values
        lines(:n) = read_in%lines
        call move_alloc(values, read_in%values)
        call move_alloc(lines, read_in%lines)
    end subroutine double_room

    pure function cells_in(line) result(n)
        character(len=*), intent(in) :: line
        integer :: n
        integer :: i

        n = 1
        do i = 1, len_trim(line)
            if (line(i:i) == ',') n = n + 1
        end do
    end function cells_in

    !> The i-th cell of a line, without the blanks, tabs and carriage returns around it.
    pure function cell(line, i) result(word)
        character(len=*), intent(in) :: line
        integer, intent(in) :: i
        character(len=name_length) :: word
        integer :: first, last, comma, k

        first = 1
        do k = 1, i - 1
            first = first + index(line(first:), ',')
        end do
        comma = index(line(first:), ',')
        last = len_trim(line)
        if (comma > 0) last = first + comma - 2
        do while (first < last)
            if (iachar(line(first:first)) > 32) exit
            first = first + 1
        end do
        do while (last >= first)
            if (iachar(line(last:last)) > 32) exit
            last = last - 1
        end do
        word = line(first:last)
    end function cell

    !> Place of a column; 0 if there is none of that name.
    pure function column(self, name) result(i)
        class(table), intent(in) :: self
        character(len=*), intent(in) :: name
        integer :: i

        do i = size(self%names), 1, -1
            if (self%names(i) == name) return
        end do
    end function column

    !> Notes a fault in a line; line 0 is the file as a whole.
    subroutine add_fault(self, line, text)
        class(table), intent(inout) :: self
        integer, intent(in) :: line
        character(len=*), intent(in) :: text
        character(len=20) :: place
        type(line_text) :: new

        if (size(self%faults) > most_faults) return
        place = ''
        if (line > 0) write (place, '(a, i0, a)') 'line ', line, ': '
        new%text = trim(place) // ' ' // text
        if (line == 0) new%text = text
        if (size(self%faults) == most_faults) new%text = 'and more faults'
        self%faults = [self%faults, new]
    end subroutine add_fault

end module csv_table
