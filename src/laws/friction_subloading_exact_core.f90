!> The arithmetic of the subloading law integrated exactly for a constant slip rate, on plain
!> numbers
!> (docs/theory.md, section 8): what both the update of one point and the vector lanes of a batch
!> are
!> made of. A core uses nothing but the kind of its numbers (src/CMakeLists.txt).
module friction_subloading_exact_core
    use, intrinsic :: iso_fortran_env, only : wp => real64
    implicit none
    private

    public :: mean_of_decay, tilt_of_decay, exact_coefficient, exact_fall

contains

    !> The mean over 0 < t < 1 of t exp(-x t), minus the derivative of `mean_of_decay`; from a
    !> series
    !> where it would cancel.
    elemental function tilt_of_decay(x, decay) result(tilt)
        real(wp), intent(in) :: x       !! >= 0
        real(wp), intent(in) :: decay   !! exp(-x)
        real(wp) :: tilt
        real(wp), parameter :: x_series = 0.5_wp
        integer :: k
        !> Of (-x)^k: 1/(k! (k + 2)); the next term is below 1e-16 up to `x_series`.
        real(wp), parameter :: c(0:13) = [(1.0_wp / (gamma(k + 1.0_wp) * (k + 2)), k = 0, 13)]
        real(wp) :: even, odd, y, z

        ! two short chains of operations in place of a long one
        y = min(x, x_series)
        z = y * y
        even = c(0) + z * (c(2) + z * (c(4) + z * (c(6) + z * (c(8) + z * (c(10) + z * c(12))))))
        odd = c(1) + z * (c(3) + z * (c(5) + z * (c(7) + z * (c(9) + z * (c(11) + z * c(13))))))
        tilt = even - y * odd
        z = max(x, x_series)   ! lanes divide whether they need it or not
        if (x > x_series) tilt = ((1.0_wp - decay) / z - decay) / z
    end function tilt_of_decay

    !> The mean over 0 < t < 1 of exp(-x t): (1 - exp(-x))/x.
    elemental function mean_of_decay(x, tilt) result(mean)
        real(wp), intent(in) :: x      !! >= 0
        real(wp), intent(in) :: tilt   !! see above
        real(wp) :: mean

        mean = (1.0_wp + x * tilt) / (1.0_wp + x)
    end function mean_of_decay

    !> mu after a slip, within its bounds in spite of round-off.
    elemental function exact_coefficient(mu_n, mu_s, mu_k, healing, decay, mean) result(mu)
        real(wp), intent(in) :: mu_n      !! at the start of the increment [-]
        real(wp), intent(in) :: mu_s, mu_k
        real(wp), intent(in) :: healing   !! xi dt [-]
        real(wp), intent(in) :: decay, mean   !! of x = kappa s + xi dt
        real(wp) :: mu

        mu = mu_k + ((mu_n - mu_k) * decay + healing * (mu_s - mu_k) * mean)
        mu = min(max(mu, mu_k), mu_s)
    end function exact_coefficient

    !> -d(mu)/ds over kappa, which is never negative and shrinks with s.
    elemental function exact_fall(mu_n, mu_s, mu_k, healing, decay, tilt) result(fall)
        real(wp), intent(in) :: mu_n, mu_s, mu_k, healing, decay, tilt   !! as above
        real(wp) :: fall   !! [-]

        fall = (mu_n - mu_k) * decay + healing * (mu_s - mu_k) * tilt
    end function exact_fall

end module friction_subloading_exact_core
