!> Static-kinetic decay of a block of points.
module friction_static_kinetic_lanes
    use, intrinsic :: iso_fortran_env, only : wp => real64
    use friction_lane_block, only : c_cap, c_own, lanes, n_constants, no_cap, rest_block, &
        slide_block
    use friction_static_kinetic_core, only : decay_per_slip, excess_after
    implicit none
    private

    public :: rest_static_kinetic, slide_static_kinetic, state_static_kinetic

    integer, parameter :: c_mu_s = c_own, c_mu_k = c_own + 1, c_d_c = c_own + 2

contains

    pure subroutine rest_static_kinetic(constants, block)
        real(wp), intent(in) :: constants(lanes, n_constants)
        type(rest_block), intent(inout) :: block
        integer :: i

        do i = 1, lanes
            block%mu_rest(i) = constants(i, c_mu_s)
            block%r_rest(i) = 0.0_wp
            block%strength(i) = constants(i, c_mu_s) * block%pressure(i)
            block%valid(i) = min(block%mu(i), -abs(block%r(i)))
        end do
    end subroutine rest_static_kinetic

    !> Newton's method from the right, where a concave equation lets it fall on the root without
    !> fail; a point that has settled stays where it is while others go on.
    pure subroutine slide_static_kinetic(constants, dt, block)
        real(wp), intent(in) :: constants(lanes, n_constants)
        real(wp), intent(in) :: dt   !! > 0 [T]
        type(slide_block), intent(inout) :: block
        integer, parameter :: max_iterations = 30
        real(wp), dimension(lanes) :: rate, drop
        real(wp) :: still, step, excess, fall
        integer :: i, iteration

        do i = 1, block%n
            rate(i) = decay_per_slip(constants(i, c_d_c), dt)
            drop(i) = (constants(i, c_mu_s) - constants(i, c_mu_k)) * block%pressure(i) * rate(i)
            block%slip(i) = (block%trial(i) - constants(i, c_mu_k) * block%pressure(i)) &
                / block%stiffness(i)
            block%left(i) = 1.0_wp
        end do
        do iteration = 1, max_iterations
            still = 0.0_wp
            do i = 1, block%n
                excess = excess_after(constants(i, c_mu_s), constants(i, c_mu_k), rate(i), &
                    block%slip(i))
                block%mu_end(i) = constants(i, c_mu_k) + excess
                block%d_slip(i) = -rate(i) * excess * block%pressure(i)
                fall = max(block%stiffness(i) + block%d_slip(i), &
                    epsilon(fall) * block%stiffness(i))
                step = (block%trial(i) - block%stiffness(i) * block%slip(i) - block%mu_end(i) &
                    * block%pressure(i)) / fall
                if (-step <= 4.0_wp * epsilon(step) * block%slip(i)) block%left(i) = 0.0_wp
                still = max(still, block%left(i))
                block%slip(i) = max(block%slip(i) + block%left(i) * step, 0.0_wp)
            end do
            if (still <= 0.0_wp) exit
        end do
        do i = 1, block%n
            block%d_pressure(i) = block%mu_end(i)
            block%resistance(i) = block%mu_end(i) * block%pressure(i)
            block%r_end(i) = 0.0_wp
            ! under a cap a contact softer than its law can meet it more than once
            if (constants(i, c_cap) < no_cap .and. drop(i) >= block%stiffness(i)) then
                block%left(i) = 1.0_wp
            end if
        end do
    end subroutine slide_static_kinetic

    !> mu after a given slip.
    pure subroutine state_static_kinetic(constants, dt, block)
        real(wp), intent(in) :: constants(lanes, n_constants)
        real(wp), intent(in) :: dt   !! > 0 [T]
        type(slide_block), intent(inout) :: block   !! in: slip, out: mu_end, r_end
        integer :: i

        do i = 1, block%n
            block%mu_end(i) = constants(i, c_mu_k) + excess_after(constants(i, c_mu_s), &
                constants(i, c_mu_k), decay_per_slip(constants(i, c_d_c), dt), block%slip(i))
            block%r_end(i) = 0.0_wp
        end do
    end subroutine state_static_kinetic

end module friction_static_kinetic_lanes
