!> One step of Newmark's or the generalised-alpha method for a block that moves along and across the
!> interface, so that its normal traction follows from its motion (docs/theory.md, section 14).
module two_way_steps
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use abstract_integrator, only : most_shown, step_report
    use friction_mod, only : friction_no_convergence, friction_ok, friction_update, statev_size, &
        statev_u_n
    use slider_system, only : slider, slider_state
    use time_integrator, only : newmark, round_off_of
    implicit none
    private

    public :: two_way_newmark

    type, extends(newmark) :: two_way_newmark
    contains
        procedure :: step
    end type two_way_newmark

    integer, parameter :: along = 1, across = 2

    !> Forces on the block at the end of a step, for displacements in it.
    type :: trial
        real(dp) :: moved(2) = 0.0_dp             !! [L]
        real(dp) :: residual(2) = 0.0_dp          !! [F]
        real(dp) :: stiffness(2, 2) = 0.0_dp      !! its derivative, with the opposite sign [F/L]
        real(dp) :: scale = 0.0_dp                !! the largest force [F]
        integer :: status = friction_ok           !! of the friction routine
    contains
        procedure :: misfit
    end type trial

contains

    pure function misfit(self) result(norm)
        class(trial), intent(in) :: self
        real(dp) :: norm

        norm = maxval(abs(self%residual))
    end function misfit

    subroutine step(self, system, drive, normal, dt, old, new, report, guess)
        class(two_way_newmark), intent(inout) :: self
        type(slider), intent(in) :: system
        real(dp), intent(in) :: drive, normal, dt
        type(slider_state), intent(in) :: old
        type(slider_state), intent(inout) :: new
        type(step_report), intent(out) :: report
        real(dp), intent(in), optional :: guess(:)   !! along the interface
        integer, parameter :: most_halvings = 8
        type(trial) :: now, next
        real(dp) :: correction(2)
        integer :: halving
        logical :: balanced, final

        report%iterations = 0
        report%status = friction_no_convergence
        if (dt <= 0.0_dp) return
        new%time = old%time + dt
        new%drive = drive
        new%load = normal
        now%moved = dt * [old%v(1), old%v_n] + 0.5_dp * dt**2 * [old%a(1), old%a_n]
        if (present(guess)) now%moved(along) = guess(1) - old%x(1)
        call evaluate(self, system, dt, old, new, now)
        do while (now%status >= 0)
            report%residual(min(report%iterations, most_shown)) = now%misfit() &
                / max(now%scale, tiny(dt))
            balanced = now%misfit() <= self%tolerance * now%scale
            if (balanced .or. report%iterations == self%max_iterations) exit
            correction = solved(now%stiffness, now%residual)
            report%iterations = report%iterations + 1
            final = all(abs(correction) <= round_off_of(now%moved, [old%v(1), old%v_n], &
                [old%a(1), old%a_n], dt))
            do halving = 0, most_halvings
                next%moved = now%moved + correction / 2**halving
                call evaluate(self, system, dt, old, new, next)
                if (next%status < 0 .or. next%misfit() < now%misfit() .or. final) exit
            end do
            now = next
            balanced = final
            if (balanced) exit
        end do
        report%status = now%status
        if (now%status < 0) return
        report%status = friction_no_convergence
        if (.not. balanced) return
        report%status = now%status
        report%scale = now%scale
        report%stiffness = maxval(abs(now%stiffness))
    end subroutine step

    !> By Cramer's rule, with numbers of their own size in each row.
    pure function solved(a, b) result(x)
        real(dp), intent(in) :: a(2, 2), b(2)
        real(dp) :: x(2)

        x = [b(1) * a(2, 2) - b(2) * a(1, 2), a(1, 1) * b(2) - a(2, 1) * b(1)] &
            / (a(1, 1) * a(2, 2) - a(1, 2) * a(2, 1))
    end function solved

    !> State and force residual at the end of the step.
    subroutine evaluate(self, system, dt, old, new, this)
        class(two_way_newmark), intent(in) :: self
        type(slider), intent(in) :: system
        real(dp), intent(in) :: dt
        type(slider_state), intent(in) :: old
        type(slider_state), intent(inout) :: new
        type(trial), intent(inout) :: this
        real(dp) :: statev(statev_size), traction(2), tangent(2, 2), mass(2), damping(2), force(2)

        mass = [system%mass, system%across%mass]
        damping = [system%damping, system%across%damping]
        statev = old%statev(1, :)
        call friction_update(this%moved([across, along]), dt, system%props, statev, traction, &
            tangent, this%status)
        if (this%status < 0) return
        new%statev(1, :) = statev
        new%x = old%x + this%moved(along)
        call self%motion(dt, this%moved(along), old%v(1), old%a(1), new%v(1), new%a(1))
        call self%motion(dt, this%moved(across), old%v_n, old%a_n, new%v_n, new%a_n)
        new%spring = system%pull(new%drive, new%x, statev(statev_u_n))
        new%friction = system%area * traction(2)
        new%normal = system%carried_pressure(statev(statev_u_n))
        force = forces_on(system, new)
        this%residual = (1.0_dp - self%alpha_f) * force + self%alpha_f * forces_on(system, old) &
            - mass * ((1.0_dp - self%alpha_m) * [new%a(1), new%a_n] &
            + self%alpha_m * [old%a(1), old%a_n])
        this%scale = max(abs(new%spring(1)) + abs(new%friction(1)) + abs(mass(1) * new%a(1)), &
            system%area * (abs(new%load) + new%normal) + abs(mass(2) * new%a_n))
        this%scale = max(this%scale, 8.0_dp * epsilon(dt) / self%tolerance &
            * ((system%stiffness + abs(system%across%tilt)) * abs(new%x(1)) &
            + (system%across%stiffness + abs(system%across%tilt)) * abs(statev(statev_u_n))))
        this%stiffness = system%area * tangent([2, 1], [2, 1])
        this%stiffness(1, 1) = this%stiffness(1, 1) + system%stiffness
        this%stiffness(1, 2) = this%stiffness(1, 2) + system%across%tilt
        this%stiffness(2, 1) = this%stiffness(2, 1) + system%across%tilt
        this%stiffness(2, 2) = this%stiffness(2, 2) + system%across%stiffness
        this%stiffness = (1.0_dp - self%alpha_f) * this%stiffness
        call add_inertia(along)
        call add_inertia(across)

    contains

        subroutine add_inertia(i)
            integer, intent(in) :: i

            this%stiffness(i, i) = this%stiffness(i, i) + (1.0_dp - self%alpha_m) * mass(i) &
                / (self%beta * dt**2) + (1.0_dp - self%alpha_f) * damping(i) * self%gamma &
                / (self%beta * dt)
        end subroutine add_inertia

    end subroutine evaluate

    !> Forces but for inertia, along and across.
    pure function forces_on(system, state) result(force)
        type(slider), intent(in) :: system
        type(slider_state), intent(in) :: state
        real(dp) :: force(2)   !! [F]

        force = [state%spring(1) - system%damping * state%v(1) - state%friction(1), &
            system%push(state%drive, state%load, state%x(1), state%statev(1, statev_u_n), &
            state%v_n) + system%area * state%normal]
    end function forces_on

end module two_way_steps
