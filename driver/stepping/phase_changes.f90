!> Where the phases of a contact in continuous time end, and what comes next (docs/theory.md,
!> section 13).
module phase_changes
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use block_motion, only : moving_block
    use friction_mod, only : friction_update, law_state, load_rates, onset_drops, onset_gradual, &
        onset_yields, prop_alpha_n, prop_alpha_t, statev_r, statev_size, statev_slip, &
        statev_status, statev_u_et, statev_u_n
    use slider_rates, only : contact_motion, controlled, dissipated, elastic, extension, memory, &
        phase_capped, phase_open, phase_slide, phase_stick, ratio, slider_equations, slip, &
        unknowns, velocity
    use slip_balance, only : damper_balance
    implicit none
    private

    public :: between, change_phase, first_root, follow_velocity, phase_at_rest, settle, slide_on, &
        switch_values

    integer, parameter, public :: switches = 4   !! ways in which a phase can end
    integer, parameter, public :: lifts = 4      !! the one in which the block leaves the base

    !> Between what a switch value is not positive and positive.
    type, public :: root_bracket
        real(dp) :: low = 0.0_dp, high = 0.0_dp
        real(dp) :: g_low = 0.0_dp, g_high = 0.0_dp   !! values there
        integer, private :: side = 0   !! that was moved last, so many times on end: below 0 the
                                       !! lower one
    contains
        procedure :: guess, take
    end type root_bracket

contains

    !> Positive where the phase has ended: 1 because the surface starts or stops to slide, 2 because
    !> cap and law change places, 3 because the law changes its form, 4 because the block leaves the
    !> base or comes back.
    pure subroutine switch_values(eq, t, y, dy, g)
        type(slider_equations), intent(in) :: eq
        real(dp), intent(in) :: t              !! [T]
        real(dp), intent(in) :: y(controlled)
        real(dp), intent(in) :: dy(unknowns)   !! rates there
        real(dp), intent(out) :: g(switches)

        g = -1.0_dp
        if (eq%rests) then
            if (eq%phase == phase_slide) g(1) = -dy(slip)
            if (eq%phase == phase_stick) g(:2) = [eq%slip_tendency(y), -eq%sense * y(elastic)]
            return   ! 2: the traction changes its side
        end if
        if (eq%across%mass > 0.0_dp) g(lifts) = merge(-1.0_dp, 1.0_dp, eq%phase == phase_open) &
            * (eq%open_below - eq%pressed_to(y))
        if (.not. eq%damper > 0.0_dp) then
            call spring_switches(eq, t, y, dy, g)
        else if (eq%phase == phase_open) then
            return
        else if (eq%follows_share()) then
            g(1) = share_switch(eq, t, y)
        else if (eq%slides_damped()) then
            call damper_switches(eq, t, y, g)
        end if
    end subroutine switch_values

    !> The same of a contact without a damper beside its spring.
    pure subroutine spring_switches(eq, t, y, dy, g)
        type(slider_equations), intent(in) :: eq
        real(dp), intent(in) :: t, y(controlled), dy(unknowns)
        real(dp), intent(inout) :: g(switches)
        real(dp), parameter :: just_below = 1.0_dp - 1.0e-9_dp   !! or round-off would call it back
        type(load_rates) :: load
        real(dp) :: v_drive, pressure, pressure_rate, own, by_rate
        logical :: jumps, gradual, capped

        gradual = eq%surface%traits%onset == onset_gradual
        capped = eq%surface%tau_max < huge(own)
        if (eq%phase == phase_open .or. gradual .and. .not. capped) return
        if (gradual .and. eq%rigid .and. .not. eq%mass > 0.0_dp) return
        call eq%inputs(t, y, v_drive, pressure, pressure_rate)
        associate (cap => eq%surface%tau_max)
            select case (eq%phase)
            case (phase_stick)
                g(1) = abs(eq%traction(t, y)) - min(cap, eq%strength(y, pressure))
            case (phase_slide)
                if (gradual) then
                    g(2) = eq%alpha * abs(y(elastic)) - cap
                else
                    g(1) = -dy(slip)
                    if (eq%rigid .and. .not. eq%mass > 0.0_dp) g(1) = min(cap, eq%strength(&
                        y, pressure)) - eq%sense * eq%stiffness * y(extension) / eq%area
                    g(3) = y(memory) - eq%surface%traits%kink
                    if (capped .and. .not. eq%rigid .and. eq%surface%traits%onset &
                        /= onset_drops) then
                        g(2) = eq%strength(y, pressure) - cap
                    end if
                end if
            case default
                g(1) = -dy(slip)
                if (.not. gradual) then
                    g(2) = just_below * cap - eq%strength(y, pressure)
                else if (eq%surface%traits%memory == 1) then
                    g(2) = just_below * cap - y(ratio) * eq%full_strength(y, pressure)
                else if (eq%rigid) then
                    call eq%surface%resistance_at(eq%law_state_of(y, pressure), &
                        max(0.0_dp, dy(slip)), pressure, own, by_rate)
                    g(1) = -1.0_dp
                    g(2) = just_below * cap - own
                else
                    load = load_rates(cap, 0.0_dp, 1.0_dp, pressure, 0.0_dp, .false.)
                    call eq%surface%slip_rate(eq%law_state_of(y, pressure), load, own, &
                        jumps)
                    g(2) = own - dy(slip)
                end if
            end select
        end associate
    end subroutine spring_switches

    !> Positive where a subloading surface beside a damper stops to slide, or starts.
    pure function share_switch(eq, t, y) result(g)
        type(slider_equations), intent(in) :: eq
        real(dp), intent(in) :: t   !! [T]
        real(dp), intent(in) :: y(controlled)
        real(dp) :: g
        real(dp), parameter :: just_below = 1.0_dp - 1.0e-12_dp   !! or round-off would call it back
        type(contact_motion) :: contact
        type(damper_balance) :: balance
        type(law_state) :: state
        real(dp) :: v_drive, pressure, pressure_rate, pull
        logical :: failed

        call eq%inputs(t, y, v_drive, pressure, pressure_rate)
        pull = eq%pull(y)
        if (eq%phase == phase_stick) then
            call eq%damped_contact(y, pull, v_drive, pressure, pressure_rate, contact, failed)
            g = contact%ratio
        else
            balance = eq%balance_at(y, pull)
            state = eq%law_state_of(y, pressure)
            g = just_below * min(eq%surface%tau_max, state%r * eq%full_strength(y, &
                pressure)) - balance%push
        end if
    end function share_switch

    !> The first two switch values of other surfaces beside a damper, on a block with a mass.
    pure subroutine damper_switches(eq, t, y, g)
        type(slider_equations), intent(in) :: eq
        real(dp), intent(in) :: t   !! [T]
        real(dp), intent(in) :: y(controlled)
        real(dp), intent(inout) :: g(switches)
        real(dp), parameter :: just_below = 1.0_dp - 1.0e-12_dp   !! or round-off would call it back
        type(contact_motion) :: contact
        type(damper_balance) :: balance
        real(dp) :: v_drive, pressure, pressure_rate, pull, resistance, by_rate
        logical :: failed

        if (eq%surface%traits%onset == onset_gradual .and. .not. eq%surface%tau_max &
            < huge(pull)) return
        call eq%inputs(t, y, v_drive, pressure, pressure_rate)
        pull = eq%pull(y)
        associate (cap => eq%surface%tau_max)
            if (eq%surface%traits%onset == onset_gradual) then
                call eq%damped_contact(y, pull, v_drive, pressure, pressure_rate, contact, failed)
                g(2) = abs(contact%traction) - cap
                if (eq%phase == phase_slide) return
                call eq%surface%resistance_at(eq%law_state_of(y, pressure), max(0.0_dp, &
                    contact%slip), pressure, resistance, by_rate)
                g(2) = just_below * cap - resistance
                return
            end if
            balance = eq%balance_at(y, pull)
            resistance = min(cap, eq%strength(y, pressure))
            if (eq%phase == phase_stick) then
                g(1) = balance%push - resistance
            else
                g(1) = just_below * resistance - eq%sense * balance%sense * balance%push
            end if
        end associate
    end subroutine damper_switches

    !> Where a switch value first becomes positive on the cubic through the ends of a step, part of
    !> the step.
    function first_root(block, t, h, end, last, which) result(share)
        type(moving_block), intent(in) :: block
        real(dp), intent(in) :: t          !! [T]
        real(dp), intent(in) :: h          !! length of the step [T]
        real(dp), intent(in) :: end(unknowns), last(unknowns)   !! its end, and rates there
        integer, intent(in) :: which       !! of the switch values
        real(dp) :: share
        integer, parameter :: most_tries = 20
        real(dp), parameter :: close = 1.0e-5_dp, small = 1.0e-3_dp
        type(root_bracket) :: bracket
        real(dp) :: middle, g(switches), y(unknowns), dy(unknowns)
        logical :: failed
        integer :: i

        call switch_values(block%equations, t, block%y, block%first, g)
        bracket%g_low = g(which)
        call switch_values(block%equations, t + h, end, last, g)
        bracket%high = 1.0_dp
        bracket%g_high = g(which)
        bracket%g_low = min(bracket%g_low, -small * bracket%g_high)   ! a phase may start at its end
        share = bracket%guess()
        do i = 1, most_tries
            middle = share
            y = between(block, h, end, last, middle)
            call block%equations%rates(t + middle * h, y, dy, failed)
            call switch_values(block%equations, t + middle * h, y, dy, g)
            call bracket%take(middle, g(which))
            share = bracket%guess()
            if (abs(share - middle) <= close) exit
        end do
    end function first_root

    !> The unknowns on the cubic through the ends of a step.
    pure function between(block, h, end, last, share) result(y)
        type(moving_block), intent(in) :: block   !! at its start
        real(dp), intent(in) :: h                 !! its length [T]
        real(dp), intent(in) :: end(unknowns), last(unknowns)   !! its end, and rates there
        real(dp), intent(in) :: share             !! part of the step
        real(dp) :: y(unknowns), change(unknowns)

        change = end - block%y
        y = block%y + share * change + share * (share - 1.0_dp) * ((1.0_dp - 2.0_dp * share) &
            * change + h * ((share - 1.0_dp) * block%first + share * last))
    end function between

    !> Where the value of a switch is expected to be 0: false position, by the Illinois method. That
    !> crawls along a value that is next to nothing and then rises at a kink: half-way then.
    pure function guess(self) result(x)
        class(root_bracket), intent(in) :: self
        real(dp) :: x
        integer, parameter :: most = 3   !! moves of one side on end

        x = 0.5_dp * (self%low + self%high)
        if (.not. self%g_low < 0.0_dp) return   ! round-off calls the start the end of the phase
        if (abs(self%side) >= most) return
        x = (self%low * self%g_high - self%high * self%g_low) / (self%g_high - self%g_low)
        if (.not. (x > self%low .and. x < self%high)) x = 0.5_dp * (self%low + self%high)
    end function guess

    !> Takes in a value between the ends.
    pure subroutine take(self, x, g)
        class(root_bracket), intent(inout) :: self
        real(dp), intent(in) :: x, g

        if (g > 0.0_dp) then
            self%high = x
            self%g_high = g
            if (self%side > 0) self%g_low = 0.5_dp * self%g_low
            self%side = max(self%side, 0) + 1
        else
            self%low = x
            self%g_low = g
            if (self%side < 0) self%g_high = 0.5_dp * self%g_high
            self%side = min(self%side, 0) - 1
        end if
    end subroutine take

    !> Rates at the start of a step, in the phase that holds there.
    subroutine settle(block, t)
        type(moving_block), intent(inout) :: block
        real(dp), intent(in) :: t   !! [T]
        integer, parameter :: most_switches = 6
        real(dp), parameter :: round_off = 1.0e-12_dp
        real(dp) :: g(switches), v_drive, pressure, pressure_rate
        logical :: failed, slides, came_to_rest
        integer :: i

        came_to_rest = .false.
        if (block%known .and. block%equations%rests) return   ! the step before has seen to it
        associate (eq => block%equations)
            do i = 1, most_switches
                if (.not. block%known) call eq%rates(t, block%y, block%first, failed)
                if (.not. block%known .and. .not. failed) block%known = .true.
                if (eq%phase == phase_open) return
                call switch_values(eq, t, block%y, block%first, g)
                if (eq%phase == phase_stick .and. .not. (eq%damper > 0.0_dp .or. eq%rests)) then
                    call eq%inputs(t, block%y, v_drive, pressure, pressure_rate)
                    if (g(1) < -round_off * eq%strength(block%y, pressure)) return
                    slides = would_slide(block, pressure, pressure_rate)
                    if (.not. (slides .and. (g(1) > 0.0_dp .or. .not. eq%rigid))) return
                    if (came_to_rest) return   ! friction that drops does so by less than round-off
                    call change_phase(block, t, 1)
                else if (g(1) > 0.0_dp .or. g(2) > 0.0_dp) then
                    came_to_rest = g(1) > 0.0_dp
                    call change_phase(block, t, merge(1, 2, g(1) > 0.0_dp))
                else
                    return
                end if
            end do
        end associate
    end subroutine settle

    !> Does the traction of a contact that sticks at its strength grow faster than that?
    pure function would_slide(block, pressure, pressure_rate) result(slides)
        type(moving_block), intent(in) :: block
        real(dp), intent(in) :: pressure, pressure_rate   !! [F/L^2], [F/L^2/T]
        logical :: slides
        real(dp) :: strength, growth
        type(law_state) :: healing

        slides = .true.
        if (block%equations%rigid) return
        strength = block%equations%strength(block%y, pressure)
        growth = 0.0_dp
        if (strength < block%equations%surface%tau_max) then
            healing = block%equations%surface%state_rates(block%equations%law_state_of(block%y, &
                pressure), load_rates(strength, 0.0_dp, block%equations%alpha, pressure, &
                pressure_rate, .false.), 0.0_dp)
            growth = healing%mu * pressure
            if (pressure > 0.0_dp) growth = growth + (strength &
                - block%equations%surface%cohesion) / pressure * pressure_rate
        end if
        slides = block%equations%alpha * block%equations%sense_of(block%y(elastic)) &
            * block%first(elastic) > growth
    end function would_slide

    !> Phase of a contact that has just closed, or come to rest.
    pure function phase_at_rest(eq) result(phase)
        type(slider_equations), intent(in) :: eq
        integer :: phase

        phase = merge(phase_slide, phase_stick, eq%surface%traits%onset == onset_gradual &
            .or. eq%damper > 0.0_dp .and. .not. eq%slides_damped())
    end function phase_at_rest

    !> Enters the next phase.
    subroutine change_phase(block, t, which)
        type(moving_block), intent(inout) :: block
        real(dp), intent(in) :: t   !! [T]
        integer, intent(in) :: which
        real(dp), parameter :: just_inside = 1.0_dp - 8.0_dp * epsilon(1.0_dp)
        real(dp) :: v_drive, pressure, pressure_rate, strength

        block%known = .false.
        associate (eq => block%equations)
            if (eq%rests) then
                eq%phase = merge(phase_slide, phase_stick, eq%phase == phase_stick)
                eq%sense = eq%sense_of(block%y(elastic))
                return
            end if
            call eq%inputs(t, block%y, v_drive, pressure, pressure_rate)
            if (eq%damper > 0.0_dp) then
                if (eq%phase /= phase_slide) then
                    call slide_on(block, pressure)
                else if (which == 2) then
                    call slide_on(block, pressure)
                    eq%phase = phase_capped
                else
                    eq%phase = phase_stick
                end if
                return
            end if
            strength = min(eq%strength(block%y, pressure), eq%surface%tau_max)
            if (eq%phase == phase_capped .and. eq%surface%traits%onset == onset_gradual .and. &
                .not. eq%rigid) block%y(elastic) = eq%sense * just_inside * eq%surface%tau_max &
                / eq%alpha   ! or round-off would call the cap back
            if (which == 3) then
                block%y(memory) = eq%surface%traits%kink
            else if (eq%phase == phase_stick) then
                eq%sense = eq%sense_of(eq%traction(t, block%y))
                eq%phase = phase_slide
                if (eq%surface%traits%onset == onset_yields .and. .not. strength &
                    < eq%surface%tau_max .and. .not. eq%rigid) eq%phase = phase_capped
                if (.not. eq%rigid) call jump(block, pressure, strength)
            else if (which == 1) then
                eq%phase = phase_at_rest(eq)
                if (eq%rigid) block%y(velocity) = 0.0_dp
            else if (eq%phase == phase_slide) then
                eq%phase = phase_capped
                eq%sense = eq%sense_of(block%y(elastic))
                block%y(elastic) = eq%sense * eq%surface%tau_max / eq%alpha
                if (eq%surface%traits%memory == 1) block%y(ratio) = min(1.0_dp, eq%surface%tau_max &
                    / eq%full_strength(block%y, pressure))
            else
                if (eq%surface%traits%memory == 1) strength = block%y(ratio) &
                    * eq%full_strength(block%y, pressure)
                if (eq%surface%traits%memory == 1 .or. eq%surface%traits%onset &
                    == onset_yields) then
                    block%y(elastic) = sign(min(strength, eq%surface%tau_max) / eq%alpha, eq%sense)
                end if
                eq%phase = phase_slide
                if (eq%surface%traits%memory == 2 .and. eq%surface%traits%onset &
                    == onset_yields) call slip_at_once(block, pressure, abs(block%y(elastic)))
            end if
        end associate
    end subroutine change_phase

    !> A surface beside a damper slides from now on. A subloading one keeps its R when the pressure
    !> jumps, unless it sticks.
    pure subroutine slide_on(block, pressure)
        type(moving_block), intent(inout) :: block
        real(dp), intent(in) :: pressure   !! before the jump, or now [F/L^2]
        type(law_state) :: state
        type(damper_balance) :: balance

        associate (eq => block%equations)
            if (eq%follows_share()) then
                state = eq%law_state_of(block%y, pressure)
                block%y(ratio) = state%r
            end if
            balance = eq%balance_at(block%y, eq%pull(block%y))
            eq%sense = balance%sense
            eq%phase = phase_slide
        end associate
        block%known = .false.
    end subroutine slide_on

    !> Onset of slip under a law with a yield point. Where the resistance falls faster than the
    !> contact spring unloads, that goes on at once to where it does not.
    subroutine jump(block, pressure, strength)
        type(moving_block), intent(inout) :: block
        real(dp), intent(in) :: pressure   !! [F/L^2]
        real(dp), intent(in) :: strength   !! [F/L^2]
        real(dp) :: before, after

        associate (eq => block%equations)
            before = abs(block%y(elastic))
            block%y(elastic) = eq%sense * strength / eq%alpha
            if (eq%phase == phase_capped) return
            if (eq%surface%traits%onset == onset_drops) then
                after = dropped(eq, block%y, pressure)
                block%y(elastic) = eq%sense * after
                block%y(slip) = block%y(slip) + max(0.0_dp, before - after)
                block%y(dissipated) = block%y(dissipated) + max(0.0_dp, 0.5_dp * eq%alpha &
                    * (before**2 - after**2))
            else if (eq%surface%traits%memory == 2) then
                call slip_at_once(block, pressure, before)
            end if
        end associate
    end subroutine jump

    !> Elastic displacement, in the sense of the slip, under friction that falls at once.
    pure function dropped(eq, y, pressure) result(displacement)
        type(slider_equations), intent(in) :: eq
        real(dp), intent(in) :: y(unknowns)
        real(dp), intent(in) :: pressure   !! [F/L^2]
        real(dp) :: displacement           !! [L]
        real(dp) :: resistance, by_rate, v
        logical :: failed

        call eq%find_velocity(y(:controlled), pressure, v, failed)
        call eq%surface%resistance_at(eq%law_state_of(y(:controlled), pressure), max(0.0_dp, &
            eq%sense * v), pressure, resistance, by_rate)
        displacement = min(resistance, eq%surface%tau_max) / eq%alpha
    end function dropped

    !> At the end of a step: where the traction follows the velocity, so does the contact spring.
    !> Errors of its rate would add up, into the next time that the block sticks.
    pure subroutine follow_velocity(block, t, least_slip)
        type(moving_block), intent(inout) :: block
        real(dp), intent(in) :: t            !! [T]
        real(dp), intent(in) :: least_slip   !! that of the step's start [L]
        real(dp) :: v_drive, pressure, pressure_rate, after

        associate (eq => block%equations, y => block%y)
            if (eq%phase /= phase_slide .or. eq%surface%traits%onset /= onset_drops &
                .or. eq%rigid .or. eq%damper > 0.0_dp) return
            call eq%inputs(t, y(:controlled), v_drive, pressure, pressure_rate)
            after = dropped(eq, y, max(0.0_dp, pressure))
            y(slip) = max(least_slip, y(slip) + eq%sense * y(elastic) - after)
            y(elastic) = eq%sense * after
        end associate
    end subroutine follow_velocity

    !> Slip without time, as far as the friction routine lets the contact slip, if that is far. A
    !> block without mass and damper goes along: to friction its drive spring and its contact spring
    !> are one then.
    subroutine slip_at_once(block, pressure, before)
        type(moving_block), intent(inout) :: block
        real(dp), intent(in) :: pressure   !! [F/L^2]
        real(dp), intent(in) :: before     !! elastic displacement, in the sense of the slip [L]
        real(dp), parameter :: far = 1.0e-6_dp   !! part of that
        real(dp) :: statev(statev_size)
        real(dp) :: part   !! of the contact spring's stiffness [-]
        integer :: status

        associate (eq => block%equations, y => block%y)
            part = 1.0_dp
            call let_slip(block, pressure, before, part, statev, status)
            if (status < 0 .or. statev(statev_slip) < far * before) return
            if (eq%springs_alone()) then
                part = eq%stiffness / (eq%stiffness + eq%area * eq%alpha)
                call let_slip(block, pressure, before, part, statev, status)
                if (status < 0) return
            end if
            y(slip) = y(slip) + statev(statev_slip)
            y(dissipated) = y(dissipated) + 0.5_dp * eq%alpha * (before**2 / part - part &
                * statev(statev_u_et)**2)
            y(elastic) = sign(part * statev(statev_u_et), y(elastic))
            if (part < 1.0_dp) y(extension) = eq%area * eq%alpha * y(elastic) / eq%stiffness
            y(memory) = statev(statev_r)
        end associate
    end subroutine slip_at_once

    !> What the friction routine makes of a contact on a spring of a part of its stiffness.
    subroutine let_slip(block, pressure, before, part, statev, status)
        type(moving_block), intent(in) :: block
        real(dp), intent(in) :: pressure, before, part   !! as of `slip_at_once`
        real(dp), intent(out) :: statev(statev_size)
        integer, intent(out) :: status
        real(dp), parameter :: push = 1.0e-12_dp   !! part of the elastic displacement
        real(dp) :: props(size(block%props)), traction(2), tangent(2, 2)

        props = block%props
        props(prop_alpha_t) = part * props(prop_alpha_t)
        statev = 0.0_dp
        statev(statev_status) = 1.0_dp
        statev(statev_u_n) = -pressure / props(prop_alpha_n)
        statev(statev_u_et) = before / part
        statev(statev_r) = block%y(memory)
        call friction_update([0.0_dp, push * statev(statev_u_et)], 0.0_dp, props, statev, &
            traction, tangent, status)
    end subroutine let_slip

end module phase_changes
