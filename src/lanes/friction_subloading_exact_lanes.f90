!> The subloading law integrated exactly for a constant slip rate, of a block of points. `y = -ln R`
!> travels beside R.
module friction_subloading_exact_lanes
    use, intrinsic :: iso_fortran_env, only : wp => real64
    use friction_exponential_integral, only : e1_of
    use friction_lane_block, only : lanes, least_ratio, n_constants, rest_block, &
        slide_block
    use friction_subloading_exact_core, only : exact_coefficient, exact_fall, mean_of_decay, &
        tilt_of_decay
    use friction_subloading_lanes, only : c_kappa, c_m, c_mu_k, c_mu_s, c_xi
    implicit none
    private

    public :: exact_coefficients_after, rest_subloading_exact, slide_subloading_exact

    real(wp), parameter :: least = 1.0e-200_wp      !! below every divisor that counts
    real(wp), parameter :: small_step = 1.0e-8_wp   !! the next error is its square
    real(wp), parameter :: y_largest = 200.0_wp     !! far from where exp(y) overflows
    real(wp), parameter :: steepest = 10.0_wp       !! for the start, where -ln R has no bound

    !> What the iteration needs of a block, and where it is.
    type :: search
        real(wp) :: v_n(lanes)   !! E1(-ln R) at the start of the increment
        real(wp) :: y(lanes)     !! -ln R
        real(wp) :: mu(lanes), fall(lanes)   !! coefficient, and -d(mu)/ds
    end type search

contains

    pure subroutine rest_subloading_exact(constants, dt, block)
        real(wp), intent(in) :: constants(lanes, n_constants)
        real(wp), intent(in) :: dt   !! [T]
        type(rest_block), intent(inout) :: block
        real(wp) :: healing, decay, full
        integer :: i

        do i = 1, lanes
            healing = constants(i, c_xi) * dt
            decay = exp(-healing)
            block%mu_rest(i) = exact_coefficient(block%mu(i), constants(i, c_mu_s), &
                constants(i, c_mu_k), healing, decay, mean_of_decay(healing, &
                tilt_of_decay(healing, decay)))
            full = block%mu_rest(i) * block%pressure(i)
            block%strength(i) = max(block%r(i), least_ratio) * full
            ! beside no strength at all only a surface without traction rests
            block%r_rest(i) = min(block%traction(i) / max(full, least), 1.0_wp)
            block%valid(i) = min(constants(i, c_mu_s) - block%mu(i), &
                block%mu(i) - constants(i, c_mu_k), block%r(i), 1.0_wp - block%r(i))
        end do
    end subroutine rest_subloading_exact

    !> Newton's method on the pair (s, ln y); a point that has settled stays where it is while
    !> others
    !> go on.
    pure subroutine slide_subloading_exact(constants, dt, block)
        real(wp), intent(in) :: constants(lanes, n_constants)
        real(wp), intent(in) :: dt   !! [T]
        type(slide_block), intent(inout) :: block
        integer, parameter :: max_iterations = 12
        type(search) :: now
        real(wp) :: still
        integer :: i, iteration

        block%slip(:block%n) = 0.0_wp
        call find_coefficient(constants, dt, block, now)
        do i = 1, block%n
            block%d_pressure(i) = 0.0_wp   ! 1 where several equilibria are possible
            if (block%stiffness(i) <= block%pressure(i) * now%fall(i)) block%d_pressure(i) = 1.0_wp
            block%left(i) = 1.0_wp
        end do
        call start(constants, block, now)
        do iteration = 1, max_iterations
            call find_coefficient(constants, dt, block, now)
            call step(constants, block, now, still)
            if (still <= 0.0_wp) exit
        end do
        call find_coefficient(constants, dt, block, now)
        do i = 1, block%n
            block%left(i) = max(block%left(i), block%d_pressure(i))
            block%r_end(i) = exp(-now%y(i))
        end do
        do i = 1, block%n
            block%mu_end(i) = now%mu(i)
            block%d_pressure(i) = block%r_end(i) * now%mu(i)
            block%resistance(i) = block%d_pressure(i) * block%pressure(i)
            block%d_slip(i) = block%pressure(i) * (now%mu(i) * constants(i, c_m) * now%y(i) &
                - block%r_end(i) * now%fall(i))
        end do
    end subroutine slide_subloading_exact

    !> Friction coefficients after the slips that were found.
    pure subroutine exact_coefficients_after(constants, dt, block)
        real(wp), intent(in) :: constants(lanes, n_constants)
        real(wp), intent(in) :: dt   !! [T]
        type(slide_block), intent(inout) :: block   !! in: slip, out: mu_end
        type(search) :: now
        integer :: i

        call find_coefficient(constants, dt, block, now)
        do i = 1, block%n
            block%mu_end(i) = now%mu(i)
        end do
    end subroutine exact_coefficients_after

    !> mu after the slip, and how fast it falls.
    pure subroutine find_coefficient(constants, dt, block, now)
        real(wp), intent(in) :: constants(lanes, n_constants)
        real(wp), intent(in) :: dt
        type(slide_block), intent(in) :: block   !! slip
        type(search), intent(inout) :: now
        real(wp) :: decay(lanes), healing, x, tilt
        integer :: i

        do i = 1, block%n
            decay(i) = exp(-(constants(i, c_kappa) * block%slip(i) + constants(i, c_xi) * dt))
        end do
        do i = 1, block%n
            healing = constants(i, c_xi) * dt
            x = constants(i, c_kappa) * block%slip(i) + healing
            tilt = tilt_of_decay(x, decay(i))
            now%mu(i) = exact_coefficient(block%mu(i), constants(i, c_mu_s), constants(i, c_mu_k), &
                healing, decay(i), mean_of_decay(x, tilt))
            now%fall(i) = constants(i, c_kappa) * exact_fall(block%mu(i), constants(i, c_mu_s), &
                constants(i, c_mu_k), healing, decay(i), tilt)
        end do
    end subroutine find_coefficient

    !> A start for any slip: with `R' = rate (1 - R)` and mu as at the beginning, backward Euler's
    !> step ends at the root of a quadratic. The positive root, taken where nothing cancels.
    pure subroutine start(constants, block, now)
        real(wp), intent(in) :: constants(lanes, n_constants)
        type(slide_block), intent(inout) :: block
        type(search), intent(inout) :: now
        real(wp), parameter :: small = 0.1_wp
        real(wp), dimension(lanes) :: y_n, log_y, e, r
        real(wp) :: rate, full, excess, b, root
        integer :: i

        do i = 1, block%n
            y_n(i) = -log(max(block%r(i), least))
        end do
        do i = 1, block%n
            log_y(i) = log(max(y_n(i), least))
        end do
        do i = 1, block%n
            now%v_n(i) = e1_of(max(y_n(i), least), log_y(i), block%r(i))
            rate = constants(i, c_m) * min(y_n(i) / max(1.0_wp - block%r(i), least), steepest)
            if (block%r(i) >= 1.0_wp) rate = constants(i, c_m)
            full = now%mu(i) * block%pressure(i)
            excess = block%trial(i) - block%r(i) * full
            b = 0.5_wp * (block%stiffness(i) + rate * ((1.0_wp - block%r(i)) * full - excess))
            root = sqrt(b**2 + block%stiffness(i) * rate * excess)
            block%slip(i) = (root - b) / (block%stiffness(i) * rate)
            if (b > 0.0_wp) block%slip(i) = excess / (root + abs(b))
            e(i) = (1.0_wp - block%r(i)) / (1.0_wp + rate * block%slip(i))
            r(i) = max(1.0_wp - e(i), least)
            if (block%r(i) < small) then
                r(i) = max((block%r(i) + rate * block%slip(i)) / (1.0_wp + rate * &
                    block%slip(i)), least)
            end if
        end do
        do i = 1, block%n
            now%y(i) = -log(r(i))
        end do
        do i = 1, block%n
            if (e(i) <= small) now%y(i) = e(i) * (1.0_wp + e(i) * (0.5_wp + e(i) / 3.0_wp))
        end do
    end subroutine start

    pure subroutine step(constants, block, now, still)
        real(wp), intent(in) :: constants(lanes, n_constants)
        type(slide_block), intent(inout) :: block
        type(search), intent(inout) :: now
        real(wp), intent(out) :: still   !! above 0 as long as a point has not settled
        real(wp), dimension(lanes) :: log_y, r
        real(wp) :: y, lag, d, ds, dz, ms
        integer :: i

        do i = 1, block%n
            r(i) = exp(-min(now%y(i), y_largest))
        end do
        do i = 1, block%n
            log_y(i) = log(max(now%y(i), least))
        end do
        still = 0.0_wp
        do i = 1, block%n
            y = now%y(i)
            ms = constants(i, c_m) * block%slip(i)
            lag = e1_of(max(y, least), log_y(i), r(i)) - (now%v_n(i) + ms)
            if (y <= 0.0_wp) lag = 0.0_wp
            d = block%stiffness(i) + block%pressure(i) * (now%mu(i) * constants(i, c_m) * y &
                - r(i) * now%fall(i))
            ds = (block%trial(i) - block%stiffness(i) * block%slip(i) - block%pressure(i) &
                * now%mu(i) * (r(i) - y * lag)) / d
            dz = (lag - constants(i, c_m) * ds) / r(i)
            if (y <= 0.0_wp) dz = 0.0_wp
            if (block%left(i) > 0.0_wp) then
                block%slip(i) = max(block%slip(i) + ds, 0.05_wp * block%slip(i))
                now%y(i) = min(max(y * (1.0_wp + dz), 0.05_wp * y), 20.0_wp * y, y_largest)
                if (max(constants(i, c_kappa) * abs(ds), block%stiffness(i) * abs(ds) / &
                    block%trial(i), max(1.0_wp, y) * abs(dz)) <= small_step) then
                    block%left(i) = 0.0_wp
                end if
            end if
            still = max(still, block%left(i))
        end do
    end subroutine step

end module friction_subloading_exact_lanes
