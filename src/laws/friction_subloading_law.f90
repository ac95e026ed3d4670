!> Time-dependent elastoplastic friction with a subloading surface (docs/theory.md, section 1):
!>
!>     resistance = R mu p,   mu_dot = -kappa (mu - mu_k) |v_p| + xi (mu_s - mu),   R_dot = -m ln(R)
!> |v_p|
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
    use friction_law, only : law, law_state, sliding
    use friction_status, only : friction_bad_property, friction_bad_size, friction_ok
    implicit none
    private

    public :: subloading_law, read_subloading_law

    type, extends(law) :: subloading_law
        real(wp) :: mu_s = 0.0_wp    !! static friction coefficient, >= mu_k [-]
        real(wp) :: mu_k = 0.0_wp    !! kinetic friction coefficient, >= 0 [-]
        real(wp) :: kappa = 0.0_wp   !! adhesion-breaking exponent, >= 0 [1/L]
        real(wp) :: xi = 0.0_wp      !! adhesion-forming exponent, >= 0 [1/T]
        real(wp) :: m = 0.0_wp       !! rate at which R approaches 1, > 0 [1/L]
        real(wp) :: mu_0 = 0.0_wp    !! friction coefficient of a virgin point, mu_k to mu_s [-]
    contains
        procedure :: virgin
        procedure :: admits
        procedure :: rest
        procedure :: slide
        procedure :: weakening
        procedure :: solve
    end type subloading_law

    !> Newton's next error is the square of a step this small: round-off.
    real(wp), parameter :: small_step = 1.0e-8_wp

contains

    !> The law from its constants `mu_s, mu_k, kappa, xi, m[, mu_0]`.
    pure subroutine read_subloading_law(constants, surface, status)
        real(wp), intent(in) :: constants(:)          !! size 5 or more, finite
        type(subloading_law), intent(out) :: surface  !! the law, if the status is ok
        integer, intent(out) :: status                !! ok, bad size, or bad property

        status = friction_bad_size
        if (size(constants) < 5) return
        surface%mu_s = constants(1)
        surface%mu_k = constants(2)
        surface%kappa = constants(3)
        surface%xi = constants(4)
        surface%m = constants(5)
        surface%mu_0 = surface%mu_s
        if (size(constants) > 5) surface%mu_0 = constants(6)
        status = friction_bad_property
        if (surface%mu_k < 0.0_wp .or. surface%mu_s < surface%mu_k) return
        if (surface%mu_0 < surface%mu_k .or. surface%mu_0 > surface%mu_s) return
        if (surface%kappa < 0.0_wp .or. surface%xi < 0.0_wp .or. surface%m <= 0.0_wp) return
        status = friction_ok
    end subroutine read_subloading_law

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
        full = new%mu * pressure
        strength = old%r * full
        new%r = 0.0_wp
        if (full > 0.0_wp) new%r = min(traction / full, 1.0_wp)
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
        resistance = d_pressure * pressure
        d_slip = 0.0_wp
        if (new%r > 0.0_wp) d_slip = pressure * (new%mu * ratio_rate(self%m, slip, new%r, log_r) &
            - new%r * self%kappa * c / w**2)
    end subroutine slide

    !> With mu falling ever slower and R rising ever slower, the worst of each factor stands at one
    !> end.
    pure function weakening(self, from, to, pressure, dt, old) result(bound)
        class(subloading_law), intent(in) :: self
        real(wp), intent(in) :: from, to, pressure, dt
        type(law_state), intent(in) :: old
        real(wp) :: bound
        real(wp) :: c, w0, r, log_r

        c = weakening_reserve(self, dt, old)
        w0 = 1.0_wp + self%xi * dt
        call similarity_ratio(old%r, self%m * to, r, log_r)
        bound = pressure * (r * self%kappa * c / (w0 + self%kappa * from)**2 &
            - friction_coefficient(self, w0 + self%kappa * to, c) &
            * ratio_rate(self%m, to, r, log_r))
    end function weakening

    !> Newton's method on the pair (s, R), one logarithm an iteration, from the root of the
    !> quadratic that `-ln R ~ 1 - R`, `mu ~ mu(0)` gives (docs/theory.md, section 3).
    pure subroutine solve(self, trial, stiffness, pressure, dt, old, answer, solved)
        class(subloading_law), intent(in) :: self
        real(wp), intent(in) :: trial, stiffness, pressure, dt
        type(law_state), intent(in) :: old
        type(sliding), intent(out) :: answer
        logical, intent(out) :: solved
        integer, parameter :: max_iterations = 12
        real(wp) :: c, w0, iw, mu, mu_rate, s, r, e, log_r, gain, misfit, r_rate, d, ds, de
        integer :: iteration

        solved = .false.
        c = weakening_reserve(self, dt, old)
        w0 = 1.0_wp + self%xi * dt
        if (stiffness <= pressure * self%kappa * c / w0**2) return   ! several equilibria are
                                                                     ! possible

        call start(old%r, friction_coefficient(self, w0, c) * pressure, trial, stiffness, self%m, &
            s, r, e)
        if (.not. r > 0.0_wp) return
        log_r = rough_log(e)
        do iteration = 0, max_iterations
            if (iteration > 0) log_r = log_of_ratio(r, e)
            iw = 1.0_wp / (w0 + self%kappa * s)
            mu = self%mu_k + c * iw
            mu_rate = -self%kappa * c * iw**2
            gain = r / (r + self%m * s)
            misfit = gain * (ratio_gained(old%r, r, e) + self%m * s * log_r)
            r_rate = -gain * self%m * log_r
            d = stiffness + pressure * (r * mu_rate + mu * r_rate)
            ds = (trial - stiffness * s - pressure * mu * (r - misfit)) / d
            de = misfit - r_rate * ds
            solved = iteration > 0 .and. abs(ds) <= small_step * s .and. abs(de) <= small_step &
                * min(r, e)
            if (solved) exit
            call move(old%r, trial / stiffness, ds, de, s, r, e)
        end do
        if (.not. solved) return

        ! The last step, too small to need the bracket or another logarithm.
        s = s + ds
        iw = 1.0_wp / (w0 + self%kappa * s)
        mu = self%mu_k + c * iw
        log_r = log_r - de / r
        r = r - de
        answer%slip = s
        answer%state = law_state(mu=min(max(mu, self%mu_k), self%mu_s), r=min(r, 1.0_wp))
        answer%d_pressure = r * mu
        answer%resistance = answer%d_pressure * pressure
        answer%d_slip = pressure * (mu * ratio_rate(self%m, s, r, log_r) - r * self%kappa * c &
            * iw**2)
    end subroutine solve

    !> First estimate of slip and R: the quadratic's positive root, taken where nothing cancels.
    pure subroutine start(r_n, full, trial, stiffness, m, s, r, e)
        real(wp), intent(in) :: r_n          !! R at the start of the increment [-]
        real(wp), intent(in) :: full         !! traction of the normal sliding surface, mu p [F/L^2]
        real(wp), intent(in) :: trial        !! trial traction [F/L^2]
        real(wp), intent(in) :: stiffness    !! tangential stiffness [F/L^3]
        real(wp), intent(in) :: m            !! rate at which R approaches 1 [1/L]
        real(wp), intent(out) :: s, r, e     !! slip [L], R and 1 - R
        real(wp) :: excess, b, root

        excess = trial - r_n * full
        b = stiffness + m * (full - trial)
        root = abs(b) + sqrt(b**2 + 4.0_wp * stiffness * m * excess)
        if (b > 0.0_wp) then
            s = 2.0_wp * excess / root
        else
            s = 0.5_wp * root / (stiffness * m)
        end if
        s = min(s, trial / stiffness)
        e = (1.0_wp - r_n) / (1.0_wp + m * s)
        r = (r_n + m * s) / (1.0_wp + m * s)
    end subroutine start

    !> One Newton step, kept inside the bracket 0 < s <= s_max, R_n <= R <= 1.
    pure subroutine move(r_n, s_max, ds, de, s, r, e)
        real(wp), intent(in) :: r_n           !! R at the start of the increment [-]
        real(wp), intent(in) :: s_max         !! slip that would unload the contact [L]
        real(wp), intent(in) :: ds, de        !! Newton step in slip [L] and in 1 - R
        real(wp), intent(inout) :: s, r, e    !! slip [L], R and 1 - R

        s = min(max(s + ds, 0.05_wp * s), s_max)
        if (r < 0.5_wp) then
            r = min(max(r - de, r_n, 0.05_wp * r), 1.0_wp - 0.05_wp * e)
            e = 1.0_wp - r
        else
            e = min(max(e + de, 0.05_wp * e), 1.0_wp - max(r_n, 0.05_wp * r))
            r = 1.0_wp - e
        end if
    end subroutine move

    !> R after the slip `m s` of section 3: Newton's method from the left, where it climbs without
    !> fail because the equation is concave. `log_r` is zero for R = 0, which only a contact that
    !> has not slid can have.
    pure subroutine similarity_ratio(r_n, ms, r, log_r)
        real(wp), intent(in) :: r_n       !! R at the start of the increment [-]
        real(wp), intent(in) :: ms        !! m times the slip, >= 0 [-]
        real(wp), intent(out) :: r        !! R at its end [-]
        real(wp), intent(out) :: log_r    !! ln R
        integer, parameter :: max_iterations = 100
        real(wp) :: e, de
        integer :: iteration

        r = (r_n + ms) / (1.0_wp + ms)
        e = (1.0_wp - r_n) / (1.0_wp + ms)
        log_r = 0.0_wp
        if (.not. r > 0.0_wp) return
        do iteration = 1, max_iterations
            log_r = log_of_ratio(r, e)
            de = r / (r + ms) * (ratio_gained(r_n, r, e) + ms * log_r)
            log_r = log_r - de / r
            e = e + de
            r = merge(r - de, 1.0_wp - e, r < 0.5_wp)
            if (abs(de) <= small_step * min(r, e)) exit
        end do
    end subroutine similarity_ratio

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

    !> R - R_n without cancellation near 1.
    pure function ratio_gained(r_n, r, e) result(gained)
        real(wp), intent(in) :: r_n, r, e
        real(wp) :: gained

        gained = merge(r - r_n, (1.0_wp - r_n) - e, r < 0.5_wp)
    end function ratio_gained

    !> ln R, exact near 1: `r` is a rounded 1 - e there, and a Taylor term makes up for the
    !> rounding.
    pure function log_of_ratio(r, e) result(log_r)
        real(wp), intent(in) :: r, e
        real(wp) :: log_r

        log_r = log(r) + merge(0.0_wp, ((1.0_wp - r) - e) / r, r < 0.5_wp)
    end function log_of_ratio

    !> ln(1 - e) without a logarithm: within 1e-3 of it for R > 0.1, a sound first step anywhere.
    pure function rough_log(e) result(log_r)
        real(wp), intent(in) :: e
        real(wp) :: log_r, z

        z = e / (e - 2.0_wp)
        log_r = 2.0_wp * z * (1.0_wp + z**2 / (3.0_wp - 1.8_wp * z**2))
    end function rough_log

end module friction_subloading_law
