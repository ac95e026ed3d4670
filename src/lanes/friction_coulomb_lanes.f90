!> Coulomb friction of a block of points.
module friction_coulomb_lanes
    use, intrinsic :: iso_fortran_env, only : wp => real64
    use friction_lane_block, only : c_own, lanes, n_constants, rest_block, slide_block
    implicit none
    private

    public :: rest_coulomb, slide_coulomb

    integer, parameter :: c_mu = c_own

contains

    pure subroutine rest_coulomb(constants, block)
        real(wp), intent(in) :: constants(lanes, n_constants)
        type(rest_block), intent(inout) :: block
        integer :: i

        do i = 1, lanes
            block%mu_rest(i) = constants(i, c_mu)
            block%r_rest(i) = 0.0_wp
            block%strength(i) = constants(i, c_mu) * block%pressure(i)
            block%valid(i) = min(block%mu(i), -abs(block%r(i)))
        end do
    end subroutine rest_coulomb

    pure subroutine slide_coulomb(constants, block)
        real(wp), intent(in) :: constants(lanes, n_constants)
        type(slide_block), intent(inout) :: block
        integer :: i

        do i = 1, block%n
            block%mu_end(i) = constants(i, c_mu)
            block%r_end(i) = 0.0_wp
            block%d_pressure(i) = constants(i, c_mu)
            block%d_slip(i) = 0.0_wp
            block%resistance(i) = constants(i, c_mu) * block%pressure(i)
            block%slip(i) = (block%trial(i) - block%resistance(i)) / block%stiffness(i)
            block%left(i) = 0.0_wp
        end do
    end subroutine slide_coulomb

end module friction_coulomb_lanes
