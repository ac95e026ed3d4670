!> What namelists say as a JSON text, for other languages: an object of groups, each an object of
!> keys with a value or a list of values. They then read an input as the program does.
module namelist_json
    use, intrinsic :: ieee_arithmetic, only : ieee_is_finite
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use namelist_input, only : namelist_file, read_logical
    use namelist_parser, only : value_token
    use number_reader, only : read_number
    use number_text, only : full_row
    use printable_text, only : growing_text
    implicit none
    private

    public :: write_json

contains

    !> Values that no key takes (a number that is not finite, a word without quotes) are left in
    !> `file%faults`, with all that is wrong with the lists that they are in.
    subroutine write_json(file, text)
        type(namelist_file), intent(inout) :: file
        character(len=:), allocatable, intent(out) :: text
        type(growing_text) :: written
        type(value_token), allocatable :: values(:)
        integer :: group, i, k
        logical :: first

        call written%put('{')
        do group = 1, size(file%groups)
            if (group > 1) call written%put(', ')
            call written%put('"' // file%groups(group)%name // '": {')
            first = .true.
            do i = 1, size(file%entries)
                if (file%entries(i)%group /= file%groups(group)%name) cycle
                if (file%entries(i)%known) cycle   ! one of the key's other assignments told it
                if (.not. first) call written%put(', ')
                first = .false.
                call file%gather(file%entries(i)%group, file%entries(i)%key, values)
                call written%put('"' // file%entries(i)%key // '": ')
                if (size(values) /= 1) call written%put('[')
                do k = 1, size(values)
                    if (k > 1) call written%put(', ')
                    call put_value(file, i, values(k), written)
                end do
                if (size(values) /= 1) call written%put(']')
            end do
            call written%put('}')
        end do
        call written%put('}')
        text = written%text()
    end subroutine write_json

    subroutine put_value(file, entry, token, written)
        type(namelist_file), intent(inout) :: file
        integer, intent(in) :: entry               !! that the value is of
        type(value_token), intent(in) :: token
        type(growing_text), intent(inout) :: written
        integer, parameter :: most_digits = 18     !! of a whole number
        character(len=:), allocatable :: digits
        real(dp) :: number
        logical :: is_number, is_logical, too_small, yes

        call read_number(token%text, number, is_number, too_small)
        call read_logical(token%text, yes, is_logical)
        if (token%quoted) then
            call put_text(token%text, written)
        else if (is_logical) then
            call written%put(trim(merge('true ', 'false', yes)))
        else if (.not. is_number) then
            call refuse('must be a number, text in quotes, .true. or .false.')
        else if (.not. ieee_is_finite(number)) then
            call refuse('must be finite')
        else if (too_small) then
            call refuse('is not 0, but below the smallest number, 4.9e-324')
        else
            digits = token%text(verify(token%text // ' ', '+-0'):)
            if (verify(digits, '0123456789') == 0 .and. len(digits) <= most_digits) then
                if (index(token%text, '-') == 1 .and. len(digits) > 0) call written%put('-')
                if (len(digits) == 0) digits = '0'
                call written%put(digits)
            else
                call written%put(full_row([number]))
            end if
        end if

    contains

        subroutine refuse(why)
            character(len=*), intent(in) :: why

            call file%reject(file%entries(entry)%group, file%entries(entry)%key, why, token=token)
        end subroutine refuse

    end subroutine put_value

    !> A text in quotes, with what JSON does not take in them as numbers of characters.
    subroutine put_text(text, written)
        character(len=*), intent(in) :: text
        type(growing_text), intent(inout) :: written
        character(len=6) :: code
        integer :: i

        call written%put('"')
        do i = 1, len(text)
            if (iachar(text(i:i)) < 32 .or. scan(text(i:i), '"\') > 0) then
                write (code, '(a, z4.4)') '\u', iachar(text(i:i))
                call written%put(code)
            else
                call written%put(text(i:i))
            end if
        end do
        call written%put('"')
    end subroutine put_text

end module namelist_json
