!> Friction that decays from a static to a kinetic coefficient with the slip rate v:
!>
!>     resistance = mu(v) p,   mu(v) = mu_k + (mu_s - mu_k) exp(-d_c v),   v = slip/dt
!>
!> The law has no memory; the internal variable stays 0. Because mu(v) is convex, the equation of
!> the return mapping is concave in the slip and positive at 0: it has one root, however fast the
!> resistance falls.
module friction_static_kinetic_law
    use friction_kinds, only : wp
    use friction_law, only : below, law_description, law_state, law_traits, load_rates, named_law, &
        onset_drops, onset_yields, sliding
    use friction_law_constants, only : constant_table, law_constant, no_constants
    use friction_static_kinetic_core, only : decay_per_slip, excess_after
    use friction_status, only : friction_bad_property, friction_bad_size, friction_ok
    implicit none
    private

    public :: static_kinetic_law

    type, extends(named_law) :: static_kinetic_law
        real(wp) :: mu_s   !! coefficient at v = 0, >= mu_k [-]
        real(wp) :: mu_k   !! coefficient at v -> infinity, >= 0 [-]
        real(wp) :: d_c    !! decay, >= 0 [T/L]
    contains
        procedure :: read => read_constants
        procedure :: typical_coefficient
        procedure :: kinetic_coefficient
        procedure :: rate_weakening
        procedure :: virgin
        procedure :: admits
        procedure :: rest
        procedure :: slide
        procedure :: slip_rate
        procedure :: state_rates
        procedure :: resistance_at
        procedure :: traits
        procedure :: needs_time
        procedure :: solve
    end type static_kinetic_law

    !> Its own constants; in `props` they stand from place 4 on.
    type(law_constant), parameter :: table(3) = [ &
        law_constant('mu_s', '-', 'friction coefficient at rest', 'StaticFriction', &
        lower=0.0_wp, not_below=2), &
        law_constant('mu_k', '-', 'friction coefficient in fast sliding', 'KineticFriction', &
        lower=0.0_wp), &
        law_constant('d_c', 'T/L', 'decay of friction with the slip rate', 'Decay', lower=0.0_wp)]

    type(law_description), parameter, public :: static_kinetic_description = law_description( &
        name='static_kinetic', &
        summary='Friction that falls with the slip rate: mu_k + (mu_s - mu_k) exp(-d_c v)', &
        constants=constant_table(size(table), [table, no_constants(size(table) + 1:)]))

contains

    pure subroutine read_constants(self, n, constants, n_own, status)
        class(static_kinetic_law), intent(inout) :: self
        integer, intent(in) :: n
        real(wp), intent(in) :: constants(n)
        integer, intent(out) :: n_own, status

        n_own = size(table)
        status = friction_bad_size
        if (n < 3) return
        status = friction_bad_property
        if (any(constants(:3) < table(:3)%lower)) return
        if (constants(1) < constants(table(1)%not_below)) return
        self%mu_s = constants(1)
        self%mu_k = constants(2)
        self%d_c = constants(3)
        status = friction_ok
    end subroutine read_constants

    pure function typical_coefficient(self) result(mu)
        class(static_kinetic_law), intent(in) :: self
        real(wp) :: mu

        mu = self%mu_s
    end function typical_coefficient

    pure function kinetic_coefficient(self) result(mu)
        class(static_kinetic_law), intent(in) :: self
        real(wp) :: mu

        mu = self%mu_k
    end function kinetic_coefficient

    pure function rate_weakening(self) result(slope)
        class(static_kinetic_law), intent(in) :: self
        real(wp) :: slope

        slope = (self%mu_s - self%mu_k) * self%d_c
    end function rate_weakening

    pure function virgin(self) result(state)
        class(static_kinetic_law), intent(in) :: self
        type(law_state) :: state

        state = law_state(mu=self%mu_s, r=0.0_wp)
    end function virgin

    !> The coefficient in the state is for the reader; the law has no memory.
    pure function admits(self, state) result(valid)
        class(static_kinetic_law), intent(in) :: self
        type(law_state), intent(in) :: state
        logical :: valid

        valid = state%mu >= 0.0_wp .and. .not. abs(state%r) > 0.0_wp
    end function admits

    pure function needs_time(self) result(needs)
        class(static_kinetic_law), intent(in) :: self
        logical :: needs

        needs = .true.
    end function needs_time

    pure subroutine rest(self, traction, pressure, dt, old, new, strength)
        class(static_kinetic_law), intent(in) :: self
        real(wp), intent(in) :: traction, pressure, dt
        type(law_state), intent(in) :: old
        type(law_state), intent(out) :: new
        real(wp), intent(out) :: strength

        new = self%virgin()
        strength = self%mu_s * pressure
    end subroutine rest

    pure subroutine slide(self, slip, pressure, dt, old, new, resistance, d_slip, d_pressure)
        class(static_kinetic_law), intent(in) :: self
        real(wp), intent(in) :: slip, pressure, dt
        type(law_state), intent(in) :: old
        type(law_state), intent(out) :: new
        real(wp), intent(out) :: resistance, d_slip, d_pressure
        real(wp) :: rate, excess

        rate = decay_per_slip(self%d_c, dt)
        excess = excess_after(self%mu_s, self%mu_k, rate, slip)
        new = law_state(mu=self%mu_k + excess, r=0.0_wp)
        d_pressure = new%mu
        resistance = new%mu * pressure
        d_slip = -rate * excess * pressure
    end subroutine slide

    !> Newton's method from the right, where a concave equation lets it fall on the root without
    !> fail.
    pure subroutine solve(self, trial, stiffness, pressure, dt, old, answer, solved)
        class(static_kinetic_law), intent(in) :: self
        real(wp), intent(in) :: trial, stiffness, pressure, dt
        type(law_state), intent(in) :: old
        type(sliding), intent(out) :: answer
        logical, intent(out) :: solved
        integer, parameter :: max_iterations = 100
        real(wp) :: step, fall
        integer :: iteration

        solved = .false.
        answer%slip = (trial - self%mu_k * pressure) / stiffness
        do iteration = 1, max_iterations
            call self%slide(answer%slip, pressure, dt, old, answer%state, answer%resistance, &
                answer%d_slip, answer%d_pressure)
            fall = stiffness + answer%d_slip
            if (.not. fall > 0.0_wp) return
            step = (trial - stiffness * answer%slip - answer%resistance) / fall
            solved = -step <= 4.0_wp * epsilon(step) * answer%slip
            if (solved) return
            answer%slip = answer%slip + step
        end do
    end subroutine solve

    !> The resistance falls as soon as the surface slides, and with it the traction on the spring,
    !> at once: where the law weakens at all, slip starts with a jump.
    pure subroutine slip_rate(self, state, load, rate, jumps)
        class(static_kinetic_law), intent(in) :: self
        type(law_state), intent(in) :: state
        type(load_rates), intent(in) :: load
        real(wp), intent(out) :: rate
        logical, intent(out) :: jumps

        jumps = .false.
        rate = 0.0_wp
        if (below(load, self%mu_s * load%pressure)) return
        rate = (load%loading - self%mu_s * load%pressure_rate) / load%stiffness
        if (.not. load%sliding) rate = max(0.0_wp, rate)
        jumps = rate > 0.0_wp .and. self%d_c * (self%mu_s - self%mu_k) * load%pressure > 0.0_wp
    end subroutine slip_rate

    pure function state_rates(self, state, load, slip_rate) result(rates)
        class(static_kinetic_law), intent(in) :: self
        type(law_state), intent(in) :: state
        type(load_rates), intent(in) :: load
        real(wp), intent(in) :: slip_rate
        type(law_state) :: rates

        rates = law_state(mu=0.0_wp, r=0.0_wp)
    end function state_rates

    pure subroutine resistance_at(self, state, rate, pressure, resistance, by_rate)
        class(static_kinetic_law), intent(in) :: self
        type(law_state), intent(in) :: state
        real(wp), intent(in) :: rate, pressure
        real(wp), intent(out) :: resistance, by_rate
        real(wp) :: excess

        excess = (self%mu_s - self%mu_k) * exp(-self%d_c * rate) * pressure
        resistance = self%mu_k * pressure + excess
        by_rate = -self%d_c * excess
    end subroutine resistance_at

    pure function traits(self)
        class(static_kinetic_law), intent(in) :: self
        type(law_traits) :: traits

        traits = law_traits(onset=onset_yields)
        if (self%d_c * (self%mu_s - self%mu_k) > 0.0_wp) traits%onset = onset_drops
    end function traits

end module friction_static_kinetic_law
