!> Linear slip-weakening friction: the coefficient falls from its static to its kinetic value over
!> the slip d_c,
!>
!>     resistance = mu(D) p,   mu(D) = max(mu_k, mu_s - (mu_s - mu_k) D/d_c)
!>
!> with the slip D since the surface was fresh as internal variable. It does not heal: D never falls
!> (a host that knows of healing sets it back). mu(D) is convex, so the equation of the return
!> mapping is concave in the slip and positive at 0: it has one root, however steep the fall.
module friction_slip_weakening_law
    use friction_kinds, only : wp
    use friction_law, only : below, internal_variable, law_description, law_state, law_traits, &
        load_rates, named_law, sliding
    use friction_law_constants, only : constant_table, law_constant, no_constants, positive
    use friction_slip_weakening_core, only : coefficient_at, fall_at, slip_to_balance
    use friction_status, only : friction_bad_property, friction_bad_size, friction_ok
    implicit none
    private

    public :: slip_weakening_law

    type, extends(named_law) :: slip_weakening_law
        real(wp) :: mu_s   !! coefficient of a fresh surface, >= mu_k [-]
        real(wp) :: mu_k   !! coefficient after the slip d_c, >= 0 [-]
        real(wp) :: d_c    !! slip over which it falls, > 0 [L]
    contains
        procedure :: read => read_constants
        procedure :: typical_coefficient
        procedure :: kinetic_coefficient
        procedure :: virgin
        procedure :: admits
        procedure :: rest
        procedure :: slide
        procedure :: slip_rate
        procedure :: state_rates
        procedure :: traits
        procedure :: solve
    end type slip_weakening_law

    !> Its own constants; in `props` they stand from place 4 on.
    type(law_constant), parameter, public :: slip_weakening_constants(3) = [ &
        law_constant('mu_s', '-', 'friction coefficient of a fresh surface', 'StaticFriction', &
        lower=0.0_wp, &
        not_below=2), &
        law_constant('mu_k', '-', 'friction coefficient after the slip d_c', 'KineticFriction', &
        lower=0.0_wp), &
        law_constant('d_c', 'L', 'slip over which friction falls', 'CriticalSlip', lower=positive)]

    integer, parameter :: n_constants = size(slip_weakening_constants)

    type(internal_variable), parameter, public :: slip_variable = &
        internal_variable('D', 'L', exists=.true.)

    type(law_description), parameter, public :: slip_weakening_description = law_description( &
        name='slip_weakening', &
        summary='Friction that falls with slip, linearly, from mu_s to mu_k, and stays there', &
        constants=constant_table(n_constants, [slip_weakening_constants, &
        no_constants(n_constants + 1:)]), &
        internal=slip_variable)

contains

    pure subroutine read_constants(self, n, constants, n_own, status)
        class(slip_weakening_law), intent(inout) :: self
        integer, intent(in) :: n
        real(wp), intent(in) :: constants(n)
        integer, intent(out) :: n_own, status

        n_own = size(slip_weakening_constants)
        status = friction_bad_size
        if (n < 3) return
        status = friction_bad_property
        if (any(constants(:3) < slip_weakening_constants(:3)%lower)) return
        if (constants(1) < constants(slip_weakening_constants(1)%not_below)) return
        self%mu_s = constants(1)
        self%mu_k = constants(2)
        self%d_c = constants(3)
        status = friction_ok
    end subroutine read_constants

    pure function typical_coefficient(self) result(mu)
        class(slip_weakening_law), intent(in) :: self
        real(wp) :: mu

        mu = self%mu_s
    end function typical_coefficient

    pure function kinetic_coefficient(self) result(mu)
        class(slip_weakening_law), intent(in) :: self
        real(wp) :: mu

        mu = self%mu_k
    end function kinetic_coefficient

    pure function virgin(self) result(state)
        class(slip_weakening_law), intent(in) :: self
        type(law_state) :: state

        state = law_state(mu=self%mu_s, r=0.0_wp)
    end function virgin

    !> The coefficient in the state is for the reader; it follows from D.
    pure function admits(self, state) result(valid)
        class(slip_weakening_law), intent(in) :: self
        type(law_state), intent(in) :: state
        logical :: valid

        valid = state%mu >= 0.0_wp .and. state%r >= 0.0_wp
    end function admits

    pure subroutine rest(self, traction, pressure, dt, old, new, strength)
        class(slip_weakening_law), intent(in) :: self
        real(wp), intent(in) :: traction, pressure, dt
        type(law_state), intent(in) :: old
        type(law_state), intent(out) :: new
        real(wp), intent(out) :: strength

        new = state_after(self, old%r)
        strength = new%mu * pressure
    end subroutine rest

    !> Where the fall ends, the derivative is that of the end.
    pure subroutine slide(self, slip, pressure, dt, old, new, resistance, d_slip, d_pressure)
        class(slip_weakening_law), intent(in) :: self
        real(wp), intent(in) :: slip, pressure, dt
        type(law_state), intent(in) :: old
        type(law_state), intent(out) :: new
        real(wp), intent(out) :: resistance, d_slip, d_pressure

        new = state_after(self, old%r + slip)
        d_pressure = new%mu
        resistance = new%mu * pressure
        d_slip = -fall(self, new%r, pressure)
    end subroutine slide

    !> Two straight lines, the lower of which counts.
    pure subroutine solve(self, trial, stiffness, pressure, dt, old, answer, solved)
        class(slip_weakening_law), intent(in) :: self
        real(wp), intent(in) :: trial, stiffness, pressure, dt
        type(law_state), intent(in) :: old
        type(sliding), intent(out) :: answer
        logical, intent(out) :: solved
        type(law_state) :: start

        start = state_after(self, old%r)
        answer%slip = slip_to_balance(trial - start%mu * pressure, trial - self%mu_k * pressure, &
            stiffness, fall(self, old%r, pressure))
        call self%slide(answer%slip, pressure, dt, old, answer%state, answer%resistance, &
            answer%d_slip, answer%d_pressure)
        solved = .true.
    end subroutine solve

    pure subroutine slip_rate(self, state, load, rate, jumps)
        class(slip_weakening_law), intent(in) :: self
        type(law_state), intent(in) :: state
        type(load_rates), intent(in) :: load
        real(wp), intent(out) :: rate
        logical, intent(out) :: jumps
        type(law_state) :: now
        real(wp) :: slope

        jumps = .false.
        rate = 0.0_wp
        now = state_after(self, state%r)
        if (below(load, now%mu * load%pressure)) return
        rate = load%loading - now%mu * load%pressure_rate
        if (.not. load%sliding) rate = max(0.0_wp, rate)
        slope = load%stiffness - fall(self, state%r, load%pressure)
        jumps = rate > 0.0_wp .and. slope <= 0.0_wp
        rate = rate / merge(slope, load%stiffness, slope > 0.0_wp)
    end subroutine slip_rate

    pure function state_rates(self, state, load, slip_rate) result(rates)
        class(slip_weakening_law), intent(in) :: self
        type(law_state), intent(in) :: state
        type(load_rates), intent(in) :: load
        real(wp), intent(in) :: slip_rate
        type(law_state) :: rates

        rates = law_state(mu=-fall(self, state%r, 1.0_wp) * slip_rate, r=slip_rate)
    end function state_rates

    pure function traits(self)
        class(slip_weakening_law), intent(in) :: self
        type(law_traits) :: traits

        traits = law_traits(memory=2, weight=(self%mu_s - self%mu_k) / self%d_c, kink=self%d_c, &
            slip_scale=self%d_c, weakening=(self%mu_s - self%mu_k) / self%d_c)
    end function traits

    pure function state_after(self, d) result(state)
        class(slip_weakening_law), intent(in) :: self
        real(wp), intent(in) :: d   !! slip since the surface was fresh, >= 0 [L]
        type(law_state) :: state

        state = law_state(mu=coefficient_at(d, self%mu_s, self%mu_k, self%d_c), r=d)
    end function state_after

    !> How fast the resistance falls with slip.
    pure function fall(self, d, pressure) result(rate)
        class(slip_weakening_law), intent(in) :: self
        real(wp), intent(in) :: d          !! slip since the surface was fresh, >= 0 [L]
        real(wp), intent(in) :: pressure   !! [F/L^2]
        real(wp) :: rate                   !! >= 0 [F/L^3]

        rate = fall_at(d, (self%mu_s - self%mu_k) * pressure, self%d_c)
    end function fall

end module friction_slip_weakening_law
