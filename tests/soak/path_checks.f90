!> What must hold of every update: the checks of the random path test.
module path_checks
    use, intrinsic :: iso_fortran_env, only : dp => real64, qp => real128
    use friction_mod, only : friction_update
    use independent_laws, only : creeps, evolution_misfits, healed_slip, is_sheared, &
        load_case, material, mean_decay, pulled, read_increment, read_material, resistance_of, &
        rested_state, rested_strength
    use quad_friction_mod, only : quad_update => friction_update
    use worst_errors, only : worse, worst_of
    implicit none
    private

    public :: capped, check_equations, check_first_root, check_hold, check_range, check_tangent, &
        expects_time, viscous_of

    !> Kinds of faults.
    integer, parameter, public :: n_kinds = 19
    character(len=44), parameter, public :: kinds(n_kinds) = [character(len=44) :: &
        'no convergence (-6)', 'a state of its own refused (-5)', &
        'another code that is not right', &
        'NaN or infinity', 'slip or dissipation fell', 'an internal variable out of range', &
        'traction is not that of the springs', 'slip along the wrong direction', &
        'stick above the strength, slip below it', 'no solution of the discrete equations', &
        'energy', 'not the first equilibrium', 'another equilibrium not told', &
        'another equilibrium told where there is none', 'tangent', &
        'batch: another status', 'batch: other values', 'frame: other values', &
        'a hold after slip does not stick']
    integer, parameter, public :: k_convergence = 1, k_refused = 2, k_code = 3, k_finite = 4, &
        k_falls = 5, k_range = 6, k_traction = 7, k_direction = 8, k_verge = 9, k_equation = 10, &
        k_energy = 11, k_first = 12, k_untold = 13, k_told = 14, k_tangent = 15, &
        k_batch_status = 16, k_batch = 17, k_entry = 18, k_hold = 19

    !> One update of one point, in and out.
    type, public :: trial_of
        real(dp), allocatable :: props(:)
        real(dp) :: du(3), dt, old(8)
        logical :: given             !! the pressure is
        real(dp) :: pressure         !! then
        real(dp) :: new(8), traction(3), tangent(3, 3)
        integer :: status
    end type trial_of

    !> What is counted.
    type, public :: tally
        integer :: faults(n_kinds) = 0
        integer :: updates = 0, slips = 0, several = 0, refused_time = 0, beyond = 0
        integer :: equations = 0, roots = 0, tangents = 0, skipped = 0
        real(dp) :: residual = 0.0_dp, tangent = 0.0_dp, batch_value = 0.0_dp, &
            batch_tangent = 0.0_dp
    end type tally

    real(qp), parameter :: eps = epsilon(1.0_dp)
    real(dp), parameter :: largest = 2.0_dp**333

contains

    !> Numbers in range, nothing that may not fall falls.
    integer function check_range(t) result(kind_)
        type(trial_of), intent(in) :: t

        kind_ = 0
        if (.not. (all(abs(t%new) <= huge(1.0_dp)) .and. all(abs(t%traction) <= huge(1.0_dp)) &
            .and. all(abs(t%tangent) <= huge(1.0_dp)))) then
            kind_ = k_finite
        else if (t%new(7) < t%old(7) .or. t%new(8) < t%old(8)) then
            kind_ = k_falls
        else if (any(abs(t%new) >= largest) .or. t%new(5) < 0.0_dp .or. t%new(6) < 0.0_dp) then
            kind_ = k_range
        else if (nint(t%props(1)) == 1) then
            if (t%new(6) > 1.0_dp .or. t%new(5) < t%props(5) .or. t%new(5) > t%props(4)) kind_ = &
                k_range
        else if (creeps(nint(t%props(1))) .and. .not. t%new(6) > 0.0_dp) then
            kind_ = k_range
        end if
    end function check_range

    !> Is -9 the right answer?
    logical function expects_time(t)
        type(trial_of), intent(in) :: t
        type(material) :: mat
        type(load_case) :: this
        logical :: closed

        call read_material(t%props, mat)
        call read_increment(mat, t%du, t%dt, t%old, t%given, t%pressure, this, closed)
        expects_time = closed .and. is_sheared(mat, t%old(3:4), t%du(2:3)) .and. .not. t%dt > 0.0_dp
    end function expects_time

    !> Nothing moves after slip: the contact sticks, with the stiffness of its springs.
    integer function check_hold(t) result(kind_)
        type(trial_of), intent(in) :: t
        real(dp) :: state(8), traction(3), tangent(3, 3), zero(3)
        integer :: status

        kind_ = 0
        if (creeps(nint(t%props(1))) .or. nint(t%new(1)) /= 2 .or. t%given &
            .or. viscous_of(t) > 0.0_dp) return
        if (nint(t%props(1)) == 3 .and. .not. t%dt > 0.0_dp) return
        zero = 0.0_dp
        state = t%new
        call friction_update(zero, t%dt, t%props, state, traction, tangent, status)
        kind_ = k_hold
        if (status /= 0 .or. nint(state(1)) /= 1) return
        if (all(abs(state(2:4) - t%new(2:4)) <= 1.0e-280_dp) .and. abs(tangent(2, 2) - t%props(3)) &
            <= 0.0_dp .and. abs(tangent(2, 1)) <= 0.0_dp) kind_ = 0
    end function check_hold

    !> The discrete equations, in extended precision, of what was returned.
    integer function check_equations(t, residual) result(kind_)
        type(trial_of), intent(in) :: t
        real(dp), intent(inout) :: residual   !! the worst so far, by the scale of its terms
        type(material) :: mat
        type(load_case) :: this
        real(qp) :: tau(2), slid(2), trial, strength, error, equivalent, carried(2), full
        logical :: closed

        kind_ = 0
        call read_material(t%props, mat)
        call read_increment(mat, t%du, t%dt, t%old, t%given, t%pressure, this, closed)
        if (.not. closed) then
            if (any(abs(t%traction) > 0.0_dp)) kind_ = k_traction
            if (.not. rests(t, mat, this)) kind_ = k_equation
            return
        end if
        tau = t%traction(2:3)
        slid = this%moved - real(t%new(3:4), qp)
        error = 8.0_qp * eps * this%q_scale
        equivalent = sqrt(tau(1)**2 + (tau(2) / mat%rho)**2)
        trial = this%stiffness * sqrt(this%q(1)**2 + (this%q(2) / mat%rho)**2)
        strength = min(rested_strength(mat, this), mat%tau_max)
        kind_ = k_traction
        carried = mat%alpha_t * t%new(3:4) + this%viscous * (real(t%new(3:4), qp) - t%old(3:4))
        if (norm2(tau - carried) > this%stiffness * (error + 1.0e-290_qp) &
            .or. abs(t%traction(1) + this%p) > 4.0_qp * eps * this%p) return
        if (nint(t%new(1)) == 1) then
            if (norm2(slid) > error + 1.0e-288_qp) return
            kind_ = k_verge
            if (trial > strength * (1.0_qp + 200.0_qp * eps) + this%stiffness * (error &
                + 1.0e-280_qp) * max(1.0_qp, 1.0_qp / mat%rho)) return
            kind_ = k_equation
            if (.not. rests(t, mat, this)) return
            full = this%mu_rest * this%p + mat%cohesion
            if (mat%law == 1 .and. full > 0.0_qp) then
                if (abs(t%new(6) - min(1.0_qp, trial / full)) > 64.0_qp * eps * (1.0_qp &
                    + this%stiffness * error / max(eps, full))) return
            end if
            kind_ = 0
        else
            kind_ = k_verge
            if (trial < strength * (1.0_qp - 200.0_qp * eps) - this%viscous * error) return
            kind_ = sliding_fault(t, mat, this, tau, slid, equivalent, trial, residual)
        end if
    end function check_equations

    !> Are the internal variables those after a time without slip? R of a closed contact is another
    !> matter.
    logical function rests(t, mat, this)
        type(trial_of), intent(in) :: t
        type(material), intent(in) :: mat
        type(load_case), intent(in) :: this
        real(qp) :: state(2), share

        state = rested_state(mat, this)
        rests = abs(t%new(5) - state(1)) <= 32.0_qp * eps * mat%own(1)
        if (mat%law == 1 .and. nint(t%new(1)) < 3) return
        share = 64.0_qp * eps
        if (mat%law == 6) share = share * (1.0_qp + mat%own(4) * this%dt)
        if (mat%law == 8) share = share * (1.0_qp + mat%own(6) / mat%own(2) &
            * abs(log(max(this%p, 1.0e-300_qp))))   ! a difference of two logarithms
        rests = rests .and. abs(t%new(6) - state(2)) <= share * state(2) + tiny(1.0_dp)
    end function rests

    !> The same of an increment that slips.
    integer function sliding_fault(t, mat, this, tau, slid, equivalent, trial, residual) &
        result(kind_)
        type(trial_of), intent(in) :: t
        type(material), intent(in) :: mat
        type(load_case), intent(in) :: this
        real(qp), intent(in) :: tau(2), slid(2), equivalent, trial
        real(dp), intent(inout) :: residual
        real(dp) :: worst
        real(qp) :: along(2), s, error, work, gained, blur(2), misfit(2), scale(2), normal(2)

        kind_ = 0
        error = 8.0_qp * eps * this%q_scale
        s = norm2(slid)
        along = this%q
        if (mat%associated) along = [tau(1), tau(2) / mat%rho**2]
        if (this%q_scale < 1.0e-130_qp .or. norm2(tau) < 1.0e-130_qp) return   ! squares underflow
        kind_ = k_direction
        if (abs(slid(1) * along(2) - slid(2) * along(1)) > 16.0_qp * (error + eps * s) &
            * norm2(along)) return
        normal = along
        if (dot_product(slid, normal) < -8.0_qp * error * norm2(normal)) return

        gained = real(t%new(7), qp) - t%old(7)
        kind_ = k_energy
        if (abs(t%new(7)) < 1.0e100_dp .and. abs(gained - s) > 8.0_qp * (error + eps &
            * t%new(7))) then
            return
        end if
        work = dot_product(tau, slid) + this%viscous * sum((real(t%new(3:4), qp) - t%old(3:4))**2)
        gained = real(t%new(8), qp) - t%old(8)   ! at the end's traction, but by the exact rate
        if (work > 1.0e-280_qp .and. t%new(8) < 1.0e100_dp .and. mat%form /= 3 &
            .and. abs(gained - work) > 16.0_qp * (error * (norm2(tau) + this%viscous &
            * this%q_scale) + eps * (t%new(8) + work)) * max(1.0_qp, 1.0_qp / mat%rho)) return

        ! The slip is known better from its sum where that is short.
        if (t%new(7) < this%q_scale) then
            s = real(t%new(7), qp) - t%old(7)
            error = 4.0_qp * eps * t%new(7)
        end if
        kind_ = k_equation
        call evolve(t%new(5), t%new(6), s, misfit, scale, blur)
        if (creeps(mat%law) .and. s < max(1.0e-90_qp * mat%own(3), 100.0_qp * error)) then
            misfit = 0.0_qp
        end if
        if (.not. carries(t, mat, this, equivalent, trial, residual)) return
        worst = worst_of(real(abs(misfit) / (scale + blur / eps), dp))
        residual = worse(residual, worst)
        if (worst <= 128.0_dp * epsilon(worst)) kind_ = 0

    contains

        !> Misfits of the evolution laws, and how much round-off of state and slip changes them.
        subroutine evolve(mu_, r_, s_, misfit, scale, blur)
            real(dp), intent(in) :: mu_, r_
            real(qp), intent(in) :: s_
            real(qp), intent(out) :: misfit(2), scale(2), blur(2)
            real(qp) :: mu, r, plus(2), minus(2), unused(2)

            mu = mu_
            r = r_
            call evolution_misfits(mat, this, s_, mu, r, misfit, scale)
            call evolution_misfits(mat, this, s_ + error, mu, r, plus, unused)
            call evolution_misfits(mat, this, max(s_ - error, 0.0_qp), mu, r, minus, unused)
            blur = abs(plus - misfit) + abs(minus - misfit)
            call evolution_misfits(mat, this, s_, mu, r * (1.0_qp + eps), plus, unused)
            call evolution_misfits(mat, this, s_, mu, r * (1.0_qp - eps), minus, unused)
            blur = blur + abs(plus - misfit) + abs(minus - misfit)
            if (mat%law == 1 .and. mat%form == 3) call vary_start(mu, r, s_, misfit, blur)
            if (mat%law == 8) call vary_pressing(mu, r, s_, misfit, blur)
        end subroutine evolve

        !> Where sliding starts is a small difference, if the traction turns back.
        subroutine vary_start(mu, r, s_, misfit, blur)
            real(qp), intent(in) :: mu, r, s_, misfit(2)
            real(qp), intent(inout) :: blur(2)
            type(load_case) :: varied
            real(qp) :: plus(2), unused(2)

            varied = this
            varied%r_start = min(1.0_qp, this%r_start * (1.0_qp + 8.0_qp * eps) + 8.0_qp * eps &
                * this%r * min(1.0_qp, this%q_scale / max(norm2(this%q - t%old(3:4)), eps &
                * this%q_scale)))
            if (this%r_start >= this%r) varied%r_start = min(1.0_qp, this%r_start * (1.0_qp + eps))
            call evolution_misfits(mat, varied, s_, mu, r, plus, unused)
            blur = blur + abs(plus - misfit)
        end subroutine vary_start

        !> The pressures are products that round.
        subroutine vary_pressing(mu, r, s_, misfit, blur)
            real(qp), intent(in) :: mu, r, s_, misfit(2)
            real(qp), intent(inout) :: blur(2)
            type(load_case) :: varied
            real(qp) :: plus(2), unused(2)

            varied = this
            varied%pressing = this%pressing + eps * mat%own(6) / mat%own(2)
            call evolution_misfits(mat, varied, s_, mu, r, plus, unused)
            blur = blur + abs(plus - misfit)
        end subroutine vary_pressing

    end function sliding_fault

    !> Does a surface that slides carry what its law says, or its cap?
    logical function carries(t, mat, this, equivalent, trial, residual)
        type(trial_of), intent(in) :: t
        type(material), intent(in) :: mat
        type(load_case), intent(in) :: this
        real(qp), intent(in) :: equivalent, trial   !! traction at the end, and without slip
        real(dp), intent(inout) :: residual
        real(qp) :: own, worst

        own = this%p * t%new(5) + mat%cohesion
        if (mat%law == 1) own = own * t%new(6)
        if (equivalent >= mat%tau_max * (1.0_qp - 64.0_qp * eps)) then   ! the cap holds
            carries = equivalent <= mat%tau_max * (1.0_qp + 64.0_qp * eps) &
                .and. own >= mat%tau_max * (1.0_qp - 1.0e3_qp * eps)
        else
            worst = abs(equivalent - own) / (trial + own)
            residual = worse(residual, real(worst, dp))
            carries = worst <= 64.0_qp * eps
        end if
    end function carries

    !> Scans the curve of the spring against the law for equilibria before the one returned, and
    !> behind it.
    integer function check_first_root(t) result(kind_)
        type(trial_of), intent(in) :: t
        integer, parameter :: n = 600
        type(material) :: mat
        type(load_case) :: this
        real(qp) :: x(0:n), g(n), scale, taken, traction, slip, best
        integer :: i, k
        logical :: closed

        kind_ = 0
        call read_material(t%props, mat)
        call read_increment(mat, t%du, t%dt, t%old, t%given, t%pressure, this, closed)
        if (nint(t%new(1)) /= 2) return
        call pulled(mat, this, 0.0_qp, scale, slip)
        taken = norm2(this%moved - real(t%new(3:4), qp))
        if (t%new(7) < this%q_scale) taken = real(t%new(7), qp) - t%old(7)
        call fill_grid(mat, this, x)
        k = 0
        do i = 1, n
            call misfit_at(x(i), g(i), slip)
            if (slip < taken * (1.0_qp - 1.0e-6_qp) - 1.0e-12_qp * this%q_scale) k = i
        end do
        kind_ = k_first
        if (any(g(1:k) < -1.0e-9_qp * scale)) return
        do k = k + 1, n
            call misfit_at(x(k), g(k), slip)
            if (slip > taken * (1.0_qp + 1.0e-6_qp) + 1.0e-12_qp * this%q_scale) exit
        end do
        kind_ = k_untold
        if (k <= n .and. t%status == 0) then
            if (any(g(k:n) > 1.0e-9_qp * scale)) return
        end if
        kind_ = 0
        if (t%status /= 1) return
        best = -huge(1.0_dp)
        do i = max(k - 1, 1), n - 1
            if (g(i) >= best) best = max(best, peak_near(i))
        end do
        if (best < -1.0e-6_qp * scale) kind_ = k_told

    contains

        subroutine misfit_at(x, g, slip)
            real(qp), intent(in) :: x
            real(qp), intent(out) :: g, slip

            call pulled(mat, this, x, traction, slip)
            g = traction - min(resistance_of(mat, this, slip), mat%tau_max)
        end subroutine misfit_at

        !> Largest g between the neighbours of grid point i, by trisection.
        function peak_near(i) result(peak)
            integer, intent(in) :: i
            real(qp) :: peak
            real(qp) :: a, b, one, two, g_one, g_two
            integer :: j

            a = x(max(i - 1, 1))
            b = x(i + 1)
            peak = g(i)
            do j = 1, 60
                one = a + (b - a) / 3.0_qp
                two = b - (b - a) / 3.0_qp
                call misfit_at(one, g_one, slip)
                call misfit_at(two, g_two, slip)
                peak = max(peak, g_one, g_two)
                if (g_one > g_two) then
                    b = two
                else
                    a = one
                end if
            end do
        end function peak_near

    end function check_first_root

    !> Does the shear cap hold an increment that slips?
    logical function capped(t)
        type(trial_of), intent(in) :: t
        type(material) :: mat

        call read_material(t%props, mat)
        capped = nint(t%new(1)) == 2 .and. norm2([real(t%traction(2), qp), t%traction(3) &
            / mat%rho]) >= mat%tau_max * (1.0_qp - 64.0_qp * eps)
    end function capped

    !> From no slip to all of it: every decade of it, evenly, and around the kink of laws 5 and 6.
    subroutine fill_grid(mat, this, x)
        type(material), intent(in) :: mat
        type(load_case), intent(in) :: this
        real(qp), intent(out) :: x(0:)
        real(qp) :: kink, swap
        integer :: n, i, j

        n = ubound(x, 1)
        x(0) = 0.0_qp
        do i = 1, n
            if (i <= n / 2) then
                x(i) = 10.0_qp**(-22.0_qp + 22.0_qp * i / (n / 2))
            else
                x(i) = real(i - n / 2, qp) / (n - n / 2)
            end if
        end do
        if (any(mat%law == [5, 6])) then
            kink = (mat%own(3) - this%r) / norm2(this%q)
            if (mat%law == 6) kink = (mat%own(3) - healed_slip(mat, this, 0.0_qp)) &
                / (norm2(this%q) * mean_decay(mat%own(4) * this%dt))
            if (kink > 0.0_qp .and. kink < 1.0_qp) x(n / 2 + 1:n / 2 + 5) = kink &
                * [0.99_qp, 0.999999_qp, 1.0_qp, 1.000001_qp, 1.01_qp]
        end if
        x = min(x, 1.0_qp)
        do i = 2, n   ! sorted by insertion: nearly so already, in two runs
            swap = x(i)
            j = i - 1
            do while (j > 0)
                if (x(j) <= swap) exit
                x(j + 1) = x(j)
                j = j - 1
            end do
            x(j + 1) = swap
        end do
    end subroutine fill_grid

    !> The damper as a spring [F/L^3].
    function viscous_of(t) result(viscous)
        type(trial_of), intent(in) :: t
        real(dp) :: viscous
        type(material) :: mat

        call read_material(t%props, mat)
        viscous = 0.0_dp
        if (t%dt > 0.0_dp) viscous = real(min(mat%damping / t%dt, 2.0_qp**166), dp)
    end function viscous_of

    !> The tangent against central differences of the library in quadruple precision; skipped where
    !> a kink is in the way.
    integer function check_tangent(t, m, error, skipped) result(kind_)
        type(trial_of), intent(in) :: t
        integer, intent(in) :: m              !! components
        real(dp), intent(inout) :: error   !! the worst so far, by stiffness and condition
        logical, intent(out) :: skipped
        real(qp) :: h(3), f(3, -1:1), by_du(3, 3), state(8), unused(3, 3), du(3), bend
        real(dp) :: stiff, worst
        type(material) :: mat
        integer :: j, k, status

        kind_ = 0
        skipped = .true.
        call read_material(t%props, mat)   ! differences see no pressure beside such a cohesion
        if (abs(t%traction(1)) < 1.0e-9_qp * mat%cohesion) return
        h(1) = 1.0e-13_qp * (abs(t%du(1)) + abs(t%old(2)))
        ! gfortran's norm2 does not scale: the square of a small displacement would be 0
        h(2:3) = 1.0e-13_qp * (norm2(real(t%du(2:3), qp)) + norm2(real(t%old(3:4), qp)))
        h = max(h, 1.0e-200_qp)
        by_du = 0.0_qp
        do j = 1, m
            do k = -1, 1
                du = t%du
                du(j) = du(j) + k * h(j)
                state = t%old
                f(:, k) = 0.0_qp
                call quad_update(du, real(t%dt, qp), real(t%props, qp), state, f(:, k), unused, &
                    status)
                if (status /= t%status .or. nint(state(1)) /= nint(t%new(1))) return
            end do
            by_du(:, j) = (f(:, 1) - f(:, -1)) / (2.0_qp * h(j))
            stiff = max(t%props(2), t%props(3), real(maxval(abs(by_du(:, j))), dp))
            f(m + 1:, :) = 0.0_qp
            by_du(m + 1:, j) = 0.0_qp
            bend = maxval(abs(f(:, 1) - 2.0_qp * f(:, 0) + f(:, -1)))
            if (bend > 1.0e-9_qp * stiff * h(j)) return
        end do
        skipped = .false.
        stiff = max(t%props(2), t%props(3))
        worst = worst_of(real(abs(t%tangent - by_du), dp)) / max(stiff, real(maxval(abs(by_du)), &
            dp)**2 / stiff)
        error = worse(error, worst)
        if (.not. worst <= 1.0e-12_dp) kind_ = k_tangent
    end function check_tangent

end module path_checks
