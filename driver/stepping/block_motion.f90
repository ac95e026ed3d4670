!> Where a block is in continuous time, and what states hold of that.
module block_motion
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use friction_mod, only : facts => law_facts, friction_facts, law_state, onset_drops, &
        onset_gradual, prop_alpha_n, prop_alpha_t, read_surface, sliding_surface, &
        statev_dissipation, statev_mu, statev_r, statev_slip, statev_status, statev_u_et, statev_u_n
    use law_facts, only : typical_strength
    use run_settings, only : settings
    use slider_rates, only : along, away, controlled, damped, dissipated, drive_work, elastic, &
        extension, memory, phase_open, phase_stick, place, ratio, slider_equations, slip, &
        unknowns, velocity
    use slider_system, only : slider_state
    implicit none
    private

    public :: fill_block, moving_block, set_growing_weights, set_up, unknowns_of

    type :: moving_block
        type(slider_equations) :: equations
        real(dp), allocatable :: props(:)       !! constants of the friction routine
        real(dp) :: y(unknowns) = 0.0_dp        !! where the block is
        real(dp) :: first(unknowns) = 0.0_dp    !! rates there
        logical :: known = .false.              !! they are up to date
    contains
        procedure :: synchronise, find_balance
    end type moving_block

contains

    !> Equations of a block with constants of its own, but for its drive, its motion across the
    !> interface and the phase of its contact, and the sizes of its unknowns.
    subroutine set_up(run, props, largest, equations, natural)
        type(settings), intent(in) :: run
        real(dp), intent(in) :: props(:)
        real(dp), intent(in) :: largest   !! normal traction [F/L^2]
        type(slider_equations), intent(inout) :: equations
        real(dp), intent(out) :: natural(controlled)
        !> By trial on the inertial case of docs/driver.md: when the next event comes is decided by
        !> what the law remembers, how many steps are taken by the contact spring.
        real(dp), parameter :: stiff_sizes(along) = [1.5_dp, 1.5_dp, 1.5_dp, 0.3_dp, 1.0_dp]
        real(dp), parameter :: margin = 256.0_dp
        real(dp), parameter :: inverse_step = 1.0e8_dp   !! of derivatives, by natural sizes
        real(dp) :: told   !! round-off of forces, as a velocity [L/T]
        type(facts) :: law
        real(dp) :: force, stiffness
        integer :: status

        associate (eq => equations)
            call read_surface(props, eq%surface, status)
            eq%mass = run%mass
            eq%stiffness = run%stiffness
            eq%damping = run%damping
            eq%area = run%area
            eq%alpha = props(prop_alpha_t)
            eq%alpha_n = props(prop_alpha_n)
            law = friction_facts(props)
            eq%damper = law%damping
            eq%rigid = run%rigid_contact
            eq%least_pressure = 1.0e-10_dp * largest
            eq%forward = run%loading_sense()
            force = run%area * typical_strength(props, largest)
            stiffness = run%stiffness
            if (.not. eq%rigid) stiffness = stiffness + run%area * eq%alpha
            natural = 1.0_dp
            natural(extension) = force / stiffness
            if (run%mass > 0.0_dp) then
                natural(velocity) = force / max(sqrt(stiffness * run%mass), run%damping)
                told = epsilon(1.0_dp) * force / max(sqrt(stiffness * run%mass), run%damping)
                eq%falling = max(falls_by(eq%surface, largest), margin * told / run%rtol)
                natural(velocity) = min(natural(velocity), inverse_step * sqrt(eq%falling * told))
            else if (run%damping > 0.0_dp) then   ! what slow drives ask for
                natural(velocity) = maxval(abs(run%drive%velocity))
                if (.not. natural(velocity) > 0.0_dp) natural(velocity) = force / eq%damping
            end if
            natural(elastic) = force / (run%area * eq%alpha)
            if (eq%surface%traits%weight * largest > 0.0_dp) natural(memory) = force &
                / (run%area * largest * eq%surface%traits%weight)
            if (eq%surface%traits%stiff) natural(:along) = natural(:along) * stiff_sizes
            if (.not. run%across%free()) return
            natural(place) = force / (run%area * eq%alpha_n)
            natural(away) = natural(place) * sqrt((run%across%stiffness + run%area * eq%alpha_n) &
                / run%across%mass)
        end associate
    end subroutine set_up

    !> Velocity by which friction falls that falls with it: without end if it does not [L/T].
    pure function falls_by(surface, pressure) result(v)
        type(sliding_surface), intent(in) :: surface
        real(dp), intent(in) :: pressure   !! [F/L^2]
        real(dp) :: v, resistance, by_rate

        v = 1.0e200_dp   ! it does not
        if (surface%traits%onset /= onset_drops) return
        call surface%resistance_at(law_state(mu=0.0_dp, r=0.0_dp), 0.0_dp, pressure, resistance, &
            by_rate)
        if (by_rate < 0.0_dp) v = min(v, resistance / (-by_rate))
    end function falls_by

    !> What the errors are compared with of unknowns that grow beyond their natural sizes: their
    !> own, but not less than the amplitude of the contact's ringing.
    pure subroutine set_growing_weights(n, rtol, natural, y, weights)
        integer, intent(in) :: n   !! unknowns that act on the others
        real(dp), intent(in) :: rtol, natural(n), y(n)
        real(dp), intent(inout) :: weights(n)   !! inverse of the tolerated errors

        weights(velocity) = 1.0_dp / (rtol * max(natural(velocity), abs(y(velocity))))
        weights(extension) = 1.0_dp / (rtol * max(natural(extension), abs(y(extension))))
        if (n > along) weights(place:away) = 1.0_dp / (rtol * max(natural(place:away), &
            abs(y(place:away))))
    end subroutine set_growing_weights

    !> Puts the block where a state has it.
    pure subroutine synchronise(self, state)
        class(moving_block), intent(inout) :: self
        type(slider_state), intent(in) :: state

        self%y = unknowns_of(self%equations, state, 1)
        self%y(drive_work) = state%drive_work
        self%y(damped) = state%damped
        self%known = .false.
    end subroutine synchronise

    !> The balance of a block without mass whose velocity is an unknown. Forces that have changed at
    !> once change the velocity; where a phase has ended within the tolerated error, its drive
    !> spring gives way.
    pure subroutine find_balance(self, tolerated)
        class(moving_block), intent(inout) :: self
        real(dp), intent(in) :: tolerated   !! error of its contact spring [L]
        real(dp), parameter :: round_off = 64.0_dp * epsilon(1.0_dp)
        real(dp) :: open, friction   !! [F]

        associate (eq => self%equations, y => self%y)
            if (.not. eq%keeps_velocity()) return
            friction = eq%area * eq%alpha * y(elastic)
            open = eq%stiffness * y(extension) - friction - eq%damping * y(velocity)
            if (abs(open) <= round_off * abs(friction)) return
            self%known = .false.
            if (abs(open) <= eq%area * eq%alpha * tolerated) then
                y(extension) = (friction + eq%damping * y(velocity)) / eq%stiffness
            else
                y(velocity) = y(velocity) + open / eq%damping
            end if
        end associate
    end subroutine find_balance

    !> The unknowns of a block as a state has them, but for what is known of all blocks together.
    pure function unknowns_of(equations, state, i) result(y)
        type(slider_equations), intent(in) :: equations
        type(slider_state), intent(in) :: state
        integer, intent(in) :: i   !! block
        real(dp) :: y(unknowns)

        y = 0.0_dp
        y(extension) = state%spring(i) / equations%stiffness
        associate (across => equations%across, u_n => state%statev(i, statev_u_n))
            if (across%free()) then
                y(extension) = y(extension) + across%tilt * (u_n - across%rest) &
                    / equations%stiffness
                y(place) = u_n
                y(away) = state%v_n
            end if
        end associate
        y(velocity) = state%v(i)
        y(elastic) = state%statev(i, statev_u_et)
        select case (equations%surface%traits%memory)
        case (1)
            y(memory) = state%statev(i, statev_mu)
            if (equations%damper > 0.0_dp) y(ratio) = state%statev(i, statev_r)
        case (2)
            y(memory) = state%statev(i, statev_r)
            if (equations%surface%traits%logarithmic) y(memory) = log(y(memory))
        case default   ! it remembers nothing
        end select
        y(slip) = state%statev(i, statev_slip)
        y(dissipated) = state%statev(i, statev_dissipation)
    end function unknowns_of

    !> What a state holds of a block, but for its u_n.
    subroutine fill_block(eq, normal, t, y, dy, i, old, new)
        type(slider_equations), intent(in) :: eq
        real(dp), intent(in) :: normal            !! traction that is prescribed [F/L^2]
        real(dp), intent(in) :: t                 !! [T]
        real(dp), intent(inout) :: y(unknowns)
        real(dp), intent(in) :: dy(unknowns)
        integer, intent(in) :: i                  !! block
        type(slider_state), intent(in) :: old
        type(slider_state), intent(inout) :: new  !! its time and drive are given
        type(law_state) :: state
        real(dp) :: pressure, traction   !! [F/L^2]

        ! what accumulates never falls, not even by round-off
        y(slip) = max(y(slip), old%statev(i, statev_slip))
        y(dissipated) = max(y(dissipated), old%statev(i, statev_dissipation))
        new%x(i) = new%drive - y(extension)
        new%spring(i) = eq%pull(y)
        pressure = merge(0.0_dp, max(normal, eq%least_pressure), eq%phase == phase_open)
        state = eq%law_state_of(y, pressure)
        state%r = max(state%r, 0.0_dp)   ! slip that has healed, but for its tolerated error
        new%v(i) = y(velocity)
        new%a(i) = merge(dy(velocity), 0.0_dp, eq%mass > 0.0_dp)
        traction = eq%traction(t, y)
        call let_go(eq, y, pressure, traction, new%a(i))
        new%friction(i) = eq%area * traction
        new%statev(i, statev_status) = 3.0_dp
        if (eq%phase /= phase_open) new%statev(i, statev_status) = merge(2.0_dp, 1.0_dp, &
            dy(slip) > 0.0_dp)
        new%statev(i, statev_u_et) = merge(0.0_dp, y(elastic), eq%rigid)
        new%statev(i, statev_r) = state%r
        new%statev(i, statev_mu) = coefficient(eq, state, pressure, abs(traction), dy(slip))
        new%statev(i, statev_slip) = y(slip)
        new%statev(i, statev_dissipation) = y(dissipated)
    end subroutine fill_block

    !> A block without contact spring that has come to rest under more than it can hold slides back
    !> at once, from the next step on.
    pure subroutine let_go(eq, y, pressure, traction, acceleration)
        type(slider_equations), intent(in) :: eq
        real(dp), intent(in) :: y(unknowns)
        real(dp), intent(in) :: pressure          !! [F/L^2]
        real(dp), intent(inout) :: traction       !! that holds it [F/L^2]
        real(dp), intent(inout) :: acceleration   !! [L/T^2]
        real(dp) :: held

        if (.not. eq%rigid .or. eq%phase /= phase_stick) return
        held = sign(min(abs(traction), eq%strength(y, pressure), eq%surface%tau_max), traction)
        if (eq%mass > 0.0_dp) acceleration = acceleration + eq%area * (traction - held) / eq%mass
        traction = held
    end subroutine let_go

    !> Friction coefficient as `friction_update` has it: of a surface that sticks or is open that at
    !> rest, of one that creeps what it carries, under a cap what it would carry without.
    pure function coefficient(eq, state, pressure, traction, slip_rate) result(mu)
        type(slider_equations), intent(in) :: eq
        type(law_state), intent(in) :: state
        real(dp), intent(in) :: pressure    !! [F/L^2]
        real(dp), intent(in) :: traction    !! [F/L^2]
        real(dp), intent(in) :: slip_rate   !! [L/T]
        real(dp) :: mu, resistance, by_rate, some
        logical :: carried
        real(dp), parameter :: below_cap = 1.0_dp - 1.0e-9_dp   !! round-off of steps aside

        mu = state%mu
        if (eq%surface%traits%memory == 1) return
        ! friction that drops follows the block's velocity on a bare contact spring
        carried = eq%surface%traits%onset == onset_gradual .or. eq%surface%traits%onset &
            == onset_drops .and. slip_rate > 0.0_dp
        carried = carried .and. traction < below_cap * eq%surface%tau_max
        if (carried) then
            mu = 0.0_dp
            if (pressure > 0.0_dp) mu = max(0.0_dp, traction - eq%surface%cohesion) / pressure
        else   ! under any pressure
            some = max(pressure, eq%least_pressure, eq%surface%cohesion)
            call eq%surface%resistance_at(state, max(0.0_dp, slip_rate), some, resistance, by_rate)
            mu = max(0.0_dp, resistance - eq%surface%cohesion) / some
        end if
    end function coefficient

end module block_motion
