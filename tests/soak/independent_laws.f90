!> The friction laws once more, straight from docs/theory.md and docs/laws.md, without any of the
!> library's code: what the random path test compares with.
!>
!> Written for a working precision `qp` of 33 digits, where nothing that matters cancels.
module independent_laws
    use, intrinsic :: iso_fortran_env, only : dp => real64, qp => real128
    implicit none
    private

    public :: creeps, evolution_misfits, healed_slip, is_sheared, load_case, material, &
        mean_decay, pulled, read_increment, read_material, rested_state, rested_strength, &
        resistance_of

    !> What `props` says.
    type :: material
        integer :: law           !! 1 to 8
        real(qp) :: alpha_n, alpha_t
        real(qp) :: own(9)       !! the law's own constants
        real(qp) :: mu_0         !! of a virgin point
        integer :: form          !! of law 1: 0 logarithm, 1 cotangent, 2 reciprocal, 3 exact rate;
                                 !! of law 4: 0 ageing, 1 slip
        real(qp) :: tau_max      !! huge: none
        real(qp) :: rho          !! mu_2/mu_1
        logical :: associated
        real(qp) :: cohesion, damping
    end type material

    !> A closed contact in an increment, its slip prevented.
    type :: load_case
        real(qp) :: p            !! pressure
        real(qp) :: dt
        real(qp) :: q(2)         !! displacement of which spring and damper make the trial traction
        real(qp) :: moved(2)     !! the elastic displacement, if nothing slips
        real(qp) :: viscous      !! stiffness of the damper
        real(qp) :: stiffness    !! of both
        real(qp) :: q_scale      !! of the terms of q
        real(qp) :: mu, r        !! internal variables at the start; for a virgin point its own
        real(qp) :: mu_rest      !! friction coefficient without slip
        real(qp) :: pressing     !! of law 8: how much ln(theta) falls by the change of pressure
        real(qp) :: r_start      !! where sliding starts: the least R on the way
    end type load_case

    real(qp), parameter :: half_pi = acos(0.0_qp)

    real(qp), parameter :: largest = 2.0_qp**333   !! what grows ends there

    !> v0 theta/d_c of law 7 ends here.
    real(qp), parameter :: least_state = 1.0e-250_dp

contains

    !> Laws of rate-and-state friction, which slide under any traction.
    pure logical function creeps(law)
        integer, intent(in) :: law   !! number

        creeps = any(law == [4, 7, 8])
    end function creeps

    subroutine read_material(props, mat)
        real(dp), intent(in) :: props(:)
        type(material), intent(out) :: mat
        integer, parameter :: places(8) = [12, 5, 7, 11, 7, 8, 13, 12]   ! of the cap
        integer :: n_own, cap

        mat%law = nint(props(1))
        mat%alpha_n = props(2)
        mat%alpha_t = props(3)
        mat%own = 0.0_qp
        n_own = min(9, size(props) - 3)
        mat%own(:n_own) = props(4:3 + n_own)
        mat%form = 0
        mat%mu_0 = mat%own(1)
        if (mat%law == 1) then
            if (size(props) > 8) mat%mu_0 = mat%own(6)
            if (size(props) > 9) mat%form = 3 * nint(props(10))
            if (size(props) > 10) mat%form = mat%form + nint(props(11))
        else if (mat%law == 4) then
            if (size(props) > 8) mat%form = nint(props(9))
            if (size(props) < 10) mat%own(7) = mat%own(3) / mat%own(4)
        else if (mat%law == 8) then
            if (size(props) > 9) mat%form = nint(props(10))
            if (size(props) < 11) mat%own(8) = mat%own(3) / mat%own(4)
        else if (mat%law == 7) then
            mat%form = 1
            if (size(props) < 11) mat%own(8) = 8.0_qp
            if (size(props) < 12) mat%own(9) = mat%own(3) / mat%own(4)
        end if
        mat%tau_max = huge(1.0_dp)
        mat%rho = 1.0_qp
        mat%associated = .false.
        cap = places(mat%law)
        if (size(props) >= cap) then
            if (props(cap) > 0.0_dp) mat%tau_max = props(cap)
        end if
        if (size(props) > cap) then
            if (props(cap + 1) > 0.0_dp) mat%rho = props(cap + 1)
            mat%associated = abs(mat%rho - 1.0_qp) > 0.0_qp
        end if
        if (size(props) > cap + 1) mat%associated = mat%associated .and. props(cap + 2) < 0.5_dp
        mat%cohesion = 0.0_qp
        if (size(props) > cap + 2) mat%cohesion = props(cap + 3)
        mat%damping = 0.0_qp
        if (size(props) > cap + 3) mat%damping = props(cap + 4)
    end subroutine read_material

    !> The increment as the contact sees it; `closed` false: no pressure.
    subroutine read_increment(mat, du, dt, old, given, pressure, this, closed)
        type(material), intent(in) :: mat
        real(dp), intent(in) :: du(3), dt, old(8), pressure
        logical, intent(in) :: given    !! the pressure is
        type(load_case), intent(out) :: this
        logical, intent(out) :: closed
        real(qp) :: u_n, part

        u_n = real(old(2), qp) + du(1)
        this%p = -mat%alpha_n * u_n
        if (given) this%p = pressure
        closed = this%p > 0.0_qp .or. (mat%cohesion > 0.0_qp .and. .not. this%p < 0.0_qp)
        part = 1.0_qp
        if (old(2) > 0.0_dp .and. closed .and. .not. given) part = u_n / du(1)
        this%dt = dt
        this%moved = real(old(3:4), qp) + part * du(2:3)
        this%viscous = 0.0_qp
        if (dt > 0.0_dp) this%viscous = min(mat%damping / dt, 2.0_qp**166)
        this%stiffness = mat%alpha_t + this%viscous
        this%q = (mat%alpha_t / this%stiffness) * old(3:4) + part * du(2:3)
        this%q_scale = norm2(real(old(3:4), qp)) + part * norm2(real(du(2:3), qp)) &
            + norm2(this%moved)
        this%mu = old(5)
        this%r = old(6)
        if (nint(old(1)) == 0) then
            this%mu = mat%mu_0
            this%r = 0.0_qp
            if (mat%law == 4) this%r = mat%own(7)
            if (mat%law == 7) this%r = mat%own(9)
            if (mat%law == 8) this%r = mat%own(8)
        end if
        this%pressing = 0.0_qp   ! from no pressure, or to none, the equation says nothing
        if (mat%law == 8 .and. this%p > 0.0_qp .and. old(2) < 0.0_dp) this%pressing = &
            max(-200.0_qp, min(mat%own(6) / mat%own(2) * log(this%p / (-mat%alpha_n &
            * old(2))), 200.0_qp))
        if (.not. closed) return
        this%mu_rest = mu_after(mat, this, 0.0_qp)
        this%r_start = this%r
        if (mat%law == 1 .and. mat%form == 3 .and. mat%tau_max > 1.0e300_qp .and. .not. &
            mat%damping > 0.0_qp) this%r_start = &
            this%r * least_share(mat, this, real(old(3:4), qp))
    end subroutine read_increment

    !> Where traction over strength moves along a straight line, its least magnitude by that at the
    !> start (section 8).
    function least_share(mat, this, u_et) result(share)
        type(material), intent(in) :: mat
        type(load_case), intent(in) :: this
        real(qp), intent(in) :: u_et(2)
        real(qp) :: share
        real(qp) :: a(2), b(2), way(2), t, reach

        share = 1.0_qp
        a = [u_et(1), u_et(2) / mat%rho]
        b = [this%q(1), this%q(2) / mat%rho]
        if (.not. norm2(a) > 0.0_qp) return
        a = a / norm2(a)
        reach = this%r * (this%mu_rest * this%p + mat%cohesion) / mat%alpha_t
        way = b - reach * a
        if (.not. norm2(way) > 0.0_qp) return
        t = -reach * dot_product(a, way) / dot_product(way, way)
        if (t > 0.0_qp .and. t < 1.0_qp) share = norm2(a + (t / reach) * way)
    end function least_share

    !> Traction at which sliding starts, the cap aside.
    function rested_strength(mat, this) result(strength)
        type(material), intent(in) :: mat
        type(load_case), intent(in) :: this
        real(qp) :: strength

        strength = this%mu_rest * this%p + mat%cohesion
        if (mat%law == 1) strength = max(this%r_start, 1.0e-100_qp) * strength
    end function rested_strength

    !> Internal variables after an increment without slip; R of law 1, which then follows from the
    !> traction, is 0.
    function rested_state(mat, this) result(state)
        type(material), intent(in) :: mat
        type(load_case), intent(in) :: this
        real(qp) :: state(2)   !! mu, r

        state(1) = mu_after(mat, this, 0.0_qp)
        state(2) = 0.0_qp
        select case (mat%law)
        case (4, 7, 8)
            state(2) = min(exp(ln_theta(mat, this, 0.0_qp)), largest)
        case (5)
            state(2) = this%r
        case (6)
            state(2) = healed_slip(mat, this, 0.0_qp)
        case default   ! nothing else evolves
        end select
    end function rested_state

    !> Does law or damper need time for this increment?
    function is_sheared(mat, u_et, du) result(sheared)
        type(material), intent(in) :: mat
        real(dp), intent(in) :: u_et(2), du(2)   !! elastic displacement at the start; increment
        logical :: sheared

        sheared = (mat%law == 3 .or. creeps(mat%law)) .and. any(abs(u_et + du) > 0.0_dp)
        sheared = sheared .or. mat%damping > 0.0_qp .and. any(abs([u_et, du]) > 0.0_dp)
    end function is_sheared

    !> Friction coefficient after the slip s in the increment; of law 4 the state does that.
    function mu_after(mat, this, s) result(mu)
        type(material), intent(in) :: mat
        type(load_case), intent(in) :: this
        real(qp), intent(in) :: s
        real(qp) :: mu
        real(qp) :: x

        select case (mat%law)
        case (1)
            associate (mu_s => mat%own(1), mu_k => mat%own(2), ks => mat%own(3) * s, &
                xt => mat%own(4) * this%dt)
                if (mat%form == 3) then
                    x = ks + xt
                    mu = mu_k + (this%mu - mu_k) * exp(-x) + xt * (mu_s - mu_k) * mean_decay(x)
                else
                    mu = (this%mu + ks * mu_k + xt * mu_s) / (1.0_qp + ks + xt)
                end if
            end associate
        case (2)
            mu = mat%own(1)
        case (3)
            x = 0.0_qp
            if (s > 0.0_qp) x = mat%own(3) * s / this%dt
            mu = mat%own(2) + (mat%own(1) - mat%own(2)) * exp(-x)
        case (5)
            mu = max(mat%own(2), mat%own(1) - (mat%own(1) - mat%own(2)) * ((this%r + s) &
                / mat%own(3)))
        case (6)
            mu = mat%own(1) - (mat%own(1) - mat%own(2)) * (healed_slip(mat, this, s) / mat%own(3))
        case default
            mu = 0.0_qp
        end select
    end function mu_after

    !> D of law 6 after the slip s.
    function healed_slip(mat, this, s) result(d)
        type(material), intent(in) :: mat
        type(load_case), intent(in) :: this
        real(qp), intent(in) :: s
        real(qp) :: d
        real(qp) :: x

        x = mat%own(4) * this%dt
        d = min(min(this%r, mat%own(3)) * exp(-x) + s * mean_decay(x), mat%own(3))
    end function healed_slip

    !> (1 - e^-x)/x
    function mean_decay(x) result(mean)
        real(qp), intent(in) :: x
        real(qp) :: mean

        mean = 1.0_qp - 0.5_qp * x + x**2 / 6.0_qp
        if (abs(x) > 1.0e-10_qp) mean = (1.0_qp - exp(-x)) / x
    end function mean_decay

    !> ln(theta) of laws 4, 7 and 8 after the slip s.
    function ln_theta(mat, this, s) result(ln)
        type(material), intent(in) :: mat
        type(load_case), intent(in) :: this
        real(qp), intent(in) :: s
        real(qp) :: ln
        real(qp) :: x, steady

        x = s / mat%own(3)
        if (mat%form == 0) then
            x = x + this%pressing
            ln = log(this%r * exp(-x) + this%dt * mean_decay(x))
        else
            ln = log(this%r)
            ln = ln - this%pressing * mean_decay(x)
            if (.not. x > 0.0_qp) return
            steady = log(this%dt) - log(x)
            if (mat%law == 7) steady = heated(mat, s / this%dt)
            ln = ln + x * mean_decay(x) * (steady - log(this%r))
        end if
    end function ln_theta

    !> ln(theta) of law 7 in steady sliding: psi_ss = f0 + b ln(v0 theta/d_c).
    function heated(mat, v) result(ln)
        type(material), intent(in) :: mat
        real(qp), intent(in) :: v
        real(qp) :: ln
        real(qp) :: f_lv, f_ss, psi, x

        associate (a => mat%own(1), b => mat%own(2), v0 => mat%own(4), f0 => mat%own(5), &
            f_w => mat%own(6), n => mat%own(8))
            x = log(v / (2.0_qp * v0)) + (f0 - b * log(v / v0)) / a
            if (x > 40.0_qp) then
                f_lv = a * (x + log(2.0_qp))
            else
                f_lv = a * asinh(exp(x))
            end if
            x = n * log(v / mat%own(7))
            x = max(x, 0.0_qp) + log_of_1_and(exp(-abs(x)))   ! -n ln(G)
            f_ss = max(f_lv * exp(-x / n) + f_w * ((x / n) * mean_decay(x / n)), 1.0e-100_qp * a)
            psi = f_ss / a
            if (psi < 100.0_qp) psi = log(sinh(psi)) + log(2.0_qp)
            psi = a * (psi + log(v0 / v))
            ln = (psi - f0) / b + log(mat%own(3) / v0)
        end associate
    end function heated

    !> ln(1 + t), without cancellation where t is small.
    function log_of_1_and(t) result(ln)
        real(qp), intent(in) :: t   !! 0 to 1
        real(qp) :: ln

        ln = 2.0_qp * atanh(t / (2.0_qp + t))
    end function log_of_1_and

    !> Misfits of the discrete evolution laws for the state `new` after the slip s, zero for none:
    !> of the friction coefficient, and of the internal variable, with the scales of their terms.
    subroutine evolution_misfits(mat, this, s, mu, r, misfit, scale)
        type(material), intent(in) :: mat
        type(load_case), intent(in) :: this
        real(qp), intent(in) :: s, mu, r
        real(qp), intent(out) :: misfit(2), scale(2)
        real(qp) :: x

        misfit(1) = mu - mu_after(mat, this, s)
        scale(1) = mat%own(1)
        misfit(2) = 0.0_qp
        scale(2) = 1.0_qp
        select case (mat%law)
        case (1)
            call ratio_misfit(mat, this%r_start, s, min(r, 1.0_qp), misfit(2), scale(2))
        case (4, 7, 8)
            x = ln_theta(mat, this, s)
            misfit(2) = max(x, log(real(tiny(1.0_dp), qp)))   ! as far as numbers go
            if (mat%law == 7) misfit(2) = max(x, log(least_state * mat%own(3) / mat%own(4)))
            misfit(2) = log(r) - min(misfit(2), log(largest))
            scale(2) = 1.0_qp + abs(x) + abs(log(this%r)) + abs(log(this%dt))
            misfit(1) = mu - viscous(mat, this, s, x, scale(1))
        case (5)
            misfit(2) = r - (this%r + s)
            scale(2) = r
        case (6)
            misfit(2) = r - healed_slip(mat, this, s)
            scale(2) = r
        case default   ! nothing evolves
        end select
    end subroutine evolution_misfits

    !> a asinh(v/(2 v0) exp((f0 + b ln(v0 theta/d_c))/a))
    function viscous(mat, this, s, ln, scale) result(mu)
        type(material), intent(in) :: mat
        type(load_case), intent(in) :: this
        real(qp), intent(in) :: s, ln
        real(qp), intent(out) :: scale   !! of the terms, as far as they count
        real(qp) :: mu
        real(qp) :: x, state

        scale = 1.0_qp
        mu = 0.0_qp
        if (.not. s > 0.0_qp) return
        associate (a => mat%own(1), b => mat%own(2), v0 => mat%own(4), f0 => mat%own(5))
            state = log(v0 / mat%own(3)) + ln
            x = log(s / (2.0_qp * v0 * this%dt)) + (f0 + b * state) / a
            if (x > 40.0_qp) then
                mu = a * (x + log(2.0_qp))
            else
                mu = a * asinh(exp(x))
            end if
            scale = abs(log(v0)) + abs(log(mat%own(3))) + abs(ln)
            scale = abs(log(s)) + abs(log(v0 * this%dt)) + (f0 + b * scale) / a
            scale = 1.0e-290_qp + mu + (mu / max(x, 1.0_qp)) * scale
        end associate
    end function viscous

    subroutine ratio_misfit(mat, r_start, s, r, misfit, scale)
        type(material), intent(in) :: mat
        real(qp), intent(in) :: r_start, s, r
        real(qp), intent(out) :: misfit, scale
        real(qp) :: ms, u

        ms = mat%own(5) * s
        misfit = r - r_start
        scale = r + r_start
        if (.not. ms > 0.0_qp .or. r_start >= 1.0_qp) return
        if (mat%form == 3) then
            misfit = -ms
            if (r_start > 0.0_qp) misfit = misfit - integral(-log(r_start))
            scale = -misfit
            if (r >= 1.0_qp) then   ! by rounding: -ln(R) is less than half a unit of that
                misfit = max(0.0_qp, misfit + integral(0.5_qp * epsilon(1.0_dp)))
            else
                misfit = misfit + integral(-log(r))
                scale = scale + integral(-log(r))
            end if
            return
        end if
        u = u_of(mat, r)
        misfit = (r - r_start) - ms * u
        scale = r + r_start + ms * u
    end subroutine ratio_misfit

    function u_of(mat, r) result(u)
        type(material), intent(in) :: mat
        real(qp), intent(in) :: r
        real(qp) :: u

        select case (mat%form)
        case (0)
            u = -log(r)
        case (1)
            u = cos(half_pi * r) / sin(half_pi * r)
            if (r >= 1.0_qp) u = 0.0_qp
        case default
            u = 1.0_qp / r - 1.0_qp
        end select
    end function u_of

    !> The exponential integral E1.
    function integral(y) result(e1)
        real(qp), intent(in) :: y
        real(qp) :: e1
        real(qp), parameter :: euler_gamma = 0.57721566490153286060651209008240243_qp
        real(qp) :: term
        integer :: k

        if (y < 4.0_qp) then
            e1 = -euler_gamma - log(y)
            term = 1.0_qp
            do k = 1, 80
                term = -term * y / k
                e1 = e1 - term / k
                if (abs(term) < 1.0e-36_qp * abs(e1)) exit
            end do
        else
            term = 0.0_qp
            do k = 20 + int(700.0_qp / y), 1, -1
                term = real(k, qp)**2 / (y + 2 * k + 1 - term)
            end do
            e1 = exp(-y) / (y + 1.0_qp - term)
        end if
    end function integral

    !> Resistance after the slip s, the cap aside. R by bisection.
    function resistance_of(mat, this, s) result(resistance)
        type(material), intent(in) :: mat
        type(load_case), intent(in) :: this
        real(qp), intent(in) :: s
        real(qp) :: resistance
        real(qp) :: unused

        if (creeps(mat%law)) then
            resistance = this%p * viscous(mat, this, s, ln_theta(mat, this, s), unused) &
                + mat%cohesion
        else
            resistance = this%p * mu_after(mat, this, s) + mat%cohesion
            if (mat%law == 1) resistance = resistance * ratio_after(mat, this%r_start, s)
        end if
    end function resistance_of

    function ratio_after(mat, r_start, s) result(r)
        type(material), intent(in) :: mat
        real(qp), intent(in) :: r_start, s
        real(qp) :: r
        real(qp) :: low, high, misfit, scale
        integer :: k

        r = r_start
        if (.not. s > 0.0_qp .or. r_start >= 1.0_qp) return
        low = r_start
        high = 1.0_qp
        do k = 1, 200
            r = 0.5_qp * (low + high)
            if (high > 4.0_qp * low) r = sqrt(high * max(low, 1.0e-10_qp * high))
            call ratio_misfit(mat, r_start, s, r, misfit, scale)
            if (misfit > 0.0_qp) then
                high = r
            else
                low = r
            end if
            if (high - low <= 1.0e-14_qp * min(low, 1.0_qp - high)) exit
        end do
    end function ratio_after

    !> The spring when the share x of its displacement (associated: of the component that relaxes
    !> more slowly) has become slip: equivalent traction and slip.
    subroutine pulled(mat, this, x, traction, slip)
        type(material), intent(in) :: mat
        type(load_case), intent(in) :: this
        real(qp), intent(in) :: x
        real(qp), intent(out) :: traction, slip
        real(qp) :: rates(2), left(2)

        left = 1.0_qp - x
        if (mat%associated) then
            rates = [1.0_qp, 1.0_qp / mat%rho**2]
            rates = rates / minval(rates)
            left = (1.0_qp - x) / (1.0_qp + (rates - 1.0_qp) * x)
        end if
        traction = this%stiffness * sqrt((left(1) * this%q(1))**2 + (left(2) * this%q(2) &
            / mat%rho)**2)
        slip = norm2((1.0_qp - left) * this%q)
    end subroutine pulled

end module independent_laws
