!> The arithmetic of linear slip-weakening, healing or not, on plain numbers: what both the update
!> of one point and the vector lanes of a batch are made of. A core uses nothing but the kind of its
!> numbers (src/CMakeLists.txt).
module friction_slip_weakening_core
    use, intrinsic :: iso_fortran_env, only : wp => real64
    implicit none
    private

    public :: coefficient_at, fall_at, forgotten, remembered, slip_to_balance

contains

    !> mu after the slip d since the surface was fresh.
    elemental function coefficient_at(d, mu_s, mu_k, d_c) result(mu)
        real(wp), intent(in) :: d            !! >= 0 [L]
        real(wp), intent(in) :: mu_s, mu_k   !! [-]
        real(wp), intent(in) :: d_c          !! > 0 [L]
        real(wp) :: mu

        mu = mu_k
        if (d < d_c) mu = mu + (mu_s - mu_k) * ((d_c - d) / d_c)
    end function coefficient_at

    !> How fast the resistance falls with slip.
    elemental function fall_at(d, drop, d_c) result(fall)
        real(wp), intent(in) :: d      !! slip since the surface was fresh, >= 0 [L]
        real(wp), intent(in) :: drop   !! (mu_s - mu_k) p [F/L^2]
        real(wp), intent(in) :: d_c    !! > 0 [L]
        real(wp) :: fall               !! >= 0 [F/L^3]

        fall = 0.0_wp
        if (d < d_c) fall = drop / d_c
    end function fall_at

    !> The slip at which spring and surface balance: two straight lines, the lower of which counts.
    elemental function slip_to_balance(above_start, above_kinetic, stiffness, fall) result(slip)
        real(wp), intent(in) :: above_start     !! trial above the resistance without slip [F/L^2]
        real(wp), intent(in) :: above_kinetic   !! trial above mu_k p [F/L^2]
        real(wp), intent(in) :: stiffness       !! > 0 [F/L^3]
        real(wp), intent(in) :: fall            !! of the resistance with slip [F/L^3]
        real(wp) :: slip                        !! [L]
        real(wp) :: steeper

        slip = above_kinetic / stiffness
        ! lanes divide in any case; two numbers that differ do so by more than this
        steeper = max(stiffness - fall, 0.25_wp * epsilon(fall) * stiffness)
        if (stiffness > fall) slip = min(slip, above_start / steeper)
    end function slip_to_balance

    !> What healing leaves of D in an increment without slip. More than d_c, which a user may have
    !> set, counts as that.
    elemental function forgotten(d, d_c, left) result(d_left)
        real(wp), intent(in) :: d      !! at the start of the increment, >= 0 [L]
        real(wp), intent(in) :: d_c    !! > 0 [L]
        real(wp), intent(in) :: left   !! e^-y, y = xi dt
        real(wp) :: d_left             !! [L]

        d_left = min(d, d_c) * left
    end function forgotten

    !> D after a slip at a constant rate.
    elemental function remembered(d_left, by_slip, slip, d_c) result(d)
        real(wp), intent(in) :: d_left    !! see above [L]
        real(wp), intent(in) :: by_slip   !! what a unit of slip adds, (1 - e^-y)/y [-]
        real(wp), intent(in) :: slip      !! in the increment, >= 0 [L]
        real(wp), intent(in) :: d_c       !! > 0 [L]
        real(wp) :: d                     !! [L]

        d = min(d_left + by_slip * slip, d_c)
    end function remembered

end module friction_slip_weakening_core
