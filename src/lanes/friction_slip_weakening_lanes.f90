!> Linear slip-weakening of a block of points.
module friction_slip_weakening_lanes
    use, intrinsic :: iso_fortran_env, only : wp => real64
    use friction_lane_block, only : c_cap, c_own, lanes, n_constants, no_cap, rest_block, &
        slide_block, unsure
    use friction_slip_weakening_core, only : coefficient_at, fall_at, slip_to_balance
    implicit none
    private

    public :: rest_slip_weakening, slide_slip_weakening, state_slip_weakening

    integer, parameter :: c_mu_s = c_own, c_mu_k = c_own + 1, c_d_c = c_own + 2

contains

    pure subroutine rest_slip_weakening(constants, block)
        real(wp), intent(in) :: constants(lanes, n_constants)
        type(rest_block), intent(inout) :: block
        integer :: i

        do i = 1, lanes
            block%r_rest(i) = block%r(i)
            block%mu_rest(i) = coefficient_at(block%r(i), constants(i, c_mu_s), &
                constants(i, c_mu_k), constants(i, c_d_c))
            block%strength(i) = block%mu_rest(i) * block%pressure(i)
            block%valid(i) = min(block%mu(i), block%r(i))
        end do
    end subroutine rest_slip_weakening

    pure subroutine slide_slip_weakening(constants, block)
        real(wp), intent(in) :: constants(lanes, n_constants)
        type(slide_block), intent(inout) :: block
        real(wp) :: mu_n, fall
        integer :: i

        do i = 1, block%n
            mu_n = coefficient_at(block%r(i), constants(i, c_mu_s), constants(i, c_mu_k), &
                constants(i, c_d_c))
            fall = fall_at(block%r(i), (constants(i, c_mu_s) - constants(i, c_mu_k)) &
                * block%pressure(i), constants(i, c_d_c))
            block%slip(i) = slip_to_balance(block%trial(i) - mu_n * block%pressure(i), &
                block%trial(i) - constants(i, c_mu_k) * block%pressure(i), block%stiffness(i), &
                fall)
            ! under a cap a contact softer than its law can meet it more than once
            block%left(i) = 0.0_wp
            if (constants(i, c_cap) < no_cap .and. fall >= block%stiffness(i)) then
                block%left(i) = 1.0_wp
            end if
        end do
        call state_slip_weakening(constants, block)
        do i = 1, block%n
            block%d_pressure(i) = block%mu_end(i)
            block%resistance(i) = block%mu_end(i) * block%pressure(i)
            block%d_slip(i) = -fall_at(block%r_end(i), (constants(i, c_mu_s) &
                - constants(i, c_mu_k)) * block%pressure(i), constants(i, c_d_c))
            if (abs(block%r_end(i) - constants(i, c_d_c)) < unsure * constants(i, c_d_c)) then
                block%left(i) = 1.0_wp   ! which side of the kink?
            end if
        end do
    end subroutine slide_slip_weakening

    !> mu and D after a given slip.
    pure subroutine state_slip_weakening(constants, block)
        real(wp), intent(in) :: constants(lanes, n_constants)
        type(slide_block), intent(inout) :: block   !! in: slip, out: mu_end, r_end
        integer :: i

        do i = 1, block%n
            block%r_end(i) = block%r(i) + block%slip(i)
            block%mu_end(i) = coefficient_at(block%r_end(i), constants(i, c_mu_s), &
                constants(i, c_mu_k), constants(i, c_d_c))
        end do
    end subroutine state_slip_weakening

end module friction_slip_weakening_lanes
