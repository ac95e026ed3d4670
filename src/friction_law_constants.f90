!> What laws say about their constants: names, units, ranges, defaults. A law has one table of them;
!> it is checked by that table, described by it, and read by it from input files.
module friction_law_constants
    use friction_kinds, only : largest, wp
    use friction_status, only : friction_bad_property, friction_ok
    implicit none
    private

    public :: complete_constants, constant_table, default_value, law_constant, obeys, positive

    !> The least number that counts as above zero, where a constant has to be: its reciprocal is the
    !> largest number that is taken.
    real(wp), parameter :: positive = 2.0_wp**(-333)

    integer, parameter, public :: name_length = 23, unit_length = 8, meaning_length = 64
    integer, parameter, public :: long_name_length = 32, words_length = 64, table_length = 24

    !> One constant. Places count within the same table.
    type :: law_constant
        character(len=name_length) :: name = ''    !! also its key in the program's input
        character(len=unit_length) :: unit = ''    !! '-', 'L', 'T/L', 'F/L^2', ...
        character(len=meaning_length) :: meaning = ''   !! in words
        character(len=long_name_length) :: long_name = ''   !! for hosts that name
                                                            !! constants in words (MFront's)
        real(wp) :: lower = 0.0_wp         !! least value; `positive` stands for > 0
        real(wp) :: upper = huge(1.0_wp)   !! largest value, where it is below that of all numbers
                                           !! (`largest`)
        logical :: or_zero = .false.       !! zero is allowed, too, and means the default
        integer :: not_below = 0           !! place of the constant that it must not fall below
        integer :: not_above = 0           !! place of the constant that it must not exceed
        integer :: not_beside = 0          !! where that constant is not 0, this one has to be
        logical :: optional = .false.      !! it may be left out, with all that follow it
        real(wp) :: default = 0.0_wp       !! then
        integer :: default_from = 0        !! or then it is the constant in this place ...
        integer :: default_per = 0         !! ... over the one in this place
        logical :: whole = .false.         !! it is a choice: a whole number
        character(len=words_length) :: words = ''   !! which word stands for 0, 1, ... in the
                                                    !! program's input; blanks between them
    end type law_constant

    !> A table of fixed size: nothing is allocated.
    type :: constant_table
        integer :: n = 0               !! how many there are
        type(law_constant) :: of(table_length)
    end type constant_table

    !> Fills up a table that is written down: constant_table(n, [constants, no_constants(n + 1:)]).
    type(law_constant), parameter, public :: no_constants(table_length) = law_constant()

contains

    !> All constants of a table, those that are left out by their defaults, once the needed ones are
    !> known to obey their rules. (A law checks those itself, by the same table: every update passes
    !> there, and a compiler that sees the table turns it into a handful of comparisons.)
    pure subroutine complete_constants(n_needed, table, n, given, full, status)
        integer, intent(in) :: n_needed             !! how many come first and have no default
        type(law_constant), intent(in) :: table(:)
        integer, intent(in) :: n                    !! how many are given, `n_needed` or more; more
                                                    !! than there are in the table do no harm
        real(wp), intent(in) :: given(n)            !! finite
        real(wp), intent(out) :: full(size(table))
        integer, intent(out) :: status              !! ok or bad property
        integer :: place

        full(:n_needed) = given(:n_needed)
        status = friction_bad_property
        do place = n_needed + 1, size(table)
            if (place <= n) then
                full(place) = given(place)
            else
                full(place) = default_value(table(place), full)
            end if
            if (.not. obeys(table(place), full(place), full)) return
        end do
        status = friction_ok
    end subroutine complete_constants

    !> The value of a constant that is left out.
    pure function default_value(this, others) result(value)
        type(law_constant), intent(in) :: this
        real(wp), intent(in) :: others(:)   !! the constants of its table, those that it depends on
        real(wp) :: value                   !! 0, which no rule allows there, where that is a
                                            !! quotient out of range

        value = this%default
        if (this%default_from > 0) value = others(this%default_from)
        if (this%default_per == 0) return
        if (abs(value) < largest * abs(others(this%default_per))) then
            value = value / others(this%default_per)
        else
            value = 0.0_wp
        end if
    end function default_value

    !> Does a constant obey its rule?
    pure function obeys(this, value, others) result(valid)
        type(law_constant), intent(in) :: this
        real(wp), intent(in) :: value
        real(wp), intent(in) :: others(:)   !! the constants of its table
        logical :: valid

        valid = value >= this%lower .and. value <= this%upper
        if (this%or_zero) valid = valid .or. .not. abs(value) > 0.0_wp
        if (this%not_below > 0) valid = valid .and. value >= others(this%not_below)
        if (this%not_above > 0) valid = valid .and. value <= others(this%not_above)
        if (this%whole) valid = valid .and. .not. abs(value - aint(value)) > 0.0_wp
        if (this%not_beside > 0) valid = valid .and. .not. (abs(value) > 0.0_wp &
            .and. abs(others(this%not_beside)) > 0.0_wp)
    end function obeys

end module friction_law_constants
