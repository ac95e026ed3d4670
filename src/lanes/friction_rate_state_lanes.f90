!> Rate-and-state friction of a block of points.
module friction_rate_state_lanes
    use, intrinsic :: iso_fortran_env, only : wp => real64
    use friction_lane_block, only : c_own, lanes, n_constants, rest_block, slide_block
    use friction_rate_state_bounds, only : aged_bounds, aged_fall, may_turn, may_turn_far, &
        may_vanish, ranges, slip_range, slipped_bounds, slipped_fall
    use friction_rate_state_core, only : aged_slope, aged_state, asinh_of, decayed_part, far, &
        mean_decay, slipped_slope, slope_of, state_exponent
    implicit none
    private

    public :: rest_rate_state, slide_rate_state

    integer, parameter :: c_a = c_own, c_b = c_own + 1, c_d_c = c_own + 2, c_v0 = c_own + 3, &
        c_f0 = c_own + 4
    real(wp), parameter :: ln_2 = 0.693147180559945309417232121458176568_wp
    real(wp), parameter :: least_theta = 1.0e-150_wp   !! taken [T]
    real(wp), parameter :: ln_least_slip = -200.0_wp   !! taken, slip over d_c
    real(wp), parameter :: small = 1.0e-8_wp      !! the error of a step's result is its square
    !> How far a point has come: searching, or to be evaluated once more; settled is 0.
    real(wp), parameter :: active = 1.0_wp, last = 0.5_wp

    !> What the iteration needs of a block, and where it is.
    type :: search
        real(wp) :: u_0(lanes)         !! u of the core without slip and theta's change
        real(wp) :: per_d_c(lanes), ln_d_c(lanes), b_over_a(lanes)
        real(wp) :: ln_theta_n(lanes)  !! at the start of the increment
        real(wp) :: z(lanes)           !! ln(slip)
        real(wp) :: ln_theta(lanes)    !! at the end of the increment
        real(wp) :: low(lanes), high(lanes)   !! the bracket of z
        real(wp) :: several(lanes)     !! above 0 where several equilibria are possible
        logical :: ages                !! ageing law, else slip law
        real(wp) :: dt                 !! [T]
    end type search

contains

    !> A surface without traction ages, or by the slip law stays as it is.
    pure subroutine rest_rate_state(ages, dt, block)
        logical, intent(in) :: ages
        real(wp), intent(in) :: dt   !! [T]
        type(rest_block), intent(inout) :: block
        real(wp) :: older
        integer :: i

        older = 0.0_wp
        if (ages) older = dt
        do i = 1, lanes
            block%mu_rest(i) = 0.0_wp
            block%r_rest(i) = block%r(i) + older
            block%strength(i) = 0.0_wp
            block%valid(i) = min(block%mu(i), block%r(i) - least_theta)
        end do
    end subroutine rest_rate_state

    !> Newton's method in ln(slip), bracketed; a point that has settled stays where it is while
    !> others go on.
    pure subroutine slide_rate_state(constants, ages, dt, block)
        real(wp), intent(in) :: constants(lanes, n_constants)
        logical, intent(in) :: ages
        real(wp), intent(in) :: dt   !! > 0 [T]
        type(slide_block), intent(inout) :: block
        integer, parameter :: max_iterations = 25
        type(search) :: now
        real(wp), dimension(lanes) :: ln_theta, by_ln_slip, slip
        real(wp) :: still
        integer :: i, iteration

        now%ages = ages
        now%dt = dt
        call begin(constants, block, now)
        if (any(now%several(:block%n) > 0.0_wp)) call look_closer(constants, block, now)
        call start(constants, block, now)
        do i = 1, block%n
            now%several(i) = max(now%several(i), now%low(i) + 1.0_wp - now%high(i))
            block%left(i) = merge(0.0_wp, active, now%several(i) > 0.0_wp)
            block%slip(i) = block%trial(i) / block%stiffness(i)   ! numbers for those that are left
            block%mu_end(i) = 0.0_wp
            block%d_slip(i) = 0.0_wp
            now%ln_theta(i) = now%ln_theta_n(i)
        end do
        do iteration = 1, max_iterations
            do i = 1, block%n
                slip(i) = exp(now%z(i))
            end do
            call evolve(block, now, slip, ln_theta, by_ln_slip)
            call step(constants, slip, ln_theta, by_ln_slip, block, now, still)
            if (still <= 0.0_wp) exit
        end do
        do i = 1, block%n
            block%r_end(i) = exp(now%ln_theta(i))
        end do
        do i = 1, block%n
            block%d_slip(i) = block%d_slip(i) / block%slip(i)
            block%d_pressure(i) = block%mu_end(i)
            block%resistance(i) = block%mu_end(i) * block%pressure(i)
            block%left(i) = max(block%left(i), now%several(i))
        end do
    end subroutine slide_rate_state

    !> Prepares the search; points at which several equilibria are possible are left.
    pure subroutine begin(constants, block, now)
        real(wp), intent(in) :: constants(lanes, n_constants)
        type(slide_block), intent(in) :: block
        type(search), intent(inout) :: now
        real(wp), dimension(lanes) :: ln_v0, left, x
        real(wp) :: ln_dt, fastest, aged, older, pull
        integer :: i

        older = merge(1.0_wp, 0.0_wp, now%ages)
        ln_dt = log(now%dt)
        do i = 1, block%n
            now%ln_d_c(i) = log(constants(i, c_d_c))
        end do
        do i = 1, block%n
            ln_v0(i) = log(constants(i, c_v0))
        end do
        do i = 1, block%n
            now%ln_theta_n(i) = log(block%r(i))
        end do
        do i = 1, block%n
            now%high(i) = log(block%trial(i) / block%stiffness(i))
        end do
        do i = 1, block%n
            now%per_d_c(i) = 1.0_wp / constants(i, c_d_c)
            now%b_over_a(i) = constants(i, c_b) / constants(i, c_a)
            x(i) = (block%trial(i) / block%stiffness(i)) * now%per_d_c(i)
            left(i) = exp(-x(i))
        end do
        do i = 1, block%n
            now%low(i) = now%ln_d_c(i) + ln_least_slip
            now%u_0(i) = state_exponent(constants(i, c_a), constants(i, c_b), constants(i, c_f0), &
                ln_v0(i) - now%ln_d_c(i)) - (ln_dt + ln_2 + ln_v0(i))
            pull = ln_dt - (now%high(i) - now%ln_d_c(i)) - now%ln_theta_n(i)
            fastest = 1.0_wp - pull * left(i)
            if (pull <= 0.0_wp) fastest = 1.0_wp - pull
            aged = min(1.0_wp, (block%r(i) + 0.5_wp * now%dt) / aged_state(block%r(i), now%dt, &
                left(i), mean_decay(x(i), left(i))))
            fastest = older * aged + (1.0_wp - older) * fastest   ! fall of ln(theta) with slip/d_c
            now%several(i) = block%pressure(i) * (constants(i, c_b) * fastest * now%per_d_c(i) &
                - constants(i, c_a) * block%stiffness(i) / block%trial(i)) - block%stiffness(i)
        end do
    end subroutine begin

    !> Where one bound for all slips does not tell that there is one equilibrium, several do; points
    !> at which they do not are left.
    pure subroutine look_closer(constants, block, now)
        real(wp), intent(in) :: constants(lanes, n_constants)
        type(slide_block), intent(in) :: block
        type(search), intent(inout) :: now
        real(wp), dimension(lanes) :: t, k, ratio, may
        real(wp) :: longest
        integer :: i, j

        longest = 0.0_wp
        do i = 1, block%n
            t(i) = block%trial(i) / (constants(i, c_a) * block%pressure(i))
            k(i) = t(i) * (block%stiffness(i) * constants(i, c_d_c) / block%trial(i))
            longest = max(longest, t(i) / k(i))
            ratio(i) = block%r(i) / now%dt
            if (.not. now%ages) ratio(i) = log(now%dt) - now%ln_theta_n(i)
            now%several(i) = may_turn_far(k(i), now%b_over_a(i), block%r(i) / now%dt, 0.0_wp)
            if (ranges(size(ranges))%to * k(i) > t(i)) now%several(i) = 0.0_wp
        end do
        do j = 1, size(ranges)
            if (ranges(j)%from > longest) exit
            if (now%ages) then
                do i = 1, block%n
                    may(i) = may_turn(ranges(j), k(i), now%b_over_a(i) * aged_fall(ranges(j), &
                        ratio(i)))
                end do
            else
                do i = 1, block%n
                    may(i) = may_turn(ranges(j), k(i), now%b_over_a(i) * slipped_fall(ranges(j), &
                        ratio(i), 0.0_wp))
                end do
            end if
            if (any(may(:block%n) > 0.0_wp)) call exclude_roots(ranges(j), t, k, ratio, block%n, &
                now, may)
            do i = 1, block%n
                now%several(i) = max(now%several(i), may(i))
            end do
        end do
    end subroutine look_closer

    !> Points whose misfit may turn in a range, but is not zero there.
    pure subroutine exclude_roots(range, t, k, ratio, n, now, may)
        type(slip_range), intent(in) :: range
        real(wp), dimension(lanes), intent(in) :: t, k
        real(wp), intent(in) :: ratio(lanes)   !! theta/dt, by the slip law ln(dt/theta)
        integer, intent(in) :: n
        type(search), intent(in) :: now
        real(wp), intent(inout) :: may(lanes)   !! above 0 if it may
        real(wp) :: x_0, low, high, ln_dt
        integer :: i

        ln_dt = log(now%dt)
        if (now%ages) then
            do i = 1, n
                x_0 = now%u_0(i) + now%ln_d_c(i) + now%b_over_a(i) * ln_dt
                call aged_bounds(range, ratio(i), low, high)
                may(i) = min(may(i), may_vanish(range, t(i), k(i), x_0 + now%b_over_a(i) * low, &
                    x_0 + now%b_over_a(i) * high))
            end do
        else
            do i = 1, n
                x_0 = now%u_0(i) + now%ln_d_c(i) + now%b_over_a(i) * now%ln_theta_n(i)
                call slipped_bounds(range, ratio(i), 0.0_wp, low, high)
                may(i) = min(may(i), may_vanish(range, t(i), k(i), x_0 + now%b_over_a(i) * low, &
                    x_0 + now%b_over_a(i) * high))
            end do
        end if
    end subroutine exclude_roots

    !> The slip if the state does not evolve by slip and the spring does not unload.
    pure subroutine start(constants, block, now)
        real(wp), intent(in) :: constants(lanes, n_constants)
        type(slide_block), intent(in) :: block
        type(search), intent(inout) :: now
        real(wp), parameter :: fast = 1.0e6_wp
        real(wp), dimension(lanes) :: y, e_y, ln_part, ln_theta
        integer :: i

        do i = 1, block%n
            y(i) = min(block%trial(i) / (constants(i, c_a) * block%pressure(i)), fast)
            e_y(i) = exp(-y(i))
        end do
        do i = 1, block%n
            ln_part(i) = log(max(decayed_part(y(i), e_y(i)), tiny(y)))
        end do
        do i = 1, block%n
            ln_theta(i) = now%ln_theta_n(i)
        end do
        if (now%ages) then
            do i = 1, block%n
                ln_theta(i) = log(block%r(i) + now%dt)
            end do
        end if
        do i = 1, block%n
            now%z(i) = y(i) + ln_part(i) - ln_2 - now%u_0(i) - now%b_over_a(i) &
                * ln_theta(i)
            now%z(i) = max(min(now%z(i), now%high(i)), now%low(i))
        end do
    end subroutine start

    !> ln(theta) after each slip, and how it depends on that.
    pure subroutine evolve(block, now, slip, ln_theta, by_ln_slip)
        type(slide_block), intent(in) :: block
        type(search), intent(in) :: now
        real(wp), intent(in) :: slip(lanes)
        real(wp), intent(out) :: ln_theta(lanes), by_ln_slip(lanes)
        real(wp), dimension(lanes) :: left, theta
        real(wp) :: x, mean, pull, ln_dt
        integer :: i

        do i = 1, block%n
            left(i) = exp(-slip(i) * now%per_d_c(i))
        end do
        if (now%ages) then
            do i = 1, block%n
                x = slip(i) * now%per_d_c(i)
                mean = mean_decay(x, left(i))
                theta(i) = aged_state(block%r(i), now%dt, left(i), mean)
                by_ln_slip(i) = aged_slope(x, block%r(i), now%dt, left(i), mean, theta(i))
            end do
            do i = 1, block%n
                ln_theta(i) = log(theta(i))
            end do
        else
            ln_dt = log(now%dt)
            do i = 1, block%n
                x = slip(i) * now%per_d_c(i)
                mean = mean_decay(x, left(i))
                pull = ln_dt - (now%z(i) - now%ln_d_c(i)) - now%ln_theta_n(i)
                ln_theta(i) = now%ln_theta_n(i) + x * mean * pull
                by_ln_slip(i) = slipped_slope(x, left(i), mean, pull)
            end do
        end if
    end subroutine evolve

    !> One step for every point that has not settled: whose last step was not small enough for its
    !> result to be exact.
    pure subroutine step(constants, slip, ln_theta, by_ln_slip, block, now, still)
        real(wp), intent(in) :: constants(lanes, n_constants)
        real(wp), dimension(lanes), intent(in) :: slip, ln_theta, by_ln_slip
        type(slide_block), intent(inout) :: block
        type(search), intent(inout) :: now
        real(wp), intent(out) :: still   !! above 0 as long as a point has not settled
        real(wp), dimension(lanes) :: u, e_u, y
        real(wp) :: by_z, fall, per_fall, misfit, move, next, steepness
        logical :: nearly
        integer :: i

        do i = 1, block%n
            u(i) = u_of(now%u_0(i), now%z(i), now%b_over_a(i), ln_theta(i))
        end do
        do i = 1, block%n
            e_u(i) = exp(min(u(i), far))
        end do
        do i = 1, block%n
            y(i) = asinh_of(u(i), e_u(i))
        end do
        still = 0.0_wp
        do i = 1, block%n
            by_z = block%pressure(i) * slope_of(e_u(i)) * (constants(i, c_a) + constants(i, c_b) &
                * by_ln_slip(i))
            misfit = block%trial(i) - block%stiffness(i) * slip(i) - constants(i, c_a) * y(i) &
                * block%pressure(i)
            fall = max(block%stiffness(i) * slip(i) + by_z, epsilon(fall) * block%trial(i))
            per_fall = 1.0_wp / fall
            if (misfit > 0.0_wp) now%low(i) = now%z(i)
            if (misfit <= 0.0_wp) now%high(i) = now%z(i)
            move = misfit * per_fall
            ! u bends the more, the faster it changes: far from equilibrium with its slip the state
            ! may change by a power of the slip, and u by b/a of its logarithm
            steepness = abs(1.0_wp + now%b_over_a(i) * by_ln_slip(i))
            steepness = max(1.0_wp, steepness, steepness * (abs(by_z) * per_fall))
            nearly = abs(move) * steepness <= small
            next = now%z(i) + move
            if (max(now%low(i) - next, next - now%high(i)) >= 0.0_wp .and. .not. nearly) then
                next = 0.5_wp * (now%low(i) + now%high(i))
            end if
            if (block%left(i) > 0.0_wp) then
                block%slip(i) = slip(i)
                block%mu_end(i) = constants(i, c_a) * y(i)
                block%d_slip(i) = by_z   ! by ln(slip), for now
                now%ln_theta(i) = ln_theta(i)
            end if
            if (block%left(i) > 0.0_wp) then
                if (nearly .and. block%left(i) < active) then
                    block%left(i) = 0.0_wp
                else
                    block%left(i) = merge(last, active, nearly)
                    now%z(i) = next
                end if
            end if
            still = max(still, block%left(i))
        end do
    end subroutine step

    !> u of the core.
    elemental function u_of(u_0, z, b_over_a, ln_theta) result(u)
        real(wp), intent(in) :: u_0, z, b_over_a, ln_theta
        real(wp) :: u

        u = (u_0 + z) + b_over_a * ln_theta
    end function u_of

end module friction_rate_state_lanes
