!> The arithmetic of static-kinetic decay on plain numbers: what both the update of one point and
!> the
!> vector lanes of a batch are made of. A core uses nothing but the kind of its numbers
!> (src/CMakeLists.txt).
module friction_static_kinetic_core
    use, intrinsic :: iso_fortran_env, only : wp => real64
    implicit none
    private

    public :: decay_per_slip, excess_after

contains

    !> d_c/dt, short of what would overflow: so fast a decay is a jump.
    elemental function decay_per_slip(d_c, dt) result(rate)
        real(wp), intent(in) :: d_c   !! decay, >= 0 [T/L]
        real(wp), intent(in) :: dt    !! > 0 [T]
        real(wp) :: rate              !! [1/L]
        real(wp), parameter :: fastest = 1.0e100_wp

        rate = fastest
        if (d_c < fastest * dt) rate = d_c / dt
    end function decay_per_slip

    !> What the coefficient is above mu_k after a slip.
    elemental function excess_after(mu_s, mu_k, rate, slip) result(excess)
        real(wp), intent(in) :: mu_s, mu_k   !! [-]
        real(wp), intent(in) :: rate         !! see `decay_per_slip` [1/L]
        real(wp), intent(in) :: slip         !! >= 0 [L]
        real(wp) :: excess                   !! [-]

        excess = (mu_s - mu_k) * exp(-rate * slip)
    end function excess_after

end module friction_static_kinetic_core
