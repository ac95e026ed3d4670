!> One step of an explicit Runge-Kutta method 5(4) for the rate equations of a block: Dormand and
!> Prince's (J. Comput. Appl. Math. 6, 1980) or Tsitouras' (Comput. Math. Appl. 62, 2011), whose
!> errors are a fraction of the former's, but which amplifies what swings undamped in shorter steps.
module explicit_pairs
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use slider_rates, only : controlled, slider_equations, unknowns
    implicit none
    private

    public :: explicit_pair, explicit_step

    !> Seven stages, of which the last is the first of the next step.
    type :: explicit_pair
        real(dp) :: c(2:5)                           !! times; those after them are the step's end
        real(dp) :: a2(1), a3(2), a4(3), a5(4), a6(5)
        real(dp) :: b(6)                             !! of order five
        real(dp) :: e(7)                             !! that less the one of order four
        real(dp) :: neutral   !! an undamped oscillation is amplified by longer steps: phase in one
        real(dp) :: bound     !! of stable steps on the real axis
    end type explicit_pair

    type(explicit_pair), parameter, public :: dormand_prince = explicit_pair( &
        c=[1.0_dp / 5, 3.0_dp / 10, 4.0_dp / 5, 8.0_dp / 9], &
        a2=[1.0_dp / 5], a3=[3.0_dp / 40, 9.0_dp / 40], &
        a4=[44.0_dp / 45, -56.0_dp / 15, 32.0_dp / 9], &
        a5=[19372.0_dp / 6561, -25360.0_dp / 2187, 64448.0_dp / 6561, -212.0_dp / 729], &
        a6=[9017.0_dp / 3168, -355.0_dp / 33, 46732.0_dp / 5247, 49.0_dp / 176, &
        -5103.0_dp / 18656], &
        b=[35.0_dp / 384, 0.0_dp, 500.0_dp / 1113, 125.0_dp / 192, -2187.0_dp / 6784, &
        11.0_dp / 84], &
        e=[71.0_dp / 57600, 0.0_dp, -71.0_dp / 16695, 71.0_dp / 1920, -17253.0_dp / 339200, &
        22.0_dp / 525, -1.0_dp / 40], neutral=0.998_dp, bound=3.25_dp)

    !> The difference counts three times: so errors of event times are no larger than those of the
    !> other pair under the same tolerance, damped or not (Soederlind and Wang, J. Comput. Appl.
    !> Math. 185, 2006, on tolerances that mean the same to several methods).
    type(explicit_pair), parameter, public :: tsitouras = explicit_pair( &
        c=[0.161_dp, 0.327_dp, 0.9_dp, 0.9800255409045097_dp], &
        a2=[0.161_dp], a3=[-0.008480655492356989_dp, 0.335480655492357_dp], &
        a4=[2.8971530571054935_dp, -6.359448489975075_dp, 4.3622954328695815_dp], &
        a5=[5.325864828439257_dp, -11.748883564062828_dp, 7.4955393428898365_dp, &
        -0.09249506636175525_dp], &
        a6=[5.86145544294642_dp, -12.92096931784711_dp, 8.159367898576159_dp, &
        -0.071584973281401_dp, -0.028269050394068383_dp], &
        b=[0.09646076681806523_dp, 0.01_dp, 0.4798896504144996_dp, 1.379008574103742_dp, &
        -3.290069515436081_dp, 2.324710524099774_dp], &
        e=3.0_dp * [-0.001780011052225777_dp, -0.0008164344596567469_dp, &
        0.007880878010261995_dp, -0.1447110071732629_dp, 0.5823571654525552_dp, &
        -0.45808210592918697_dp, 1.0_dp / 66], &
        neutral=0.478_dp, bound=3.45_dp)

contains

    !> From `y` at time `t` by `h`.
    pure subroutine explicit_step(pair, equations, t, h, y, first, weights, new, last, error, &
        stiffness)
        type(explicit_pair), intent(in) :: pair
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
        associate (c => pair%c, a2 => pair%a2, a3 => pair%a3, a4 => pair%a4, a5 => pair%a5, &
            a6 => pair%a6, b => pair%b, e => pair%e)
            ! what a processor waits for, the rates of the stage before, comes last in each sum
            w(:n) = y(:n) + (h * a2(1)) * first(:n)
            call equations%rates(t + c(2) * h, w, k2, failed)
            if (failed) return
            w(:n) = (y(:n) + (h * a3(1)) * first(:n)) + (h * a3(2)) * k2(:n)
            call equations%rates(t + c(3) * h, w, k3, failed)
            if (failed) return
            w(:n) = (y(:n) + h * (a4(1) * first(:n) + a4(2) * k2(:n))) + (h * a4(3)) * k3(:n)
            call equations%rates(t + c(4) * h, w, k4, failed)
            if (failed) return
            w(:n) = (y(:n) + h * (a5(1) * first(:n) + a5(2) * k2(:n) + a5(3) * k3(:n))) &
                + (h * a5(4)) * k4(:n)
            call equations%rates(t + c(5) * h, w, k5, failed)
            if (failed) return
            w(:n) = (y(:n) + h * (a6(1) * first(:n) + a6(2) * k2(:n) + a6(3) * k3(:n) + a6(4) &
                * k4(:n))) + (h * a6(5)) * k5(:n)
            call equations%rates(t + h, w, k6, failed)
            if (failed) return
            new = (y + h * (b(1) * first + b(2) * k2 + b(3) * k3 + b(4) * k4 + b(5) * k5)) &
                + (h * b(6)) * k6
            call equations%rates(t + h, new, last, failed)
            if (failed) return
            error = 0.0_dp
            change = 0.0_dp
            way = 0.0_dp
            do i = 1, n
                error = max(error, abs(h * (e(1) * first(i) + e(2) * k2(i) + e(3) * k3(i) + e(4) &
                    * k4(i) + e(5) * k5(i) + e(6) * k6(i) + e(7) * last(i))) * weights(i))
                change = change + ((last(i) - k6(i)) * weights(i))**2
                way = way + ((new(i) - w(i)) * weights(i))**2
            end do
        end associate
        stiffness = h * sqrt(change / max(way, tiny(way)))
        if (.not. error <= huge(error)) error = huge(error)   ! not a number
    end subroutine explicit_step

end module explicit_pairs
