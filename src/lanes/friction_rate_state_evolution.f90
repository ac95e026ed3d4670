!> How the state of rate-and-state friction evolves at the points of a block: ageing law, slip law,
!> both under a pressure that changes (Linker and Dieterich), and flash heating. And whether more
!> than one equilibrium is possible.
module friction_rate_state_evolution
    use, intrinsic :: iso_fortran_env, only : wp => real64
    use friction_flash_heating_core, only : bounds_between, heating, shift_slope, sliding_at, &
        steady_bounds, steady_sliding
    use friction_lane_block, only : c_own, lane_ageing, lane_flash_heating, lane_pressed_ageing, &
        lane_pressed_slip_law, lanes, n_constants, slide_block
    use friction_rate_state_bounds, only : aged_bounds, aged_fall, joined, may_turn, &
        may_turn_far, may_vanish, pressed_range, ranges, slip_range, slipped_bounds, slipped_fall
    use friction_rate_state_core, only : aged_slope, aged_state, mean_decay, mean_growth, &
        pressed_by, slipped_slope
    implicit none
    private

    public :: evolution, evolve, evolved, find_pressed, find_several, prepare_evolution

    integer, parameter, public :: c_a = c_own, c_b = c_own + 1, c_d_c = c_own + 2, &
        c_v0 = c_own + 3, c_f0 = c_own + 4
    integer, parameter, public :: c_alpha = c_own + 5   !! of Linker and Dieterich's law
    integer, parameter :: c_f_w = c_own + 5, c_v_w = c_own + 6, c_n = c_own + 7   !! flash heating
    real(wp), parameter, public :: most_pressing = 64.0_wp   !! of ln(theta), taken: beyond, the
                                                             !! round-off of pressures shows

    !> An increment as the state sees it.
    type :: evolution
        logical :: ages       !! ageing law, else slip law
        logical :: presses    !! the state depends on the pressure
        logical :: heats      !! its steady state is that of flash heating
        real(wp) :: dt, ln_dt   !! [T]
        real(wp) :: per_d_c(lanes), ln_d_c(lanes), b_over_a(lanes)
        real(wp) :: ln_v0(lanes)
        real(wp) :: ln_theta_n(lanes)   !! at the start of the increment
        real(wp) :: x_n(lanes)          !! X of the core less ln(slip), for that
        real(wp) :: pressed(lanes)      !! what a change of the pressure takes from ln(theta)
        real(wp) :: ln_v_w(lanes), f0(lanes), f_w(lanes), n(lanes)   !! of `heating`
        real(wp) :: ln_most(lanes)      !! ln of the slip that takes all of the traction
        real(wp) :: several(lanes)      !! above 0 where several equilibria are possible
    end type evolution

    !> Points after a slip.
    type :: evolved
        real(wp) :: z(lanes), slip(lanes)   !! in: ln(slip), slip
        real(wp) :: ln_theta(lanes)
        real(wp) :: by_ln_slip(lanes)    !! d(ln theta)/d(ln slip)
        real(wp) :: by_pressing(lanes)   !! d(ln theta)/d(pressed), where the pressure counts
    end type evolved

contains

    pure subroutine prepare_evolution(kind, constants, dt, block, now)
        integer, intent(in) :: kind   !! of lanes
        real(wp), intent(in) :: constants(lanes, n_constants)
        real(wp), intent(in) :: dt    !! > 0 [T]
        type(slide_block), intent(in) :: block
        type(evolution), intent(inout) :: now
        integer :: i

        now%ages = kind == lane_ageing .or. kind == lane_pressed_ageing
        now%presses = kind == lane_pressed_ageing .or. kind == lane_pressed_slip_law
        now%heats = kind == lane_flash_heating
        now%dt = dt
        now%ln_dt = log(dt)
        do i = 1, block%n
            now%ln_d_c(i) = log(constants(i, c_d_c))
        end do
        do i = 1, block%n
            now%ln_v0(i) = log(constants(i, c_v0))
        end do
        do i = 1, block%n
            now%ln_theta_n(i) = log(block%r(i))
        end do
        do i = 1, block%n
            now%per_d_c(i) = 1.0_wp / constants(i, c_d_c)
            now%b_over_a(i) = constants(i, c_b) / constants(i, c_a)
        end do
        if (now%presses) call find_pressed(block%n, constants, block%before, block%pressure, &
            now%pressed)
        if (.not. now%heats) return
        do i = 1, block%n
            now%ln_v_w(i) = log(constants(i, c_v_w))
            now%f0(i) = constants(i, c_f0) / constants(i, c_a)
            now%f_w(i) = constants(i, c_f_w) / constants(i, c_a)
            now%n(i) = constants(i, c_n)
        end do
    end subroutine prepare_evolution

    !> What the change of the pressure takes from ln(theta); 0 where it begins or ends at none.
    pure subroutine find_pressed(n, constants, before, pressure, pressed)
        integer, intent(in) :: n
        real(wp), intent(in) :: constants(lanes, n_constants)
        real(wp), intent(in) :: before(lanes), pressure(lanes)   !! [F/L^2]
        real(wp), intent(out) :: pressed(lanes)
        real(wp), parameter :: least = 1.0e-150_wp   !! of pressures that have a quotient
        real(wp) :: from, to
        integer :: i

        do i = 1, n
            to = merge(pressure(i), 1.0_wp, min(pressure(i), before(i)) > 0.0_wp)
            from = merge(before(i), 1.0_wp, min(pressure(i), before(i)) > 0.0_wp)
            pressed(i) = pressed_by(constants(i, c_alpha) / constants(i, c_b), max(from, least), &
                max(to, least))
            pressed(i) = max(-most_pressing, min(pressed(i), most_pressing))
            if (min(from, to) < least) pressed(i) = most_pressing   ! not taken
        end do
    end subroutine find_pressed

    !> ln(theta) after each slip, and how it depends on that and on the pressure.
    pure subroutine evolve(block, now, after)
        type(slide_block), intent(in) :: block
        type(evolution), intent(in) :: now
        type(evolved), intent(inout) :: after
        real(wp), dimension(lanes) :: left, theta
        real(wp) :: x, mean, fall
        integer :: i

        if (now%ages .and. now%presses) then
            do i = 1, block%n
                left(i) = exp(-(after%slip(i) * now%per_d_c(i) + now%pressed(i)))
            end do
            do i = 1, block%n
                x = after%slip(i) * now%per_d_c(i) + now%pressed(i)
                call mean_growth(x, left(i), mean, fall)
                theta(i) = aged_state(block%r(i), now%dt, left(i), mean)
                after%by_pressing(i) = -(block%r(i) * left(i) + now%dt * fall) / theta(i)
                after%by_ln_slip(i) = after%slip(i) * now%per_d_c(i) * after%by_pressing(i)
            end do
        else if (now%ages) then
            do i = 1, block%n
                left(i) = exp(-after%slip(i) * now%per_d_c(i))
            end do
            do i = 1, block%n
                x = after%slip(i) * now%per_d_c(i)
                mean = mean_decay(x, left(i))
                theta(i) = aged_state(block%r(i), now%dt, left(i), mean)
                after%by_ln_slip(i) = aged_slope(x, block%r(i), now%dt, left(i), mean, theta(i))
            end do
        else
            call evolve_by_slip(block%n, now, after)
            return
        end if
        do i = 1, block%n
            after%ln_theta(i) = log(theta(i))
        end do
    end subroutine evolve

    pure subroutine evolve_by_slip(n, now, after)
        integer, intent(in) :: n
        type(evolution), intent(in) :: now
        type(evolved), intent(inout) :: after
        real(wp), dimension(lanes) :: left, shift, by_ln_v
        real(wp) :: x, mean, pull
        integer :: i

        do i = 1, n
            left(i) = exp(-after%slip(i) * now%per_d_c(i))
        end do
        do i = 1, n
            x = after%slip(i) * now%per_d_c(i)
            mean = mean_decay(x, left(i))
            pull = now%ln_dt - (after%z(i) - now%ln_d_c(i)) - now%ln_theta_n(i)
            after%ln_theta(i) = now%ln_theta_n(i) + x * mean * pull
            after%by_ln_slip(i) = slipped_slope(x, left(i), mean, pull)
            after%by_pressing(i) = -mean
        end do
        if (now%presses) then
            do i = 1, n
                mean = -after%by_pressing(i)
                after%ln_theta(i) = after%ln_theta(i) - now%pressed(i) * mean
                after%by_ln_slip(i) = after%by_ln_slip(i) - now%pressed(i) * (left(i) - mean)
            end do
        end if
        if (now%heats) then
            call find_shift(n, now, after%z, shift, by_ln_v)
            do i = 1, n
                x = after%slip(i) * now%per_d_c(i)
                mean = -after%by_pressing(i)
                after%ln_theta(i) = after%ln_theta(i) + x * mean * shift(i)
                after%by_ln_slip(i) = after%by_ln_slip(i) + x * (left(i) * shift(i) + mean &
                    * by_ln_v(i))
            end do
        end if
    end subroutine evolve_by_slip

    !> How flash heating shifts ln(theta) of steady sliding, and how that grows with ln(slip).
    pure subroutine find_shift(n, now, z, shift, by_ln_v)
        integer, intent(in) :: n
        type(evolution), intent(in) :: now
        real(wp), intent(in) :: z(lanes)   !! ln(slip)
        real(wp), intent(out) :: shift(lanes), by_ln_v(lanes)
        type(steady_sliding) :: steady
        integer :: i

        do i = 1, n
            steady = sliding_at(heating(now%ln_v0(i), now%ln_v_w(i), now%f0(i), &
                now%b_over_a(i), now%f_w(i), now%n(i)), z(i) - now%ln_dt)
            shift(i) = steady%rise / now%b_over_a(i)
            by_ln_v(i) = shift_slope(now%b_over_a(i), steady%growth)
        end do
    end subroutine find_shift

    !> Points at which several equilibria are possible, as far as bounds over ranges of the slip
    !> tell (docs/theory.md, section 12).
    pure subroutine find_several(constants, block, now)
        real(wp), intent(in) :: constants(lanes, n_constants)
        type(slide_block), intent(in) :: block
        type(evolution), intent(inout) :: now
        integer, parameter :: short = 10   !! ranges of slips up to 0.022 d_c
        real(wp), dimension(lanes) :: t, k, may
        real(wp) :: longest
        integer :: i, j, first

        if (.not. now%heats) then
            call find_by_one_bound(constants, block, now)
            if (.not. any(now%several(:block%n) > 0.0_wp)) return
        end if
        longest = 0.0_wp
        do i = 1, block%n
            t(i) = block%trial(i) / (constants(i, c_a) * block%pressure(i))
            k(i) = t(i) * (block%stiffness(i) * constants(i, c_d_c) / block%trial(i))
            longest = max(longest, t(i) / k(i))
            may(i) = 0.0_wp
            if (now%presses) may(i) = now%pressed(i)
            now%several(i) = may_turn_far(k(i), now%b_over_a(i), block%r(i) / now%dt, may(i))
            if (now%heats) now%several(i) = 1.0_wp
            if (ranges(size(ranges))%to * k(i) > t(i)) now%several(i) = 0.0_wp
        end do
        if (now%heats) then
            call look_at_heating(longest, t, k, block%n, now)
            return
        end if
        ! the shortest slips as one, which is as good as a rule
        call look_for_turns(joined(ranges(1), ranges(short)), k, block, now, may)
        first = 1
        if (all(may(:block%n) <= 0.0_wp)) first = short + 1
        do j = first, size(ranges)
            if (ranges(j)%from > longest) exit
            call look_for_turns(ranges(j), k, block, now, may)
            if (any(may(:block%n) > 0.0_wp)) call look_for_roots(ranges(j), t, k, block, now, may)
            do i = 1, block%n
                now%several(i) = max(now%several(i), may(i))
            end do
        end do
    end subroutine find_several

    !> The same by one bound for all slips.
    pure subroutine find_by_one_bound(constants, block, now)
        real(wp), intent(in) :: constants(lanes, n_constants)
        type(slide_block), intent(in) :: block
        type(evolution), intent(inout) :: now
        real(wp), dimension(lanes) :: left, x
        real(wp) :: fastest(lanes)   ! fall of ln(theta) with slip/d_c
        real(wp) :: pull
        integer :: i

        do i = 1, block%n
            x(i) = (block%trial(i) / block%stiffness(i)) * now%per_d_c(i)
            left(i) = exp(-x(i))
        end do
        if (now%ages .and. now%presses) then
            call bound_pressed(block, now, x, left, fastest)
        else if (now%ages) then
            do i = 1, block%n
                fastest(i) = min(1.0_wp, (block%r(i) + 0.5_wp * now%dt) / aged_state(block%r(i), &
                    now%dt, left(i), mean_decay(x(i), left(i))))
            end do
        else
            do i = 1, block%n
                pull = now%ln_dt - (now%ln_most(i) - now%ln_d_c(i)) - now%ln_theta_n(i)
                fastest(i) = 1.0_wp - pull * merge(left(i), 1.0_wp, pull > 0.0_wp)
                if (now%presses) fastest(i) = fastest(i) + 0.5_wp * max(0.0_wp, -now%pressed(i))
            end do
        end if
        do i = 1, block%n
            now%several(i) = block%pressure(i) * (constants(i, c_b) * fastest(i) &
                * now%per_d_c(i) - constants(i, c_a) * block%stiffness(i) / block%trial(i)) &
                - block%stiffness(i)
        end do
    end subroutine find_by_one_bound

    !> How fast ln(theta) falls with slip/d_c at most, by the ageing law under a pressure that
    !> changes.
    pure subroutine bound_pressed(block, now, x, left, fastest)
        type(slide_block), intent(in) :: block
        type(evolution), intent(in) :: now
        real(wp), dimension(lanes), intent(in) :: x, left   !! the largest slip/d_c, e^-x
        real(wp), intent(out) :: fastest(lanes)
        real(wp) :: kept(lanes), mean, fall, fall_0
        integer :: i

        do i = 1, block%n
            kept(i) = exp(-now%pressed(i))
        end do
        do i = 1, block%n
            call mean_growth(now%pressed(i), kept(i), mean, fall_0)
            call mean_growth(x(i) + now%pressed(i), left(i) * kept(i), mean, fall)
            fastest(i) = min(1.0_wp, (block%r(i) * kept(i) + now%dt * fall_0) &
                / aged_state(block%r(i), now%dt, left(i) * kept(i), mean))
        end do
    end subroutine bound_pressed

    !> May the misfit stop rising in a range?
    pure subroutine look_for_turns(range, k, block, now, may)
        type(slip_range), intent(in) :: range
        real(wp), intent(in) :: k(lanes)
        type(slide_block), intent(in) :: block
        type(evolution), intent(in) :: now
        real(wp), intent(out) :: may(lanes)   !! above 0 if it may
        real(wp) :: fall
        integer :: i

        if (now%ages .and. now%presses) then
            do i = 1, block%n
                may(i) = may_turn(range, k(i), now%b_over_a(i) * aged_fall(pressed_range(range, &
                    now%pressed(i)), block%r(i) / now%dt))
            end do
        else if (now%ages) then
            do i = 1, block%n
                may(i) = may_turn(range, k(i), now%b_over_a(i) * aged_fall(range, block%r(i) &
                    / now%dt))
            end do
        else
            do i = 1, block%n
                fall = slipped_fall(range, now%ln_dt - now%ln_theta_n(i) - range%ln_to, -1.0_wp, &
                    merge(now%pressed(i), 0.0_wp, now%presses))
                may(i) = may_turn(range, k(i), now%b_over_a(i) * fall)
            end do
        end if
    end subroutine look_for_turns

    !> May it be zero there, too?
    pure subroutine look_for_roots(range, t, k, block, now, may)
        type(slip_range), intent(in) :: range
        real(wp), dimension(lanes), intent(in) :: t, k
        type(slide_block), intent(in) :: block
        type(evolution), intent(in) :: now
        real(wp), intent(inout) :: may(lanes)   !! above 0 if it may
        real(wp), dimension(lanes) :: low, high
        type(slip_range) :: own
        real(wp) :: x_0, pull
        integer :: i

        if (now%ages) then
            do i = 1, block%n
                own = range
                if (now%presses) own = pressed_range(range, now%pressed(i))
                call aged_bounds(own, block%r(i) / now%dt, low(i), high(i))
                low(i) = low(i) + now%ln_dt - now%ln_theta_n(i)
                high(i) = high(i) + now%ln_dt - now%ln_theta_n(i)
            end do
        else
            do i = 1, block%n
                pull = now%ln_dt - now%ln_theta_n(i)
                call slipped_bounds(range, pull - range%ln_to, pull - range%ln_from, &
                    merge(now%pressed(i), 0.0_wp, now%presses), low(i), high(i))
            end do
        end if
        do i = 1, block%n
            x_0 = now%x_n(i) + now%ln_d_c(i)
            may(i) = min(may(i), may_vanish(range, t(i), k(i), x_0 + now%b_over_a(i) * low(i), &
                x_0 + now%b_over_a(i) * high(i)))
        end do
    end subroutine look_for_roots

    !> The same with flash heating, whose steady state costs more: both at once, over wide ranges,
    !> and over narrow ones where these do not tell.
    pure subroutine look_at_heating(longest, t, k, n, now)
        real(wp), intent(in) :: longest, t(lanes), k(lanes)
        integer, intent(in) :: n
        type(evolution), intent(inout) :: now
        integer, parameter :: many = 3   !! ranges in a wide one
        type(steady_sliding), dimension(lanes) :: from, at
        real(wp) :: may(lanes)
        integer :: i, j, m

        do i = 1, n
            from(i) = sliding_at(heating_at(now, i), ranges(1)%ln_from + now%ln_d_c(i) &
                - now%ln_dt)
        end do
        do j = 1, size(ranges), many
            if (ranges(j)%from > longest) exit
            at(:n) = from(:n)
            call look_at_range(joined(ranges(j), ranges(min(j + many - 1, size(ranges)))), t, k, &
                n, now, from, may)
            if (any(may(:n) > 0.0_wp)) then
                do m = j, min(j + many - 1, size(ranges))
                    call look_at_range(ranges(m), t, k, n, now, at, may)
                    now%several(:n) = max(now%several(:n), may(:n))
                end do
            end if
        end do
    end subroutine look_at_heating

    pure subroutine look_at_range(range, t, k, n, now, steady, may)
        type(slip_range), intent(in) :: range
        real(wp), dimension(lanes), intent(in) :: t, k
        integer, intent(in) :: n
        type(evolution), intent(in) :: now
        type(steady_sliding), intent(inout) :: steady(lanes)   !! at its start, then at its end
        real(wp), intent(out) :: may(lanes)
        type(steady_sliding) :: last
        type(steady_bounds) :: bounds
        real(wp) :: least, most, low, high, fall, x_0
        integer :: i

        do i = 1, n
            last = sliding_at(heating_at(now, i), range%ln_to + now%ln_d_c(i) - now%ln_dt)
            bounds = bounds_between(heating_at(now, i), steady(i), last)
            steady(i) = last
            least = bounds%ln_low + now%ln_d_c(i) - now%ln_theta_n(i)
            most = bounds%ln_high + now%ln_d_c(i) - now%ln_theta_n(i)
            fall = slipped_fall(range, least, (bounds%growth_low - 1.0_wp) / now%b_over_a(i), &
                0.0_wp)
            call slipped_bounds(range, least, most, 0.0_wp, low, high)
            x_0 = now%x_n(i) + now%ln_d_c(i)
            may(i) = min(may_turn(range, k(i), now%b_over_a(i) * fall), may_vanish(range, t(i), &
                k(i), x_0 + now%b_over_a(i) * low, x_0 + now%b_over_a(i) * high))
        end do
    end subroutine look_at_range

    pure function heating_at(now, i) result(constants)
        type(evolution), intent(in) :: now
        integer, intent(in) :: i
        type(heating) :: constants

        constants = heating(now%ln_v0(i), now%ln_v_w(i), now%f0(i), now%b_over_a(i), now%f_w(i), &
            now%n(i))
    end function heating_at

end module friction_rate_state_evolution
