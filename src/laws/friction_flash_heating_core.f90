!> The physics of flash heating (Rice 2006; Noda, Dunham and Rice 2009) on plain numbers: friction
!> in steady sliding falls from that of rate-and-state friction to f_w where asperities melt, beyond
!> the slip rate v_w,
!>
!>     f_ss = f_w + (f_LV - f_w) G,   G = (1 + (v/v_w)^n)^(-1/n)
!>
!> Over the direct effect a, and as a change of ln(theta) in steady sliding. A core uses nothing but
!> the kind of its numbers (src/CMakeLists.txt).
module friction_flash_heating_core
    use, intrinsic :: iso_fortran_env, only : wp => real64
    implicit none
    private

    public :: kept_share, steady_ratio, steady_ratio_slope, weak_part

    real(wp), parameter, public :: least_ratio = 1.0e-100_wp   !! of f_ss/a, which ends there

contains

    !> ln(1 + e^x)/n, so that G is e^- of it.
    elemental function kept_share(x, n) result(l)
        real(wp), intent(in) :: x   !! n ln(v/v_w)
        real(wp), intent(in) :: n   !! >= 1
        real(wp) :: l
        real(wp) :: t

        t = exp(-abs(x))
        l = (max(x, 0.0_wp) + 2.0_wp * atanh(t / (2.0_wp + t))) / n
    end function kept_share

    !> e^x/(1 + e^x) = -d(ln G)/d(ln v)
    elemental function weak_part(x) result(h)
        real(wp), intent(in) :: x   !! n ln(v/v_w)
        real(wp) :: h               !! 0 to 1
        real(wp) :: t

        t = exp(-abs(x))
        h = t / (1.0_wp + t)
        if (x > 0.0_wp) h = 1.0_wp / (1.0_wp + t)
    end function weak_part

    !> f_ss/a
    elemental function steady_ratio(y, w, g, lost) result(ratio)
        real(wp), intent(in) :: y      !! f_LV/a, >= 0
        real(wp), intent(in) :: w      !! f_w/a, >= 0
        real(wp), intent(in) :: g      !! G
        real(wp), intent(in) :: lost   !! 1 - G, without cancellation
        real(wp) :: ratio

        ratio = max(w * lost + y * g, least_ratio)
    end function steady_ratio

    !> Its derivative by ln(v).
    elemental function steady_ratio_slope(y, y_slope, w, g, h) result(slope)
        real(wp), intent(in) :: y, w, g
        real(wp), intent(in) :: y_slope   !! of y by ln(v)
        real(wp), intent(in) :: h         !! see `weak_part`
        real(wp) :: slope

        slope = g * (y_slope + h * (w - y))
    end function steady_ratio_slope

end module friction_flash_heating_core
