!> Linear slip-weakening friction that heals: what slip has weakened grows strong again with time,
!>
!>     resistance = mu(D) p,   mu(D) = mu_s - (mu_s - mu_k) D/d_c,   D_dot = v - xi D,   D <= d_c
!>
!> with the slip D that the surface remembers as internal variable. It forgets slip at the rate xi
!> (Shaw 1995), at rest, while it slides, and when open. D stops growing at d_c, where friction is
!> kinetic: so it heals from the moment at which it comes to rest, however far it has slid.
!>
!> Integrated exactly for a constant slip rate in the increment, with y = xi dt:
!>
!>     D = min(D_n e^-y + slip (1 - e^-y)/y, d_c)
!>
!> As without healing, the resistance is two straight lines over the slip, and convex: one root.
module friction_slip_weakening_healing_law
    use friction_kinds, only : wp
    use friction_law, only : below, law_description, law_state, load_rates, sliding
    use friction_law_constants, only : constant_table, law_constant, no_constants
    use friction_rate_state_core, only : mean_decay
    use friction_slip_weakening_core, only : coefficient_at, fall_at, forgotten, remembered, &
        slip_to_balance
    use friction_slip_weakening_law, only : slip_variable, slip_weakening_constants, &
        slip_weakening_law
    use friction_status, only : friction_bad_property, friction_bad_size, friction_ok
    implicit none
    private

    public :: slip_weakening_healing_law

    type, extends(slip_weakening_law) :: slip_weakening_healing_law
        real(wp) :: xi   !! healing rate, >= 0 [1/T]
    contains
        procedure :: read => read_constants
        procedure :: healing_rate
        procedure :: rest
        procedure :: slide
        procedure :: solve
        procedure :: slip_rate
        procedure :: state_rates
    end type slip_weakening_healing_law

    !> Its own constants; in `props` they stand from place 4 on.
    type(law_constant), parameter :: table(4) = [slip_weakening_constants, &
        law_constant('xi', '1/T', 'healing rate: how fast D falls with time', 'HealingRate', &
        lower=0.0_wp)]

    type(law_description), parameter, public :: healing_description = &
        law_description(name='slip_weakening_healing', &
        summary='Friction that falls with slip, from mu_s to mu_k, and recovers with time', &
        constants=constant_table(size(table), [table, no_constants(size(table) + 1:)]), &
        internal=slip_variable)

    !> An increment of time as the law sees it.
    type :: healing
        real(wp) :: d_left     !! what is left of D without slip [L]
        real(wp) :: by_slip    !! D gained by a unit of slip [-]
    end type healing

contains

    pure subroutine read_constants(self, n, constants, n_own, status)
        class(slip_weakening_healing_law), intent(inout) :: self
        integer, intent(in) :: n
        real(wp), intent(in) :: constants(n)
        integer, intent(out) :: n_own, status

        call self%slip_weakening_law%read(n, constants, n_own, status)
        n_own = size(table)
        if (status < 0) return
        status = friction_bad_size
        if (n < size(table)) return
        status = friction_bad_property
        if (constants(4) < table(4)%lower) return
        self%xi = constants(4)
        status = friction_ok
    end subroutine read_constants

    !> At rest the coefficient tends to mu_s at the rate xi.
    pure function healing_rate(self, state) result(rate)
        class(slip_weakening_healing_law), intent(in) :: self
        type(law_state), intent(in) :: state
        real(wp) :: rate

        rate = self%xi * (self%mu_s - coefficient_at(state%r, self%mu_s, self%mu_k, self%d_c))
    end function healing_rate

    pure subroutine rest(self, traction, pressure, dt, old, new, strength)
        class(slip_weakening_healing_law), intent(in) :: self
        real(wp), intent(in) :: traction, pressure, dt
        type(law_state), intent(in) :: old
        type(law_state), intent(out) :: new
        real(wp), intent(out) :: strength
        type(healing) :: heals

        heals = healing_of(self, dt, old%r)
        new%r = heals%d_left
        new%mu = coefficient_at(new%r, self%mu_s, self%mu_k, self%d_c)
        strength = new%mu * pressure
    end subroutine rest

    !> Where the fall ends, the derivative is that of the end.
    pure subroutine slide(self, slip, pressure, dt, old, new, resistance, d_slip, d_pressure)
        class(slip_weakening_healing_law), intent(in) :: self
        real(wp), intent(in) :: slip, pressure, dt
        type(law_state), intent(in) :: old
        type(law_state), intent(out) :: new
        real(wp), intent(out) :: resistance, d_slip, d_pressure
        type(healing) :: heals

        heals = healing_of(self, dt, old%r)
        new%r = remembered(heals%d_left, heals%by_slip, slip, self%d_c)
        new%mu = coefficient_at(new%r, self%mu_s, self%mu_k, self%d_c)
        d_pressure = new%mu
        resistance = new%mu * pressure
        d_slip = -heals%by_slip * fall_at(new%r, (self%mu_s - self%mu_k) * pressure, self%d_c)
    end subroutine slide

    !> Two straight lines, the lower of which counts.
    pure subroutine solve(self, trial, stiffness, pressure, dt, old, answer, solved)
        class(slip_weakening_healing_law), intent(in) :: self
        real(wp), intent(in) :: trial, stiffness, pressure, dt
        type(law_state), intent(in) :: old
        type(sliding), intent(out) :: answer
        logical, intent(out) :: solved
        type(healing) :: heals
        real(wp) :: mu, softening

        heals = healing_of(self, dt, old%r)
        mu = coefficient_at(heals%d_left, self%mu_s, self%mu_k, self%d_c)
        softening = fall_at(heals%d_left, (self%mu_s - self%mu_k) * pressure, self%d_c)
        answer%slip = slip_to_balance(trial - mu * pressure, trial - self%mu_k * pressure, &
            stiffness, heals%by_slip * softening)
        call self%slide(answer%slip, pressure, dt, old, answer%state, answer%resistance, &
            answer%d_slip, answer%d_pressure)
        solved = .true.
    end subroutine solve

    !> Weak, the surface stays so as long as it slides faster than it heals; else D moves.
    pure subroutine slip_rate(self, state, load, rate, jumps)
        class(slip_weakening_healing_law), intent(in) :: self
        type(law_state), intent(in) :: state
        type(load_rates), intent(in) :: load
        real(wp), intent(out) :: rate
        logical, intent(out) :: jumps
        real(wp) :: mu, d, slope, softening

        jumps = .false.
        rate = 0.0_wp
        d = min(state%r, self%d_c)
        mu = coefficient_at(d, self%mu_s, self%mu_k, self%d_c)
        if (below(load, mu * load%pressure)) return
        rate = load%loading - mu * load%pressure_rate
        if (d >= self%d_c .and. rate >= load%stiffness * self%xi * d) then
            rate = rate / load%stiffness
            return
        end if
        softening = (self%mu_s - self%mu_k) * load%pressure / self%d_c
        rate = rate - softening * self%xi * d
        if (.not. load%sliding) rate = max(0.0_wp, rate)
        slope = load%stiffness - softening
        jumps = rate > 0.0_wp .and. slope <= 0.0_wp
        rate = rate / merge(slope, load%stiffness, slope > 0.0_wp)
    end subroutine slip_rate

    pure function state_rates(self, state, load, slip_rate) result(rates)
        class(slip_weakening_healing_law), intent(in) :: self
        type(law_state), intent(in) :: state
        type(load_rates), intent(in) :: load
        real(wp), intent(in) :: slip_rate
        type(law_state) :: rates

        rates%r = slip_rate - self%xi * min(state%r, self%d_c)
        if (state%r >= self%d_c) rates%r = min(rates%r, 0.0_wp)
        rates%mu = -(self%mu_s - self%mu_k) / self%d_c * rates%r
    end function state_rates

    !> What time does to D.
    pure function healing_of(self, dt, d) result(heals)
        class(slip_weakening_healing_law), intent(in) :: self
        real(wp), intent(in) :: dt   !! increment of time, >= 0 [T]
        real(wp), intent(in) :: d    !! at its start, >= 0 [L]
        type(healing) :: heals
        real(wp) :: y, left

        y = self%xi * dt
        left = exp(-y)
        heals%d_left = forgotten(d, self%d_c, left)
        heals%by_slip = mean_decay(y, left)
    end function healing_of

end module friction_slip_weakening_healing_law
