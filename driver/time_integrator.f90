!> One step of Newmark's or the generalised-alpha method, with equilibrium by Newton-Raphson on the
!> consistent tangent (docs/theory.md, section 7). The linear systems are LAPACK's.
module time_integrator
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use friction_mod, only : friction_no_convergence, friction_ok, friction_snap_back
    use slider_system, only : friction_forces, slider, slider_state
    implicit none
    private

    public :: generalised_alpha, newmark, step_report

    type :: newmark
        real(dp) :: beta = 0.25_dp, gamma = 0.5_dp   !! mean acceleration
        real(dp) :: tolerance = 1.0e-10_dp   !! of the residual, relative to the largest force
        integer :: max_iterations = 25
        real(dp) :: alpha_m = 0.0_dp, alpha_f = 0.0_dp   !! parts of the old state in the balance
    contains
        procedure :: step
    end type newmark

    integer, parameter :: most_shown = 20

    !> How a step went.
    type :: step_report
        integer :: status = friction_ok     !! ok, snap back, or the error that ended the step
        integer :: iterations = 0           !! linear systems solved
        real(dp) :: stiffness = 0.0_dp      !! of drive spring and contact at the end, largest [F/L]
        real(dp) :: residual(0:most_shown) = 0.0_dp   !! relative, before each iteration and at the
                                                      !! end
    end type step_report

    interface
        !> LAPACK: tridiagonal system by Gaussian elimination with partial pivoting.
        pure subroutine dgtsv(n, nrhs, dl, d, du, b, ldb, info)
            import :: dp
            implicit none
            integer, intent(in) :: n, nrhs, ldb
            real(dp), intent(inout) :: dl(*), d(*), du(*), b(ldb, *)
            integer, intent(out) :: info
        end subroutine dgtsv
    end interface

contains

    !> The generalised-alpha method (Chung and Hulbert, J. Appl. Mech. 60, 1993) of second order
    !> whose spectral radius at high frequencies is `rho`; 1 is Newmark's mean acceleration.
    pure function generalised_alpha(rho, tolerance, max_iterations) result(method)
        real(dp), intent(in) :: rho          !! 0 to 1 [-]
        real(dp), intent(in) :: tolerance    !! of the residual, relative to the largest force
        integer, intent(in) :: max_iterations
        type(newmark) :: method

        method = newmark(tolerance=tolerance, max_iterations=max_iterations)
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
        class(newmark), intent(in) :: self
        type(slider), intent(in) :: system
        real(dp), intent(in) :: drive            !! position of the drive at the end [L]
        real(dp), intent(in) :: normal           !! normal traction at the end [F/L^2]
        real(dp), intent(in) :: dt               !! > 0 [T]
        type(slider_state), intent(in) :: old
        type(slider_state), intent(inout) :: new   !! allocated like `old`
        type(step_report), intent(out) :: report
        real(dp), intent(in), optional :: guess(:)   !! of the displacements at the end [L]
        integer, parameter :: max_halvings = 8
        real(dp), dimension(size(old%x)) :: dx, dx_old, correction, residual, tangent, below, &
            diagonal, above, rest_of_old
        real(dp) :: du_n, inertia, norm, norm_old, scale
        integer :: halving, info, n
        logical :: inertial

        n = size(old%x)
        report%iterations = 0
        inertial = system%mass > 0.0_dp
        if (inertial) then
            inertia = (1.0_dp - self%alpha_m) * system%mass / (self%beta * dt**2) &
                + (1.0_dp - self%alpha_f) * system%damping * self%gamma / (self%beta * dt)
            rest_of_old = self%alpha_f * (old%spring - system%damping * old%v - old%friction) &
                - self%alpha_m * system%mass * old%a
        else
            inertia = system%damping / (self%gamma * dt)
            rest_of_old = 0.0_dp
        end if
        du_n = system%penetration_step(old%normal, normal)
        new%time = old%time + dt
        new%drive = drive
        new%normal = normal

        if (present(guess)) then
            dx = guess - old%x
        else
            dx = dt * old%v + 0.5_dp * dt**2 * old%a
        end if
        call evaluate()
        if (report%status < 0) return
        do
            report%residual(min(report%iterations, most_shown)) = norm / max(scale, tiny(scale))
            if (norm <= self%tolerance * scale) exit
            if (report%iterations == self%max_iterations) then
                report%status = friction_no_convergence
                return
            end if

            diagonal = inertia + (1.0_dp - self%alpha_f) * (system%stiffness + tangent)
            if (.not. inertial .and. any(diagonal <= 0.0_dp)) then
                report%status = friction_no_convergence
                return
            end if
            correction = residual
            below = 0.0_dp
            above = 0.0_dp
            call dgtsv(n, 1, below, diagonal, above, correction, n, info)
            if (info /= 0) then
                report%status = friction_no_convergence
                return
            end if
            report%iterations = report%iterations + 1
            ! too small a correction to change the displacements: as exact as they get
            if (all(abs(correction) <= epsilon(dx) * abs(old%x + dx))) exit

            dx_old = dx
            norm_old = norm
            do halving = 0, max_halvings
                dx = dx_old + correction / 2**halving
                call evaluate()
                if (report%status < 0) return
                if (norm < norm_old) exit
            end do
        end do
        report%stiffness = system%stiffness + maxval(tangent)
        if (.not. inertial) call look_for_another_balance()

    contains

        !> State and force residual at the end of the step for the displacement increment `dx`.
        subroutine evaluate()
            new%x = old%x + dx
            if (inertial) then
                new%a = (dx - dt * old%v) / (self%beta * dt**2) &
                    - (0.5_dp / self%beta - 1.0_dp) * old%a
                new%v = old%v + dt * ((1.0_dp - self%gamma) * old%a + self%gamma * new%a)
            else
                new%v = (dx / dt - (1.0_dp - self%gamma) * old%v) / self%gamma
            end if
            new%spring = system%stiffness * (drive - new%x)
            call friction_forces(system, old%statev, du_n, dx, dt, new%statev, new%friction, &
                tangent, report%status)
            residual = (1.0_dp - self%alpha_f) * (new%spring - system%damping * new%v &
                - new%friction) - (1.0_dp - self%alpha_m) * system%mass * new%a + rest_of_old
            norm = maxval(abs(residual))
            scale = maxval(abs(new%spring) + abs(system%damping * new%v) + abs(new%friction) &
                + abs(system%mass * new%a))
        end subroutine evaluate

        !> The forces must fall all the way from no displacement to the one found: otherwise there
        !> is another balance before it, and no quasi-static motion leads past that.
        subroutine look_for_another_balance()
            integer, parameter :: samples = 8
            real(dp) :: statev(size(old%statev, 1), n), force(n)
            integer :: i, status

            do i = 1, samples
                call friction_forces(system, old%statev, du_n, dx * i / samples, dt, statev, &
                    force, tangent, status)
                if (status < 0) return
                if (any(inertia + system%stiffness + tangent <= 0.0_dp)) then
                    report%status = friction_no_convergence
                    return
                end if
            end do
        end subroutine look_for_another_balance

    end subroutine step

end module time_integrator
