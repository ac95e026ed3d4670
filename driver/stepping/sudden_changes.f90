!> What changes at one moment of time: a normal traction that jumps, a contact that opens or
!> touches, slip in a time that is lost in round-off.
module sudden_changes
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use block_motion, only : moving_block
    use contact_forces, only : apply_normal_traction
    use friction_mod, only : law_state, load_rates, prop_alpha_t, statev_size, &
        statev_status, statev_u_et, statev_u_n
    use phase_changes, only : phase_at_rest, slide_on
    use slider_rates, only : elastic, extension, memory, phase_capped, phase_open, phase_slide, &
        phase_stick, ratio, slider_equations, slip, unknowns, velocity
    use slider_system, only : set_accelerations, slider, slider_state
    implicit none
    private

    public :: creep_at_once, open_or_touch, press, stopped, take_load, take_off_spring

contains

    !> A rigid contact carries what the block's velocity, or without one the friction at the start,
    !> asks for.
    subroutine take_off_spring(block, start)
        type(moving_block), intent(inout) :: block
        type(slider_state), intent(in) :: start
        real(dp) :: traction   !! [F/L^2]
        logical :: jumps

        associate (eq => block%equations, v => block%y(velocity))
            eq%sense = eq%sense_of(v)
            if (abs(v) > 0.0_dp .and. eq%phase == phase_stick) eq%phase = phase_slide
            block%y(elastic) = 0.0_dp
            if (.not. abs(v) > 0.0_dp .and. eq%creeps_along()) then
                traction = start%friction(1) / eq%area
                call eq%surface%slip_rate(eq%law_state_of(block%y, start%normal), load_rates( &
                    abs(traction), 0.0_dp, 1.0_dp, start%normal, 0.0_dp, .false.), v, jumps)
                v = sign(v, traction)
            end if
            call hold_velocity(block, start%normal)
        end associate
    end subroutine take_off_spring

    !> The traction of a rigid contact that creeps with the block's velocity, as far as its cap lets
    !> it grow.
    pure subroutine hold_velocity(block, pressure)
        type(moving_block), intent(inout) :: block
        real(dp), intent(in) :: pressure   !! [F/L^2]
        real(dp) :: resistance, by_rate

        if (.not. (block%equations%rigid .and. block%equations%creeps_along())) return
        associate (eq => block%equations)
            call eq%surface%resistance_at(eq%law_state_of(block%y, pressure), &
                abs(block%y(velocity)), pressure, resistance, by_rate)
            if (resistance >= eq%surface%tau_max) eq%phase = phase_capped
            eq%sense = eq%sense_of(block%y(velocity))
            block%y(elastic) = eq%sense * min(resistance, eq%surface%tau_max) / eq%alpha
        end associate
    end subroutine hold_velocity

    !> Does a block on a rigid contact that creeps stop or start? It is so slow only then for less
    !> than time can tell: friction falls to what balances the drive spring, or changes its side, at
    !> once. On that side the block is some times faster, or as short steps would be asked for
    !> again, and so it is at a start, up to the balance.
    function stopped(block, t, time_lost) result(yes)
        type(moving_block), intent(inout) :: block
        real(dp), intent(in) :: t           !! [T]
        real(dp), intent(in) :: time_lost   !! in round-off [T]
        logical :: yes
        real(dp), parameter :: faster = 16.0_dp, round_off = 4.0_dp * epsilon(1.0_dp)
        real(dp) :: pull, carried   !! tractions in the sense of the pull [F/L^2]
        real(dp) :: v_drive, pressure, pressure_rate, traction, by_rate, balanced
        type(law_state) :: state
        logical :: jumps

        associate (eq => block%equations, y => block%y, slip_rate => block%first(slip))
            pull = abs(eq%pull(y)) / eq%area
            carried = sign(1.0_dp, eq%pull(y)) * eq%alpha * y(elastic)
            yes = eq%follows_traction() .and. abs(pull - carried) > round_off * pull
            if (.not. yes) return
            traction = pull
            if (carried < pull) then
                call eq%inputs(t, y, v_drive, pressure, pressure_rate)
                state = eq%law_state_of(y, pressure)
                call eq%surface%resistance_at(state, faster * slip_rate, pressure, traction, &
                    by_rate)
                traction = min(traction, pull)
                if (carried >= 0.0_dp) then
                    call eq%surface%slip_rate(state, load_rates(traction, 0.0_dp, 1.0_dp, &
                        pressure, 0.0_dp, .false.), balanced, jumps)
                    yes = eq%mass * (balanced - slip_rate) < eq%area * (pull - carried) * time_lost
                    if (.not. yes) return
                end if
            end if
            y(elastic) = sign(traction, eq%pull(y)) / eq%alpha
            block%known = .false.
        end associate
    end function stopped

    !> Takes the block to the normal traction that holds from now on.
    subroutine take_load(block, system, pressure, open_below, time_lost, state, touches)
        type(moving_block), intent(inout) :: block
        type(slider), intent(in) :: system
        real(dp), intent(in) :: pressure              !! [F/L^2]
        real(dp), intent(in) :: open_below            !! pressure that counts as none [F/L^2]
        real(dp), intent(in) :: time_lost             !! in round-off [T]
        type(slider_state), intent(inout) :: state
        logical, intent(out) :: touches   !! a subloading surface: its R leaves 0, where the law
                                          !! knows no slip, steeply
        logical :: closed

        touches = .false.
        closed = pressure > open_below
        associate (eq => block%equations)
            if (closed .and. eq%phase /= phase_open) then
                if (eq%across%free()) return   ! it comes with the motion
                if (abs(pressure - state%normal) <= 1.0e-14_dp * pressure) return
                call jump_to(block, system, pressure, time_lost, state)
            else if (closed) then
                eq%phase = phase_at_rest(eq)
                touches = eq%phase == phase_slide .and. eq%surface%traits%memory == 1
                call open_or_touch(block, pressure, touches)
            else if (eq%phase /= phase_open) then
                eq%phase = phase_open
                call open_or_touch(block, pressure, touches)
            end if
        end associate
    end subroutine take_load

    !> A normal traction that jumps on a closed contact.
    subroutine jump_to(block, system, pressure, time_lost, state)
        type(moving_block), intent(inout) :: block
        type(slider), intent(in) :: system
        real(dp), intent(in) :: pressure    !! after it [F/L^2]
        real(dp), intent(in) :: time_lost   !! in round-off [T]
        type(slider_state), intent(inout) :: state
        real(dp) :: carried(size(state%friction))   ! [F]
        logical :: taken

        carried = state%friction
        associate (eq => block%equations)
            call press(block, max(state%normal, eq%least_pressure), max(pressure, &
                eq%least_pressure), time_lost)
            if (eq%follows_share()) call slide_on(block, state%normal)
            call load_springs(eq, system, pressure, state, taken)
            block%known = .false.
            if (eq%damper > 0.0_dp) return
            if (eq%phase == phase_capped) eq%phase = phase_slide
            if (eq%rigid) then
                state%friction = carried   ! it has no spring to tell
                call hold_velocity(block, pressure)
                return
            end if
            eq%phase = phase_at_rest(eq)
            if (taken) then
                call block%synchronise(state)
            else if (eq%surface%traits%stiff) then
                call creep_at_once(block, state%time, time_lost)
            end if
        end associate
    end subroutine jump_to

    !> The springs under a normal traction that jumps. A block without mass and damper goes along:
    !> to friction its drive spring and its contact spring are one then.
    subroutine load_springs(eq, system, pressure, state, taken)
        type(slider_equations), intent(in) :: eq
        type(slider), intent(in) :: system
        real(dp), intent(in) :: pressure   !! [F/L^2]
        type(slider_state), intent(inout) :: state
        logical, intent(out) :: taken      !! or else left to the rates
        type(slider) :: springs
        real(dp) :: part   !! of the contact spring's stiffness that both have [-]

        part = 1.0_dp
        if (eq%springs_alone() .and. .not. eq%rigid) then
            part = eq%stiffness / (eq%stiffness + eq%area * eq%alpha)
        end if
        springs = system
        springs%props(prop_alpha_t) = part * springs%props(prop_alpha_t)
        if (allocated(springs%constants)) springs%constants(1, prop_alpha_t) = part &
            * springs%constants(1, prop_alpha_t)
        state%statev(1, statev_u_et) = state%statev(1, statev_u_et) / part
        if (eq%surface%traits%memory == 1 .and. pressure < state%normal) then
            call relieve(springs, pressure, state, taken)
        else
            call apply_normal_traction(springs, pressure, state, taken)
        end if
        state%statev(1, statev_u_et) = part * state%statev(1, statev_u_et)
        if (.not. (taken .and. part < 1.0_dp)) return
        state%spring = state%friction
        state%x = state%drive - state%spring / eq%stiffness
    end subroutine load_springs

    !> A normal traction that falls at once on a surface which slides meanwhile: what the update
    !> tends to in ever smaller parts of the fall, extrapolated (Richardson) from 1, 2, 4, ... of
    !> them, because in one part it is of first order in the slip.
    subroutine relieve(springs, pressure, state, taken)
        type(slider), intent(in) :: springs
        real(dp), intent(in) :: pressure   !! afterwards [F/L^2]
        type(slider_state), intent(inout) :: state
        logical, intent(out) :: taken
        integer, parameter :: most_halvings = 12
        real(dp), parameter :: close = 1.0e-13_dp   !! of the displacements
        type(slider_state) :: start, fallen
        real(dp) :: old(statev_size), new(statev_size), guess(statev_size, 0:most_halvings)
        real(dp), allocatable :: props(:)
        integer :: halvings, i

        start = state
        old = 0.0_dp
        do halvings = 0, most_halvings
            fallen = start
            do i = 1, 2**halvings
                call apply_normal_traction(springs, start%normal + (pressure - start%normal) &
                    * (real(i, dp) / 2**halvings), fallen, taken)
                if (.not. taken) return
            end do
            new = fallen%statev(1, :)
            do i = 0, halvings - 1   ! Neville's scheme for an error in powers of the part
                associate (coarser => guess(:, i))
                    old = coarser
                    coarser = new
                    new = new + (new - old) / (2.0_dp**(i + 1) - 1.0_dp)
                end associate
            end do
            guess(:, halvings) = new
            if (halvings > 0 .and. abs(new(statev_u_et) - old(statev_u_et)) <= close &
                * abs(start%statev(1, statev_u_et))) exit
        end do
        state = fallen
        state%statev(1, :) = new
        state%statev(1, [statev_status, statev_u_n]) = fallen%statev(1, [statev_status, statev_u_n])
        props = springs%props_of(1)
        state%friction = springs%area * props(prop_alpha_t) * new(statev_u_et)
        call set_accelerations(springs, state)
    end subroutine relieve

    !> A contact that is in its new phase carries nothing at first.
    subroutine open_or_touch(block, pressure, touches)
        type(moving_block), intent(inout) :: block
        real(dp), intent(in) :: pressure   !! [F/L^2]
        logical, intent(in) :: touches     !! as a subloading surface
        real(dp), parameter :: first_ratio = 1.0e-12_dp   !! R as surfaces meet

        associate (eq => block%equations, y => block%y)
            if (eq%rigid .and. eq%phase == phase_stick .and. abs(y(velocity)) > 0.0_dp) then
                eq%phase = phase_slide
                eq%sense = eq%sense_of(y(velocity))
            end if
            y(ratio) = 0.0_dp
            y(elastic) = 0.0_dp
            if (touches) y(elastic) = eq%sense_of(y(velocity)) * first_ratio &
                * eq%full_strength(y, pressure) / eq%alpha
            if (eq%springs_alone()) y(extension) = 0.0_dp
            call hold_velocity(block, pressure)
            block%known = .false.
        end associate
    end subroutine open_or_touch

    !> What the law remembers may depend on the pressure. What of it comes back in a time that no
    !> step can follow, comes back at once.
    subroutine press(block, before, after, time_lost)
        type(moving_block), intent(inout) :: block
        real(dp), intent(in) :: before, after   !! pressure [F/L^2]
        real(dp), intent(in) :: time_lost       !! [T]
        type(law_state) :: state, healing

        associate (eq => block%equations)
            if (.not. eq%surface%traits%logarithmic) return
            state = eq%surface%law%pressed(eq%law_state_of(block%y, before), before, after)
            if (state%r < time_lost) then
                healing = eq%surface%state_rates(state, load_rates(0.0_dp, 0.0_dp, eq%alpha, &
                    after, 0.0_dp, .false.), 0.0_dp)
                state%r = state%r + time_lost * healing%r
            end if
            block%y(memory) = log(state%r)
        end associate
    end subroutine press

    !> A creeping contact that is relieved may slip far in a time that is lost in round-off. It is
    !> followed over its slip then, in steps in which the slip rate falls by less than a half.
    subroutine creep_at_once(block, t, time_lost)
        type(moving_block), intent(inout) :: block
        real(dp), intent(in) :: t           !! [T]
        real(dp), intent(in) :: time_lost   !! in round-off [T]
        integer, parameter :: most_steps = 10000
        real(dp), parameter :: far = 1.0e-3_dp   !! part of the elastic displacement
        real(dp) :: ahead(unknowns), part, time_left, passes
        logical :: failed
        integer :: i

        time_left = time_lost
        call block%equations%rates(t, block%y, block%first, failed)
        if (failed .or. block%first(slip) * time_left < far * abs(block%y(elastic))) return
        part = far * abs(block%y(elastic))
        do i = 1, most_steps
            call creep(block, t, part, ahead, passes, failed)
            if (failed) then
                part = 0.5_dp * part
                cycle
            end if
            block%y = ahead
            time_left = time_left - passes
            if (time_left <= 0.0_dp) exit
            part = min(1.2_dp * part, 0.5_dp * abs(block%y(elastic)))   ! not to the other side
        end do
        block%known = .false.
    end subroutine creep_at_once

    !> A step over a slip, by Runge and Kutta's method, and the time that passes in it.
    subroutine creep(block, t, distance, ahead, passes, failed)
        type(moving_block), intent(in) :: block
        real(dp), intent(in) :: t          !! [T]
        real(dp), intent(in) :: distance   !! of the slip [L]
        real(dp), intent(out) :: ahead(unknowns)
        real(dp), intent(out) :: passes    !! [T]; without end if the surface does not slip
        logical, intent(out) :: failed     !! the slip rate falls too far in it
        real(dp), parameter :: nodes(4) = [0.0_dp, 0.5_dp, 0.5_dp, 1.0_dp]
        real(dp), parameter :: weights(4) = [1.0_dp, 2.0_dp, 2.0_dp, 1.0_dp] / 6.0_dp
        real(dp) :: dy(unknowns), first_rate
        integer :: i

        ahead = block%y
        passes = 0.0_dp
        dy = 0.0_dp
        do i = 1, size(nodes)
            call block%equations%rates(t, block%y + nodes(i) * distance * dy, dy, failed)
            if (i == 1) first_rate = dy(slip)
            if (.not. (failed .or. first_rate > 0.0_dp)) passes = huge(passes)
            failed = failed .or. 2.0_dp * dy(slip) < first_rate
            if (failed .or. passes >= huge(passes)) return
            passes = passes + weights(i) * distance / dy(slip)
            dy = dy / dy(slip)
            ahead = ahead + weights(i) * distance * dy
        end do
    end subroutine creep

end module sudden_changes
