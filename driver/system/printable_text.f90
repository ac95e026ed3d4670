!> Words of a file as a message shows them, and what else is done to texts.
module printable_text
    implicit none
    private

    public :: growing_text, lower, printable, replaced

    !> A text that is put together word by word.
    type :: growing_text
        character(len=:), allocatable, private :: room
        integer, private :: n = 0
    contains
        procedure :: put, text
    end type growing_text

contains

    pure subroutine put(self, word)
        class(growing_text), intent(inout) :: self
        character(len=*), intent(in) :: word

        if (.not. allocated(self%room)) allocate (character(len=1024) :: self%room)
        do while (self%n + len(word) > len(self%room))
            self%room = self%room // self%room
        end do
        self%room(self%n + 1:self%n + len(word)) = word
        self%n = self%n + len(word)
    end subroutine put

    !> What has been put so far.
    pure function text(self)
        class(growing_text), intent(in) :: self
        character(len=self%n) :: text

        if (self%n > 0) text = self%room(:self%n)
    end function text

    !> Cut where it is long; invisible characters are shown as their codes.
    pure function printable(text) result(shown)
        character(len=*), intent(in) :: text
        character(len=:), allocatable :: shown
        integer, parameter :: most = 60
        character(len=4) :: code
        integer :: hidden, i

        shown = ''
        hidden = 0   ! bytes of the character that are still to be shown as codes
        do i = 1, len(text)
            if (hidden == 0) hidden = unseen(text(i:))
            if (hidden > 0) then
                write (code, '(a, z2.2)') '\x', iachar(text(i:i))
                shown = shown // code
                hidden = hidden - 1
            else
                shown = shown // text(i:i)
            end if
            if (len(shown) >= most .and. i < len(text)) then
                shown = shown // '...'
                exit
            end if
        end do
    end function printable

    !> Bytes of the character at the start, if it does not show: a control character, or in UTF-8 a
    !> blank, a joiner or a mark other than the ASCII blank.
    pure integer function unseen(text) result(bytes)
        character(len=*), intent(in) :: text   !! not empty
        integer :: codes(3), i

        codes = 0
        do i = 1, min(3, len(text))
            codes(i) = iachar(text(i:i))
        end do
        bytes = 0
        if (codes(1) < 32 .or. codes(1) == 127) bytes = 1
        if (codes(1) == 194 .and. codes(2) >= 128 .and. codes(2) <= 160) bytes = 2
        if (codes(1) == 226 .and. codes(2) == 128 .and. codes(3) < 176) then
            if (codes(3) < 144 .or. codes(3) > 167) bytes = 3   ! between: dashes and quotes
        end if
        if (all(codes == [239, 187, 191])) bytes = 3
    end function unseen

    !> A text with another one in place of each of a letter, to quote it.
    pure function replaced(text, letter, by) result(new)
        character(len=*), intent(in) :: text, by
        character(len=1), intent(in) :: letter
        character(len=:), allocatable :: new
        integer :: i

        new = ''
        do i = 1, len(text)
            if (text(i:i) == letter) then
                new = new // by
            else
                new = new // text(i:i)
            end if
        end do
    end function replaced

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

end module printable_text
