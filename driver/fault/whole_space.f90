!> Slip in one direction, x, on a plane in a whole space. A unit of slip on a rectangle of cells
!> dx by dz changes the traction at the distance (x, z) of its centre by
!>
!>     K = G/(4 pi) sum of +- [-Z/((1 - nu) X r) - X/(Z r)],   X = x -+ dx/2, Z = z -+ dz/2
!>
!> over the four corners, r their distance. The sum over all cells is a convolution, done by Fourier
!> transforms of at least twice the size in both directions, the rest without slip: rows are
!> transformed where they are, the matrix is transposed among the processes, columns are padded and
!> transformed, and back. Each row and each column is transformed by one and the same plan, so that
!> the result does not depend on which process has it.
module whole_space
    use, intrinsic :: iso_c_binding, only : c_double_complex, c_int, c_ptr
    use, intrinsic :: iso_fortran_env, only : dp => real64, int64
    use fault_elasticity, only : elasticity, good_length, slab
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
        integer :: length = 0        !! of a row with its padding
        integer :: height = 0        !! of a column
        integer :: waves = 0         !! wave numbers along strike, length/2 + 1
        integer :: first_wave = 0    !! of this process, from 0
        integer :: own_waves = 0
        type(c_ptr) :: row_forth, row_back, column_forth, column_back
        real(dp), allocatable :: multiplier(:, :)     !! K: wave numbers in depth, own ones
        real(dp), allocatable :: slip(:), traction(:)             !! of a row
        complex(c_double_complex), allocatable :: before(:), column_waves(:), after(:)
                                                                  !! of a column
        complex(c_double_complex), allocatable :: by_rows(:), by_columns(:)
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
        integer :: block

        self%part = part
        self%length = good_length(2 * part%nx)
        self%height = good_length(2 * part%nz)
        self%waves = self%length / 2 + 1
        block = (self%waves + together%members - 1) / together%members
        self%first_wave = min(together%rank * block, self%waves)
        self%own_waves = min(block, self%waves - self%first_wave)
        self%self_stiffness = -whole_space_kernel(elastic(1), elastic(2), dx, dz, 0.0_dp, 0.0_dp)
        call together%prepare_transposes(part%nz, self%waves, room)
        allocate (self%slip(self%length), self%traction(self%length), self%before(self%height), &
            self%column_waves(self%height), self%after(self%height), self%by_rows(room), &
            self%by_columns(room))
        self%row_forth = fftw_plan_dft_r2c_1d(int(self%length, c_int), self%slip, self%by_rows, &
            fftw_estimate)
        self%row_back = fftw_plan_dft_c2r_1d(int(self%length, c_int), self%by_rows, &
            self%traction, fftw_estimate)
        self%column_forth = fftw_plan_dft_1d(int(self%height, c_int), self%before, &
            self%column_waves, fftw_forward, fftw_estimate)
        self%column_back = fftw_plan_dft_1d(int(self%height, c_int), self%column_waves, &
            self%after, fftw_backward, fftw_estimate)
        call self%transform_kernel(elastic, dx, dz)
        self%slip = 0.0_dp
        self%before = (0.0_dp, 0.0_dp)
    end subroutine create

    !> Each process transforms all rows of the kernel, and keeps its own wave numbers.
    subroutine transform_kernel(self, elastic, dx, dz)
        class(full_space), intent(inout) :: self
        real(dp), intent(in) :: elastic(2), dx, dz
        complex(c_double_complex), allocatable :: strip(:, :), row_waves(:)
        integer :: nz, i, k, around

        nz = self%part%nz
        allocate (strip(self%height, self%own_waves), self%multiplier(self%height, &
            self%own_waves), row_waves(self%waves))
        strip = (0.0_dp, 0.0_dp)
        do k = 0, nz - 1
            do i = 0, self%length - 1
                around = i
                if (2 * i > self%length) around = i - self%length
                self%slip(i + 1) = whole_space_kernel(elastic(1), elastic(2), dx, dz, &
                    around * dx, k * dz)
            end do
            call fftw_execute_dft_r2c(self%row_forth, self%slip, row_waves)
            strip(k + 1, :) = row_waves(self%first_wave + 1:self%first_wave + self%own_waves)
            if (k > 0) strip(self%height - k + 1, :) = strip(k + 1, :)
        end do
        do i = 1, self%own_waves
            self%before = strip(:, i)
            call fftw_execute_dft(self%column_forth, self%before, self%column_waves)
            self%multiplier(:, i) = real(self%column_waves, dp) / (real(self%length, dp) &
                * self%height)
        end do
    end subroutine transform_kernel

    subroutine apply(self, together, slip, traction)
        class(full_space), intent(inout) :: self
        type(team), intent(in) :: together
        real(dp), intent(in) :: slip(:)
        real(dp), intent(out) :: traction(:)
        integer :: nx, k

        nx = self%part%nx
        do k = 1, self%part%rows
            self%slip(:nx) = slip((k - 1) * nx + 1:k * nx)
            call fftw_execute_dft_r2c(self%row_forth, self%slip, &
                self%by_rows((k - 1) * self%waves + 1:))
        end do
        call together%transpose_rows(self%part%nz, self%waves, self%by_rows, self%by_columns)
        do k = 1, self%own_waves
            call convolve(self, k)
        end do
        call together%transpose_columns(self%part%nz, self%waves, self%by_columns, self%by_rows)
        do k = 1, self%part%rows
            call fftw_execute_dft_c2r(self%row_back, self%by_rows((k - 1) * self%waves + 1:), &
                self%traction)
            traction((k - 1) * nx + 1:k * nx) = self%traction(:nx)
        end do
    end subroutine apply

    !> One wave number along strike: the convolution in depth.
    subroutine convolve(self, k)
        type(full_space), intent(inout) :: self
        integer, intent(in) :: k
        integer :: nz, at

        nz = self%part%nz
        at = nz * (k - 1)
        self%before(:nz) = self%by_columns(at + 1:at + nz)
        call fftw_execute_dft(self%column_forth, self%before, self%column_waves)
        self%column_waves = self%column_waves * self%multiplier(:, k)
        call fftw_execute_dft(self%column_back, self%column_waves, self%after)
        self%by_columns(at + 1:at + nz) = self%after(:nz)
    end subroutine convolve

    subroutine free(self)
        class(full_space), intent(inout) :: self

        call fftw_destroy_plan(self%row_forth)
        call fftw_destroy_plan(self%row_back)
        call fftw_destroy_plan(self%column_forth)
        call fftw_destroy_plan(self%column_back)
    end subroutine free

end module whole_space
