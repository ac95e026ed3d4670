!> One step of the explicit Runge-Kutta method 5(4) of Dormand and Prince (J. Comput. Appl. Math. 6,
!> 1980) for the rate equations of a block.
module dormand_prince
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use slider_rates, only : controlled, slider_equations, unknowns
    implicit none
    private

    public :: dormand_prince_step

    real(dp), parameter :: c2 = 1.0_dp / 5, c3 = 3.0_dp / 10, c4 = 4.0_dp / 5, c5 = 8.0_dp / 9
    real(dp), parameter :: a21 = 1.0_dp / 5, a31 = 3.0_dp / 40, a32 = 9.0_dp / 40, &
        a41 = 44.0_dp / 45, a42 = -56.0_dp / 15, a43 = 32.0_dp / 9, a51 = 19372.0_dp / 6561, &
        a52 = -25360.0_dp / 2187, a53 = 64448.0_dp / 6561, a54 = -212.0_dp / 729, &
        a61 = 9017.0_dp / 3168, a62 = -355.0_dp / 33, a63 = 46732.0_dp / 5247, &
        a64 = 49.0_dp / 176, a65 = -5103.0_dp / 18656
    real(dp), parameter :: b1 = 35.0_dp / 384, b3 = 500.0_dp / 1113, b4 = 125.0_dp / 192, &
        b5 = -2187.0_dp / 6784, b6 = 11.0_dp / 84
    !> Fifth order less fourth.
    real(dp), parameter :: e1 = 71.0_dp / 57600, e3 = -71.0_dp / 16695, e4 = 71.0_dp / 1920, &
        e5 = -17253.0_dp / 339200, e6 = 22.0_dp / 525, e7 = -1.0_dp / 40

contains

    !> From `y` at time `t` by `h`.
    pure subroutine dormand_prince_step(equations, t, h, y, first, weights, new, last, error, &
        stiffness)
        type(slider_equations), intent(in) :: equations
        real(dp), intent(in) :: t, h                   !! [T]
        real(dp), intent(in) :: y(unknowns)
        real(dp), intent(in) :: first(unknowns)        !! rates at y
        real(dp), intent(in) :: weights(controlled)    !! inverse of the tolerated errors
        real(dp), intent(out) :: new(unknowns)
        real(dp), intent(out) :: last(unknowns)        !! rates at the end
        real(dp), intent(out) :: error       !! part of the tolerated one; huge if a rate is missing
        real(dp), intent(out) :: stiffness   !! h times the size of the equations' derivative
        real(dp), dimension(unknowns) :: k2, k3, k4, k5, k6
        real(dp) :: w(controlled)
        real(dp) :: change, way
        logical :: failed
        integer :: n, i

        n = equations%acting
        error = huge(error)
        stiffness = 0.0_dp
        w(:n) = y(:n) + h * (a21 * first(:n))
        call equations%rates(t + c2 * h, w, k2, failed)
        if (failed) return
        w(:n) = y(:n) + h * (a31 * first(:n) + a32 * k2(:n))
        call equations%rates(t + c3 * h, w, k3, failed)
        if (failed) return
        w(:n) = y(:n) + h * (a41 * first(:n) + a42 * k2(:n) + a43 * k3(:n))
        call equations%rates(t + c4 * h, w, k4, failed)
        if (failed) return
        w(:n) = y(:n) + h * (a51 * first(:n) + a52 * k2(:n) + a53 * k3(:n) + a54 * k4(:n))
        call equations%rates(t + c5 * h, w, k5, failed)
        if (failed) return
        w(:n) = y(:n) + h * (a61 * first(:n) + a62 * k2(:n) + a63 * k3(:n) + a64 * k4(:n) &
            + a65 * k5(:n))
        call equations%rates(t + h, w, k6, failed)
        if (failed) return
        new = y + h * (b1 * first + b3 * k3 + b4 * k4 + b5 * k5 + b6 * k6)
        call equations%rates(t + h, new, last, failed)
        if (failed) return
        error = 0.0_dp
        change = 0.0_dp
        way = 0.0_dp
        do i = 1, n
            error = max(error, abs(h * (e1 * first(i) + e3 * k3(i) + e4 * k4(i) + e5 * k5(i) &
                + e6 * k6(i) + e7 * last(i))) * weights(i))
            change = change + ((last(i) - k6(i)) * weights(i))**2
            way = way + ((new(i) - w(i)) * weights(i))**2
        end do
        stiffness = h * sqrt(change / max(way, tiny(way)))
        if (.not. error <= huge(error)) error = huge(error)   ! not a number
    end subroutine dormand_prince_step

end module dormand_prince
