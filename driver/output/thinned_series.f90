!> The rows of a time series that a picture needs: of each stretch of rows the one with the least
!> and the one with the largest force, and the one with the largest speed. When there is no room for
!> more, stretches become twice as long. So a picture has its peaks however long the run is.
module thinned_series
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use archive_file, only : archive
    implicit none
    private

    public :: thinned

    integer, parameter :: kept_rows = 3          !! of a stretch
    integer, parameter :: most_stretches = 10000

    type :: thinned
        integer :: columns = 0, force = 0, speed = 0   !! of the rows, and places of two of them
        integer :: stretch = kept_rows                 !! its rows
        integer :: count = 0                           !! rows kept of whole stretches
        integer :: filled = 0                          !! rows seen of the one under way
        real(dp), allocatable :: rows(:, :)            !! column, row; beyond `count` those of the
                                                       !! stretch under way
    contains
        procedure :: prepare, add, visit, kept
    end type thinned

contains

    pure subroutine prepare(self, columns, force, speed)
        class(thinned), intent(inout) :: self
        integer, intent(in) :: columns, force, speed

        self%columns = columns
        self%force = force
        self%speed = speed
        allocate (self%rows(columns, kept_rows * most_stretches + kept_rows + 1))
    end subroutine prepare

    !> Rows that are kept now.
    pure integer function kept(self) result(n)
        class(thinned), intent(in) :: self

        n = self%count + min(self%filled, kept_rows)
    end function kept

    pure subroutine add(self, row)
        class(thinned), intent(inout) :: self
        real(dp), intent(in) :: row(:)
        integer :: n

        n = self%kept() + 1
        self%rows(:, n) = row
        self%filled = self%filled + 1
        if (self%filled > kept_rows) call choose(self, self%count + 1, n, self%count)
        if (self%filled < self%stretch) return
        self%count = self%count + kept_rows
        self%filled = 0
        if (self%count < kept_rows * most_stretches) return
        do n = 1, most_stretches / 2   ! two stretches become one
            call choose(self, 2 * kept_rows * (n - 1) + 1, 2 * kept_rows * n, kept_rows * (n - 1))
        end do
        self%count = self%count / 2
        self%stretch = 2 * self%stretch
    end subroutine add

    !> Copies those of the rows `first` to `last` that matter most behind row `after`, in their
    !> order.
    pure subroutine choose(self, first, last, after)
        class(thinned), intent(inout) :: self
        integer, intent(in) :: first, last, after
        logical :: wanted(first:last)
        integer, allocatable :: chosen(:)
        integer :: i

        wanted = .false.
        associate (force => self%rows(self%force, first:last), &
            speed => abs(self%rows(self%speed, first:last)))
            wanted(first - 1 + maxloc(force, dim=1)) = .true.
            wanted(first - 1 + minloc(force, dim=1)) = .true.
            wanted(first - 1 + maxloc(speed, dim=1)) = .true.
        end associate
        do i = first, last   ! some may be the same
            if (count(wanted) < kept_rows) wanted(i) = .true.
        end do
        chosen = pack([(i, i = first, last)], wanted)
        self%rows(:, after + 1:after + size(chosen)) = self%rows(:, chosen)
    end subroutine choose

    !> Reads or writes what has to be kept for a run that is resumed.
    subroutine visit(self, file)
        class(thinned), intent(inout) :: self
        type(archive), intent(inout) :: file

        call file%visit(self%stretch, self%count, self%filled)
        call file%visit(self%rows(:, :self%kept()))
    end subroutine visit

end module thinned_series
