!> A block of contact points in space from one point after another to one component after another,
!> and back, in vector lanes. Compiled once for each vector instruction set, as
!> `friction_batch_kernel` is.
module friction_points_kernel
    use, intrinsic :: iso_c_binding, only : c_double
    use friction_lane_block, only : apart, lanes
    implicit none
    private

    public :: to_components, to_points

    integer, parameter :: wp = c_double

contains

    !> Assignments one by one, here and below: of a loop over the components the compiler makes
    !> scalar ones, or picks one number of each vector.
    subroutine to_components(du, statev, du_block, statev_block) &
        bind(C, name='stickslip_points_kernel_in')
        real(wp), intent(in) :: du(3, lanes), statev(8, lanes)
        real(wp), intent(inout) :: du_block(apart, 3), statev_block(apart, 8)
        integer :: i

        do i = 1, lanes
            du_block(i, 1) = du(1, i)
            du_block(i, 2) = du(2, i)
            du_block(i, 3) = du(3, i)
        end do
        do i = 1, lanes
            statev_block(i, 1) = statev(1, i)
            statev_block(i, 2) = statev(2, i)
            statev_block(i, 3) = statev(3, i)
            statev_block(i, 4) = statev(4, i)
            statev_block(i, 5) = statev(5, i)
            statev_block(i, 6) = statev(6, i)
            statev_block(i, 7) = statev(7, i)
            statev_block(i, 8) = statev(8, i)
        end do
    end subroutine to_components

    subroutine to_points(statev_block, traction_block, tangent_block, statev, traction, tangent) &
        bind(C, name='stickslip_points_kernel_out')
        real(wp), intent(in) :: statev_block(apart, 8), traction_block(apart, 3)
        real(wp), intent(in) :: tangent_block(apart, 3, 3)   !! row, column
        real(wp), intent(inout) :: statev(8, lanes), traction(3, lanes)
        real(wp), intent(inout) :: tangent(3, 3, lanes)      !! column, row
        integer :: i

        do i = 1, lanes
            statev(1, i) = statev_block(i, 1)
            statev(2, i) = statev_block(i, 2)
            statev(3, i) = statev_block(i, 3)
            statev(4, i) = statev_block(i, 4)
            statev(5, i) = statev_block(i, 5)
            statev(6, i) = statev_block(i, 6)
            statev(7, i) = statev_block(i, 7)
            statev(8, i) = statev_block(i, 8)
        end do
        do i = 1, lanes
            traction(1, i) = traction_block(i, 1)
            traction(2, i) = traction_block(i, 2)
            traction(3, i) = traction_block(i, 3)
        end do
        do i = 1, lanes
            tangent(1, 1, i) = tangent_block(i, 1, 1)
            tangent(2, 1, i) = tangent_block(i, 1, 2)
            tangent(3, 1, i) = tangent_block(i, 1, 3)
            tangent(1, 2, i) = tangent_block(i, 2, 1)
            tangent(2, 2, i) = tangent_block(i, 2, 2)
            tangent(3, 2, i) = tangent_block(i, 2, 3)
            tangent(1, 3, i) = tangent_block(i, 3, 1)
            tangent(2, 3, i) = tangent_block(i, 3, 2)
            tangent(3, 3, i) = tangent_block(i, 3, 3)
        end do
    end subroutine to_points

end module friction_points_kernel
