!> The processes that share a fault, under MPI if it has started them; a program that was started by
!> hand is one process, and leaves MPI alone. Reductions are of numbers that do not depend on their
!> order: largest, lowest, gathered. Transposes are FFTW's.
module processes
    use, intrinsic :: ieee_exceptions, only : ieee_get_halting_mode, &
        ieee_set_halting_mode, ieee_usual
    use, intrinsic :: iso_c_binding, only : c_double_complex, c_intptr_t, c_ptr
    use, intrinsic :: iso_fortran_env, only : dp => real64, int64
    use fftw_mpi, only : fftw_destroy_plan, fftw_estimate, fftw_mpi_default_block, &
        fftw_mpi_init, fftw_mpi_local_size_many_transposed, fftw_mpi_plan_many_transpose
    use local_transpose, only : transpose_here
    use mpi_f08, only : mpi_allgatherv, mpi_allreduce, mpi_barrier, mpi_bcast, mpi_bxor, &
        mpi_comm_rank, mpi_comm_size, mpi_comm_world, mpi_double_precision, mpi_finalize, &
        mpi_init, mpi_integer8, mpi_logical, mpi_lor, mpi_max, mpi_min
    implicit none
    private

    public :: lacks_mpi, team

    type :: team
        integer :: rank = 0        !! from 0
        integer :: members = 1
        logical, private :: prepared = .false.
        type(c_ptr), private :: forth, back   !! plans of the transposes
    contains
        procedure :: start, end, largest, largest_of_each, lowest, any_of, xor_of, share, gather
        procedure :: wait, prepare_transposes, transpose_rows, transpose_columns
    end type team

    interface
        !> FFTW's own interface takes real numbers.
        subroutine exchange(plan, from, to) bind(C, name='fftw_mpi_execute_r2r')
            import :: c_double_complex, c_ptr
            implicit none
            type(c_ptr), value, intent(in) :: plan
            complex(c_double_complex), intent(inout) :: from(*), to(*)
        end subroutine exchange
    end interface

contains

    !> Is this one of several processes, which know nothing of each other?
    logical function lacks_mpi() result(yes)
        yes = .false.
    end function lacks_mpi

    subroutine start(self)
        class(team), intent(out) :: self
        logical :: traps(size(ieee_usual))   !! of a build with run-time checks

        if (.not. is_launched()) return
        call ieee_get_halting_mode(ieee_usual, traps)
        call ieee_set_halting_mode(ieee_usual, .false.)   ! what MPI loads may raise exceptions
        call mpi_init()
        call ieee_set_halting_mode(ieee_usual, traps)
        call mpi_comm_rank(mpi_comm_world, self%rank)
        call mpi_comm_size(mpi_comm_world, self%members)
        call fftw_mpi_init()
    end subroutine start

    subroutine end(self)
        class(team), intent(inout) :: self

        if (self%prepared) then
            call fftw_destroy_plan(self%forth)
            call fftw_destroy_plan(self%back)
        end if
        self%prepared = .false.
        if (is_launched()) call mpi_finalize()
    end subroutine end

    !> Has a launcher of MPI started this process? Their ways of telling so.
    logical function is_launched() result(yes)
        character(len=*), parameter :: names(6) = [character(len=20) :: 'OMPI_COMM_WORLD_SIZE', &
            'PMI_RANK', 'PMI_SIZE', 'PMIX_RANK', 'MPI_LOCALRANKID', 'SLURM_STEP_NUM_TASKS']
        integer :: i, status

        yes = .false.
        do i = 1, size(names)
            call get_environment_variable(trim(names(i)), status=status)
            yes = yes .or. status == 0
        end do
    end function is_launched

    !> The largest of all processes' numbers.
    real(dp) function largest(self, x) result(most)
        class(team), intent(in) :: self
        real(dp), intent(in) :: x

        most = x
        if (self%members > 1) call mpi_allreduce(x, most, 1, mpi_double_precision, mpi_max, &
            mpi_comm_world)
    end function largest

    !> The same of each number of an array, in its place.
    subroutine largest_of_each(self, x)
        class(team), intent(in) :: self
        real(dp), intent(inout) :: x(:)
        real(dp) :: most(size(x))

        if (self%members == 1) return
        call mpi_allreduce(x, most, size(x), mpi_double_precision, mpi_max, mpi_comm_world)
        x = most
    end subroutine largest_of_each

    !> The lowest of all processes' whole numbers.
    integer(int64) function lowest(self, i) result(least)
        class(team), intent(in) :: self
        integer(int64), intent(in) :: i

        least = i
        if (self%members > 1) call mpi_allreduce(i, least, 1, mpi_integer8, mpi_min, mpi_comm_world)
    end function lowest

    !> Exclusive or of all processes' words.
    integer(int64) function xor_of(self, bits) result(all_bits)
        class(team), intent(in) :: self
        integer(int64), intent(in) :: bits

        all_bits = bits
        if (self%members > 1) call mpi_allreduce(bits, all_bits, 1, mpi_integer8, mpi_bxor, &
            mpi_comm_world)
    end function xor_of

    logical function any_of(self, yes) result(any_one)
        class(team), intent(in) :: self
        logical, intent(in) :: yes

        any_one = yes
        if (self%members > 1) call mpi_allreduce(yes, any_one, 1, mpi_logical, mpi_lor, &
            mpi_comm_world)
    end function any_of

    !> Gives the first process's numbers to all.
    subroutine share(self, x)
        class(team), intent(in) :: self
        real(dp), intent(inout) :: x(:)

        if (self%members > 1) call mpi_bcast(x, size(x), mpi_double_precision, 0, mpi_comm_world)
    end subroutine share

    !> Puts the parts of all processes one after the other, for each of them.
    subroutine gather(self, part, counts, whole)
        class(team), intent(in) :: self
        real(dp), intent(in) :: part(:)
        integer, intent(in) :: counts(:)       !! numbers of each process
        real(dp), intent(out) :: whole(:)
        integer :: i

        if (self%members > 1) then
            call mpi_allgatherv(part, size(part), mpi_double_precision, whole, counts, &
                [(sum(counts(:i - 1)), i = 1, size(counts))], mpi_double_precision, mpi_comm_world)
        else
            whole = part
        end if
    end subroutine gather

    !> Until all have come here.
    subroutine wait(self)
        class(team), intent(in) :: self

        if (self%members > 1) call mpi_barrier(mpi_comm_world)
    end subroutine wait

    !> A matrix of complex numbers, of which each process has a block of rows, is to be turned
    !> into one of which it has a block of columns, and back. Blocks are FFTW's: all of
    !> ceiling(n/members) but for the last ones.
    subroutine prepare_transposes(self, rows, columns, room)
        class(team), intent(inout) :: self
        integer, intent(in) :: rows, columns
        integer(int64), intent(out) :: room    !! numbers that each of two buffers must hold
        integer(c_intptr_t) :: own_rows, first_row, own_columns, first_column
        real(dp), allocatable :: from(:), to(:)

        room = int(rows, int64) * columns
        if (self%members == 1) return
        room = fftw_mpi_local_size_many_transposed(2, [int(rows, c_intptr_t), &
            int(columns, c_intptr_t)], 2_c_intptr_t, fftw_mpi_default_block, &
            fftw_mpi_default_block, mpi_comm_world%mpi_val, own_rows, first_row, own_columns, &
            first_column)
        room = max(room, 2_int64 * rows * own_columns, 2_int64 * own_rows * columns, 2_int64)
        allocate (from(room), to(room))
        room = (room + 1) / 2
        self%forth = fftw_mpi_plan_many_transpose(int(rows, c_intptr_t), int(columns, &
            c_intptr_t), 2_c_intptr_t, fftw_mpi_default_block, fftw_mpi_default_block, from, to, &
            mpi_comm_world%mpi_val, fftw_estimate)
        self%back = fftw_mpi_plan_many_transpose(int(columns, c_intptr_t), int(rows, c_intptr_t), &
            2_c_intptr_t, fftw_mpi_default_block, fftw_mpi_default_block, to, from, &
            mpi_comm_world%mpi_val, fftw_estimate)
        self%prepared = .true.
    end subroutine prepare_transposes

    !> from(columns, own rows) to to(rows, own columns)
    subroutine transpose_rows(self, rows, columns, from, to)
        class(team), intent(in) :: self
        integer, intent(in) :: rows, columns
        complex(dp), intent(inout), contiguous :: from(:), to(:)

        if (self%members > 1) then
            call exchange(self%forth, from, to)
        else
            call transpose_here(columns, rows, from, to)
        end if
    end subroutine transpose_rows

    !> The way back.
    subroutine transpose_columns(self, rows, columns, from, to)
        class(team), intent(in) :: self
        integer, intent(in) :: rows, columns
        complex(dp), intent(inout), contiguous :: from(:), to(:)

        if (self%members > 1) then
            call exchange(self%back, from, to)
        else
            call transpose_here(rows, columns, from, to)
        end if
    end subroutine transpose_columns

end module processes
