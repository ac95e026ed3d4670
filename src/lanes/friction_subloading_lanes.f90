!> The subloading law of a block of points, backward Euler.
module friction_subloading_lanes
    use, intrinsic :: iso_fortran_env, only : wp => real64
    use friction_lane_block, only : c_own, lanes, least_ratio, n_constants, rest_block, &
        slide_block
    use friction_subloading_core, only : chebyshev, coefficient, inverses, &
        logarithm_after, moved, ratio_step, reserve, settled, slip_guess, slip_move, slip_task, &
        slope, start_far
    implicit none
    private

    public :: coefficients_after, rest_subloading, slide_subloading, state_subloading

    integer, parameter, public :: c_mu_s = c_own, c_mu_k = c_own + 1, c_kappa = c_own + 2, &
        c_xi = c_own + 3, c_m = c_own + 4
    real(wp), parameter :: least = 1.0e-200_wp   !! below every divisor that counts
    real(wp), parameter :: small_step = 1.0e-8_wp   !! the next error of Newton's method is its
                                                    !! square

contains

    pure subroutine rest_subloading(constants, dt, block)
        real(wp), intent(in) :: constants(lanes, n_constants)
        real(wp), intent(in) :: dt   !! [T]
        type(rest_block), intent(inout) :: block
        real(wp) :: w0, c, full_w0, shared
        integer :: i

        do i = 1, lanes
            w0 = 1.0_wp + constants(i, c_xi) * dt
            c = reserve(block%mu(i), constants(i, c_mu_s), constants(i, c_mu_k), &
                constants(i, c_xi) * dt)
            full_w0 = (constants(i, c_mu_k) * w0 + c) * block%pressure(i)
            shared = 1.0_wp / (w0 * max(full_w0, least))   ! one division for two
            block%mu_rest(i) = coefficient(constants(i, c_mu_s), constants(i, c_mu_k), c, &
                max(full_w0, least) * shared)
            block%strength(i) = max(block%r(i), least_ratio) * (block%mu_rest(i) * &
                block%pressure(i))
            block%r_rest(i) = merge(min(block%traction(i) * (w0 * w0 * shared), 1.0_wp), 0.0_wp, &
                full_w0 > 0.0_wp)
            block%valid(i) = min(constants(i, c_mu_s) - block%mu(i), &
                block%mu(i) - constants(i, c_mu_k), block%r(i), 1.0_wp - block%r(i))
        end do
    end subroutine rest_subloading

    !> Friction coefficients after the slips that were found.
    pure subroutine coefficients_after(constants, dt, block)
        real(wp), intent(in) :: constants(lanes, n_constants)
        real(wp), intent(in) :: dt   !! [T]
        type(slide_block), intent(inout) :: block   !! in: slip, out: mu_end
        real(wp) :: healing
        integer :: i

        do i = 1, block%n
            healing = constants(i, c_xi) * dt
            block%mu_end(i) = coefficient(constants(i, c_mu_s), constants(i, c_mu_k), &
                reserve(block%mu(i), constants(i, c_mu_s), constants(i, c_mu_k), healing), &
                1.0_wp / (1.0_wp + healing + constants(i, c_kappa) * block%slip(i)))
        end do
    end subroutine coefficients_after

    !> Chebyshev's method on all points at once; one that has settled stays where it is while others
    !> go on.
    pure subroutine slide_subloading(constants, dt, block)
        real(wp), intent(in) :: constants(lanes, n_constants)
        real(wp), intent(in) :: dt   !! [T]
        type(slide_block), intent(inout) :: block
        integer, parameter :: max_iterations = 7
        real(wp), dimension(lanes) :: c, w0, r, e, log_r
        real(wp) :: still
        integer :: i, iteration

        call begin(constants, dt, block, c, w0, r, e)
        block%left = 1.0_wp
        block%r_end = 0.0_wp
        do iteration = 1, max_iterations
            do i = 1, block%n   ! logarithms apart: their call needs the registers
                log_r(i) = log(r(i))
            end do
            call step(constants, c, w0, log_r, block, r, e, still)
            if (still <= 0.0_wp) exit
        end do
        call finish(constants, c, w0, r, block)
    end subroutine slide_subloading

    !> c and w(0) of each point, and a first guess.
    pure subroutine begin(constants, dt, block, c, w0, r, e)
        real(wp), intent(in) :: constants(lanes, n_constants)
        real(wp), intent(in) :: dt
        type(slide_block), intent(inout) :: block
        real(wp), dimension(lanes), intent(out) :: c, w0, r, e
        type(slip_task) :: task
        type(slip_guess) :: guess
        integer :: i

        do i = 1, block%n
            w0(i) = 1.0_wp + constants(i, c_xi) * dt
            c(i) = reserve(block%mu(i), constants(i, c_mu_s), constants(i, c_mu_k), &
                constants(i, c_xi) * dt)
            task = slip_task(block%trial(i), block%stiffness(i), block%pressure(i), block%r(i), &
                c(i), w0(i), constants(i, c_mu_k), constants(i, c_kappa), constants(i, c_m))
            guess = start_far(task, block%mu_rest(i) * task%pressure)
            block%slip(i) = guess%s
            r(i) = guess%r
            e(i) = guess%e
        end do
    end subroutine begin

    pure subroutine step(constants, c, w0, log_r, block, r, e, still)
        real(wp), intent(in) :: constants(lanes, n_constants)
        real(wp), dimension(lanes), intent(in) :: c, w0
        real(wp), dimension(lanes), intent(in) :: log_r     !! ln R
        type(slide_block), intent(inout) :: block     !! slip; r_end keeps ln R of settled points
        real(wp), dimension(lanes), intent(inout) :: r, e   !! R and 1 - R
        real(wp), intent(out) :: still                !! above 0 as long as a point has not settled
        type(slip_task) :: task
        type(slip_guess) :: at
        type(slip_move) :: move
        type(inverses) :: inverse
        real(wp) :: w, gain, shared
        integer :: i

        still = 0.0_wp
        do i = 1, block%n
            task = slip_task(block%trial(i), block%stiffness(i), block%pressure(i), block%r(i), &
                c(i), w0(i), constants(i, c_mu_k), constants(i, c_kappa), constants(i, c_m))
            at = slip_guess(block%slip(i), r(i), e(i))
            w = w0(i) + task%kappa * at%s
            gain = at%r + task%m * at%s
            shared = 1.0_wp / (w * gain * at%r)   ! one division for three
            inverse = inverses(gain * at%r * shared, w * at%r * shared, w * gain * shared)
            move = chebyshev(task, at, log_r(i), inverse)
            move%ds = move%ds * block%left(i)
            move%dr = move%dr * block%left(i)
            ! no store under a condition: that would be a branch
            block%r_end(i) = merge(logarithm_after(move, inverse%r), block%r_end(i), &
                block%left(i) > 0.0_wp)
            block%left(i) = merge(block%left(i), 0.0_wp, settled(task, at, move) > 0.0_wp)
            still = max(still, block%left(i))
            at = moved(at, move)
            block%slip(i) = at%s
            r(i) = at%r
            e(i) = at%e
        end do
    end subroutine step

    pure subroutine finish(constants, c, w0, r, block)
        real(wp), intent(in) :: constants(lanes, n_constants)
        real(wp), dimension(lanes), intent(in) :: c, w0, r
        type(slide_block), intent(inout) :: block   !! in: r_end is ln R
        type(slip_task) :: task
        type(inverses) :: inverse
        real(wp) :: w, gain, shared
        integer :: i

        do i = 1, block%n
            task = slip_task(block%trial(i), block%stiffness(i), block%pressure(i), block%r(i), &
                c(i), w0(i), constants(i, c_mu_k), constants(i, c_kappa), constants(i, c_m))
            w = w0(i) + task%kappa * block%slip(i)
            gain = r(i) + task%m * block%slip(i)
            shared = 1.0_wp / (w * gain)
            inverse = inverses(gain * shared, w * shared, 0.0_wp)
            block%d_slip(i) = slope(task, r(i), block%r_end(i), inverse)
            block%d_pressure(i) = r(i) * (task%mu_k + c(i) * inverse%w)
            block%resistance(i) = block%d_pressure(i) * block%pressure(i)
            block%mu_end(i) = coefficient(constants(i, c_mu_s), task%mu_k, c(i), inverse%w)
            block%r_end(i) = min(r(i), 1.0_wp)
            ! several equilibria are possible
            block%left(i) = merge(block%left(i), 1.0_wp, task%stiffness * w0(i)**2 &
                > task%pressure * task%kappa * c(i))
        end do
    end subroutine finish

    !> mu and R after a given slip.
    pure subroutine state_subloading(constants, dt, block)
        real(wp), intent(in) :: constants(lanes, n_constants)
        real(wp), intent(in) :: dt
        type(slide_block), intent(inout) :: block   !! in: slip, out: mu_end, r_end
        integer, parameter :: max_iterations = 20
        real(wp), dimension(lanes) :: r, e, log_r, active
        real(wp) :: ms, healing, c, still, dr
        type(slip_guess) :: at
        integer :: i, iteration

        do i = 1, block%n
            healing = constants(i, c_xi) * dt
            c = reserve(block%mu(i), constants(i, c_mu_s), constants(i, c_mu_k), healing)
            block%mu_end(i) = coefficient(constants(i, c_mu_s), constants(i, c_mu_k), c, &
                1.0_wp / (1.0_wp + healing + constants(i, c_kappa) * block%slip(i)))
            ms = constants(i, c_m) * block%slip(i)
            e(i) = (1.0_wp - block%r(i)) / (1.0_wp + ms)
            r(i) = max((block%r(i) + ms) / (1.0_wp + ms), least)
            active(i) = 1.0_wp
        end do
        do iteration = 1, max_iterations
            do i = 1, block%n
                log_r(i) = log(r(i))
            end do
            still = 0.0_wp
            do i = 1, block%n
                at = slip_guess(0.0_wp, r(i), e(i))
                call ratio_step(constants(i, c_m) * block%slip(i), block%r(i), log_r(i), at, dr)
                if (active(i) > 0.0_wp) r(i) = at%r
                if (active(i) > 0.0_wp) e(i) = at%e
                if (abs(dr) <= small_step * min(at%r, at%e)) active(i) = 0.0_wp
                still = max(still, active(i))
            end do
            if (still <= 0.0_wp) exit
        end do
        do i = 1, block%n
            block%r_end(i) = min(r(i), 1.0_wp)
            block%left(i) = max(block%left(i), active(i))
        end do
    end subroutine state_subloading

end module friction_subloading_lanes
