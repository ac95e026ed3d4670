!> How a fault under rate-and-state friction starts, from what the law says of one cell.
module fault_start
    use, intrinsic :: iso_fortran_env, only : dp => real64, int64
    use fault_problem, only : fault, fault_state
    use friction_mod, only : friction_bad_state, friction_facts, friction_law_of, &
        friction_message, friction_update, law_facts, law_state, law_subloading, load_rates, &
        read_surface, sliding_surface, statev_mu, statev_r, statev_size, statev_slip, &
        statev_status, statev_u_et, statev_u_n
    use number_text, only : six_digits
    use processes, only : team
    implicit none
    private

    public :: start_contacts, start_rate_state

contains

    !> Slip rates and tractions of the plan; the state follows from both. A steady start is one at
    !> the plate rate, everywhere under the traction of steady sliding where that is least: the
    !> stronger cells have aged so little that they slide as fast.
    subroutine start_rate_state(here, together, state, problem)
        type(fault), intent(inout) :: here
        type(team), intent(in) :: together
        type(fault_state), intent(inout) :: state
        character(len=:), allocatable, intent(out) :: problem   !! empty if there is none
        type(sliding_surface) :: surface
        real(dp) :: given(2), least
        integer :: i, k, cell, status

        allocate (state%memory(here%n), state%slip(here%n), state%rate(here%n), &
            state%traction(here%n))
        state%slip = 0.0_dp
        state%rate = here%plan%plate_rate
        here%prestress = 0.0_dp
        if (here%plan%steady) then
            least = huge(least)
            do cell = 1, here%n
                if (is_like_the_last(here, state%rate, cell)) cycle
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
        call find_states(here, state, cell)
        state%traction = here%prestress - here%damping * state%rate
        call tell_refused_cell(here, together, state, cell, 'no state of the law slides so fast', &
            problem)
    end subroutine start_rate_state

    !> The states that slide as told, under the tractions that are told.
    subroutine find_states(here, state, refused)
        type(fault), intent(in) :: here
        type(fault_state), intent(inout) :: state
        integer, intent(out) :: refused   !! the first cell that none slides so; or 0
        real(dp), parameter :: tolerance = 1.0e-6_dp   !! of ln(slip rate)
        type(sliding_surface) :: surface
        real(dp) :: traction
        integer :: cell, status

        refused = 0
        do cell = 1, here%n
            if (is_like_the_last(here, state%rate, cell)) then
                state%memory(cell) = state%memory(cell - 1)
                cycle
            end if
            call read_surface(here%props(cell, :), surface, status)
            traction = here%prestress(cell) - here%damping * state%rate(cell)
            state%memory(cell) = state_of(surface, traction, here%pressure(cell), state%rate(cell))
            if (abs(ln_rate(surface, traction, here%pressure(cell), state%memory(cell)) &
                - log(state%rate(cell))) <= tolerance .and. traction * (1.0_dp &
                - epsilon(traction) / tolerance) <= surface%tau_max) cycle
            refused = cell
            return
        end do
    end subroutine find_states

    !> What is wrong with the start of the first cell of all that is refused.
    subroutine tell_refused_cell(here, together, state, cell, why, problem)
        type(fault), intent(in) :: here
        type(team), intent(in) :: together
        type(fault_state), intent(in) :: state
        integer, intent(in) :: cell            !! first one of this process; or 0
        character(len=*), intent(in) :: why    !! all processes say the same
        character(len=:), allocatable, intent(out) :: problem   !! empty if there is none
        integer(int64) :: own, first
        real(dp) :: given(3)
        type(law_facts) :: law

        problem = ''
        own = huge(own)
        if (cell > 0) own = cell + int(here%plan%nx, int64) * (here%part%first - 1)
        first = together%lowest(own)
        if (first == huge(first)) return
        given = -huge(given)
        if (own == first) then
            law = friction_facts(here%props(cell, :))
            given = [state%traction(cell), state%rate(cell), law%shear_cap]
        end if
        call together%largest_of_each(given)
        problem = 'at the start, at x = ' // six_digits(here%plan%x_of(int(modulo(first - 1, &
            int(here%plan%nx, int64))) + 1)) // ', z = ' &
            // six_digits(here%plan%z_of(int((first - 1) / here%plan%nx) + 1)) &
            // ', under a traction of ' // six_digits(given(1)) // ' and at a slip rate of ' &
            // six_digits(given(2)) // ': '
        if (given(1) > given(3)) then
            problem = problem // 'the traction must not exceed tau_max = ' // six_digits(given(3))
        else
            problem = problem // why
        end if
    end subroutine tell_refused_cell

    !> Whether a cell starts as the one before it does: its state is then known.
    pure logical function is_like_the_last(here, rate, cell) result(yes)
        type(fault), intent(in) :: here
        real(dp), intent(in) :: rate(:)
        integer, intent(in) :: cell

        yes = cell > 1
        if (yes) yes = all(abs(here%props(cell, :) - here%props(cell - 1, :)) <= 0.0_dp)
        if (yes) yes = max(abs(here%pressure(cell) - here%pressure(cell - 1)), &
            abs(here%prestress(cell) - here%prestress(cell - 1)), abs(rate(cell) &
            - rate(cell - 1))) <= 0.0_dp
    end function is_like_the_last

    !> The contacts of all cells, for implicit steps, whatever the law: under rate-and-state
    !> friction as above; else under the traction of the plan, with the memory of a virgin surface,
    !> or in steady sliding.
    subroutine start_contacts(here, together, state, statev, problem)
        type(fault), intent(inout) :: here
        type(team), intent(in) :: together
        type(fault_state), intent(inout) :: state
        real(dp), intent(out) :: statev(:, :)                   !! cell, place
        character(len=:), allocatable, intent(out) :: problem   !! empty if there is none
        real(dp) :: given(1), contact(statev_size)
        integer :: i, k, cell, status, own_status
        character(len=:), allocatable :: why
        type(law_facts) :: law

        problem = ''
        status = 0
        if (here%plan%rate_state) call start_rate_state(here, together, state, problem)
        if (len(problem) > 0) return
        if (.not. allocated(state%slip)) then
            allocate (state%slip(here%n), state%memory(here%n), state%traction(here%n))
            state%slip = 0.0_dp
            state%rate = spread(here%plan%plate_rate, 1, here%n)
        end if
        cell = 0
        do k = here%part%first, here%part%first + here%part%rows - 1
            do i = 1, here%plan%nx
                cell = cell + 1
                if (here%plan%rate_state) then
                    state%traction(cell) = here%prestress(cell) - here%damping * state%rate(cell)
                    call load_contact(here%props(cell, :), here%pressure(cell), &
                        state%traction(cell), exp(state%memory(cell)), contact, status)
                else if (here%plan%steady) then
                    call slide_to_steady_state(here%props(cell, :), here%pressure(cell), &
                        here%plan%plate_rate, contact, state%traction(cell), status)
                else
                    given = here%plan%initial%at(here%plan%x_of(i), here%plan%z_of(k))
                    state%traction(cell) = given(1)
                    state%rate(cell) = 0.0_dp
                    call load_contact(here%props(cell, :), here%pressure(cell), given(1), -1.0_dp, &
                        contact, status)
                    law = friction_facts(here%props(cell, :))
                    if (given(1) > law%shear_cap) status = friction_bad_state
                end if
                if (status < 0) exit
                statev(cell, :) = contact
                if (.not. here%plan%rate_state) state%memory(cell) = contact(statev_r)
            end do
            if (status < 0) exit
        end do
        own_status = status
        status = int(together%lowest(int(min(own_status, 0), int64)))
        if (own_status >= 0) cell = 0
        why = trim(friction_message(status))
        ! the law's, of a traction beyond its strength
        if (status == friction_bad_state) why = 'the traction exceeds the strength'
        call tell_refused_cell(here, together, state, cell, why, problem)
        if (len(problem) > 0) return
        here%prestress = state%traction + here%damping * state%rate
    end subroutine start_contacts

    !> A contact that carries a traction elastically.
    subroutine load_contact(props, pressure, traction, internal, statev, status)
        real(dp), intent(in) :: props(:), pressure, traction
        real(dp), intent(in) :: internal   !! variable of the law; < 0: that of a virgin surface
        real(dp), intent(out) :: statev(statev_size)
        integer, intent(out) :: status
        type(law_facts) :: facts
        real(dp) :: tried(statev_size), t(2), tangent(2, 2)

        facts = friction_facts(props)
        statev = 0.0_dp
        statev(statev_status) = 1.0_dp
        statev(statev_u_n) = -pressure / facts%alpha_n
        statev(statev_u_et) = traction / facts%alpha_t
        statev(statev_mu) = facts%virgin_mu
        statev(statev_r) = facts%virgin_internal
        if (internal > 0.0_dp) statev(statev_r) = internal
        if (friction_law_of(props) == law_subloading) statev(statev_r) = traction &
            / (facts%virgin_mu * pressure)
        tried = statev
        t = 0.0_dp
        tangent = 0.0_dp
        call friction_update([0.0_dp, 0.0_dp], 1.0e-30_dp, props, tried, t, tangent, status)
    end subroutine load_contact

    !> A contact that has slid at a rate until its traction changes no more.
    subroutine slide_to_steady_state(props, pressure, rate, statev, traction, status)
        real(dp), intent(in) :: props(:), pressure, rate
        real(dp), intent(out) :: statev(statev_size), traction
        integer, intent(out) :: status
        real(dp), parameter :: growth = 1.3_dp, tolerance = 1.0e-13_dp
        integer, parameter :: most = 400
        type(law_facts) :: facts
        real(dp) :: t(2), tangent(2, 2), du, before
        integer :: i

        facts = friction_facts(props)
        statev = 0.0_dp
        traction = 0.0_dp
        t = 0.0_dp
        tangent = 0.0_dp
        call friction_update([-pressure / facts%alpha_n, 0.0_dp], 0.0_dp, props, statev, t, &
            tangent, status)
        du = 1.0e-3_dp * pressure / facts%alpha_t
        do i = 1, most
            if (status < 0) return
            before = t(2)
            call friction_update([0.0_dp, du], du / rate, props, statev, t, tangent, status)
            if (i > 40 .and. abs(t(2) - before) <= tolerance * pressure) exit
            du = growth * du
        end do
        traction = t(2)
        statev(statev_slip:) = 0.0_dp
    end subroutine slide_to_steady_state

    !> ln(slip rate) of a cell under a traction, without damping.
    real(dp) function ln_rate(surface, traction, pressure, ln_theta) result(ln_v)
        type(sliding_surface), intent(in) :: surface
        real(dp), intent(in) :: traction, pressure, ln_theta
        real(dp) :: rate
        logical :: jumps

        call surface%slip_rate(law_state(mu=0.0_dp, r=exp(ln_theta)), load_of(traction, &
            pressure), rate, jumps)
        ln_v = log(max(rate, tiny(rate)))
    end function ln_rate

    pure type(load_rates) function load_of(traction, pressure) result(load)
        real(dp), intent(in) :: traction, pressure

        load = load_rates(traction=traction, loading=0.0_dp, stiffness=1.0_dp, pressure=pressure, &
            pressure_rate=0.0_dp, sliding=.true.)
    end function load_of

    !> The state that slides at a rate under a traction. ln(rate) is a straight line in ln(theta).
    real(dp) function state_of(surface, traction, pressure, rate) result(ln_theta)
        type(sliding_surface), intent(in) :: surface
        real(dp), intent(in) :: traction, pressure, rate
        real(dp), parameter :: rough = 1.0e-2_dp, round_off = 1.0e-9_dp
        real(dp) :: before, ln_v, ln_v_before
        integer :: iteration

        before = ln_steady_state(surface, traction, pressure, rate, rough)
        do iteration = 1, 30   ! at the law's limits slip rates tell nothing of the state
            ln_v_before = ln_rate(surface, traction, pressure, before)
            ln_theta = before + 1.0_dp
            if (abs(ln_rate(surface, traction, pressure, ln_theta) - ln_v_before) > round_off) exit
            before = before + sign(10.0_dp, ln_v_before - log(rate))
        end do
        do iteration = 1, 20
            ln_v = ln_rate(surface, traction, pressure, ln_theta)
            if (.not. abs(ln_v - ln_v_before) > 0.0_dp) exit
            call swap_in(ln_theta - (ln_v - log(rate)) * (ln_theta - before) / (ln_v - ln_v_before))
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
    real(dp) function ln_steady_state(surface, traction, pressure, rate, tolerance) result(ln_theta)
        type(sliding_surface), intent(in) :: surface
        real(dp), intent(in) :: traction, pressure, rate
        real(dp), intent(in) :: tolerance   !! of ln(theta)
        type(law_state) :: change
        real(dp) :: low, high

        low = -300.0_dp
        high = 300.0_dp
        do
            ln_theta = 0.5_dp * (low + high)
            if (high - low <= tolerance .or. ln_theta <= low .or. ln_theta >= high) exit
            change = surface%state_rates(law_state(mu=0.0_dp, r=exp(ln_theta)), &
                load_of(traction, pressure), rate)
            if (change%r > 0.0_dp) then
                low = ln_theta
            else
                high = ln_theta
            end if
        end do
    end function ln_steady_state

    !> Traction of steady sliding, under the cap if there is one.
    real(dp) function steady_traction(surface, pressure, rate) result(traction)
        type(sliding_surface), intent(in) :: surface
        real(dp), intent(in) :: pressure, rate
        real(dp), parameter :: most = 1.0e300_dp   !! [F/L^2]
        real(dp) :: low, high, ln_theta
        integer :: halving

        ln_theta = ln_steady_state(surface, 0.0_dp, pressure, rate, 0.0_dp)
        low = 0.0_dp
        high = pressure
        do while (ln_rate(surface, high, pressure, ln_theta) < log(rate) .and. high < most)
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
        traction = min(traction, surface%tau_max)
    end function steady_traction

end module fault_start
