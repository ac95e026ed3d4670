!> Slip in one direction, x, on a plane in a whole space. A unit of slip on a rectangle of cells
!> dx by dz changes the traction at the distance (x, z) of its centre by
!>
!>     K = G/(4 pi) sum of +- [-Z/((1 - nu) X r) - X/(Z r)],   X = x -+ dx/2, Z = z -+ dz/2
!>
!> over the four corners, r their distance. The sum over all cells is a convolution, done by Fourier
!> transforms of twice the size in both directions, the rest without slip: rows are transformed
!> where they are, the matrix is transposed among the processes, columns are padded and
!> transformed, and back. Each row and each column is transformed in one and the same place of
!> memory by one and the same plan, so that the result does not depend on which process has it.
module whole_space
    use, intrinsic :: iso_c_binding, only : c_double_complex, c_int, c_ptr
    use, intrinsic :: iso_fortran_env, only : dp => real64, int64
    use fault_elasticity, only : elasticity, slab
    use fftw, only : fftw_backward, fftw_destroy_plan, fftw_estimate, fftw_execute_dft, &
        fftw_execute_dft_c2r, fftw_execute_dft_r2c, fftw_forward, fftw_plan_dft_1d, &
        fftw_plan_dft_c2r_1d, fftw_plan_dft_r2c_1d
    use processes, only : team
    implicit none
    private

    public :: full_space, whole_space_kernel

    real(dp), parameter :: pi = acos(-1.0_dp)

    type, extends(elasticity) :: full_space
        private
        type(slab) :: part
        integer :: waves = 0         !! wave numbers along strike, nx + 1
        integer :: first_wave = 0    !! of this process, from 0
        integer :: own_waves = 0
        type(c_ptr) :: row_forth, row_back, column_forth, column_back
        real(dp), allocatable :: multiplier(:, :)     !! K: 2 nz wave numbers, own wave numbers
        real(dp), allocatable :: row(:)                             !! 2 nx
        complex(c_double_complex), allocatable :: row_waves(:)      !! nx + 1
        complex(c_double_complex), allocatable :: column(:)         !! 2 nz
        complex(c_double_complex), allocatable :: column_waves(:)   !! 2 nz
        real(dp), allocatable :: by_rows(:), by_columns(:)          !! pairs: complex numbers
    contains
        procedure :: create
        procedure :: apply
        procedure :: free
        procedure, private :: transform_kernel
    end type full_space

contains

    !> Traction at (x, z) per unit of slip on a cell around (0, 0).
    elemental function whole_space_kernel(shear_modulus, poisson, dx, dz, x, z) result(k)
        real(dp), intent(in) :: shear_modulus, poisson
        real(dp), intent(in) :: dx, dz   !! size of the cell [L]
        real(dp), intent(in) :: x, z     !! never at an edge of the cell [L]
        real(dp) :: k                    !! [F/L^3]

        k = shear_modulus / (4.0_dp * pi) * (corner(x + 0.5_dp * dx, z + 0.5_dp * dz) &
            - corner(x - 0.5_dp * dx, z + 0.5_dp * dz) - corner(x + 0.5_dp * dx, z - 0.5_dp * dz) &
            + corner(x - 0.5_dp * dx, z - 0.5_dp * dz))

    contains

        pure function corner(xc, zc) result(share)
            real(dp), intent(in) :: xc, zc
            real(dp) :: share
            real(dp) :: r

            r = sqrt(xc**2 + zc**2)
            share = -zc / ((1.0_dp - poisson) * xc * r) - xc / (zc * r)
        end function corner

    end function whole_space_kernel

    subroutine create(self, together, part, elastic, dx, dz)
        class(full_space), intent(inout) :: self
        type(team), intent(inout) :: together
        type(slab), intent(in) :: part
        real(dp), intent(in) :: elastic(2)   !! shear modulus [F/L^2], Poisson's ratio
        real(dp), intent(in) :: dx, dz       !! size of a cell [L]
        integer(int64) :: room
        integer :: block, nx, nz

        self%part = part
        nx = part%nx
        nz = part%nz
        self%waves = nx + 1
        block = (self%waves + together%members - 1) / together%members
        self%first_wave = min(together%rank * block, self%waves)
        self%own_waves = min(block, self%waves - self%first_wave)
        self%self_stiffness = -whole_space_kernel(elastic(1), elastic(2), dx, dz, 0.0_dp, 0.0_dp)
        allocate (self%row(2 * nx), self%row_waves(nx + 1), self%column(2 * nz), &
            self%column_waves(2 * nz))
        self%row_forth = fftw_plan_dft_r2c_1d(int(2 * nx, c_int), self%row, self%row_waves, &
            fftw_estimate)
        self%row_back = fftw_plan_dft_c2r_1d(int(2 * nx, c_int), self%row_waves, self%row, &
            fftw_estimate)
        self%column_forth = fftw_plan_dft_1d(int(2 * nz, c_int), self%column, self%column_waves, &
            fftw_forward, fftw_estimate)
        self%column_back = fftw_plan_dft_1d(int(2 * nz, c_int), self%column_waves, self%column, &
            fftw_backward, fftw_estimate)
        call together%prepare_transposes(nz, self%waves, room)
        allocate (self%by_rows(room), self%by_columns(room))
        call self%transform_kernel(elastic, dx, dz)
    end subroutine create

    !> Each process transforms all rows of the kernel, and keeps its own wave numbers.
    subroutine transform_kernel(self, elastic, dx, dz)
        class(full_space), intent(inout) :: self
        real(dp), intent(in) :: elastic(2), dx, dz
        complex(c_double_complex), allocatable :: strip(:, :)
        integer :: nx, nz, i, k, around

        nx = self%part%nx
        nz = self%part%nz
        allocate (strip(2 * nz, self%own_waves), self%multiplier(2 * nz, self%own_waves))
        do k = 0, nz
            do i = 0, 2 * nx - 1
                around = i
                if (i > nx) around = i - 2 * nx
                self%row(i + 1) = whole_space_kernel(elastic(1), elastic(2), dx, dz, around * dx, &
                    k * dz)
            end do
            call fftw_execute_dft_r2c(self%row_forth, self%row, self%row_waves)
            strip(k + 1, :) = self%row_waves(self%first_wave + 1:self%first_wave + self%own_waves)
            if (k > 0 .and. k < nz) strip(2 * nz - k + 1, :) = strip(k + 1, :)
        end do
        do i = 1, self%own_waves
            self%column = strip(:, i)
            call fftw_execute_dft(self%column_forth, self%column, self%column_waves)
            self%multiplier(:, i) = real(self%column_waves, dp) / (4.0_dp * nx * nz)
        end do
    end subroutine transform_kernel

    subroutine apply(self, together, slip, traction)
        class(full_space), intent(inout) :: self
        type(team), intent(in) :: together
        real(dp), intent(in) :: slip(:)
        real(dp), intent(out) :: traction(:)
        integer :: nx, k, at

        nx = self%part%nx
        do k = 1, self%part%rows
            self%row(:nx) = slip((k - 1) * nx + 1:k * nx)
            self%row(nx + 1:) = 0.0_dp
            call fftw_execute_dft_r2c(self%row_forth, self%row, self%row_waves)
            at = 2 * self%waves * (k - 1)
            call put_pairs(self%waves, self%row_waves, self%by_rows(at + 1:at + 2 * self%waves))
        end do
        call together%transpose_rows(self%part%nz, self%waves, self%by_rows, self%by_columns)
        do k = 1, self%own_waves
            call convolve(self, k)
        end do
        call together%transpose_columns(self%part%nz, self%waves, self%by_columns, self%by_rows)
        do k = 1, self%part%rows
            at = 2 * self%waves * (k - 1)
            call take_pairs(self%waves, self%by_rows(at + 1:at + 2 * self%waves), self%row_waves)
            call fftw_execute_dft_c2r(self%row_back, self%row_waves, self%row)
            traction((k - 1) * nx + 1:k * nx) = self%row(:nx)
        end do
    end subroutine apply

    !> One wave number along strike: the convolution in depth.
    subroutine convolve(self, k)
        type(full_space), intent(inout) :: self
        integer, intent(in) :: k
        integer :: nz, at

        nz = self%part%nz
        at = 2 * nz * (k - 1)
        call take_pairs(nz, self%by_columns(at + 1:at + 2 * nz), self%column(:nz))
        self%column(nz + 1:) = (0.0_dp, 0.0_dp)
        call fftw_execute_dft(self%column_forth, self%column, self%column_waves)
        self%column_waves = self%column_waves * self%multiplier(:, k)
        call fftw_execute_dft(self%column_back, self%column_waves, self%column)
        call put_pairs(nz, self%column(:nz), self%by_columns(at + 1:at + 2 * nz))
    end subroutine convolve

    pure subroutine put_pairs(n, numbers, pairs)
        integer, intent(in) :: n
        complex(c_double_complex), intent(in) :: numbers(n)
        real(dp), intent(out) :: pairs(2, n)

        pairs(1, :) = real(numbers, dp)
        pairs(2, :) = aimag(numbers)
    end subroutine put_pairs

    pure subroutine take_pairs(n, pairs, numbers)
        integer, intent(in) :: n
        real(dp), intent(in) :: pairs(2, n)
        complex(c_double_complex), intent(out) :: numbers(n)

        numbers = cmplx(pairs(1, :), pairs(2, :), c_double_complex)
    end subroutine take_pairs

    subroutine free(self)
        class(full_space), intent(inout) :: self

        call fftw_destroy_plan(self%row_forth)
        call fftw_destroy_plan(self%row_back)
        call fftw_destroy_plan(self%column_forth)
        call fftw_destroy_plan(self%column_back)
    end subroutine free

end module whole_space
