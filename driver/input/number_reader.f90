!> Reads a real number as Fortran and its neighbours write it.
module number_reader
    use, intrinsic :: ieee_arithmetic, only : ieee_get_halting_mode, ieee_overflow, &
        ieee_positive_inf, ieee_quiet_nan, ieee_set_halting_mode, ieee_value
    use, intrinsic :: iso_c_binding, only : c_intptr_t, c_loc, c_null_char, c_ptr
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use c_library, only : c_strtod
    implicit none
    private

    public :: read_number

    character(len=*), parameter :: digits = '0123456789'

contains

    !> NaN and infinity are read as such, for the caller to refuse; a number too large is infinite.
    subroutine read_number(text, value, is_number, too_small)
        character(len=*), intent(in) :: text     !! without blanks around it
        real(dp), intent(out) :: value
        logical, intent(out) :: is_number
        logical, intent(out) :: too_small        !! a number other than 0 that rounds to 0
        integer :: magnitude
        logical :: zero

        value = 0.0_dp
        too_small = .false.
        call take_apart(text, is_number, zero, magnitude)
        if (.not. is_number) then
            call read_name(text, value, is_number)
        else if (.not. zero) then
            call convert(text, magnitude, value)
            too_small = .not. abs(value) > 0.0_dp
        end if
    end subroutine read_number

    !> A sign, digits with or without a point, and an exponent with its letter. Fortran itself also
    !> reads an exponent without a letter, 1-3, which is a typing error.
    pure subroutine take_apart(text, valid, zero, magnitude)
        character(len=*), intent(in) :: text
        logical, intent(out) :: valid
        logical, intent(out) :: zero          !! every digit before the exponent is 0
        integer, intent(out) :: magnitude     !! power of ten of the first digit that is not 0
        integer :: exponent, digit, i
        logical :: any_digit, after_point, found

        valid = .false.
        zero = .true.
        any_digit = .false.
        after_point = .false.
        magnitude = 0
        exponent = 0
        i = 1
        if (scan(text, '+-') == 1) i = 2
        do i = i, len(text)
            digit = index(digits, text(i:i)) - 1
            found = zero .and. digit > 0
            zero = zero .and. digit <= 0
            if (digit >= 0) then
                any_digit = .true.
                if (after_point .and. (zero .or. found)) magnitude = magnitude - 1
                if (.not. (after_point .or. zero .or. found)) magnitude = magnitude + 1
            else if (text(i:i) == '.' .and. .not. after_point) then
                after_point = .true.
            else
                exit
            end if
        end do
        if (.not. any_digit) return
        valid = i > len(text)
        if (.not. valid) call read_exponent(text(i:), exponent, valid)
        magnitude = magnitude + exponent
    end subroutine take_apart

    pure subroutine read_exponent(text, exponent, valid)
        character(len=*), intent(in) :: text     !! from its letter on
        integer, intent(out) :: exponent         !! cut at 100000
        logical, intent(out) :: valid
        integer :: first, digit, i

        exponent = 0
        first = 2
        if (scan(text(2:), '+-') == 1) first = 3
        valid = index('eEdD', text(1:1)) > 0 .and. first <= len(text)
        do i = first, len(text)
            digit = index(digits, text(i:i)) - 1
            valid = valid .and. digit >= 0
            exponent = min(100000, 10 * exponent + digit)
        end do
        if (first == 3 .and. valid) exponent = merge(-exponent, exponent, text(2:2) == '-')
    end subroutine read_exponent

    !> The nearest number, by the C library. Overflow would end a program that asks for that.
    subroutine convert(text, magnitude, value)
        character(len=*), intent(in) :: text
        integer, intent(in) :: magnitude
        real(dp), intent(out) :: value
        character(len=len(text) + 1) :: copy
        logical :: halting
        integer :: letter

        value = 0.0_dp
        if (magnitude < -400) return
        copy = text // c_null_char
        letter = scan(copy, 'dD')
        if (letter > 0) copy(letter:letter) = 'e'
        if (magnitude < 308) then
            call to_nearest(copy, value)
        else if (magnitude == 308) then
            call ieee_get_halting_mode(ieee_overflow, halting)
            call ieee_set_halting_mode(ieee_overflow, .false.)
            call to_nearest(copy, value)
            call ieee_set_halting_mode(ieee_overflow, halting)
        else
            value = ieee_value(value, ieee_positive_inf)
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
        integer :: letter, i

        value = 0.0_dp
        is_number = .false.
        if (len(text) == 0 .or. len(text) > 9) return
        word = text
        if (scan(text, '+-') == 1) word = text(2:)
        do i = 1, len(word)
            letter = iachar(word(i:i))
            if (letter >= iachar('A') .and. letter <= iachar('Z')) word(i:i) = achar(letter + 32)
        end do
        is_number = word == 'nan' .or. word == 'inf' .or. word == 'infinity'
        if (word == 'nan') then
            value = ieee_value(value, ieee_quiet_nan)
        else if (is_number) then
            value = ieee_value(value, ieee_positive_inf)
        end if
    end subroutine read_name

end module number_reader
