!> One step of Newmark's or the generalised-alpha method, with equilibrium by Newton-Raphson on the
!> consistent tangent (docs/theory.md, section 7).
module time_integrator
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use friction_mod, only : friction_no_convergence, friction_ok, friction_snap_back
    use chain_solver, only : chain_matrix
    use slider_system, only : ends_fixed_free, ends_free, ends_free_fixed, ends_periodic, &
        friction_forces, slider, slider_state
    implicit none
    private

    public :: generalised_alpha, newmark, step_report

    !> Room for a step, kept from one to the next; one number a block.
    type :: workspace
        real(dp), allocatable, dimension(:) :: dx, dx_old, correction, residual, tangent, &
            rest_of_old
        type(chain_matrix) :: matrix
    end type workspace

    type :: newmark
        real(dp) :: beta = 0.25_dp, gamma = 0.5_dp   !! mean acceleration
        real(dp) :: tolerance = 1.0e-10_dp   !! of the residual, relative to the largest force
        integer :: max_iterations = 25
        real(dp) :: alpha_m = 0.0_dp, alpha_f = 0.0_dp   !! parts of the old state in the balance
        type(workspace) :: work
    contains
        procedure :: step
    end type newmark

    integer, parameter :: most_shown = 20

    !> How a step went.
    type :: step_report
        integer :: status = friction_ok     !! ok, snap back, or the error that ended the step
        integer :: iterations = 0           !! linear systems solved
        real(dp) :: stiffness = 0.0_dp      !! of drive spring and contact at the end, largest [F/L]
        real(dp) :: scale = 0.0_dp          !! the largest force, by which a residual is held [F]
        real(dp) :: residual(0:most_shown) = 0.0_dp   !! relative, before each iteration and at the
                                                      !! end
    end type step_report

contains

    !> The generalised-alpha method (Chung and Hulbert, J. Appl. Mech. 60, 1993) of second order
    !> whose spectral radius at high frequencies is `rho`; 1 is Newmark's mean acceleration.
    pure function generalised_alpha(rho, tolerance, max_iterations) result(method)
        real(dp), intent(in) :: rho          !! 0 to 1 [-]
        real(dp), intent(in) :: tolerance    !! of the residual, relative to the largest force
        integer, intent(in) :: max_iterations
        type(newmark) :: method

        method%tolerance = tolerance
        method%max_iterations = max_iterations
        if (rho >= 1.0_dp) return
        method%alpha_m = (2.0_dp * rho - 1.0_dp) / (rho + 1.0_dp)
        method%alpha_f = rho / (rho + 1.0_dp)
        method%gamma = 0.5_dp - method%alpha_m + method%alpha_f
        method%beta = 0.25_dp * (1.0_dp - method%alpha_m + method%alpha_f)**2
    end function generalised_alpha

    !> Moves `old` by `dt` to `new`, under the drive position and normal traction at the end.
    !>
    !> Without a mass the displacement follows from the balance of the other forces, and the
    !> velocity from dx = dt ((1 - gamma) v_old + gamma v_new). Where that balance breaks down,
    !> because the force that the block meets falls faster than the spring's, the step fails.
    subroutine step(self, system, drive, normal, dt, old, new, report, guess)
        class(newmark), intent(inout) :: self
        type(slider), intent(in) :: system
        real(dp), intent(in) :: drive            !! position of the drive at the end [L]
        real(dp), intent(in) :: normal           !! normal traction at the end [F/L^2]
        real(dp), intent(in) :: dt               !! 0 cannot be done [T]
        type(slider_state), intent(in) :: old
        type(slider_state), intent(inout) :: new   !! allocated like `old`
        type(step_report), intent(out) :: report
        real(dp), intent(in), optional :: guess(:)   !! of the displacements at the end [L]
        integer, parameter :: max_halvings = 8, to_and_fro = 10
        real(dp) :: inertia, norm, norm_old, scale
        integer :: halving
        logical :: inertial, solved

        report%iterations = 0
        report%status = friction_no_convergence
        if (dt <= 0.0_dp) return   ! steps so short that time stands still
        inertial = system%mass > 0.0_dp
        if (inertial) then
            inertia = (1.0_dp - self%alpha_m) * system%mass / (self%beta * dt**2) &
                + (1.0_dp - self%alpha_f) * system%damping * self%gamma / (self%beta * dt)
        else
            inertia = system%damping / (self%gamma * dt)
        end if
        new%time = old%time + dt
        new%drive = drive
        new%normal = normal

        call make_room(self%work, size(old%x), system)
        associate (w => self%work)
            if (present(guess)) then
                w%dx = guess - old%x
            else
                w%dx = dt * old%v + 0.5_dp * dt**2 * old%a
            end if
            call weigh_old_state(w%rest_of_old)
            call evaluate(w%dx, w%rest_of_old, w%tangent, w%residual)
            if (report%status < 0) return
            do
                report%residual(min(report%iterations, most_shown)) = norm / max(scale, tiny(scale))
                if (norm <= self%tolerance * scale) exit
                report%status = friction_no_convergence
                if (report%iterations == self%max_iterations) return
                if (report%iterations == to_and_fro .and. size(w%dx) == 1) then
                    ! between slip one way and slip the other: a stiff contact may well stick
                    w%dx = 0.0_dp
                    call evaluate(w%dx, w%rest_of_old, w%tangent, w%residual)
                    if (report%status < 0) return
                end if
                call fill(w%matrix, w%tangent)
                if (.not. inertial .and. any(w%matrix%diagonal <= 0.0_dp)) return
                w%correction = w%residual
                call w%matrix%solve(w%correction, solved)
                if (.not. solved) return
                report%status = friction_ok
                report%iterations = report%iterations + 1
                ! too small a correction to change the displacements: as exact as they get
                if (all(abs(w%correction) <= epsilon(w%dx) * abs(old%x + w%dx))) exit

                w%dx_old = w%dx
                norm_old = norm
                do halving = 0, max_halvings
                    w%dx = w%dx_old + w%correction / 2**halving
                    call evaluate(w%dx, w%rest_of_old, w%tangent, w%residual)
                    if (report%status < 0) return
                    if (norm < norm_old) exit
                end do
            end do
            report%scale = scale
            report%stiffness = system%stiffness + maxval(w%tangent) + 4.0_dp * system%coupling
            if (.not. inertial) call look_for_another_balance(w%dx, w%tangent)
        end associate

    contains

        !> What the old state adds to the balance of forces.
        subroutine weigh_old_state(rest)
            real(dp), intent(inout) :: rest(:)   !! [F]

            rest = 0.0_dp
            if (.not. inertial) return
            if (.not. (abs(self%alpha_f) > 0.0_dp .or. abs(self%alpha_m) > 0.0_dp)) return
            rest = self%alpha_f * (old%spring - system%damping * old%v - old%friction) &
                - self%alpha_m * system%mass * old%a
            call system%add_coupling(old%x, self%alpha_f, rest)
        end subroutine weigh_old_state

        !> State and force residual at the end of the step for the displacement increment `dx`.
        subroutine evaluate(dx, rest_of_old, tangent, residual)
            real(dp), intent(in), contiguous :: dx(:), rest_of_old(:)
            real(dp), intent(inout), contiguous :: tangent(:), residual(:)
            real(dp) :: farthest
            integer :: i

            call move_to(dx)
            call friction_forces(system, old%statev, normal, dx, dt, new%statev, new%friction, &
                tangent, report%status)
            if (report%status < 0) return
            scale = 0.0_dp
            farthest = 0.0_dp
            do i = 1, size(dx)
                residual(i) = (1.0_dp - self%alpha_f) * (new%spring(i) - system%damping &
                    * new%v(i) - new%friction(i)) - (1.0_dp - self%alpha_m) * system%mass &
                    * new%a(i) + rest_of_old(i)
                scale = max(scale, abs(new%spring(i)) + abs(system%damping * new%v(i)) &
                    + abs(new%friction(i)) + abs(system%mass * new%a(i)))
                farthest = max(farthest, abs(new%x(i)))
            end do
            ! the forces of stiff springs between neighbours are no better known than by round-off
            scale = max(scale, 8.0_dp * epsilon(scale) * system%coupling * farthest &
                / self%tolerance)
            call system%add_coupling(new%x, 1.0_dp - self%alpha_f, residual)
            norm = 0.0_dp
            do i = 1, size(dx)
                norm = max(norm, abs(residual(i)))
            end do
        end subroutine evaluate

        !> Newmark's formulas, and the drive springs.
        subroutine move_to(dx)
            real(dp), intent(in), contiguous :: dx(:)   !! [L]
            integer :: i

            do i = 1, size(dx)
                new%x(i) = old%x(i) + dx(i)
                if (inertial) then
                    new%a(i) = (dx(i) - dt * old%v(i)) / (self%beta * dt**2) &
                        - (0.5_dp / self%beta - 1.0_dp) * old%a(i)
                    new%v(i) = old%v(i) + dt * ((1.0_dp - self%gamma) * old%a(i) &
                        + self%gamma * new%a(i))
                else
                    new%v(i) = (dx(i) / dt - (1.0_dp - self%gamma) * old%v(i)) / self%gamma
                end if
                new%spring(i) = system%stiffness * (drive - new%x(i))
            end do
        end subroutine move_to

        !> The derivative of the residual, with the opposite sign.
        subroutine fill(matrix, tangent)
            type(chain_matrix), intent(inout) :: matrix
            real(dp), intent(in) :: tangent(:)   !! of the contacts [F/L]
            real(dp) :: k
            integer :: n

            k = (1.0_dp - self%alpha_f) * system%coupling
            matrix%beside = -k
            matrix%diagonal = inertia + 2.0_dp * k + (1.0_dp - self%alpha_f) &
                * (system%stiffness + tangent)
            n = size(tangent)
            if (system%ends == ends_free .or. system%ends == ends_free_fixed) then
                matrix%diagonal(1) = matrix%diagonal(1) - k
            end if
            if (system%ends == ends_free .or. system%ends == ends_fixed_free) then
                matrix%diagonal(n) = matrix%diagonal(n) - k
            end if
        end subroutine fill

        !> The forces must fall all the way from no displacement to the one found: otherwise there
        !> is another balance before it, and no quasi-static motion leads past that.
        subroutine look_for_another_balance(dx, tangent)
            real(dp), intent(in) :: dx(:)            !! [L]
            real(dp), intent(inout) :: tangent(:)    !! [F/L]
            integer, parameter :: samples = 8
            real(dp) :: statev(size(dx), size(old%statev, 2)), force(size(dx))
            integer :: i, status

            do i = 1, samples
                call friction_forces(system, old%statev, normal, dx * i / samples, dt, statev, &
                    force, tangent, status)
                if (status < 0) return
                if (any(inertia + system%stiffness + tangent <= 0.0_dp)) then
                    report%status = friction_no_convergence
                    return
                end if
            end do
        end subroutine look_for_another_balance

    end subroutine step

    pure subroutine make_room(work, n, system)
        type(workspace), intent(inout) :: work
        integer, intent(in) :: n                !! blocks
        type(slider), intent(in) :: system

        if (allocated(work%dx)) then
            if (size(work%dx) == n) return
            deallocate (work%dx, work%dx_old, work%correction, work%residual, work%tangent, &
                work%rest_of_old)
        end if
        allocate (work%dx(n), work%dx_old(n), work%correction(n), work%residual(n), &
            work%tangent(n), work%rest_of_old(n))
        call work%matrix%make_room(n, system%ends == ends_periodic .and. n > 1)
    end subroutine make_room

end module time_integrator
