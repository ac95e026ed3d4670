!> Antiplane slip on a vertical fault that cuts the free surface of a half space. With cells of
!> height D, one cell's slip of unit size changes the traction d cells away by
!>
!>     K(d) = G/(2 pi D) [1/(d - 1/2) - 1/(d + 1/2)]
!>
!> and its mirror image above the surface does the same. Slip is thus even about the surface, and
!> the sum over all cells is a product of cosine transforms (DCT-II and its inverse) of twice the
!> length, the second half without slip. A fault has few such cells: each process transforms all.
module antiplane_half_space
    use, intrinsic :: iso_c_binding, only : c_int, c_ptr
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use fault_elasticity, only : elasticity, slab
    use fftw, only : fftw_destroy_plan, fftw_estimate, fftw_execute_r2r, fftw_plan_r2r_1d, &
        fftw_redft00, fftw_redft01, fftw_redft10
    use processes, only : team
    implicit none
    private

    public :: antiplane_kernel, half_space

    real(dp), parameter :: pi = acos(-1.0_dp)

    type, extends(elasticity) :: half_space
        private
        type(slab) :: part
        type(c_ptr) :: forth, back
        real(dp), allocatable :: multiplier(:)            !! K in wave numbers
        real(dp), allocatable :: depth(:), wave(:)        !! before and behind a transform
    contains
        procedure :: create
        procedure :: apply
        procedure :: free
    end type half_space

contains

    !> Traction per unit of slip `d` cells away, without the image.
    elemental function antiplane_kernel(shear_modulus, height, d) result(k)
        real(dp), intent(in) :: shear_modulus, height
        integer, intent(in) :: d
        real(dp) :: k   !! [F/L^3]

        k = shear_modulus / (2.0_dp * pi * height) * (1.0_dp / (d - 0.5_dp) - 1.0_dp &
            / (d + 0.5_dp))
    end function antiplane_kernel

    subroutine create(self, part, shear_modulus, height)
        class(half_space), intent(inout) :: self
        type(slab), intent(in) :: part
        real(dp), intent(in) :: shear_modulus, height
        type(c_ptr) :: plan
        real(dp), allocatable :: distance(:), wave(:)
        integer :: n, d

        self%part = part
        self%self_stiffness = -antiplane_kernel(shear_modulus, height, 0)
        n = 2 * part%nz
        allocate (self%depth(n), self%wave(n), distance(n + 1), wave(n + 1))
        self%forth = fftw_plan_r2r_1d(int(n, c_int), self%depth, self%wave, fftw_redft10, &
            fftw_estimate)
        self%back = fftw_plan_r2r_1d(int(n, c_int), self%wave, self%depth, fftw_redft01, &
            fftw_estimate)
        plan = fftw_plan_r2r_1d(int(n + 1, c_int), distance, wave, fftw_redft00, fftw_estimate)
        distance = [(antiplane_kernel(shear_modulus, height, d), d = 0, n)]
        call fftw_execute_r2r(plan, distance, wave)
        call fftw_destroy_plan(plan)
        self%multiplier = wave(:n) / (2 * n)
    end subroutine create

    subroutine apply(self, together, slip, traction)
        class(half_space), intent(inout) :: self
        type(team), intent(in) :: together
        real(dp), intent(in) :: slip(:)
        real(dp), intent(out) :: traction(:)
        integer :: n

        n = self%part%nz
        call together%gather(slip, self%part%counts, self%depth(:n))
        self%depth(n + 1:) = 0.0_dp
        call fftw_execute_r2r(self%forth, self%depth, self%wave)
        self%wave = self%wave * self%multiplier
        call fftw_execute_r2r(self%back, self%wave, self%depth)
        traction = self%depth(self%part%first:self%part%first + self%part%rows - 1)
    end subroutine apply

    subroutine free(self)
        class(half_space), intent(inout) :: self

        call fftw_destroy_plan(self%forth)
        call fftw_destroy_plan(self%back)
    end subroutine free

end module antiplane_half_space
