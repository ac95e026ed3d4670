!> The cells of a line of a table, as rigs and spreadsheets write it: separated by commas,
!> semicolons, tabs or blanks, some of them in double quotes.
module table_cells
    implicit none
    private

    public :: line_cells, separators, split, tab

    character(len=1), parameter :: tab = achar(9)
    character(len=*), parameter :: separators = tab // ';, '   !! in the order of preference

    !> The cells of a line.
    type :: line_cells
        integer :: n = 0
        integer, allocatable :: first(:), last(:)     !! characters; room for `n` or more
        logical :: sound = .true.                     !! all quotes are closed
    end type line_cells

contains

    !> The cells of a line, without the blanks and the quotes around them. A blank that separates
    !> stands for any number of blanks and tabs.
    pure subroutine split(text, first, last, separator, cells)
        character(len=*), intent(in) :: text
        integer, intent(in) :: first, last              !! characters of the line
        character(len=1), intent(in) :: separator
        type(line_cells), intent(inout) :: cells
        integer :: at, cell_end, next

        cells%n = 0
        cells%sound = .true.
        at = first
        do
            do while (at <= last)   ! blanks before the cell
                if (.not. is_blank(text(at:at)) .or. text(at:at) == tab .and. separator == tab) exit
                at = at + 1
            end do
            if (separator == ' ' .and. at > last) exit
            call find_end(text, at, last, separator, cell_end, next, cells%sound)
            call add_cell(cells, at, cell_end)
            if (next > last) exit
            at = next + 1
        end do
    end subroutine split

    !> Where does the cell that starts at `at` end?
    pure subroutine find_end(text, at, last, separator, cell_end, next, sound)
        character(len=*), intent(in) :: text
        integer, intent(inout) :: at            !! start of the cell; of what is in its quotes
        integer, intent(in) :: last             !! character of the line
        character(len=1), intent(in) :: separator
        integer, intent(out) :: cell_end
        integer, intent(out) :: next            !! separator behind it, or behind the line
        logical, intent(inout) :: sound
        integer :: quote
        logical :: quoted

        quoted = .false.
        if (at <= last) quoted = text(at:at) == '"'
        next = at
        if (quoted) then
            at = at + 1
            quote = closing_quote(text, at, last)
            sound = sound .and. quote <= last
            next = quote + 1
            do while (at < quote)   ! numbers may be filled up with blanks inside their quotes
                if (.not. is_blank(text(at:at))) exit
                at = at + 1
            end do
        end if
        do while (next <= last)
            if (text(next:next) == separator) exit
            if (separator == ' ' .and. text(next:next) == tab) exit
            if (quoted) sound = sound .and. is_blank(text(next:next))
            next = next + 1
        end do
        cell_end = next - 1
        if (quoted) cell_end = quote - 1
        do while (cell_end >= at)
            if (.not. is_blank(text(cell_end:cell_end))) exit
            cell_end = cell_end - 1
        end do
    end subroutine find_end

    !> The quote that ends a text; two in a row belong to it. Behind the line if there is none.
    pure integer function closing_quote(text, from, last) result(place)
        character(len=*), intent(in) :: text
        integer, intent(in) :: from, last

        place = from
        do while (place <= last)
            if (text(place:place) == '"') then
                if (place == last) return
                if (text(place + 1:place + 1) /= '"') return
                place = place + 1
            end if
            place = place + 1
        end do
    end function closing_quote

    pure logical function is_blank(c) result(blank)
        character(len=1), intent(in) :: c

        blank = c == ' ' .or. c == tab
    end function is_blank

    pure subroutine add_cell(cells, first, last)
        type(line_cells), intent(inout) :: cells
        integer, intent(in) :: first, last

        if (.not. allocated(cells%first)) allocate (cells%first(16), cells%last(16))
        if (cells%n == size(cells%first)) then
            cells%first = [cells%first, cells%first]
            cells%last = [cells%last, cells%last]
        end if
        cells%n = cells%n + 1
        cells%first(cells%n) = first
        cells%last(cells%n) = last
    end subroutine add_cell

end module table_cells
