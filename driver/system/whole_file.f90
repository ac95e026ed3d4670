!> Reads text files whole, through the C library: from disks, pipes and devices alike. Byte-order
!> marks, UTF-16, Latin-1 and the line ends of other systems are turned into plain lines of UTF-8.
module whole_file
    use, intrinsic :: iso_c_binding, only : c_associated, c_null_char, c_ptr, c_size_t
    use c_library, only : c_fclose, c_ferror, c_fopen, c_fread
    use number_text, only : whole_text
    use platform, only : is_directory
    implicit none
    private

    public :: next_line, plain_text, read_whole_file, line_text

    !> One of several.
    type :: line_text
        character(len=:), allocatable :: text
    end type line_text

    character(len=*), parameter :: utf8_mark = char(239) // char(187) // char(191)
    character(len=*), parameter :: little_endian_mark = char(255) // char(254)
    character(len=*), parameter :: big_endian_mark = char(254) // char(255)
    character(len=1), parameter :: carriage_return = achar(13), line_feed = achar(10)

contains

    !> The text of a file, as `plain_text` makes it. `problem` says why there is none, or is empty.
    subroutine read_whole_file(name, text, problem)
        character(len=*), intent(in) :: name
        character(len=:), allocatable, intent(out) :: text
        character(len=:), allocatable, intent(out) :: problem
        integer, parameter :: most = 536870911   ! in UTF-16 they become half as many again
        character(len=65536) :: chunk
        character(len=256) :: message
        character(len=:), allocatable :: bytes
        type(c_ptr) :: stream
        integer :: length, taken, unit, status

        text = ''
        problem = ''
        if (is_directory(name)) then
            problem = 'is a directory'
            return
        end if
        stream = c_fopen(name // c_null_char, 'r' // c_null_char)
        if (.not. c_associated(stream)) then
            ! the operating system's reason, which Fortran tells and C keeps in a macro
            message = 'cannot be opened'
            open (newunit=unit, file=name, status='old', action='read', iostat=status, &
                iomsg=message)
            if (status == 0) close (unit)
            problem = trim(message)
            return
        end if
        allocate (character(len=len(chunk)) :: bytes)
        length = 0
        do
            taken = int(c_fread(chunk, 1_c_size_t, int(len(chunk), c_size_t), stream))
            if (taken == 0) exit
            if (length + taken > len(bytes)) bytes = bytes // bytes   ! room
            bytes(length + 1:length + taken) = chunk(:taken)
            length = length + taken
            if (length > most) exit
        end do
        if (c_ferror(stream) /= 0) problem = 'cannot be read'
        if (length > most) problem = 'is too large'
        if (c_fclose(stream) /= 0) problem = 'cannot be read'
        if (len(problem) == 0) call plain_text(bytes(:length), text, problem)
    end subroutine read_whole_file

    !> Moves on to the next line of a text. What follows the last line feed is one, too: there
    !> `last` is the end of the text.
    pure subroutine next_line(text, first, last, line)
        character(len=*), intent(in) :: text
        integer, intent(out) :: first     !! character of the line
        integer, intent(inout) :: last    !! of the line before, then of this one; -1 at the start
        integer, intent(inout) :: line    !! number, from 1
        integer :: length

        first = last + 2
        length = index(text(first:), line_feed) - 1
        last = first + length - 1
        if (length < 0) last = len(text)
        line = line + 1
    end subroutine next_line

    !> Takes a byte-order mark off, turns UTF-16 into UTF-8, and ends each line by a line feed.
    !> UTF-16 without a mark shows in its first letters, each of which has a byte that is zero. What
    !> is not UTF-8 is Latin-1. A character 0 belongs to no text: `problem` tells its line.
    pure subroutine plain_text(bytes, text, problem)
        character(len=*), intent(in) :: bytes
        character(len=:), allocatable, intent(out) :: text
        character(len=:), allocatable, intent(out) :: problem   !! empty if there is none
        character(len=1) :: this, previous
        integer :: line, n, i

        problem = ''
        if (index(bytes, little_endian_mark) == 1) then
            call decode_utf16(bytes(3:), 1, text)
        else if (index(bytes, big_endian_mark) == 1) then
            call decode_utf16(bytes(3:), 2, text)
        else if (has_zeros(bytes, [.false., .true., .false., .true.])) then
            call decode_utf16(bytes, 1, text)
        else if (has_zeros(bytes, [.true., .false., .true., .false.])) then
            call decode_utf16(bytes, 2, text)
        else if (index(bytes, utf8_mark) == 1) then
            text = bytes(4:)
        else if (is_utf8(bytes)) then
            text = bytes
        else
            allocate (character(len=2 * len(bytes)) :: text)   ! Latin-1: characters 0 to 255
            n = 0
            do i = 1, len(bytes)
                call append_utf8(iachar(bytes(i:i)), text, n)
            end do
            text = text(:n)
        end if

        n = 0
        line = 1
        previous = ' '
        do i = 1, len(text)
            this = text(i:i)
            if (this == achar(0)) then
                problem = 'line ' // whole_text(line) // ': holds a character 0, which no text does'
                exit
            end if
            if (this /= line_feed .or. previous /= carriage_return) then
                n = n + 1
                text(n:n) = this
                if (this == carriage_return) text(n:n) = line_feed
                if (text(n:n) == line_feed) line = line + 1
            end if
            previous = this
        end do
        text = text(:n)
    end subroutine plain_text

    !> Are these of the first bytes zero, and no others?
    pure logical function has_zeros(bytes, zero) result(yes)
        character(len=*), intent(in) :: bytes
        logical, intent(in) :: zero(:)
        integer :: i

        yes = len(bytes) >= size(zero)
        if (yes) yes = all([((bytes(i:i) == achar(0)) .eqv. zero(i), i = 1, size(zero))])
    end function has_zeros

    !> Has each character as many bytes as its first one says?
    pure logical function is_utf8(bytes) result(yes)
        character(len=*), intent(in) :: bytes
        integer :: following, code, i

        following = 0
        do i = 1, len(bytes)
            code = iachar(bytes(i:i))
            if (code < 128 .and. following == 0) cycle
            yes = ((following > 0) .eqv. (code >= 128 .and. code < 192)) .and. code < 248
            if (.not. yes) return
            if (following > 0) then
                following = following - 1
            else
                following = count(code >= [192, 224, 240])
            end if
        end do
        yes = following == 0
    end function is_utf8

    !> Turns UTF-16 into UTF-8. What is no character becomes U+FFFD.
    pure subroutine decode_utf16(bytes, low, text)
        character(len=*), intent(in) :: bytes
        integer, intent(in) :: low   !! place in each pair of its less significant byte, 1 or 2
        character(len=:), allocatable, intent(out) :: text
        integer, parameter :: no_character = int(z'FFFD')
        integer :: code, second, n, i

        allocate (character(len=3 * (len(bytes) / 2)) :: text)   ! no pair makes more than 3 bytes
        n = 0
        i = 1
        do while (i < len(bytes))
            code = unit_at(i)
            i = i + 2
            if (code >= int(z'D800') .and. code < int(z'E000')) then
                second = 0
                if (code < int(z'DC00') .and. i < len(bytes)) second = unit_at(i)
                if (second >= int(z'DC00') .and. second < int(z'E000')) then
                    code = int(z'10000') + 1024 * (code - int(z'D800')) + second - int(z'DC00')
                    i = i + 2
                else
                    code = no_character
                end if
            end if
            call append_utf8(code, text, n)
        end do
        text = text(:n)

    contains

        pure integer function unit_at(place)
            integer, intent(in) :: place

            unit_at = 256 * iachar(bytes(place + 2 - low:place + 2 - low)) &
                + iachar(bytes(place + low - 1:place + low - 1))
        end function unit_at

    end subroutine decode_utf16

    pure subroutine append_utf8(code, text, n)
        integer, intent(in) :: code                !! of a character, 0 to 1114111
        character(len=:), allocatable, intent(inout) :: text
        integer, intent(inout) :: n                !! bytes so far

        if (code < 128) then
            text(n + 1:n + 1) = char(code)
            n = n + 1
        else if (code < 2048) then
            text(n + 1:n + 2) = char(192 + code / 64) // char(128 + mod(code, 64))
            n = n + 2
        else if (code < 65536) then
            text(n + 1:n + 3) = char(224 + code / 4096) // char(128 + mod(code / 64, 64)) &
                // char(128 + mod(code, 64))
            n = n + 3
        else
            text(n + 1:n + 4) = char(240 + code / 262144) // char(128 + mod(code / 4096, 64)) &
                // char(128 + mod(code / 64, 64)) // char(128 + mod(code, 64))
            n = n + 4
        end if
    end subroutine append_utf8

end module whole_file
