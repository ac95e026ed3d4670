!> The subloading law's update in quadruple precision by another road than the library's: the
!> evolution law gives the slip explicitly from R, and plain bisection on R solves the rest. Slow,
!> simple, and to 30 digits. Both schemes of time integration: backward Euler and exact rate.
module reference_update
    use, intrinsic :: iso_fortran_env, only : dp => real64, real128
    implicit none
    private

    public :: count_equilibria, exponential_integral, reference_tangent, reference_traction

    integer, parameter, public :: qp = real128
    integer, parameter :: n_grid = 3000

    !> The scalar equation of an increment that slips.
    type :: slip_equation
        real(qp) :: trial, alpha_t, mu_s, mu_k, kappa, xi, m, p, dt, mu_n, r_n
        logical :: exact   !! scheme: exact rate
    end type slip_equation

contains

    !> Traction at the end of an increment, 3 components; `first` takes the first of several
    !> equilibria.
    function reference_traction(du, dt, props, statev, first) result(traction)
        real(qp), intent(in) :: du(3), dt
        real(dp), intent(in) :: props(:), statev(8)
        logical, intent(in), optional :: first
        real(qp) :: traction(3)
        type(slip_equation) :: eq
        real(qp) :: u_n, q(2), part, r

        traction = 0.0_qp
        u_n = statev(2) + du(1)
        if (u_n >= 0.0_qp) return
        part = 1.0_qp
        if (statev(2) > 0.0_dp) part = u_n / du(1)
        q = statev(3:4) + part * du(2:3)
        eq = equation(sqrt(sum(q**2)), u_n, dt, props, statev)
        if (eq%exact .and. statev(2) < 0.0_dp) eq%r_n = min(eq%r_n, least_ratio(eq, &
            real(statev(3:4), qp), q, -props(2) * real(statev(2), qp)))
        traction(1) = props(2) * u_n
        traction(2:3) = props(3) * q
        if (eq%trial <= eq%r_n * friction(eq, 0.0_qp) * eq%p) return
        if (eq%exact) then
            traction(2:3) = exact_resistance(eq, first) * q / sqrt(sum(q**2))
            return
        end if
        r = root(eq, first)
        traction(2:3) = r * friction(eq, slip(eq, r)) * eq%p * q / sqrt(sum(q**2))
    end function reference_traction

    !> d(traction)/d(du) by central differences of the above: error below 1e-15 of the stiffness.
    function reference_tangent(du, dt, props, statev) result(tangent)
        real(dp), intent(in) :: du(3), dt, props(:), statev(8)
        real(dp) :: tangent(3, 3)
        real(qp) :: h, plus(3), minus(3), scale
        integer :: j

        scale = sqrt(sum(real(du, qp)**2)) + sqrt(sum(real(statev(3:4), qp)**2))
        h = 1.0e-13_qp * scale
        do j = 1, 3
            plus = du
            minus = du
            plus(j) = plus(j) + h
            minus(j) = minus(j) - h
            tangent(:, j) = real((reference_traction(plus, real(dt, qp), props, statev) &
                - reference_traction(minus, real(dt, qp), props, statev)) / (2.0_qp * h), dp)
        end do
    end function reference_tangent

    !> How many equilibria has the scalar equation of this increment? Counts changes of sign on a
    !> dense grid.
    function count_equilibria(du, dt, props, statev) result(count)
        real(dp), intent(in) :: du(3), dt, props(:), statev(8)
        integer :: count
        type(slip_equation) :: eq
        real(qp) :: q(2)

        q = real(statev(3:4), qp) + du(2:3)
        eq = equation(sqrt(sum(q**2)), real(statev(2), qp) + du(1), real(dt, qp), props, statev)
        if (eq%exact) then
            count = exact_crossings(eq)
        else
            count = size(crossings(eq))
        end if
    end function count_equilibria

    function equation(distance, u_n, dt, props, statev) result(eq)
        real(qp), intent(in) :: distance, u_n, dt
        real(dp), intent(in) :: props(:), statev(8)
        type(slip_equation) :: eq
        real(dp) :: mu_n

        mu_n = statev(5)
        if (nint(statev(1)) == 0) then
            mu_n = props(4)
            if (size(props) > 8) mu_n = props(9)
        end if
        eq = slip_equation(trial=props(3) * distance, alpha_t=real(props(3), qp), &
            mu_s=real(props(4), qp), mu_k=real(props(5), qp), kappa=real(props(6), qp), &
            xi=real(props(7), qp), m=real(props(8), qp), p=-props(2) * u_n, dt=dt, &
            mu_n=real(mu_n, qp), r_n=real(statev(6), qp), exact=.false.)
        if (size(props) > 9) eq%exact = nint(props(10)) == 1
    end function equation

    !> Traction of the exact-rate scheme: bisection on z = ln y, y = -ln R, which gives the slip;
    !> `first` looks for the first of several equilibria on a grid, dense at the start.
    function exact_resistance(eq, first) result(tau)
        type(slip_equation), intent(in) :: eq
        logical, intent(in), optional :: first
        real(qp) :: tau
        real(qp) :: low, high, z, s
        integer :: i

        call exact_range(eq, high, low)
        if (present(first)) then
            do i = 1, n_grid
                call exact_slide(eq, grid_point(eq, i), s, tau)
                if (eq%trial - eq%alpha_t * s <= tau) exit
            end do
            low = grid_point(eq, i)
            high = grid_point(eq, i - 1)
        end if
        do i = 1, 170
            z = 0.5_qp * (low + high)
            call exact_slide(eq, z, s, tau)
            if (eq%trial - eq%alpha_t * s > tau) then
                high = z
            else
                low = z
            end if
        end do
    end function exact_resistance

    !> How often the misfit of the exact-rate scheme changes its sign.
    function exact_crossings(eq) result(count)
        type(slip_equation), intent(in) :: eq
        integer :: count
        real(qp) :: s, tau
        logical :: above, was_above
        integer :: i

        count = 0
        was_above = .true.
        do i = 1, n_grid
            call exact_slide(eq, grid_point(eq, i), s, tau)
            above = eq%trial - eq%alpha_t * s > tau
            if (above .neqv. was_above) count = count + 1
            was_above = above
        end do
    end function exact_crossings

    !> z from no slip to more slip than the spring has.
    subroutine exact_range(eq, start, end)
        type(slip_equation), intent(in) :: eq
        real(qp), intent(out) :: start, end

        start = log(1000.0_qp)
        if (eq%r_n > 0.0_qp) start = log(-log(eq%r_n))
        end = min(start, -1.0_qp) - eq%m * eq%trial / eq%alpha_t - 40.0_qp
    end subroutine exact_range

    function grid_point(eq, i) result(z)
        type(slip_equation), intent(in) :: eq
        integer, intent(in) :: i
        real(qp) :: z
        real(qp) :: start, end

        call exact_range(eq, start, end)
        z = start + (end - start) * (real(i, qp) / n_grid)**3
    end function grid_point

    !> Slip and resistance at z. Below z = -100, E1(exp(z)) is a straight line.
    subroutine exact_slide(eq, z, s, tau)
        type(slip_equation), intent(in) :: eq
        real(qp), intent(in) :: z
        real(qp), intent(out) :: s, tau
        real(qp), parameter :: straight = -100.0_qp
        real(qp) :: v

        v = exponential_integral(exp(max(z, straight))) + max(0.0_qp, straight - z)
        if (eq%r_n > 0.0_qp) v = v - exponential_integral(-log(eq%r_n))
        s = v / eq%m
        tau = exp(-exp(z)) * friction(eq, s) * eq%p
    end subroutine exact_slide

    !> The least R on the elastic path from `from` to `to`, strength linear in time: by trisection.
    function least_ratio(eq, from, to, p_n) result(r)
        type(slip_equation), intent(in) :: eq
        real(qp), intent(in) :: from(2), to(2), p_n
        real(qp) :: r
        real(qp) :: left, right, one, two
        integer :: i

        left = 0.0_qp
        right = 1.0_qp
        do i = 1, 200
            one = (2.0_qp * left + right) / 3.0_qp
            two = (left + 2.0_qp * right) / 3.0_qp
            if (ratio(one) < ratio(two)) then
                right = two
            else
                left = one
            end if
        end do
        r = ratio(0.5_qp * (left + right))

    contains

        function ratio(part)
            real(qp), intent(in) :: part
            real(qp) :: ratio

            ratio = eq%alpha_t * sqrt(sum((from + part * (to - from))**2)) &
                / ((1.0_qp - part) * eq%mu_n * p_n + part * friction(eq, 0.0_qp) * eq%p)
        end function ratio

    end function least_ratio

    !> E1(y) for y > 0: the integral from y to infinity of exp(-t)/t.
    function exponential_integral(y) result(v)
        real(qp), intent(in) :: y
        real(qp) :: v
        real(qp), parameter :: euler_gamma = 0.577215664901532860606512090082402431_qp
        real(qp) :: term
        integer :: k

        if (y < 3.0_qp) then
            v = -euler_gamma - log(y)
            term = 1.0_qp
            do k = 1, 60
                term = -term * y / k
                v = v - term / k
                if (abs(term) < 1.0e-36_qp) exit
            end do
        else
            v = 0.0_qp
            do k = 20 + int(450.0_qp / y), 1, -1
                v = k**2 / (y + 2 * k + 1 - v)
            end do
            v = exp(-y) / (y + 1.0_qp - v)
        end if
    end function exponential_integral

    function slip(eq, r) result(s)
        type(slip_equation), intent(in) :: eq
        real(qp), intent(in) :: r
        real(qp) :: s

        s = 0.0_qp
        if (r > eq%r_n) s = (r - eq%r_n) / (-eq%m * log(r))
    end function slip

    function friction(eq, s) result(mu)
        type(slip_equation), intent(in) :: eq
        real(qp), intent(in) :: s
        real(qp) :: mu

        if (eq%exact) then
            mu = (eq%kappa * eq%mu_k * s + eq%xi * eq%mu_s * eq%dt) / (eq%kappa * s + eq%xi * eq%dt)
            mu = mu + (eq%mu_n - mu) * exp(-(eq%kappa * s + eq%xi * eq%dt))
        else
            mu = (eq%mu_n + eq%kappa * eq%mu_k * s + eq%xi * eq%mu_s * eq%dt) &
                / (1.0_qp + eq%kappa * s + eq%xi * eq%dt)
        end if
    end function friction

    function misfit(eq, r) result(g)
        type(slip_equation), intent(in) :: eq
        real(qp), intent(in) :: r
        real(qp) :: g, s

        s = slip(eq, r)
        g = eq%trial - eq%alpha_t * s - r * friction(eq, s) * eq%p
    end function misfit

    function root(eq, first) result(r)
        type(slip_equation), intent(in) :: eq
        logical, intent(in), optional :: first
        real(qp) :: r, all_roots(1)

        if (present(first)) then
            all_roots = minval(crossings(eq))
            r = all_roots(1)
        else
            r = bisect(eq, eq%r_n, 1.0_qp)
        end if
    end function root

    function bisect(eq, left, right) result(r)
        type(slip_equation), intent(in) :: eq
        real(qp), intent(in) :: left, right
        real(qp) :: r, low, high
        integer :: i

        low = left
        high = right
        do i = 1, 125
            r = 0.5_qp * (low + high)
            if (.not. (r > low .and. r < high)) exit
            if (misfit(eq, r) > 0.0_qp) then
                low = r
            else
                high = r
            end if
        end do
    end function bisect

    !> R at every downward and upward crossing, from a grid that is dense at both ends.
    function crossings(eq) result(roots)
        type(slip_equation), intent(in) :: eq
        real(qp), allocatable :: roots(:)
        integer, parameter :: n = 4000
        real(qp) :: x, r, r_old, g, g_old
        integer :: i

        allocate (roots(0))
        r_old = eq%r_n
        g_old = 1.0_qp
        do i = 1, n
            x = 12.0_qp * (2.0_qp * i / n - 1.0_qp)
            r = eq%r_n + (1.0_qp - eq%r_n) / (1.0_qp + exp(-2.0_qp * x))
            g = misfit(eq, r)
            if (g > 0.0_qp .neqv. g_old > 0.0_qp) then
                if (g_old > 0.0_qp) then
                    roots = [roots, bisect(eq, r_old, r)]
                else
                    roots = [roots, r]
                end if
            end if
            r_old = r
            g_old = g
        end do
        if (g_old > 0.0_qp) roots = [roots, bisect(eq, r_old, 1.0_qp)]
    end function crossings

end module reference_update
