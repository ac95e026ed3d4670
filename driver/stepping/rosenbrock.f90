!> One step of Rodas4, the stiffly accurate Rosenbrock method of order 4(3) of Hairer and Wanner
!> (Solving Ordinary Differential Equations II, section IV.7), for the rate equations of a block,
!> and of a chain.
module rosenbrock
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use chain_rates, only : chain_equations
    use chain_solver, only : chain_matrix
    use lapack_interface, only : dgeev, dgetrf
    use slider_rates, only : along, controlled, elastic, extension, ratio, slider_equations, &
        unknowns, velocity
    implicit none
    private

    public :: chain_stepper, growth_rate, rosenbrock_step

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

    !> Steps of a chain, and room for one.
    type :: chain_stepper
        !> Of each block: natural sizes of the unknowns, the inverse of the tolerated errors.
        real(dp), allocatable, dimension(:, :) :: natural, weights
        real(dp), allocatable, private :: j(:, :, :), by_time(:, :), k(:, :, :), &
            matrix(:, :, :), answer(:, :), share(:)
        integer, allocatable, private :: pivot(:, :)
        type(chain_matrix), private :: neighbours
    contains
        procedure :: make_room, step
        procedure, private :: factorise_all, solve_all
    end type chain_stepper

contains

    !> From `y` at time `t` by `h`.
    pure subroutine rosenbrock_step(equations, t, h, y, first, scales, new, error, growth)
        type(slider_equations), intent(in) :: equations
        real(dp), intent(in) :: t, h                 !! [T]
        real(dp), intent(in) :: y(unknowns)
        real(dp), intent(in) :: first(unknowns)      !! rates at y
        real(dp), intent(in) :: scales(controlled, 2)   !! of the unknowns: inverse of the
                                                        !! tolerated error, natural size
        real(dp), intent(out) :: new(unknowns)
        real(dp), intent(out) :: error    !! part of the tolerated one; huge if a rate is missing
        real(dp), intent(out) :: growth   !! size of the equations' derivative, by these scales
                                          !! [1/T]
        real(dp) :: j(unknowns, controlled), by_time(unknowns), k(unknowns, stages), &
            matrix(controlled, controlled), w(unknowns)
        logical :: failed
        integer :: n   !! unknowns that act on the others
        integer :: i, pivot(controlled)

        error = huge(error)
        growth = 0.0_dp
        n = merge(controlled, along, equations%across%free())
        call differentiate(n, equations, t, h, y, first, scales(:, 2), j, by_time, failed)
        if (failed) return
        call factorise(n, j, h, scales(:, 2), matrix, pivot, growth, failed)
        if (failed) return
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
            call solve(n, matrix, pivot, scales(:, 2), k(:n, i))
            call follow(n, j, h, k(:, i))
        end do
        new = w + k(:, stages)
        error = maxval(abs(k(:n, stages)) * scales(:n, 1))
        if (.not. all(abs(new) <= huge(error))) error = huge(error)
    end subroutine rosenbrock_step

    !> Factors of a step's matrix, by natural sizes, so that no choice of units has a say in which
    !> pivot is taken.
    pure subroutine factorise(n, j, h, natural, matrix, pivot, growth, failed)
        integer, intent(in) :: n
        real(dp), intent(in) :: j(unknowns, n), h, natural(n)
        real(dp), intent(out) :: matrix(n, n)
        integer, intent(out) :: pivot(n)
        real(dp), intent(out) :: growth   !! size of the equations' derivative [1/T]
        logical, intent(out) :: failed
        integer :: i, info

        growth = 0.0_dp
        do i = 1, n
            matrix(i, :) = -j(i, :) * natural / natural(i)
            growth = max(growth, sum(abs(matrix(i, :))))
        end do
        do i = 1, n
            matrix(i, i) = matrix(i, i) + 1.0_dp / (gamma * h)
        end do
        call dgetrf(n, n, matrix, n, pivot, info)
        failed = info /= 0
    end subroutine factorise

    !> Solution by these factors: LAPACK's takes twice as long for so few unknowns.
    pure subroutine solve(n, matrix, pivot, natural, k)
        integer, intent(in) :: n, pivot(n)
        real(dp), intent(in) :: matrix(n, n), natural(n)
        real(dp), intent(inout) :: k(n)
        real(dp) :: other
        integer :: i

        k = k / natural
        do i = 1, n
            other = k(pivot(i))
            k(pivot(i)) = k(i)
            k(i) = other
        end do
        do i = 1, n
            k(i + 1:) = k(i + 1:) - k(i) * matrix(i + 1:, i)
        end do
        do i = n, 1, -1
            k(i) = k(i) / matrix(i, i)
            k(:i - 1) = k(:i - 1) - k(i) * matrix(:i - 1, i)
        end do
        k = k * natural
    end subroutine solve

    !> The unknowns that do not act on the others.
    pure subroutine follow(n, j, h, k)
        integer, intent(in) :: n
        real(dp), intent(in) :: j(unknowns, n), h
        real(dp), intent(inout) :: k(unknowns)

        k(controlled + 1:) = gamma * h * (k(controlled + 1:) + matmul(j(controlled + 1:, :), &
            k(:n)))
    end subroutine follow

    !> For a number of blocks.
    subroutine make_room(self, blocks, ring)
        class(chain_stepper), intent(inout) :: self
        integer, intent(in) :: blocks
        logical, intent(in) :: ring

        allocate (self%natural(controlled, blocks), self%weights(controlled, blocks))
        allocate (self%j(unknowns, along, blocks), self%by_time(unknowns, blocks), &
            self%k(unknowns, blocks, stages), self%matrix(along, along, blocks), &
            self%answer(along, blocks), self%share(blocks), self%pivot(along, blocks))
        call self%neighbours%make_room(blocks, ring)
    end subroutine make_room

    !> From `y` at time `t` by `h`.
    subroutine step(self, chain, t, h, y, first, new, error)
        class(chain_stepper), intent(inout) :: self
        type(chain_equations), intent(in) :: chain
        real(dp), intent(in) :: t, h                    !! [T]
        real(dp), intent(in) :: y(:, :), first(:, :)    !! unknowns and their rates, a column a
                                                        !! block
        real(dp), intent(inout) :: new(:, :)
        real(dp), intent(out) :: error    !! part of the tolerated one; huge if a rate is missing
        logical :: failed
        integer :: i, l

        error = huge(error)
        call self%factorise_all(chain, t, h, y, failed)
        if (failed) return
        do i = 1, stages
            new(:, :) = y
            do l = 1, i - 1
                new(:, :) = new + a(i, l) * self%k(:, :, l)
            end do
            if (i == 1) then
                self%k(:, :, 1) = first
            else
                call chain%rates(t + at(i) * h, new, self%k(:, :, i), failed)
                if (failed) return
            end if
            self%k(:, :, i) = self%k(:, :, i) + (h * d(i)) * self%by_time
            do l = 1, i - 1
                self%k(:, :, i) = self%k(:, :, i) + (c(i, l) / h) * self%k(:, :, l)
            end do
            call self%solve_all(chain, h, self%k(:, :, i), failed)
            if (failed) return
        end do
        new(:, :) = new + self%k(:, :, stages)
        error = maxval(abs(self%k(:along, :, stages)) * self%weights(:along, :))
        if (.not. all(abs(new) <= huge(error))) error = huge(error)
    end subroutine step

    !> Derivatives and matrices of all blocks. A block's neighbours act on its velocity by the
    !> extensions of their drive springs alone: `answer` is what its unknowns do then.
    subroutine factorise_all(self, chain, t, h, y, failed)
        class(chain_stepper), intent(inout) :: self
        type(chain_equations), intent(in) :: chain
        real(dp), intent(in) :: t, h, y(:, :)
        logical, intent(out) :: failed
        real(dp) :: own(unknowns), growth
        integer :: i, n

        n = size(y, 2)
        do i = 1, n
            associate (block => chain%blocks(min(i, size(chain%blocks))))
                call block%rates(t, y(:controlled, i), own, failed)
                if (failed) return
                call differentiate(along, block, t, h, y(:, i), own, self%natural(:, i), &
                    self%j(:, :, i), self%by_time(:, i), failed)
            end associate
            if (failed) return
            self%j(velocity, extension, i) = self%j(velocity, extension, i) &
                + chain%by_own_extension(i, n)
            self%by_time(velocity, i) = self%by_time(velocity, i) + chain%by_walls(i, n, t)
            call factorise(along, self%j(:, :, i), h, self%natural(:, i), self%matrix(:, :, i), &
                self%pivot(:, i), growth, failed)
            if (failed) return
            self%answer(:, i) = 0.0_dp
            self%answer(velocity, i) = 1.0_dp / chain%system%mass
            call solve(along, self%matrix(:, :, i), self%pivot(:, i), self%natural(:, i), &
                self%answer(:, i))
        end do
    end subroutine factorise_all

    !> Turns right-hand sides into solutions: a tridiagonal system for the extensions, the other
    !> unknowns of each block by themselves.
    subroutine solve_all(self, chain, h, k, failed)
        class(chain_stepper), intent(inout) :: self
        type(chain_equations), intent(in) :: chain
        real(dp), intent(in) :: h
        real(dp), intent(inout) :: k(:, :)
        logical, intent(out) :: failed
        real(dp) :: pulled(size(k, 2))   !! force of the neighbours, a rate
        integer :: i
        logical :: solved

        do i = 1, size(k, 2)
            call solve(along, self%matrix(:, :, i), self%pivot(:, i), self%natural(:, i), &
                k(:along, i))
        end do
        if (chain%system%coupling > 0.0_dp) then
            self%neighbours%beside = -chain%system%coupling
            self%neighbours%diagonal = -1.0_dp / self%answer(extension, :)
            self%share = self%neighbours%diagonal * k(extension, :)
            pulled = self%share
            call self%neighbours%solve(self%share, solved)
            failed = .not. solved
            if (failed) return
            pulled = self%share / self%answer(extension, :) + pulled
            do i = 1, size(k, 2)
                k(:along, i) = k(:along, i) + self%answer(:, i) * pulled(i)
            end do
        end if
        failed = .false.
        do i = 1, size(k, 2)
            call follow(along, self%j(:, :, i), h, k(:, i))
        end do
    end subroutine solve_all

    !> Derivatives of the rates by the unknowns that act on them, and by time, by differences: taken
    !> in the sense in which the block moves, so that none turns it back, which unloads the contact.
    pure subroutine differentiate(n, equations, t, h, y, first, natural, j, by_time, failed)
        integer, intent(in) :: n
        type(slider_equations), intent(in) :: equations
        real(dp), intent(in) :: t, h, y(unknowns), first(unknowns), natural(n)
        real(dp), intent(out) :: j(unknowns, n)
        real(dp), intent(out) :: by_time(unknowns)
        logical, intent(out) :: failed
        real(dp), parameter :: little = 1.0e-8_dp
        real(dp) :: w(unknowns), dy(unknowns), steps(controlled), step, v_drive, pressure, &
            pressure_rate, sense
        integer :: i

        steps(:n) = little * max(abs(y(:n)), natural)
        ! it may be far smaller than 1, and its rate changes with its logarithm
        if (equations%least_share > 0.0_dp) steps(ratio) = little * max(abs(y(ratio)), &
            equations%least_share)
        call equations%inputs(t, y, v_drive, pressure, pressure_rate)
        sense = equations%sense_of(v_drive - first(extension))
        steps(extension:velocity) = sense * steps(extension:velocity)
        steps(elastic) = merge(equations%forward, -sense, equations%mass > 0.0_dp) * steps(elastic)
        do i = 1, n
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

    !> How fast the smallest disturbance grows [1/T]; 0: it does not, but for what differences tell.
    pure function growth_rate(equations, t, y, first, natural) result(rate)
        type(slider_equations), intent(in) :: equations
        real(dp), intent(in) :: t, y(unknowns), first(unknowns)   !! the last: rates at y
        real(dp), intent(in) :: natural(controlled)
        real(dp) :: rate
        real(dp), parameter :: noise = 1.0e-6_dp   !! part of the size of the derivative
        real(dp) :: j(unknowns, controlled), by_time(unknowns), re(controlled), im(controlled), &
            left(1, controlled), right(1, controlled), work(4 * controlled)
        logical :: failed
        integer :: n, i, info

        rate = 0.0_dp
        n = equations%acting
        call differentiate(n, equations, t, 0.0_dp, y, first, natural, j, by_time, failed)
        if (failed) return
        do i = 1, n
            j(i, :n) = j(i, :n) * natural(:n) / natural(i)
        end do
        associate (most => maxval(sum(abs(j(:n, :n)), dim=2)))
            call dgeev('N', 'N', n, j, unknowns, re, im, left, 1, right, 1, work, size(work), info)
            if (info == 0) rate = maxval(re(:n))
            if (rate < noise * most) rate = 0.0_dp
        end associate
    end function growth_rate

end module rosenbrock
