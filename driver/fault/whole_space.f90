!> Slip in one direction, x, on a plane in a whole space. A unit of slip on a rectangle of cells
!> dx by dz changes the traction at the distance (x, z) of its centre by
!>
!>     K = G/(4 pi) sum of +- [-Z/((1 - nu) X r) - X/(Z r)],   X = x -+ dx/2, Z = z -+ dz/2
!>
!> over the four corners, r their distance. The sum over all cells is a convolution in depth, too.
module whole_space
    use, intrinsic :: iso_c_binding, only : c_double_complex
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use fftw, only : fftw_execute_dft
    use plane_medium, only : plane_surroundings
    implicit none
    private

    public :: full_space, whole_space_kernel

    real(dp), parameter :: pi = acos(-1.0_dp)

    type, extends(plane_surroundings) :: full_space
        real(dp), allocatable, private :: multiplier(:, :)   !! K: wave numbers in depth, own ones
    contains
        procedure :: transform_kernel
        procedure :: convolve
    end type full_space

contains

    !> Traction at (x, z) per unit of slip on a cell around (0, 0) [F/L^3].
    elemental real(dp) function whole_space_kernel(shear_modulus, poisson, dx, dz, x, z) result(k)
        real(dp), intent(in) :: shear_modulus, poisson
        real(dp), intent(in) :: dx, dz   !! size of the cell [L]
        real(dp), intent(in) :: x, z     !! never at an edge of the cell [L]

        k = shear_modulus / (4.0_dp * pi) * (corner(x + 0.5_dp * dx, z + 0.5_dp * dz) &
            - corner(x - 0.5_dp * dx, z + 0.5_dp * dz) - corner(x + 0.5_dp * dx, z - 0.5_dp * dz) &
            + corner(x - 0.5_dp * dx, z - 0.5_dp * dz))

    contains

        pure real(dp) function corner(xc, zc) result(share)
            real(dp), intent(in) :: xc, zc
            real(dp) :: r

            r = sqrt(xc**2 + zc**2)
            share = -zc / ((1.0_dp - poisson) * xc * r) - xc / (zc * r)
        end function corner

    end function whole_space_kernel

    subroutine transform_kernel(self)
        class(full_space), intent(inout) :: self
        real(dp) :: row(0:self%length / 2)
        integer :: i, k

        associate (nz => self%part%nz, height => self%height)
            self%self_stiffness = -whole_space_kernel(self%shear_modulus, self%poisson, self%dx, &
                self%dz, 0.0_dp, 0.0_dp)
            allocate (self%multiplier(height, self%own_waves))
            self%multiplier = 0.0_dp
            do k = 0, nz - 1
                row = whole_space_kernel(self%shear_modulus, self%poisson, self%dx, self%dz, &
                    [(i * self%dx, i = 0, self%length / 2)], k * self%dz)
                self%multiplier(k + 1, :) = self%own_waves_of(row)
                if (k > 0) self%multiplier(height - k + 1, :) = self%multiplier(k + 1, :)
            end do
            do i = 1, self%own_waves
                self%before = cmplx(self%multiplier(:, i), 0.0_dp, c_double_complex)
                call fftw_execute_dft(self%column_forth, self%before, self%column_waves)
                self%multiplier(:, i) = real(self%column_waves, dp)
            end do
        end associate
    end subroutine transform_kernel

    subroutine convolve(self, wave, column)
        class(full_space), intent(inout) :: self
        integer, intent(in) :: wave
        complex(c_double_complex), intent(inout) :: column(:)

        self%before(:size(column)) = column
        call fftw_execute_dft(self%column_forth, self%before, self%column_waves)
        self%column_waves = self%column_waves * self%multiplier(:, wave)
        call fftw_execute_dft(self%column_back, self%column_waves, self%after)
        column = self%after(:size(column))
    end subroutine convolve

end module whole_space
