!> Numbers as text, each way once.
module number_text
    use, intrinsic :: iso_fortran_env, only : dp => real64, int64
    use printable_text, only : replaced
    implicit none
    private

    public :: full_row, quoted_field, rounded_text, short_text, six_digits, whole_text

contains

    !> Numbers with 17 significant digits, so that reading them back gives the same bits, between
    !> commas or another sign: as format es24.16e3 has them, without blanks.
    pure function full_row(numbers, separator) result(line)
        real(dp), intent(in) :: numbers(:)
        character(len=1), intent(in), optional :: separator
        character(len=:), allocatable :: line
        character(len=25 * size(numbers)) :: packed
        character(len=24) :: buffer
        integer :: i, n, first

        n = 0
        do i = 1, size(numbers)
            if (i > 1) then
                n = n + 1
                packed(n:n) = ','
                if (present(separator)) packed(n:n) = separator
            end if
            call write_full(numbers(i), buffer, first)
            packed(n + 1:n + 25 - first) = buffer(first:)
            n = n + 25 - first
        end do
        line = packed(:n)
    end function full_row

    !> Format es24.16e3 for one number, in a tenth of the time, which tables of long runs are made
    !> of: the number times a power of ten, as a sum of two, is the 17 digits.
    pure subroutine write_full(number, text, first)
        real(dp), intent(in) :: number
        character(len=24), intent(out) :: text   !! from `first` on
        integer, intent(out) :: first
        real(dp), parameter :: least = 1.0e-100_dp, most = 1.0e30_dp   !! others: as ever
        integer(int64), parameter :: least_digits = 10_int64**16
        integer(int64) :: digits, more_digits
        integer :: power, place
        logical :: usual

        usual = exponent(number) <= exponent(most)   ! NaN must not be compared
        if (usual) usual = abs(number) >= least .and. abs(number) <= most
        if (.not. usual) then
            write (text, '(es24.16e3)') number
            first = verify(text, ' ')
            return
        end if
        power = floor(log10(abs(number)))   ! one too large or too small by chance
        digits = scaled(abs(number), 16 - power)
        if (digits >= 10 * least_digits) then
            power = power + 1
            digits = scaled(abs(number), 16 - power)
        else if (digits <= least_digits) then
            more_digits = scaled(abs(number), 17 - power)
            if (more_digits < 10 * least_digits) then
                power = power - 1
                digits = more_digits
            end if
        end if
        first = 2
        if (number < 0.0_dp) first = 1
        text = '-'
        do place = 19, 4, -1
            text(place:place) = achar(iachar('0') + int(modulo(digits, 10_int64)))
            digits = digits / 10
        end do
        text(2:3) = achar(iachar('0') + int(digits)) // '.'
        text(20:21) = merge('E-', 'E+', power < 0)
        do place = 24, 22, -1
            text(place:place) = achar(iachar('0') + modulo(abs(power) / 10**(24 - place), 10))
        end do
    end subroutine write_full

    !> x 10**power as the nearest whole number, the even one of two: 10**16 or so.
    pure integer(int64) function scaled(x, power) result(whole)
        real(dp), intent(in) :: x       !! > 0
        integer, intent(in) :: power
        integer, parameter :: exact = 22   !! 10**exact is a number of this kind
        real(dp) :: high, low, product, rest
        integer :: left, now

        high = x
        low = 0.0_dp
        left = power
        do while (left > 0)
            now = min(left, exact)
            product = high * 10.0_dp**now
            low = low * 10.0_dp**now + left_out(high, 10.0_dp**now, product)
            high = product + low
            low = low - (high - product)
            left = left - now
        end do
        if (left < 0) then
            product = high / 10.0_dp**(-left)
            low = -left_out(product, 10.0_dp**(-left), high) / 10.0_dp**(-left)
            high = product
        end if
        whole = int(high, int64) + floor(low, int64)
        rest = low - floor(low, int64)
        if (rest > 0.5_dp .or. (.not. rest < 0.5_dp .and. modulo(whole, 2_int64) == 1)) whole = &
            whole + 1
    end function scaled

    !> a b - product, where that is small, exactly (Dekker 1971).
    pure real(dp) function left_out(a, b, product) result(rest)
        real(dp), intent(in) :: a, b, product
        real(dp), parameter :: splitter = 2.0_dp**27 + 1.0_dp
        real(dp) :: a_high, b_high

        a_high = splitter * a - (splitter * a - a)
        b_high = splitter * b - (splitter * b - b)
        rest = ((a_high * b_high - product) + a_high * (b - b_high) + (a - a_high) * b_high) &
            + (a - a_high) * (b - b_high)
    end function left_out

    pure function whole_text(number) result(text)
        integer, intent(in) :: number
        character(len=:), allocatable :: text
        character(len=12) :: buffer

        write (buffer, '(i0)') number
        text = trim(buffer)
    end function whole_text

    !> A number with as many digits as it takes to read the same bits back, and no more.
    pure function short_text(number) result(text)
        real(dp), intent(in) :: number   !! finite
        character(len=:), allocatable :: text
        character(len=32) :: buffer, form
        real(dp) :: back
        integer :: digits, ends

        do digits = 15, 17
            if (abs(number) >= 0.1_dp .and. abs(number) < 1.0e6_dp) then
                write (form, '(a, i0, a)') '(g32.', digits, ')'
            else
                write (form, '(a, i0, a)') '(es32.', digits - 1, 'e3)'
            end if
            write (buffer, form) number
            read (buffer, *) back
            if (.not. abs(back - number) > 0.0_dp) exit
        end do
        ends = index(buffer // 'E', 'E') - 1
        text = trim(buffer(:ends))
        text = text(:verify(text, '0', back=.true.))
        text = text(:verify(text, '.', back=.true.))
        text = trim(adjustl(text // buffer(ends + 1:)))
        if (.not. abs(number) > 0.0_dp) text = '0'
    end function short_text

    !> A number as format es has it, with a digit less where the exponent has three: Fortran leaves
    !> out the E before it there, and no other language reads 1.0-100.
    pure function rounded_text(number, width, digits) result(text)
        real(dp), intent(in) :: number
        integer, intent(in) :: width, digits   !! in all; behind the point, >= 1
        character(len=width) :: text
        character(len=16) :: form

        write (form, '(2(a, i0), a)') '(es', width, '.', digits, ')'
        write (text, form) number
        if (index(text, 'E') > 0 .or. scan(text, '.') == 0) return   ! NaN and Infinity have none
        write (form, '(2(a, i0), a)') '(es', width, '.', digits - 1, 'e3)'
        write (text, form) number
    end function rounded_text

    !> A number near 1 as it is, others with an exponent. Format g0.6 would do, but compilers differ
    !> in its exponent and its leading zero.
    pure function six_digits(number) result(text)
        real(dp), intent(in) :: number   !! finite
        character(len=:), allocatable :: text
        character(len=13) :: buffer
        logical :: near

        near = abs(number) >= 0.1_dp .and. abs(number) < 1.0e6_dp
        if (near .or. .not. abs(number) > 0.0_dp) then
            write (buffer, '(g13.6)') number
        else
            buffer = rounded_text(number, 13, 5)
        end if
        text = trim(adjustl(buffer))
    end function six_digits

    !> A text as one field of a CSV file, whatever it contains.
    pure function quoted_field(text) result(field)
        character(len=*), intent(in) :: text
        character(len=:), allocatable :: field

        field = '"' // replaced(text, '"', '""') // '"'
    end function quoted_field

end module number_text
