!> What stands in a file of namelist groups, the faults that are found in it, and which of its keys
!> the program knows.
!>
!> A Fortran `read` with a namelist stops at the first fault and says little about it. Here what
!> was not asked for is a fault, and so is what breaks its rule. Faults are collected, not thrown.
module namelist_content
    use fault_list, only : append_fault, fault
    use known_key_list, only : known_keys
    use namelist_parser, only : group_seen, namelist_entry, parse_namelists, parsed_text, &
        value_token
    use number_text, only : whole_text
    use printable_text, only : growing_text, printable
    implicit none
    private

    integer, parameter :: most_shown = 50   !! faults

    type, public :: content
        character(len=:), allocatable :: name   !! of the file
        type(namelist_entry), allocatable :: entries(:)
        type(group_seen), allocatable :: groups(:)
        type(fault), allocatable :: faults(:)
        type(value_token), allocatable :: files(:)   !! paths of this file and of all that it may
                                                     !! name: its quoted values
        logical, private :: broken = .false.     !! the text could not be read to its end
        integer, private :: not_listed = 0       !! faults that are only counted
        type(known_keys), private :: keys
    contains
        procedure :: take_text
        procedure :: has_group, line_of_group, given, require, require_groups, refuse, reject, &
            add_fault, belongs_elsewhere, refuse_unknown, describe_faults
        procedure :: find, gather, value_of, listing
        procedure :: assume, substitute, remove, beside
    end type content

contains

    !> Takes a text apart.
    subroutine take_text(self, name, text)
        class(content), intent(inout) :: self
        character(len=*), intent(in) :: name    !! of its file
        character(len=*), intent(in) :: text    !! lines, each ended by a line feed
        type(parsed_text) :: parsed

        call parse_namelists(text, parsed)
        self%name = name
        self%broken = parsed%broken
        call move_alloc(parsed%entries, self%entries)
        call move_alloc(parsed%groups, self%groups)
        call move_alloc(parsed%faults, self%faults)
        call note_files(self)
    end subroutine take_text

    !> Is the group in the file? Says that the program knows it.
    logical function has_group(self, group) result(found)
        class(content), intent(inout) :: self
        character(len=*), intent(in) :: group

        call note(self, group, '')
        found = self%line_of_group(group) > 0
    end function has_group

    !> Where does the group start? 0: the file does not have it.
    pure integer function line_of_group(self, group) result(line)
        class(content), intent(in) :: self
        character(len=*), intent(in) :: group
        integer :: i

        line = 0
        do i = size(self%groups), 1, -1
            if (self%groups(i)%name == group) line = self%groups(i)%line
        end do
    end function line_of_group

    !> Is the key in the file? Says that the program knows it.
    logical function given(self, group, key) result(found)
        class(content), intent(inout) :: self
        character(len=*), intent(in) :: group, key
        integer, allocatable :: mine(:)

        call note(self, group, key)
        call self%find(group, key, mine)
        found = size(mine) > 0
    end function given

    !> Notes a fault if a key is not given; where its whole group is missing, that fault stands for
    !> it.
    subroutine require(self, group, key)
        class(content), intent(inout) :: self
        character(len=*), intent(in) :: group, key
        integer :: line

        if (self%given(group, key)) return
        line = self%line_of_group(group)
        if (line > 0) call self%add_fault(line, '&' // group // ' ' // key &
            // ': is missing and has no default')
    end subroutine require

    !> Notes a fault for each of the groups that is missing.
    subroutine require_groups(self, groups)
        class(content), intent(inout) :: self
        character(len=*), intent(in) :: groups(:)
        integer :: i

        do i = 1, size(groups)
            if (.not. self%has_group(trim(groups(i)))) call self%add_fault(0, 'group &' &
                // trim(groups(i)) // ' is missing')
        end do
    end subroutine require_groups

    !> Notes a fault if a key is given where it must not be.
    subroutine refuse(self, group, key, why)
        class(content), intent(inout) :: self
        character(len=*), intent(in) :: group, key, why

        if (self%given(group, key)) call self%reject(group, key, why)
    end subroutine refuse

    !> Notes a fault of a key, with its value and the rule that it breaks. That key is known then.
    subroutine reject(self, group, key, why, token)
        class(content), intent(inout) :: self
        character(len=*), intent(in) :: group, key, why
        type(value_token), intent(in), optional :: token
        integer, allocatable :: mine(:)
        character(len=:), allocatable :: value
        integer :: i, line

        call self%find(group, key, mine)
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

    !> Notes a fault in a line; line 0 is the file as a whole.
    subroutine add_fault(self, line, text)
        class(content), intent(inout) :: self
        integer, intent(in) :: line
        character(len=*), intent(in) :: text

        call append_fault(self%faults, line, text, hidden=self%broken)
    end subroutine add_fault

    !> What to say of a key if it is given where the program does not ask for it, such as `belongs
    !> to the law 'coulomb'`. Of several hints to one key the first one counts.
    subroutine belongs_elsewhere(self, group, key, hint)
        class(content), intent(inout) :: self
        character(len=*), intent(in) :: group, key, hint

        call note_group(self, group)
        call self%keys%add_elsewhere(group, key, hint)
    end subroutine belongs_elsewhere

    !> Remembers that the program knows a key and its group, or with an empty key only the group.
    subroutine note(self, group, key)
        class(content), intent(inout) :: self
        character(len=*), intent(in) :: group, key

        call note_group(self, group)
        call self%keys%add(group, key)
    end subroutine note

    pure subroutine note_group(self, group)
        class(content), intent(inout) :: self
        character(len=*), intent(in) :: group
        integer :: i

        do i = 1, size(self%groups)
            if (self%groups(i)%name == group) self%groups(i)%known = .true.
        end do
    end subroutine note_group

    !> Notes every group and key that was not asked for, with the name that may have been meant;
    !> keys beyond a screenful are only counted.
    subroutine refuse_unknown(self)
        class(content), intent(inout) :: self
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

    pure logical function known_group(self, name) result(known)
        class(content), intent(in) :: self
        character(len=*), intent(in) :: name
        integer :: i

        known = any([(self%groups(i)%name == name .and. self%groups(i)%known, i = 1, &
            size(self%groups))])
    end function known_group

    !> The faults as lines of text, in the order of the file, up to a screenful.
    function describe_faults(self) result(text)
        class(content), intent(in) :: self
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

    !> The assignments to a key, as places in the list of entries.
    pure subroutine find(self, group, key, places)
        class(content), intent(in) :: self
        character(len=*), intent(in) :: group, key
        integer, allocatable, intent(out) :: places(:)
        integer :: i

        places = pack([(i, i = 1, size(self%entries))], [(self%entries(i)%group == group &
            .and. self%entries(i)%key == key, i = 1, size(self%entries))])
    end subroutine find

    !> Collects the values of a key in the order of their places, and says that the key is known.
    !> Nothing is collected where something is wrong.
    subroutine gather(self, group, key, tokens)
        class(content), intent(inout) :: self
        character(len=*), intent(in) :: group, key
        type(value_token), allocatable, intent(out) :: tokens(:)
        integer, allocatable :: mine(:)
        logical, allocatable :: filled(:)
        integer :: last, place, i, k
        logical :: again

        call note(self, group, key)
        call self%find(group, key, mine)
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
    pure integer function place_of(entry, k) result(place)
        type(namelist_entry), intent(in) :: entry
        integer, intent(in) :: k

        place = entry%first + (k - 1) * entry%stride
    end function place_of

    !> The first value of a key as the file has it; empty if it has none.
    pure function value_of(self, group, key) result(text)
        class(content), intent(in) :: self
        character(len=*), intent(in) :: group, key
        character(len=:), allocatable :: text
        integer, allocatable :: mine(:)
        integer :: i

        text = ''
        call self%find(group, key, mine)
        do i = 1, size(mine)
            if (size(self%entries(mine(i))%values) > 0) text = &
                shown(self%entries(mine(i))%values(1))
        end do
    end function value_of

    !> What the file says, without its comments and its layout: one line an assignment.
    function listing(self, without) result(text)
        class(content), intent(in) :: self
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

    !> Gives a key that the input leaves out a number.
    subroutine assume(self, group, key, number)
        class(content), intent(inout) :: self
        character(len=*), intent(in) :: group, key, number
        type(namelist_entry) :: entry

        if (self%given(group, key)) return
        entry%group = group
        entry%key = key
        allocate (entry%values(1))
        entry%values(1)%text = number
        self%entries = [self%entries, entry]
    end subroutine assume

    !> Gives a key one value in place of all that it has: the i-th value of another key. A key or a
    !> group that the file does not have is added. Faults of it count for the line of the other key.
    subroutine substitute(self, group, key, from_group, from_key, i)
        class(content), intent(inout) :: self
        character(len=*), intent(in) :: group, key
        character(len=*), intent(in) :: from_group, from_key   !! given, with `i` values or more
        integer, intent(in) :: i                               !! >= 1
        type(namelist_entry) :: entry
        type(group_seen) :: seen
        integer, allocatable :: theirs(:)
        integer :: j, k

        entry%group = group
        entry%key = key
        call self%find(from_group, from_key, theirs)
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
        class(content), intent(inout) :: self
        type(namelist_entry), intent(in) :: entry
        integer, allocatable :: mine(:)

        call self%find(entry%group, entry%key, mine)
        if (size(mine) == 1) then
            self%entries(mine(1)) = entry
        else
            call self%remove(entry%group, entry%key)
            self%entries = [self%entries, entry]
        end if
    end subroutine replace

    !> Forgets all assignments to a key.
    subroutine remove(self, group, key)
        class(content), intent(inout) :: self
        character(len=*), intent(in) :: group, key
        logical, allocatable :: kept(:)
        integer, allocatable :: mine(:)

        call self%find(group, key, mine)
        allocate (kept(size(self%entries)), source=.true.)
        kept(mine) = .false.
        self%entries = pack(self%entries, kept)
    end subroutine remove

    subroutine note_files(self)
        class(content), intent(inout) :: self
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
        class(content), intent(in) :: self
        character(len=*), intent(in) :: path   !! not empty
        character(len=:), allocatable :: full

        full = path
        if (path(1:1) /= '/') full = self%name(:index(self%name, '/', back=.true.)) // path
    end function beside

    pure function shown(token) result(text)
        type(value_token), intent(in) :: token
        character(len=:), allocatable :: text

        text = printable(token%text)
        if (token%quoted) text = "'" // text // "'"
    end function shown

    pure function quoted(token) result(text)
        type(value_token), intent(in) :: token
        character(len=:), allocatable :: text

        text = token%text
        if (token%quoted) text = "'" // text // "'"
    end function quoted

end module namelist_content
