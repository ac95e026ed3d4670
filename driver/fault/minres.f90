!> Solves a symmetric system, definite or not, by minimal residuals (Paige and Saunders 1975),
!> scaled by its diagonal. The fault's matrix is definite while friction holds the surroundings, and
!> loses that where friction weakens faster than they unload: conjugate gradients would break down
!> there, minimal residuals do not. All sums are taken row after row, so that the result does not
!> depend on the number of processes.
module minres
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use fault_problem, only : fault
    use processes, only : team
    implicit none
    private

    public :: solve_minres

contains

    !> (diag(diagonal) - K) x = b, with K that of the fault's surroundings.
    subroutine solve_minres(here, together, diagonal, b, tolerance, x, definite)
        type(fault), intent(inout) :: here
        type(team), intent(in) :: together
        real(dp), intent(in) :: diagonal(:), b(:)
        real(dp), intent(in) :: tolerance   !! of the scaled residual, relative
        real(dp), intent(out) :: x(:)
        logical, intent(out) :: definite    !! as far as the search has seen the matrix
        integer, parameter :: most = 200
        real(dp), dimension(here%n) :: scale, v, v_old, v_new, w, w_old, w_new
        real(dp) :: alpha, beta, beta_new, c, c_old, s, s_old, eta, first, pivot, rho(0:3)
        integer :: iteration

        scale = 1.0_dp / sqrt(abs(diagonal) + here%surroundings%self_stiffness)
        x = 0.0_dp
        definite = .true.
        v_old = 0.0_dp
        w = 0.0_dp
        w_old = 0.0_dp
        v = scale * b
        beta = sqrt(here%part%row_sums(together, v**2))
        first = beta
        if (.not. beta > 0.0_dp) return
        v = v / beta
        eta = beta
        c = 1.0_dp
        c_old = 1.0_dp
        s = 0.0_dp
        s_old = 0.0_dp
        beta = 0.0_dp
        pivot = 1.0_dp
        do iteration = 1, most
            w_new = scale * v
            call here%surroundings%apply(together, w_new, v_new)
            v_new = scale * (diagonal * w_new - v_new)
            alpha = here%part%row_sums(together, v * v_new)
            v_new = v_new - alpha * v - beta * v_old
            if (definite) pivot = alpha - beta**2 / pivot   ! of the tridiagonal matrix
            definite = pivot > 0.0_dp
            beta_new = sqrt(here%part%row_sums(together, v_new**2))
            rho(0) = c * alpha - c_old * s * beta
            rho(1) = sqrt(rho(0)**2 + beta_new**2)
            rho(2) = s * alpha + c_old * c * beta
            rho(3) = s_old * beta
            if (.not. rho(1) > 0.0_dp) exit
            c_old = c
            s_old = s
            c = rho(0) / rho(1)
            s = beta_new / rho(1)
            w_new = (v - rho(3) * w_old - rho(2) * w) / rho(1)
            x = x + c * eta * w_new
            eta = -s * eta
            if (abs(eta) <= tolerance * first .or. .not. beta_new > 0.0_dp) exit
            v_old = v
            v = v_new / beta_new
            beta = beta_new
            w_old = w
            w = w_new
        end do
        x = scale * x
    end subroutine solve_minres

end module minres
