!> Blocks on a base, each pulled by a spring whose far end the drive moves (docs/theory.md, section
!> 7):
!>
!>     M a = K (x_d - x) - C v - S f_t
!>
!> The friction force comes from the same `friction_update` that finite-element hosts call; the
!> normal traction is controlled through the penetration that carries it.
module slider_system
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use friction_mod, only : friction_ok, friction_snap_back, friction_update, statev_dissipation, &
        statev_mu, statev_r, statev_size, statev_u_et
    implicit none
    private

    public :: apply_normal_traction, copy_state, energy_balance, friction_forces, initial_state, &
        initial_values, place, slider, slider_state

    !> What stays.
    type :: slider
        real(dp) :: mass, stiffness, damping, area   !! [M], [F/L], [F T/L], [L^2]
        real(dp), allocatable :: props(:)            !! constants of the friction routine
    contains
        procedure :: penetration_step
        procedure :: account
        procedure :: stored
    end type slider

    !> How a block starts, if not at rest on a virgin contact with a slack spring.
    type :: initial_values
        logical :: any_given = .false.
        real(dp) :: mu = 0.0_dp                !! friction coefficient [-]
        real(dp) :: r = 0.0_dp                 !! similarity ratio; the friction opposes +x [-]
        real(dp) :: displacement = 0.0_dp      !! [L]
        real(dp) :: velocity = 0.0_dp          !! [L/T]
        logical :: spring_given = .false.      !! otherwise the block starts in equilibrium
        real(dp) :: spring_force = 0.0_dp      !! [F]
    end type initial_values

    !> What moves.
    type :: slider_state
        real(dp) :: time = 0.0_dp                !! [T]
        real(dp) :: drive = 0.0_dp               !! position of the drive [L]
        real(dp) :: normal = 0.0_dp              !! normal traction [F/L^2]
        real(dp), allocatable :: x(:), v(:), a(:)   !! of each block [L], [L/T], [L/T^2]
        real(dp), allocatable :: spring(:)       !! force of the drive spring [F]
        real(dp), allocatable :: friction(:)     !! S f_t, positive when it opposes +x [F]
        real(dp), allocatable :: statev(:, :)    !! of the friction routine, one column a block
    end type slider_state

    !> Where the work of the drive has gone [F L].
    type :: energy_balance
        real(dp) :: at_start = 0.0_dp   !! held at the start, in all forms
        real(dp) :: drive_work = 0.0_dp
        real(dp) :: kinetic = 0.0_dp, spring = 0.0_dp, contact = 0.0_dp   !! held now
        real(dp) :: damped = 0.0_dp, dissipated = 0.0_dp                  !! gone
    contains
        procedure :: unbalanced
    end type energy_balance

contains

    !> At rest, pressed on the base, no spring stretched.
    pure subroutine initial_state(system, n_blocks, normal, state, status)
        type(slider), intent(in) :: system
        integer, intent(in) :: n_blocks
        real(dp), intent(in) :: normal           !! normal traction at the start [F/L^2]
        type(slider_state), intent(out) :: state
        integer, intent(out) :: status           !! of the friction routine
        real(dp) :: tangent(n_blocks), zero(n_blocks), virgin(statev_size, n_blocks)

        zero = 0.0_dp
        virgin = 0.0_dp
        state%x = zero
        state%v = zero
        state%a = zero
        state%spring = zero
        state%friction = zero
        state%statev = virgin
        state%normal = normal
        call friction_forces(system, virgin, -normal / system%props(2), zero, 0.0_dp, &
            state%statev, state%friction, tangent, status)
    end subroutine initial_state

    !> Puts the block where the initial values say.
    pure subroutine place(system, values, state)
        type(slider), intent(in) :: system
        type(initial_values), intent(in) :: values
        type(slider_state), intent(inout) :: state   !! as `initial_state` left it

        if (.not. values%any_given) return
        state%x = values%displacement
        state%v = values%velocity
        state%statev(statev_mu, :) = values%mu
        state%statev(statev_r, :) = values%r
        state%friction = system%area * values%r * values%mu * state%normal
        state%statev(statev_u_et, :) = values%r * values%mu * state%normal / system%props(3)
        state%spring = state%friction + system%damping * state%v
        if (values%spring_given) state%spring = values%spring_force
        state%drive = state%x(1) + state%spring(1) / system%stiffness
        if (system%mass > 0.0_dp) state%a = (state%spring - system%damping * state%v &
            - state%friction) / system%mass
    end subroutine place

    !> `to = from` without new memory.
    pure subroutine copy_state(from, to)
        type(slider_state), intent(in) :: from
        type(slider_state), intent(inout) :: to   !! allocated like `from`

        to%time = from%time
        to%drive = from%drive
        to%normal = from%normal
        to%x(:) = from%x
        to%v(:) = from%v
        to%a(:) = from%a
        to%spring(:) = from%spring
        to%friction(:) = from%friction
        to%statev(:, :) = from%statev
    end subroutine copy_state

    !> Energy that a state holds: of the motion, of the springs, of the contact [F L].
    pure function stored(self, state) result(energy)
        class(slider), intent(in) :: self
        type(slider_state), intent(in) :: state
        real(dp) :: energy

        energy = 0.5_dp * self%mass * sum(state%v**2) + 0.5_dp * sum(state%spring**2) &
            / self%stiffness + 0.5_dp * self%area * self%props(3) &
            * sum(state%statev(statev_u_et, :)**2)
    end function stored

    !> Change of u_n that brings the normal traction from `old` to `new`.
    pure function penetration_step(self, old, new) result(du_n)
        class(slider), intent(in) :: self
        real(dp), intent(in) :: old, new   !! normal tractions [F/L^2]
        real(dp) :: du_n                   !! [L]

        du_n = -(new - old) / self%props(2)
    end function penetration_step

    !> Friction force and its derivative on every block, for displacement increments from `old`.
    pure subroutine friction_forces(system, old, du_n, dx, dt, new, force, stiffness, status)
        type(slider), intent(in) :: system
        real(dp), intent(in) :: old(:, :)        !! state variables at the start of the step
        real(dp), intent(in) :: du_n             !! increment of u_n [L]
        real(dp), intent(in) :: dx(:)            !! increment of displacement [L]
        real(dp), intent(in) :: dt               !! [T]
        real(dp), intent(inout) :: new(:, :)     !! state variables at its end
        real(dp), intent(inout) :: force(:)      !! S f_t [F]
        real(dp), intent(inout) :: stiffness(:)  !! S df_t/dx [F/L]
        integer, intent(out) :: status           !! the worst: an error, snap-back, or ok
        real(dp) :: traction(2), tangent(2, 2)
        integer :: i, point_status

        status = friction_ok
        do i = 1, size(dx)
            new(:, i) = old(:, i)
            call friction_update([du_n, dx(i)], dt, system%props, new(:, i), traction, tangent, &
                point_status)
            if (point_status < 0) then
                status = point_status
                return
            end if
            if (point_status == friction_snap_back) status = friction_snap_back
            force(i) = system%area * traction(2)
            stiffness(i) = system%area * tangent(2, 2)
        end do
    end subroutine friction_forces

    !> A sudden change of the normal traction, at one moment of time.
    pure subroutine apply_normal_traction(system, normal, state)
        type(slider), intent(in) :: system
        real(dp), intent(in) :: normal   !! afterwards [F/L^2]
        type(slider_state), intent(inout) :: state
        real(dp) :: old(size(state%statev, 1), size(state%x)), zero(size(state%x)), &
            tangent(size(state%x))
        integer :: status

        if (abs(normal - state%normal) <= 1.0e-14_dp * normal) return
        zero = 0.0_dp
        old = state%statev
        call friction_forces(system, old, system%penetration_step(state%normal, normal), zero, &
            0.0_dp, state%statev, state%friction, tangent, status)
        state%normal = normal
        if (system%mass > 0.0_dp) state%a = (state%spring - system%damping * state%v &
            - state%friction) / system%mass
    end subroutine apply_normal_traction

    !> Books the step from `old` to `new`: works by the mean force over the step, or by Simpson's
    !> rule if the state half-way is known.
    pure subroutine account(self, old, new, energy, middle)
        class(slider), intent(in) :: self
        type(slider_state), intent(in) :: old, new
        type(energy_balance), intent(inout) :: energy
        type(slider_state), intent(in), optional :: middle

        if (present(middle)) then
            energy%drive_work = energy%drive_work + (sum(old%spring) &
                * (4.0_dp * middle%drive - 3.0_dp * old%drive - new%drive) &
                + 4.0_dp * sum(middle%spring) * (new%drive - old%drive) + sum(new%spring) &
                * (old%drive - 4.0_dp * middle%drive + 3.0_dp * new%drive)) / 6.0_dp
            energy%damped = energy%damped + self%damping * (new%time - old%time) &
                * sum(old%v**2 + 4.0_dp * middle%v**2 + new%v**2) / 6.0_dp
        else
            energy%drive_work = energy%drive_work &
                + 0.5_dp * sum(old%spring + new%spring) * (new%drive - old%drive)
            energy%damped = energy%damped &
                + 0.5_dp * self%damping * sum((old%v + new%v) * (new%x - old%x))
        end if
        energy%kinetic = 0.5_dp * self%mass * sum(new%v**2)
        energy%spring = 0.5_dp * sum(new%spring**2) / self%stiffness
        energy%contact = 0.5_dp * self%area * self%props(3) * sum(new%statev(statev_u_et, :)**2)
        energy%dissipated = self%area * sum(new%statev(statev_dissipation, :))
    end subroutine account

    !> What the balance does not explain: the error of the time integration.
    pure function unbalanced(self) result(rest)
        class(energy_balance), intent(in) :: self
        real(dp) :: rest

        rest = self%at_start + self%drive_work - self%kinetic - self%spring - self%contact &
            - self%damped - self%dissipated
    end function unbalanced

end module slider_system
