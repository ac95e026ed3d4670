!> One step of Rodas4, the stiffly accurate Rosenbrock method of order 4(3) of Hairer and Wanner
!> (Solving Ordinary Differential Equations II, section IV.7), for the rate equations of a block.
module rosenbrock
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use slider_rates, only : controlled, elastic, extension, slider_equations, unknowns, velocity
    implicit none
    private

    public :: rosenbrock_step

    integer, parameter :: stages = 6
    real(dp), parameter :: gamma = 0.25_dp
    real(dp), parameter :: at(stages) = [0.0_dp, 0.386_dp, 0.21_dp, 0.63_dp, 1.0_dp, 1.0_dp]
    !> Factors of the derivatives by time.
    real(dp), parameter :: d(stages) = [0.25_dp, -0.1043_dp, 0.1035_dp, &
        -0.03620000000000023_dp, 0.0_dp, 0.0_dp]
    real(dp), parameter :: a(stages, stages - 1) = reshape([ &
        0.0_dp, 1.544_dp, 0.9466785280815826_dp, 3.314825187068521_dp, 1.221224509226641_dp, &
        1.221224509226641_dp, &
        0.0_dp, 0.0_dp, 0.2557011698983284_dp, 2.896124015972201_dp, 6.019134481288629_dp, &
        6.019134481288629_dp, &
        0.0_dp, 0.0_dp, 0.0_dp, 0.9986419139977817_dp, 12.53708332932087_dp, &
        12.53708332932087_dp, &
        0.0_dp, 0.0_dp, 0.0_dp, 0.0_dp, -0.6878860361058950_dp, -0.6878860361058950_dp, &
        0.0_dp, 0.0_dp, 0.0_dp, 0.0_dp, 0.0_dp, 1.0_dp], [stages, stages - 1])
    real(dp), parameter :: c(stages, stages - 1) = reshape([ &
        0.0_dp, -5.6688_dp, -2.430093356833875_dp, -0.1073529058151375_dp, 7.496443313967647_dp, &
        8.083246795921522_dp, &
        0.0_dp, 0.0_dp, -0.2063599157091915_dp, -9.594562251023355_dp, -10.24680431464352_dp, &
        -7.981132988064893_dp, &
        0.0_dp, 0.0_dp, 0.0_dp, -20.47028614809616_dp, -33.99990352819905_dp, &
        -31.52159432874371_dp, &
        0.0_dp, 0.0_dp, 0.0_dp, 0.0_dp, 11.70890893206160_dp, 16.31930543123136_dp, &
        0.0_dp, 0.0_dp, 0.0_dp, 0.0_dp, 0.0_dp, -6.058818238834054_dp], [stages, stages - 1])

    interface
        !> LAPACK: factors of a matrix by Gaussian elimination with partial pivoting.
        pure subroutine dgetrf(m, n, a, lda, ipiv, info)
            import :: dp
            implicit none
            integer, intent(in) :: m, n, lda
            real(dp), intent(inout) :: a(lda, n)
            integer, intent(out) :: ipiv(n), info
        end subroutine dgetrf

        !> LAPACK: solution by these factors.
        pure subroutine dgetrs(trans, n, nrhs, a, lda, ipiv, b, ldb, info)
            import :: dp
            implicit none
            character(len=1), intent(in) :: trans
            integer, intent(in) :: n, nrhs, lda, ldb, ipiv(n)
            real(dp), intent(in) :: a(lda, n)
            real(dp), intent(inout) :: b(ldb, nrhs)
            integer, intent(out) :: info
        end subroutine dgetrs
    end interface

contains

    !> From `y` at time `t` by `h`.
    pure subroutine rosenbrock_step(equations, t, h, y, first, scales, new, error, growth)
        type(slider_equations), intent(in) :: equations
        real(dp), intent(in) :: t, h                 !! [T]
        real(dp), intent(in) :: y(unknowns)
        real(dp), intent(in) :: first(unknowns)      !! rates at y
        real(dp), intent(in) :: scales(2, controlled)   !! of the unknowns: inverse of the
                                                        !! tolerated error, natural size
        real(dp), intent(out) :: new(unknowns)
        real(dp), intent(out) :: error    !! part of the tolerated one; huge if a rate is missing
        real(dp), intent(out) :: growth   !! size of the equations' derivative, by these scales
                                          !! [1/T]
        real(dp) :: j(unknowns, controlled), by_time(unknowns), k(unknowns, stages), &
            matrix(controlled, controlled), w(unknowns)
        logical :: failed
        integer :: i, info, pivot(controlled)

        error = huge(error)
        growth = 0.0_dp
        call differentiate(equations, t, h, y, first, scales(2, :), j, by_time, failed)
        if (failed) return
        do i = 1, controlled
            ! by natural sizes, so that no choice of units has a say in which pivot is taken
            matrix(i, :) = -j(i, :) * scales(2, :) / scales(2, i)
            growth = max(growth, sum(abs(matrix(i, :))))
        end do
        do i = 1, controlled
            matrix(i, i) = matrix(i, i) + 1.0_dp / (gamma * h)
        end do
        call dgetrf(controlled, controlled, matrix, controlled, pivot, info)
        if (info /= 0) return
        new = y
        do i = 1, stages
            w = y + matmul(k(:, :i - 1), a(i, :i - 1))
            if (i == 1) then
                k(:, 1) = first
            else
                call equations%rates(t + at(i) * h, w, k(:, i), failed)
                if (failed) return
            end if
            k(:, i) = k(:, i) + matmul(k(:, :i - 1), c(i, :i - 1)) / h + (h * d(i)) * by_time
            k(:controlled, i) = k(:controlled, i) / scales(2, :)
            call dgetrs('N', controlled, 1, matrix, controlled, pivot, k(:, i:i), unknowns, &
                info)
            k(:controlled, i) = k(:controlled, i) * scales(2, :)
            ! the others do not act on these
            k(controlled + 1:, i) = gamma * h * (k(controlled + 1:, i) &
                + matmul(j(controlled + 1:, :), k(:controlled, i)))
        end do
        new = w + k(:, stages)
        error = maxval(abs(k(:controlled, stages)) * scales(1, :))
        if (.not. all(abs(new) <= huge(error))) error = huge(error)
    end subroutine rosenbrock_step

    !> Derivatives of the rates by the unknowns that act on them, and by time, by differences: taken
    !> in the sense of the loading, so that a mirrored motion has the mirrored steps.
    pure subroutine differentiate(equations, t, h, y, first, natural, j, by_time, failed)
        type(slider_equations), intent(in) :: equations
        real(dp), intent(in) :: t, h, y(unknowns), first(unknowns), natural(controlled)
        real(dp), intent(out) :: j(unknowns, controlled)
        real(dp), intent(out) :: by_time(unknowns)
        logical, intent(out) :: failed
        real(dp), parameter :: little = 1.0e-8_dp
        integer, parameter :: mirrored(3) = [extension, velocity, elastic]
        real(dp) :: w(unknowns), dy(unknowns), steps(controlled), step
        integer :: i

        steps = little * max(abs(y(:controlled)), natural)
        steps(mirrored) = equations%forward * steps(mirrored)
        do i = 1, controlled
            w = y
            w(i) = y(i) + steps(i)
            step = w(i) - y(i)
            call equations%rates(t, w, dy, failed)
            if (failed) return
            j(:, i) = (dy - first) / step
        end do
        by_time = 0.0_dp
        if (equations%steady) return
        step = max(1.0e-3_dp * h, 16.0_dp * epsilon(t) * abs(t))
        call equations%rates(t + step, y, dy, failed)
        by_time = (dy - first) / step
    end subroutine differentiate

end module rosenbrock
