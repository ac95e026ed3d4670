!> Reads a file of namelist groups and finds every fault in it, with its line.
!>
!> A Fortran `read` with a namelist stops at the first fault and says little about it. Here the file
!> is first taken apart into entries `group, key, values`; the program then asks for each key that
!> it knows, with its type, rule and default. What nobody asked for is a fault, and so is what
!> breaks its rule. Faults are collected, not thrown.
module namelist_input
    use, intrinsic :: ieee_arithmetic, only : ieee_is_finite, ieee_overflow, ieee_set_halting_mode
    use, intrinsic :: iso_fortran_env, only : dp => real64, iostat_end, iostat_eor
    use platform, only : is_directory
    implicit none
    private

    public :: above, any_number, at_least, between, fault, lower, namelist_file, &
        read_namelist_file, read_number, rule

    !> The numbers that a key may take.
    type :: rule
        real(dp) :: low = -huge(1.0_dp)
        real(dp) :: high = huge(1.0_dp)
        logical :: low_excluded = .false.
        character(len=:), allocatable :: text   !! in words, after "must be"
    end type rule

    type :: value_token
        character(len=:), allocatable :: text
        logical :: quoted = .false.
    end type value_token

    !> One assignment of the file.
    type :: namelist_entry
        character(len=:), allocatable :: group, key
        integer :: first = 0             !! first subscript; 0 without one
        integer :: line = 0
        logical :: known = .false.       !! some part of the program asked for it
        type(value_token), allocatable :: values(:)
    end type namelist_entry

    type :: group_seen
        character(len=:), allocatable :: name
        integer :: line = 0
        logical :: known = .false.
    end type group_seen

    type :: fault
        integer :: line = 0                     !! 0: of the file as a whole
        character(len=:), allocatable :: text
    end type fault

    type :: namelist_file
        character(len=:), allocatable :: name
        type(namelist_entry), allocatable :: entries(:)
        type(group_seen), allocatable :: groups(:)
        type(fault), allocatable :: faults(:)
    contains
        procedure :: get_real, get_reals, get_integer, get_choice, get_choices, get_text, &
            get_logical
        procedure :: has_group, given, require, reject, add_fault, refuse_unknown, describe_faults
        procedure :: substitute, value_of, remove, listing
    end type namelist_file

contains

    pure function any_number() result(r)
        type(rule) :: r

        r%text = 'a number'
    end function any_number

    pure function above(low) result(r)
        real(dp), intent(in) :: low
        type(rule) :: r

        r%low = low
        r%low_excluded = .true.
        r%text = '> ' // short(low)
    end function above

    pure function at_least(low) result(r)
        real(dp), intent(in) :: low
        type(rule) :: r

        r%low = low
        r%text = '>= ' // short(low)
    end function at_least

    !> From `low` to `high`, both included.
    pure function between(low, high) result(r)
        real(dp), intent(in) :: low, high
        type(rule) :: r

        r%low = low
        r%high = high
        r%text = 'from ' // short(low) // ' to ' // short(high)
    end function between

    !> Reads a file whole and takes it apart. `problem` is empty unless the file cannot be read.
    subroutine read_namelist_file(name, file, problem)
        character(len=*), intent(in) :: name
        type(namelist_file), intent(out) :: file
        character(len=:), allocatable, intent(out) :: problem
        character(len=:), allocatable :: text

        file%name = name
        allocate (file%entries(0), file%groups(0), file%faults(0))
        call read_whole(name, text, problem)
        if (len(problem) == 0) call take_apart(text, file)
    end subroutine read_namelist_file

    subroutine read_whole(name, text, problem)
        character(len=*), intent(in) :: name
        character(len=:), allocatable, intent(out) :: text      !! lines, each ended by a newline
        character(len=:), allocatable, intent(out) :: problem
        character(len=1024) :: chunk
        character(len=256) :: message
        integer :: unit, status, length

        text = ''
        problem = ''
        if (is_directory(name)) then
            problem = 'is a directory'
            return
        end if
        open (newunit=unit, file=name, status='old', action='read', iostat=status, iomsg=message)
        if (status /= 0) then
            problem = trim(message)
            return
        end if
        do
            read (unit, '(a)', advance='no', size=length, iostat=status, iomsg=message) chunk
            if (status == iostat_end) exit
            if (status /= 0 .and. status /= iostat_eor) then
                problem = trim(message)
                exit
            end if
            text = text // chunk(:length)
            if (status == iostat_eor) text = text // new_line('a')
        end do
        close (unit)
        text = text // new_line('a')
    end subroutine read_whole

    ! ---- taking the text apart ---------------------------------------------------------------

    !> Scans the text once: groups, keys with subscripts, values.
    subroutine take_apart(text, file)
        character(len=*), intent(in) :: text
        type(namelist_file), intent(inout) :: file
        character(len=:), allocatable :: group, name, word
        integer :: at, line
        logical :: inside

        at = 1
        line = 1
        inside = .false.
        group = ''
        do
            call skip_blanks(text, at, line, also_commas=inside)
            if (at > len(text)) exit
            if (text(at:at) == '&') then
                at = at + 1
                name = lower(name_at(text, at))
                if (inside .and. name /= 'end') call not_ended(file)
                inside = name /= 'end'
                if (inside) group = name
                if (inside) call open_group(file, group, line)
            else if (.not. inside) then
                word = rest_of_line(text, at)
                call file%add_fault(line, "text outside any group: '" // word // "'")
                at = at + len(word)
            else if (text(at:at) == '/') then
                at = at + 1
                inside = .false.
            else
                call read_entry(text, at, line, group, file)
            end if
        end do
        if (inside) call not_ended(file)
    end subroutine take_apart

    !> The group that was opened last has no end.
    subroutine not_ended(file)
        type(namelist_file), intent(inout) :: file

        associate (group => file%groups(size(file%groups)))
            call file%add_fault(group%line, 'group &' // group%name // " is not ended by '/'")
        end associate
    end subroutine not_ended

    subroutine open_group(file, group, line)
        type(namelist_file), intent(inout) :: file
        character(len=*), intent(in) :: group
        integer, intent(in) :: line
        type(group_seen) :: seen
        integer :: i

        do i = 1, size(file%groups)
            if (file%groups(i)%name == group) then
                call file%add_fault(line, 'group &' // group // ' is given twice, first in line ' &
                    // whole(file%groups(i)%line))
            end if
        end do
        seen%name = group
        seen%line = line
        file%groups = [file%groups, seen]
    end subroutine open_group

    !> `key = values`, `key(i) = ...` or `key(i:j) = ...`
    subroutine read_entry(text, at, line, group, file)
        character(len=*), intent(in) :: text, group
        integer, intent(inout) :: at, line
        type(namelist_file), intent(inout) :: file
        type(namelist_entry) :: entry
        character(len=:), allocatable :: problem

        entry%group = group
        entry%line = line
        entry%key = lower(name_at(text, at))
        allocate (entry%values(0))
        if (len(entry%key) == 0) then
            call file%add_fault(line, '&' // group // ": expected 'key = value', found '" &
                // rest_of_token(text, at) // "'")
            at = at + len(rest_of_token(text, at))
            return
        end if
        problem = ''
        call read_subscript(text, at, entry%first, problem)
        call skip_blanks(text, at, line, also_commas=.false.)
        if (at > len(text)) then
            problem = "expected '=' after the key"
        else if (text(at:at) /= '=') then
            problem = "expected '=' after the key"
        end if
        if (len(problem) > 0) then
            call file%add_fault(line, '&' // group // ' ' // entry%key // ': ' // problem)
            if (at <= len(text)) then
                if (index('/&', text(at:at)) == 0) at = at + len(rest_of_token(text, at))
            end if
            return
        end if
        at = at + 1
        call read_values(text, at, line, entry, problem)
        if (len(problem) > 0) then
            call file%add_fault(entry%line, '&' // group // ' ' // entry%key // ': ' // problem)
        end if
        file%entries = [file%entries, entry]
    end subroutine read_entry

    subroutine read_subscript(text, at, first, problem)
        character(len=*), intent(in) :: text
        integer, intent(inout) :: at
        integer, intent(out) :: first
        character(len=:), allocatable, intent(inout) :: problem
        character(len=:), allocatable :: inner
        integer :: bracket, colon, status

        first = 0
        do while (at < len(text))
            if (text(at:at) /= ' ') exit
            at = at + 1
        end do
        if (at > len(text)) return
        if (text(at:at) /= '(') return
        bracket = index(text(at:), ')')
        if (bracket == 0) then
            problem = "subscript without ')'"
            return
        end if
        inner = text(at + 1:at + bracket - 2)
        at = at + bracket
        colon = index(inner, ':')
        if (colon > 0) inner = inner(:colon - 1)   ! the values themselves tell how many they are
        first = 1
        if (len_trim(inner) == 0) return
        status = verify(trim(adjustl(inner)), '0123456789')
        if (status == 0) read (inner, *, iostat=status) first
        if (status /= 0 .or. first < 1) problem = "'(" // inner // ")' is not a subscript"
    end subroutine read_subscript

    !> Values up to the next key or the end of the group.
    subroutine read_values(text, at, line, entry, problem)
        character(len=*), intent(in) :: text
        integer, intent(inout) :: at, line
        type(namelist_entry), intent(inout) :: entry
        character(len=:), allocatable, intent(inout) :: problem
        type(value_token) :: token
        integer :: repeat, i
        logical :: after_comma

        after_comma = .true.
        do
            call skip_blanks(text, at, line, also_commas=.false.)
            if (at > len(text)) exit
            if (text(at:at) == ',') then
                if (after_comma) problem = 'a value is missing before a comma'
                after_comma = .true.
                at = at + 1
                cycle
            end if
            if (index('/&', text(at:at)) > 0) exit
            if (key_follows(text, at)) exit
            call read_token(text, at, token, repeat, problem)
            after_comma = .false.
            do i = 1, repeat
                entry%values = [entry%values, token]
            end do
        end do
        if (size(entry%values) == 0) problem = 'has no value'
    end subroutine read_values

    !> Is the word here a key, that is, followed by '=' (perhaps after a subscript)?
    function key_follows(text, at) result(follows)
        character(len=*), intent(in) :: text
        integer, intent(in) :: at
        logical :: follows
        integer :: i

        follows = .false.
        i = at
        if (len(name_at(text, i)) == 0) return
        i = i + verify_blank(text, i)
        if (i > len(text)) return
        if (text(i:i) == '(') then
            i = i + index(text(i:) // ')', ')')
            i = i + verify_blank(text, i)
            if (i > len(text)) return
        end if
        follows = text(i:i) == '='
    end function key_follows

    !> Number of blanks, tabs and newlines at a place.
    pure function verify_blank(text, at) result(count)
        character(len=*), intent(in) :: text
        integer, intent(in) :: at
        integer :: count

        count = 0
        do while (at + count <= len(text))
            if (.not. is_blank(text(at + count:at + count))) exit
            count = count + 1
        end do
    end function verify_blank

    !> One value, quoted or not, with its repeat count `r*value`.
    subroutine read_token(text, at, token, repeat, problem)
        character(len=*), intent(in) :: text
        integer, intent(inout) :: at
        type(value_token), intent(out) :: token
        integer, intent(out) :: repeat
        character(len=:), allocatable, intent(inout) :: problem
        integer, parameter :: most = 100000
        integer :: star, status
        character(len=:), allocatable :: word

        repeat = 1
        token%text = ''
        if (text(at:at) == "'" .or. text(at:at) == '"') then
            call read_quoted(text, at, token%text, problem)
            token%quoted = .true.
            return
        end if
        word = rest_of_token(text, at)
        at = at + len(word)
        token%text = word
        star = index(word, '*')
        if (star <= 1) return
        if (verify(word(:star - 1), '0123456789') /= 0) return
        read (word(:star - 1), *, iostat=status) repeat
        if (status /= 0 .or. repeat < 1 .or. repeat > most) then
            problem = "'" // word // "' repeats a value too often, or not at all"
            repeat = 0
        end if
        token%text = word(star + 1:)
    end subroutine read_token

    subroutine read_quoted(text, at, inner, problem)
        character(len=*), intent(in) :: text
        integer, intent(inout) :: at
        character(len=:), allocatable, intent(out) :: inner
        character(len=:), allocatable, intent(inout) :: problem
        character(len=1) :: quote

        quote = text(at:at)
        inner = ''
        at = at + 1
        do
            if (at > len(text)) then
                problem = 'text is not ended by a quote'
                return
            end if
            if (text(at:at) == new_line('a')) then
                problem = 'text is not ended by a quote'
                return
            end if
            if (text(at:at) == quote) then
                at = at + 1
                if (at > len(text)) return
                if (text(at:at) /= quote) return
            end if
            inner = inner // text(at:at)
            at = at + 1
        end do
    end subroutine read_quoted

    !> Moves past blanks, comments and, between entries, commas.
    subroutine skip_blanks(text, at, line, also_commas)
        character(len=*), intent(in) :: text
        integer, intent(inout) :: at, line
        logical, intent(in) :: also_commas

        do while (at <= len(text))
            if (text(at:at) == '!') then
                at = at + len(rest_of_line(text, at))
            else if (is_blank(text(at:at))) then
                if (text(at:at) == new_line('a')) line = line + 1
                at = at + 1
            else if (also_commas .and. text(at:at) == ',') then
                at = at + 1
            else
                exit
            end if
        end do
    end subroutine skip_blanks

    pure function is_blank(c) result(blank)
        character(len=1), intent(in) :: c
        logical :: blank

        blank = c == ' ' .or. c == achar(9) .or. c == achar(13) .or. c == new_line('a')
    end function is_blank

    !> The name that starts here, and `at` moved behind it; empty if none does.
    function name_at(text, at) result(name)
        character(len=*), intent(in) :: text
        integer, intent(inout) :: at
        character(len=:), allocatable :: name
        character(len=*), &
            parameter :: letters = 'abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ'
        integer :: start

        start = at
        if (index(letters, text(at:at)) > 0) then
            do while (at <= len(text))
                if (index(letters // '0123456789_%', text(at:at)) == 0) exit
                at = at + 1
            end do
        end if
        name = text(start:at - 1)
    end function name_at

    pure function rest_of_line(text, at) result(rest)
        character(len=*), intent(in) :: text
        integer, intent(in) :: at
        character(len=:), allocatable :: rest

        rest = text(at:at - 2 + index(text(at:) // new_line('a'), new_line('a')))
    end function rest_of_line

    !> Up to a blank, a comma, a comment, or a sign that ends the group.
    pure function rest_of_token(text, at) result(rest)
        character(len=*), intent(in) :: text
        integer, intent(in) :: at
        character(len=:), allocatable :: rest
        integer :: i

        do i = at, len(text)
            if (is_blank(text(i:i)) .or. index(',/!&', text(i:i)) > 0) exit
        end do
        rest = text(at:max(at, i - 1))
    end function rest_of_token

    ! ---- asking for keys ---------------------------------------------------------------------

    !> Is the group in the file? Says that the program knows it.
    function has_group(self, group) result(found)
        class(namelist_file), intent(inout) :: self
        character(len=*), intent(in) :: group
        logical :: found
        integer :: i

        found = .false.
        do i = 1, size(self%groups)
            if (self%groups(i)%name /= group) cycle
            self%groups(i)%known = .true.
            found = .true.
        end do
    end function has_group

    !> Is the key in the file?
    pure function given(self, group, key) result(found)
        class(namelist_file), intent(in) :: self
        character(len=*), intent(in) :: group, key
        logical :: found
        integer :: i

        found = .false.
        do i = 1, size(self%entries)
            if (self%entries(i)%group == group .and. self%entries(i)%key == key) found = .true.
        end do
    end function given

    !> A number. Without a default, leaving the key out is a fault.
    subroutine get_real(self, group, key, value, allowed, default)
        class(namelist_file), intent(inout) :: self
        character(len=*), intent(in) :: group, key
        real(dp), intent(out) :: value
        type(rule), intent(in) :: allowed
        real(dp), intent(in), optional :: default
        real(dp), allocatable :: values(:)

        value = 0.0_dp
        if (present(default)) value = default
        if (.not. self%given(group, key)) then
            if (.not. present(default)) call self%require(group, key)
            return
        end if
        call self%get_reals(group, key, values, allowed)
        if (size(values) > 1) then
            call self%reject(group, key, 'takes one value, not ' // whole(size(values)))
        end if
        if (size(values) > 0) value = values(1)
    end subroutine get_real

    !> A list of numbers; empty if the key is not given or one of its values is no number.
    subroutine get_reals(self, group, key, values, allowed)
        class(namelist_file), intent(inout) :: self
        character(len=*), intent(in) :: group, key
        real(dp), allocatable, intent(out) :: values(:)
        type(rule), intent(in) :: allowed
        type(value_token), allocatable :: tokens(:)
        integer :: i
        logical :: ok, sound

        call gather(self, group, key, tokens)
        allocate (values(size(tokens)))
        sound = .true.
        do i = 1, size(tokens)
            call read_number(tokens(i)%text, values(i), ok)
            ok = ok .and. .not. tokens(i)%quoted
            sound = sound .and. ok
            if (.not. ok) then
                call self%reject(group, key, 'must be a number', token=tokens(i))
            else if (.not. ieee_is_finite(values(i))) then
                call self%reject(group, key, 'must be finite', token=tokens(i))
                sound = .false.
            else if (values(i) < allowed%low .or. values(i) > allowed%high &
                .or. (allowed%low_excluded .and. .not. values(i) > allowed%low)) then
                call self%reject(group, key, 'must be ' // allowed%text, token=tokens(i))
            end if
        end do
        if (.not. sound) values = [real(dp) ::]
    end subroutine get_reals

    !> A whole number.
    subroutine get_integer(self, group, key, value, allowed, default)
        class(namelist_file), intent(inout) :: self
        character(len=*), intent(in) :: group, key
        integer, intent(out) :: value
        type(rule), intent(in) :: allowed
        integer, intent(in) :: default
        real(dp) :: number

        call self%get_real(group, key, number, allowed, default=real(default, dp))
        value = default
        if (abs(number) > real(huge(value), dp)) then
            call self%reject(group, key, 'must be a whole number that can be counted to')
        else if (abs(number - anint(number)) > 0.0_dp) then
            call self%reject(group, key, 'must be a whole number')
        else
            value = nint(number)
        end if
    end subroutine get_integer

    !> One of a few texts.
    subroutine get_choice(self, group, key, value, choices, default)
        class(namelist_file), intent(inout) :: self
        character(len=*), intent(in) :: group, key
        character(len=:), allocatable, intent(out) :: value
        character(len=*), intent(in) :: choices(:)
        character(len=*), intent(in) :: default
        integer, allocatable :: places(:)

        value = default
        call self%get_choices(group, key, places, choices)
        if (size(places) > 1) then
            call self%reject(group, key, 'takes one value, not ' // whole(size(places)))
        else if (size(places) == 1) then
            value = trim(choices(places(1)))
        end if
    end subroutine get_choice

    !> A list of texts of which each is one of a few, as places in `choices`; empty if the key is
    !> not given or one of its values is none of them.
    subroutine get_choices(self, group, key, places, choices)
        class(namelist_file), intent(inout) :: self
        character(len=*), intent(in) :: group, key
        integer, allocatable, intent(out) :: places(:)
        character(len=*), intent(in) :: choices(:)
        type(value_token), allocatable :: tokens(:)
        character(len=:), allocatable :: list
        integer :: i

        list = "'" // trim(choices(1)) // "'"
        do i = 2, size(choices)
            list = list // ", '" // trim(choices(i)) // "'"
        end do
        if (size(choices) > 1) list = 'one of ' // list
        call gather(self, group, key, tokens)
        allocate (places(size(tokens)))
        do i = 1, size(tokens)
            places(i) = place_in(choices, lower(tokens(i)%text))
            if (.not. tokens(i)%quoted) then
                call self%reject(group, key, 'must be text in quotes, ' // list, token=tokens(i))
                places(i) = 0
            else if (places(i) == 0) then
                call self%reject(group, key, 'must be ' // list, token=tokens(i))
            end if
        end do
        if (any(places == 0)) places = [integer ::]
    end subroutine get_choices

    !> Any text in quotes; empty if the key is not given.
    subroutine get_text(self, group, key, value)
        class(namelist_file), intent(inout) :: self
        character(len=*), intent(in) :: group, key
        character(len=:), allocatable, intent(out) :: value
        type(value_token), allocatable :: tokens(:)

        value = ''
        call gather(self, group, key, tokens)
        if (size(tokens) == 0) return
        if (size(tokens) > 1) then
            call self%reject(group, key, 'takes one value, not ' // whole(size(tokens)))
        else if (.not. tokens(1)%quoted .or. len_trim(tokens(1)%text) == 0) then
            call self%reject(group, key, 'must be text in quotes', token=tokens(1))
        else
            value = tokens(1)%text
        end if
    end subroutine get_text

    !> True or false, as Fortran writes it.
    subroutine get_logical(self, group, key, value, default)
        class(namelist_file), intent(inout) :: self
        character(len=*), intent(in) :: group, key
        logical, intent(out) :: value
        logical, intent(in) :: default
        type(value_token), allocatable :: tokens(:)
        character(len=7), parameter :: words(6) = ['.true. ', 't      ', 'true   ', &
            '.false.', 'f      ', 'false  ']
        integer :: place

        value = default
        call gather(self, group, key, tokens)
        if (size(tokens) == 0) return
        place = place_in(words, lower(tokens(1)%text))
        if (size(tokens) > 1) then
            call self%reject(group, key, 'takes one value, not ' // whole(size(tokens)))
        else if (tokens(1)%quoted .or. place == 0) then
            call self%reject(group, key, 'must be .true. or .false.', token=tokens(1))
        else
            value = place <= 3
        end if
    end subroutine get_logical

    !> Collects the values of a key in the order of their subscripts, and says that the key is
    !> known.
    subroutine gather(self, group, key, tokens)
        class(namelist_file), intent(inout) :: self
        character(len=*), intent(in) :: group, key
        type(value_token), allocatable, intent(out) :: tokens(:)
        logical, allocatable :: filled(:), longer(:)
        type(value_token), allocatable :: extended(:)
        integer :: i, first, last
        logical :: again

        allocate (tokens(0), filled(0))
        again = .false.
        do i = 1, size(self%entries)
            associate (entry => self%entries(i))
                if (entry%group /= group .or. entry%key /= key) cycle
                entry%known = .true.
                first = max(entry%first, 1)
                last = first + size(entry%values) - 1
                if (last > size(tokens)) then
                    allocate (extended(last), longer(last))
                    extended(:size(tokens)) = tokens
                    longer = .false.
                    longer(:size(filled)) = filled
                    call move_alloc(extended, tokens)
                    call move_alloc(longer, filled)
                end if
                again = again .or. any(filled(first:last))
                tokens(first:last) = entry%values
                filled(first:last) = .true.
            end associate
        end do
        if (again) call self%reject(group, key, 'is given twice')
        if (.not. all(filled)) then
            call self%reject(group, key, 'has gaps between its subscripts')
            tokens = [value_token ::]
        end if
    end subroutine gather

    !> Notes a fault if a key is not given; where its whole group is missing, that fault stands for
    !> it.
    subroutine require(self, group, key)
        class(namelist_file), intent(inout) :: self
        character(len=*), intent(in) :: group, key
        integer :: i

        if (self%given(group, key)) return
        do i = 1, size(self%groups)
            if (self%groups(i)%name /= group) cycle
            call self%add_fault(self%groups(i)%line, '&' // group // ' ' // key &
                // ': is missing and has no default')
            return
        end do
    end subroutine require

    !> Notes a fault of a key, with its value and the rule that it breaks. That key is known then.
    subroutine reject(self, group, key, why, token)
        class(namelist_file), intent(inout) :: self
        character(len=*), intent(in) :: group, key, why
        type(value_token), intent(in), optional :: token
        character(len=:), allocatable :: value
        integer :: i, line

        line = 0
        value = ''
        do i = 1, size(self%entries)
            if (self%entries(i)%group /= group .or. self%entries(i)%key /= key) cycle
            self%entries(i)%known = .true.
            line = self%entries(i)%line
            if (size(self%entries(i)%values) == 1) value = shown(self%entries(i)%values(1))
        end do
        if (present(token)) value = shown(token)
        if (len(value) > 0) value = ' = ' // value
        call self%add_fault(line, '&' // group // ' ' // key // value // ': ' // why)
    end subroutine reject

    pure function shown(token) result(text)
        type(value_token), intent(in) :: token
        character(len=:), allocatable :: text

        text = token%text
        if (token%quoted) text = "'" // text // "'"
    end function shown

    !> Notes every group and key that nobody asked for.
    subroutine refuse_unknown(self)
        class(namelist_file), intent(inout) :: self
        integer :: i

        do i = 1, size(self%groups)
            if (self%groups(i)%known) cycle
            call self%add_fault(self%groups(i)%line, '&' // self%groups(i)%name &
                // ': unknown group')
        end do
        do i = 1, size(self%entries)
            if (self%entries(i)%known .or. .not. known_group(self, self%entries(i)%group)) cycle
            call self%add_fault(self%entries(i)%line, '&' // self%entries(i)%group // ' ' &
                // self%entries(i)%key // ': unknown key')
        end do
    end subroutine refuse_unknown

    pure function known_group(self, name) result(known)
        class(namelist_file), intent(in) :: self
        character(len=*), intent(in) :: name
        logical :: known
        integer :: i

        known = .false.
        do i = 1, size(self%groups)
            if (self%groups(i)%name == name) known = self%groups(i)%known
        end do
    end function known_group

    !> The faults as lines of text, in the order of the file.
    function describe_faults(self) result(text)
        class(namelist_file), intent(in) :: self
        character(len=:), allocatable :: text
        integer :: line, i

        text = ''
        do line = 0, maxval([0, self%faults%line])
            do i = 1, size(self%faults)
                if (self%faults(i)%line /= line) cycle
                text = text // self%name
                if (line > 0) text = text // ':' // whole(line)
                text = text // ': ' // self%faults(i)%text // new_line('a')
            end do
        end do
    end function describe_faults

    !> Gives a key one value in place of all that it has: the i-th value of another key. A key or a
    !> group that the file does not have is added. Faults of it count for the line of the other key.
    subroutine substitute(self, group, key, from_group, from_key, i)
        class(namelist_file), intent(inout) :: self
        character(len=*), intent(in) :: group, key
        character(len=*), intent(in) :: from_group, from_key   !! given, with `i` values or more
        integer, intent(in) :: i                               !! >= 1
        type(value_token), allocatable :: tokens(:)
        type(namelist_entry) :: entry
        type(group_seen) :: seen
        logical :: there
        integer :: j

        call gather(self, from_group, from_key, tokens)
        entry%group = group
        entry%key = key
        entry%values = [tokens(i)]
        do j = 1, size(self%entries)
            if (self%entries(j)%group /= from_group .or. self%entries(j)%key /= from_key) cycle
            entry%line = self%entries(j)%line
        end do
        call self%remove(group, key)
        self%entries = [self%entries, entry]
        there = .false.
        do j = 1, size(self%groups)
            there = there .or. self%groups(j)%name == group
        end do
        if (there) return
        seen%name = group
        seen%line = entry%line
        self%groups = [self%groups, seen]
    end subroutine substitute

    !> The first value of a key as the file has it; empty if it has none.
    pure function value_of(self, group, key) result(text)
        class(namelist_file), intent(in) :: self
        character(len=*), intent(in) :: group, key
        character(len=:), allocatable :: text
        integer :: i

        text = ''
        do i = 1, size(self%entries)
            if (self%entries(i)%group /= group .or. self%entries(i)%key /= key) cycle
            if (size(self%entries(i)%values) > 0) text = shown(self%entries(i)%values(1))
        end do
    end function value_of

    !> Forgets all assignments to a key.
    subroutine remove(self, group, key)
        class(namelist_file), intent(inout) :: self
        character(len=*), intent(in) :: group, key
        type(namelist_entry), allocatable :: kept(:)
        integer :: i

        allocate (kept(0))
        do i = 1, size(self%entries)
            if (self%entries(i)%group == group .and. self%entries(i)%key == key) cycle
            kept = [kept, self%entries(i)]
        end do
        call move_alloc(kept, self%entries)
    end subroutine remove

    !> What the file says, without its comments and its layout: one line an assignment.
    pure function listing(self) result(text)
        class(namelist_file), intent(in) :: self
        character(len=:), allocatable :: text
        integer :: i, j

        text = ''
        do i = 1, size(self%entries)
            associate (entry => self%entries(i))
                text = text // '&' // entry%group // ' ' // entry%key
                if (entry%first > 0) text = text // '(' // whole(entry%first) // ')'
                text = text // ' ='
                do j = 1, size(entry%values)
                    text = text // ' ' // shown(entry%values(j))
                end do
                text = text // new_line('a')
            end associate
        end do
    end function listing

    !> Notes a fault in a line; line 0 is the file as a whole.
    subroutine add_fault(self, line, text)
        class(namelist_file), intent(inout) :: self
        integer, intent(in) :: line
        character(len=*), intent(in) :: text
        type(fault) :: new

        new%line = line
        new%text = text
        self%faults = [self%faults, new]
    end subroutine add_fault

    ! ---- small things ------------------------------------------------------------------------

    !> A real number as Fortran and its neighbours write it; also NaN and infinity, which the caller
    !> refuses by name.
    subroutine read_number(text, value, ok)
        character(len=*), intent(in) :: text
        real(dp), intent(out) :: value
        logical, intent(out) :: ok
        character(len=:), allocatable :: word
        integer :: status, i

        value = 0.0_dp
        word = lower(text)
        ok = len(word) > 0
        if (.not. ok) return
        if (verify(word, '0123456789+-.ed') /= 0) then
            i = 1
            if (index('+-', word(1:1)) > 0) i = 2
            ok = any(word(i:) == ['nan     ', 'inf     ', 'infinity'])
        else
            ! "1-3" is a number to Fortran alone, and "1e" or "." to nobody
            do i = 2, len(word)
                if (index('+-', word(i:i)) > 0) ok = ok .and. index('ed', word(i - 1:i - 1)) > 0
            end do
            ok = ok .and. scan(word, '0123456789') > 0 .and. verify(word(len(word):), &
                '0123456789.') == 0
        end if
        if (.not. ok) return
        call ieee_set_halting_mode(ieee_overflow, .false.)  ! 1e999 is infinite, and refused as such
        read (word, *, iostat=status) value
        ok = status == 0
    end subroutine read_number

    !> Which of the choices is it? 0: none.
    pure function place_in(choices, text) result(place)
        character(len=*), intent(in) :: choices(:), text
        integer :: place

        do place = size(choices), 1, -1
            if (choices(place) == text) return
        end do
    end function place_in

    pure function lower(text) result(lowered)
        character(len=*), intent(in) :: text
        character(len=len(text)) :: lowered
        integer :: i

        lowered = text
        do i = 1, len(text)
            if (text(i:i) >= 'A' .and. text(i:i) <= 'Z') lowered(i:i) = achar(iachar(text(i:i)) &
                + 32)
        end do
    end function lower

    pure function whole(number) result(text)
        integer, intent(in) :: number
        character(len=:), allocatable :: text
        character(len=12) :: buffer

        write (buffer, '(i0)') number
        text = trim(buffer)
    end function whole

    !> A number with no more digits than it needs.
    pure recursive function short(number) result(text)
        real(dp), intent(in) :: number
        character(len=:), allocatable :: text
        character(len=24) :: buffer
        integer :: exponent

        if (abs(number - anint(number)) <= 0.0_dp) then
            text = whole(nint(number))
        else if (abs(number) < 1.0e-3_dp) then
            exponent = floor(log10(abs(number)) + 1.0e-9_dp)
            text = short(1.0e-3_dp * anint(1.0e3_dp * number / 10.0_dp**exponent)) // 'e' &
                // whole(exponent)
        else
            write (buffer, '(f24.3)') number
            text = trim(adjustl(buffer))
            text = text(:verify(text, '0', back=.true.))
        end if
    end function short

end module namelist_input
