!> How long explicit steps of a block that swings on springs may be. Longer ones amplify what the
!> tolerated error does not see.
module swing_bound
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use explicit_pairs, only : explicit_pair
    implicit none
    private

    public :: oscillation, oscillation_of

    !> How a block swings on springs.
    type :: oscillation
        real(dp) :: radian = huge(1.0_dp)   !! time of one; huge where it does not swing [T]
        real(dp) :: phase = 0.0_dp          !! what damping allows an explicit step [rad]
        logical :: decays = .false.         !! within a swing or two
    contains
        procedure :: longest_step
    end type oscillation

contains

    !> Of both pairs a radian or more of a damped swing goes well where that decays by at least half
    !> as fast as it should.
    pure function oscillation_of(mass, stiffness, damping) result(swings)
        real(dp), intent(in) :: mass        !! 0: it does not swing [F T^2/L]
        real(dp), intent(in) :: stiffness   !! of all its springs [F/L]
        real(dp), intent(in) :: damping     !! [F T/L]
        type(oscillation) :: swings
        real(dp), parameter :: one_radian = 3.0e-4_dp   !! damping ratio that allows this
        real(dp), parameter :: most_damped = 0.5_dp     !! stability is as on the real axis
        real(dp), parameter :: decaying = 3.0_dp        !! what decays is stable there
        real(dp) :: ratio

        if (.not. mass > 0.0_dp) return
        ratio = 0.5_dp * damping / sqrt(stiffness * mass)
        swings%radian = sqrt(mass / stiffness)
        swings%phase = (min(ratio, most_damped) / one_radian)**(1.0_dp / 7.0_dp)
        swings%decays = ratio > most_damped
        if (swings%decays) swings%phase = decaying
        if (ratio > 1.0_dp) swings%radian = swings%radian / (ratio + sqrt(ratio**2 - 1.0_dp))
    end function oscillation_of

    !> The longest explicit step that does not amplify the swings [T].
    pure function longest_step(self, pair) result(dt)
        class(oscillation), intent(in) :: self
        type(explicit_pair), intent(in) :: pair
        real(dp) :: dt

        dt = self%radian
        if (dt < huge(dt)) dt = dt * max(pair%neutral, self%phase)
    end function longest_step

end module swing_bound
