!> How a fault under rate-and-state friction starts, from what the law says of one cell.
module fault_start
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use fault_problem, only : fault, fault_state
    use friction_mod, only : law_state, load_rates, read_surface, sliding_surface
    use processes, only : team
    implicit none
    private

    public :: start_rate_state

contains

    !> Slip rates and tractions of the plan; the state follows from both. A steady start is one at
    !> the plate rate, everywhere under the traction of steady sliding where that is least: the
    !> stronger cells have aged so little that they slide as fast.
    subroutine start_rate_state(here, together, state)
        type(fault), intent(inout) :: here
        type(team), intent(in) :: together
        type(fault_state), intent(inout) :: state
        type(sliding_surface) :: surface
        real(dp) :: given(2), least
        integer :: i, k, cell, status

        allocate (state%memory(here%n), state%slip(here%n), state%rate(here%n), &
            state%traction(here%n))
        state%slip = 0.0_dp
        state%rate = here%plan%plate_rate
        if (here%plan%steady) then
            least = huge(least)
            do cell = 1, here%n
                call read_surface(here%props(cell, :), surface, status)
                least = min(least, steady_traction(surface, here%pressure(cell), &
                    here%plan%plate_rate))
            end do
            here%prestress = -together%largest(-least) + here%damping * state%rate
        else
            cell = 0
            do k = here%part%first, here%part%first + here%part%rows - 1
                do i = 1, here%plan%nx
                    cell = cell + 1
                    given = here%plan%initial%at(here%plan%x_of(i), here%plan%z_of(k))
                    here%prestress(cell) = given(1) + here%damping * given(2)
                    state%rate(cell) = given(2)
                end do
            end do
        end if
        do cell = 1, here%n
            call read_surface(here%props(cell, :), surface, status)
            state%memory(cell) = state_of(surface, here%prestress(cell) &
                - here%damping * state%rate(cell), here%pressure(cell), state%rate(cell))
        end do
    end subroutine start_rate_state

    !> ln(slip rate) of a cell under a traction, without damping.
    function ln_rate(surface, traction, pressure, ln_theta) result(ln_v)
        type(sliding_surface), intent(in) :: surface
        real(dp), intent(in) :: traction, pressure, ln_theta
        real(dp) :: ln_v
        real(dp) :: rate
        logical :: jumps

        call surface%law%slip_rate(law_state(mu=0.0_dp, r=exp(ln_theta)), load_of(traction, &
            pressure), rate, jumps)
        ln_v = log(max(rate, tiny(rate)))
    end function ln_rate

    pure function load_of(traction, pressure) result(load)
        real(dp), intent(in) :: traction, pressure
        type(load_rates) :: load

        load = load_rates(traction=traction, loading=0.0_dp, stiffness=1.0_dp, pressure=pressure, &
            pressure_rate=0.0_dp, sliding=.true.)
    end function load_of

    !> The state that slides at a rate under a traction. ln(rate) is a straight line in ln(theta).
    function state_of(surface, traction, pressure, rate) result(ln_theta)
        type(sliding_surface), intent(in) :: surface
        real(dp), intent(in) :: traction, pressure, rate
        real(dp) :: ln_theta
        real(dp) :: before, ln_v, ln_v_before
        integer :: iteration

        before = ln_steady_state(surface, traction, pressure, rate)
        ln_v_before = ln_rate(surface, traction, pressure, before)
        ln_theta = before + 1.0_dp
        do iteration = 1, 20
            ln_v = ln_rate(surface, traction, pressure, ln_theta)
            if (.not. abs(ln_v - ln_v_before) > 0.0_dp) exit
            call swap_in(ln_theta - (ln_v - log(rate)) * (ln_theta - before) &
                / (ln_v - ln_v_before))
            if (abs(ln_theta - before) <= 1.0e-15_dp * abs(ln_theta)) exit
        end do

    contains

        subroutine swap_in(next)
            real(dp), intent(in) :: next

            before = ln_theta
            ln_v_before = ln_v
            ln_theta = next
        end subroutine swap_in

    end function state_of

    !> Where the state does not change any more at a slip rate.
    function ln_steady_state(surface, traction, pressure, rate) result(ln_theta)
        type(sliding_surface), intent(in) :: surface
        real(dp), intent(in) :: traction, pressure, rate
        real(dp) :: ln_theta
        type(law_state) :: change
        real(dp) :: low, high
        integer :: halving

        low = -300.0_dp
        high = 300.0_dp
        do halving = 1, 100
            ln_theta = 0.5_dp * (low + high)
            change = surface%law%state_rates(law_state(mu=0.0_dp, r=exp(ln_theta)), &
                load_of(traction, pressure), rate)
            if (change%r > 0.0_dp) then
                low = ln_theta
            else
                high = ln_theta
            end if
        end do
    end function ln_steady_state

    !> Traction of steady sliding.
    function steady_traction(surface, pressure, rate) result(traction)
        type(sliding_surface), intent(in) :: surface
        real(dp), intent(in) :: pressure, rate
        real(dp) :: traction
        real(dp) :: low, high, ln_theta
        integer :: halving

        ln_theta = ln_steady_state(surface, 0.0_dp, pressure, rate)
        low = 0.0_dp
        high = pressure
        do while (ln_rate(surface, high, pressure, ln_theta) < log(rate))
            high = 2.0_dp * high
        end do
        do halving = 1, 80
            traction = 0.5_dp * (low + high)
            if (ln_rate(surface, traction, pressure, ln_theta) < log(rate)) then
                low = traction
            else
                high = traction
            end if
        end do
    end function steady_traction

end module fault_start
