!> Reads columns of numbers from tables as rigs and spreadsheets write them, and finds every fault,
!> with its line.
!>
!> Cells are separated by commas, semicolons, tabs or blanks, and may stand in double quotes. The
!> line of column names is found by the names that are asked for; titles before it, up to two rows
!> of units or the like behind it, other columns, empty lines and lines that start with # or %
!> are left alone. Rows may end before columns that nobody asks for (comments), if not the last one
!> alone does: that file was cut short. A line of names may itself be such a comment. Numbers have a
!> decimal point or a decimal comma, the same in the whole file. Commas that may as well part
!> thousands are refused.
module csv_table
    use, intrinsic :: ieee_arithmetic, only : ieee_is_finite
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use fault_list, only : append_fault, fault
    use number_reader, only : largest, read_number
    use number_text, only : whole_text
    use printable_text, only : lower, printable
    use table_cells, only : line_cells, separators, split, tab
    use whole_file, only : line_text, next_line, plain_text, read_whole_file
    implicit none
    private

    public :: column_request, line_text, read_table, table, table_of_bytes, table_reader

    integer, parameter :: most_faults = 20
    character(len=*), parameter :: digits = '0123456789'

    !> A column that the caller can use.
    type :: column_request
        character(len=:), allocatable :: name      !! as the caller calls it
        character(len=:), allocatable :: title     !! in the file; empty: much like `name`
        logical :: needed = .false.                !! a file without it is at fault
        real(dp) :: factor = 1.0_dp                !! its numbers are multiplied by
    end type column_request

    type :: table
        type(line_text), allocatable :: names(:)              !! of the columns, as asked for
        real(dp), allocatable :: values(:, :)                 !! column, row
        integer, allocatable :: lines(:)                      !! of the file, one a row
        type(fault), allocatable :: faults(:)                 !! each with its line
        integer :: header_line = 0                            !! with the names of the columns
        character(len=:), allocatable :: titles               !! all of its names, for messages
    contains
        procedure :: column, numbers, add_fault
    end type table

    !> How a file is written.
    type :: file_form
        character(len=1) :: separator = ','
        integer :: header_line = 0
        type(line_text), allocatable :: titles(:)     !! of the columns
        logical :: sound = .true.                     !! all of their quotes are closed
        integer :: named_cells = 0                    !! up to the last column with a name
        integer :: least_cells = 0                    !! up to the last column asked for
        integer, allocatable :: places(:)             !! of the columns asked for; 0: not there
        integer :: mark = 0                           !! 1 decimal point, 2 comma; 0 none so far
        integer :: mark_line = 0                      !! where the first one is
        integer :: doubt_line = 0                     !! of a comma that may part thousands
        character(len=:), allocatable :: in_doubt     !! that cell
        logical :: sure = .false.                     !! a comma can only be a decimal one
        integer :: word_rows = 0                      !! rows of units or the like so far
        integer :: empty_row = 0                      !! the last row of nothing but separators
        integer :: last_cells = 0                     !! of the row before
        integer :: cut_line = 0                       !! of a row shorter than header and row before
    end type file_form

    abstract interface
        !> What reads tables of another kind, as `read_table` does.
        subroutine table_reader(path, requests, read_in)
            import :: column_request, table
            implicit none
            character(len=*), intent(in) :: path
            type(column_request), intent(in) :: requests(:)
            type(table), intent(out) :: read_in
        end subroutine table_reader
    end interface

contains

    !> Takes columns from a file; what is wrong with it is left in `read_in%faults`. Columns that
    !> are not there are not in `read_in%names`; that is a fault where they are needed.
    subroutine read_table(path, requests, read_in)
        character(len=*), intent(in) :: path
        type(column_request), intent(in) :: requests(:)
        type(table), intent(out) :: read_in
        character(len=:), allocatable :: text, problem

        call read_whole_file(path, text, problem)
        call take_text(text, problem, requests, read_in)
    end subroutine read_table

    !> The same of what a file holds, byte by byte.
    subroutine table_of_bytes(bytes, requests, read_in)
        character(len=*), intent(in) :: bytes
        type(column_request), intent(in) :: requests(:)
        type(table), intent(out) :: read_in
        character(len=:), allocatable :: text, problem

        call plain_text(bytes, text, problem)
        call take_text(text, problem, requests, read_in)
    end subroutine table_of_bytes

    subroutine take_text(text, problem, requests, read_in)
        character(len=*), intent(in) :: text, problem
        type(column_request), intent(in) :: requests(:)
        type(table), intent(inout) :: read_in
        type(file_form) :: form
        type(line_cells) :: cells
        integer :: first, last, line, rows, i

        allocate (read_in%names(0), read_in%values(0, 0), read_in%lines(0), read_in%faults(0))
        if (len(problem) > 0) then
            call read_in%add_fault(0, problem)
            return
        end if
        call find_header(text, requests, form, read_in)
        if (size(read_in%faults) > 0) return
        if (count(form%places > 0) < min(2, size(requests))) return
        deallocate (read_in%values, read_in%lines)
        line = 1
        do i = 1, len(text)
            if (text(i:i) == new_line('a')) line = line + 1
        end do
        allocate (read_in%values(size(read_in%names), line), read_in%lines(line))
        rows = 0
        line = 0
        last = -1
        do while (last < len(text))
            call next_line(text, first, last, line)
            if (line <= form%header_line .or. is_no_row(text(first:last))) cycle
            call split(text, first, last, form%separator, cells)
            call take_row(text, line, requests, form, cells, rows, read_in)
            if (size(read_in%faults) > most_faults) exit
        end do
        if (form%doubt_line > 0 .and. form%separator /= ';' .and. .not. form%sure) then
            call read_in%add_fault(form%doubt_line, form%in_doubt // ': is its comma a decimal ' &
                // 'mark or a thousands separator? No number of the file decides it: write ' &
                // 'numbers without such a comma, or separate the cells by semicolons')
        end if
        if (form%cut_line > 0) call read_in%add_fault(form%cut_line, other_size(form, &
            form%last_cells) // ', and the row before has more: the file is cut short')
        read_in%values = read_in%values(:, :rows)
        read_in%lines = read_in%lines(:rows)
    end subroutine take_text

    !> Empty, or a comment: not a row whose first cell spreadsheets could not compute.
    pure logical function is_no_row(line) result(yes)
        character(len=*), intent(in) :: line
        character(len=7), parameter :: not_computed(7) = [character(len=7) :: '#N/A', '#DIV/0!', &
            '#VALUE!', '#REF!', '#NAME?', '#NUM!', '#NULL!']
        integer :: i, k

        i = verify(line, ' ' // tab)
        yes = i == 0
        if (yes) return
        yes = scan(line(i:i), '#%') > 0
        if (yes) yes = all([(index(line(i:), trim(not_computed(k))) /= 1, k = 1, &
            size(not_computed))])
    end function is_no_row

    ! ---- the line of names -------------------------------------------------------------------

    !> The first line that has two of the names asked for, or the only one; a comment only where no
    !> other line has them. Failing that, the first line with one serves for messages.
    subroutine find_header(text, requests, form, read_in)
        character(len=*), intent(in) :: text
        type(column_request), intent(in) :: requests(:)
        type(file_form), intent(out) :: form
        type(table), intent(inout) :: read_in
        integer, parameter :: most_lines = 200
        type(file_form) :: trial
        integer :: best, rank, first, last, line, first_text, open_quote, i
        logical :: comment

        best = 0
        first_text = 0
        open_quote = 0
        line = 0
        last = -1
        do while (last < len(text) .and. line < most_lines .and. best <= size(requests))
            call next_line(text, first, last, line)
            i = verify(text(first:last), ' #%' // tab)
            if (i == 0) cycle
            comment = is_no_row(text(first:last))
            if (comment) first = first + i - 1
            if (first_text == 0 .and. .not. comment) first_text = line
            if (open_quote == 0) then
                if (mod(count([(text(i:i) == '"', i = first, last)]), 2) == 1) open_quote = line
            end if
            do i = 1, len(separators)
                trial%separator = separators(i:i)
                trial%header_line = line
                call read_titles(text, first, last, requests, trial)
                rank = columns_found(trial)
                if (rank >= min(2, size(requests))) then
                    if (.not. comment) rank = rank + size(requests)
                else if (comment) then
                    rank = 0
                end if
                if (rank < best .or. rank == best .and. .not. parts_more(trial, form)) cycle
                best = rank
                form = trial
            end do
        end do
        read_in%header_line = form%header_line
        read_in%titles = ''
        if (best == 1) read_in%titles = cells_of(text, form%header_line)   ! for messages alone
        if (best > 1) read_in%titles = list_of(form%titles)
        if (first_text == 0) then
            call read_in%add_fault(0, 'is empty')
        else if (open_quote > 0 .and. best < min(2, size(requests)) .or. .not. form%sound) then
            call read_in%add_fault(merge(open_quote, form%header_line, form%sound), &
                'a quote is not closed in this line')
        else if (best == 0) then
            call read_in%add_fault(first_text, 'no line of column names is found from here on: ' &
                // "column '" // title_of(requests(1)) // "' is missing; this line has " &
                // cells_of(text, first_text))
        else
            call check_titles(requests, form, read_in)
            call check_lines_before(text, form, read_in)
        end if
    end subroutine find_header

    !> How many columns have a name that is asked for?
    pure integer function columns_found(form) result(n)
        type(file_form), intent(in) :: form
        integer :: i

        n = count([(form%places(i) > 0 .and. all(form%places(:i - 1) /= form%places(i)), &
            i = 1, size(form%places))])
    end function columns_found

    !> Does this separator part a line that another left whole? Behind a comma, a name that is not
    !> parted may have a unit. Blanks may stand in names.
    pure logical function parts_more(trial, form) result(yes)
        type(file_form), intent(in) :: trial, form

        yes = allocated(form%titles) .and. trial%header_line == form%header_line &
            .and. trial%separator /= ' '
        if (yes) yes = size(form%titles) == 1 .and. size(trial%titles) > 1
    end function parts_more

    !> What a line is if it is the line of names.
    pure subroutine read_titles(text, first, last, requests, form)
        character(len=*), intent(in) :: text
        integer, intent(in) :: first, last
        type(column_request), intent(in) :: requests(:)
        type(file_form), intent(inout) :: form
        type(line_cells) :: cells
        integer :: i

        call split(text, first, last, form%separator, cells)
        if (allocated(form%titles)) deallocate (form%titles, form%places)
        allocate (form%titles(cells%n), form%places(size(requests)))
        form%sound = cells%sound
        form%named_cells = 0
        do i = 1, cells%n
            form%titles(i)%text = text(cells%first(i):cells%last(i))
            if (len(form%titles(i)%text) > 0) form%named_cells = i
        end do
        do i = 1, size(requests)
            form%places(i) = sum(places_of(requests(i), form%titles, most=1))
        end do
        form%least_cells = form%named_cells   ! blanks do not show which cell is missing
        if (form%separator /= ' ') form%least_cells = maxval([0, form%places])
    end subroutine read_titles

    !> The columns that have the name asked for: as it is written if there is one, else without
    !> regard to case, else without a unit behind it.
    pure function places_of(request, titles, most) result(places)
        type(column_request), intent(in) :: request
        type(line_text), intent(in) :: titles(:)
        integer, intent(in) :: most             !! places
        integer, allocatable :: places(:)
        character(len=:), allocatable :: wanted
        integer :: strictness, i

        places = [integer ::]
        do strictness = 0, 2
            wanted = simplified(title_of(request), strictness)
            do i = 1, size(titles)
                if (size(places) == most) return
                if (simplified(titles(i)%text, strictness) == wanted &
                    .and. len(titles(i)%text) > 0) places = [places, i]
            end do
            if (size(places) > 0) return
        end do
    end function places_of

    pure function title_of(request) result(title)
        type(column_request), intent(in) :: request
        character(len=:), allocatable :: title

        title = request%name
        if (allocated(request%title)) then
            if (len(request%title) > 0) title = request%title
        end if
    end function title_of

    !> A name without its case, or without its unit either: `Time [s]`, `time (s)`, `Time/s`.
    pure function simplified(title, strictness) result(name)
        character(len=*), intent(in) :: title
        integer, intent(in) :: strictness    !! 0 as it is; 1 no case; 2 no unit either
        character(len=:), allocatable :: name
        integer :: unit

        name = title
        if (strictness > 0) name = lower(name)
        unit = scan(name, '[({/,')
        if (strictness > 1 .and. unit > 1) name = trim(name(:unit - 1))
    end function simplified

    !> Names of several columns, and names asked for that are not there. Takes the others.
    subroutine check_titles(requests, form, read_in)
        type(column_request), intent(in) :: requests(:)
        type(file_form), intent(in) :: form
        type(table), intent(inout) :: read_in
        character(len=:), allocatable :: title
        type(line_text) :: name
        integer, allocatable :: places(:)
        integer :: i

        do i = 1, size(requests)
            title = title_of(requests(i))
            if (form%places(i) == 0) then
                if (requests(i)%needed) call read_in%add_fault(form%header_line, &
                    "column '" // printable(title) // "' is missing: there are " // read_in%titles)
                cycle
            end if
            if (any(form%places(:i - 1) == form%places(i))) call read_in%add_fault( &
                form%header_line, "column '" // printable(form%titles(form%places(i))%text) &
                // "' is asked for twice")
            name%text = requests(i)%name
            read_in%names = [read_in%names, name]
            places = places_of(requests(i), form%titles, most=2)
            if (size(places) < 2) cycle
            associate (first => form%titles(places(1))%text, second => form%titles(places(2))%text)
                if (first == second) then
                    call read_in%add_fault(form%header_line, "column '" // printable(first) &
                        // "' is given twice")
                else
                    call read_in%add_fault(form%header_line, "columns '" // printable(first) &
                        // "' and '" // printable(second) // "' may both be " &
                        // requests(i)%name // ': name one as it is written')
                end if
            end associate
        end do
    end subroutine check_titles

    !> The cells of a line, for messages: of the separators the first one that the line has.
    pure function cells_of(text, number) result(list)
        character(len=*), intent(in) :: text
        integer, intent(in) :: number        !! of the line
        character(len=:), allocatable :: list
        type(file_form) :: form
        integer :: first, last, line, i

        line = 0
        last = -1
        do while (line < number)
            call next_line(text, first, last, line)
        end do
        do i = 1, len(separators)
            form%separator = separators(i:i)
            call read_titles(text, first, last, [column_request ::], form)
            if (size(form%titles) > 1) exit
        end do
        list = list_of(form%titles)
    end function cells_of

    pure function list_of(titles) result(text)
        type(line_text), intent(in) :: titles(:)
        character(len=:), allocatable :: text
        integer, parameter :: most = 400
        integer :: i

        text = "'" // printable(titles(1)%text) // "'"
        do i = 2, size(titles)
            text = text // ", '" // printable(titles(i)%text) // "'"
            if (len(text) > most) exit
        end do
    end function list_of

    !> Titles may stand before the names, numbers may not.
    subroutine check_lines_before(text, form, read_in)
        character(len=*), intent(in) :: text
        type(file_form), intent(in) :: form
        type(table), intent(inout) :: read_in
        type(line_cells) :: cells
        real(dp) :: value
        integer :: first, last, line, i
        logical :: is_number, too_small

        last = -1
        line = 0
        do while (line < form%header_line - 1)
            call next_line(text, first, last, line)
            if (is_no_row(text(first:last))) cycle
            call split(text, first, last, form%separator, cells)
            is_number = cells%n > 1
            do i = 1, cells%n
                if (.not. is_number) exit
                call read_number(text(cells%first(i):cells%last(i)), value, is_number, too_small)
            end do
            if (.not. is_number) cycle
            call read_in%add_fault(line, 'numbers stand before the line of column names')
            return
        end do
    end subroutine check_lines_before

    ! ---- rows --------------------------------------------------------------------------------

    subroutine take_row(text, line, requests, form, cells, rows, read_in)
        character(len=*), intent(in) :: text
        integer, intent(in) :: line        !! of the file
        type(column_request), intent(in) :: requests(:)
        type(file_form), intent(inout) :: form
        type(line_cells), intent(in) :: cells
        integer, intent(inout) :: rows     !! taken so far
        type(table), intent(inout) :: read_in
        integer :: place, column, i

        if (.not. cells%sound) then
            call read_in%add_fault(line, 'a quote is not closed')
            return
        else if (all(cells%last(:cells%n) < cells%first(:cells%n))) then
            if (form%empty_row == 0) form%empty_row = line
            return
        else if (rows == 0 .and. form%word_rows < 2) then
            if (holds_words_only(text, form, cells)) then
                form%word_rows = form%word_rows + 1
                return
            end if
        end if
        if (form%empty_row > 0) call read_in%add_fault(form%empty_row, &
            'the row is empty, and other rows follow it')
        form%empty_row = 0
        if (cells%n < form%least_cells .or. any(cells%last(form%named_cells + 1:cells%n) &
            >= cells%first(form%named_cells + 1:cells%n))) then
            call read_in%add_fault(line, other_size(form, cells%n))
            return
        end if
        form%cut_line = 0
        if (cells%n < min(form%named_cells, form%last_cells)) form%cut_line = line
        form%last_cells = cells%n
        rows = rows + 1
        read_in%lines(rows) = line
        column = 0
        do i = 1, size(requests)
            place = form%places(i)
            if (place == 0) cycle
            column = column + 1
            call take_cell(text(cells%first(place):cells%last(place)), line, &
                form%titles(place)%text, form, read_in%values(column, rows), read_in)
            associate (value => read_in%values(column, rows))
                if (abs(value) > largest / max(1.0_dp, abs(requests(i)%factor))) then
                    call read_in%add_fault(line, requests(i)%name // ': the number, times its ' &
                        // 'factor, must not exceed 1e100')
                else
                    value = requests(i)%factor * value
                end if
            end associate
        end do
    end subroutine take_row

    !> What is wrong with a row of too few cells, or of cells without a name.
    pure function other_size(form, n) result(text)
        type(file_form), intent(in) :: form
        integer, intent(in) :: n                      !! cells of the row
        character(len=:), allocatable :: text

        text = 'does not have as many cells as the header: ' // whole_text(n) // ' for ' &
            // whole_text(form%named_cells)
        if (form%separator == ',' .and. n > form%named_cells) text = text &
            // ' (cells with a decimal comma need quotes)'
    end function other_size

    !> A row of units or the like: its cells that count look like no numbers, but for 1, which is
    !> the unit of what has none. Time or place, the first column that is asked for, has one.
    pure logical function holds_words_only(text, form, cells) result(yes)
        character(len=*), intent(in) :: text
        type(file_form), intent(in) :: form
        type(line_cells), intent(in) :: cells
        character(len=:), allocatable :: word
        integer :: words, i

        words = 0
        do i = 1, size(form%places)
            if (form%places(i) == 0 .or. form%places(i) > cells%n) cycle
            word = lower(text(cells%first(form%places(i)):cells%last(form%places(i))))
            if (len(word) == 0 .or. word == '1' .and. i > 1) cycle
            words = words + 1
            yes = scan(word(1:1), digits // '+-.,') == 0 .or. scan(word, digits) == 0 &
                .or. has_unit_behind(word)
            yes = yes .and. all(word /= ['nan     ', 'inf     ', 'infinity'])
            if (.not. yes) return
        end do
        yes = words > 0
    end function holds_words_only

    !> Units that begin with a number: 1/s, 10^-6, 0.1 mm. Dates (1/2/2026), times (12:30) and
    !> numbers in groups (10 000) are none.
    pure logical function has_unit_behind(word) result(yes)
        character(len=*), intent(in) :: word
        integer :: mark, next

        mark = scan(word, ' /*^')
        yes = mark > 1
        if (.not. yes) return
        next = mark - 1 + verify(word(mark:) // ';', ' /*')
        yes = next <= len(word)
        if (yes) yes = word(next:next) == '^' .or. scan(word(next:next), digits // '+-.,:') == 0
    end function has_unit_behind

    subroutine take_cell(word, line, title, form, value, read_in)
        character(len=*), intent(in) :: word, title
        integer, intent(in) :: line
        type(file_form), intent(inout) :: form
        real(dp), intent(out) :: value
        type(table), intent(inout) :: read_in
        character(len=len(word)) :: number
        character(len=:), allocatable :: why
        integer :: mark, comma
        logical :: is_number, too_small

        why = ''
        number = word
        mark = merge(1, 0, index(word, '.') > 0)
        comma = index(word, ',')
        if (comma > 0) then
            number(comma:comma) = '.'
            if (mark == 1) why = 'has a decimal point and a comma'
            mark = 2
            if (.not. may_part_thousands(word)) then
                form%sure = .true.
            else if (form%doubt_line == 0) then
                form%doubt_line = line
                form%in_doubt = printable(title) // " = '" // word // "'"
            end if
        end if
        if (form%mark == 0 .and. mark > 0) form%mark_line = line
        if (form%mark == 0) form%mark = mark
        call read_number(number, value, is_number, too_small)
        if (is_number) is_number = ieee_is_finite(value)
        if (len(word) == 0) then
            why = 'must be a finite number, and the cell is empty'
        else if (.not. is_number .and. len(why) == 0) then
            why = 'must be a finite number'
        else if (too_small) then
            why = 'is not 0, but below the smallest number'
        else if (mark > 0 .and. mark /= form%mark .and. len(why) == 0) then
            why = 'has a decimal ' // merge('point', 'comma', mark == 1) // ', and line ' &
                // whole_text(form%mark_line) // ' has another mark'
        end if
        if (len(why) == 0) return
        value = 0.0_dp
        call read_in%add_fault(line, printable(title) // " = '" // printable(word) // "': " // why)
    end subroutine take_cell

    !> 1,000 and -12,500 are numbers with a decimal comma, and such with a comma behind thousands.
    pure logical function may_part_thousands(word) result(yes)
        character(len=*), intent(in) :: word   !! has a comma
        integer :: first, comma

        first = verify(word, '+-')
        comma = index(word, ',')
        yes = comma > first .and. comma <= first + 3 .and. first <= 2 .and. len(word) == comma + 3
        if (yes) yes = word(first:first) /= '0' .and. verify(word(first:comma - 1), digits) == 0 &
            .and. verify(word(comma + 1:), digits) == 0
    end function may_part_thousands

    ! ---- the table ---------------------------------------------------------------------------

    !> Place of a column; 0 if there is none of that name.
    pure integer function column(self, name) result(i)
        class(table), intent(in) :: self
        character(len=*), intent(in) :: name

        do i = size(self%names), 1, -1
            if (self%names(i)%text == name) return
        end do
    end function column

    !> The numbers of a column that is there; none of a table with faults. (gfortran 14 checks the
    !> bounds of an array section before it calls a function that stands among them.)
    pure function numbers(self, name) result(values)
        class(table), intent(in) :: self
        character(len=*), intent(in) :: name
        real(dp), allocatable :: values(:)
        integer :: place

        allocate (values(size(self%values, 2)))
        if (size(values) == 0) return
        place = self%column(name)
        values = self%values(place, :)
    end function numbers

    !> Notes a fault in a line; line 0 is the file as a whole.
    pure subroutine add_fault(self, line, text)
        class(table), intent(inout) :: self
        integer, intent(in) :: line
        character(len=*), intent(in) :: text

        if (size(self%faults) > most_faults) return
        if (size(self%faults) == most_faults) then
            call append_fault(self%faults, 0, 'and more faults')
        else if (line > 0) then
            call append_fault(self%faults, line, 'line ' // whole_text(line) // ': ' // text)
        else
            call append_fault(self%faults, 0, text)
        end if
    end subroutine add_fault

end module csv_table
