!> Slip along strike, x, on a vertical plane that cuts the free surface of a half space. A unit of
!> slip on a rectangle of cells dx by dz whose centre is in the depth z' changes the traction at the
!> depth z and the distance x along strike by
!>
!>     K(x, z, z') = K of a whole space at (x, z - z')
!>                 + G/(4 pi) sum of +- [A(X, Z) + z B(X, Z) + z^2 C(X, Z)],
!>     A = -X/(Z r) - (4 - 2 alpha) Z/(X r) - 2 (1 - 2 nu) X/(r + Z)^2,
!>     B = -4 alpha X/r^3,   C = 4 alpha X (2 r + Z)/(r^3 (r + Z)^2)
!>
!> over the corners of the cell's image above the surface, X = x -+ dx/2, Z = z + z' -+ dz/2, with
!> their distance r and alpha = 1/(2 (1 - nu)). That is G (du_x/dy + du_y/dx) at y = 0 of the
!> displacements of Okada (1992), tables 6 to 9 with the dip 90 degrees, without terms that cancel
!> in the sum.
!>
!> Of two cells, each acts on the other one's centre as the other does on its own, but for parts of
!> the order of the cells' size squared. Elastic energy and minimal residuals want a symmetric
!> matrix: it is the mean of both, in which z + z' = Z_0 and z^2 + z'^2 = Z_0^2 - 2 z z',
!>
!>     K = whole space + H_0(x, z + z') + z z' H_2(x, z + z'),
!>     H_0 = G/(4 pi) sum of +- [A + Z_0/2 B + Z_0^2/2 C],   H_2 = -G/(4 pi) sum of +- C,
!>
!> three sums that are convolutions or correlations in depth, done by Fourier transforms.
module strike_slip_half_space
    use, intrinsic :: iso_c_binding, only : c_double_complex
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use fftw, only : fftw_execute_dft
    use plane_medium, only : plane_surroundings
    use whole_space, only : whole_space_kernel
    implicit none
    private

    public :: half_space_kernel, vertical_half_space

    real(dp), parameter :: pi = acos(-1.0_dp)

    type, extends(plane_surroundings) :: vertical_half_space
        private
        real(dp), allocatable :: direct(:, :)         !! of a whole space: wave numbers in depth and
                                                      !! own ones along strike
        complex(c_double_complex), allocatable :: image(:, :)     !! H_0
        complex(c_double_complex), allocatable :: weighted(:, :)  !! H_2
        real(dp), allocatable :: depth(:)             !! of the cells' centres [L]
        complex(c_double_complex), allocatable :: slip_waves(:)   !! in depth
    contains
        procedure :: transform_kernel
        procedure :: convolve
    end type vertical_half_space

contains

    !> Traction at the depth `z` per unit of slip on a cell in the depth `z_slip`.
    elemental function half_space_kernel(shear_modulus, poisson, dx, dz, x, z, z_slip) result(k)
        real(dp), intent(in) :: shear_modulus, poisson
        real(dp), intent(in) :: dx, dz      !! size of the cell [L]
        real(dp), intent(in) :: x           !! from the cell's centre, never at its edge [L]
        real(dp), intent(in) :: z, z_slip   !! depths, z never that of an edge; > 0, >= dz/2 [L]
        real(dp) :: k                       !! [F/L^3]
        real(dp) :: shares(3)

        shares = image_shares(poisson, dx, dz, x, z + z_slip)
        k = whole_space_kernel(shear_modulus, poisson, dx, dz, x, z - z_slip) &
            + shear_modulus / (4.0_dp * pi) * (shares(1) + z * (shares(2) + z * shares(3)))
    end function half_space_kernel

    !> The sums of A, B and C over the corners of a cell's image.
    pure function image_shares(poisson, dx, dz, x, z) result(shares)
        real(dp), intent(in) :: poisson, dx, dz
        real(dp), intent(in) :: x, z   !! from the centre of the image [L]
        real(dp) :: shares(3)

        shares = corner(x + 0.5_dp * dx, z + 0.5_dp * dz) - corner(x - 0.5_dp * dx, &
            z + 0.5_dp * dz) - corner(x + 0.5_dp * dx, z - 0.5_dp * dz) + corner(x &
            - 0.5_dp * dx, z - 0.5_dp * dz)

    contains

        pure function corner(xc, zc) result(parts)
            real(dp), intent(in) :: xc, zc
            real(dp) :: parts(3)
            real(dp) :: r, alpha

            alpha = 0.5_dp / (1.0_dp - poisson)
            r = sqrt(xc**2 + zc**2)
            parts(1) = -xc / (zc * r) - (4.0_dp - 2.0_dp * alpha) * zc / (xc * r) &
                - 2.0_dp * (1.0_dp - 2.0_dp * poisson) * xc / (r + zc)**2
            parts(2) = -4.0_dp * alpha * xc / r**3
            parts(3) = 4.0_dp * alpha * xc * (2.0_dp * r + zc) / (r**3 * (r + zc)**2)
        end function corner

    end function image_shares

    subroutine transform_kernel(self)
        class(vertical_half_space), intent(inout) :: self
        real(dp), dimension(0:self%length / 2) :: row, weighted
        real(dp) :: own(self%own_waves)
        integer :: i, k

        associate (nz => self%part%nz, height => self%height)
            self%self_stiffness = -whole_space_kernel(self%shear_modulus, self%poisson, self%dx, &
                self%dz, 0.0_dp, 0.0_dp)
            self%depth = [((k - 0.5_dp) * self%dz, k = 1, nz)]
            allocate (self%direct(height, self%own_waves), self%image(height, self%own_waves), &
                self%weighted(height, self%own_waves), self%slip_waves(height))
            self%direct = 0.0_dp
            self%image = (0.0_dp, 0.0_dp)
            self%weighted = (0.0_dp, 0.0_dp)
            do k = 0, nz - 1
                row = whole_space_kernel(self%shear_modulus, self%poisson, self%dx, self%dz, &
                    [(i * self%dx, i = 0, self%length / 2)], k * self%dz)
                own = self%own_waves_of(row)
                self%direct(k + 1, :) = own
                if (k > 0) self%direct(height - k + 1, :) = own
            end do
            do k = 1, 2 * nz - 1
                do i = 0, self%length / 2
                    call image_kernel(self, i * self%dx, k * self%dz, row(i), weighted(i))
                end do
                self%image(k, :) = self%own_waves_of(row)
                self%weighted(k, :) = self%own_waves_of(weighted)
            end do
            do i = 1, self%own_waves
                self%before = self%direct(:, i)
                call fftw_execute_dft(self%column_forth, self%before, self%column_waves)
                self%direct(:, i) = real(self%column_waves, dp)
                self%before = self%image(:, i)
                call fftw_execute_dft(self%column_forth, self%before, self%image(:, i))
                self%before = self%weighted(:, i)
                call fftw_execute_dft(self%column_forth, self%before, self%weighted(:, i))
            end do
        end associate
    end subroutine transform_kernel

    !> H_0 and H_2.
    pure subroutine image_kernel(self, x, z, image, weighted)
        type(vertical_half_space), intent(in) :: self
        real(dp), intent(in) :: x, z               !! from the centre of the image [L]
        real(dp), intent(out) :: image, weighted   !! [F/L^3], [F/L^5]
        real(dp) :: shares(3)

        shares = self%shear_modulus / (4.0_dp * pi) * image_shares(self%poisson, self%dx, self%dz, &
            x, z)
        image = shares(1) + 0.5_dp * z * (shares(2) + z * shares(3))
        weighted = -shares(3)
    end subroutine image_kernel

    !> The correlation of an image with slip is the product with the transform of the reversed slip,
    !> which is that of slip at the negative wave number.
    subroutine convolve(self, wave, column)
        class(vertical_half_space), intent(inout) :: self
        integer, intent(in) :: wave
        complex(c_double_complex), intent(inout) :: column(:)
        integer :: nz, k, reversed

        nz = size(column)
        self%before(:nz) = column
        call fftw_execute_dft(self%column_forth, self%before, self%slip_waves)
        do k = 1, self%height
            reversed = merge(1, self%height + 2 - k, k == 1)
            self%column_waves(k) = self%direct(k, wave) * self%slip_waves(k) + product_of( &
                self%image(k, wave), self%slip_waves(reversed))
        end do
        self%before(:nz) = self%depth * column
        call fftw_execute_dft(self%column_back, self%column_waves, self%after)
        column = self%after(:nz)
        call fftw_execute_dft(self%column_forth, self%before, self%slip_waves)
        do k = 1, self%height
            reversed = merge(1, self%height + 2 - k, k == 1)
            self%column_waves(k) = product_of(self%weighted(k, wave), self%slip_waves(reversed))
        end do
        call fftw_execute_dft(self%column_back, self%column_waves, self%after)
        column = column + self%depth * self%after(:nz)
    end subroutine convolve

    !> In parts: a product of complex numbers minds infinite ones.
    elemental function product_of(a, b) result(ab)
        complex(c_double_complex), intent(in) :: a, b
        complex(c_double_complex) :: ab

        ab = cmplx(real(a, dp) * real(b, dp) - aimag(a) * aimag(b), real(a, dp) * aimag(b) &
            + aimag(a) * real(b, dp), c_double_complex)
    end function product_of

end module strike_slip_half_space
