!> Takes the text of namelist groups apart into entries `group, key, values`, in one pass, and finds
!> every fault of the syntax with its line.
!>
!> What Fortran's own reader takes is taken with the same meaning, or refused: null values (two
!> commas in a row), text in quotes over several lines, text after the `/` of a group, which
!> that reader skips. A comma before a comment, or at the start of a line, separates two values, as
!> the standard has it; gfortran (12) takes one between them to be missing.
module namelist_parser
    use fault_list, only : append_fault, fault
    use number_text, only : whole_text
    use printable_text, only : lower, printable
    implicit none
    private

    public :: group_seen, namelist_entry, parse_namelists, parsed_text, value_token

    integer, parameter, public :: most_values = 1000000   !! of a key
    integer, parameter :: most_faults = 40                !! then the rest is not read
    integer, parameter :: most_groups = 100               !! likewise
    character(len=1), parameter :: line_feed = new_line('a')
    character(len=*), parameter :: blanks = ' ' // achar(9) // line_feed

    type :: value_token
        character(len=:), allocatable :: text
        logical :: quoted = .false.
    end type value_token

    !> One assignment.
    type :: namelist_entry
        character(len=:), allocatable :: group, key
        integer :: line = 0
        logical :: subscripted = .false.
        integer :: first = 1, stride = 1   !! places of its values in the list
        logical :: faulty = .false.        !! has been refused already
        logical :: known = .false.         !! some part of the program asked for it
        type(value_token), allocatable :: values(:)
    end type namelist_entry

    type :: group_seen
        character(len=:), allocatable :: name
        integer :: line = 0
        logical :: known = .false.         !! some part of the program asked for it
    end type group_seen

    type :: parsed_text
        type(namelist_entry), allocatable :: entries(:)
        type(group_seen), allocatable :: groups(:)
        type(fault), allocatable :: faults(:)
        logical :: broken = .false.        !! the text could not be read to its end
        integer, private :: n_entries = 0
    end type parsed_text

    !> Where the reader is.
    type :: cursor
        integer :: at = 1                  !! next character
        integer :: line = 1
    end type cursor

contains

    subroutine parse_namelists(lines, parsed)
        character(len=*), intent(in) :: lines       !! each ended by a line feed
        type(parsed_text), intent(out) :: parsed
        character(len=:), allocatable :: text, group
        type(cursor) :: here
        integer :: ended_in, stray_in   ! lines
        logical :: inside

        text = lines // line_feed
        allocate (parsed%entries(64), parsed%groups(0), parsed%faults(0))
        inside = .false.
        ended_in = 0
        stray_in = -1
        group = ''
        do while (.not. parsed%broken)
            call skip_blanks(text, here, also_commas=inside)
            if (here%at > len(text)) exit
            if (starts_group(text, here%at)) then
                here%at = here%at + 1
                call start_group(text, here, inside, group, parsed)
            else if (.not. inside) then
                call refuse_stray_text(text, here, group, ended_in, stray_in, parsed)
            else if (text(here%at:here%at) == '/') then
                here%at = here%at + 1
                inside = .false.
                ended_in = here%line
            else
                call read_entry(text, here, group, parsed)
            end if
            if (size(parsed%faults) >= most_faults .and. .not. parsed%broken) then
                call append_fault(parsed%faults, here%line, 'there are too many faults: what ' &
                    // 'follows is not read')
                parsed%broken = .true.
            end if
        end do
        if (inside .and. .not. parsed%broken) call refuse_open_group(parsed)
        parsed%entries = parsed%entries(:parsed%n_entries)
    end subroutine parse_namelists

    !> Does `&name`, or `$name` as old programs write it, stand here?
    pure logical function starts_group(text, at) result(starts)
        character(len=*), intent(in) :: text
        integer, intent(in) :: at

        starts = .false.
        if (scan(text(at:at), '&$') > 0) starts = len(name_at(text, at + 1)) > 0
    end function starts_group

    !> The start of a group, or `&end`.
    subroutine start_group(text, here, inside, group, parsed)
        character(len=*), intent(in) :: text
        type(cursor), intent(inout) :: here
        logical, intent(inout) :: inside
        character(len=:), allocatable, intent(inout) :: group
        type(parsed_text), intent(inout) :: parsed
        type(group_seen) :: seen
        character(len=:), allocatable :: name
        integer :: i

        name = name_at(text, here%at)
        here%at = here%at + len(name)
        name = lower(name)
        if (inside .and. name /= 'end') call refuse_open_group(parsed)
        inside = name /= 'end'
        if (.not. inside) return
        group = name
        do i = 1, size(parsed%groups)
            if (parsed%groups(i)%name /= group) cycle
            call append_fault(parsed%faults, here%line, 'group &' // group &
                // ' is given twice, first in line ' // whole_text(parsed%groups(i)%line))
            exit
        end do
        seen%name = group
        seen%line = here%line
        parsed%groups = [parsed%groups, seen]
        if (size(parsed%groups) <= most_groups) return
        call append_fault(parsed%faults, here%line, 'there are too many groups: what follows ' &
            // 'is not read')
        parsed%broken = .true.
    end subroutine start_group

    !> The group that was opened last has no end.
    subroutine refuse_open_group(parsed)
        type(parsed_text), intent(inout) :: parsed

        associate (group => parsed%groups(size(parsed%groups)))
            call append_fault(parsed%faults, group%line, 'group &' // group%name &
                // " is not ended by '/'")
        end associate
    end subroutine refuse_open_group

    !> Fortran's own reader skips what stands outside groups; then so it would a group whose `&` was
    !> forgotten. Lines in a row are one fault.
    subroutine refuse_stray_text(text, here, group, ended_in, stray_in, parsed)
        character(len=*), intent(in) :: text, group   !! the group before
        type(cursor), intent(inout) :: here
        integer, intent(in) :: ended_in               !! line in which that ended
        integer, intent(inout) :: stray_in            !! line of the last stray text
        type(parsed_text), intent(inout) :: parsed
        character(len=:), allocatable :: words
        integer :: last

        last = line_end(text, here%at)
        words = printable(text(here%at:last))
        here%at = last + 1
        if (here%line == ended_in) then
            call append_fault(parsed%faults, here%line, "text after the '/' that ends &" &
                // group // ": '" // words // "' (a comment starts with '!')")
        else if (here%line /= stray_in + 1) then
            call append_fault(parsed%faults, here%line, "text outside any group: '" // words // "'")
        end if
        stray_in = here%line
    end subroutine refuse_stray_text

    !> `key = values`, `key(i) = ...` or `key(i:j:k) = ...`
    subroutine read_entry(text, here, group, parsed)
        character(len=*), intent(in) :: text, group
        type(cursor), intent(inout) :: here
        type(parsed_text), intent(inout) :: parsed
        type(namelist_entry) :: entry
        character(len=:), allocatable :: problem, name
        integer :: most   ! values

        name = name_at(text, here%at)
        if (len(name) == 0) then
            name = word_at(text, here%at)
            if (len(name) == 0) name = text(here%at:here%at)
            call append_fault(parsed%faults, here%line, '&' // group &
                // ": expected 'key = value', found '" // printable(name) // "'")
            here%at = here%at + len(name)
            return
        end if
        entry%group = group
        entry%line = here%line
        entry%key = lower(name)
        here%at = here%at + len(name)
        problem = ''
        call read_subscript(text, here, entry, most, problem)
        call skip_blanks(text, here, also_commas=.false.)
        if (here%at > len(text)) then
            if (len(problem) == 0) problem = "expected '=' after the key"
        else if (text(here%at:here%at) == '=') then
            here%at = here%at + 1
            call read_values(text, here, entry, parsed%broken, problem)
            if (len(problem) == 0) call check_number_of_values(entry, most, problem)
        else
            if (len(problem) == 0) problem = "expected '=' after the key"
            if (scan(text(here%at:here%at), '/&$') == 0) here%at = here%at &
                + max(1, len(word_at(text, here%at)))
        end if
        entry%faulty = len(problem) > 0
        if (entry%faulty) call append_fault(parsed%faults, entry%line, '&' // group // ' ' &
            // entry%key // ': ' // problem)
        if (.not. allocated(entry%values)) allocate (entry%values(0))
        call append(parsed, entry)
    end subroutine read_entry

    subroutine append(parsed, entry)
        type(parsed_text), intent(inout) :: parsed
        type(namelist_entry), intent(in) :: entry
        type(namelist_entry), allocatable :: more(:)

        if (parsed%n_entries == size(parsed%entries)) then
            allocate (more(2 * parsed%n_entries))
            more(:parsed%n_entries) = parsed%entries
            call move_alloc(more, parsed%entries)
        end if
        parsed%n_entries = parsed%n_entries + 1
        parsed%entries(parsed%n_entries) = entry
    end subroutine append

    ! ---- subscripts --------------------------------------------------------------------------

    !> After `(i)` the values fill the places from `i` on; `(i:j:k)` names each of its places.
    subroutine read_subscript(text, here, entry, most, problem)
        character(len=*), intent(in) :: text
        type(cursor), intent(inout) :: here
        type(namelist_entry), intent(inout) :: entry
        integer, intent(out) :: most    !! values that the subscript has places for
        character(len=:), allocatable, intent(inout) :: problem
        character(len=:), allocatable :: inner
        integer :: start, bracket

        most = most_values
        start = here%at + verify(text(here%at:line_end(text, here%at) + 1), ' ' // achar(9)) - 1
        if (text(start:start) /= '(') return
        entry%subscripted = .true.
        bracket = index(text(start:line_end(text, start)), ')')
        if (bracket == 0) then
            problem = "subscript without ')'"
            here%at = line_end(text, start) + 1
            return
        end if
        inner = text(start + 1:start + bracket - 2)
        here%at = start + bracket
        call take_places(inner, entry, most, problem)
        if (len(problem) > 0) problem = "'(" // printable(inner) // ")' " // problem
    end subroutine read_subscript

    subroutine take_places(inner, entry, most, problem)
        character(len=*), intent(in) :: inner   !! between the brackets
        type(namelist_entry), intent(inout) :: entry
        integer, intent(inout) :: most
        character(len=:), allocatable, intent(inout) :: problem
        integer :: colon, second, last
        logical :: ok(3)

        last = most_values
        ok = .true.
        colon = index(inner, ':')
        second = index(inner, ':', back=.true.)
        if (colon == 0) then
            call read_place(inner, .false., entry%first, ok(1))
        else
            if (second == colon) second = len(inner) + 1
            if (second < len(inner) + 1) call read_place(inner(second + 1:), .false., &
                entry%stride, ok(3))
            if (entry%stride < 0) last = 1
            call read_place(inner(:colon - 1), entry%stride > 0, entry%first, ok(1))
            call read_place(inner(colon + 1:second - 1), .true., last, ok(2))
        end if
        if (.not. all(ok) .or. entry%stride == 0) then
            problem = 'is not a subscript'
        else if (min(entry%first, last) < 1 .or. max(entry%first, last) > most_values) then
            problem = 'is outside the list, whose places are 1 to 1000000'
        else if (colon > 0) then
            most = max(0, (last - entry%first + entry%stride) / entry%stride)
            if (most == 0) problem = 'has no places'
        end if
    end subroutine take_places

    !> A whole number; an empty text leaves `place` as it is, where that is allowed.
    pure subroutine read_place(text, may_be_empty, place, ok)
        character(len=*), intent(in) :: text
        logical, intent(in) :: may_be_empty
        integer, intent(inout) :: place
        logical, intent(out) :: ok
        integer, parameter :: most_digits = 9
        character(len=:), allocatable :: word
        integer :: first

        word = trim(adjustl(text))
        ok = may_be_empty
        if (len(word) == 0) return
        first = 1
        if (scan(word, '+-') == 1) first = 2
        ok = first <= len(word) .and. len(word) <= most_digits &
            .and. verify(word(first:), '0123456789') == 0
        if (ok) read (word, *) place
    end subroutine read_place

    subroutine check_number_of_values(entry, most, problem)
        type(namelist_entry), intent(in) :: entry
        integer, intent(in) :: most
        character(len=:), allocatable, intent(inout) :: problem
        integer :: n

        n = size(entry%values)
        if (n > most) then
            problem = 'has ' // whole_text(n) // ' values for the ' // whole_text(most) &
                // ' places of its subscript'
        else if (entry%first + real(n - 1) * entry%stride > most_values) then
            problem = 'has values beyond place 1000000'
        end if
    end subroutine check_number_of_values

    ! ---- values ------------------------------------------------------------------------------

    !> Values up to the next key or the end of the group.
    subroutine read_values(text, here, entry, broken, problem)
        character(len=*), intent(in) :: text
        type(cursor), intent(inout) :: here
        type(namelist_entry), intent(inout) :: entry
        logical, intent(inout) :: broken
        character(len=:), allocatable, intent(inout) :: problem   !! the first one stays
        type(value_token), allocatable :: tokens(:)
        type(value_token) :: token
        character(len=:), allocatable :: why
        integer :: n, repeat
        logical :: after_comma

        allocate (tokens(8))
        n = 0
        after_comma = .true.
        do while (.not. broken)
            call skip_blanks(text, here, also_commas=.false.)
            if (here%at > len(text)) exit
            why = ''
            if (text(here%at:here%at) == ',') then
                if (after_comma) why = 'a value is missing before a comma'
                after_comma = .true.
                here%at = here%at + 1
            else if (text(here%at:here%at) == '/' .or. starts_group(text, here%at) &
                .or. key_follows(text, here%at)) then
                exit
            else if (scan(text(here%at:here%at), '&$') > 0) then
                why = "'" // text(here%at:here%at) // "' is no value; lists go on in the next " &
                    // 'line without it'
                here%at = here%at + 1
            else
                call read_token(text, here, token, repeat, broken, why)
                after_comma = .false.
                call add_tokens(tokens, n, token, repeat, why)
            end if
            if (len(problem) == 0) problem = why
        end do
        entry%values = tokens(:n)
        if (n == 0 .and. len(problem) == 0) problem = 'has no value'
    end subroutine read_values

    pure subroutine add_tokens(tokens, n, token, repeat, problem)
        type(value_token), allocatable, intent(inout) :: tokens(:)
        integer, intent(inout) :: n
        type(value_token), intent(in) :: token
        integer, intent(in) :: repeat
        character(len=:), allocatable, intent(inout) :: problem
        type(value_token), allocatable :: more(:)
        integer :: i

        if (n + repeat > most_values) then
            problem = 'has more than 1000000 values'
            return
        end if
        if (n + repeat > size(tokens)) then
            allocate (more(2 * (n + repeat)))
            do i = 1, n
                call move_alloc(tokens(i)%text, more(i)%text)
                more(i)%quoted = tokens(i)%quoted
            end do
            call move_alloc(more, tokens)
        end if
        do i = n + 1, n + repeat
            tokens(i) = token
        end do
        n = n + repeat
    end subroutine add_tokens

    !> Is the word here a key, that is, followed by '=' (perhaps after a subscript)?
    pure logical function key_follows(text, at) result(follows)
        character(len=*), intent(in) :: text
        integer, intent(in) :: at
        integer :: i, length, bracket

        follows = .false.
        length = len(name_at(text, at))
        if (length == 0) return
        i = past_blanks(text, at + length)
        if (i > len(text)) return
        if (text(i:i) == '(') then
            bracket = index(text(i:line_end(text, i)), ')')
            if (bracket == 0) return
            i = past_blanks(text, i + bracket)
            if (i > len(text)) return
        end if
        follows = text(i:i) == '='
    end function key_follows

    !> One value, quoted or not, with its repeat count `r*value`; `repeat` is 0 where there is none.
    subroutine read_token(text, here, token, repeat, broken, problem)
        character(len=*), intent(in) :: text
        type(cursor), intent(inout) :: here
        type(value_token), intent(out) :: token
        integer, intent(out) :: repeat
        logical, intent(inout) :: broken
        character(len=:), allocatable, intent(inout) :: problem
        character(len=:), allocatable :: word
        integer :: star
        logical :: ok

        repeat = 1
        word = word_at(text, here%at)
        star = index(word, '*')
        if (star > 1) then
            if (verify(word(:star - 1), '0123456789') > 0) star = 0
        end if
        if (star > 1) then
            call read_place(word(:star - 1), .false., repeat, ok)
            if (.not. ok .or. repeat < 1) problem = "'" // printable(word) &
                // "' repeats a value too often, or not at all"
            if (len(problem) > 0) repeat = 0
            here%at = here%at + star
            word = word(star + 1:)
            if (len(word) == 0 .and. scan(text(here%at:here%at), '''"') == 0) then
                problem = 'a value is missing after a repeat count'
                repeat = 0
                token%text = ''
                return
            end if
        end if
        token%quoted = scan(text(here%at:here%at), '''"') > 0
        if (token%quoted) then
            call read_quoted(text, here, token%text, broken, problem)
        else
            token%text = word
            here%at = here%at + len(word)
        end if
    end subroutine read_token

    !> Text up to the quote that ends it, which stands twice where it belongs to the text. Behind a
    !> quote that is missing nothing can be told: `broken`.
    subroutine read_quoted(text, here, inner, broken, problem)
        character(len=*), intent(in) :: text
        type(cursor), intent(inout) :: here
        character(len=:), allocatable, intent(out) :: inner
        logical, intent(inout) :: broken
        character(len=:), allocatable, intent(inout) :: problem
        character(len=1) :: quote
        integer :: last, length, n

        quote = text(here%at:here%at)
        last = line_end(text, here%at)
        inner = text(here%at:last)
        n = 0
        here%at = here%at + 1
        do
            length = index(text(here%at:last), quote) - 1
            if (length < 0) then
                problem = 'the text ' // quote // printable(inner(:n) // text(here%at:last)) &
                    // ' is not ended by a quote'
                broken = .true.
                return
            end if
            inner(n + 1:n + length) = text(here%at:here%at + length - 1)
            n = n + length
            here%at = here%at + length + 1
            if (text(here%at:here%at) /= quote) exit
            n = n + 1
            inner(n:n) = quote
            here%at = here%at + 1
        end do
        inner = inner(:n)
        if (is_blank(text(here%at:here%at)) .or. scan(text(here%at:here%at), ',/!&$') > 0) return
        problem = 'the text ' // quote // printable(inner) // quote // ' is followed by ' &
            // printable(text(here%at:last)) // ': a quote or a comma is missing'
        broken = .true.
    end subroutine read_quoted

    ! ---- characters --------------------------------------------------------------------------

    !> Moves past blanks, comments and, between entries, commas.
    pure subroutine skip_blanks(text, here, also_commas)
        character(len=*), intent(in) :: text
        type(cursor), intent(inout) :: here
        logical, intent(in) :: also_commas

        do while (here%at <= len(text))
            if (text(here%at:here%at) == '!') then
                here%at = line_end(text, here%at) + 1
            else if (is_blank(text(here%at:here%at))) then
                if (text(here%at:here%at) == line_feed) here%line = here%line + 1
                here%at = here%at + 1
            else if (also_commas .and. text(here%at:here%at) == ',') then
                here%at = here%at + 1
            else
                exit
            end if
        end do
    end subroutine skip_blanks

    !> The first place from `at` on that is not blank.
    pure integer function past_blanks(text, at) result(place)
        character(len=*), intent(in) :: text
        integer, intent(in) :: at

        place = verify(text(at:), blanks) + at - 1
        if (place < at) place = len(text) + 1
    end function past_blanks

    pure logical function is_blank(c) result(blank)
        character(len=1), intent(in) :: c

        blank = scan(c, blanks) > 0
    end function is_blank

    !> The last character before the end of the line.
    pure integer function line_end(text, at) result(last)
        character(len=*), intent(in) :: text   !! ended by a line feed
        integer, intent(in) :: at

        last = at + index(text(at:), line_feed) - 2
    end function line_end

    !> The name that starts here; empty if none does.
    pure function name_at(text, at) result(name)
        character(len=*), intent(in) :: text   !! ended by a line feed
        integer, intent(in) :: at
        character(len=:), allocatable :: name
        character(len=*), &
            parameter :: letters = 'abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ'

        name = ''
        if (scan(text(at:at), letters) > 0) name = text(at:at - 2 + verify(text(at:), letters &
            // '0123456789_%'))
    end function name_at

    !> Up to a blank, a comma, a comment, or a sign that ends the group.
    pure function word_at(text, at) result(word)
        character(len=*), intent(in) :: text   !! ended by a line feed
        integer, intent(in) :: at
        character(len=:), allocatable :: word

        word = text(at:at - 2 + scan(text(at:), blanks // ',/!&$'))
    end function word_at

end module namelist_parser
