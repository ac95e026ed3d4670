!> The physics of rate-and-state friction, regularised (Dieterich 1979, Ruina 1983, Rice et al.
!> 2001), on plain numbers:
!>
!>     mu = a asinh(v/(2 v0) e^x),   x = (f0 + b ln(v0 theta/d_c))/a
!>     ageing law:  theta_dot = 1 - w,          w = v theta/d_c
!>     slip law:    theta_dot = -w ln(w)
!>
!> The form of a core: elemental functions of numbers, without types, branches or state, so that a
!> compiler can inline them into a loop and turn that into vector instructions. Law (one point, an
!> increment) and vector kernel (many points) are wrappers of it and write no formula a second time.
!> A core uses nothing but the kind of its numbers: the build puts a copy of it into each copy of a
!> kernel (src/CMakeLists.txt).
module friction_rate_state_core
    use, intrinsic :: iso_fortran_env, only : wp => real64
    implicit none
    private

    public :: fall_of_mean, mean_growth, pressed_by, state_exponent, asinh_exp, slope_asinh_exp, &
        asinh_of, &
        slope_of, far, slip_rate, decayed_part, ageing_rate, slip_law_rate, mean_decay, &
        aged_state, aged_slope, slipped_slope

    real(wp), parameter :: ln_2 = 0.693147180559945309417232121458176568_wp
    real(wp), parameter :: far = 20.0_wp   !! beyond, asinh(e^u) is u + ln(2) to the last bit

contains

    !> x of the law: how strong the state makes the surface.
    elemental function state_exponent(a, b, f0, ln_state) result(x)
        real(wp), intent(in) :: a          !! direct effect, > 0 [-]
        real(wp), intent(in) :: b          !! evolution effect [-]
        real(wp), intent(in) :: f0         !! coefficient of steady sliding at v0 [-]
        real(wp), intent(in) :: ln_state   !! ln(v0 theta/d_c)
        real(wp) :: x

        x = (f0 + b * ln_state) / a
    end function state_exponent

    !> asinh(e^u) for every u: mu/a, if u = ln(v/(2 v0)) + x.
    elemental function asinh_exp(u) result(y)
        real(wp), intent(in) :: u
        real(wp) :: y

        y = asinh_of(u, exp(min(u, far)))
    end function asinh_exp

    !> The derivative of that.
    elemental function slope_asinh_exp(u) result(slope)
        real(wp), intent(in) :: u
        real(wp) :: slope   !! 0 to 1

        slope = slope_of(exp(min(u, far)))
    end function slope_asinh_exp

    !> The same two where both are needed.
    elemental function asinh_of(u, e_u) result(y)
        real(wp), intent(in) :: u
        real(wp), intent(in) :: e_u   !! e^u, for min(u, far)
        real(wp) :: y

        y = asinh(e_u)
        if (u > far) y = u + ln_2   ! the next term of the series is round-off
    end function asinh_of

    elemental function slope_of(e_u) result(slope)
        real(wp), intent(in) :: e_u   !! as above
        real(wp) :: slope

        slope = e_u / sqrt(1.0_wp + e_u * e_u)
    end function slope_of

    !> The law the other way round, v = 2 v0 e^-x sinh(y), for y = mu/a.
    elemental function slip_rate(v0, growth, part) result(v)
        real(wp), intent(in) :: v0       !! reference slip rate, > 0 [L/T]
        real(wp), intent(in) :: growth   !! e^(y - x)
        real(wp), intent(in) :: part     !! 1 - e^-2y, see `decayed_part`
        real(wp) :: v                    !! [L/T]

        v = v0 * growth * part
    end function slip_rate

    !> 1 - e^-2y without cancellation, for y >= 0 and given e^-y.
    elemental function decayed_part(y, e_y) result(part)
        real(wp), intent(in) :: y     !! >= 0
        real(wp), intent(in) :: e_y   !! e^-y
        real(wp) :: part              !! 0 to 1
        real(wp), parameter :: small = 0.5_wp   !! below it the series is exact to round-off
        real(wp), parameter :: c3 = 2.0_wp / 6.0_wp, c5 = c3 / 20.0_wp, c7 = c5 / 42.0_wp, &
            c9 = c7 / 72.0_wp, c11 = c9 / 110.0_wp, c13 = c11 / 156.0_wp   !! of 2 sinh(y)
        real(wp) :: z, twice_sinh

        z = y * y
        twice_sinh = y * (2.0_wp + z * (c3 + z * (c5 + z * (c7 + z * (c9 + z * (c11 + z * c13))))))
        part = merge(e_y * twice_sinh, 1.0_wp - e_y * e_y, y < small)
    end function decayed_part

    !> How fast theta ages.
    elemental function ageing_rate(w) result(rate)
        real(wp), intent(in) :: w   !! v theta/d_c, >= 0
        real(wp) :: rate            !! d(theta)/dt [-]

        rate = 1.0_wp - w
    end function ageing_rate

    !> How fast theta changes by slip alone.
    elemental function slip_law_rate(w, ln_w) result(rate)
        real(wp), intent(in) :: w      !! v theta/d_c, >= 0
        real(wp), intent(in) :: ln_w   !! its logarithm
        real(wp) :: rate               !! d(theta)/dt [-]

        rate = -w * ln_w
    end function slip_law_rate

    !> (1 - e^-x)/x: what is left on average of something that decays.
    elemental function mean_decay(x, left) result(mean)
        real(wp), intent(in) :: x      !! slip/d_c, >= 0
        real(wp), intent(in) :: left   !! e^-x
        real(wp) :: mean
        real(wp), parameter :: small = 0.5_wp   !! below it the series is exact to round-off
        real(wp), parameter :: c1 = 1.0_wp / 2.0_wp, c2 = c1 / 3.0_wp, c3 = c2 / 4.0_wp, &
            c4 = c3 / 5.0_wp, c5 = c4 / 6.0_wp, c6 = c5 / 7.0_wp, c7 = c6 / 8.0_wp, c8 = c7 / &
                9.0_wp, &
            c9 = c8 / 10.0_wp, c10 = c9 / 11.0_wp, c11 = c10 / 12.0_wp, c12 = c11 / 13.0_wp, &
            c13 = c12 / 14.0_wp, c14 = c13 / 15.0_wp
        real(wp) :: even, odd, y, z

        ! two short chains of operations in place of a long one
        y = min(x, small)
        z = y * y
        even = c2 + z * (c4 + z * (c6 + z * (c8 + z * (c10 + z * (c12 + z * c14)))))
        odd = c1 + z * (c3 + z * (c5 + z * (c7 + z * (c9 + z * (c11 + z * c13)))))
        mean = 1.0_wp + y * (y * even - odd)
        z = max(x, small)   ! lanes divide in any case; below, gfortran 14 knows it to be x
        if (x > small) mean = (1.0_wp - left) / z
    end function mean_decay

    !> theta after a slip by the ageing law, exact for a constant slip rate.
    elemental function aged_state(theta_n, dt, left, mean) result(theta)
        real(wp), intent(in) :: theta_n      !! at the start of the increment, > 0 [T]
        real(wp), intent(in) :: dt           !! > 0 [T]
        real(wp), intent(in) :: left, mean   !! e^-x and `mean_decay`
        real(wp) :: theta                    !! [T]

        theta = max(theta_n * left + dt * mean, tiny(theta))
    end function aged_state

    !> d(ln theta)/d(ln slip) of that.
    elemental function aged_slope(x, theta_n, dt, left, mean, theta) result(by_ln_slip)
        real(wp), intent(in) :: x, theta_n, dt, left, mean, theta
        real(wp) :: by_ln_slip

        by_ln_slip = (dt * (left - mean) - x * (theta_n * left)) / theta
    end function aged_slope

    !> The same by the slip law, where ln(theta) = ln(theta_n) + x mean pull.
    elemental function slipped_slope(x, left, mean, pull) result(by_ln_slip)
        real(wp), intent(in) :: x, left, mean
        real(wp), intent(in) :: pull   !! ln(dt/x) - ln(theta_n)
        real(wp) :: by_ln_slip

        by_ln_slip = x * (left * pull - mean)
    end function slipped_slope

    !> How much ln(theta) falls because the pressure changes (Linker and Dieterich).
    elemental function pressed_by(alpha_over_b, before, after) result(fall)
        real(wp), intent(in) :: alpha_over_b    !! [-]
        real(wp), intent(in) :: before, after   !! pressures, > 0 [F/L^2]
        real(wp) :: fall

        fall = alpha_over_b * log(after / before)
    end function pressed_by

    !> `mean_decay`, and minus its derivative, for x of either sign.
    elemental subroutine mean_growth(x, left, mean, fall)
        real(wp), intent(in) :: x       !! -200 or more
        real(wp), intent(in) :: left    !! e^-x
        real(wp), intent(out) :: mean   !! (1 - e^-x)/x
        real(wp), intent(out) :: fall   !! > 0
        real(wp) :: back, m, f   ! of the magnitude

        back = exp(-abs(x))
        m = mean_decay(abs(x), back)
        f = fall_of_mean(abs(x), back, m)
        mean = merge(left * m, m, x < 0.0_wp)   ! what decays backwards
        fall = merge(left * (m - f), f, x < 0.0_wp)
    end subroutine mean_growth

    !> Minus the derivative of `mean_decay` by x, 1/2 at x = 0; it shrinks with x.
    elemental function fall_of_mean(x, left, mean) result(fall)
        real(wp), intent(in) :: x      !! >= 0
        real(wp), intent(in) :: left   !! e^-x
        real(wp), intent(in) :: mean   !! (1 - e^-x)/x
        real(wp) :: fall
        real(wp), parameter :: small = 1.0e-3_wp   !! below, the series is exact to round-off
        real(wp) :: y

        y = min(x, small)   ! no powers of a large one, which overflow
        fall = 0.5_wp - y * (1.0_wp / 3.0_wp - y * (0.125_wp - y * (1.0_wp / 30.0_wp - y &
            / 144.0_wp)))
        y = max(x, small)   ! as in `mean_decay`
        if (x > small) fall = (mean - left) / y
    end function fall_of_mean

end module friction_rate_state_core
