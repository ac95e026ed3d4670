!> The subloading law's update (backward Euler) of a block of contact points in vector lanes: the
!> arithmetic of `friction_contact` and `friction_subloading_law` for points in space that share
!> their constants, without options. `friction_batch_kernel` does the same for every law and
!> option; this
!> kernel holds the constants in registers and needs fewer arrays, which saves a fifth of the time
!> where it is used most (docs/performance.md).
!>
!> Either all points of the block are updated, or nothing is touched and `left` tells which points
!> this kernel does not take: numbers that are not finite or beyond 1e20, states that no update
!> leaves, gaps that close, possible snap-back, slow convergence. Each point is treated by itself:
!> its result does not depend on its neighbours. No floating-point exception but inexact and
!> underflow; overflow only where numbers beyond 1e307 are judged, by their sum.
!>
!> Compiled once for each vector instruction set, under other names, with a copy of what it uses
!> (src/CMakeLists.txt).
module friction_subloading_kernel
    use, intrinsic :: iso_c_binding, only : c_double, c_int, c_int64_t
    use friction_lane_block, only : below_largest, lanes, least_ratio, unsure, verge, widest, &
        zero_unless
    use friction_subloading_core, only : chebyshev, inverses, logarithm_after, moved, settled, &
        slip_guess, slip_move, slip_task, slope, start_far
    implicit none
    private

    public :: update_block

    integer, parameter :: wp = c_double
    real(wp), parameter :: largest = 1.0e20_wp   !! of the numbers taken: no product overflows
    real(wp), parameter :: smallest = 1.0e-150_wp   !! of the tractions taken, unless zero
    real(wp), parameter :: least = 1.0e-200_wp      !! below every divisor that counts

    !> Constants of the law and of the increment.
    type :: increment
        real(wp) :: alpha_n, alpha_t    !! stiffness [F/L^3]
        real(wp) :: mu_s, mu_k, kappa, xi, m, mu_0
        real(wp) :: w0                  !! 1 + xi dt [-]
        real(wp) :: forming             !! xi dt (mu_s - mu_k) [-]
    end type increment

    !> A block with all of its slip prevented.
    type :: trial_block
        real(wp) :: p(lanes)         !! pressure [F/L^2]
        real(wp) :: q1(lanes), q2(lanes)   !! elastic tangential displacement [L]
        real(wp) :: tau(lanes)       !! tangential traction [F/L^2]
        real(wp) :: c(lanes)         !! c of docs/theory.md, section 3 [-]
        real(wp) :: r(lanes)         !! R at the start of the increment [-]
        real(wp) :: slides(lanes)    !! 1 where the traction is beyond the strength, else 0
    end type trial_block

    !> What slip does to the points of a block that slide.
    type :: slip_block
        real(wp) :: s(lanes)         !! slip [L]
        real(wp) :: r(lanes)         !! R at the end of the increment [-]
        real(wp) :: log_r(lanes)     !! its logarithm
    end type slip_block

contains

    !> Updates points 1 to `lanes` of component-major arrays with `stride` points.
    subroutine update_block(stride, du, dtime, constants, statev, traction, tangent, left, n_left) &
        bind(C, name='stickslip_subloading_kernel')
        integer(c_int64_t), value, intent(in) :: stride   !! distance of components, `lanes` or more
        real(wp), intent(in) :: du(stride, *)             !! 3 components [L]
        real(wp), value, intent(in) :: dtime              !! [T]
        real(wp), intent(in) :: constants(8)   !! alpha_n, alpha_t, mu_s, mu_k, kappa, xi, m, mu_0,
                                               !! valid; those that are not zero between 1e-20 and
                                               !! 1e20
        real(wp), intent(inout) :: statev(stride, *)      !! 8 components
        real(wp), intent(inout) :: traction(stride, *)    !! 3 components [F/L^2]
        real(wp), intent(inout) :: tangent(stride, 3, *)  !! 3 x 3 components [F/L^3]
        integer(c_int), intent(out) :: left(lanes)   !! 1 for a point that is not taken, else 0
        integer(c_int), intent(out) :: n_left        !! how many; unless 0, nothing is touched
        type(increment) :: inc
        type(trial_block) :: trial
        type(slip_block) :: slid

        inc = increment(alpha_n=constants(1), alpha_t=constants(2), mu_s=constants(3), &
            mu_k=constants(4), kappa=constants(5), xi=constants(6), m=constants(7), &
            mu_0=constants(8), w0=1.0_wp + constants(6) * dtime, &
            forming=constants(6) * dtime * (constants(3) - constants(4)))
        call find_trial(stride, inc, du, statev, trial, left, n_left)
        if (n_left > 0) return
        call find_slip(inc, trial, slid, left, n_left)
        if (n_left > 0) return
        call finish(stride, inc, du, trial, slid, statev, traction, tangent)
    end subroutine update_block

    !> The trial state, and the points that the kernel leaves.
    subroutine find_trial(stride, inc, du, statev, trial, left, n_left)
        integer(c_int64_t), intent(in) :: stride
        type(increment), intent(in) :: inc
        real(wp), intent(in) :: du(stride, 3), statev(stride, 8)
        type(trial_block), intent(out) :: trial
        integer(c_int), intent(out) :: left(lanes), n_left
        integer(c_int64_t) :: fine
        real(wp) :: others, phase, u_n, mu, slip, dissipated, valid, strength, fall, iw0
        integer :: i

        iw0 = 1.0_wp / inc%w0
        n_left = 0
        do i = 1, lanes
            others = abs(statev(i, 2)) + abs(statev(i, 3)) + abs(statev(i, 4)) + abs(statev(i, 5)) &
                + abs(statev(i, 6)) + abs(statev(i, 7)) + abs(statev(i, 8))
            fine = below_largest(others + abs(statev(i, 1)) + abs(du(i, 1)) + abs(du(i, 2)) &
                + abs(du(i, 3)), largest)
            others = zero_unless(fine, others)
            phase = zero_unless(fine, statev(i, 1))
            u_n = zero_unless(fine, statev(i, 2))
            trial%q1(i) = zero_unless(fine, statev(i, 3) + du(i, 2))
            trial%q2(i) = zero_unless(fine, statev(i, 4) + du(i, 3))
            mu = zero_unless(fine, statev(i, 5))
            trial%r(i) = zero_unless(fine, statev(i, 6))
            slip = zero_unless(fine, statev(i, 7))
            dissipated = zero_unless(fine, statev(i, 8))

            if (phase <= 0.0_wp) mu = inc%mu_0
            ! valid < 0 tells a number out of its range
            valid = min(inc%mu_s - mu, mu - inc%mu_k, trial%r(i), 1.0_wp - trial%r(i), slip, &
                dissipated, &
                -abs(phase * (phase - 1.0_wp) * (phase - 2.0_wp) * (phase - 3.0_wp)))
            if (phase <= 0.0_wp) valid = min(valid, -others)
            if (fine == 0) valid = -1.0_wp

            trial%p(i) = max(0.0_wp, -inc%alpha_n * zero_unless(fine, u_n + du(i, 1)))
            if (trial%p(i) > 0.0_wp) valid = min(valid, -u_n, trial%p(i) - smallest)
            trial%tau(i) = inc%alpha_t * sqrt(trial%q1(i)**2 + trial%q2(i)**2)
            trial%c(i) = (mu - inc%mu_k) + inc%forming
            trial%slides(i) = 0.0_wp
            strength = max(trial%r(i), least_ratio) * (inc%mu_k + trial%c(i) * iw0) * trial%p(i)
            if (trial%tau(i) > strength * (1.0_wp + verge)) trial%slides(i) = 1.0_wp
            if (trial%p(i) <= 0.0_wp) trial%slides(i) = 0.0_wp
            if (abs(trial%tau(i) - strength * (1.0_wp + verge)) < unsure * strength) valid = -1.0_wp
            fall = trial%p(i) * inc%kappa * trial%c(i)
            if (inc%alpha_t * inc%w0**2 <= fall) valid = min(valid, -trial%slides(i))
            if (abs(trial%q1(i)) + abs(trial%q2(i)) > 0.0_wp) valid = min(valid, trial%tau(i) &
                - smallest)
            left(i) = 0
            if (valid < 0.0_wp) left(i) = 1
            n_left = n_left + left(i)
        end do
    end subroutine find_trial

    !> Solves for slip and R of the points that slide, packed together.
    subroutine find_slip(inc, trial, slid, left, n_left)
        type(increment), intent(in) :: inc
        type(trial_block), intent(in) :: trial
        type(slip_block), intent(out) :: slid
        integer(c_int), intent(inout) :: left(lanes)
        integer(c_int), intent(out) :: n_left
        type(slip_block) :: packed
        real(wp), dimension(lanes) :: p, c, tau, r_n, active
        integer :: place(lanes), n_slides, n_solved, i

        n_slides = 0
        do i = 1, lanes
            place(n_slides + 1) = i
            n_slides = n_slides + int(trial%slides(i))
        end do
        n_solved = min(lanes, iand(n_slides + widest - 1, not(widest - 1)))
        do i = n_slides + 1, n_solved
            place(i) = place(1)   ! whole vectors: the first one fills the last
        end do
        do i = 1, n_solved
            p(i) = trial%p(place(i))
            c(i) = trial%c(place(i))
            tau(i) = trial%tau(place(i))
            r_n(i) = trial%r(place(i))
        end do
        call solve(n_solved, inc, p, c, tau, r_n, packed, active)

        slid%s = 0.0_wp
        slid%r = 1.0_wp
        slid%log_r = 0.0_wp
        do i = 1, n_slides
            slid%s(place(i)) = packed%s(i)
            slid%r(place(i)) = packed%r(i)
            slid%log_r(place(i)) = packed%log_r(i)
        end do
        n_left = int(sum(active(:n_slides)), c_int)
        if (n_left == 0) return
        do i = 1, n_slides
            left(place(i)) = int(active(i), c_int)
        end do
    end subroutine find_slip

    !> Slip and R by the steps of module friction_subloading_core; a point that has settled stays
    !> where it is while others go on.
    subroutine solve(n, inc, p, c, tau, r_n, packed, active)
        integer, intent(in) :: n
        type(increment), intent(in) :: inc
        real(wp), dimension(lanes), intent(in) :: p, c, tau, r_n   !! of the trial
        type(slip_block), intent(inout) :: packed
        real(wp), intent(out) :: active(lanes)   !! 1 for a point that has not converged, else 0
        integer, parameter :: max_iterations = 7
        type(slip_task) :: task
        type(slip_guess) :: at
        type(slip_move) :: move
        type(inverses) :: inverse
        real(wp) :: e(lanes), log_r(lanes), still, iw0, w, gain, shared
        integer :: i, iteration

        iw0 = 1.0_wp / inc%w0
        do i = 1, n
            task = slip_task(tau(i), inc%alpha_t, p(i), r_n(i), c(i), inc%w0, inc%mu_k, inc%kappa, &
                inc%m)
            at = start_far(task, (inc%mu_k + c(i) * iw0) * p(i))
            packed%s(i) = at%s
            packed%r(i) = at%r
            e(i) = at%e
            active(i) = 1.0_wp
        end do
        do iteration = 1, max_iterations
            still = 0.0_wp   ! logarithms apart: their call needs the registers
            do i = 1, n
                log_r(i) = log(packed%r(i))
            end do
            do i = 1, n
                task = slip_task(tau(i), inc%alpha_t, p(i), r_n(i), c(i), inc%w0, inc%mu_k, &
                    inc%kappa, inc%m)
                at = slip_guess(packed%s(i), packed%r(i), e(i))
                w = inc%w0 + inc%kappa * at%s
                gain = at%r + inc%m * at%s
                shared = 1.0_wp / (w * gain * at%r)   ! one division for three
                inverse = inverses(gain * at%r * shared, w * at%r * shared, w * gain * shared)
                move = chebyshev(task, at, log_r(i), inverse)
                move%ds = move%ds * active(i)
                move%dr = move%dr * active(i)
                if (active(i) > 0.0_wp) packed%log_r(i) = logarithm_after(move, inverse%r)
                if (settled(task, at, move) <= 0.0_wp) active(i) = 0.0_wp
                still = max(still, active(i))
                at = moved(at, move)
                packed%s(i) = at%s
                packed%r(i) = at%r
                e(i) = at%e
            end do
            if (still <= 0.0_wp) return
        end do
    end subroutine solve

    !> State, traction and tangent at the end of the increment. Two loops, since a cache holds few
    !> lines whose addresses differ by a power of two.
    subroutine finish(stride, inc, du, trial, slid, statev, traction, tangent)
        integer(c_int64_t), intent(in) :: stride
        type(increment), intent(in) :: inc
        real(wp), intent(in) :: du(stride, 3)
        type(trial_block), intent(in) :: trial
        type(slip_block), intent(in) :: slid
        real(wp), intent(inout) :: statev(stride, 8), traction(stride, 3), tangent(stride, 3, 3)
        real(wp), dimension(lanes) :: share, along, coupling, direction, closed
        type(slip_task) :: task
        real(wp) :: w, iw, gain, shared, mu, full, d_slip, stiffness, below, r, t1, t2, across
        integer :: i

        !GCC$ ivdep
        do i = 1, lanes
            closed(i) = 0.0_wp
            if (trial%p(i) > 0.0_wp) closed(i) = 1.0_wp
            w = inc%w0 + inc%kappa * slid%s(i)
            gain = slid%r(i) + inc%m * slid%s(i)
            shared = 1.0_wp / (w * gain)
            iw = gain * shared
            mu = inc%mu_k + trial%c(i) * iw
            full = mu * trial%p(i)
            task = slip_task(0.0_wp, inc%alpha_t, trial%p(i), trial%r(i), trial%c(i), inc%w0, &
                inc%mu_k, inc%kappa, inc%m)
            d_slip = slope(task, slid%r(i), slid%log_r(i), inverses(iw, w * shared, 0.0_wp))
            stiffness = max(inc%alpha_t + d_slip, epsilon(1.0_wp) * inc%alpha_t)
            ! Quotients of all points, though each needs only one of them: none may divide by zero.
            below = max(full, least)
            if (trial%slides(i) > 0.0_wp) below = max(trial%tau(i) * stiffness, least)
            below = 1.0_wp / below
            r = min(closed(i) * trial%tau(i) * below, 1.0_wp)
            share(i) = closed(i)
            along(i) = inc%alpha_t * closed(i)
            coupling(i) = 0.0_wp
            direction(i) = 0.0_wp
            if (trial%slides(i) > 0.0_wp) then
                r = min(slid%r(i), 1.0_wp)
                direction(i) = inc%alpha_t * stiffness * below
                share(i) = slid%r(i) * full * stiffness * below
                along(i) = inc%alpha_t * trial%tau(i) * below * d_slip
                coupling(i) = -inc%alpha_n * inc%alpha_t * trial%tau(i) * below * slid%r(i) * mu
            end if
            statev(i, 1) = 3.0_wp - 2.0_wp * closed(i) + trial%slides(i)
            statev(i, 2) = statev(i, 2) + du(i, 1)
            statev(i, 3) = share(i) * trial%q1(i)
            statev(i, 4) = share(i) * trial%q2(i)
            statev(i, 5) = min(max(mu, inc%mu_k), inc%mu_s)
            statev(i, 6) = r
            statev(i, 7) = statev(i, 7) + slid%s(i)
            statev(i, 8) = statev(i, 8) + slid%r(i) * full * slid%s(i)
        end do
        !GCC$ ivdep
        do i = 1, lanes
            t1 = trial%q1(i) * direction(i)
            t2 = trial%q2(i) * direction(i)
            across = share(i) * inc%alpha_t
            traction(i, 1) = -trial%p(i)
            traction(i, 2) = across * trial%q1(i)
            traction(i, 3) = across * trial%q2(i)
            tangent(i, 1, 1) = inc%alpha_n * closed(i)
            tangent(i, 2, 1) = coupling(i) * t1
            tangent(i, 3, 1) = coupling(i) * t2
            tangent(i, 1, 2) = 0.0_wp
            tangent(i, 2, 2) = across + (along(i) - across) * t1**2
            tangent(i, 3, 2) = (along(i) - across) * t1 * t2
            tangent(i, 1, 3) = 0.0_wp
            tangent(i, 2, 3) = (along(i) - across) * t1 * t2
            tangent(i, 3, 3) = across + (along(i) - across) * t2**2
        end do
    end subroutine finish

end module friction_subloading_kernel
