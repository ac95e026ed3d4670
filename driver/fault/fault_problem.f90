!> A fault on this process: its cells with their constants, what holds them, and how it starts.
module fault_problem
    use, intrinsic :: iso_fortran_env, only : dp => real64, int64
    use antiplane_half_space, only : half_space
    use fault_elasticity, only : elasticity, slab
    use fault_energy, only : energies, power_loading, power_radiated, power_slip
    use fault_settings, only : fault_plan
    use friction_mod, only : read_surface, sliding_surface
    use plane_medium, only : plane_surroundings
    use processes, only : team
    use strike_slip_half_space, only : vertical_half_space
    use whole_space, only : full_space
    implicit none
    private

    public :: fault, fault_state, step_start

    type :: fault
        type(fault_plan) :: plan
        type(slab) :: part
        class(elasticity), allocatable :: surroundings
        integer :: n = 0                               !! cells of this process
        real(dp) :: damping = 0.0_dp                   !! [F T/L^3]
        real(dp), allocatable :: props(:, :)           !! cell, constant
        real(dp), allocatable :: pressure(:)           !! [F/L^2]
        real(dp), allocatable :: prestress(:)          !! traction without any slip deficit [F/L^2]
        real(dp), allocatable :: slip_scale(:)         !! over which friction evolves [L]
        real(dp) :: cohesive_length = huge(1.0_dp)     !! least of all cells [L]
    contains
        procedure :: create, tractions, cell_of, add_powers, elastic_energy
    end type fault

    !> Where the fault is.
    type :: fault_state
        real(dp) :: time = 0.0_dp              !! [T]
        real(dp) :: dt = 0.0_dp                !! of the next step [T]
        real(dp) :: error = 1.0e-4_dp          !! of the last step, in parts of the tolerance
        integer(int64) :: steps = 0, rejected = 0
        type(energies) :: energy               !! so far
        real(dp), allocatable :: slip(:)       !! [L]
        real(dp), allocatable :: rate(:)       !! of slip [L/T]
        real(dp), allocatable :: traction(:)   !! that friction carries [F/L^2]
        real(dp), allocatable :: memory(:)     !! internal variable of the law; of rate-and-state
                                               !! friction its logarithm
    end type fault_state

    !> Where a step began.
    type :: step_start
        real(dp) :: time = 0.0_dp
        real(dp), allocatable :: slip(:), rate(:)
    contains
        procedure :: slip_at
    end type step_start

contains

    !> Slip at a time within a step, by the cubic through both ends.
    pure function slip_at(self, time, state) result(slip)
        class(step_start), intent(in) :: self
        real(dp), intent(in) :: time
        type(fault_state), intent(in) :: state   !! at the end of the step
        real(dp), allocatable :: slip(:)
        real(dp) :: dt, u

        dt = state%time - self%time
        u = (time - self%time) / dt
        slip = self%slip + u**2 * (3.0_dp - 2.0_dp * u) * (state%slip - self%slip) + dt * u &
            * (1.0_dp - u) * ((1.0_dp - u) * self%rate - u * state%rate)
    end function slip_at

    subroutine create(self, plan, together)
        class(fault), intent(inout) :: self
        type(fault_plan), intent(in) :: plan
        type(team), intent(inout) :: together
        real(dp), parameter :: least_weakening = 1.0e-100_dp   !! [F/L^3]
        type(sliding_surface) :: surface
        integer :: n_props, i, k, cell, status
        real(dp), allocatable :: values(:)

        self%plan = plan
        call self%part%divide(plan%nx, plan%nz, together)
        self%n = self%part%cells()
        self%damping = plan%damping()
        n_props = size(plan%constants%values, 1) - 1
        allocate (self%props(self%n, n_props), self%pressure(self%n), self%prestress(self%n), &
            self%slip_scale(self%n), values(n_props + 1))
        cell = 0
        do k = self%part%first, self%part%first + self%part%rows - 1
            do i = 1, plan%nx
                cell = cell + 1
                values = plan%constants%at(plan%x_of(i), plan%z_of(k))
                self%props(cell, :) = values(:n_props)
                self%pressure(cell) = values(n_props + 1)
                call read_surface(values(:n_props), surface, status)
                self%slip_scale(cell) = surface%traits%slip_scale
                self%cohesive_length = min(self%cohesive_length, plan%shear_modulus &
                    / max(surface%traits%weakening * self%pressure(cell), least_weakening))
            end do
        end do
        self%cohesive_length = -together%largest(-self%cohesive_length)
        call surround(self, together)
    end subroutine create

    subroutine surround(self, together)
        class(fault), intent(inout) :: self
        type(team), intent(inout) :: together
        type(half_space), allocatable :: antiplane
        class(plane_surroundings), allocatable :: plane

        associate (plan => self%plan)
            if (plan%geometry == 'antiplane_half') then
                allocate (antiplane)
                call antiplane%create(self%part, plan%shear_modulus, plan%dz())
                call move_alloc(antiplane, self%surroundings)
                return
            end if
            if (plan%geometry == 'half') then
                allocate (vertical_half_space :: plane)
            else
                allocate (full_space :: plane)
            end if
            call plane%create(together, self%part, [plan%shear_modulus, plan%poisson], plan%dx(), &
                plan%dz())
            call move_alloc(plane, self%surroundings)
        end associate
    end subroutine surround

    !> Traction without radiation damping, from slip at a time.
    subroutine tractions(self, together, time, slip, traction)
        class(fault), intent(inout) :: self
        type(team), intent(in) :: together
        real(dp), intent(in) :: time, slip(:)
        real(dp), intent(out) :: traction(:)
        real(dp) :: deficit(self%n)

        deficit = slip - self%plan%plate_rate * time
        call self%surroundings%apply(together, deficit, traction)
        traction = traction + self%prestress
    end subroutine tractions

    !> Adds the powers of this process's rows, integrated over a step, to the energies.
    subroutine add_powers(self, together, work, energy)
        class(fault), intent(in) :: self
        type(team), intent(in) :: together
        real(dp), intent(in) :: work(:, :)   !! row, power
        type(energies), intent(inout) :: energy

        associate (area => self%plan%cell_area())
            energy%loading = energy%loading + self%plan%plate_rate * area &
                * self%part%sum_of_rows(together, work(:, power_loading))
            energy%dissipated = energy%dissipated + area * self%part%sum_of_rows(together, &
                work(:, power_slip))
            energy%radiated = energy%radiated + area * self%part%sum_of_rows(together, &
                work(:, power_radiated))
        end associate
    end subroutine add_powers

    !> Elastic energy of a state, without that of the start.
    real(dp) function elastic_energy(self, together, state) result(energy)
        class(fault), intent(in) :: self
        type(team), intent(in) :: together
        type(fault_state), intent(in) :: state

        energy = -0.5_dp * self%plan%cell_area() * self%part%row_sums(together, (state%slip &
            - self%plan%plate_rate * state%time) * (state%traction + self%damping * state%rate &
            + self%prestress))
    end function elastic_energy

    !> Number of the cell around a point, among those of this process; 0: another process has it.
    pure integer function cell_of(self, x, z) result(cell)
        class(fault), intent(in) :: self
        real(dp), intent(in) :: x, z   !! [L]
        integer :: i, k

        i = min(self%plan%nx, 1 + int((x + 0.5_dp * self%plan%length) / self%plan%dx()))
        k = min(self%plan%nz, 1 + int(z / self%plan%dz()))
        cell = 0
        if (k < self%part%first .or. k >= self%part%first + self%part%rows) return
        cell = i + self%plan%nx * (k - self%part%first)
    end function cell_of

end module fault_problem
