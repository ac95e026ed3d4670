!> The keys that the program knows, and what may have been meant by one that it does not.
module known_key_list
    use similar_words, only : difference
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

        subroutine compare(word, known, mark)
            character(len=*), intent(in) :: word, known, mark
            integer :: letters

            letters = difference(word, known)
            if (letters >= least) return
            least = letters
            nearest = mark // known
        end subroutine compare

    end function suggestion

end module known_key_list
