!> Numbers as text, each way once.
module number_text
    use, intrinsic :: iso_fortran_env, only : dp => real64
    implicit none
    private

    public :: full_row, quoted_field, short_text, whole_text

contains

    !> Numbers with 17 significant digits, so that reading them back gives the same bits, between
    !> commas or another sign.
    pure function full_row(numbers, separator) result(line)
        real(dp), intent(in) :: numbers(:)
        character(len=1), intent(in), optional :: separator
        character(len=:), allocatable :: line
        character(len=25 * size(numbers)) :: buffer, packed
        integer :: i, n

        write (buffer, '(*(es24.16e3, :, ","))') numbers
        n = 0
        do i = 1, len(buffer)
            if (buffer(i:i) == ' ') cycle
            n = n + 1
            packed(n:n) = buffer(i:i)
            if (present(separator) .and. buffer(i:i) == ',') packed(n:n) = separator
        end do
        line = packed(:n)
    end function full_row

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

    !> A text as one field of a CSV file, whatever it contains.
    pure function quoted_field(text) result(field)
        character(len=*), intent(in) :: text
        character(len=:), allocatable :: field
        integer :: i

        field = '"'
        do i = 1, len(text)
            field = field // text(i:i)
            if (text(i:i) == '"') field = field // '"'
        end do
        field = field // '"'
    end function quoted_field

end module number_text
