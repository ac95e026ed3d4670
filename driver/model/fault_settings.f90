!> What a run of the planar fault is told to do (docs/fault.md).
module fault_settings
    use, intrinsic :: iso_fortran_env, only : dp => real64, int64
    use grid_map, only : map_on_grid
    use unit_names, only : units
    implicit none
    private

    public :: fault_plan

    type :: fault_plan
        character(len=:), allocatable :: geometry   !! 'antiplane_half', 'half', 'whole'
        integer :: nx = 1, nz = 1                   !! cells along strike, in depth
        real(dp) :: length = 1.0_dp                 !! along strike; 1 for antiplane strain [L]
        real(dp) :: width = 0.0_dp                  !! in depth [L]
        real(dp) :: shear_modulus = 0.0_dp          !! [F/L^2]
        real(dp) :: poisson = 0.25_dp               !! Poisson's ratio; not used in antiplane strain
        real(dp) :: wave_speed = 0.0_dp             !! of shear waves [L/T]
        real(dp) :: plate_rate = 0.0_dp             !! slip rate that is imposed from afar [L/T]
        type(map_on_grid) :: constants              !! of friction, in the order of `props`; the
                                                    !! last quantity is the normal traction
        logical :: steady = .true.                  !! starts from sliding at the plate rate
        type(map_on_grid) :: initial                !! if not: traction [F/L^2], internal variable
        real(dp) :: t_end = 0.0_dp                  !! [T]
        real(dp) :: rtol = 1.0e-4_dp                !! error of a step, see docs/fault.md
        logical :: rate_state = .true.              !! the law: rate-and-state friction
        logical :: explicit = .true.                !! steps
        real(dp), allocatable :: station_x(:), station_z(:)   !! [L]
        real(dp) :: seismic_rate = 1.0e-3_dp        !! from which on slip is an event [L/T]
        real(dp) :: contours(2) = 0.0_dp            !! time between contours of slip, between and
                                                    !! during events; 0: none [T]
        integer :: interval = 1                     !! steps between two rows
        integer :: fields = 0                       !! steps between two frames of fields; 0: none
        real(dp) :: table_limit = 10.0_dp           !! that the files may take on disk [GB]
        type(units) :: units                        !! names for pictures
        real(dp) :: checkpoint = 60.0_dp            !! clock between two checkpoints [s]
        integer(int64) :: fingerprint = 0           !! another one for any input with other results
    contains
        procedure :: dx, dz, cell_area, damping, x_of, z_of, contour_stride
    end type fault_plan

contains

    pure function dx(self)
        class(fault_plan), intent(in) :: self
        real(dp) :: dx   !! size of a cell along strike [L]

        dx = self%length / self%nx
    end function dx

    pure function dz(self)
        class(fault_plan), intent(in) :: self
        real(dp) :: dz   !! in depth [L]

        dz = self%width / self%nz
    end function dz

    pure function cell_area(self) result(area)
        class(fault_plan), intent(in) :: self
        real(dp) :: area   !! [L^2], per unit of length in antiplane strain [L]

        area = self%dz()
        if (self%geometry /= 'antiplane_half') area = area * self%dx()
    end function cell_area

    !> Radiation damping, G/(2 c_s) [F T/L^3].
    pure real(dp) function damping(self)
        class(fault_plan), intent(in) :: self

        damping = 0.5_dp * self%shear_modulus / self%wave_speed
    end function damping

    !> Centre of a cell along strike, from the middle of the fault [L].
    elemental real(dp) function x_of(self, i) result(x)
        class(fault_plan), intent(in) :: self
        integer, intent(in) :: i   !! 1 to nx

        x = (i - 0.5_dp) * (self%length / self%nx) - 0.5_dp * self%length
    end function x_of

    !> Centre of a cell in depth, from the upper edge [L].
    elemental real(dp) function z_of(self, k) result(z)
        class(fault_plan), intent(in) :: self
        integer, intent(in) :: k   !! 1 to nz

        z = (k - 0.5_dp) * (self%width / self%nz)
    end function z_of

    !> Cells from one depth of a contour to the next: there are 200 depths at most.
    pure integer function contour_stride(self) result(stride)
        class(fault_plan), intent(in) :: self
        integer, parameter :: most_depths = 200

        stride = (self%nz + most_depths - 1) / most_depths
    end function contour_stride

end module fault_settings
