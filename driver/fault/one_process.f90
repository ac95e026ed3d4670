!> The processes that share a fault, where the build has no MPI: one. Module `processes` of
!> many_processes.f90 is the same for any number.
module processes
    use, intrinsic :: iso_fortran_env, only : dp => real64, int64
    use local_transpose, only : transpose_here
    implicit none
    private

    public :: lacks_mpi, team

    type :: team
        integer :: rank = 0        !! from 0
        integer :: members = 1
    contains
        procedure :: start, end, largest, largest_of_each, lowest, any_of, xor_of, share, gather
        procedure :: wait, prepare_transposes, transpose_rows, transpose_columns
    end type team

contains

    !> Is this one of several processes, which know nothing of each other?
    logical function lacks_mpi() result(yes)
        character(len=20), parameter :: names(2) = ['OMPI_COMM_WORLD_SIZE', 'PMI_SIZE            ']
        character(len=12) :: members
        integer :: i, status

        yes = .false.
        do i = 1, size(names)
            call get_environment_variable(trim(names(i)), members, status=status)
            yes = yes .or. (status == 0 .and. members /= '1')
        end do
    end function lacks_mpi

    subroutine start(self)
        class(team), intent(out) :: self

        self%rank = 0
    end subroutine start

    subroutine end(self)
        class(team), intent(inout) :: self

        self%members = 1
    end subroutine end

    !> The largest of all processes' numbers.
    real(dp) function largest(self, x) result(most)
        class(team), intent(in) :: self
        real(dp), intent(in) :: x

        most = x
    end function largest

    !> The same of each number of an array, in its place.
    subroutine largest_of_each(self, x)
        class(team), intent(in) :: self
        real(dp), intent(inout) :: x(:)

        if (self%members < 1) x = 0.0_dp   ! never: one process has the largest already
    end subroutine largest_of_each

    !> The lowest of all processes' whole numbers.
    integer(int64) function lowest(self, i) result(least)
        class(team), intent(in) :: self
        integer(int64), intent(in) :: i

        least = i
    end function lowest

    !> Exclusive or of all processes' words.
    integer(int64) function xor_of(self, bits) result(all_bits)
        class(team), intent(in) :: self
        integer(int64), intent(in) :: bits

        all_bits = bits
    end function xor_of

    logical function any_of(self, yes) result(any_one)
        class(team), intent(in) :: self
        logical, intent(in) :: yes

        any_one = yes
    end function any_of

    !> Gives the first process's numbers to all.
    subroutine share(self, x)
        class(team), intent(in) :: self
        real(dp), intent(inout) :: x(:)

        if (self%members < 1) x = 0.0_dp   ! never: all are the first
    end subroutine share

    !> Puts the parts of all processes one after the other, for each of them.
    subroutine gather(self, part, counts, whole)
        class(team), intent(in) :: self
        real(dp), intent(in) :: part(:)
        integer, intent(in) :: counts(:)       !! numbers of each process
        real(dp), intent(out) :: whole(:)

        whole = part
    end subroutine gather

    !> Until all have come here.
    subroutine wait(self)
        class(team), intent(in) :: self

        if (self%members < 1) return
    end subroutine wait

    !> A matrix of complex numbers, of which each process has a block of rows, is to be turned
    !> into one of which it has a block of columns, and back.
    subroutine prepare_transposes(self, rows, columns, room)
        class(team), intent(inout) :: self
        integer, intent(in) :: rows, columns
        integer(int64), intent(out) :: room    !! numbers that each of two buffers must hold

        room = int(rows, int64) * columns
    end subroutine prepare_transposes

    !> from(columns, own rows) to to(rows, own columns)
    subroutine transpose_rows(self, rows, columns, from, to)
        class(team), intent(in) :: self
        integer, intent(in) :: rows, columns
        complex(dp), intent(inout), contiguous :: from(:), to(:)

        if (self%members == 1) call transpose_here(columns, rows, from, to)
    end subroutine transpose_rows

    !> The way back.
    subroutine transpose_columns(self, rows, columns, from, to)
        class(team), intent(in) :: self
        integer, intent(in) :: rows, columns
        complex(dp), intent(inout), contiguous :: from(:), to(:)

        if (self%members == 1) call transpose_here(rows, columns, from, to)
    end subroutine transpose_columns

end module processes
