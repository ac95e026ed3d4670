!> A law around a law: an option that changes what a surface resists with holds the law that it
!> changes. What the option leaves as it is, is passed on here.
module friction_law_around
    use friction_kinds, only : wp
    use friction_law, only : law, law_state, law_traits, load_rates, sliding
    implicit none
    private

    public :: law_around

    type, abstract, extends(law) :: law_around
        class(law), pointer :: inner   !! the law without the option
    contains
        procedure :: virgin
        procedure :: admits
        procedure :: slide
        procedure :: state_rates
        procedure :: traits
        procedure :: scale_of_terms
        procedure :: settle
        procedure :: slopes
        procedure :: steepest_fall
        procedure :: needs_time
        procedure :: solve
        procedure :: pressed
    end type law_around

contains

    pure function virgin(self) result(state)
        class(law_around), intent(in) :: self
        type(law_state) :: state

        state = self%inner%virgin()
    end function virgin

    pure function admits(self, state) result(valid)
        class(law_around), intent(in) :: self
        type(law_state), intent(in) :: state
        logical :: valid

        valid = self%inner%admits(state)
    end function admits

    pure subroutine slide(self, slip, pressure, dt, old, new, resistance, d_slip, d_pressure)
        class(law_around), intent(in) :: self
        real(wp), intent(in) :: slip, pressure, dt
        type(law_state), intent(in) :: old
        type(law_state), intent(out) :: new
        real(wp), intent(out) :: resistance, d_slip, d_pressure

        call self%inner%slide(slip, pressure, dt, old, new, resistance, d_slip, d_pressure)
    end subroutine slide

    pure function state_rates(self, state, load, slip_rate) result(rates)
        class(law_around), intent(in) :: self
        type(law_state), intent(in) :: state
        type(load_rates), intent(in) :: load
        real(wp), intent(in) :: slip_rate
        type(law_state) :: rates

        rates = self%inner%state_rates(state, load, slip_rate)
    end function state_rates

    pure function traits(self)
        class(law_around), intent(in) :: self
        type(law_traits) :: traits

        traits = self%inner%traits()
    end function traits

    pure function scale_of_terms(self, slid, dt, old) result(scale)
        class(law_around), intent(in) :: self
        type(sliding), intent(in) :: slid
        real(wp), intent(in) :: dt
        type(law_state), intent(in) :: old
        real(wp) :: scale

        scale = self%inner%scale_of_terms(slid, dt, old)
    end function scale_of_terms

    pure subroutine settle(self, misfit, stiffness, pressure, answer)
        class(law_around), intent(in) :: self
        real(wp), intent(in) :: misfit, stiffness, pressure
        type(sliding), intent(inout) :: answer

        call self%inner%settle(misfit, stiffness, pressure, answer)
    end subroutine settle

    pure subroutine slopes(self, first, last, pressure, dt, old, least, most)
        class(law_around), intent(in) :: self
        type(sliding), intent(in) :: first, last
        real(wp), intent(in) :: pressure, dt
        type(law_state), intent(in) :: old
        real(wp), intent(out) :: least, most

        call self%inner%slopes(first, last, pressure, dt, old, least, most)
    end subroutine slopes

    pure function steepest_fall(self, pressure, dt, old) result(fall)
        class(law_around), intent(in) :: self
        real(wp), intent(in) :: pressure, dt
        type(law_state), intent(in) :: old
        real(wp) :: fall

        fall = self%inner%steepest_fall(pressure, dt, old)
    end function steepest_fall

    pure function needs_time(self) result(needs)
        class(law_around), intent(in) :: self
        logical :: needs

        needs = self%inner%needs_time()
    end function needs_time

    pure subroutine solve(self, trial, stiffness, pressure, dt, old, answer, solved)
        class(law_around), intent(in) :: self
        real(wp), intent(in) :: trial, stiffness, pressure, dt
        type(law_state), intent(in) :: old
        type(sliding), intent(out) :: answer
        logical, intent(out) :: solved

        call self%inner%solve(trial, stiffness, pressure, dt, old, answer, solved)
    end subroutine solve

    pure function pressed(self, state, before, after) result(new)
        class(law_around), intent(in) :: self
        type(law_state), intent(in) :: state
        real(wp), intent(in) :: before, after
        type(law_state) :: new

        new = self%inner%pressed(state, before, after)
    end function pressed

end module friction_law_around
