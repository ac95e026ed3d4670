!> Time-dependent elastoplastic friction with a subloading surface (docs/theory.md, section 1):
!>
!>     resistance = R (mu p + cohesion)
!>     mu_dot = -kappa (mu - mu_k) |v_p| + xi (mu_s - mu)
!>     R_dot = -m ln(R) |v_p|
!>
!> integrated by backward Euler over an increment with the slip s (section 3):
!>
!>     mu(s) = mu_k + c/w,  w = 1 + kappa s + xi dt,  c = mu_n - mu_k + xi dt (mu_s - mu_k)
!>     R(s)  : the root in [R_n, 1] of  R - R_n + m s ln R = 0
!>
!> Near R = 1 the difference 1 - R is the number that carries the information, so both travel: `r`
!> and `e = 1 - r`.
module friction_subloading_law
    use friction_kinds, only : wp
    use friction_law, only : internal_variable, law_description, law_state, law_traits, &
        least_ratio, load_rates, named_law, onset_gradual, sliding, unbounded
    use friction_law_constants, only : complete_constants, constant_table, law_constant, &
        no_constants, positive
    use friction_status, only : friction_bad_property, friction_bad_size, friction_ok
    implicit none
    private

    public :: subloading_law

    !> Time integration: values of the constant `scheme`.
    integer, parameter, public :: scheme_backward_euler = 0   !! as the law's authors chose
    integer, parameter, public :: scheme_exact_rate = 1   !! exact for a constant slip rate: module
                                                          !! friction_subloading_exact_law

    !> Evolution of R: values of the constant `u_of_r`.
    integer, parameter, public :: u_logarithm = 0
    integer, parameter, public :: u_cotangent = 1    !! module friction_subloading_general_law
    integer, parameter, public :: u_reciprocal = 2   !! likewise

    type, extends(named_law) :: subloading_law
        real(wp) :: mu_s    !! static friction coefficient, >= mu_k [-]
        real(wp) :: mu_k    !! kinetic friction coefficient, >= 0 [-]
        real(wp) :: kappa   !! adhesion-breaking exponent, >= 0 [1/L]
        real(wp) :: xi      !! adhesion-forming exponent, >= 0 [1/T]
        real(wp) :: m       !! rate at which R approaches 1, > 0 [1/L]
        real(wp) :: mu_0    !! friction coefficient of a virgin point, mu_k to mu_s [-]
        integer :: scheme   !! of time integration, one of those below
        integer :: u_of_r   !! which function U of R, one of those below
    contains
        procedure :: read => read_constants
        procedure, nopass :: mobilises_cohesion
        procedure :: typical_coefficient
        procedure :: kinetic_coefficient
        procedure :: healing_rate
        procedure :: virgin
        procedure :: admits
        procedure :: rest
        procedure :: slide
        procedure :: slip_rate
        procedure :: state_rates
        procedure :: traits
        procedure :: u_of
        procedure :: slopes
        procedure :: steepest_fall
        procedure :: fall_of_mu
        procedure :: solve
    end type subloading_law

    !> Its own constants; in `props` they stand from place 4 on.
    type(law_constant), parameter :: table(8) = [ &
        law_constant('mu_s', '-', 'static friction coefficient', 'StaticFriction', &
        lower=0.0_wp, not_below=2), &
        law_constant('mu_k', '-', 'kinetic friction coefficient', 'KineticFriction', &
        lower=0.0_wp), &
        law_constant('kappa', '1/L', 'loss of friction with slip', 'AdhesionBreakingExponent', &
        lower=0.0_wp), &
        law_constant('xi', '1/T', 'recovery of friction with time', 'AdhesionFormingExponent', &
        lower=0.0_wp), &
        law_constant('m', '1/L', 'rate at which R approaches 1', 'SubloadingExponent', &
        lower=positive), &
        law_constant('mu_0', '-', 'friction coefficient of a virgin point', 'InitialFriction', &
        lower=0.0_wp, &
        not_below=2, not_above=1, optional=.true., default_from=1), &
        law_constant('scheme', '-', 'time integration', 'TimeIntegration', &
        lower=0.0_wp, upper=1.0_wp, &
        optional=.true., whole=.true., words='backward_euler exact_rate'), &
        law_constant('u_of_r', '-', 'evolution of R', 'SubloadingEvolution', &
        lower=0.0_wp, upper=2.0_wp, not_beside=7, &
        optional=.true., whole=.true., words='logarithm cotangent reciprocal')]

    type(law_description), parameter, public :: subloading_description = law_description( &
        name='subloading', &
        summary='Time-dependent elastoplastic friction with a subloading surface', &
        constants=constant_table(size(table), [table, no_constants(size(table) + 1:)]), &
        internal=internal_variable('R', '-', exists=.true.))

    !> The next error of a third-order iteration is the cube of a step this small, that of Newton's
    !> method its square: round-off either way.
    real(wp), parameter :: small_step = 1.0e-5_wp, small_newton_step = 1.0e-8_wp

    integer, parameter :: n_needed = 5   !! of them; the others have defaults

    !> What a slide starts from.
    type :: slide_start
        real(wp) :: c, w0       !! c and w(0) of section 3 [-]
        real(wp) :: fall        !! of the strength with slip, by that of mu [F/L^3]
        real(wp) :: healing     !! 1/w(0) of section 3 [-]
        real(wp) :: excess      !! trial traction beyond the strength [F/L^2]
        real(wp) :: full        !! traction of the normal sliding surface [F/L^2]
        real(wp) :: stiffness   !! tangential stiffness [F/L^3]
        real(wp) :: r           !! R [-]
    end type slide_start

contains

    pure subroutine read_constants(self, n, constants, n_own, status)
        class(subloading_law), intent(inout) :: self
        integer, intent(in) :: n
        real(wp), intent(in) :: constants(n)
        integer, intent(out) :: n_own, status
        real(wp) :: c(size(table))

        n_own = size(table)
        status = friction_bad_size
        if (n < n_needed) return
        status = friction_bad_property
        if (any(constants(:n_needed) < table(:n_needed)%lower)) return
        if (constants(1) < constants(table(1)%not_below)) return
        self%mu_s = constants(1)
        self%mu_k = constants(2)
        self%kappa = constants(3)
        self%xi = constants(4)
        self%m = constants(5)
        self%mu_0 = constants(table(6)%default_from)
        self%scheme = int(table(7)%default)
        self%u_of_r = int(table(8)%default)
        status = friction_ok
        if (n == n_needed) return
        call complete_constants(n_needed, table, n, constants, c, status)
        if (status /= friction_ok) return
        self%mu_0 = c(6)
        self%scheme = int(c(7))
        self%u_of_r = int(c(8))
    end subroutine read_constants

    pure function typical_coefficient(self) result(mu)
        class(subloading_law), intent(in) :: self
        real(wp) :: mu

        mu = self%mu_s
    end function typical_coefficient

    !> As much of it as of the friction, R.
    pure function mobilises_cohesion() result(mobilises)
        logical :: mobilises

        mobilises = .true.
    end function mobilises_cohesion

    pure function kinetic_coefficient(self) result(mu)
        class(subloading_law), intent(in) :: self
        real(wp) :: mu

        mu = self%mu_k
    end function kinetic_coefficient

    pure function healing_rate(self, state) result(rate)
        class(subloading_law), intent(in) :: self
        type(law_state), intent(in) :: state
        real(wp) :: rate

        rate = self%xi * (self%mu_s - state%mu)
    end function healing_rate

    pure function virgin(self) result(state)
        class(subloading_law), intent(in) :: self
        type(law_state) :: state

        state = law_state(mu=self%mu_0, r=0.0_wp)
    end function virgin

    pure function admits(self, state) result(valid)
        class(subloading_law), intent(in) :: self
        type(law_state), intent(in) :: state
        logical :: valid

        valid = state%mu >= self%mu_k .and. state%mu <= self%mu_s .and. state%r >= 0.0_wp &
            .and. state%r <= 1.0_wp
    end function admits

    !> Adhesion recovers at rest; R follows the elastic traction (paper's eqs 12 and 16).
    pure subroutine rest(self, traction, pressure, dt, old, new, strength)
        class(subloading_law), intent(in) :: self
        real(wp), intent(in) :: traction, pressure, dt
        type(law_state), intent(in) :: old
        type(law_state), intent(out) :: new
        real(wp), intent(out) :: strength
        real(wp) :: full

        new%mu = friction_coefficient(self, 1.0_wp + self%xi * dt, weakening_reserve(self, dt, old))
        full = new%mu * pressure + self%cohesion
        strength = max(old%r, least_ratio) * full
        new%r = 0.0_wp
        if (full > 0.0_wp) new%r = traction / max(full, traction)
    end subroutine rest

    pure subroutine slide(self, slip, pressure, dt, old, new, resistance, d_slip, d_pressure)
        class(subloading_law), intent(in) :: self
        real(wp), intent(in) :: slip, pressure, dt
        type(law_state), intent(in) :: old
        type(law_state), intent(out) :: new
        real(wp), intent(out) :: resistance, d_slip, d_pressure
        real(wp) :: c, w, log_r

        c = weakening_reserve(self, dt, old)
        w = 1.0_wp + self%xi * dt + self%kappa * slip
        new%mu = friction_coefficient(self, w, c)
        call similarity_ratio(old%r, self%m * slip, new%r, log_r)
        d_pressure = new%r * new%mu
        resistance = d_pressure * pressure + new%r * self%cohesion
        d_slip = 0.0_wp
        if (new%r > 0.0_wp) d_slip = (new%mu * pressure + self%cohesion) * ratio_rate(self%m, &
            slip, new%r, log_r) - pressure * new%r * (self%kappa / w) * (c / w)
    end subroutine slide

    !> The slope is (mu p + cohesion) dR/ds - p R fall, with R rising ever slower and mu falling
    !> ever slower: the first product only shrinks, and of the second the worst of each factor
    !> stands at one end.
    pure subroutine slopes(self, first, last, pressure, dt, old, least, most)
        class(subloading_law), intent(in) :: self
        type(sliding), intent(in) :: first, last
        real(wp), intent(in) :: pressure, dt
        type(law_state), intent(in) :: old
        real(wp), intent(out) :: least, most
        real(wp), parameter :: steep = 1.0e-30_wp   ! below, R may rise at any rate
        real(wp) :: fall_first, fall_last

        fall_first = pressure * self%fall_of_mu(first%slip, dt, old)
        fall_last = pressure * self%fall_of_mu(last%slip, dt, old)
        least = last%d_slip - last%state%r * (fall_first - fall_last)
        most = unbounded
        if (first%state%r > steep) most = first%d_slip + first%state%r * (fall_first - fall_last)
    end subroutine slopes

    !> R only rises, and mu falls fastest at first.
    pure function steepest_fall(self, pressure, dt, old) result(fall)
        class(subloading_law), intent(in) :: self
        real(wp), intent(in) :: pressure, dt
        type(law_state), intent(in) :: old
        real(wp) :: fall

        fall = pressure * self%fall_of_mu(0.0_wp, dt, old)
    end function steepest_fall

    !> -d(mu)/ds, which is never negative and shrinks with the slip.
    pure function fall_of_mu(self, slip, dt, old) result(fall)
        class(subloading_law), intent(in) :: self
        real(wp), intent(in) :: slip          !! in the increment, >= 0 [L]
        real(wp), intent(in) :: dt            !! increment of time, >= 0 [T]
        type(law_state), intent(in) :: old    !! state at the start of the increment
        real(wp) :: fall                      !! [1/L]
        real(wp) :: w

        w = 1.0_wp + self%xi * dt + self%kappa * slip
        fall = (self%kappa / w) * (weakening_reserve(self, dt, old) / w)
    end function fall_of_mu

    !> The pair (s, R) by Chebyshev's method, Newton's third-order kin: one logarithm an iteration,
    !> one or two iterations as a rule after either of two starts (docs/theory.md, section 3).
    pure subroutine solve(self, trial, stiffness, pressure, dt, old, answer, solved)
        class(subloading_law), intent(in) :: self
        real(wp), intent(in) :: trial, stiffness, pressure, dt
        type(law_state), intent(in) :: old
        type(sliding), intent(out) :: answer
        logical, intent(out) :: solved
        integer, parameter :: max_iterations = 12
        type(slide_start) :: start
        real(wp) :: c, w0, full, s, r, e, iw, mu, mu_rate, log_r, r_rate, ms, gain, slack, misfit, &
            ir, z, d, ds, dr, bend_s, bend_r
        integer :: iteration

        call prepare(self, trial, stiffness, pressure, dt, old, start, solved)
        if (.not. solved) return
        c = start%c
        w0 = start%w0
        call start_near(self, start, s, r, e, solved)
        if (.not. solved) call start_far(self, start, s, r, e)
        solved = .false.
        if (.not. r > 0.0_wp) return

        do iteration = 1, max_iterations
            iw = 1.0_wp / (w0 + self%kappa * s)
            mu = self%mu_k + c * iw
            mu_rate = -self%kappa * c * iw**2
            ms = self%m * s
            gain = 1.0_wp / (r + ms)
            ir = 1.0_wp / r
            slack = (1.0_wp - r) - e
            log_r = log(r) + slack
            r_rate = -self%m * log_r * r * gain
            misfit = ((r - old%r) + slack + ms * log_r) * r * gain
            ! Newton's step ...
            full = pressure * mu + self%cohesion
            d = 1.0_wp / (stiffness + (pressure * r * mu_rate + full * r_rate))
            ds = (trial - stiffness * s - full * (r - misfit)) * d
            dr = r_rate * ds - misfit
            ! ... and its correction by the second derivatives, where that is one.
            bend_r = gain * dr * (self%m * ds - 0.5_wp * ms * dr * ir)
            bend_s = (full * bend_r - pressure * mu_rate * ds * (dr - self%kappa * iw * r * ds)) * d
            bend_r = r_rate * bend_s - bend_r
            if (abs(bend_s) <= 0.5_wp * abs(ds) .and. abs(bend_r) <= 0.5_wp * abs(dr)) then
                ds = ds + bend_s
                dr = dr + bend_r
            end if
            solved = self%m * abs(ds) <= small_step * (r + ms) &
                .and. self%kappa * abs(ds) * iw <= small_step &
                .and. stiffness * abs(ds) <= small_step * trial &
                .and. abs(dr) <= small_step * min(r, e)
            if (solved) exit
            s = max(s + ds, 0.05_wp * s)
            call move_ratio(dr, r, e)
        end do
        if (.not. solved) return

        ! The last step, too small to need another logarithm.
        z = dr * ir
        log_r = log_r + z * (1.0_wp - z * (0.5_wp - z * (1.0_wp / 3.0_wp)))
        call conclude(self, c, w0, pressure, s + ds, r + dr, log_r, answer)
    end subroutine solve

    !> May Newton's method be used here? Then what it starts from.
    pure subroutine prepare(self, trial, stiffness, pressure, dt, old, start, possible)
        class(subloading_law), intent(in) :: self
        real(wp), intent(in) :: trial, stiffness, pressure, dt   !! as of `solve`
        type(law_state), intent(in) :: old
        type(slide_start), intent(inout) :: start   !! out
        logical, intent(out) :: possible
        real(wp), parameter :: too_large = 2.0_wp**400   ! for its squares

        possible = .false.
        start%c = weakening_reserve(self, dt, old)
        start%w0 = 1.0_wp + self%xi * dt
        start%healing = 1.0_wp / start%w0
        start%fall = self%kappa * (start%c * start%healing)
        if (stiffness * start%w0 <= pressure * start%fall) return   ! several are possible
        start%full = (self%mu_k + start%c * start%healing) * pressure + self%cohesion
        start%excess = trial - old%r * start%full
        if (self%m * (start%full + trial) + self%kappa * start%w0 > too_large) return
        start%fall = start%fall * start%healing * pressure
        start%stiffness = stiffness
        start%r = old%r
        possible = start%excess > 0.0_wp
    end subroutine prepare

    !> What a slip and an R mean.
    pure subroutine conclude(self, c, w0, pressure, s, r, log_r, answer)
        class(subloading_law), intent(in) :: self
        real(wp), intent(in) :: c, w0      !! c and w(0) of section 3 [-]
        real(wp), intent(in) :: pressure   !! contact pressure [F/L^2]
        real(wp), intent(in) :: s          !! slip [L]
        real(wp), intent(in) :: r, log_r   !! R and its logarithm
        type(sliding), intent(out) :: answer
        real(wp) :: iw, mu, full, rate

        iw = 1.0_wp / (w0 + self%kappa * s)
        rate = self%m * log_r / (r + self%m * s)   ! divides meanwhile
        mu = self%mu_k + c * iw
        answer%slip = s
        answer%state%mu = min(max(mu, self%mu_k), self%mu_s)
        answer%state%r = min(r, 1.0_wp)
        answer%d_pressure = r * mu
        full = pressure * mu + self%cohesion
        answer%resistance = r * full
        answer%d_slip = -r * (full * rate + pressure * self%kappa * c * iw**2)
    end subroutine conclude

    !> A start for little slip: two terms of the expansion of (s, R) in the excess traction.
    pure subroutine start_near(self, start, s, r, e, good)
        class(subloading_law), intent(in) :: self
        type(slide_start), intent(in) :: start
        real(wp), intent(out) :: s, r, e    !! slip [L], R and 1 - R
        logical, intent(out) :: good        !! R and w change so little that the expansion holds
        real(wp), parameter :: little = 0.2_wp, least_ratio = 1.0e-3_wp
        real(wp) :: r_n, full, fall, rate, d, dr, bend_s, bend_r

        r_n = start%r
        full = start%full
        fall = start%fall
        s = 0.0_wp
        r = r_n
        e = 1.0_wp - r_n
        ! too much slip, to judge by `-ln R >= 2 (1 - R)/(1 + R)` and before any logarithm?
        good = r_n > least_ratio .and. self%m * start%excess * (1.0_wp + r_n) <= little * r_n &
            * ((start%stiffness - r_n * fall) * (1.0_wp + r_n) + 2.0_wp * self%m * e * full)
        if (.not. good) return
        rate = -self%m * log(r_n)
        d = 1.0_wp / (start%stiffness - r_n * fall + full * rate)
        s = start%excess * d
        dr = rate * s
        bend_r = dr * s * (self%m / r_n)
        bend_s = (fall * s * (dr - self%kappa * start%healing * r_n * s) + full * bend_r) * d
        bend_r = rate * bend_s - bend_r
        good = dr <= little * min(r, e) .and. self%m * s <= little * r_n .and. abs(bend_r) &
            <= little * dr .and. abs(bend_s) <= 0.5_wp * s
        s = s + bend_s
        r = r + (dr + bend_r)
        e = e - (dr + bend_r)
        call pair(r, e)
    end subroutine start_near

    !> A start for any slip: `-ln R ~ rate/m (1 - R)`, right at R_n, and `mu ~ mu(0)` make the
    !> equation a quadratic. Its positive root, taken where nothing cancels.
    pure subroutine start_far(self, start, s, r, e)
        class(subloading_law), intent(in) :: self
        type(slide_start), intent(in) :: start
        real(wp), intent(out) :: s, r, e     !! slip [L], R and 1 - R
        real(wp) :: r_n, e_n, z, rate, b, root, above, below, shrink

        r_n = start%r
        e_n = 1.0_wp - r_n
        z = 3.0_wp * (1.0_wp + r_n)**2 - 1.8_wp * e_n**2
        rate = (2.0_wp * self%m) * (z + e_n**2) / ((1.0_wp + r_n) * z)
        b = 0.5_wp * (start%stiffness + rate * (e_n * start%full - start%excess))
        root = sqrt(b**2 + start%stiffness * rate * start%excess)
        above = root - b
        below = start%stiffness * rate
        if (b > 0.0_wp) then
            above = start%excess
            below = b + root
        end if
        s = above / below
        shrink = 1.0_wp / (below + rate * above)
        r = (r_n * below + rate * above) * shrink
        e = e_n * below * shrink
        call pair(r, e)
    end subroutine start_far

    !> R after the slip `m s` of section 3: Newton's method from the left, where it climbs without
    !> fail because the equation is concave. `log_r` is zero for R = 0, which only a contact that
    !> has not slid can have.
    pure subroutine similarity_ratio(r_n, ms, r, log_r)
        real(wp), intent(in) :: r_n       !! R at the start of the increment [-]
        real(wp), intent(in) :: ms        !! m times the slip, >= 0 [-]
        real(wp), intent(out) :: r        !! R at its end [-]
        real(wp), intent(out) :: log_r    !! ln R
        integer, parameter :: max_iterations = 100
        real(wp) :: e, slack, dr
        integer :: iteration

        r = (r_n + ms) / (1.0_wp + ms)
        e = (1.0_wp - r_n) / (1.0_wp + ms)
        call pair(r, e)
        log_r = 0.0_wp
        if (.not. r > 0.0_wp) return
        do iteration = 1, max_iterations
            slack = (1.0_wp - r) - e
            log_r = log(r) + slack
            dr = -r / (r + ms) * ((r - r_n) + slack + ms * log_r)
            log_r = log_r + dr / r
            call move_ratio(dr, r, e)
            if (abs(dr) <= small_newton_step * min(r, e)) exit
        end do
    end subroutine similarity_ratio

    !> Consistency: the traction stays on the subloading surface, R (mu p + cohesion).
    pure subroutine slip_rate(self, state, load, rate, jumps)
        class(subloading_law), intent(in) :: self
        type(law_state), intent(in) :: state
        type(load_rates), intent(in) :: load
        real(wp), intent(out) :: rate
        logical, intent(out) :: jumps
        real(wp) :: full, slope

        jumps = .false.
        rate = 0.0_wp
        full = state%mu * load%pressure + self%cohesion
        if (full > 0.0_wp .and. .not. (state%r > 0.0_wp .and. load%traction > 0.0_wp)) return
        rate = load%loading - state%r * strength_rate(self, state, load)
        if (.not. load%sliding) rate = max(0.0_wp, rate)
        if (.not. abs(rate) > 0.0_wp) return
        slope = load%stiffness
        if (full > 0.0_wp) slope = slope + full * self%m * self%u_of(state%r) - state%r &
            * load%pressure * self%kappa * (state%mu - self%mu_k)
        jumps = rate > 0.0_wp .and. slope <= 0.0_wp
        rate = rate / merge(slope, load%stiffness, slope > 0.0_wp)
    end subroutine slip_rate

    !> While nothing slips R is the traction's share of mu p + cohesion.
    pure function state_rates(self, state, load, slip_rate) result(rates)
        class(subloading_law), intent(in) :: self
        type(law_state), intent(in) :: state
        type(load_rates), intent(in) :: load
        real(wp), intent(in) :: slip_rate
        type(law_state) :: rates
        real(wp) :: full

        full = state%mu * load%pressure + self%cohesion
        rates%mu = self%xi * (self%mu_s - state%mu) - self%kappa * (state%mu - self%mu_k) &
            * slip_rate
        rates%r = 0.0_wp
        if (slip_rate > 0.0_wp) then
            if (state%r > 0.0_wp) rates%r = self%m * self%u_of(state%r) * slip_rate
        else if (full > 0.0_wp) then
            rates%r = (load%loading - load%traction / full * strength_rate(self, state, load)) &
                / full
        end if
    end function state_rates

    !> R follows from the traction, unless a cap holds that.
    pure function traits(self)
        class(subloading_law), intent(in) :: self
        type(law_traits) :: traits

        traits = law_traits(onset=onset_gradual, memory=1, weight=1.0_wp, &
            slip_scale=1.0_wp / merge(self%kappa, self%m, self%kappa > 0.0_wp), &
            weakening=self%kappa * (self%mu_s - self%mu_k))
    end function traits

    !> U(R), which tells how fast sliding becomes full.
    pure function u_of(self, r) result(u)
        class(subloading_law), intent(in) :: self
        real(wp), intent(in) :: r   !! 0 < R <= 1 [-]
        real(wp) :: u               !! >= 0 [-]

        u = -log(r)
    end function u_of

    !> Rate of mu p where nothing slips.
    pure function strength_rate(self, state, load) result(rate)
        class(subloading_law), intent(in) :: self
        type(law_state), intent(in) :: state
        type(load_rates), intent(in) :: load
        real(wp) :: rate   !! [F/L^2/T]

        rate = self%xi * (self%mu_s - state%mu) * load%pressure + state%mu * load%pressure_rate
    end function strength_rate

    !> The friction coefficient's share that slip can take away, times w: `c` of section 3.
    pure function weakening_reserve(self, dt, old) result(c)
        class(subloading_law), intent(in) :: self
        real(wp), intent(in) :: dt            !! increment of time [T]
        type(law_state), intent(in) :: old    !! state at the start of the increment
        real(wp) :: c                         !! [-]

        c = (old%mu - self%mu_k) + self%xi * dt * (self%mu_s - self%mu_k)
    end function weakening_reserve

    pure function friction_coefficient(self, w, c) result(mu)
        class(subloading_law), intent(in) :: self
        real(wp), intent(in) :: w, c   !! of section 3 [-]
        real(wp) :: mu   !! friction coefficient, within its bounds in spite of round-off [-]

        mu = min(max(self%mu_k + c / w, self%mu_k), self%mu_s)
    end function friction_coefficient

    !> dR/ds of the discrete evolution law.
    pure function ratio_rate(m, s, r, log_r) result(rate)
        real(wp), intent(in) :: m, s, r, log_r
        real(wp) :: rate   !! [1/L]

        rate = -m * log_r * r / (r + m * s)
    end function ratio_rate

    !> A step in R, in whichever of R and 1 - R is the smaller number; neither loses its sign.
    pure subroutine move_ratio(dr, r, e)
        real(wp), intent(in) :: dr
        real(wp), intent(inout) :: r, e

        r = max(r + dr, 0.05_wp * r)
        e = max(e - dr, 0.05_wp * e)
        call pair(r, e)
    end subroutine move_ratio

    !> The larger of R and 1 - R follows from the smaller one, which carries the digits.
    pure subroutine pair(r, e)
        real(wp), intent(inout) :: r, e

        if (r < 0.5_wp) then
            e = 1.0_wp - r
        else
            r = 1.0_wp - e
        end if
    end subroutine pair

end module friction_subloading_law
