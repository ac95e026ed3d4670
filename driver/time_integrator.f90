!> One step of Newmark's method, with equilibrium at its end by Newton-Raphson on the consistent
!> tangent (docs/theory.md, section 7). The linear systems are LAPACK's.
module time_integrator
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use friction_mod, only : friction_no_convergence, friction_ok, friction_snap_back
    use slider_system, only : friction_forces, slider, slider_state
    implicit none
    private

    public :: newmark, step_report

    type :: newmark
        real(dp) :: beta = 0.25_dp, gamma = 0.5_dp   !! mean acceleration
        real(dp) :: tolerance = 1.0e-10_dp   !! of the residual, relative to the largest force
        integer :: max_iterations = 25
    contains
        procedure :: step
    end type newmark

    integer, parameter :: most_shown = 20

    !> How a step went.
    type :: step_report
        integer :: status = friction_ok     !! ok, snap back, or the error that ended the step
        integer :: iterations = 0           !! linear systems solved
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

    !> Moves `old` by `dt` to `new`, under the drive position and normal traction at the end.
    subroutine step(self, system, drive, normal, dt, old, new, report)
        class(newmark), intent(in) :: self
        type(slider), intent(in) :: system
        real(dp), intent(in) :: drive            !! position of the drive at the end [L]
        real(dp), intent(in) :: normal           !! normal traction at the end [F/L^2]
        real(dp), intent(in) :: dt               !! [T]
        type(slider_state), intent(in) :: old
        type(slider_state), intent(inout) :: new   !! allocated like `old`
        type(step_report), intent(out) :: report
        integer, parameter :: max_halvings = 8
        real(dp), dimension(size(old%x)) :: dx, dx_old, correction, residual, tangent, &
            below, diagonal, above
        real(dp) :: du_n, inertia, norm, norm_old, scale
        integer :: halving, info, n

        n = size(old%x)
        inertia = system%mass / (self%beta * dt**2) + system%damping * self%gamma / (self%beta * dt)
        du_n = system%penetration_step(old%normal, normal)
        new%time = old%time + dt
        new%drive = drive
        new%normal = normal

        dx = dt * old%v + 0.5_dp * dt**2 * old%a
        call evaluate()
        if (report%status < 0) return
        do
            report%residual(min(report%iterations, most_shown)) = norm / max(scale, tiny(scale))
            if (norm <= self%tolerance * scale) return
            if (report%iterations == self%max_iterations) exit

            below = 0.0_dp
            diagonal = inertia + system%stiffness + tangent
            above = 0.0_dp
            correction = residual
            call dgtsv(n, 1, below, diagonal, above, correction, n, info)
            if (info /= 0) exit
            report%iterations = report%iterations + 1
            ! too small a correction to change the displacements: as exact as they get
            if (all(abs(correction) <= epsilon(dx) * abs(old%x + dx))) return

            dx_old = dx
            norm_old = norm
            do halving = 0, max_halvings
                dx = dx_old + correction / 2**halving
                call evaluate()
                if (report%status < 0) return
                if (norm < norm_old) exit
            end do
        end do
        report%status = friction_no_convergence

    contains

        !> State and force residual at the end of the step for the displacement increment `dx`.
        subroutine evaluate()
            new%x = old%x + dx
            new%a = (dx - dt * old%v) / (self%beta * dt**2) - (0.5_dp / self%beta - 1.0_dp) * old%a
            new%v = old%v + dt * ((1.0_dp - self%gamma) * old%a + self%gamma * new%a)
            new%spring = system%stiffness * (drive - new%x)
            call friction_forces(system, old%statev, du_n, dx, dt, new%statev, new%friction, &
                tangent, report%status)
            residual = new%spring - system%damping * new%v - new%friction - system%mass * new%a
            norm = maxval(abs(residual))
            scale = maxval(abs(new%spring) + abs(system%damping * new%v) + abs(new%friction) &
                + abs(system%mass * new%a))
        end subroutine evaluate

    end subroutine step

end module time_integrator
