!> The keys that the program knows, and what may have been meant by one that it does not.
module known_key_list
    implicit none
    private

    public :: known_keys

    integer, parameter :: name_length = 64

    !> A key that the program knows, or one that it knows in another place.
    type :: known_key
        character(len=name_length) :: group = '', key = ''
        character(len=:), allocatable :: hint    !! where it belongs; not allocated: here
    end type known_key

    type :: known_keys
        type(known_key), allocatable, private :: keys(:)
        integer, private :: n = 0
    contains
        procedure :: add, add_elsewhere, suggestion
    end type known_keys

contains

    !> A key of a group, or with an empty key the group alone.
    subroutine add(self, group, key)
        class(known_keys), intent(inout) :: self
        character(len=*), intent(in) :: group, key
        integer :: i

        do i = 1, self%n
            if (self%keys(i)%key /= key .or. self%keys(i)%group /= group) cycle
            if (.not. allocated(self%keys(i)%hint)) return
        end do
        if (.not. allocated(self%keys)) allocate (self%keys(32))
        if (self%n == size(self%keys)) self%keys = [self%keys, self%keys]   ! room
        self%n = self%n + 1
        self%keys(self%n) = known_key(group, key)   ! without the hint of another
    end subroutine add

    !> A key that the program does not ask for in this group, and what to say of it there. Of
    !> several hints to one key the first one counts.
    subroutine add_elsewhere(self, group, key, hint)
        class(known_keys), intent(inout) :: self
        character(len=*), intent(in) :: group, key, hint
        integer :: i

        do i = 1, self%n
            if (self%keys(i)%key == key .and. self%keys(i)%group == group) return
        end do
        call self%add(group, key)
        self%keys(self%n)%hint = hint
    end subroutine add_elsewhere

    !> What may have been meant by a key that is unknown: its hint in this group, one of its keys
    !> that is much like it, or else another group that has it. With an empty key, what group may
    !> have been meant. Empty where there is nothing to say.
    function suggestion(self, group, key) result(text)
        class(known_keys), intent(in) :: self
        character(len=*), intent(in) :: group, key
        character(len=:), allocatable :: text
        character(len=:), allocatable :: nearest, elsewhere
        integer :: least, i

        text = ''
        if (len(group) > name_length .or. len(key) > name_length) return
        nearest = ''
        elsewhere = ''
        least = max(1, len(key) / 3) + 1
        if (len(key) == 0) least = max(1, len(group) / 3) + 1
        do i = 1, self%n
            associate (known => self%keys(i))
                if (len(key) == 0) then
                    call compare(group, trim(known%group), '&')
                else if (known%group /= group) then
                    if (known%key == key .and. .not. allocated(known%hint)) elsewhere = known%group
                else if (.not. allocated(known%hint)) then
                    if (len_trim(known%key) > 0) call compare(key, trim(known%key), '')
                else if (known%key == key) then
                    text = '; ' // known%hint
                    return
                end if
            end associate
        end do
        if (len(nearest) > 0) then
            text = "; did you mean '" // nearest // "'?"
        else if (len(elsewhere) > 0) then
            text = '; &' // trim(elsewhere) // ' has a key of that name'
        end if

    contains

        !> A word that is the beginning of another is much like it, too.
        subroutine compare(word, known, mark)
            character(len=*), intent(in) :: word, known, mark
            integer :: distance

            distance = edits(word, known)
            if (index(known, word) == 1) distance = 1
            if (distance >= least .or. distance == len(word) .and. known(1:1) /= word(1:1)) return
            least = distance
            nearest = mark // known
        end subroutine compare

    end function suggestion

    !> How many letters must be changed, added, taken out or exchanged with the next one to turn
    !> one word into another?
    pure integer function edits(from, to) result(n)
        character(len=*), intent(in) :: from, to
        integer :: d(-1:len(from), -1:len(to)), cost, i, j

        d = len(from) + len(to)
        d(0:, 0) = [(i, i = 0, len(from))]
        d(0, 0:) = [(j, j = 0, len(to))]
        do j = 1, len(to)
            do i = 1, len(from)
                cost = merge(0, 1, from(i:i) == to(j:j))
                d(i, j) = min(d(i - 1, j) + 1, d(i, j - 1) + 1, d(i - 1, j - 1) + cost)
                if (min(i, j) == 1) cycle
                if (from(i:i) == to(j - 1:j - 1) .and. from(i - 1:i - 1) == to(j:j)) d(i, j) = &
                    min(d(i, j), d(i - 2, j - 2) + 1)
            end do
        end do
        n = d(len(from), len(to))
    end function edits

end module known_key_list
