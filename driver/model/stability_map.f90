!> Where steady sliding is stable, over two keys of the input: a logarithmic grid, and the boundary
!> between its places.
module stability_map
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use linear_stability, only : analyse, critical_value, find_critical, stability
    use steady_sliding, only : sliding_case
    implicit none
    private

    public :: map_axis, map_stability, plane_map

    integer, parameter :: cells = 48       !! between the ends of an axis
    integer, parameter :: search = 24      !! steps of the search along a line of the grid

    !> A key, and the values that it takes.
    type :: map_axis
        character(len=:), allocatable :: name   !! group%key
        real(dp) :: range(2) = 0.0_dp           !! lowest and highest value, > 0
    contains
        procedure :: value_at
    end type map_axis

    type :: plane_map
        type(map_axis) :: axes(2)
        integer :: verdict(0:cells, 0:cells) = 0           !! of module linear_stability
        real(dp), dimension(0:cells, 0:cells) :: growth = 0.0_dp, frequency = 0.0_dp   !! [1/T]
        real(dp), allocatable :: boundary(:, :)   !! (value of a key, point); the frequency comes
                                                  !! third
    end type plane_map

contains

    !> The value at a place of the grid.
    pure real(dp) function value_at(self, i) result(value)
        class(map_axis), intent(in) :: self
        integer, intent(in) :: i   !! from 0

        value = self%range(1) * (self%range(2) / self%range(1))**(real(i, dp) / cells)
    end function value_at

    !> Fills the map of a case, which is given back as it was.
    subroutine map_stability(this, axes, map)
        type(sliding_case), intent(inout) :: this
        type(map_axis), intent(in) :: axes(2)   !! of keys that `this` knows
        type(plane_map), intent(out) :: map
        type(stability) :: result
        real(dp) :: before(2)
        integer :: i, j

        map%axes = axes
        before = [this%value_of(axes(1)%name), this%value_of(axes(2)%name)]
        allocate (map%boundary(3, 0))
        do i = 0, cells
            call this%set(axes(1)%name, axes(1)%value_at(i))
            call follow_line(this, map, 1)
            do j = 0, cells
                call this%set(axes(2)%name, axes(2)%value_at(j))
                call analyse(this, result)
                map%verdict(i, j) = result%verdict
                map%growth(i, j) = result%growth
                map%frequency(i, j) = result%frequency
            end do
        end do
        do j = 0, cells
            call this%set(axes(2)%name, axes(2)%value_at(j))
            call follow_line(this, map, 2)
        end do
        call this%set(axes(1)%name, before(1))
        call this%set(axes(2)%name, before(2))
    end subroutine map_stability

    !> Finds the boundary along the line on which one key has a value.
    subroutine follow_line(this, map, fixed)
        type(sliding_case), intent(inout) :: this
        type(plane_map), intent(inout) :: map
        integer, intent(in) :: fixed   !! 1 or 2
        type(critical_value), allocatable :: found(:)
        type(stability) :: result
        real(dp) :: point(2)
        integer :: i

        associate (axis => map%axes(3 - fixed))
            call find_critical(this, axis%name, axis%range, search, found)
            point(fixed) = this%value_of(map%axes(fixed)%name)
            do i = 1, size(found)
                point(3 - fixed) = found(i)%value
                call this%set(axis%name, found(i)%value)
                call analyse(this, result)
                map%boundary = reshape([map%boundary, point, result%frequency], [3, &
                    size(map%boundary, 2) + 1])
            end do
        end associate
    end subroutine follow_line

end module stability_map
