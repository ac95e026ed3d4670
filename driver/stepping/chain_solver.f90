!> Linear systems of a chain: symmetric, tridiagonal with one number beside the diagonal, and with
!> that number in the two corners if the chain is closed to a ring. In a time that is proportional
!> to the number of blocks: without pivoting where the matrix is positive definite, otherwise, and
!> for rings, by LAPACK.
module chain_solver
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use lapack_interface, only : dgtsv
    implicit none
    private

    public :: chain_matrix

    type :: chain_matrix
        logical :: ring = .false.
        real(dp) :: beside = 0.0_dp              !! the number beside the diagonal
        real(dp), allocatable :: diagonal(:)     !! destroyed by the solution
        real(dp), allocatable, private :: below(:), above(:), columns(:, :)
    contains
        procedure :: make_room, solve
    end type chain_matrix

contains

    !> For `n` rows; a ring has two or more.
    pure subroutine make_room(self, n, ring)
        class(chain_matrix), intent(inout) :: self
        integer, intent(in) :: n
        logical, intent(in) :: ring

        self%ring = ring
        self%diagonal = spread(0.0_dp, 1, n)
        self%below = self%diagonal
        self%above = self%diagonal
        if (ring) self%columns = reshape(spread(0.0_dp, 1, 2 * n), [n, 2])
    end subroutine make_room

    !> Turns the right-hand side into the solution; false if the matrix is singular.
    subroutine solve(self, x, solved)
        class(chain_matrix), intent(inout) :: self
        real(dp), intent(inout), contiguous :: x(:)
        logical, intent(out) :: solved
        integer, parameter :: few = 16   !! rows that LAPACK solves as fast
        integer :: info

        if (.not. self%ring .and. size(x) >= few) then
            call eliminate_to_middle(self%beside, self%diagonal, self%above, solved)
            if (solved) then
                call substitute(self%beside, self%above, x)
                return
            end if
        end if
        self%below = self%beside
        self%above = self%beside
        if (self%ring) then
            call solve_ring(self, x, info)
        else
            call dgtsv(size(x), 1, self%below, self%diagonal, self%above, x, size(x), info)
        end if
        solved = info == 0
    end subroutine solve

    !> Inverse pivots of an elimination from both ends to the middle row: a pivot waits for the
    !> division before it, and two wait together. All are positive if the matrix is positive
    !> definite.
    pure subroutine eliminate_to_middle(beside, diagonal, inverse, definite)
        real(dp), intent(in) :: beside
        real(dp), intent(in), contiguous :: diagonal(:)
        real(dp), intent(inout), contiguous :: inverse(:)
        logical, intent(out) :: definite
        real(dp) :: square, top, bottom, least
        integer :: n, i

        n = size(diagonal)
        square = beside**2
        top = 0.0_dp
        bottom = 0.0_dp
        least = huge(least)
        do i = 1, (n - 1) / 2
            top = diagonal(i) - square * top
            bottom = diagonal(n + 1 - i) - square * bottom
            least = min(least, top, bottom)
            if (least <= 0.0_dp) exit
            top = 1.0_dp / top
            bottom = 1.0_dp / bottom
            inverse(i) = top
            inverse(n + 1 - i) = bottom
        end do
        definite = .false.
        if (.not. least > 0.0_dp) return
        if (mod(n, 2) == 0) then   ! one row more above the middle
            top = diagonal(n / 2) - square * top
            if (.not. top > 0.0_dp) return
            top = 1.0_dp / top
            inverse(n / 2) = top
        end if
        top = diagonal(n / 2 + 1) - square * (top + bottom)
        definite = top > 0.0_dp
        if (definite) inverse(n / 2 + 1) = 1.0_dp / top
    end subroutine eliminate_to_middle

    !> Turns the right-hand side into the solution, from the ends to the middle and back.
    pure subroutine substitute(beside, inverse, x)
        real(dp), intent(in) :: beside
        real(dp), intent(in), contiguous :: inverse(:)   !! pivots of `eliminate_to_middle`
        real(dp), intent(inout), contiguous :: x(:)
        integer :: n, i, middle

        n = size(x)
        middle = n / 2 + 1
        x(1) = x(1) * inverse(1)
        x(n) = x(n) * inverse(n)
        do i = 2, (n - 1) / 2
            x(i) = (x(i) - beside * x(i - 1)) * inverse(i)
            x(n + 1 - i) = (x(n + 1 - i) - beside * x(n + 2 - i)) * inverse(n + 1 - i)
        end do
        if (mod(n, 2) == 0) x(n / 2) = (x(n / 2) - beside * x(n / 2 - 1)) * inverse(n / 2)
        x(middle) = (x(middle) - beside * (x(middle - 1) + x(middle + 1))) * inverse(middle)
        if (mod(n, 2) == 0) x(n / 2) = x(n / 2) - beside * inverse(n / 2) * x(middle)
        do i = (n - 1) / 2, 1, -1
            x(i) = x(i) - beside * inverse(i) * x(i + 1)
            x(n + 1 - i) = x(n + 1 - i) - beside * inverse(n + 1 - i) * x(n - i)
        end do
    end subroutine substitute

    !> The corners as a matrix of rank one, p q^T with p = (g, 0, ..., b) and q = (1, 0, ..., b/g),
    !> added to a tridiagonal one (Sherman and Morrison). g = -d(1) keeps clear of cancellation.
    pure subroutine solve_ring(self, x, info)
        class(chain_matrix), intent(inout) :: self
        real(dp), intent(inout) :: x(:)
        integer, intent(out) :: info
        real(dp) :: b, g, denominator
        integer :: n

        n = size(x)
        b = self%beside
        g = -self%diagonal(1)
        if (.not. abs(g) > 0.0_dp) g = -b
        self%diagonal(1) = self%diagonal(1) - g
        self%diagonal(n) = self%diagonal(n) - b**2 / g
        self%columns(:, 1) = x
        self%columns(:, 2) = 0.0_dp
        self%columns(1, 2) = g
        self%columns(n, 2) = b
        call dgtsv(n, 2, self%below, self%diagonal, self%above, self%columns, n, info)
        if (info /= 0) return
        associate (y => self%columns(:, 1), z => self%columns(:, 2))
            denominator = 1.0_dp + z(1) + b * z(n) / g
            info = 1
            if (.not. abs(denominator) > 0.0_dp) return
            x = y - (y(1) + b * y(n) / g) / denominator * z
        end associate
        info = 0
    end subroutine solve_ring

end module chain_solver
