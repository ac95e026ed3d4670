!> The subloading law integrated exactly for a constant slip rate in the increment (docs/theory.md,
!> section 8), hence second order where the slip rate varies:
!>
!>     mu(s) = mu_k + (mu_n - mu_k) exp(-x) + xi dt (mu_s - mu_k) phi(x),   x = kappa s + xi dt
!>     R(s)  : E1(-ln R) = E1(-ln R_n) + m s
!>
!> with phi(x) = (1 - exp(-x))/x and the exponential integral E1. Every sum is one of positive
!> terms: nothing cancels, neither at R = 0 nor at R = 1. `y = -ln R` travels beside R.
module friction_subloading_exact_law
    use friction_exponential_integral, only : e1, inverse_e1
    use friction_kinds, only : wp
    use friction_law, only : law_state, least_ratio, sliding
    use friction_subloading_exact_core, only : exact_coefficient, exact_fall, mean_of_decay, &
        tilt_of_decay
    use friction_subloading_law, only : subloading_law
    implicit none
    private

    public :: subloading_exact_law

    type, extends(subloading_law) :: subloading_exact_law
    contains
        procedure :: order
        procedure :: start_rate
        procedure :: rest
        procedure :: slide
        procedure :: fall_of_mu
        procedure :: solve
    end type subloading_exact_law

contains

    pure function order(self)
        class(subloading_exact_law), intent(in) :: self
        integer :: order

        order = 2
    end function order

    !> The flow of R depends on R alone, so that dR/dR_n = ln R/ln R_n. Next to 1 the R after the
    !> slip has not the digits of its logarithm; at 1 the quotient is its limit.
    pure function start_rate(self, pressure, start, slid) result(rate)
        class(subloading_exact_law), intent(in) :: self
        real(wp), intent(in) :: pressure
        type(law_state), intent(in) :: start
        type(sliding), intent(in) :: slid
        real(wp) :: rate
        real(wp) :: r, y

        rate = 0.0_wp
        if (.not. start%r > 0.0_wp) return
        if (start%r < 1.0_wp) then
            call similarity_ratio(start%r, self%m * slid%slip, r, y)
            rate = y / (-log(start%r))
        else
            rate = exp(-self%m * slid%slip)
        end if
        rate = rate * (slid%state%mu * pressure + self%cohesion)
    end function start_rate

    pure subroutine rest(self, traction, pressure, dt, old, new, strength)
        class(subloading_exact_law), intent(in) :: self
        real(wp), intent(in) :: traction, pressure, dt
        type(law_state), intent(in) :: old
        type(law_state), intent(out) :: new
        real(wp), intent(out) :: strength
        real(wp) :: full, fall

        call friction_coefficient(self, 0.0_wp, dt, old, new%mu, fall)
        full = new%mu * pressure + self%cohesion
        strength = max(old%r, least_ratio) * full
        new%r = 0.0_wp
        if (full > 0.0_wp) new%r = traction / max(full, traction)
    end subroutine rest

    pure subroutine slide(self, slip, pressure, dt, old, new, resistance, d_slip, d_pressure)
        class(subloading_exact_law), intent(in) :: self
        real(wp), intent(in) :: slip, pressure, dt
        type(law_state), intent(in) :: old
        type(law_state), intent(out) :: new
        real(wp), intent(out) :: resistance, d_slip, d_pressure
        real(wp) :: fall, y

        call friction_coefficient(self, slip, dt, old, new%mu, fall)
        call similarity_ratio(old%r, self%m * slip, new%r, y)
        d_pressure = new%r * new%mu
        resistance = d_pressure * pressure + new%r * self%cohesion
        d_slip = (new%mu * pressure + self%cohesion) * self%m * y - pressure * new%r * fall
    end subroutine slide

    pure function fall_of_mu(self, slip, dt, old) result(fall)
        class(subloading_exact_law), intent(in) :: self
        real(wp), intent(in) :: slip, dt
        type(law_state), intent(in) :: old
        real(wp) :: fall
        real(wp) :: mu

        call friction_coefficient(self, slip, dt, old, mu, fall)
    end function fall_of_mu

    !> The pair (s, ln y) by Newton's method; three or four iterations as a rule.
    pure subroutine solve(self, trial, stiffness, pressure, dt, old, answer, solved)
        class(subloading_exact_law), intent(in) :: self
        real(wp), intent(in) :: trial, stiffness, pressure, dt
        type(law_state), intent(in) :: old
        type(sliding), intent(out) :: answer
        logical, intent(out) :: solved
        integer, parameter :: max_iterations = 15
        real(wp), parameter :: small_step = 1.0e-8_wp   ! the next error is its square
        real(wp), parameter :: y_largest = 200.0_wp     ! far from where exp(y) overflows
        real(wp), parameter :: steepest = 10.0_wp       ! for the start, where -ln R has no bound
        real(wp), parameter :: too_large = 2.0_wp**400  ! for its squares
        real(wp) :: v_n, rate, mu, full, fall, s, r, y, lag, d, ds, dz
        integer :: iteration

        solved = .false.
        call friction_coefficient(self, 0.0_wp, dt, old, mu, fall)
        if (stiffness <= pressure * fall) return   ! several equilibria possible
        full = mu * pressure + self%cohesion
        if (self%m * (full + trial) > too_large .or. .not. trial > old%r * full) return
        v_n = 0.0_wp
        rate = self%m * steepest
        if (old%r >= 1.0_wp) then
            rate = self%m
        else if (old%r > 0.0_wp) then
            y = -log(old%r)
            v_n = e1(y)
            rate = self%m * min(y / (1.0_wp - old%r), steepest)
        end if
        call start(rate, old%r, full, trial - old%r * full, stiffness, s, y)
        if (.not. s > 0.0_wp) return

        do iteration = 1, max_iterations
            if (y > y_largest) return
            r = exp(-y)
            call friction_coefficient(self, s, dt, old, mu, fall)
            lag = 0.0_wp
            if (y > 0.0_wp) lag = e1(y) - (v_n + self%m * s)
            full = mu * pressure + self%cohesion
            d = stiffness + (full * self%m * y - pressure * r * fall)
            ds = (trial - stiffness * s - full * (r - y * lag)) / d
            dz = 0.0_wp
            if (y > 0.0_wp) dz = (lag - self%m * ds) / r
            solved = self%kappa * abs(ds) <= small_step .and. stiffness * abs(ds) &
                <= small_step * trial .and. max(1.0_wp, y) * abs(dz) <= small_step
            if (solved) exit
            s = max(s + ds, 0.05_wp * s)
            if (y < 1.0_wp) then
                y = y * exp(min(dz, 3.0_wp))
            else
                y = y - log(max(1.0_wp - y * dz, 0.05_wp))
            end if
        end do
        if (.not. solved) return

        call conclude(self, s + ds, y + y * dz, pressure, dt, old, answer)
        solved = answer%slip > 0.0_wp
    end subroutine solve

    !> What a slip and an R mean.
    pure subroutine conclude(self, s, y, pressure, dt, old, answer)
        class(subloading_exact_law), intent(in) :: self
        real(wp), intent(in) :: s, y           !! slip [L] and -ln R
        real(wp), intent(in) :: pressure, dt   !! [F/L^2], [T]
        type(law_state), intent(in) :: old
        type(sliding), intent(out) :: answer
        real(wp) :: full, fall

        answer%slip = s
        answer%state%r = exp(-y)
        call friction_coefficient(self, s, dt, old, answer%state%mu, fall)
        answer%d_pressure = answer%state%r * answer%state%mu
        full = answer%state%mu * pressure + self%cohesion
        answer%resistance = answer%state%r * full
        answer%d_slip = full * self%m * y - pressure * answer%state%r * fall
    end subroutine conclude

    !> A start for any slip: with `R' = rate (1 - R)` and mu as at the beginning, backward Euler's
    !> step ends at the root of a quadratic. The positive root, taken where nothing cancels.
    pure subroutine start(rate, r_n, full, excess, stiffness, s, y)
        real(wp), intent(in) :: rate        !! R'/(1 - R) at R_n [1/L]
        real(wp), intent(in) :: r_n         !! R at the start of the increment [-]
        real(wp), intent(in) :: full        !! traction of the normal sliding surface [F/L^2]
        real(wp), intent(in) :: excess      !! trial traction beyond the strength [F/L^2]
        real(wp), intent(in) :: stiffness   !! tangential stiffness [F/L^3]
        real(wp), intent(out) :: s, y       !! slip [L] and -ln R
        real(wp), parameter :: small = 0.1_wp
        real(wp) :: e_n, b, root, e

        e_n = 1.0_wp - r_n
        b = 0.5_wp * (stiffness + rate * (e_n * full - excess))
        root = sqrt(b**2 + stiffness * rate * excess)
        if (b > 0.0_wp) then
            s = excess / (b + root)
        else
            s = (root - b) / (stiffness * rate)
        end if
        e = e_n / (1.0_wp + rate * s)
        if (e > small) then
            y = -log(max((r_n + rate * s) / (1.0_wp + rate * s), tiny(r_n)))
        else
            y = e * (1.0_wp + e * (0.5_wp + e / 3.0_wp))
        end if
    end subroutine start

    !> mu after the slip s, and -d(mu)/ds, which is never negative and shrinks with s.
    pure subroutine friction_coefficient(self, s, dt, old, mu, fall)
        class(subloading_exact_law), intent(in) :: self
        real(wp), intent(in) :: s             !! slip, >= 0 [L]
        real(wp), intent(in) :: dt            !! increment of time, >= 0 [T]
        type(law_state), intent(in) :: old    !! state at the start of the increment
        real(wp), intent(out) :: mu           !! within its bounds in spite of round-off [-]
        real(wp), intent(out) :: fall         !! -d(mu)/ds [1/L]
        real(wp) :: x, healing, decay, mean, tilt

        x = self%kappa * s + self%xi * dt
        healing = self%xi * dt
        call decay_means(x, decay, mean, tilt)
        mu = exact_coefficient(old%mu, self%mu_s, self%mu_k, healing, decay, mean)
        fall = self%kappa * exact_fall(old%mu, self%mu_s, self%mu_k, healing, decay, tilt)
    end subroutine friction_coefficient

    !> exp(-x) and the means over 0 < t < 1 of exp(-x t) and of t exp(-x t): (1 - exp(-x))/x, and
    !> minus its derivative, from a series where they would cancel.
    pure subroutine decay_means(x, decay, mean, tilt)
        real(wp), intent(in) :: x                     !! >= 0
        real(wp), intent(out) :: decay, mean, tilt
        real(wp), parameter :: x_series = 0.5_wp

        decay = 0.0_wp
        if (x > x_series) decay = exp(-x)
        tilt = tilt_of_decay(x, decay)
        mean = mean_of_decay(x, tilt)
        if (x <= x_series) decay = 1.0_wp - x * mean
    end subroutine decay_means

    !> R after the slip `m s`.
    pure subroutine similarity_ratio(r_n, ms, r, y)
        real(wp), intent(in) :: r_n   !! R at the start of the increment, 0 to 1 [-]
        real(wp), intent(in) :: ms    !! m times the slip, >= 0 [-]
        real(wp), intent(out) :: r    !! R at its end [-]
        real(wp), intent(out) :: y    !! -ln R; 0 for R = 0, which only a contact that has not slid
                                      !! can have
        real(wp) :: v

        r = r_n
        y = 0.0_wp
        if (r_n > 0.0_wp) y = -log(r_n)
        if (r_n >= 1.0_wp .or. .not. ms > 0.0_wp) return
        v = ms
        if (r_n > 0.0_wp) v = e1(y) + ms
        y = inverse_e1(v)
        r = max(exp(-y), r_n)
    end subroutine similarity_ratio

end module friction_subloading_exact_law
