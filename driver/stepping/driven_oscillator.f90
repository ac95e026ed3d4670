!> The damped oscillator `M x'' + C x' + k x = g` under a force that varies linearly in time, solved
!> exactly over a step from x = 0:
!>
!>     x(h)  = h v s + h^2/M (i_0 g(0) + i_1 (g(h) - g(0)))
!>     x'(h) = v s' + h/M (s g(0) + i_0 (g(h) - g(0)))
!>
!>     mean of x = h v i_0 + h^2/M (i_1 g(0) + i_2 (g(h) - g(0)))
!>
!> with s(t), t = time/h, the solution of s'' + 2 b s' + z s = 0, s(0) = 0, s'(0) = 1, and its
!> integrals from 0 to 1: i_0 of s, i_1 of i_0, i_2 of i_1; b = C h/(2 M), z = k h^2/M.
module driven_oscillator
    use, intrinsic :: iso_fortran_env, only : dp => real64
    implicit none
    private

    public :: oscillator, responses

    !> Responses at the end of a step, all of them numbers without unit.
    type :: oscillator
        real(dp) :: s, ds      !! to a velocity: displacement and velocity
        real(dp) :: i0, i1     !! to a constant and to a rising force: displacement
        real(dp) :: i2         !! to a rising force: mean displacement
    end type oscillator

contains

    pure function responses(mass, damping, stiffness, h) result(o)
        real(dp), intent(in) :: mass        !! > 0 [M]
        real(dp), intent(in) :: damping     !! >= 0 [F T/L]
        real(dp), intent(in) :: stiffness   !! of any sign [F/L]
        real(dp), intent(in) :: h           !! the step, > 0 [T]
        type(oscillator) :: o
        real(dp), parameter :: apart = 0.25_dp   !! roots that a difference can be divided by
        real(dp) :: b, z

        b = 0.5_dp * damping * h / mass
        z = stiffness * h**2 / mass
        if (abs(z) <= 1.0_dp .and. b <= 1.0_dp) then
            o = by_series(b, z)
        else if (b**2 - z > apart) then
            o = by_roots(b, z)
        else
            o = by_phase(b, z)
        end if
    end function responses

    !> Powers of t, up to where they no longer count.
    pure function by_series(b, z) result(o)
        real(dp), intent(in) :: b, z   !! at most 1
        type(oscillator) :: o
        integer, parameter :: most_terms = 40
        integer :: n
        real(dp), parameter :: one_over(most_terms + 3) = [(1.0_dp / n, n = 1, most_terms + 3)]
        real(dp) :: a, before, next   ! coefficients of s

        before = 0.0_dp
        a = 1.0_dp
        o = oscillator(s=1.0_dp, ds=1.0_dp, i0=one_over(2), i1=one_over(2) * one_over(3), &
            i2=one_over(2) * one_over(3) * one_over(4))
        do n = 2, most_terms
            next = -(2.0_dp * b * one_over(n) * a + z * one_over(n) * one_over(n - 1) * before)
            before = a
            a = next
            o%s = o%s + a
            o%ds = o%ds + n * a
            o%i0 = o%i0 + a * one_over(n + 1)
            next = a * (one_over(n + 1) * one_over(n + 2))
            o%i1 = o%i1 + next
            o%i2 = o%i2 + next * one_over(n + 3)
            if (n * (abs(a) + abs(before)) < 0.1_dp * epsilon(a)) exit
        end do
    end function by_series

    !> Two real roots, well apart: the responses are divided differences of exponentials.
    pure function by_roots(b, z) result(o)
        real(dp), intent(in) :: b, z
        type(oscillator) :: o
        real(dp) :: slow, fast, width

        width = sqrt(b**2 - z)
        fast = -(b + width)
        slow = z / fast
        width = slow - fast
        o%s = (exp(slow) - exp(fast)) / width
        o%ds = (slow * exp(slow) - fast * exp(fast)) / width
        o%i0 = (phi_1(slow) - phi_1(fast)) / width
        o%i1 = (phi_2(slow) - phi_2(fast)) / width
        o%i2 = (phi_3(slow) - phi_3(fast)) / width
    end function by_roots

    !> Oscillation, or nearly so; z is not small here.
    pure function by_phase(b, z) result(o)
        real(dp), intent(in) :: b, z
        type(oscillator) :: o
        real(dp) :: phase

        phase = sqrt(abs(z - b**2))
        if (z > b**2) then
            o%s = exp(-b) * sin(phase) / phase
            o%ds = exp(-b) * cos(phase)
        else
            o%s = exp(-b)
            if (phase > 0.0_dp) o%s = o%s * sinh(phase) / phase
            o%ds = exp(-b) * cosh(phase)
        end if
        o%ds = o%ds - b * o%s
        o%i0 = (1.0_dp - o%ds - 2.0_dp * b * o%s) / z
        o%i1 = (1.0_dp - o%s - 2.0_dp * b * o%i0) / z
        o%i2 = (0.5_dp - o%i0 - 2.0_dp * b * o%i1) / z
    end function by_phase

    !> (exp(r) - 1)/r
    pure function phi_1(r) result(phi)
        real(dp), intent(in) :: r
        real(dp) :: phi

        if (abs(r) < 1.0_dp) then
            phi = 1.0_dp + r * phi_2(r)
        else
            phi = (exp(r) - 1.0_dp) / r
        end if
    end function phi_1

    !> (exp(r) - 1 - r)/r^2
    pure function phi_2(r) result(phi)
        real(dp), intent(in) :: r
        real(dp) :: phi

        if (abs(r) < 1.0_dp) then
            phi = 0.5_dp + r * phi_3(r)
        else
            phi = (exp(r) - 1.0_dp - r) / r**2
        end if
    end function phi_2

    !> (exp(r) - 1 - r - r^2/2)/r^3
    pure function phi_3(r) result(phi)
        real(dp), intent(in) :: r
        real(dp) :: phi
        integer :: n

        if (abs(r) < 1.0_dp) then
            phi = 0.0_dp
            do n = 20, 4, -1
                phi = (1.0_dp + r * phi) / n
            end do
            phi = (1.0_dp + r * phi) / 6.0_dp
        else
            phi = (exp(r) - 1.0_dp - r - 0.5_dp * r**2) / r**3
        end if
    end function phi_3

end module driven_oscillator
