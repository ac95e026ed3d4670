!> What the surroundings of the fault answer to slip: traction K s, static. Each geometry is a type
!> of its own. Cells along strike come first; each process has a block of rows of cells, a row being
!> all cells of one depth.
module fault_elasticity
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use processes, only : team
    implicit none
    private

    public :: elasticity, good_length, slab

    !> Which rows of cells a process has.
    type :: slab
        integer :: nx = 1                    !! cells of a row
        integer :: nz = 0                    !! rows of all processes
        integer :: first = 1                 !! row of this process
        integer :: rows = 0                  !! of this process
        integer, allocatable :: counts(:)    !! rows of each process
    contains
        procedure :: divide, cells, row_sums, sum_of_rows
    end type slab

    type, abstract :: elasticity
        real(dp) :: self_stiffness = 0.0_dp   !! traction that a cell loses by a unit of its own
                                              !! slip [F/L^3]
    contains
        procedure(apply_interface), deferred :: apply
        procedure(free_interface), deferred :: free
    end type elasticity

    abstract interface
        !> Traction on this process's cells from the slip on all.
        subroutine apply_interface(self, together, slip, traction)
            import :: dp, elasticity, team
            implicit none
            class(elasticity), intent(inout) :: self
            type(team), intent(in) :: together
            real(dp), intent(in) :: slip(:)         !! on this process's cells [L]
            real(dp), intent(out) :: traction(:)    !! [F/L^2]
        end subroutine apply_interface

        subroutine free_interface(self)
            import :: elasticity
            implicit none
            class(elasticity), intent(inout) :: self
        end subroutine free_interface
    end interface

contains

    !> The least even length from `n` on that Fourier transforms take fast: no prime factor
    !> beyond 7.
    pure integer function good_length(n) result(length)
        integer, intent(in) :: n
        integer, parameter :: primes(4) = [2, 3, 5, 7]
        integer :: rest, i

        length = n + modulo(n, 2)
        do
            rest = length
            do i = 1, size(primes)
                do while (modulo(rest, primes(i)) == 0)
                    rest = rest / primes(i)
                end do
            end do
            if (rest == 1) return
            length = length + 2
        end do
    end function good_length

    !> Rows in blocks of one length but for the last ones, as FFTW's transposes want them.
    subroutine divide(self, nx, nz, together)
        class(slab), intent(out) :: self
        integer, intent(in) :: nx, nz
        type(team), intent(in) :: together
        integer :: block, i

        self%nx = nx
        self%nz = nz
        block = (nz + together%members - 1) / together%members
        self%counts = [(max(0, min(block, nz - (i - 1) * block)), i = 1, together%members)]
        self%first = min(together%rank * block, nz) + 1
        self%rows = self%counts(together%rank + 1)
    end subroutine divide

    pure integer function cells(self)
        class(slab), intent(in) :: self

        cells = self%nx * self%rows
    end function cells

    !> The sum over all cells of all processes, row after row: the same on any number of them.
    real(dp) function row_sums(self, together, values) result(total)
        class(slab), intent(in) :: self
        type(team), intent(in) :: together
        real(dp), intent(in) :: values(self%nx, self%rows)
        real(dp) :: own(self%rows)
        integer :: i, k

        do k = 1, self%rows
            own(k) = 0.0_dp
            do i = 1, self%nx
                own(k) = own(k) + values(i, k)
            end do
        end do
        total = self%sum_of_rows(together, own)
    end function row_sums

    !> The sum of a number of each row.
    real(dp) function sum_of_rows(self, together, own) result(total)
        class(slab), intent(in) :: self
        type(team), intent(in) :: together
        real(dp), intent(in) :: own(:)   !! of this process's rows
        real(dp) :: all_rows(self%nz)
        integer :: k

        call together%gather(own, self%counts, all_rows)
        total = 0.0_dp
        do k = 1, self%nz
            total = total + all_rows(k)
        end do
    end function sum_of_rows

end module fault_elasticity
