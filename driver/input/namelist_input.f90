!> A file of namelist groups, which the program asks for each key that it knows, with its type, rule
!> and default.
!>
!> A Fortran `read` with a namelist stops at the first fault and says little about it. Here what
!> was not asked for is a fault, and so is what breaks its rule. Faults are collected, not thrown.
module namelist_input
    use, intrinsic :: ieee_arithmetic, only : ieee_is_finite
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use fault_list, only : append_fault, fault
    use known_key_list, only : known_keys
    use namelist_parser, only : group_seen, namelist_entry, parse_namelists, parsed_text, &
        value_token
    use namelist_rules, only : above, any_number, at_least, between, not_zero, rule
    use number_reader, only : largest, read_number
    use number_text, only : whole_text
    use printable_text, only : growing_text, lower, printable
    use whole_file, only : plain_text, read_whole_file
    implicit none
    private

    public :: above, any_number, at_least, between, lower, namelist_file, not_zero, &
        read_logical, read_namelist_file, read_namelist_text, rule

    integer, parameter :: most_shown = 50        !! faults
    integer, parameter :: most_of_a_list = 10    !! of its values that are refused one by one

    type :: namelist_file
        character(len=:), allocatable :: name
        type(namelist_entry), allocatable :: entries(:)
        type(group_seen), allocatable :: groups(:)
        type(fault), allocatable :: faults(:)
        type(value_token), allocatable :: files(:)   !! paths of this file and of all that it may
                                                     !! name: its quoted values
        logical, private :: broken = .false.     !! the text could not be read to its end
        integer, private :: not_listed = 0       !! faults that are only counted
        type(known_keys), private :: keys
    contains
        procedure :: get_real, get_reals, get_integer, get_choice, get_choices, get_text, &
            get_logical
        procedure :: has_group, given, require, require_groups, reject, refuse, add_fault, &
            refuse_unknown, describe_faults
        procedure :: line_of_group, belongs_elsewhere, beside, gather
        procedure :: assume, substitute, value_of, remove, listing
    end type namelist_file

contains

    !> Reads a file whole and takes it apart. `problem` is empty unless the file cannot be read.
    subroutine read_namelist_file(name, file, problem)
        character(len=*), intent(in) :: name
        type(namelist_file), intent(out) :: file
        character(len=:), allocatable, intent(out) :: problem
        character(len=:), allocatable :: text

        call read_whole_file(name, text, problem)
        call take_text(name, text, file)
    end subroutine read_namelist_file

    !> Takes a text apart that is in memory already.
    subroutine read_namelist_text(name, text, file, problem)
        character(len=*), intent(in) :: name   !! for messages; files beside it are looked for there
        character(len=*), intent(in) :: text
        type(namelist_file), intent(out) :: file
        character(len=:), allocatable, intent(out) :: problem
        character(len=:), allocatable :: lines

        call plain_text(text, lines, problem)
        if (len(problem) > 0) lines = ''
        call take_text(name, lines, file)
    end subroutine read_namelist_text

    subroutine take_text(name, text, file)
        character(len=*), intent(in) :: name
        character(len=*), intent(in) :: text    !! lines, each ended by a line feed
        type(namelist_file), intent(inout) :: file
        type(parsed_text) :: parsed

        call parse_namelists(text, parsed)
        file%name = name
        file%broken = parsed%broken
        call move_alloc(parsed%entries, file%entries)
        call move_alloc(parsed%groups, file%groups)
        call move_alloc(parsed%faults, file%faults)
        call note_files(file)
    end subroutine take_text

    ! ---- asking for keys ---------------------------------------------------------------------

    !> Is the group in the file? Says that the program knows it.
    function has_group(self, group) result(found)
        class(namelist_file), intent(inout) :: self
        character(len=*), intent(in) :: group
        logical :: found

        call note(self, group, '')
        found = self%line_of_group(group) > 0
    end function has_group

    !> Where does the group start? 0: the file does not have it.
    pure function line_of_group(self, group) result(line)
        class(namelist_file), intent(in) :: self
        character(len=*), intent(in) :: group
        integer :: line
        integer :: i

        line = 0
        do i = size(self%groups), 1, -1
            if (self%groups(i)%name == group) line = self%groups(i)%line
        end do
    end function line_of_group

    subroutine note_files(self)
        class(namelist_file), intent(inout) :: self
        integer :: i, j, n

        n = 1
        do i = 1, size(self%entries)
            n = n + count(self%entries(i)%values%quoted)
        end do
        allocate (self%files(n))
        self%files(1)%text = self%name
        n = 1
        do i = 1, size(self%entries)
            do j = 1, size(self%entries(i)%values)
                associate (value => self%entries(i)%values(j))
                    if (.not. value%quoted) cycle
                    n = n + 1
                    self%files(n)%text = value%text
                    if (index(value%text, '@') == 1) self%files(n)%text = value%text(2:)
                end associate
                if (len(self%files(n)%text) > 0) self%files(n)%text = &
                    self%beside(self%files(n)%text)
            end do
        end do
    end subroutine note_files

    !> A path as seen from the directory of the file.
    pure function beside(self, path) result(full)
        class(namelist_file), intent(in) :: self
        character(len=*), intent(in) :: path   !! not empty
        character(len=:), allocatable :: full

        full = path
        if (path(1:1) /= '/') full = self%name(:index(self%name, '/', back=.true.)) // path
    end function beside

    !> Is the key in the file? Says that the program knows it.
    function given(self, group, key) result(found)
        class(namelist_file), intent(inout) :: self
        character(len=*), intent(in) :: group, key
        logical :: found
        integer, allocatable :: mine(:)

        call note(self, group, key)
        call find(self, group, key, mine)
        found = size(mine) > 0
    end function given

    !> Gives a key that the input leaves out a number.
    subroutine assume(self, group, key, number)
        class(namelist_file), intent(inout) :: self
        character(len=*), intent(in) :: group, key, number
        type(namelist_entry) :: entry

        if (self%given(group, key)) return
        entry%group = group
        entry%key = key
        allocate (entry%values(1))
        entry%values(1)%text = number
        self%entries = [self%entries, entry]
    end subroutine assume

    !> The assignments to a key, as places in the list of entries.
    pure subroutine find(self, group, key, places)
        class(namelist_file), intent(in) :: self
        character(len=*), intent(in) :: group, key
        integer, allocatable, intent(out) :: places(:)
        logical, allocatable :: wanted(:)
        integer :: i

        allocate (wanted(size(self%entries)))
        do i = 1, size(self%entries)
            wanted(i) = self%entries(i)%group == group .and. self%entries(i)%key == key
        end do
        places = pack([(i, i = 1, size(self%entries))], wanted)
    end subroutine find

    !> A number. Without a default, leaving the key out is a fault.
    subroutine get_real(self, group, key, value, allowed, default)
        class(namelist_file), intent(inout) :: self
        character(len=*), intent(in) :: group, key
        real(dp), intent(out) :: value
        type(rule), intent(in) :: allowed
        real(dp), intent(in), optional :: default
        type(value_token) :: token
        character(len=:), allocatable :: why
        logical :: found

        value = 0.0_dp
        if (present(default)) value = default
        if (.not. self%given(group, key)) then
            if (.not. present(default)) call self%require(group, key)
            return
        end if
        call take_one(self, group, key, token, found)
        if (.not. found) return
        call take_number(token, allowed, value, found, why)
        if (len(why) > 0) call self%reject(group, key, why)
    end subroutine get_real

    !> A list of numbers; empty if the key is not given or one of its values is no number.
    subroutine get_reals(self, group, key, values, allowed)
        class(namelist_file), intent(inout) :: self
        character(len=*), intent(in) :: group, key
        real(dp), allocatable, intent(out) :: values(:)
        type(rule), intent(in) :: allowed
        type(value_token), allocatable :: tokens(:)
        character(len=:), allocatable :: why
        integer :: refused, i
        logical :: sound

        call gather(self, group, key, tokens)
        allocate (values(size(tokens)))
        sound = .true.
        refused = 0
        do i = 1, size(tokens)
            call take_number(tokens(i), allowed, values(i), sound, why)
            if (len(why) == 0) cycle
            refused = refused + 1
            if (refused <= most_of_a_list) call self%reject(group, key, why, token=tokens(i))
        end do
        if (refused > most_of_a_list) call self%reject(group, key, whole_text(refused &
            - most_of_a_list) // ' more of its values are refused')
        if (.not. sound) values = [real(dp) ::]
    end subroutine get_reals

    subroutine take_number(token, allowed, value, sound, why)
        type(value_token), intent(in) :: token
        type(rule), intent(in) :: allowed
        real(dp), intent(out) :: value                       !! 0 where there is no number
        logical, intent(inout) :: sound                      !! false where there is no number
        character(len=:), allocatable, intent(out) :: why    !! it is refused; or empty
        logical :: is_number, too_small

        why = ''
        call read_number(token%text, value, is_number, too_small)
        if (token%quoted .or. .not. is_number) then
            why = 'must be a number'
        else if (.not. ieee_is_finite(value)) then
            why = 'must be finite'
            if (scan(token%text, '0123456789') > 0) why = 'must be finite: it is larger than ' &
                // 'any number here, 1.8e308'
        else if (too_small) then
            why = 'is smaller than any number here but 0, 4.9e-324'
        else if (abs(value) > largest) then
            why = 'must not exceed 1e100 in size'
        else if (.not. allowed%holds(value)) then
            why = 'must be ' // allowed%text
            return
        end if
        if (len(why) == 0) return
        value = 0.0_dp   ! no later rule is asked of what is no number
        sound = .false.
    end subroutine take_number

    !> The value of a key that takes one.
    subroutine take_one(self, group, key, token, found)
        class(namelist_file), intent(inout) :: self
        character(len=*), intent(in) :: group, key
        type(value_token), intent(out) :: token
        logical, intent(out) :: found   !! false if the key is not given, or something is wrong
        type(value_token), allocatable :: tokens(:)
        integer, allocatable :: mine(:)

        found = .false.
        call find(self, group, key, mine)
        if (any(self%entries(mine)%subscripted)) then
            call note(self, group, key)
            call self%reject(group, key, 'takes one value, and no subscript')
            return
        end if
        call gather(self, group, key, tokens)
        found = size(tokens) == 1
        if (found) token = tokens(1)
        if (size(tokens) > 1) call self%reject(group, key, 'takes one value, not ' &
            // whole_text(size(tokens)))
    end subroutine take_one

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
        type(value_token) :: token
        integer :: place
        logical :: found

        value = default
        call take_one(self, group, key, token, found)
        if (.not. found) return
        call take_choice(self, group, key, token, choices, place)
        if (place > 0) value = trim(choices(place))
    end subroutine get_choice

    !> A list of texts of which each is one of a few, as places in `choices`; empty if the key is
    !> not given or one of its values is none of them.
    subroutine get_choices(self, group, key, places, choices)
        class(namelist_file), intent(inout) :: self
        character(len=*), intent(in) :: group, key
        integer, allocatable, intent(out) :: places(:)
        character(len=*), intent(in) :: choices(:)
        type(value_token), allocatable :: tokens(:)
        integer :: i

        call gather(self, group, key, tokens)
        allocate (places(size(tokens)))
        do i = 1, size(tokens)
            call take_choice(self, group, key, tokens(i), choices, places(i))
        end do
        if (any(places == 0)) places = [integer ::]
    end subroutine get_choices

    subroutine take_choice(self, group, key, token, choices, place)
        class(namelist_file), intent(inout) :: self
        character(len=*), intent(in) :: group, key
        type(value_token), intent(in) :: token
        character(len=*), intent(in) :: choices(:)
        integer, intent(out) :: place   !! in `choices`; 0: it is none of them, a fault
        character(len=:), allocatable :: list

        do place = size(choices), 1, -1
            if (choices(place) == lower(token%text) .and. token%quoted) return
        end do
        list = "'" // trim(choices(1)) // "'"
        do place = 2, size(choices)
            list = list // ", '" // trim(choices(place)) // "'"
        end do
        if (size(choices) > 1) list = 'one of ' // list
        if (.not. token%quoted) list = 'text in quotes, ' // list
        call self%reject(group, key, 'must be ' // list, token=token)
        place = 0
    end subroutine take_choice

    !> Any text in quotes; empty if the key is not given.
    subroutine get_text(self, group, key, value)
        class(namelist_file), intent(inout) :: self
        character(len=*), intent(in) :: group, key
        character(len=:), allocatable, intent(out) :: value
        type(value_token) :: token
        logical :: found

        value = ''
        call take_one(self, group, key, token, found)
        if (.not. found) return
        if (token%quoted .and. len_trim(token%text) > 0) then
            value = token%text
        else
            call self%reject(group, key, 'must be text in quotes')
        end if
    end subroutine get_text

    !> True or false, as Fortran writes it.
    subroutine get_logical(self, group, key, value, default)
        class(namelist_file), intent(inout) :: self
        character(len=*), intent(in) :: group, key
        logical, intent(out) :: value
        logical, intent(in) :: default
        type(value_token) :: token
        logical :: found, is_logical

        value = default
        call take_one(self, group, key, token, found)
        if (.not. found) return
        call read_logical(token%text, value, is_logical)
        if (.not. is_logical .or. token%quoted) call self%reject(group, key, &
            'must be .true. or .false.')
    end subroutine get_logical

    pure subroutine read_logical(text, value, is_logical)
        character(len=*), intent(in) :: text
        logical, intent(out) :: value
        logical, intent(out) :: is_logical
        character(len=7), parameter :: yes(6) = [character(len=7) :: '.true.', '.true', '.t.', &
            '.t', 'true', 't']
        character(len=7), parameter :: no(6) = [character(len=7) :: '.false.', '.false', '.f.', &
            '.f', 'false', 'f']

        value = any(yes == lower(text))
        is_logical = value .or. any(no == lower(text))
    end subroutine read_logical

    !> Collects the values of a key in the order of their places, and says that the key is known.
    !> Nothing is collected where something is wrong.
    subroutine gather(self, group, key, tokens)
        class(namelist_file), intent(inout) :: self
        character(len=*), intent(in) :: group, key
        type(value_token), allocatable, intent(out) :: tokens(:)
        integer, allocatable :: mine(:)
        logical, allocatable :: filled(:)
        integer :: last, place, i, k
        logical :: again

        call note(self, group, key)
        call find(self, group, key, mine)
        self%entries(mine)%known = .true.
        last = 0
        if (.not. any(self%entries(mine)%faulty)) then
            do i = 1, size(mine)
                associate (entry => self%entries(mine(i)))
                    last = max(last, place_of(entry, 1), place_of(entry, size(entry%values)))
                end associate
            end do
        end if
        allocate (tokens(last), filled(last))
        if (last == 0) return
        filled = .false.
        again = .false.
        do i = 1, size(mine)
            associate (entry => self%entries(mine(i)))
                do k = 1, size(entry%values)
                    place = place_of(entry, k)
                    again = again .or. filled(place)
                    tokens(place) = entry%values(k)
                    filled(place) = .true.
                end do
            end associate
        end do
        if (again) call self%reject(group, key, 'is given twice')
        if (all(filled)) return
        call self%reject(group, key, 'has gaps between its subscripts')
        tokens = [value_token ::]
    end subroutine gather

    !> Where in its list does the k-th value of an entry stand?
    pure function place_of(entry, k) result(place)
        type(namelist_entry), intent(in) :: entry
        integer, intent(in) :: k
        integer :: place

        place = entry%first + (k - 1) * entry%stride
    end function place_of

    !> Remembers that the program knows a key and its group, or with an empty key only the group.
    subroutine note(self, group, key)
        class(namelist_file), intent(inout) :: self
        character(len=*), intent(in) :: group, key

        call note_group(self, group)
        call self%keys%add(group, key)
    end subroutine note

    !> What to say of a key if it is given where the program does not ask for it, such as `belongs
    !> to the law 'coulomb'`. Of several hints to one key the first one counts.
    subroutine belongs_elsewhere(self, group, key, hint)
        class(namelist_file), intent(inout) :: self
        character(len=*), intent(in) :: group, key, hint

        call note_group(self, group)
        call self%keys%add_elsewhere(group, key, hint)
    end subroutine belongs_elsewhere

    pure subroutine note_group(self, group)
        class(namelist_file), intent(inout) :: self
        character(len=*), intent(in) :: group
        integer :: i

        do i = 1, size(self%groups)
            if (self%groups(i)%name == group) self%groups(i)%known = .true.
        end do
    end subroutine note_group

    !> Notes a fault if a key is not given; where its whole group is missing, that fault stands for
    !> it.
    subroutine require(self, group, key)
        class(namelist_file), intent(inout) :: self
        character(len=*), intent(in) :: group, key
        integer :: line

        if (self%given(group, key)) return
        line = self%line_of_group(group)
        if (line > 0) call self%add_fault(line, '&' // group // ' ' // key &
            // ': is missing and has no default')
    end subroutine require

    !> Notes a fault for each of the groups that is missing.
    subroutine require_groups(self, groups)
        class(namelist_file), intent(inout) :: self
        character(len=*), intent(in) :: groups(:)
        integer :: i

        do i = 1, size(groups)
            if (.not. self%has_group(trim(groups(i)))) call self%add_fault(0, 'group &' &
                // trim(groups(i)) // ' is missing')
        end do
    end subroutine require_groups

    !> Notes a fault if a key is given where it must not be.
    subroutine refuse(self, group, key, why)
        class(namelist_file), intent(inout) :: self
        character(len=*), intent(in) :: group, key, why

        if (self%given(group, key)) call self%reject(group, key, why)
    end subroutine refuse

    !> Notes a fault of a key, with its value and the rule that it breaks. That key is known then.
    subroutine reject(self, group, key, why, token)
        class(namelist_file), intent(inout) :: self
        character(len=*), intent(in) :: group, key, why
        type(value_token), intent(in), optional :: token
        integer, allocatable :: mine(:)
        character(len=:), allocatable :: value
        integer :: i, line

        call find(self, group, key, mine)
        self%entries(mine)%known = .true.
        line = 0
        value = ''
        do i = 1, size(mine)
            line = self%entries(mine(i))%line
            if (size(self%entries(mine(i))%values) == 1) value = &
                shown(self%entries(mine(i))%values(1))
        end do
        if (present(token)) value = shown(token)
        if (len(value) > 0) value = ' = ' // value
        call self%add_fault(line, '&' // group // ' ' // key // value // ': ' // why)
        if (any(self%entries(mine)%faulty)) self%faults(size(self%faults))%hidden = .true.
    end subroutine reject

    pure function shown(token) result(text)
        type(value_token), intent(in) :: token
        character(len=:), allocatable :: text

        text = printable(token%text)
        if (token%quoted) text = "'" // text // "'"
    end function shown

    !> Notes every group and key that was not asked for, with the name that may have been meant;
    !> keys beyond a screenful are only counted.
    subroutine refuse_unknown(self)
        class(namelist_file), intent(inout) :: self
        integer :: unknown, i

        do i = 1, size(self%groups)
            if (self%groups(i)%known) cycle
            call self%add_fault(self%groups(i)%line, '&' // self%groups(i)%name &
                // ': unknown group' // self%keys%suggestion(self%groups(i)%name, ''))
        end do
        unknown = 0
        do i = 1, size(self%entries)
            associate (entry => self%entries(i))
                if (entry%known .or. entry%faulty .or. .not. known_group(self, entry%group)) cycle
                unknown = unknown + 1
                if (unknown > most_shown) cycle
                call self%add_fault(entry%line, '&' // entry%group // ' ' // entry%key &
                    // ': unknown key' // self%keys%suggestion(entry%group, entry%key))
            end associate
        end do
        if (.not. self%broken) self%not_listed = max(0, unknown - most_shown)
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

    !> The faults as lines of text, in the order of the file, up to a screenful.
    function describe_faults(self) result(text)
        class(namelist_file), intent(in) :: self
        character(len=:), allocatable :: text
        integer, allocatable :: order(:)
        integer :: swap, more, i, j

        order = pack([(i, i = 1, size(self%faults))], .not. self%faults%hidden)
        do i = 2, size(order)
            do j = i, 2, -1
                if (self%faults(order(j))%line >= self%faults(order(j - 1))%line) exit
                swap = order(j)
                order(j) = order(j - 1)
                order(j - 1) = swap
            end do
        end do
        text = ''
        do i = 1, min(size(order), most_shown)
            associate (this => self%faults(order(i)))
                text = text // self%name
                if (this%line > 0) text = text // ':' // whole_text(this%line)
                text = text // ': ' // this%text // new_line('a')
            end associate
        end do
        more = max(0, size(order) - most_shown) + self%not_listed
        if (more > 0) text = text // self%name // ': and ' // whole_text(more) // ' faults more' &
            // new_line('a')
    end function describe_faults

    !> Gives a key one value in place of all that it has: the i-th value of another key. A key or a
    !> group that the file does not have is added. Faults of it count for the line of the other key.
    subroutine substitute(self, group, key, from_group, from_key, i)
        class(namelist_file), intent(inout) :: self
        character(len=*), intent(in) :: group, key
        character(len=*), intent(in) :: from_group, from_key   !! given, with `i` values or more
        integer, intent(in) :: i                               !! >= 1
        type(namelist_entry) :: entry
        type(group_seen) :: seen
        integer, allocatable :: theirs(:)
        integer :: j, k

        entry%group = group
        entry%key = key
        call find(self, from_group, from_key, theirs)
        do j = 1, size(theirs)
            associate (from => self%entries(theirs(j)))
                k = 1 + (i - from%first) / from%stride
                if (k < 1 .or. k > size(from%values)) cycle
                if (place_of(from, k) /= i) cycle
                entry%line = from%line
                entry%values = [from%values(k)]
            end associate
        end do
        call replace(self, entry)
        if (self%line_of_group(group) > 0) return
        seen%name = group
        seen%line = entry%line
        self%groups = [self%groups, seen]
    end subroutine substitute

    !> Puts an entry in place of all that its key has. Long lists of other keys are not copied.
    subroutine replace(self, entry)
        class(namelist_file), intent(inout) :: self
        type(namelist_entry), intent(in) :: entry
        integer, allocatable :: mine(:)

        call find(self, entry%group, entry%key, mine)
        if (size(mine) == 1) then
            self%entries(mine(1)) = entry
        else
            call self%remove(entry%group, entry%key)
            self%entries = [self%entries, entry]
        end if
    end subroutine replace

    !> The first value of a key as the file has it; empty if it has none.
    pure function value_of(self, group, key) result(text)
        class(namelist_file), intent(in) :: self
        character(len=*), intent(in) :: group, key
        character(len=:), allocatable :: text
        integer, allocatable :: mine(:)
        integer :: i

        text = ''
        call find(self, group, key, mine)
        do i = 1, size(mine)
            if (size(self%entries(mine(i))%values) > 0) text = &
                shown(self%entries(mine(i))%values(1))
        end do
    end function value_of

    !> Forgets all assignments to a key.
    subroutine remove(self, group, key)
        class(namelist_file), intent(inout) :: self
        character(len=*), intent(in) :: group, key
        logical, allocatable :: kept(:)
        integer, allocatable :: mine(:)

        call find(self, group, key, mine)
        allocate (kept(size(self%entries)), source=.true.)
        kept(mine) = .false.
        self%entries = pack(self%entries, kept)
    end subroutine remove

    !> What the file says, without its comments and its layout: one line an assignment.
    function listing(self, without) result(text)
        class(namelist_file), intent(in) :: self
        character(len=*), intent(in) :: without    !! a group that is left out, or ''
        character(len=:), allocatable :: text
        type(growing_text) :: written
        integer :: i, j

        do i = 1, size(self%entries)
            associate (entry => self%entries(i))
                if (entry%group == without) cycle
                call written%put('&' // entry%group // ' ' // entry%key)
                if (entry%subscripted) call written%put('(' // whole_text(entry%first) // '::' &
                    // whole_text(entry%stride) // ')')
                call written%put(' =')
                do j = 1, size(entry%values)
                    call written%put(' ' // quoted(entry%values(j)))
                end do
                call written%put(new_line('a'))
            end associate
        end do
        text = written%text()
    end function listing

    !> Notes a fault in a line; line 0 is the file as a whole.
    subroutine add_fault(self, line, text)
        class(namelist_file), intent(inout) :: self
        integer, intent(in) :: line
        character(len=*), intent(in) :: text

        call append_fault(self%faults, line, text, hidden=self%broken)
    end subroutine add_fault

    ! ---- small things ------------------------------------------------------------------------

    pure function quoted(token) result(text)
        type(value_token), intent(in) :: token
        character(len=:), allocatable :: text

        text = token%text
        if (token%quoted) text = "'" // text // "'"
    end function quoted

end module namelist_input
