!> A shear cap for any friction law: the interface, or the softer of the two bodies, cannot carry
!> more than `tau_max`, whatever the pressure,
!>
!>     resistance = min(resistance of the law, tau_max)
!>
!> The law's internal variables evolve as without the cap, with the slip that results. Where the cap
!> holds, the traction depends neither on the slip nor on the pressure. In an increment that slides
!> it is the return mapping that cuts the resistance off.
module friction_shear_cap
    use friction_kinds, only : wp
    use friction_law, only : below, law_state, load_rates
    use friction_law_around, only : law_around
    use friction_law_constants, only : law_constant
    implicit none
    private

    public :: capped_law

    !> The constant that every law takes after its own.
    type(law_constant), parameter, public :: cap_constants(1) = [ &
        law_constant('tau_max', 'F/L^2', 'largest tangential traction; 0: none', 'ShearCap', &
        lower=0.0_wp, &
        optional=.true.)]

    type, extends(law_around) :: capped_law
    contains
        procedure :: rest
        procedure :: slip_rate
        procedure :: resistance_at
    end type capped_law

contains

    pure subroutine rest(self, traction, pressure, dt, old, new, strength)
        class(capped_law), intent(in) :: self
        real(wp), intent(in) :: traction, pressure, dt
        type(law_state), intent(in) :: old
        type(law_state), intent(out) :: new
        real(wp), intent(out) :: strength

        call self%inner%rest(traction, pressure, dt, old, new, strength)
        strength = min(strength, self%tau_max)
    end subroutine rest

    !> At the cap, the slip that keeps the traction there, or more where the law itself asks for it.
    !> Where its own strength is higher, the law has no say unless that falls with the slip rate.
    pure subroutine slip_rate(self, state, load, rate, jumps)
        class(capped_law), intent(in) :: self
        type(law_state), intent(in) :: state
        type(load_rates), intent(in) :: load
        real(wp), intent(out) :: rate
        logical, intent(out) :: jumps
        type(law_state) :: new
        real(wp) :: own, strength, resistance, by_rate

        if (below(load, self%tau_max)) then
            call self%inner%slip_rate(state, load, rate, jumps)
            return
        end if
        jumps = .false.
        rate = max(0.0_wp, load%loading) / load%stiffness
        call self%inner%rest(load%traction, load%pressure, 0.0_wp, state, new, strength)
        if (below(load, strength)) then
            call self%inner%resistance_at(state, rate, load%pressure, resistance, by_rate)
            jumps = resistance < self%tau_max
        else
            call self%inner%slip_rate(state, load, own, jumps)
            rate = max(rate, own)
        end if
    end subroutine slip_rate

    pure subroutine resistance_at(self, state, rate, pressure, resistance, by_rate)
        class(capped_law), intent(in) :: self
        type(law_state), intent(in) :: state
        real(wp), intent(in) :: rate, pressure
        real(wp), intent(out) :: resistance, by_rate

        call self%inner%resistance_at(state, rate, pressure, resistance, by_rate)
        if (resistance < self%tau_max) return
        resistance = self%tau_max
        by_rate = 0.0_wp
    end subroutine resistance_at

end module friction_shear_cap
