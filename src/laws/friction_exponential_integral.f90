!> The exponential integral E1 and its inverse.
!>
!>     E1(y) = integral from y to infinity of exp(-t)/t dt,   y > 0
!>
!> With y = -ln R it is minus the logarithmic integral of R, `li(R) = -E1(-ln R)`, which turns the
!> evolution of the similarity ratio into a straight line (docs/theory.md, section 8).
module friction_exponential_integral
    use friction_kinds, only : wp
    implicit none
    private

    public :: e1, inverse_e1

    real(wp), parameter :: euler_gamma = 0.57721566490153286_wp

    !> Below, the power series; above, the continued fraction.
    real(wp), parameter :: y_middle = 2.0_wp, e1_middle = 0.048900510708061120_wp

contains

    !> E1(y); relative error below 1e-14.
    pure function e1(y) result(v)
        real(wp), intent(in) :: y   !! > 0
        real(wp) :: v

        if (y < y_middle) then
            v = entire_part(y) - (log(y) + euler_gamma)
        else
            v = exp(-y) * scaled_e1(y)
        end if
    end function e1

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
                y = max(y + step, 0.5_wp * y)
                if (abs(step) <= small_step) exit
            end do
        end if
    end function inverse_e1

    !> E1(y) + ln y + gamma = y - y^2/(2 2!) + y^3/(3 3!) - ...
    pure function entire_part(y) result(ein)
        real(wp), intent(in) :: y   !! 0 to about 2
        real(wp) :: ein
        integer :: k
        !> Of -(-y)^(k+1): 1/((k + 1) (k + 1)!).
        real(wp), parameter :: c(0:23) = [(1.0_wp / ((k + 1) * gamma(k + 2.0_wp)), k = 0, 23)]
        real(wp), parameter :: y_few = 0.5_wp   !! the 15th term is below 1e-17 up to there
        real(wp) :: even, odd

        ! two short chains of operations in place of a long one
        even = 0.0_wp
        odd = 0.0_wp
        if (y > y_few) then
            do k = 22, 14, -2
                even = even * y**2 + c(k)
                odd = odd * y**2 + c(k + 1)
            end do
        end if
        do k = 12, 0, -2
            even = even * y**2 + c(k)
            odd = odd * y**2 + c(k + 1)
        end do
        ein = y * (even - y * odd)
    end function entire_part

    !> exp(y) E1(y) by its continued fraction 1/(y+1 - 1/(y+3 - 4/(y+5 - ...))).
    pure function scaled_e1(y) result(scaled)
        real(wp), intent(in) :: y   !! about 2 or more
        real(wp) :: scaled
        integer :: k

        scaled = 0.0_wp
        do k = 6 + int(85.0_wp / y), 1, -1
            scaled = k**2 / (y + 2 * k + 1 - scaled)
        end do
        scaled = 1.0_wp / (y + 1.0_wp - scaled)
    end function scaled_e1

end module friction_exponential_integral
