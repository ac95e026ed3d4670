!> What is prescribed of a contact point over time: segments, along which each direction's relative
!> displacement or traction moves linearly to a target.
module loading_path
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use unit_names, only : units
    implicit none
    private

    public :: path, point_run

    type :: path
        integer :: ndir = 3                        !! 2 or 3 directions, the first is normal
        integer :: cycles = 1                      !! how often the list of segments is run through
        real(dp), allocatable :: duration(:)       !! of the segments, >= 0 [T]
        integer, allocatable :: steps(:)           !! increments in them
        logical, allocatable :: by_traction(:, :)  !! (direction, segment); else by displacement
        real(dp), allocatable :: target(:, :)      !! at a segment's end; [F/L^2] or [L]
    contains
        procedure :: increments, starting_values
    end type path

    !> What the point mode is told to do.
    type :: point_run
        real(dp), allocatable :: props(:)   !! constants of the friction routine
        type(path) :: loading
        logical :: tangent = .false.        !! the CSV file shows the tangent
        type(units) :: units                !! that the numbers are in, for pictures
    end type point_run

contains

    !> How many increments are there in all? A real number: it may be more than can be counted.
    pure real(dp) function increments(self) result(n)
        class(path), intent(in) :: self

        n = real(self%cycles, dp) * sum(real(self%steps, dp))
    end function increments

    !> The prescribed values at the start of segment `i`: where the segment before it in time
    !> ended or, in a direction that it did not control in the same way, where the point is.
    pure function starting_values(self, i, first, displacement, traction) result(values)
        class(path), intent(in) :: self
        integer, intent(in) :: i                !! segment
        logical, intent(in) :: first            !! nothing has happened yet
        real(dp), intent(in) :: displacement(self%ndir)   !! of the point [L]
        real(dp), intent(in) :: traction(self%ndir)       !! that it carries [F/L^2]
        real(dp) :: values(self%ndir)
        integer :: before

        values = merge(traction, displacement, self%by_traction(:, i))
        if (first) return
        before = i - 1
        if (before == 0) before = size(self%duration)
        where (self%by_traction(:, i) .eqv. self%by_traction(:, before)) &
            values = self%target(:, before)
    end function starting_values

end module loading_path
