!> Rules and defaults of constants in words. Characters are moved one by one: the shared objects of
!> this library do without the Fortran run-time library, which intrinsic procedures for texts need.
module friction_law_texts
    use friction_kinds, only : wp
    use friction_law_constants, only : constant_table, law_constant, obeys, words_length
    implicit none
    private

    public :: broken_rule, default_text, is_blank, put, put_word, rule_text, same_text, text_line, &
        word_of

    integer, parameter, public :: text_length = 96

    !> A text that is being written.
    type :: text_line
        character(len=text_length) :: text = ' '
        integer :: length = 0
    end type text_line

contains

    !> The rule of a constant, if its value breaks it: blank, or a text such as 'must be >= 0'.
    pure function broken_rule(table, place, values) result(text)
        type(constant_table), intent(in) :: table
        integer, intent(in) :: place
        real(wp), intent(in) :: values(:)   !! of all constants of the table
        character(len=text_length) :: text

        text = ' '
        if (.not. obeys(table%of(place), values(place), values)) text = rule_text(table, place, &
            values)
    end function broken_rule

    !> The rule of a constant in words. With values: the rule that these break, where there are two.
    pure function rule_text(table, place, values) result(text)
        type(constant_table), intent(in) :: table
        integer, intent(in) :: place
        real(wp), intent(in), optional :: values(:)   !! of all constants of the table
        character(len=text_length) :: text
        type(text_line) :: line

        call put(line, 'must be ')
        associate (this => table%of(place))
            if (this%whole) then
                if (present(values)) then
                    if (is_beside(table, place, values)) then
                        call put_beside(line, table, place, values)
                        text = line%text
                        return
                    end if
                end if
                call put_choices(line, this)
            else if (this%not_below > 0 .and. this%not_above > 0) then
                call put(line, 'from ')
                call put_word(line, table%of(this%not_below)%name)
                call put(line, ' to ')
                call put_word(line, table%of(this%not_above)%name)
            else if (this%not_below > 0) then
                call put(line, '>= ')
                call put_word(line, table%of(this%not_below)%name)
            else if (this%not_above > 0) then
                call put(line, 'from ')
                call put_number(line, this%lower)
                call put(line, ' to ')
                call put_word(line, table%of(this%not_above)%name)
            else if (this%upper < huge(this%upper)) then
                call put(line, 'from ')
                call put_number(line, this%lower)
                call put(line, ' to ')
                call put_number(line, this%upper)
                if (this%or_zero) call put(line, ', or 0')
            else if (this%lower > 0.0_wp) then
                call put(line, '> 0')
            else
                call put(line, '>= 0')
            end if
        end associate
        text = line%text
    end function rule_text

    !> Is it another choice that does not go with this one?
    pure function is_beside(table, place, values) result(beside)
        type(constant_table), intent(in) :: table
        integer, intent(in) :: place
        real(wp), intent(in) :: values(:)
        logical :: beside

        associate (this => table%of(place))
            beside = this%not_beside > 0 .and. values(place) >= this%lower &
                .and. values(place) <= this%upper
            if (beside) beside = .not. abs(values(place) - aint(values(place))) > 0.0_wp
        end associate
    end function is_beside

    pure subroutine put_beside(line, table, place, values)
        type(text_line), intent(inout) :: line
        type(constant_table), intent(in) :: table
        integer, intent(in) :: place
        real(wp), intent(in) :: values(:)

        associate (this => table%of(place), other => table%of(table%of(place)%not_beside))
            call put(line, "'")
            call put_word(line, word_of(this, 0))
            call put(line, "' with ")
            call put_word(line, other%name)
            call put(line, " = '")
            call put_word(line, word_of(other, int(values(this%not_beside))))
            call put(line, "'")
        end associate
    end subroutine put_beside

    !> The default of a constant in words: blank where it has none.
    pure function default_text(table, place) result(text)
        type(constant_table), intent(in) :: table
        integer, intent(in) :: place
        character(len=text_length) :: text
        type(text_line) :: line

        text = ' '
        associate (this => table%of(place))
            if (.not. this%optional) return
            if (this%default_from > 0) then
                call put_word(line, table%of(this%default_from)%name)
                if (this%default_per > 0) then
                    call put(line, '/')
                    call put_word(line, table%of(this%default_per)%name)
                end if
            else if (this%whole) then
                call put_word(line, word_of(this, int(this%default)))
            else
                call put_number(line, this%default)
            end if
        end associate
        text = line%text
    end function default_text

    !> The words of a choice with their numbers: '0 (ageing) or 1 (slip)'.
    pure subroutine put_choices(line, this)
        type(text_line), intent(inout) :: line
        type(law_constant), intent(in) :: this
        integer :: i, last

        last = int(this%upper)
        do i = 0, last
            if (i > 0 .and. i < last) call put(line, ', ')
            if (i > 0 .and. i == last) call put(line, ' or ')
            call put_number(line, real(i, wp))
            call put(line, ' (')
            call put_word(line, word_of(this, i))
            call put(line, ')')
        end do
    end subroutine put_choices

    !> The word that stands for a number of a choice; blank if none does.
    pure function word_of(this, number) result(word)
        type(law_constant), intent(in) :: this
        integer, intent(in) :: number            !! 0, 1, ...
        character(len=words_length) :: word
        integer :: i, passed, length

        word = ' '
        passed = 0
        length = 0
        do i = 1, words_length
            if (is_blank(this%words(i:i))) then
                passed = passed + 1
            else if (passed == number) then
                length = length + 1
                word(length:length) = this%words(i:i)
            end if
        end do
    end function word_of

    !> Writes a text behind what there is.
    pure subroutine put(line, piece)
        type(text_line), intent(inout) :: line
        character(len=*), intent(in) :: piece
        integer :: i

        do i = 1, min(len(piece), text_length - line%length)
            line%text(line%length + i:line%length + i) = piece(i:i)
        end do
        line%length = min(line%length + len(piece), text_length)
    end subroutine put

    !> The same without the blanks behind a word.
    pure subroutine put_word(line, word)
        type(text_line), intent(inout) :: line
        character(len=*), intent(in) :: word
        integer :: i

        do i = 1, len(word)
            if (is_blank(word(i:i))) exit
            call put(line, word(i:i))
        end do
    end subroutine put_word

    !> The same of a number that is written with few digits, as bounds are: whole, or with three
    !> decimals.
    pure subroutine put_number(line, x)
        type(text_line), intent(inout) :: line
        real(wp), intent(in) :: x   !! 0 to 999999, a multiple of 0.001
        integer :: thousandths, power
        logical :: begun

        thousandths = int(1000.0_wp * x + 0.5_wp)
        power = 10**8
        begun = .false.
        do while (power > 0)
            if (power == 100) then
                if (mod(thousandths, 1000) == 0) exit
                call put(line, '.')
            end if
            begun = begun .or. power <= 1000 .or. thousandths / power > 0
            if (begun) call put(line, achar(iachar('0') + mod(thousandths / power, 10)))
            power = power / 10
        end do
    end subroutine put_number

    !> Are two texts the same but for blanks at their ends?
    pure function same_text(a, b) result(same)
        character(len=*), intent(in) :: a, b
        logical :: same
        integer :: i

        same = .false.
        do i = 1, max(len(a), len(b))
            if (at(a, i) /= at(b, i)) return
        end do
        same = .true.
    end function same_text

    pure function is_blank(one) result(blank)
        character(len=1), intent(in) :: one
        logical :: blank

        blank = iachar(one) == iachar(' ')
    end function is_blank

    !> A character of a text that blanks follow.
    pure function at(text, i) result(one)
        character(len=*), intent(in) :: text
        integer, intent(in) :: i
        character(len=1) :: one

        one = ' '
        if (i <= len(text)) one = text(i:i)
    end function at

end module friction_law_texts
