!> The paper's own return mapping, as a generic implicit integrator does it: Newton's method on the
!> four unknowns (u_e, dgamma, mu, R) of its equations 17 to 20, with LAPACK's dgesv. It shows what
!> the reduction to one equation buys.
!>
!> The elastic displacement is its length: sliding is along the trial traction. A start away from
!> R = 0 and clipped steps are all that is added.
module four_unknowns
    use, intrinsic :: iso_fortran_env, only : dp => real64
    implicit none
    private

    public :: four_unknown_update

    interface
        !> LAPACK: general linear system by Gaussian elimination with partial pivoting.
        pure subroutine dgesv(n, nrhs, a, lda, ipiv, b, ldb, info)
            import :: dp
            implicit none
            integer, intent(in) :: n, nrhs, lda, ldb
            real(dp), intent(inout) :: a(lda, *), b(ldb, *)
            integer, intent(out) :: ipiv(*), info
        end subroutine dgesv
    end interface

    integer, parameter :: u_e = 1, gamma = 2, mu = 3, r = 4   !! places of the unknowns

    !> What one point's equations need.
    type :: problem
        real(dp) :: alpha, mu_s, mu_k, kappa, xi, m   !! constants of the law
        real(dp) :: reach                             !! trial elastic displacement [L]
        real(dp) :: pressure, dt
        real(dp) :: mu_n, r_n                         !! at the start of the increment
    end type problem

contains

    !> Same arguments as `friction_update`, for a closed contact in three dimensions.
    pure subroutine four_unknown_update(du, dt, props, statev, traction, tangent, iterations, &
        converged)
        real(dp), intent(in) :: du(3)            !! normal, tangential 1 and 2 [L]
        real(dp), intent(in) :: dt               !! [T]
        real(dp), intent(in) :: props(8)         !! constants, as in `friction_update`
        real(dp), intent(inout) :: statev(8)     !! state, as in `friction_update`
        real(dp), intent(out) :: traction(3)     !! [F/L^2]
        real(dp), intent(out) :: tangent(3, 3)   !! [F/L^3]
        integer, intent(out) :: iterations       !! linear systems solved to find the unknowns
        logical, intent(out) :: converged
        type(problem) :: p
        real(dp) :: x(4), rates(4, 2), q(2), t(2), along, across
        integer :: i, j

        p = problem(alpha=props(3), mu_s=props(4), mu_k=props(5), kappa=props(6), xi=props(7), &
            m=props(8), reach=0.0_dp, pressure=-props(2) * (statev(2) + du(1)), dt=dt, &
            mu_n=statev(5), r_n=statev(6))
        q = statev(3:4) + du(2:3)
        p%reach = norm2(q)
        t = 0.0_dp
        if (p%reach > 0.0_dp) t = q / p%reach

        iterations = 0
        converged = .true.
        x = [p%reach, 0.0_dp, (p%mu_n + p%xi * p%mu_s * dt) / (1.0_dp + p%xi * dt), p%r_n]
        if (p%alpha * p%reach <= x(r) * x(mu) * p%pressure) then
            x(r) = p%alpha * p%reach / (x(mu) * p%pressure)
            rates = 0.0_dp
            rates(u_e, 1) = 1.0_dp
        else
            call solve(p, x, iterations, converged)
            call differentiate(p, x, rates)
        end if

        traction = [-p%pressure, p%alpha * x(u_e) * t]
        along = p%alpha * rates(u_e, 1)
        across = p%alpha
        if (p%reach > 0.0_dp) across = p%alpha * x(u_e) / p%reach
        tangent(1, :) = [props(2), 0.0_dp, 0.0_dp]
        tangent(2:3, 1) = -props(2) * p%alpha * rates(u_e, 2) * t
        do j = 1, 2
            do i = 1, 2
                tangent(i + 1, j + 1) = (along - across) * t(i) * t(j)
            end do
            tangent(j + 1, j + 1) = tangent(j + 1, j + 1) + across
        end do
        statev(1) = merge(2.0_dp, 1.0_dp, x(gamma) > 0.0_dp)
        statev(2) = statev(2) + du(1)
        statev(3:4) = x(u_e) * t
        statev(5) = x(mu)
        statev(6) = x(r)
        statev(7) = statev(7) + x(gamma)
        statev(8) = statev(8) + p%alpha * x(u_e) * x(gamma)
    end subroutine four_unknown_update

    !> Newton's method until a step is so small that the error after it is round-off.
    pure subroutine solve(p, x, iterations, converged)
        type(problem), intent(in) :: p
        real(dp), intent(inout) :: x(4)   !! trial values in, solution out
        integer, intent(out) :: iterations
        logical, intent(out) :: converged
        integer, parameter :: max_iterations = 50
        real(dp), parameter :: small_step = 1.0e-8_dp, least_ratio = 1.0e-2_dp, &
            round_off = 4.0_dp * epsilon(1.0_dp)
        real(dp) :: jacobian(4, 4), step(4), r_old
        integer :: pivots(4), info

        x(r) = min(max(x(r), least_ratio), 1.0_dp - least_ratio)
        converged = .false.
        do iterations = 1, max_iterations
            jacobian = derivatives(p, x)
            step = -residuals(p, x)
            call dgesv(4, 1, jacobian, 4, pivots, step, 4, info)
            if (info /= 0) return
            r_old = x(r)
            x = x + step
            converged = abs(step(u_e)) <= small_step * p%reach &
                .and. abs(step(gamma)) <= small_step * p%reach &
                .and. abs(step(mu)) <= small_step * p%mu_s &
                .and. abs(step(r)) <= small_step * min(r_old, 1.0_dp - r_old) + round_off
            if (converged) return
            x(gamma) = min(max(x(gamma), 0.0_dp), p%reach)
            x(r) = min(max(x(r), 0.05_dp * r_old), 1.0_dp - 0.05_dp * (1.0_dp - r_old))
        end do
    end subroutine solve

    !> Derivatives of the solution by the trial elastic displacement and by the pressure.
    pure subroutine differentiate(p, x, rates)
        type(problem), intent(in) :: p
        real(dp), intent(in) :: x(4)          !! solution
        real(dp), intent(out) :: rates(4, 2)
        real(dp) :: jacobian(4, 4)
        integer :: pivots(4), info

        jacobian = derivatives(p, x)
        rates = 0.0_dp
        rates(1, 1) = 1.0_dp
        rates(4, 2) = x(r) * x(mu)
        call dgesv(4, 2, jacobian, 4, pivots, rates, 4, info)
    end subroutine differentiate

    !> The paper's equations 17 to 20.
    pure function residuals(p, x) result(y)
        type(problem), intent(in) :: p
        real(dp), intent(in) :: x(4)
        real(dp) :: y(4)

        y(1) = x(u_e) - p%reach + x(gamma)
        y(2) = x(mu) - p%mu_n + x(gamma) * p%kappa * (x(mu) - p%mu_k) - p%xi * (p%mu_s - x(mu)) &
            * p%dt
        y(3) = x(r) - p%r_n + x(gamma) * p%m * log(x(r))
        y(4) = p%alpha * x(u_e) - x(r) * x(mu) * p%pressure
    end function residuals

    pure function derivatives(p, x) result(jacobian)
        type(problem), intent(in) :: p
        real(dp), intent(in) :: x(4)
        real(dp) :: jacobian(4, 4)   !! of `residuals`

        jacobian(:, u_e) = [1.0_dp, 0.0_dp, 0.0_dp, p%alpha]
        jacobian(:, gamma) = [1.0_dp, p%kappa * (x(mu) - p%mu_k), p%m * log(x(r)), 0.0_dp]
        jacobian(:, mu) = [0.0_dp, 1.0_dp + p%kappa * x(gamma) + p%xi * p%dt, 0.0_dp, &
            -x(r) * p%pressure]
        jacobian(:, r) = [0.0_dp, 0.0_dp, 1.0_dp + x(gamma) * p%m / x(r), -x(mu) * p%pressure]
    end function derivatives

end module four_unknowns
