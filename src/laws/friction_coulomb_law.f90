!> Coulomb friction with a constant coefficient:
!>
!>     resistance = mu p
!>
!> Nothing evolves; the internal variable stays 0.
module friction_coulomb_law
    use friction_kinds, only : wp
    use friction_law, only : below, law_description, law_state, load_rates, named_law, sliding
    use friction_law_constants, only : constant_table, law_constant, no_constants
    use friction_status, only : friction_bad_property, friction_bad_size, friction_ok
    implicit none
    private

    public :: coulomb_law

    type, extends(named_law) :: coulomb_law
        real(wp) :: mu   !! friction coefficient, >= 0 [-]
    contains
        procedure :: read => read_constants
        procedure :: typical_coefficient
        procedure :: virgin
        procedure :: admits
        procedure :: rest
        procedure :: slide
        procedure :: solve
        procedure :: slip_rate
        procedure :: state_rates
    end type coulomb_law

    !> Its own constants; in `props` they stand from place 4 on.
    type(law_constant), parameter :: table(1) = [ &
        law_constant('mu', '-', 'friction coefficient', 'Friction', lower=0.0_wp)]

    type(law_description), parameter, public :: coulomb_description = law_description( &
        name='coulomb', &
        summary='Friction proportional to the pressure', &
        constants=constant_table(size(table), [table, no_constants(size(table) + 1:)]))

contains

    pure subroutine read_constants(self, n, constants, n_own, status)
        class(coulomb_law), intent(inout) :: self
        integer, intent(in) :: n
        real(wp), intent(in) :: constants(n)
        integer, intent(out) :: n_own, status

        n_own = size(table)
        status = friction_bad_size
        if (n < 1) return
        status = friction_bad_property
        if (any(constants(:1) < table(:1)%lower)) return
        self%mu = constants(1)
        status = friction_ok
    end subroutine read_constants

    pure function typical_coefficient(self) result(mu)
        class(coulomb_law), intent(in) :: self
        real(wp) :: mu

        mu = self%mu
    end function typical_coefficient

    pure function virgin(self) result(state)
        class(coulomb_law), intent(in) :: self
        type(law_state) :: state

        state = law_state(mu=self%mu, r=0.0_wp)
    end function virgin

    !> The coefficient in the state is for the reader; a host may change `mu` on the way.
    pure function admits(self, state) result(valid)
        class(coulomb_law), intent(in) :: self
        type(law_state), intent(in) :: state
        logical :: valid

        valid = state%mu >= 0.0_wp .and. .not. abs(state%r) > 0.0_wp
    end function admits

    pure subroutine rest(self, traction, pressure, dt, old, new, strength)
        class(coulomb_law), intent(in) :: self
        real(wp), intent(in) :: traction, pressure, dt
        type(law_state), intent(in) :: old
        type(law_state), intent(out) :: new
        real(wp), intent(out) :: strength

        new = self%virgin()
        strength = self%mu * pressure
    end subroutine rest

    pure subroutine slide(self, slip, pressure, dt, old, new, resistance, d_slip, d_pressure)
        class(coulomb_law), intent(in) :: self
        real(wp), intent(in) :: slip, pressure, dt
        type(law_state), intent(in) :: old
        type(law_state), intent(out) :: new
        real(wp), intent(out) :: resistance, d_slip, d_pressure

        new = self%virgin()
        resistance = self%mu * pressure
        d_slip = 0.0_wp
        d_pressure = self%mu
    end subroutine slide

    pure subroutine solve(self, trial, stiffness, pressure, dt, old, answer, solved)
        class(coulomb_law), intent(in) :: self
        real(wp), intent(in) :: trial, stiffness, pressure, dt
        type(law_state), intent(in) :: old
        type(sliding), intent(out) :: answer
        logical, intent(out) :: solved

        answer%slip = (trial - self%mu * pressure) / stiffness
        call slide(self, answer%slip, pressure, dt, old, answer%state, answer%resistance, &
            answer%d_slip, answer%d_pressure)
        solved = .true.
    end subroutine solve

    pure subroutine slip_rate(self, state, load, rate, jumps)
        class(coulomb_law), intent(in) :: self
        type(law_state), intent(in) :: state
        type(load_rates), intent(in) :: load
        real(wp), intent(out) :: rate
        logical, intent(out) :: jumps

        jumps = .false.
        rate = 0.0_wp
        if (below(load, self%mu * load%pressure)) return
        rate = (load%loading - self%mu * load%pressure_rate) / load%stiffness
        if (.not. load%sliding) rate = max(0.0_wp, rate)
    end subroutine slip_rate

    pure function state_rates(self, state, load, slip_rate) result(rates)
        class(coulomb_law), intent(in) :: self
        type(law_state), intent(in) :: state
        type(load_rates), intent(in) :: load
        real(wp), intent(in) :: slip_rate
        type(law_state) :: rates

        rates = law_state(mu=0.0_wp, r=0.0_wp)
    end function state_rates

end module friction_coulomb_law
