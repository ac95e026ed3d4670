!> Reads a real number as Fortran and its neighbours write it.
module number_reader
    use, intrinsic :: ieee_arithmetic, only : ieee_get_halting_mode, ieee_overflow, &
        ieee_positive_inf, ieee_quiet_nan, ieee_set_halting_mode, ieee_value
    use, intrinsic :: iso_c_binding, only : c_intptr_t, c_loc, c_null_char, c_ptr
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use c_library, only : c_strtod
    use printable_text, only : lower
    implicit none
    private

    public :: read_number

    !> That inputs may have: squares are numbers, too, and the library takes no larger constants.
    real(dp), parameter, public :: largest = 1.0e100_dp

    character(len=*), parameter :: digits = '0123456789'

contains

    !> NaN and infinity are read as such, for the caller to refuse; a number too large is infinite.
    subroutine read_number(text, value, is_number, too_small)
        character(len=*), intent(in) :: text     !! without blanks around it
        real(dp), intent(out) :: value
        logical, intent(out) :: is_number
        logical, intent(out) :: too_small        !! a number other than 0 that rounds to 0
        value = 0.0_dp
        too_small = .false.
        is_number = is_written_as_number(text)
        if (is_number) then
            call convert(text, value)
            if (abs(value) > 0.0_dp) return
            value = 0.0_dp   ! and not -0
            too_small = scan(text(:scan(text // 'e', 'eEdD') - 1), '123456789') > 0
        else
            call read_name(text, value, is_number)
        end if
    end subroutine read_number

    !> A sign, digits with or without a point, and an exponent with its letter. Fortran itself also
    !> reads an exponent without a letter, 1-3, which is a typing error.
    pure logical function is_written_as_number(text) result(yes)
        character(len=*), intent(in) :: text
        integer :: first, last, point

        first = 1
        if (scan(text, '+-') == 1) first = 2
        last = first + verify(text(first:) // ' ', digits // '.') - 2   ! of the mantissa
        point = index(text(first:last), '.')
        yes = scan(text(first:last), digits) > 0 .and. point == index(text(first:last), '.', &
            back=.true.)
        if (.not. yes .or. last == len(text)) return
        first = last + 2
        if (scan(text(min(first, len(text)):), '+-') == 1) first = first + 1
        yes = scan(text(last + 1:last + 1), 'eEdD') == 1 .and. first <= len(text) &
            .and. verify(text(min(first, len(text)):), digits) == 0
    end function is_written_as_number

    !> The nearest number, by the C library. Overflow would end a program that asks for that.
    subroutine convert(text, value)
        character(len=*), intent(in) :: text
        real(dp), intent(out) :: value
        character(len=len(text) + 1) :: copy
        logical :: halting
        integer :: letter

        copy = text // c_null_char
        letter = scan(copy, 'dD')
        if (letter > 0) copy(letter:letter) = 'e'
        if (len(text) < 300 .and. scan(copy, 'eE') == 0) then
            call to_nearest(copy, value)
        else
            call ieee_get_halting_mode(ieee_overflow, halting)
            call ieee_set_halting_mode(ieee_overflow, .false.)
            call to_nearest(copy, value)
            call ieee_set_halting_mode(ieee_overflow, halting)
        end if
    end subroutine convert

    !> In a process that has set a locale with a decimal comma the C library stops at the point:
    !> Fortran's own reader, which is slower, then has to do.
    subroutine to_nearest(text, value)
        character(len=*), target, intent(in) :: text   !! ended by a character 0
        real(dp), intent(out) :: value
        type(c_ptr) :: end
        integer(c_intptr_t) :: taken
        integer :: status

        value = c_strtod(text, end)
        taken = transfer(end, taken) - transfer(c_loc(text(1:1)), taken)
        if (taken == len(text) - 1) return
        read (text(:len(text) - 1), *, iostat=status) value
        if (status /= 0) value = 0.0_dp
    end subroutine to_nearest

    pure subroutine read_name(text, value, is_number)
        character(len=*), intent(in) :: text
        real(dp), intent(out) :: value
        logical, intent(out) :: is_number
        character(len=8) :: word

        value = 0.0_dp
        is_number = .false.
        if (len(text) == 0 .or. len(text) > 9) return
        word = lower(text)
        if (scan(text, '+-') == 1) word = lower(text(2:))
        is_number = word == 'nan' .or. word == 'inf' .or. word == 'infinity'
        if (word == 'nan') then
            value = ieee_value(value, ieee_quiet_nan)
        else if (is_number) then
            value = ieee_value(value, ieee_positive_inf)
        end if
    end subroutine read_name

end module number_reader
