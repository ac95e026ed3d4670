!> What all surroundings of a plane have in common in which slip in one direction, x, depends on
!> both coordinates of the plane, and in which traction stays the same where all is moved along x.
!> Along x the sum over all cells is a convolution, done by Fourier transforms of at least twice the
!> length, the rest without slip: rows are transformed where they are, the matrix is transposed
!> among the processes, each wave number along x is left to the kind of surroundings, and all goes
!> back. Each row and each column is transformed by one and the same plan, so that the result does
!> not depend on which process has it.
module plane_medium
    use, intrinsic :: iso_c_binding, only : c_double_complex, c_int, c_ptr
    use, intrinsic :: iso_fortran_env, only : dp => real64, int64
    use fault_elasticity, only : elasticity, good_length, slab
    use fftw, only : fftw_backward, fftw_destroy_plan, fftw_estimate, fftw_execute_dft_c2r, &
        fftw_execute_dft_r2c, fftw_forward, fftw_plan_dft_1d, fftw_plan_dft_c2r_1d, &
        fftw_plan_dft_r2c_1d
    use processes, only : team
    implicit none
    private

    public :: plane_surroundings

    type, abstract, extends(elasticity) :: plane_surroundings
        type(slab) :: part
        real(dp) :: shear_modulus = 0.0_dp           !! [F/L^2]
        real(dp) :: poisson = 0.0_dp
        real(dp) :: dx = 0.0_dp, dz = 0.0_dp         !! size of a cell [L]
        integer :: length = 0                        !! of a row with its padding
        integer :: height = 0                        !! of a column with its padding
        integer :: own_waves = 0                     !! wave numbers along strike of this process
        type(c_ptr) :: column_forth, column_back     !! before -> column_waves -> after
        complex(c_double_complex), allocatable :: before(:), column_waves(:), after(:)
                                                     !! of a column; before: zero beyond the cells
        integer, private :: waves = 0                !! along strike, length/2 + 1
        integer, private :: first_wave = 0           !! of this process, from 0
        type(c_ptr), private :: row_forth, row_back
        real(dp), allocatable, private :: slip(:), traction(:)    !! of a row
        complex(c_double_complex), allocatable, private :: by_rows(:), by_columns(:)
    contains
        procedure :: create
        procedure :: apply
        procedure :: free
        procedure :: own_waves_of
        procedure(transform_interface), deferred :: transform_kernel
        procedure(convolve_interface), deferred :: convolve
    end type plane_surroundings

    abstract interface
        !> Makes ready what `convolve` needs: the kernel in wave numbers.
        subroutine transform_interface(self)
            import :: plane_surroundings
            implicit none
            class(plane_surroundings), intent(inout) :: self
        end subroutine transform_interface

        !> Traction along depth in place of slip, for one wave number along strike.
        subroutine convolve_interface(self, wave, column)
            import :: c_double_complex, plane_surroundings
            implicit none
            class(plane_surroundings), intent(inout) :: self
            integer, intent(in) :: wave                               !! of the own ones, from 1
            complex(c_double_complex), intent(inout) :: column(:)     !! of cells
        end subroutine convolve_interface
    end interface

contains

    subroutine create(self, together, part, elastic, dx, dz)
        class(plane_surroundings), intent(inout) :: self
        type(team), intent(inout) :: together
        type(slab), intent(in) :: part
        real(dp), intent(in) :: elastic(2)   !! shear modulus [F/L^2], Poisson's ratio
        real(dp), intent(in) :: dx, dz       !! size of a cell [L]
        integer(int64) :: room
        integer :: block

        self%part = part
        self%shear_modulus = elastic(1)
        self%poisson = elastic(2)
        self%dx = dx
        self%dz = dz
        self%length = good_length(2 * part%nx)
        self%height = good_length(2 * part%nz)
        self%waves = self%length / 2 + 1
        block = (self%waves + together%members - 1) / together%members
        self%first_wave = min(together%rank * block, self%waves)
        self%own_waves = min(block, self%waves - self%first_wave)
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
        call self%transform_kernel()
        self%slip = 0.0_dp
        self%before = (0.0_dp, 0.0_dp)
    end subroutine create

    !> Own wave numbers of a kernel that does not mind the sign of x, over the number of points of
    !> both transforms. Each process transforms all rows of its kernel.
    function own_waves_of(self, values) result(own)
        class(plane_surroundings), intent(inout) :: self
        real(dp), intent(in) :: values(0:)   !! 0 to length/2 cells away
        real(dp) :: own(self%own_waves)
        complex(c_double_complex) :: row_waves(self%waves)
        integer :: i

        do i = 0, self%length - 1
            self%slip(i + 1) = values(min(i, self%length - i)) / (real(self%length, dp) &
                * self%height)
        end do
        call fftw_execute_dft_r2c(self%row_forth, self%slip, row_waves)
        own = real(row_waves(self%first_wave + 1:self%first_wave + self%own_waves), dp)
    end function own_waves_of

    subroutine apply(self, together, slip, traction)
        class(plane_surroundings), intent(inout) :: self
        type(team), intent(in) :: together
        real(dp), intent(in) :: slip(:)
        real(dp), intent(out) :: traction(:)
        integer :: nx, nz, k

        nx = self%part%nx
        nz = self%part%nz
        do k = 1, self%part%rows
            self%slip(:nx) = slip((k - 1) * nx + 1:k * nx)
            call fftw_execute_dft_r2c(self%row_forth, self%slip, &
                self%by_rows((k - 1) * self%waves + 1:))
        end do
        call together%transpose_rows(nz, self%waves, self%by_rows, self%by_columns)
        do k = 1, self%own_waves
            call self%convolve(k, self%by_columns((k - 1) * nz + 1:k * nz))
        end do
        call together%transpose_columns(nz, self%waves, self%by_columns, self%by_rows)
        do k = 1, self%part%rows
            call fftw_execute_dft_c2r(self%row_back, self%by_rows((k - 1) * self%waves + 1:), &
                self%traction)
            traction((k - 1) * nx + 1:k * nx) = self%traction(:nx)
        end do
    end subroutine apply

    subroutine free(self)
        class(plane_surroundings), intent(inout) :: self

        call fftw_destroy_plan(self%row_forth)
        call fftw_destroy_plan(self%row_back)
        call fftw_destroy_plan(self%column_forth)
        call fftw_destroy_plan(self%column_back)
    end subroutine free

end module plane_medium
