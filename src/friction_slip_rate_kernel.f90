!> Slip rates of a block of contact points without a contact spring under rate-and-state friction,
!> in vector lanes. With y = mu/a, t = tau/(a p) and k = 2 v0 e^-x damping/(a p), the balance
!> `tau - damping v = friction` of a point is
!>
!>     f(y) = y + k sinh(y) - t = 0,   0 <= y <= t
!>
!> convex, and steeper than a line of slope 1: it has one root. The search starts from an
!> approximation of the root for k sinh(y) ~ (k/2) e^y, which is t minus the Wright omega function
!> of t + ln(k/2), or from 0 where that is small, and goes on by Householder's method of fourth
!> order: twice as a rule.
!>
!> Points that the kernel does not take are told by `left`: numbers out of range or of an unusual
!> size, and what has not settled. Each point is treated by itself: its result does not depend on
!> its neighbours. No floating-point exception but inexact and underflow.
!>
!> Compiled once for each vector instruction set, under other names, with a copy of the core
!> (src/CMakeLists.txt): it uses nothing else, so that the copies share nothing.
module friction_slip_rate_kernel
    use, intrinsic :: iso_c_binding, only : c_double, c_int, c_int64_t
    use friction_lane_block, only : below_largest, lanes, zero_unless
    use friction_rate_state_core, only : ageing_rate, decayed_part, slip_law_rate, slip_rate, &
        state_exponent
    implicit none
    private

    public :: slip_rates_of_block

    integer, parameter :: wp = c_double
    integer, parameter :: inputs = 8       !! numbers of a point
    integer, parameter :: in_tau = 1, in_pressure = 2, in_theta = 3, in_a = 4, in_b = 5, &
        in_d_c = 6, in_v0 = 7, in_f0 = 8
    real(wp), parameter :: largest = 1.0e30_wp    !! of the numbers taken: no product overflows
    real(wp), parameter :: smallest = 1.0e-30_wp  !! of those that must be positive
    real(wp), parameter :: far = 20.0_wp   !! beyond this y, 1 - e^-2y is 1 to the last bit
    real(wp), parameter :: fast = 20.0_wp  !! beyond this z, w is larger than ln(w) by far
    real(wp), parameter :: least_start = 0.25_wp  !! a smaller y starts from 0

    !> A block of points, prepared for the search.
    type :: search_block
        real(wp) :: t(lanes)      !! tau/(a p)
        real(wp) :: x(lanes)      !! of the law
        real(wp) :: k_half(lanes) !! v0 damping/(a p)
        real(wp) :: y(lanes)      !! mu/a
        real(wp) :: per_d_c(lanes)   !! 1/d_c [1/L]
    end type search_block

contains

    !> Slip rates, and the rates of theta, of a block of points.
    subroutine slip_rates_of_block(evolution, damping, stride, tau, pressure, theta, constants, &
        rates, left) bind(C, name='stickslip_slip_rate_kernel')
        integer(c_int), value, intent(in) :: evolution    !! 0: ageing law, 1: slip law
        real(wp), value, intent(in) :: damping            !! 0, or 1e-30 to 1e30 [F T/L^3]
        integer(c_int64_t), value, intent(in) :: stride   !! distance of constants, `lanes` or more
        real(wp), intent(in) :: tau(lanes), pressure(lanes)   !! [F/L^2]
        real(wp), intent(in) :: theta(lanes)                  !! [T]
        real(wp), intent(in) :: constants(stride, *)      !! a, b, d_c, v0, f0
        real(wp), intent(out) :: rates(lanes, 2)          !! v [L/T], d(theta)/dt [-]
        integer(c_int), intent(out) :: left(lanes)        !! 1 for a point not taken, else 0
        real(wp) :: kept(lanes, inputs)
        type(search_block) :: block

        call keep_ordinary(stride, tau, pressure, theta, constants, kept, left)
        call prepare(damping, kept, block, left)
        call solve(kept, block, rates, left)
        call evolve(evolution, kept, block, rates)
    end subroutine slip_rates_of_block

    !> Copies the points; those that are not taken are replaced by ones that harm nobody.
    subroutine keep_ordinary(stride, tau, pressure, theta, constants, kept, left)
        integer(c_int64_t), intent(in) :: stride
        real(wp), intent(in) :: tau(lanes), pressure(lanes), theta(lanes), constants(stride, 5)
        real(wp), intent(out) :: kept(lanes, inputs)
        integer(c_int), intent(out) :: left(lanes)
        integer(c_int64_t) :: fine
        real(wp) :: valid
        integer :: i, k

        do i = 1, lanes
            fine = below_largest(abs(tau(i)) + abs(pressure(i)) + abs(theta(i)) &
                + abs(constants(i, 1)) + abs(constants(i, 2)) + abs(constants(i, 3)) &
                + abs(constants(i, 4)) + abs(constants(i, 5)), largest)
            kept(i, in_tau) = zero_unless(fine, tau(i))
            kept(i, in_pressure) = zero_unless(fine, pressure(i))
            kept(i, in_theta) = zero_unless(fine, theta(i))
            do k = 1, 5
                kept(i, in_theta + k) = zero_unless(fine, constants(i, k))
            end do
            valid = min(kept(i, in_pressure), kept(i, in_theta), kept(i, in_a), kept(i, in_d_c), &
                kept(i, in_v0)) - smallest
            valid = min(valid, kept(i, in_tau), kept(i, in_b), kept(i, in_f0))
            left(i) = 0
            if (valid < 0.0_wp) left(i) = 1
        end do
        if (sum(left) == 0) return
        do k = 1, inputs
            do i = 1, lanes
                if (left(i) > 0) kept(i, k) = 1.0_wp
            end do
        end do
    end subroutine keep_ordinary

    !> The numbers of the search, and where it starts.
    subroutine prepare(damping, kept, block, left)
        real(wp), intent(in) :: damping
        real(wp), intent(in) :: kept(lanes, inputs)
        type(search_block), intent(out) :: block
        integer(c_int), intent(inout) :: left(lanes)
        real(wp), parameter :: nothing = 1.0e-300_wp
        real(wp), parameter :: most_t = 1.0e5_wp, most_x = 1.0e5_wp, &
            ln_largest = 69.0776_wp, &  ! as much as v0 may count
            most_rate = 280.0_wp, &     ! ln of v and w, but for ln(t): the routine for one point
                                        ! tells such up to e^300
            most_k = 200.0_wp           ! the cube of e^that is in range
        real(wp), dimension(lanes) :: state, ln_state, per_a
        real(wp) :: shared, ln_k_half, z, y, beyond
        integer :: i

        do i = 1, lanes
            shared = 1.0_wp / (kept(i, in_a) * kept(i, in_pressure) * kept(i, in_d_c))
            per_a(i) = kept(i, in_pressure) * kept(i, in_d_c) * shared   ! one division for three
            block%per_d_c(i) = kept(i, in_a) * kept(i, in_pressure) * shared
            block%t(i) = kept(i, in_tau) * (kept(i, in_d_c) * shared)
            block%k_half(i) = damping * kept(i, in_v0) * (kept(i, in_d_c) * shared)
            state(i) = kept(i, in_v0) * kept(i, in_theta) * block%per_d_c(i)
        end do
        do i = 1, lanes   ! logarithms apart: their call needs the registers
            ln_state(i) = log(state(i))
        end do
        do i = 1, lanes
            block%x(i) = state_exponent(1.0_wp, kept(i, in_b) * per_a(i), kept(i, in_f0) &
                * per_a(i), ln_state(i))
            ln_k_half = rough_log(max(block%k_half(i), nothing))
            z = block%t(i) - block%x(i) + ln_k_half
            beyond = max(block%t(i) - most_t, block%x(i) - most_x, min(block%t(i) - block%x(i), &
                -ln_k_half) + max(ln_state(i), ln_largest) - most_rate, ln_k_half - block%x(i) &
                - most_k)
            y = block%t(i) - wright_omega(z)
            if (y < least_start) y = 0.0_wp
            if (beyond > 0.0_wp) left(i) = 1
            if (left(i) > 0) then
                block%t(i) = 0.0_wp
                block%x(i) = 0.0_wp
                block%k_half(i) = 0.0_wp
                y = 0.0_wp
            end if
            block%y(i) = y
        end do
    end subroutine prepare

    !> w with w + ln(w) = z, to 0.1: up to z = 20 a polynomial by least squares.
    elemental function wright_omega(z) result(w)
        real(wp), intent(in) :: z
        real(wp) :: w
        real(wp), parameter :: low = -3.0_wp
        real(wp) :: inner, outer

        inner = min(max(z, low), fast)
        outer = max(z, fast)
        w = 0.5968_wp + inner * (0.3838_wp + inner * (0.05949_wp + inner * (-3.019e-3_wp &
            + inner * 5.789e-5_wp)))
        if (z < low) w = 0.0_wp
        if (z > fast) w = outer - rough_log(outer - rough_log(outer))
    end function wright_omega

    !> ln(x) to 0.01: the exponent, and a parabola for what is left.
    elemental function rough_log(x) result(ln_x)
        real(wp), intent(in) :: x   !! > 0, not denormalised
        real(wp) :: ln_x
        integer(c_int64_t), parameter :: fraction = 2_c_int64_t**52 - 1
        real(wp), parameter :: whole = 2.0_wp**52   ! a number whose fraction is an integer
        real(wp) :: exponent, m   !! x = m*2^(exponent - 1023), 1 <= m < 2

        exponent = transfer(ior(shiftr(transfer(x, fraction), 52), transfer(whole, fraction)), x) &
            - whole
        m = transfer(ior(iand(transfer(x, fraction), fraction), transfer(1.0_wp, fraction)), x)
        ln_x = log(2.0_wp) * (exponent - 1023.0_wp) + (-1.1650_wp + m * (1.4056_wp - m &
            * 0.2357_wp))
    end function rough_log

    pure function least(y)
        real(wp), intent(in) :: y(lanes)
        real(wp) :: least
        integer :: i

        least = y(1)
        do i = 2, lanes
            least = min(least, y(i))
        end do
    end function least

    !> Householder's method of fourth order. sinh and cosh after a step d follow from those before
    !> it by the addition theorem, sinh(y + d) = sinh(y) cosh(d) + cosh(y) sinh(d), so that only the
    !> start takes exponentials. A point that has converged stays where it is while others go on.
    subroutine solve(kept, block, rates, left)
        real(wp), intent(in) :: kept(lanes, inputs)
        type(search_block), intent(inout) :: block
        real(wp), intent(inout) :: rates(lanes, 2)   !! out: v, the first
        integer(c_int), intent(inout) :: left(lanes)
        real(wp), parameter :: small = 1.0e-4_wp   !! the next error is below its fourth power
        real(wp), parameter :: sixth = 1.0_wp / 6.0_wp
        integer, parameter :: max_iterations = 12
        real(wp), dimension(lanes) :: growth, sinh_y, cosh_y, active   ! both times 2 e^-y
        real(wp) :: still, k, s, c, f, f1, d, cosh_d, sinh_d, before
        integer :: i, iteration

        call grow(block, growth, sinh_y)
        cosh_y = 2.0_wp - sinh_y
        active = 1.0_wp
        do iteration = 1, max_iterations
            still = 0.0_wp
            do i = 1, lanes
                k = block%k_half(i) * growth(i)
                s = k * sinh_y(i)
                c = k * cosh_y(i)
                f = (block%y(i) - block%t(i)) + s
                f1 = 1.0_wp + c
                d = -active(i) * f * (f1**2 - 0.5_wp * f * s) / (f1 * (f1**2 - f * s) + f**2 * c &
                    * sixth)
                cosh_d = cosh_of(d**2)
                sinh_d = d * sinhc_of(d**2)
                before = sinh_y(i)
                sinh_y(i) = before * cosh_d + cosh_y(i) * sinh_d
                cosh_y(i) = cosh_y(i) * cosh_d + before * sinh_d
                block%y(i) = block%y(i) + d
                if (abs(d) <= small) active(i) = 0.0_wp
                still = max(still, active(i))
            end do
            if (still <= 0.0_wp) exit
        end do
        do i = 1, lanes
            rates(i, 1) = slip_rate(kept(i, in_v0), growth(i), sinh_y(i))
            if (active(i) > 0.0_wp) left(i) = 1
        end do
    end subroutine solve

    !> cosh(d), and sinh(d)/d, for d up to 0.61: no start is further from its root. Where friction
    !> counts none is further than 0.5, and the series end below round-off; where it hardly does, t
    !> tells k sinh(y) whatever y is.
    elemental function cosh_of(square) result(cosh_d)
        real(wp), intent(in) :: square   !! d^2
        real(wp) :: cosh_d
        real(wp), parameter :: c2 = 1.0_wp / 2.0_wp, c4 = c2 / 12.0_wp, c6 = c4 / 30.0_wp, &
            c8 = c6 / 56.0_wp, c10 = c8 / 90.0_wp, c12 = c10 / 132.0_wp

        cosh_d = 1.0_wp + square * (c2 + square * (c4 + square * (c6 + square * (c8 + square &
            * (c10 + square * c12)))))
    end function cosh_of

    elemental function sinhc_of(square) result(sinhc)
        real(wp), intent(in) :: square   !! d^2
        real(wp) :: sinhc
        real(wp), parameter :: c2 = 1.0_wp / 6.0_wp, c4 = c2 / 20.0_wp, c6 = c4 / 42.0_wp, &
            c8 = c6 / 72.0_wp, c10 = c8 / 110.0_wp, c12 = c10 / 156.0_wp

        sinhc = 1.0_wp + square * (c2 + square * (c4 + square * (c6 + square * (c8 + square &
            * (c10 + square * c12)))))
    end function sinhc_of

    !> e^(y - x), and 1 - e^-2y.
    subroutine grow(block, growth, part)
        type(search_block), intent(in) :: block
        real(wp), intent(out) :: growth(lanes), part(lanes)
        real(wp) :: e_y(lanes)
        integer :: i

        do i = 1, lanes
            growth(i) = exp(block%y(i) - block%x(i))
        end do
        part = 1.0_wp
        if (least(block%y) > far) return
        do i = 1, lanes
            e_y(i) = exp(-block%y(i))
        end do
        do i = 1, lanes
            part(i) = decayed_part(block%y(i), e_y(i))
        end do
    end subroutine grow

    !> The rate of theta, from the slip rate.
    subroutine evolve(evolution, kept, block, rates)
        integer(c_int), intent(in) :: evolution
        real(wp), intent(in) :: kept(lanes, inputs)
        type(search_block), intent(in) :: block
        real(wp), intent(inout) :: rates(lanes, 2)   !! in: v
        real(wp), parameter :: nothing = 1.0e-300_wp
        real(wp), dimension(lanes) :: w, ln_w
        integer :: i

        do i = 1, lanes
            w(i) = rates(i, 1) * (kept(i, in_theta) * block%per_d_c(i))
        end do
        if (evolution == 0) then
            do i = 1, lanes
                rates(i, 2) = ageing_rate(w(i))
            end do
        else
            do i = 1, lanes
                ln_w(i) = log(max(w(i), nothing))
            end do
            do i = 1, lanes
                rates(i, 2) = slip_law_rate(w(i), ln_w(i))
            end do
        end if
    end subroutine evolve

end module friction_slip_rate_kernel
