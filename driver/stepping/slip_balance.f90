!> Slip rates at which dampers and friction together balance what pushes a contact.
module slip_balance
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use friction_mod, only : law_state, load_rates, sliding_surface
    implicit none
    private

    public :: damper_balance, slip_of

    !> Of a contact with a damper, or on a block with one and without mass: `push - drag v` is its
    !> traction at the slip rate v.
    type :: damper_balance
        real(dp) :: sense   !! of the slip in x
        real(dp) :: push    !! >= 0 [F/L^2]
        real(dp) :: drag    !! >= 0 [F T/L^3]
    end type damper_balance

contains

    !> The least slip rate at which `push - drag v` is what the law, or a cap, resists with.
    pure subroutine slip_of(surface, state, pressure, balance, cap, v, failed)
        type(sliding_surface), intent(in) :: surface
        type(law_state), intent(in) :: state
        real(dp), intent(in) :: pressure
        type(damper_balance), intent(in) :: balance
        real(dp), intent(in) :: cap       !! [F/L^2]
        real(dp), intent(out) :: v        !! [L/T]
        logical, intent(out) :: failed    !! there is none
        integer, parameter :: most_iterations = 100
        real(dp), parameter :: round_off = 4.0_dp * epsilon(1.0_dp)
        real(dp) :: resistance, by_rate, misfit, capped
        integer :: i

        failed = .false.
        v = 0.0_dp
        call surface%resistance_at(state, 0.0_dp, pressure, resistance, by_rate)
        if (balance%push <= min(resistance, cap)) return
        if (balance%push > cap) then
            failed = .not. balance%drag > 0.0_dp
            if (failed) return
            capped = (balance%push - cap) / balance%drag
            call surface%resistance_at(state, capped, pressure, resistance, by_rate)
            v = capped
            if (resistance >= cap) return
            v = 0.0_dp
        end if
        if (surface%traits%stiff) then
            v = creep_rate(surface, state, balance%push, balance%drag, pressure)
            return
        end if
        do i = 1, most_iterations
            call surface%resistance_at(state, v, pressure, resistance, by_rate)
            misfit = balance%push - balance%drag * v - resistance
            failed = .not. balance%drag + by_rate > 0.0_dp
            if (failed .or. abs(misfit) <= round_off * balance%push) return
            v = max(0.0_dp, v + misfit / (balance%drag + by_rate))
        end do
        failed = .not. abs(misfit) <= 1.0e3_dp * round_off * balance%push
    end subroutine slip_of

    !> The slip rate of a law without a yield point at which `push = drag v + traction(v)`, by
    !> Newton's method on the traction, from where the drag alone would carry the push: v is convex
    !> in the traction.
    pure function creep_rate(surface, state, push, drag, pressure) result(v)
        type(sliding_surface), intent(in) :: surface
        type(law_state), intent(in) :: state
        real(dp), intent(in) :: push, drag, pressure   !! push >= 0, drag >= 0
        real(dp) :: v   !! >= 0 [L/T]
        integer, parameter :: most_iterations = 200
        type(load_rates) :: load
        real(dp) :: tau, resistance, by_rate, change
        logical :: jumps
        integer :: i

        tau = push
        if (drag > 0.0_dp) then
            call surface%resistance_at(state, push / drag, pressure, resistance, by_rate)
            tau = min(tau, resistance)
        end if
        load = load_rates(tau, 0.0_dp, 1.0_dp, pressure, 0.0_dp, .false.)
        call surface%slip_rate(state, load, v, jumps)
        if (.not. drag > 0.0_dp) return
        do i = 1, most_iterations
            call surface%resistance_at(state, v, pressure, resistance, by_rate)
            if (.not. by_rate > 0.0_dp) exit   ! friction vanishes beside cohesion: the drag decides
            change = (push - drag * v - load%traction) / (1.0_dp + drag / by_rate)
            load%traction = load%traction + change
            call surface%slip_rate(state, load, v, jumps)
            if (abs(change) <= 4.0_dp * epsilon(change) * load%traction) exit
        end do
        ! of the two, what round-off of the traction changes less
        if (drag > by_rate) v = max(0.0_dp, push - load%traction) / drag
    end function creep_rate

end module slip_balance
