!> The subloading law with U(R) = cot(pi R/2) or 1/R - 1 of a block of points, backward Euler.
module friction_subloading_general_lanes
    use, intrinsic :: iso_fortran_env, only : wp => real64
    use friction_lane_block, only : lanes, n_constants, slide_block
    use friction_subloading_core, only : coefficient, fall_of_coefficient, moved, reserve, &
        slip_guess, slip_move
    use friction_subloading_general_core, only : half_pi, ratio_gain, ratio_lack, &
        reciprocal_root, start_slip
    use friction_subloading_lanes, only : c_kappa, c_m, c_mu_k, c_mu_s, c_xi
    implicit none
    private

    public :: slide_subloading_general, state_subloading_general

    real(wp), parameter :: small_step = 1.0e-8_wp   !! the next error is its square

    !> Where the iteration is.
    type :: search
        real(wp) :: r(lanes), e(lanes)           !! R and 1 - R
        real(wp) :: above(lanes), below(lanes)   !! U is their quotient
        logical :: cotangent      !! U, else the reciprocal
        real(wp) :: bend          !! pi/2 or 1
    end type search

contains

    !> Newton's method on the pair (s, R); a point that has settled stays where it is while others
    !> go
    !> on.
    pure subroutine slide_subloading_general(constants, cotangent, dt, block)
        real(wp), intent(in) :: constants(lanes, n_constants)
        logical, intent(in) :: cotangent   !! U, else the reciprocal
        real(wp), intent(in) :: dt         !! [T]
        type(slide_block), intent(inout) :: block
        integer, parameter :: max_iterations = 20
        type(search) :: now
        real(wp) :: c(lanes), still
        integer :: i, iteration

        do i = 1, block%n
            c(i) = reserve(block%mu(i), constants(i, c_mu_s), constants(i, c_mu_k), &
                constants(i, c_xi) * dt)
            block%slip(i) = max(start_slip(constants(i, c_m), block%r(i), block%mu_rest(i) &
                * block%pressure(i), block%trial(i), block%stiffness(i)), &
                1.0e-12_wp * block%trial(i) / block%stiffness(i))   ! R needs some slip to leave 0
            block%left(i) = 1.0_wp
        end do
        call start_ratio(constants, cotangent, block, now)
        do iteration = 1, max_iterations
            call measure(block%n, now)
            call step(constants, dt, c, block, now, still)
            if (still <= 0.0_wp) exit
        end do
        call measure(block%n, now)
        call finish(constants, dt, c, now, block)
    end subroutine slide_subloading_general

    !> R after the slip: for the reciprocal its root, else where the search starts.
    pure subroutine start_ratio(constants, cotangent, block, now)
        real(wp), intent(in) :: constants(lanes, n_constants)
        logical, intent(in) :: cotangent
        type(slide_block), intent(in) :: block
        type(search), intent(inout) :: now
        integer :: i

        now%cotangent = cotangent
        now%bend = 1.0_wp
        if (cotangent) now%bend = half_pi
        do i = 1, block%n
            call reciprocal_root(block%r(i), constants(i, c_m) * block%slip(i) / now%bend, &
                now%r(i), now%e(i))
        end do
    end subroutine start_ratio

    pure subroutine measure(n, now)
        integer, intent(in) :: n
        type(search), intent(inout) :: now
        integer :: i

        if (now%cotangent) then
            do i = 1, n
                now%above(i) = sin(half_pi * now%e(i))
            end do
            do i = 1, n
                now%below(i) = sin(half_pi * now%r(i))
            end do
        else
            do i = 1, n
                now%above(i) = now%e(i)
                now%below(i) = now%r(i)
            end do
        end if
    end subroutine measure

    pure subroutine step(constants, dt, c, block, now, still)
        real(wp), intent(in) :: constants(lanes, n_constants)
        real(wp), intent(in) :: dt, c(lanes)
        type(slide_block), intent(inout) :: block
        type(search), intent(inout) :: now
        real(wp), intent(out) :: still   !! above 0 as long as a point has not settled
        real(wp) :: iw, mu, ms, gain, rate, lack
        type(slip_move) :: move
        type(slip_guess) :: at
        integer :: i

        still = 0.0_wp
        do i = 1, block%n
            iw = 1.0_wp / (1.0_wp + constants(i, c_xi) * dt + constants(i, c_kappa) &
                * block%slip(i))
            mu = constants(i, c_mu_k) + c(i) * iw
            ms = constants(i, c_m) * block%slip(i)
            gain = ratio_gain(now%below(i), ms, now%bend)
            rate = constants(i, c_m) * now%above(i) * gain
            lack = gain * ratio_lack(now%r(i), now%e(i), block%r(i), ms, now%above(i), &
                now%below(i))
            move%log_r = 0.0_wp
            move%ds = (block%trial(i) - block%stiffness(i) * block%slip(i) - block%pressure(i) &
                * mu * (now%r(i) + lack)) / (block%stiffness(i) + block%pressure(i) * (mu * rate &
                - now%r(i) * fall_of_coefficient(constants(i, c_kappa), c(i), iw)))
            move%dr = rate * move%ds + lack
            ! no store under a condition: what only that needs would be computed under it, too, of
            ! zeros in the lanes that it leaves out
            move%ds = move%ds * block%left(i)
            move%dr = move%dr * block%left(i)
            at = slip_guess(block%slip(i), now%r(i), now%e(i))
            block%left(i) = merge(block%left(i), 0.0_wp, max(block%stiffness(i) * abs(move%ds) &
                - small_step * block%trial(i), constants(i, c_m) * abs(move%ds) - small_step &
                * (now%r(i) + ms), abs(move%dr) - small_step * min(now%r(i), now%e(i))) > 0.0_wp)
            at = moved(at, move)
            block%slip(i) = at%s
            now%r(i) = at%r
            now%e(i) = at%e
            still = max(still, block%left(i))
        end do
    end subroutine step

    pure subroutine finish(constants, dt, c, now, block)
        real(wp), intent(in) :: constants(lanes, n_constants)
        real(wp), intent(in) :: dt, c(lanes)
        type(search), intent(in) :: now
        type(slide_block), intent(inout) :: block
        real(wp) :: w0, iw, rate
        integer :: i

        do i = 1, block%n
            w0 = 1.0_wp + constants(i, c_xi) * dt
            iw = 1.0_wp / (w0 + constants(i, c_kappa) * block%slip(i))
            rate = constants(i, c_m) * now%above(i) * ratio_gain(now%below(i), constants(i, c_m) &
                * block%slip(i), now%bend)
            block%mu_end(i) = coefficient(constants(i, c_mu_s), constants(i, c_mu_k), c(i), iw)
            block%r_end(i) = min(now%r(i), 1.0_wp)
            block%d_pressure(i) = block%r_end(i) * block%mu_end(i)
            block%resistance(i) = block%d_pressure(i) * block%pressure(i)
            block%d_slip(i) = block%pressure(i) * (block%mu_end(i) * rate - block%r_end(i) &
                * fall_of_coefficient(constants(i, c_kappa), c(i), iw))
            ! several equilibria are possible
            if (block%stiffness(i) * w0**2 <= block%pressure(i) * constants(i, c_kappa) * c(i)) then
                block%left(i) = 1.0_wp
            end if
        end do
    end subroutine finish

    !> mu and R after a given slip.
    pure subroutine state_subloading_general(constants, cotangent, dt, block)
        real(wp), intent(in) :: constants(lanes, n_constants)
        logical, intent(in) :: cotangent   !! U, else the reciprocal
        real(wp), intent(in) :: dt
        type(slide_block), intent(inout) :: block   !! in: slip, out: mu_end, r_end
        integer, parameter :: max_iterations = 20
        type(search) :: now
        type(slip_guess) :: at
        real(wp) :: active(lanes), ms, dr, healing, still
        integer :: i, iteration

        call start_ratio(constants, cotangent, block, now)
        do i = 1, block%n
            healing = constants(i, c_xi) * dt
            block%mu_end(i) = coefficient(constants(i, c_mu_s), constants(i, c_mu_k), &
                reserve(block%mu(i), constants(i, c_mu_s), constants(i, c_mu_k), healing), 1.0_wp &
                / (1.0_wp + healing + constants(i, c_kappa) * block%slip(i)))
            active(i) = 1.0_wp
        end do
        if (.not. cotangent) active = 0.0_wp
        do iteration = 1, max_iterations
            call measure(block%n, now)
            still = 0.0_wp
            do i = 1, block%n
                ms = constants(i, c_m) * block%slip(i)
                dr = active(i) * (ratio_gain(now%below(i), ms, now%bend) * ratio_lack(now%r(i), &
                    now%e(i), block%r(i), ms, now%above(i), now%below(i)))
                active(i) = merge(active(i), 0.0_wp, abs(dr) > small_step * min(now%r(i), now%e(i)))
                at = moved(slip_guess(0.0_wp, now%r(i), now%e(i)), slip_move(0.0_wp, dr, 0.0_wp))
                now%r(i) = at%r
                now%e(i) = at%e
                still = max(still, active(i))
            end do
            if (still <= 0.0_wp) exit
        end do
        do i = 1, block%n
            block%r_end(i) = min(now%r(i), 1.0_wp)
            block%left(i) = max(block%left(i), active(i))
        end do
    end subroutine state_subloading_general

end module friction_subloading_general_lanes
