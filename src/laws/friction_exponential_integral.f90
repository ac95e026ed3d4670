!> The exponential integral E1 and its inverse.
!>
!>     E1(y) = integral from y to infinity of exp(-t)/t dt,   y > 0
!>
!> With y = -ln R it is minus the logarithmic integral of R, `li(R) = -E1(-ln R)`, which turns the
!> evolution of the similarity ratio into a straight line (docs/theory.md, section 8). Its elemental
!> functions are a core (src/CMakeLists.txt): they use nothing but the kind of their numbers.
module friction_exponential_integral
    use, intrinsic :: iso_fortran_env, only : wp => real64
    implicit none
    private

    public :: e1, e1_of, inverse_e1

    real(wp), parameter :: euler_gamma = 0.57721566490153286_wp

    !> Below, the power series; above, a polynomial.
    real(wp), parameter :: y_middle = 2.0_wp, e1_middle = 0.048900510708061120_wp

contains

    !> E1(y); relative error below 2e-14, next to y = 2, where terms of 1.3 leave 0.05.
    elemental function e1(y) result(v)
        real(wp), intent(in) :: y   !! > 0
        real(wp) :: v

        if (y < y_middle) then
            v = entire_part(y) - (log(y) + euler_gamma)
        else
            v = exp(-y) * scaled_e1(y)
        end if
    end function e1

    !> The same from y, ln(y) and exp(-y), without a branch: for vector lanes.
    elemental function e1_of(y, log_y, exp_y) result(v)
        real(wp), intent(in) :: y, log_y, exp_y
        real(wp) :: v

        v = exp_y * scaled_e1(max(y, y_middle))
        if (y < y_middle) v = entire_part(min(y, y_middle)) - (log_y + euler_gamma)
    end function e1_of

    !> The y at which E1(y) = v, by Newton's method: in ln y on E1, which is convex, from the left,
    !> or, for small v, in y on ln E1, which is almost straight.
    pure function inverse_e1(v) result(y)
        real(wp), intent(in) :: v   !! > 0
        real(wp) :: y
        real(wp), parameter :: v_large = 40.0_wp   !! beyond, E1(y) = -gamma - ln y to round-off
        real(wp), parameter :: small_step = 1.0e-8_wp   !! the next error is its square
        integer, parameter :: max_iterations = 60
        real(wp) :: log_v, log_y, scaled, step
        integer :: iteration

        if (v > e1_middle) then
            log_y = -(v + euler_gamma)
            y = exp(log_y)
            if (v > v_large) return
            do iteration = 1, max_iterations
                step = (entire_part(y) - (log_y + (v + euler_gamma))) * exp(y)
                log_y = log_y + step
                y = exp(log_y)
                if (abs(step) <= small_step) exit
            end do
        else
            log_v = log(v)
            y = max(y_middle, -log_v - log(1.0_wp - log_v))
            do iteration = 1, max_iterations
                scaled = scaled_e1(y)
                step = (log(scaled) - (y + log_v)) * y * scaled
                y = y + step
                if (abs(step) <= small_step) exit
            end do
        end if
    end function inverse_e1

    !> E1(y) + ln y + gamma = y - y^2/(2 2!) + y^3/(3 3!) - ...
    elemental function entire_part(y) result(ein)
        real(wp), intent(in) :: y   !! 0 to about 2
        real(wp) :: ein
        integer :: k
        !> Of -(-y)^(k+1): 1/((k + 1) (k + 1)!); the next term is below 1e-15 of E1 up to y = 2.
        real(wp), parameter :: c(0:21) = [(1.0_wp / ((k + 1) * gamma(k + 2.0_wp)), k = 0, 21)]
        real(wp) :: even, odd, z

        ! two short chains of operations in place of a long one
        z = y * y
        even = c(0) + z * (c(2) + z * (c(4) + z * (c(6) + z * (c(8) + z * (c(10) + z * (c(12) + &
            z * (c(14) + z * (c(16) + z * (c(18) + z * c(20))))))))))
        odd = c(1) + z * (c(3) + z * (c(5) + z * (c(7) + z * (c(9) + z * (c(11) + z * (c(13) + z &
            * (c(15) + z * (c(17) + z * (c(19) + z * c(21))))))))))
        ein = y * (even - y * odd)
    end function entire_part

    !> exp(y) E1(y): a polynomial in t = (y - 7)/(y + 3), -1 to 1, interpolates y exp(y) E1(y) where
    !> Chebyshev's polynomials tell, and is off by less than 1e-17.
    elemental function scaled_e1(y) result(scaled)
        real(wp), intent(in) :: y   !! 2 or more
        real(wp) :: scaled
        real(wp), parameter :: c(0:23) = [ &
            0.88648767253642935382_wp, 0.13128768613062116306_wp, &
            -0.023076222241777831799_wp, 0.0066995889438342077292_wp, &
            -0.0018636252889425294684_wp, 0.0006074517046850598512_wp, &
            -0.00019305535689789630172_wp, 0.000067126469250894355054_wp, &
            -0.000022780265261149659654_wp, 8.2627823751996396689e-6_wp, &
            -2.9140157412179680269e-6_wp, 1.0903658059376090094e-6_wp, &
            -3.937172729330981897e-7_wp, 1.510910828671065481e-7_wp, &
            -5.544414010048656981e-8_wp, 2.1901043893731931035e-8_wp, &
            -7.8357022127630550416e-9_wp, 3.0309281698380869413e-9_wp, &
            -1.3502786971389233003e-9_wp, 6.7487966728845718621e-10_wp, &
            -6.9548662271884016476e-11_wp, -2.4920232674308866598e-11_wp, &
            -6.2643537233776607337e-11_wp, 4.2190587178408989021e-11_wp]
        real(wp) :: t, z, even, odd

        t = (y - 7.0_wp) / (y + 3.0_wp)
        z = t * t
        even = c(0) + z * (c(2) + z * (c(4) + z * (c(6) + z * (c(8) + z * (c(10) + z * (c(12) + &
            z * (c(14) + z * (c(16) + z * (c(18) + z * (c(20) + z * c(22)))))))))))
        odd = c(1) + z * (c(3) + z * (c(5) + z * (c(7) + z * (c(9) + z * (c(11) + z * (c(13) + z &
            * (c(15) + z * (c(17) + z * (c(19) + z * (c(21) + z * c(23)))))))))))
        scaled = (even + t * odd) / y
    end function scaled_e1

end module friction_exponential_integral
