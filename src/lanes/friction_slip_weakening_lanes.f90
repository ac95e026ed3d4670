!> Linear slip-weakening of a block of points, healing or not.
module friction_slip_weakening_lanes
    use, intrinsic :: iso_fortran_env, only : wp => real64
    use friction_lane_block, only : c_cap, c_own, lanes, n_constants, no_cap, rest_block, &
        slide_block, unsure
    use friction_rate_state_core, only : mean_decay
    use friction_slip_weakening_core, only : coefficient_at, fall_at, forgotten, remembered, &
        slip_to_balance
    implicit none
    private

    public :: rest_slip_weakening, slide_slip_weakening, state_slip_weakening

    integer, parameter :: c_mu_s = c_own, c_mu_k = c_own + 1, c_d_c = c_own + 2, c_xi = c_own + 3

    !> An increment of time as the law sees it.
    type :: healing
        real(wp) :: d_left(lanes)    !! what is left of D without slip [L]
        real(wp) :: by_slip(lanes)   !! D gained by a unit of slip [-]
    end type healing

contains

    pure subroutine rest_slip_weakening(constants, heals, dt, block)
        real(wp), intent(in) :: constants(lanes, n_constants)
        logical, intent(in) :: heals
        real(wp), intent(in) :: dt   !! [T]
        type(rest_block), intent(inout) :: block
        type(healing) :: now
        integer :: i

        call heal(constants, heals, dt, lanes, block%r, now)
        do i = 1, lanes
            block%r_rest(i) = now%d_left(i)
            block%mu_rest(i) = coefficient_at(now%d_left(i), constants(i, c_mu_s), &
                constants(i, c_mu_k), constants(i, c_d_c))
            block%strength(i) = block%mu_rest(i) * block%pressure(i)
            block%valid(i) = min(block%mu(i), block%r(i))
        end do
    end subroutine rest_slip_weakening

    pure subroutine slide_slip_weakening(constants, heals, dt, block)
        real(wp), intent(in) :: constants(lanes, n_constants)
        logical, intent(in) :: heals
        real(wp), intent(in) :: dt   !! [T]
        type(slide_block), intent(inout) :: block
        type(healing) :: now
        real(wp) :: mu_n, fall
        integer :: i

        call heal(constants, heals, dt, block%n, block%r, now)
        do i = 1, block%n
            mu_n = coefficient_at(now%d_left(i), constants(i, c_mu_s), constants(i, c_mu_k), &
                constants(i, c_d_c))
            fall = now%by_slip(i) * fall_at(now%d_left(i), (constants(i, c_mu_s) &
                - constants(i, c_mu_k)) * block%pressure(i), constants(i, c_d_c))
            block%slip(i) = slip_to_balance(block%trial(i) - mu_n * block%pressure(i), &
                block%trial(i) - constants(i, c_mu_k) * block%pressure(i), block%stiffness(i), &
                fall)
            ! under a cap a contact softer than its law can meet it more than once
            block%left(i) = 0.0_wp
            if (constants(i, c_cap) < no_cap .and. fall >= block%stiffness(i)) then
                block%left(i) = 1.0_wp
            end if
        end do
        call evolve(constants, heals, now, block)
        do i = 1, block%n
            block%d_pressure(i) = block%mu_end(i)
            block%resistance(i) = block%mu_end(i) * block%pressure(i)
            block%d_slip(i) = -now%by_slip(i) * fall_at(block%r_end(i), (constants(i, c_mu_s) &
                - constants(i, c_mu_k)) * block%pressure(i), constants(i, c_d_c))
            if (abs(now%d_left(i) + now%by_slip(i) * block%slip(i) - constants(i, c_d_c)) &
                < unsure * constants(i, c_d_c)) then
                block%left(i) = 1.0_wp   ! which side of the kink?
            end if
        end do
    end subroutine slide_slip_weakening

    !> mu and D after a given slip.
    pure subroutine state_slip_weakening(constants, heals, dt, block)
        real(wp), intent(in) :: constants(lanes, n_constants)
        logical, intent(in) :: heals
        real(wp), intent(in) :: dt   !! [T]
        type(slide_block), intent(inout) :: block   !! in: slip, out: mu_end, r_end
        type(healing) :: now

        call heal(constants, heals, dt, block%n, block%r, now)
        call evolve(constants, heals, now, block)
    end subroutine state_slip_weakening

    pure subroutine heal(constants, heals, dt, n, d, now)
        real(wp), intent(in) :: constants(lanes, n_constants)
        logical, intent(in) :: heals
        real(wp), intent(in) :: dt         !! [T]
        integer, intent(in) :: n
        real(wp), intent(in) :: d(lanes)   !! at the start of the increment [L]
        type(healing), intent(inout) :: now
        real(wp) :: left(lanes)
        integer :: i

        if (heals) then
            do i = 1, n
                left(i) = exp(-constants(i, c_xi) * dt)
            end do
            do i = 1, n
                now%d_left(i) = forgotten(d(i), constants(i, c_d_c), left(i))
                now%by_slip(i) = mean_decay(constants(i, c_xi) * dt, left(i))
            end do
        else
            do i = 1, n
                now%d_left(i) = d(i)
                now%by_slip(i) = 1.0_wp
            end do
        end if
    end subroutine heal

    pure subroutine evolve(constants, heals, now, block)
        real(wp), intent(in) :: constants(lanes, n_constants)
        logical, intent(in) :: heals
        type(healing), intent(in) :: now
        type(slide_block), intent(inout) :: block
        integer :: i

        do i = 1, block%n
            block%r_end(i) = now%d_left(i) + now%by_slip(i) * block%slip(i)
            if (heals) block%r_end(i) = remembered(now%d_left(i), now%by_slip(i), block%slip(i), &
                constants(i, c_d_c))
            block%mu_end(i) = coefficient_at(block%r_end(i), constants(i, c_mu_s), &
                constants(i, c_mu_k), constants(i, c_d_c))
        end do
    end subroutine evolve

end module friction_slip_weakening_lanes
