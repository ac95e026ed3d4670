!> Rate-and-state friction of a block of points, and its extensions.
module friction_rate_state_lanes
    use, intrinsic :: iso_fortran_env, only : wp => real64
    use friction_lane_block, only : lane_ageing, lane_flash_heating, lane_pressed_ageing, &
        lane_pressed_slip_law, lanes, n_constants, rest_block, slide_block
    use friction_rate_state_core, only : asinh_of, decayed_part, far, mean_growth, slope_of, &
        state_exponent
    use friction_rate_state_evolution, only : c_a, c_alpha, c_b, c_f0, evolution, evolve, &
        evolved, find_pressed, find_several, most_pressing, prepare_evolution
    implicit none
    private

    public :: rest_rate_state, slide_rate_state, state_rate_state

    real(wp), parameter :: ln_2 = 0.693147180559945309417232121458176568_wp
    real(wp), parameter :: least_theta = 1.0e-150_wp   !! taken [T]
    real(wp), parameter :: ln_least_theta = -345.0_wp, ln_most_theta = 46.0_wp
    real(wp), parameter :: ln_least_slip = -200.0_wp   !! taken, slip over d_c
    real(wp), parameter :: least_direct = 1.0e-9_wp    !! a, by b and f0, taken
    !> b, by a and f0, taken with flash heating: with less, round-off of friction shows in theta.
    real(wp), parameter :: least_evolution = 2.0_wp**(-6)
    real(wp), parameter :: small = 1.0e-8_wp      !! the error of a step's result is its square
    !> How far a point has come: searching, or to be evaluated once more; settled is 0.
    real(wp), parameter :: active = 1.0_wp, last = 0.5_wp

    !> Where the iteration is.
    type :: search
        type(evolved) :: at          !! the slip
        real(wp) :: ln_theta(lanes)  !! of points that have settled
        real(wp) :: low(lanes), high(lanes)   !! the bracket of z
        real(wp) :: u_0(lanes)       !! u of the core without slip and theta
        real(wp) :: w_0(lanes)       !! ln(v0/d_c)
    end type search

contains

    !> A surface without traction ages, or by the slip law stays as it is; a change of the pressure
    !> may change its state.
    pure subroutine rest_rate_state(kind, constants, dt, block)
        integer, intent(in) :: kind   !! of lanes
        real(wp), intent(in) :: constants(lanes, n_constants)
        real(wp), intent(in) :: dt    !! [T]
        type(rest_block), intent(inout) :: block
        real(wp), dimension(lanes) :: pressed, left
        real(wp) :: older, mean, fall
        integer :: i

        older = 0.0_wp
        if (kind == lane_ageing .or. kind == lane_pressed_ageing) older = dt
        do i = 1, lanes
            block%mu_rest(i) = 0.0_wp
            block%r_rest(i) = block%r(i) + older
            block%strength(i) = 0.0_wp
            block%valid(i) = min(block%mu(i), block%r(i) - least_theta, constants(i, c_a) &
                - least_direct * max(constants(i, c_b), constants(i, c_f0)))
        end do
        if (kind == lane_flash_heating) then
            do i = 1, lanes
                block%valid(i) = min(block%valid(i), constants(i, c_b) - least_evolution &
                    * max(constants(i, c_a), constants(i, c_f0)))
            end do
        end if
        if (kind /= lane_pressed_ageing .and. kind /= lane_pressed_slip_law) return
        call find_pressed(lanes, constants, block%before, block%pressure, pressed)
        do i = 1, lanes
            left(i) = exp(-pressed(i))
        end do
        do i = 1, lanes
            call mean_growth(pressed(i), left(i), mean, fall)
            block%r_rest(i) = block%r(i) * left(i) + older * mean
            if (abs(pressed(i)) + constants(i, c_alpha) / constants(i, c_b) >= most_pressing) then
                block%valid(i) = -1.0_wp
            end if
        end do
    end subroutine rest_rate_state

    !> Newton's method in ln(slip), bracketed; a point that has settled stays where it is while
    !> others go on. Points at which several equilibria are possible are left.
    pure subroutine slide_rate_state(kind, constants, dt, block)
        integer, intent(in) :: kind   !! of lanes
        real(wp), intent(in) :: constants(lanes, n_constants)
        real(wp), intent(in) :: dt    !! > 0 [T]
        type(slide_block), intent(inout) :: block
        integer, parameter :: max_iterations = 25
        type(evolution) :: state
        type(search) :: now
        real(wp) :: still, stiff, misfit
        integer :: i, iteration

        call prepare(kind, constants, dt, block, state, now)
        call find_several(constants, block, state)
        call start(constants, block, state, now)
        do i = 1, block%n
            state%several(i) = max(state%several(i), now%low(i) + 1.0_wp - now%high(i))
            block%left(i) = merge(0.0_wp, active, state%several(i) > 0.0_wp)
            block%slip(i) = block%trial(i) / block%stiffness(i)   ! numbers for those that are left
            block%mu_end(i) = 0.0_wp
            block%d_slip(i) = 0.0_wp
            block%d_pressure(i) = 0.0_wp
            now%ln_theta(i) = state%ln_theta_n(i)
        end do
        do iteration = 1, max_iterations
            do i = 1, block%n
                now%at%slip(i) = exp(now%at%z(i))
            end do
            call evolve(block, state, now%at)
            call step(constants, state, block, now, still)
            if (still <= 0.0_wp) exit
        end do
        do i = 1, block%n
            block%r_end(i) = exp(min(now%ln_theta(i), ln_most_theta))
        end do
        do i = 1, block%n
            block%d_slip(i) = block%d_slip(i) / block%slip(i)
            block%resistance(i) = block%mu_end(i) * block%pressure(i)
            ! the stiffer of the two, spring or law, knows the traction better
            stiff = max(block%d_slip(i), 0.0_wp)
            misfit = block%trial(i) - block%stiffness(i) * block%slip(i) - block%resistance(i)
            block%resistance(i) = max(block%resistance(i) + misfit * (stiff / (block%stiffness(i) &
                + stiff)), 0.0_wp)
            block%mu_end(i) = block%resistance(i) / block%pressure(i)
            block%d_pressure(i) = block%mu_end(i) + block%d_pressure(i)
            block%left(i) = max(block%left(i), state%several(i), ln_least_theta &
                - now%ln_theta(i), now%ln_theta(i) - ln_most_theta)
        end do
    end subroutine slide_rate_state

    !> mu and theta after a given slip.
    pure subroutine state_rate_state(kind, constants, dt, block)
        integer, intent(in) :: kind   !! of lanes
        real(wp), intent(in) :: constants(lanes, n_constants)
        real(wp), intent(in) :: dt    !! > 0 [T]
        type(slide_block), intent(inout) :: block   !! in: slip and load; out: mu_end,
                                                    !! r_end, left
        type(evolution) :: state
        real(wp), parameter :: most_digits = 5.0e-3_wp
        type(evolved) :: after
        real(wp), dimension(lanes) :: u, e_u
        real(wp) :: steepness
        integer :: i

        call prepare_evolution(kind, constants, dt, block, state)
        do i = 1, block%n
            after%slip(i) = block%slip(i)
            after%z(i) = log(max(block%slip(i), tiny(u)))
        end do
        call find_exponents(constants, block%n, state)
        call evolve(block, state, after)
        do i = 1, block%n
            u(i) = u_of(state%x_n(i), after%z(i), state%b_over_a(i), after%ln_theta(i) &
                - state%ln_theta_n(i))
            e_u(i) = exp(min(u(i), far))
        end do
        do i = 1, block%n
            block%mu_end(i) = constants(i, c_a) * asinh_of(u(i), e_u(i))
            block%r_end(i) = exp(min(after%ln_theta(i), ln_most_theta))
            block%left(i) = max(0.0_wp, ln_least_theta - after%ln_theta(i), after%ln_theta(i) &
                - ln_most_theta)
            ! round-off of the traction is more of the slip, whose logarithm counts
            steepness = max(abs(after%by_ln_slip(i)), abs(1.0_wp + state%b_over_a(i) &
                * after%by_ln_slip(i)) * (constants(i, c_a) / max(constants(i, c_a), &
                block%mu_end(i))))
            if (block%slip(i) * block%stiffness(i) < most_digits * steepness * block%trial(i)) then
                block%left(i) = 1.0_wp
            end if
        end do
    end subroutine state_rate_state

    pure subroutine prepare(kind, constants, dt, block, state, now)
        integer, intent(in) :: kind
        real(wp), intent(in) :: constants(lanes, n_constants)
        real(wp), intent(in) :: dt
        type(slide_block), intent(in) :: block
        type(evolution), intent(inout) :: state
        type(search), intent(inout) :: now
        integer :: i

        call prepare_evolution(kind, constants, dt, block, state)
        call find_exponents(constants, block%n, state)
        do i = 1, block%n
            state%ln_most(i) = log(block%trial(i) / block%stiffness(i))
        end do
        do i = 1, block%n
            now%high(i) = state%ln_most(i)
            now%low(i) = state%ln_d_c(i) + ln_least_slip
            now%w_0(i) = state%ln_v0(i) - state%ln_d_c(i)
            now%u_0(i) = state_exponent(constants(i, c_a), constants(i, c_b), constants(i, c_f0), &
                0.0_wp) - (state%ln_dt + ln_2 + state%ln_v0(i))
        end do
    end subroutine prepare

    !> X of the core less ln(slip), with the state at the start of the increment.
    pure subroutine find_exponents(constants, n, state)
        real(wp), intent(in) :: constants(lanes, n_constants)
        integer, intent(in) :: n
        type(evolution), intent(inout) :: state
        integer :: i

        do i = 1, n
            state%x_n(i) = state_exponent(constants(i, c_a), constants(i, c_b), &
                constants(i, c_f0), state%ln_v0(i) - state%ln_d_c(i)) - (state%ln_dt + ln_2 &
                + state%ln_v0(i)) + state%b_over_a(i) * state%ln_theta_n(i)
        end do
    end subroutine find_exponents

    !> The slip if the state does not evolve by slip, to a few per cent. That at which the spring
    !> unloads, too, is less by a factor of e^w, w e^w = k slip with k = stiffness/(a pressure):
    !> Lambert's function, as approximated by Iacono and Boyd (Adv. Comput. Math. 43, 2017).
    pure subroutine start(constants, block, state, now)
        real(wp), intent(in) :: constants(lanes, n_constants)
        type(slide_block), intent(in) :: block
        type(evolution), intent(in) :: state
        type(search), intent(inout) :: now
        real(wp), parameter :: fast = 1.0e6_wp, most = 300.0_wp
        real(wp), dimension(lanes) :: y, e_y, ln_part, ln_theta, ln_x, ln_more
        integer :: i

        do i = 1, block%n
            y(i) = min(block%trial(i) / (constants(i, c_a) * block%pressure(i)), fast)
            e_y(i) = exp(-y(i))
        end do
        do i = 1, block%n
            ln_part(i) = log(max(decayed_part(y(i), e_y(i)), tiny(y)))
        end do
        do i = 1, block%n
            ln_theta(i) = state%ln_theta_n(i)
        end do
        if (state%ages) then
            do i = 1, block%n
                ln_theta(i) = log(block%r(i) + state%dt)
            end do
        end if
        do i = 1, block%n
            now%at%z(i) = y(i) + ln_part(i) - ln_2 - now%u_0(i) - state%b_over_a(i) &
                * (now%w_0(i) + ln_theta(i))
            ln_x(i) = log(1.0_wp + y(i) * exp(min(now%at%z(i) - state%ln_most(i), most)))
        end do
        do i = 1, block%n
            ln_more(i) = log(1.0_wp + ln_x(i))
        end do
        do i = 1, block%n
            now%at%z(i) = now%at%z(i) - ln_x(i) * (1.0_wp - ln_more(i) / (2.0_wp + ln_x(i)))
            now%at%z(i) = max(min(now%at%z(i), now%high(i)), now%low(i))
        end do
    end subroutine start

    !> One step for every point that has not settled: whose last step was not small enough for its
    !> result to be exact.
    pure subroutine step(constants, state, block, now, still)
        real(wp), intent(in) :: constants(lanes, n_constants)
        type(evolution), intent(in) :: state
        type(slide_block), intent(inout) :: block
        type(search), intent(inout) :: now
        real(wp), intent(out) :: still   !! above 0 as long as a point has not settled
        real(wp), dimension(lanes) :: u, e_u, y
        real(wp) :: by_z, fall, per_fall, misfit, move, next, steepness
        logical :: nearly
        integer :: i

        do i = 1, block%n
            u(i) = u_of(now%u_0(i), now%at%z(i), state%b_over_a(i), now%w_0(i) &
                + now%at%ln_theta(i))
        end do
        do i = 1, block%n
            e_u(i) = exp(min(u(i), far))
        end do
        do i = 1, block%n
            y(i) = asinh_of(u(i), e_u(i))
        end do
        if (state%presses) then
            do i = 1, block%n
                if (block%left(i) > 0.0_wp) block%d_pressure(i) = slope_of(e_u(i)) &
                    * constants(i, c_alpha) * merge(now%at%by_pressing(i), 0.0_wp, block%before(i) &
                    > 0.0_wp)
            end do
        end if
        still = 0.0_wp
        do i = 1, block%n
            by_z = block%pressure(i) * slope_of(e_u(i)) * (constants(i, c_a) + constants(i, c_b) &
                * now%at%by_ln_slip(i))
            misfit = block%trial(i) - block%stiffness(i) * now%at%slip(i) - constants(i, c_a) &
                * y(i) * block%pressure(i)
            fall = max(block%stiffness(i) * now%at%slip(i) + by_z, epsilon(fall) * block%trial(i))
            per_fall = 1.0_wp / fall
            if (misfit > 0.0_wp) now%low(i) = now%at%z(i)
            if (misfit <= 0.0_wp) now%high(i) = now%at%z(i)
            move = misfit * per_fall
            ! u bends the more, the faster it changes: far from equilibrium with its slip the state
            ! may change by a power of the slip, and u by b/a of its logarithm
            steepness = abs(1.0_wp + state%b_over_a(i) * now%at%by_ln_slip(i))
            steepness = max(1.0_wp, steepness, steepness * (abs(by_z) * per_fall))
            nearly = abs(move) * steepness <= small
            next = now%at%z(i) + move
            if (max(now%low(i) - next, next - now%high(i)) >= 0.0_wp .and. .not. nearly) then
                next = 0.5_wp * (now%low(i) + now%high(i))
            end if
            if (block%left(i) > 0.0_wp) then
                block%slip(i) = now%at%slip(i)
                block%mu_end(i) = constants(i, c_a) * y(i)
                block%d_slip(i) = by_z   ! by ln(slip), for now
                now%ln_theta(i) = now%at%ln_theta(i)
            end if
            if (block%left(i) > 0.0_wp) then
                if (nearly .and. block%left(i) < active) then
                    block%left(i) = 0.0_wp
                else
                    block%left(i) = merge(last, active, nearly)
                    now%at%z(i) = next
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
