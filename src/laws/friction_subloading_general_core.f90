!> The arithmetic of the subloading law with U(R) = cot(pi R/2) or 1/R - 1 on plain numbers: what
!> both
!> the update of one point and the vector lanes of a batch are made of. A core uses nothing but the
!> kind of its numbers (src/CMakeLists.txt).
!>
!> Both are quotients U = above/below: of sin(pi (1 - R)/2) and sin(pi R/2), or of 1 - R and R. With
!> `bend` = pi/2 or 1, backward Euler's equation `(R - R_n) below = ms above` has the derivative
!> `(below^2 + bend ms)/below` where it holds.
module friction_subloading_general_core
    use, intrinsic :: iso_fortran_env, only : wp => real64
    implicit none
    private

    public :: reciprocal_root, ratio_gain, ratio_lack, start_slip

    real(wp), parameter, public :: half_pi = 1.57079632679489661923132169163975144_wp

contains

    !> The root of `R - R_n = ms (1/R - 1)`, a quadratic in R as in `e = 1 - R`, both without
    !> cancellation.
    elemental subroutine reciprocal_root(r_n, ms, r, e)
        real(wp), intent(in) :: r_n     !! R at the start of the increment [-]
        real(wp), intent(in) :: ms      !! m times the slip, >= 0 [-]
        real(wp), intent(out) :: r, e   !! R at its end, and 1 - R [-]
        real(wp) :: root, unit

        ! no hypot: glibc's vector function raises an overflow above the range of single precision
        unit = max(ms, 1.0_wp)
        root = unit * sqrt(((ms - r_n) / unit)**2 + 4.0_wp * (ms / unit) / unit)
        e = 2.0_wp * (1.0_wp - r_n) / ((1.0_wp - r_n) + (1.0_wp + ms) + root)
        r = 0.5_wp * ((r_n - ms) + root)
        if (ms > r_n) r = 2.0_wp * ms / max(abs(ms - r_n) + root, tiny(root))
        if (r > 0.5_wp) r = 1.0_wp - e   ! never above 1
    end subroutine reciprocal_root

    !> below/(below^2 + bend ms): d(R)/ds over m above, and what a step in R takes.
    elemental function ratio_gain(below, ms, bend) result(gain)
        real(wp), intent(in) :: below, ms, bend
        real(wp) :: gain
        real(wp), parameter :: least = 1.0e-80_wp   !! below R = 1e-40 the rate stays in range

        gain = below / (below**2 + bend * ms + least)
    end function ratio_gain

    !> What is missing in `(R - R_n) below = ms above`; near R = 1, 1 - R is the number that counts.
    elemental function ratio_lack(r, e, r_n, ms, above, below) result(lack)
        real(wp), intent(in) :: r, e   !! R and 1 - R [-]
        real(wp), intent(in) :: r_n, ms, above, below
        real(wp) :: lack
        real(wp) :: grown

        grown = r - r_n
        if (r >= 0.5_wp) grown = (1.0_wp - r_n) - e
        lack = ms * above - grown * below
    end function ratio_lack

    !> The slip for constant mu by the reciprocal, where R solves a quadratic equation; zero if it
    !> drowns in round-off.
    elemental function start_slip(m, r_n, full, trial, stiffness) result(s)
        real(wp), intent(in) :: m           !! of the law [1/L]
        real(wp), intent(in) :: r_n         !! R at the start of the increment [-]
        real(wp), intent(in) :: full        !! traction of the normal sliding surface [F/L^2]
        real(wp), intent(in) :: trial       !! tangential traction without slip [F/L^2]
        real(wp), intent(in) :: stiffness   !! tangential stiffness [F/L^3]
        real(wp) :: s                       !! >= 0 [L]
        real(wp) :: unit, a, b, c, root, r

        unit = 1.0_wp / (stiffness + m * (trial + full))   ! so that no square overflows
        a = (stiffness - m * full) * unit
        b = (m * (trial + full) - stiffness * r_n) * unit
        c = m * trial * unit
        root = sqrt(max(b**2 + 4.0_wp * a * c, 0.0_wp))
        r = 2.0_wp * c / max(abs(b) + root, tiny(root))
        if (b <= 0.0_wp) r = 0.5_wp * (root - b) / sign(max(abs(a), tiny(a)), a)
        s = max((trial - full * r) / stiffness, 0.0_wp)
    end function start_slip

end module friction_subloading_general_core
