!> Random contact points for the tests, the same in every run.
module draws
    use, intrinsic :: iso_fortran_env, only : dp => real64
    implicit none
    private

    public :: decade, draw, point, random_point, random_rotation, random_state, seed_draws

    !> Constants, state and increment of a contact point.
    type :: point
        real(dp) :: props(9), statev(8), du(3), dt
    end type point

contains

    subroutine seed_draws(seed)
        integer, intent(in) :: seed
        integer, allocatable :: put(:)
        integer :: n, i

        call random_seed(size=n)
        allocate (put(n))
        put = [(seed + 7919 * i, i = 1, n)]
        call random_seed(put=put)
    end subroutine seed_draws

    !> Uniform in (low, high).
    function draw(low, high) result(x)
        real(dp), intent(in) :: low, high
        real(dp) :: x

        call random_number(x)
        x = low + x * (high - low)
    end function draw

    !> Ten to a uniform power.
    function decade(low, high) result(x)
        real(dp), intent(in) :: low, high
        real(dp) :: x

        x = 10.0_dp**draw(low, high)
    end function decade

    !> A closed point on its subloading surface, whose constants span `decades` each around those of
    !> a machine element (N, mm, s); with `unique`, no second equilibrium is possible: pressure
    !> kappa (mu_s - mu_k) < alpha_t.
    function random_point(decades, unique) result(p)
        real(dp), intent(in) :: decades
        logical, intent(in) :: unique
        type(point) :: p
        real(dp) :: half, pressure

        half = 0.5_dp * decades
        do
            p%props(1) = 1.0_dp
            p%props(2) = decade(3.0_dp - half, 3.0_dp + half)
            p%props(3) = decade(3.0_dp - half, 3.0_dp + half)
            p%props(5) = draw(0.0_dp, 1.0_dp)
            p%props(4) = p%props(5) + draw(0.0_dp, 1.0_dp)
            p%props(6) = decade(1.0_dp - half, 1.0_dp + half)
            p%props(7) = decade(0.0_dp - half, 0.0_dp + half)
            p%props(8) = decade(2.0_dp - half, 2.0_dp + half)
            p%props(9) = draw(p%props(5), p%props(4))
            pressure = decade(1.0_dp - half, 1.0_dp + half)
            if (.not. unique) exit
            if (pressure * p%props(6) * (p%props(4) - p%props(5)) < 0.8_dp * p%props(3)) exit
        end do
        call random_state(p, pressure, decades)
        p%dt = decade(-3.0_dp - half, -3.0_dp + half)
    end function random_point

    !> State and increment of a closed point with given constants.
    subroutine random_state(p, pressure, decades)
        type(point), intent(inout) :: p
        real(dp), intent(in) :: pressure   !! at the start [F/L^2]
        real(dp), intent(in) :: decades    !! span of the increments
        real(dp) :: half, mu, r, angle, turn, reach

        half = 0.5_dp * decades
        mu = draw(p%props(5), p%props(4))
        r = draw(0.0_dp, 1.0_dp)
        if (draw(0.0_dp, 1.0_dp) < 0.1_dp) r = 0.0_dp
        angle = draw(0.0_dp, 8.0_dp * atan(1.0_dp))
        reach = r * mu * pressure / p%props(3)
        p%statev = [2.0_dp, -pressure / p%props(2), reach * cos(angle), reach * sin(angle), mu, r, &
            0.0_dp, 0.0_dp]
        turn = angle + draw(-3.0_dp, 3.0_dp)
        reach = mu * pressure / p%props(3) * decade(-half, half)
        p%du = [draw(-0.5_dp, 0.5_dp) * pressure / p%props(2), reach * cos(turn), reach * sin(turn)]
    end subroutine random_state

    !> A rotation matrix, uniformly distributed: from a random unit quaternion.
    function random_rotation() result(q)
        real(dp) :: q(3, 3)
        real(dp) :: v(4)

        do
            v = [draw(-1.0_dp, 1.0_dp), draw(-1.0_dp, 1.0_dp), draw(-1.0_dp, 1.0_dp), &
                draw(-1.0_dp, 1.0_dp)]
            if (sum(v**2) < 1.0_dp .and. sum(v**2) > 0.01_dp) exit
        end do
        v = v / norm2(v)
        q(:, 1) = [1.0_dp - 2.0_dp * (v(3)**2 + v(4)**2), 2.0_dp * (v(2) * v(3) + v(1) * v(4)), &
            2.0_dp * (v(2) * v(4) - v(1) * v(3))]
        q(:, 2) = [2.0_dp * (v(2) * v(3) - v(1) * v(4)), 1.0_dp - 2.0_dp * (v(2)**2 + v(4)**2), &
            2.0_dp * (v(3) * v(4) + v(1) * v(2))]
        q(:, 3) = [2.0_dp * (v(2) * v(4) + v(1) * v(3)), 2.0_dp * (v(3) * v(4) - v(1) * v(2)), &
            1.0_dp - 2.0_dp * (v(2)**2 + v(3)**2)]
    end function random_rotation

end module draws
