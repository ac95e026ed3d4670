!> Antiplane slip on a vertical fault that cuts the free surface of a half space. With cells of
!> height D, one cell's slip of unit size changes the traction d cells away by
!>
!>     K(d) = G/(2 pi D) [1/(d - 1/2) - 1/(d + 1/2)]
!>
!> and its mirror image above the surface does the same: cell j acts on cell i at the distances
!> i - j and i + j - 1. The first sum over all cells is a convolution of slip, the second one its
!> correlation with K. Both take one Fourier transform of the real slip, padded to twice its length:
!> with S that of slip, the traction is that of `direct` S + `image` conjg(S). A fault has few such
!> cells: each process transforms all.
module antiplane_half_space
    use, intrinsic :: iso_c_binding, only : c_double_complex, c_int, c_ptr
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use fault_elasticity, only : elasticity, good_length, slab
    use fftw, only : fftw_destroy_plan, fftw_estimate, fftw_execute_dft_c2r, &
        fftw_execute_dft_r2c, fftw_plan_dft_c2r_1d, fftw_plan_dft_r2c_1d
    use processes, only : team
    implicit none
    private

    public :: antiplane_kernel, half_space

    real(dp), parameter :: pi = acos(-1.0_dp)

    type, extends(elasticity) :: half_space
        private
        type(slab) :: part
        type(c_ptr) :: forth, back
        real(dp), allocatable :: direct(:)                      !! K in wave numbers
        complex(c_double_complex), allocatable :: image(:)      !! the same of the images
        real(dp), allocatable :: slip(:), traction(:)           !! padded: zero beyond the cells
        complex(c_double_complex), allocatable :: waves(:)
    contains
        procedure :: create
        procedure :: apply
        procedure :: free
    end type half_space

contains

    !> Traction per unit of slip `d` cells away, without the image [F/L^3].
    elemental real(dp) function antiplane_kernel(shear_modulus, height, d) result(k)
        real(dp), intent(in) :: shear_modulus, height
        integer, intent(in) :: d

        k = shear_modulus / (2.0_dp * pi * height) * (1.0_dp / (d - 0.5_dp) - 1.0_dp / (d + 0.5_dp))
    end function antiplane_kernel

    subroutine create(self, part, shear_modulus, height)
        class(half_space), intent(inout) :: self
        type(slab), intent(in) :: part
        real(dp), intent(in) :: shear_modulus, height
        integer :: n, length, d

        self%part = part
        self%self_stiffness = -antiplane_kernel(shear_modulus, height, 0)
        n = part%nz
        length = good_length(2 * n)
        allocate (self%slip(length), self%traction(length), self%waves(length / 2 + 1))
        self%forth = fftw_plan_dft_r2c_1d(int(length, c_int), self%slip, self%waves, fftw_estimate)
        self%back = fftw_plan_dft_c2r_1d(int(length, c_int), self%waves, self%traction, &
            fftw_estimate)
        self%traction = 0.0_dp
        do d = 0, n - 1
            self%traction(1 + d) = antiplane_kernel(shear_modulus, height, d) / length
            if (d > 0) self%traction(length + 1 - d) = self%traction(1 + d)
        end do
        call fftw_execute_dft_r2c(self%forth, self%traction, self%waves)
        self%direct = real(self%waves, dp)
        self%traction = 0.0_dp
        self%traction(:2 * n - 1) = [(antiplane_kernel(shear_modulus, height, d) / length, &
            d = 1, 2 * n - 1)]
        call fftw_execute_dft_r2c(self%forth, self%traction, self%waves)
        self%image = self%waves
        self%slip = 0.0_dp
    end subroutine create

    subroutine apply(self, together, slip, traction)
        class(half_space), intent(inout) :: self
        type(team), intent(in) :: together
        real(dp), intent(in) :: slip(:)
        real(dp), intent(out) :: traction(:)

        call together%gather(slip, self%part%counts, self%slip(:self%part%nz))
        call fftw_execute_dft_r2c(self%forth, self%slip, self%waves)
        call multiply(size(self%waves), self%direct, self%image, self%waves)
        call fftw_execute_dft_c2r(self%back, self%waves, self%traction)
        traction = self%traction(self%part%first:self%part%first + self%part%rows - 1)
    end subroutine apply

    pure subroutine multiply(n, direct, image, waves)
        integer, intent(in) :: n
        real(dp), intent(in) :: direct(n)
        complex(c_double_complex), intent(in) :: image(n)
        complex(c_double_complex), intent(inout) :: waves(n)
        real(dp) :: re, im, image_re, image_im
        integer :: k

        do k = 1, n   ! in parts: a product of complex numbers minds infinite ones
            re = real(waves(k), dp)
            im = aimag(waves(k))
            image_re = real(image(k), dp)
            image_im = aimag(image(k))
            waves(k) = cmplx((direct(k) + image_re) * re + image_im * im, &
                (direct(k) - image_re) * im + image_im * re, c_double_complex)
        end do
    end subroutine multiply

    subroutine free(self)
        class(half_space), intent(inout) :: self

        call fftw_destroy_plan(self%forth)
        call fftw_destroy_plan(self%back)
    end subroutine free

end module antiplane_half_space
