!> The numbers that a key of the input may take, and the rule in words.
module namelist_rules
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use number_text, only : whole_text
    implicit none
    private

    public :: above, any_number, at_least, between, not_zero, rule

    type :: rule
        real(dp) :: low = -huge(1.0_dp)
        real(dp) :: high = huge(1.0_dp)
        logical :: low_excluded = .false.
        logical :: zero_excluded = .false.
        character(len=:), allocatable :: text   !! in words, after "must be"
    contains
        procedure :: holds
    end type rule

contains

    pure logical function holds(self, value)
        class(rule), intent(in) :: self
        real(dp), intent(in) :: value   !! finite

        holds = value >= self%low .and. value <= self%high
        if (self%low_excluded) holds = holds .and. value > self%low
        if (self%zero_excluded) holds = holds .and. abs(value) > 0.0_dp
    end function holds

    pure type(rule) function any_number() result(r)
        r%text = 'a number'
    end function any_number

    pure type(rule) function not_zero() result(r)
        r%zero_excluded = .true.
        r%text = 'a number other than 0'
    end function not_zero

    pure type(rule) function above(low) result(r)
        real(dp), intent(in) :: low

        r%low = low
        r%low_excluded = .true.
        r%text = '> ' // short(low)
    end function above

    pure type(rule) function at_least(low) result(r)
        real(dp), intent(in) :: low

        r%low = low
        r%text = '>= ' // short(low)
    end function at_least

    !> From `low` to `high`, both included.
    pure type(rule) function between(low, high) result(r)
        real(dp), intent(in) :: low, high

        r%low = low
        r%high = high
        r%text = 'from ' // short(low) // ' to ' // short(high)
    end function between

    !> A number with no more digits than it needs.
    pure recursive function short(number) result(text)
        real(dp), intent(in) :: number
        character(len=:), allocatable :: text
        character(len=24) :: buffer
        integer :: exponent

        if (abs(number - anint(number)) <= 0.0_dp) then
            text = whole_text(nint(number))
        else if (abs(number) < 1.0e-3_dp) then
            exponent = floor(log10(abs(number)) + 1.0e-9_dp)
            text = short(1.0e-3_dp * anint(1.0e3_dp * number / 10.0_dp**exponent)) // 'e' &
                // whole_text(exponent)
        else
            write (buffer, '(f24.3)') number
            text = trim(adjustl(buffer))
            text = text(:verify(text, '0', back=.true.))
        end if
    end function short

end module namelist_rules
