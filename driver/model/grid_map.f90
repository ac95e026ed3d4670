!> Quantities given at the nodes of a rectilinear grid: bilinear between them, constant beyond.
module grid_map
    use, intrinsic :: iso_fortran_env, only : dp => real64
    implicit none
    private

    public :: map_on_grid, nodes_up_to

    type :: map_on_grid
        real(dp), allocatable :: x(:), z(:)         !! nodes, increasing [L]
        real(dp), allocatable :: values(:, :, :)    !! quantity, place in x, place in z
    contains
        procedure :: at
    end type map_on_grid

contains

    !> All quantities of the map at a point.
    pure function at(self, x, z) result(values)
        class(map_on_grid), intent(in) :: self
        real(dp), intent(in) :: x, z   !! [L]
        real(dp), allocatable :: values(:)
        integer :: i, k
        real(dp) :: u, w

        call place(self%x, x, i, u)
        call place(self%z, z, k, w)
        values = self%values(:, i, k)
        if (u > 0.0_dp) values = values + u * (self%values(:, i + 1, k) - self%values(:, i, k))
        if (w > 0.0_dp) then
            values = values + w * (self%values(:, i, k + 1) - self%values(:, i, k))
            if (u > 0.0_dp) values = values + u * w * (self%values(:, i + 1, k + 1) &
                - self%values(:, i, k + 1) - self%values(:, i + 1, k) + self%values(:, i, k))
        end if
    end function at

    !> The node below, and the part of the way to the next.
    pure subroutine place(nodes, x, i, part)
        real(dp), intent(in) :: nodes(:), x
        integer, intent(out) :: i
        real(dp), intent(out) :: part

        i = max(1, nodes_up_to(nodes, x))
        part = 0.0_dp
        if (i < size(nodes)) part = max(0.0_dp, (x - nodes(i)) / (nodes(i + 1) - nodes(i)))
    end subroutine place

    !> How many nodes, which increase, are not beyond a place?
    pure integer function nodes_up_to(nodes, x) result(n)
        real(dp), intent(in) :: nodes(:), x
        integer :: beyond, middle

        n = 0
        beyond = size(nodes) + 1
        do while (beyond - n > 1)
            middle = n + (beyond - n) / 2
            if (nodes(middle) <= x) then
                n = middle
            else
                beyond = middle
            end if
        end do
    end function nodes_up_to

end module grid_map
