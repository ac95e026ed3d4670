!> Adaptive steps of one block in continuous time: the rate equations of module `slider_rates` by
!> Dormand and Prince's method where they are not stiff, by Rodas4 where they are. Both take each
!> step from the state alone, so that a run goes on from a checkpoint as if it had never stopped.
!>
!> Steps end where a phase of the contact ends, found by taking them again until they do.
module continuous_steps
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use abstract_integrator, only : integrator, step_report, unstable_without_inertia
    use archive_file, only : archive
    use dormand_prince, only : dormand_prince_step
    use friction_mod, only : facts => law_facts, friction_facts, friction_message, &
        friction_no_convergence, friction_no_rate, friction_update, law_state, load_rates, &
        onset_drops, onset_gradual, onset_yields, prop_alpha_n, prop_alpha_t, read_surface, &
        statev_dissipation, statev_mu, statev_r, statev_size, statev_slip, statev_status, &
        statev_u_et, statev_u_n
    use law_facts, only : typical_strength
    use rosenbrock, only : rosenbrock_step
    use run_settings, only : settings
    use slider_rates, only : controlled, damped, dissipated, drive_work, elastic, extension, &
        memory, phase_capped, phase_open, phase_slide, phase_stick, ratio, slider_equations, slip, &
        switches, unknowns, velocity
    use slider_system, only : apply_normal_traction, slider, slider_state
    use step_ends, only : end_of_step, find_opening, next_limit, why_too_short
    implicit none
    private

    public :: continuous, fill_block, set_up, unknowns_of

    integer, parameter, public :: implicit_rates = 11   !! evaluations of a block's in a step
    !> Part of the time that no step is shorter than.
    real(dp), parameter :: shortest = 4.0_dp * epsilon(1.0_dp)

    type, extends(integrator) :: continuous
        type(slider_equations) :: equations
        real(dp) :: y(unknowns) = 0.0_dp        !! where the block is
        real(dp) :: first(unknowns) = 0.0_dp    !! rates there
        logical :: known = .false.              !! they are up to date
        real(dp) :: limit = 0.0_dp   !! where the step ends at the latest [T]
        real(dp) :: rtol = 0.0_dp
        real(dp) :: natural(controlled) = 0.0_dp    !! sizes of the unknowns
        real(dp) :: weights(controlled) = 0.0_dp    !! inverse of the errors tolerated in a step
        logical :: implicit = .false.           !! steps by Rodas4
        integer :: stiff = 0, calm = 0          !! steps in favour of the other method
        logical :: jumped = .false.             !! slip had no rate in the last attempt
        real(dp) :: open_below = 0.0_dp         !! normal traction that counts as none [F/L^2]
    contains
        procedure :: prepare, step, visit, why_stopped
        procedure, private :: take_pressure, settle, attempt, locate, switch, jump, choose_method, &
            set_weights, fill
    end type continuous

    !> A step that has been tried.
    type :: trial
        real(dp) :: h                !! [T]
        real(dp) :: y(unknowns)      !! its end
        real(dp) :: last(unknowns)   !! rates there
        real(dp) :: error            !! part of the tolerated one
        real(dp) :: stiffness        !! h times the size of the equations' derivative
        integer :: switch            !! which way its phase has ended; 0: it has not
    end type trial

contains

    subroutine prepare(self, run, system, start)
        class(continuous), intent(inout) :: self
        type(settings), intent(in) :: run
        type(slider), intent(in) :: system
        type(slider_state), intent(in) :: start
        real(dp) :: largest   !! normal traction [F/L^2]

        call self%take_run(run, system, start)
        self%in_rates = .true.
        if (run%drive%amplitude > 0.0_dp) self%dt_max = min(run%dt_max, 1.0_dp &
            / (16.0_dp * run%drive%frequency))
        self%rtol = run%rtol
        largest = run%drive%largest_normal()
        associate (eq => self%equations)
            call set_up(run, run%props, largest, eq, self%natural)
            eq%drive = run%drive
            self%implicit = eq%surface%traits%stiff
            self%open_below = largest * vanishing(self)
            if (max(eq%surface%cohesion, eq%surface%law%cohesion) > 0.0_dp) then
                ! closed without pressure
                eq%least_pressure = max(eq%least_pressure, self%open_below)
                self%open_below = -tiny(largest)
            end if
            self%weights = 1.0_dp / (self%rtol * self%natural)
            call synchronise(self, start)
            eq%phase = merge(phase_slide, phase_stick, eq%surface%traits%onset == onset_gradual &
                .or. eq%damper > 0.0_dp)
            if (start%normal <= min(0.0_dp, self%open_below)) eq%phase = phase_open
            eq%sense = eq%sense_of(self%y(elastic))
            if (eq%rigid) call take_off_spring(self, start)
        end associate
    end subroutine prepare

    !> Equations of a block with constants of its own, but for its drive and the phase of its
    !> contact, and the sizes of its unknowns.
    subroutine set_up(run, props, largest, equations, natural)
        type(settings), intent(in) :: run
        real(dp), intent(in) :: props(:)
        real(dp), intent(in) :: largest   !! normal traction [F/L^2]
        type(slider_equations), intent(inout) :: equations
        real(dp), intent(out) :: natural(controlled)
        !> By trial on the inertial case of docs/driver.md: when the next event comes is decided by
        !> what the law remembers, how many steps are taken by the contact spring.
        real(dp), parameter :: stiff_sizes(controlled) = [1.5_dp, 1.5_dp, 1.5_dp, 0.3_dp, 1.0_dp]
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
            if (run%mass > 0.0_dp) natural(velocity) = force / sqrt(stiffness * run%mass)
            natural(elastic) = force / (run%area * eq%alpha)
            if (eq%surface%traits%weight * largest > 0.0_dp) natural(memory) = force &
                / (run%area * largest * eq%surface%traits%weight)
            if (eq%surface%traits%stiff) natural = natural * stiff_sizes
        end associate
    end subroutine set_up

    !> Part of the largest normal traction below which a contact under a varying one counts as open:
    !> what is left out is an impulse, and of the order of the square. As the normal traction
    !> vanishes, the slip rates of rate-and-state friction have no bound, and the R of the
    !> subloading law, traction over strength, is lost in its round-off.
    pure function vanishing(self) result(part)
        class(continuous), intent(in) :: self
        real(dp) :: part

        part = 0.0_dp
        if (self%equations%surface%traits%stiff) then
            part = 1.0e-2_dp * sqrt(self%rtol)
        else if (self%equations%surface%traits%memory == 1) then
            part = max(1.0e-6_dp, 16.0_dp * epsilon(part) / self%rtol)
        end if
    end function vanishing

    !> Normal traction below which the contact is open now [F/L^2]: one that does not vary is taken
    !> as it is.
    pure function open_level(self) result(pressure)
        class(continuous), intent(in) :: self
        real(dp) :: pressure

        pressure = self%open_below
        if (self%equations%steady) pressure = min(0.0_dp, pressure)
    end function open_level

    !> A rigid contact carries what the block's velocity, or without one the friction at the start,
    !> asks for.
    subroutine take_off_spring(self, start)
        class(continuous), intent(inout) :: self
        type(slider_state), intent(in) :: start

        associate (eq => self%equations)
            eq%sense = eq%sense_of(start%v(1))
            if (abs(start%v(1)) > 0.0_dp .and. eq%phase == phase_stick) eq%phase = phase_slide
            self%y(elastic) = 0.0_dp
            if (.not. abs(start%v(1)) > 0.0_dp) self%y(velocity) = velocity_under(self, &
                start%friction(1) / eq%area, start%normal)
            call hold_velocity(self, start%normal)
        end associate
    end subroutine take_off_spring

    !> Slip rate of a rigid contact that creeps under a traction [L/T]; 0 for others.
    pure function velocity_under(self, traction, pressure) result(v)
        class(continuous), intent(in) :: self
        real(dp), intent(in) :: traction, pressure   !! [F/L^2]
        real(dp) :: v
        logical :: jumps

        v = 0.0_dp
        if (.not. self%equations%follows_traction()) return
        associate (eq => self%equations)
            call eq%surface%slip_rate(eq%law_state_of(self%y, pressure), &
                load_rates(abs(traction), 0.0_dp, 1.0_dp, pressure, 0.0_dp, .false.), v, jumps)
        end associate
        v = sign(v, traction)
    end function velocity_under

    !> The traction of a rigid contact that creeps with the block's velocity, as far as its cap lets
    !> it grow.
    pure subroutine hold_velocity(self, pressure)
        class(continuous), intent(inout) :: self
        real(dp), intent(in) :: pressure   !! [F/L^2]
        real(dp) :: resistance, by_rate

        if (.not. self%equations%follows_traction()) return
        associate (eq => self%equations)
            call eq%surface%resistance_at(eq%law_state_of(self%y, pressure), &
                abs(self%y(velocity)), pressure, resistance, by_rate)
            if (resistance >= eq%surface%tau_max) eq%phase = phase_capped
            eq%sense = eq%sense_of(self%y(velocity))
            self%y(elastic) = eq%sense * min(resistance, eq%surface%tau_max) / eq%alpha
        end associate
    end subroutine hold_velocity

    pure subroutine synchronise(self, state)
        class(continuous), intent(inout) :: self
        type(slider_state), intent(in) :: state

        self%y = unknowns_of(self%equations, self%system, state, 1)
        self%y(drive_work) = state%drive_work
        self%y(damped) = state%damped
        self%known = .false.
    end subroutine synchronise

    !> The unknowns of a block as a state has them, but for what is known of all blocks together.
    pure function unknowns_of(equations, system, state, i) result(y)
        type(slider_equations), intent(in) :: equations
        type(slider), intent(in) :: system
        type(slider_state), intent(in) :: state
        integer, intent(in) :: i   !! block
        real(dp) :: y(unknowns)

        y = 0.0_dp
        y(extension) = state%spring(i) / system%stiffness
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

    subroutine step(self, old, new, report)
        class(continuous), intent(inout) :: self
        type(slider_state), intent(inout) :: old
        type(slider_state), intent(inout) :: new
        type(step_report), intent(out) :: report
        type(trial) :: tried, whole
        real(dp) :: end, wanted, before, opening
        integer :: piece
        logical :: again

        piece = self%drive%piece(old%time)
        if (piece /= self%equations%piece) then
            call self%equations%enter(piece)
            self%known = .false.
        end if
        call self%take_pressure(old, piece)
        if (old%time >= self%limit) self%limit = next_limit(self%drive, self%every, self%t_end, &
            4.0_dp * shortest, old%time)
        call self%settle(old%time)
        again = .false.
        do
            wanted = min(self%dt, self%dt_max)
            end = end_of_step(old%time, wanted, self%limit)
            if (.not. self%equations%steady) then
                call find_opening(self%drive, piece, self%open_below, self%equations%phase &
                    == phase_open, old%time, end, before, opening)
                end = min(end, opening)
            end if
            tried%h = end - old%time
            call self%attempt(old%time, tried)
            whole = tried
            if (tried%error <= 1.0_dp) call self%locate(old%time, tried)
            if (tried%error <= 1.0_dp) exit
            self%rejected = self%rejected + 1
            again = .true.
            self%dt = tried%h * max(0.2_dp, 0.9_dp * tried%error**(-1.0_dp / order_of(self)))
            if (.not. self%dt > max(self%dt_min, shortest * old%time)) then
                if (stopped(self)) then
                    call self%settle(old%time)
                    self%dt = 1.0e3_dp * shortest * old%time
                    cycle
                end if
                report%status = merge(friction_no_rate, friction_no_convergence, jumps(self, &
                    old%time))
                return
            end if
        end do
        self%dt = whole%h * min(merge(1.0_dp, 5.0_dp, again), 0.9_dp * max(whole%error, &
            1.0e-10_dp)**(-1.0_dp / order_of(self)))
        if (whole%h < 0.99_dp * wanted) self%dt = max(self%dt, wanted)   ! the limit has cut it
        if (tried%switch > 0) end = old%time + tried%h
        call self%choose_method(tried)
        self%y = tried%y
        self%first = tried%last
        if (self%equations%follows_traction()) self%y(velocity) = self%equations%sense_of( &
            self%y(elastic)) * self%first(slip)   ! velocities of less than round-off of the drive's
        self%known = self%equations%steady .and. .not. self%implicit .and. tried%switch == 0
        if (tried%switch > 0) call self%switch(end, tried%switch)
        call self%fill(end, piece, old, new)
    end subroutine step

    !> Has slip no rate any more, or one that leaves its block far behind?
    pure function jumps(self, t) result(yes)
        class(continuous), intent(in) :: self
        real(dp), intent(in) :: t   !! [T]
        logical :: yes

        yes = self%jumped
        if (self%known) yes = yes .or. self%equations%runs_away(t, self%first, &
            maxval(abs(self%drive%velocity)))
    end function jumps

    !> Does a block on a rigid contact that creeps stop? It is so slow only then for less than time
    !> can tell: friction falls to what balances the drive spring, or changes its side, at once.
    function stopped(self) result(yes)
        class(continuous), intent(inout) :: self
        logical :: yes
        real(dp) :: pull   !! as a traction [F/L^2]

        associate (eq => self%equations, y => self%y)
            pull = eq%stiffness * y(extension) / eq%area
            yes = eq%follows_traction() .and. sign(pull, pull * y(elastic)) &
                < eq%alpha * abs(y(elastic))
            if (.not. yes) return
            y(elastic) = -y(elastic)
            if (abs(pull) < eq%alpha * abs(y(elastic))) y(elastic) = pull / eq%alpha
            self%known = .false.
        end associate
    end function stopped

    !> Order of the estimate of the error.
    pure function order_of(self) result(order)
        class(continuous), intent(in) :: self
        real(dp) :: order

        order = merge(4.0_dp, 5.0_dp, self%implicit)
    end function order_of

    !> Sudden changes of the normal traction, opening and touchdown.
    subroutine take_pressure(self, state, piece)
        class(continuous), intent(inout) :: self
        type(slider_state), intent(inout) :: state
        integer, intent(in) :: piece
        real(dp), parameter :: first_ratio = 1.0e-12_dp   !! R as surfaces meet
        real(dp) :: pressure
        logical :: taken

        pressure = self%drive%normal_traction(state%time, piece)
        associate (eq => self%equations)
            if (pressure > open_level(self) .and. eq%phase /= phase_open) then
                if (abs(pressure - state%normal) <= 1.0e-14_dp * pressure) return
                call press(self, state%normal, pressure, lost(self, state%time))
                if (eq%follows_share()) call slide_on(self, state%normal)
                call apply_normal_traction(self%system, pressure, state, taken)
                self%known = .false.
                if (eq%damper > 0.0_dp) return
                if (eq%rigid) then
                    if (eq%phase == phase_capped) eq%phase = phase_slide
                    call hold_velocity(self, pressure)
                    return
                end if
                if (eq%surface%traits%onset /= onset_gradual) eq%phase = phase_stick
                if (eq%phase == phase_capped) eq%phase = phase_slide
                if (taken) then
                    call synchronise(self, state)
                else if (eq%surface%traits%stiff) then
                    call creep_at_once(self, state%time)
                end if
            else if (pressure > open_level(self) .eqv. eq%phase == phase_open) then
                eq%phase = phase_open
                if (pressure > open_level(self)) eq%phase = merge(phase_slide, phase_stick, &
                    eq%surface%traits%onset == onset_gradual .or. eq%damper > 0.0_dp)
                if (eq%rigid .and. eq%phase == phase_stick .and. abs(self%y(velocity)) &
                    > 0.0_dp) then
                    eq%phase = phase_slide
                    eq%sense = eq%sense_of(self%y(velocity))
                end if
                self%y(ratio) = 0.0_dp
                self%y(elastic) = 0.0_dp
                if (eq%phase == phase_slide .and. eq%surface%traits%memory == 1) then
                    ! R leaves 0, where the law knows no slip, at once, and so steeply that Rodas4's
                    ! differences for derivatives tell nothing
                    self%y(elastic) = eq%sense_of(self%y(velocity)) * first_ratio &
                        * eq%full_strength(self%y, pressure) / eq%alpha
                    self%implicit = .false.
                    self%stiff = 0
                end if
                if (.not. (eq%mass > 0.0_dp .or. eq%damping > 0.0_dp)) self%y(extension) = 0.0_dp
                call hold_velocity(self, pressure)
                self%known = .false.
            end if
        end associate
    end subroutine take_pressure

    !> A subloading surface beside a damper keeps its R when the pressure jumps, unless it sticks.
    pure subroutine slide_on(self, pressure)
        class(continuous), intent(inout) :: self
        real(dp), intent(in) :: pressure   !! before the jump, or now [F/L^2]
        type(law_state) :: state

        state = self%equations%law_state_of(self%y, pressure)
        self%y(ratio) = state%r
        self%equations%phase = phase_slide
        self%known = .false.
    end subroutine slide_on

    !> What the law remembers may depend on the pressure. What of it comes back in a time that no
    !> step can follow, comes back at once.
    subroutine press(self, before, after, time_lost)
        class(continuous), intent(inout) :: self
        real(dp), intent(in) :: before, after   !! pressure [F/L^2]
        real(dp), intent(in) :: time_lost       !! [T]
        type(law_state) :: state, healing

        associate (eq => self%equations)
            if (.not. eq%surface%traits%logarithmic) return
            state = eq%surface%law%pressed(eq%law_state_of(self%y, before), before, after)
            if (state%r < time_lost) then
                healing = eq%surface%state_rates(state, load_rates(0.0_dp, 0.0_dp, eq%alpha, &
                    after, 0.0_dp, .false.), 0.0_dp)
                state%r = state%r + time_lost * healing%r
            end if
            self%y(memory) = log(state%r)
        end associate
    end subroutine press

    !> A time that is lost in round-off, but for the steps that it takes to follow a decay which
    !> has gone on for as long [T].
    pure function lost(self, t) result(dt)
        class(continuous), intent(in) :: self
        real(dp), intent(in) :: t   !! [T]
        real(dp) :: dt
        real(dp), parameter :: steps = 256.0_dp

        dt = steps * shortest * max(t, self%dt_min)
    end function lost

    !> A creeping contact that is relieved may slip far in a time that is lost in round-off. It is
    !> followed over its slip then, in steps in which the slip rate falls by less than a half.
    subroutine creep_at_once(self, t)
        class(continuous), intent(inout) :: self
        real(dp), intent(in) :: t   !! [T]
        integer, parameter :: most_steps = 10000
        real(dp), parameter :: far = 1.0e-3_dp   !! part of the elastic displacement
        real(dp) :: ahead(unknowns), part, time_left, passes
        logical :: failed
        integer :: i

        time_left = lost(self, t)
        call self%equations%rates(t, self%y, self%first, failed)
        if (failed .or. self%first(slip) * time_left < far * abs(self%y(elastic))) return
        part = far * abs(self%y(elastic))
        do i = 1, most_steps
            call creep(self, t, part, ahead, passes, failed)
            if (failed) then
                part = 0.5_dp * part
                cycle
            end if
            self%y = ahead
            time_left = time_left - passes
            if (time_left <= 0.0_dp) exit
            part = 1.2_dp * part
        end do
        self%known = .false.
    end subroutine creep_at_once

    !> A step over a slip, by Runge and Kutta's method, and the time that passes in it.
    subroutine creep(self, t, distance, ahead, passes, failed)
        class(continuous), intent(in) :: self
        real(dp), intent(in) :: t          !! [T]
        real(dp), intent(in) :: distance   !! of the slip [L]
        real(dp), intent(out) :: ahead(unknowns)
        real(dp), intent(out) :: passes    !! [T]
        logical, intent(out) :: failed     !! the slip rate falls too far in it
        real(dp), parameter :: nodes(4) = [0.0_dp, 0.5_dp, 0.5_dp, 1.0_dp]
        real(dp), parameter :: weights(4) = [1.0_dp, 2.0_dp, 2.0_dp, 1.0_dp] / 6.0_dp
        real(dp) :: dy(unknowns), first_rate
        integer :: i

        ahead = self%y
        passes = 0.0_dp
        dy = 0.0_dp
        do i = 1, size(nodes)
            call self%equations%rates(t, self%y + nodes(i) * distance * dy, dy, failed)
            if (i == 1) first_rate = dy(slip)
            failed = failed .or. 2.0_dp * dy(slip) < first_rate
            if (failed) return
            passes = passes + weights(i) * distance / dy(slip)
            dy = dy / dy(slip)
            ahead = ahead + weights(i) * distance * dy
        end do
    end subroutine creep

    !> Slip without time, as far as the friction routine lets the contact slip, if that is far.
    subroutine slip_at_once(self, pressure, before)
        class(continuous), intent(inout) :: self
        real(dp), intent(in) :: pressure   !! [F/L^2]
        real(dp), intent(in) :: before     !! elastic displacement, in the sense of the slip [L]
        real(dp), parameter :: push = 1.0e-12_dp, far = 1.0e-6_dp   !! parts of that
        real(dp) :: statev(statev_size), traction(2), tangent(2, 2)
        integer :: status

        associate (eq => self%equations, y => self%y)
            statev = 0.0_dp
            statev(statev_status) = 1.0_dp
            statev(statev_u_n) = -pressure / self%system%props(prop_alpha_n)
            statev(statev_u_et) = before
            statev(statev_r) = y(memory)
            call friction_update([0.0_dp, push * before], 0.0_dp, self%system%props, statev, &
                traction, tangent, status)
            if (status < 0 .or. statev(statev_slip) < far * before) return
            y(slip) = y(slip) + statev(statev_slip)
            y(dissipated) = y(dissipated) + 0.5_dp * eq%alpha * (before**2 &
                - statev(statev_u_et)**2)
            y(elastic) = sign(statev(statev_u_et), y(elastic))
            y(memory) = statev(statev_r)
        end associate
    end subroutine slip_at_once

    !> Rates at the start of a step, in the phase that holds there.
    subroutine settle(self, t)
        class(continuous), intent(inout) :: self
        real(dp), intent(in) :: t   !! [T]
        integer, parameter :: most_switches = 6
        real(dp), parameter :: round_off = 1.0e-12_dp
        real(dp) :: g(switches), v_drive, pressure, pressure_rate
        logical :: failed, slides
        integer :: i

        associate (eq => self%equations)
            do i = 1, most_switches
                if (.not. self%known) call eq%rates(t, self%y, self%first, failed)
                if (.not. self%known .and. .not. failed) self%known = .true.
                if (eq%phase == phase_open) return
                g = eq%switch_values(t, self%y, self%first)
                if (eq%phase == phase_stick .and. .not. eq%damper > 0.0_dp) then
                    call eq%inputs(t, v_drive, pressure, pressure_rate)
                    if (g(1) < -round_off * eq%strength(self%y, pressure)) return
                    slides = would_slide(self, pressure, pressure_rate)
                    if (.not. (slides .and. (g(1) > 0.0_dp .or. .not. eq%rigid))) return
                    call self%switch(t, 1)
                else if (g(1) > 0.0_dp .or. g(2) > 0.0_dp) then
                    call self%switch(t, merge(1, 2, g(1) > 0.0_dp))
                else
                    return
                end if
            end do
        end associate
    end subroutine settle

    !> Does the traction of a contact that sticks at its strength grow faster than that?
    pure function would_slide(self, pressure, pressure_rate) result(slides)
        class(continuous), intent(in) :: self
        real(dp), intent(in) :: pressure, pressure_rate   !! [F/L^2], [F/L^2/T]
        logical :: slides
        real(dp) :: strength, growth
        type(law_state) :: healing

        slides = .true.
        if (self%equations%rigid) return
        strength = self%equations%strength(self%y, pressure)
        growth = 0.0_dp
        if (strength < self%equations%surface%tau_max) then
            healing = self%equations%surface%state_rates(self%equations%law_state_of(self%y, &
                pressure), load_rates(strength, 0.0_dp, self%equations%alpha, pressure, &
                pressure_rate, .false.), 0.0_dp)
            growth = (strength - self%equations%surface%cohesion) / pressure * pressure_rate &
                + healing%mu * pressure
        end if
        slides = self%equations%alpha * self%equations%sense_of(self%y(elastic)) &
            * self%first(elastic) > growth
    end function would_slide

    !> Takes a step by the method in use.
    subroutine attempt(self, t, tried)
        class(continuous), intent(inout) :: self
        real(dp), intent(in) :: t             !! [T]
        type(trial), intent(inout) :: tried   !! its length is given
        real(dp) :: scales(2, controlled), growth
        logical :: failed
        integer, parameter :: explicit_rates = 6   !! evaluations of them in a step

        tried%switch = 0
        tried%error = huge(tried%error)
        self%jumped = .not. self%known
        if (.not. self%known) return
        call self%set_weights(t)
        if (self%implicit) then
            scales(1, :) = self%weights
            scales(2, :) = self%natural
            call rosenbrock_step(self%equations, t, tried%h, self%y, self%first, scales, tried%y, &
                tried%error, growth)
            tried%stiffness = tried%h * growth
            if (tried%error <= 1.0_dp) then
                call self%equations%rates(t + tried%h, tried%y, tried%last, failed)
                if (failed) tried%error = huge(tried%error)
                if (wild(self, tried)) tried%error = max(tried%error, 2.0_dp**4)
                if (.not. self%system%mass > 0.0_dp) call damp(self, t, tried)
                if (self%equations%follows_traction() .and. .not. failed) call balance(self, t, &
                    tried)
            end if
        else
            call dormand_prince_step(self%equations, t, tried%h, self%y, self%first, &
                self%weights, tried%y, tried%last, tried%error, tried%stiffness)
        end if
        call self%count_iterations(merge(implicit_rates, explicit_rates, self%implicit))
        self%jumped = .not. tried%error < huge(tried%error)
    end subroutine attempt

    !> The traction of a rigid contact that creeps comes to balance the faster the slower it slips.
    !> Where neither inertia nor damper has a say, it is the balance's. Else the slip rate may grow
    !> by so much only: where the traction comes to balance far more slowly at the end of a step
    !> than at its start, the estimate of the error sees nothing.
    subroutine balance(self, t, tried)
        class(continuous), intent(in) :: self
        real(dp), intent(in) :: t             !! [T]
        type(trial), intent(inout) :: tried
        real(dp), parameter :: no_say = 1.0e-8_dp   !! part
        real(dp), parameter :: most = 3.0_dp        !! logarithm of the growth
        real(dp) :: v_drive, pressure, pressure_rate, resistance, by_rate
        logical :: failed

        associate (eq => self%equations, before => self%first(slip), after => tried%last(slip))
            call eq%inputs(t + tried%h, v_drive, pressure, pressure_rate)
            call eq%surface%resistance_at(eq%law_state_of(tried%y, pressure), after, pressure, &
                resistance, by_rate)
            if (max(eq%mass, eq%damping * tried%h) < no_say * tried%h * by_rate * eq%area) then
                tried%y(elastic) = eq%stiffness * tried%y(extension) / (eq%area * eq%alpha)
                call eq%rates(t + tried%h, tried%y, tried%last, failed)
                if (failed) tried%error = huge(tried%error)
            else if (after > before) then
                tried%error = max(tried%error, (log(after / max(before, tiny(before))) / most)**4)
            end if
        end associate
    end subroutine balance

    !> Have the stages of a step been far from where it starts and ends? Then what slip dissipates
    !> over the slip is no traction of these.
    pure function wild(self, tried)
        class(continuous), intent(in) :: self
        type(trial), intent(in) :: tried
        logical :: wild
        real(dp), parameter :: far = 1.5_dp, round_off = 16.0_dp * epsilon(1.0_dp)
        real(dp) :: tractions(2), way, work, least

        associate (eq => self%equations, before => self%y, after => tried%y)
            way = after(slip) - before(slip)
            work = after(dissipated) - before(dissipated)
            tractions = eq%alpha * abs([before(elastic), after(elastic)])
            wild = .false.
            if (eq%damper > 0.0_dp .or. .not. maxval(tractions) > 0.0_dp) return
            if (way * self%weights(elastic) <= 1.0_dp .or. way <= round_off * after(slip)) return
            least = minval(tractions) * (way - round_off * after(slip))
            wild = work - round_off * after(dissipated) > far * maxval(tractions) * way .or. &
                far * (work + round_off * after(dissipated)) < least
        end associate
    end function wild

    !> What damper and slip take of a block without mass, whose velocity is a small difference of
    !> forces: within a long step of Rodas4 it is not well enough known to be squared, or multiplied
    !> by a traction that changes, its mean is.
    pure subroutine damp(self, t, tried)
        class(continuous), intent(in) :: self
        real(dp), intent(in) :: t             !! [T]
        type(trial), intent(inout) :: tried
        real(dp) :: way, v(2)

        associate (d => self%drive, i => self%equations%piece)
            way = tried%h * 0.5_dp * (d%drive_velocity(t, i) + d%drive_velocity(t + tried%h, i)) &
                - (tried%y(extension) - self%y(extension))
            v = [d%drive_velocity(t, i) - self%first(extension), &
                d%drive_velocity(t + tried%h, i) - tried%last(extension)]
        end associate
        tried%y(damped) = self%y(damped) + 0.5_dp * self%system%damping * sum(v) * way
        tried%y(dissipated) = self%y(dissipated) + 0.5_dp * abs(self%equations%traction(t, self%y) &
            + self%equations%traction(t + tried%h, tried%y)) * (tried%y(slip) - self%y(slip))
    end subroutine damp

    !> What the error of each unknown is compared with: its own size, but not less than the
    !> amplitude of the contact's ringing.
    subroutine set_weights(self, t)
        class(continuous), intent(inout) :: self
        real(dp), intent(in) :: t   !! [T]
        real(dp), parameter :: tight = 1.0e-4_dp   !! of traction over pressure, part of friction
        real(dp) :: v_drive, pressure, pressure_rate

        self%weights(velocity) = 1.0_dp / (self%rtol * max(self%natural(velocity), &
            abs(self%y(velocity))))
        self%weights(extension) = 1.0_dp / (self%rtol * max(self%natural(extension), &
            abs(self%y(extension))))
        if (self%equations%steady) return
        call self%equations%inputs(t, v_drive, pressure, pressure_rate)
        pressure = max(pressure, self%open_below, self%equations%least_pressure)
        if (self%equations%surface%traits%stiff) then
            ! what counts for slip that goes with an exponential is traction over pressure
            self%weights(elastic) = 1.0_dp / (self%natural(elastic) * min(self%rtol, tight &
                * pressure / self%drive%largest_normal()))
        else if (self%equations%surface%traits%memory == 1) then
            ! R is traction over strength, and how it grows from a touchdown on is not forgotten
            self%weights(elastic) = 1.0_dp / (self%natural(elastic) * self%rtol * min(1.0_dp, &
                max(pressure, self%equations%surface%law%cohesion) &
                / self%drive%largest_normal()))
        end if
    end subroutine set_weights

    !> Ends a step where its phase does, if it has ended. The error of a shorter step can be larger:
    !> then it is not taken.
    subroutine locate(self, t, tried)
        class(continuous), intent(inout) :: self
        real(dp), intent(in) :: t                 !! [T]
        type(trial), intent(inout) :: tried
        integer, parameter :: most_tries = 40
        real(dp), parameter :: close = 1.0e-12_dp
        type(trial) :: again
        real(dp) :: g(switches), low, high, g_low, g_high, middle, share
        integer :: i, which, side

        g = self%equations%switch_values(t + tried%h, tried%y, tried%last)
        if (self%y(memory) >= self%equations%surface%traits%kink) g(3) = -1.0_dp
        if (all(g <= 0.0_dp)) return
        which = 0
        share = 2.0_dp
        do i = 1, switches
            if (g(i) <= 0.0_dp) cycle
            middle = first_root(self, t, tried, i)
            if (middle < share) which = i
            share = min(share, middle)
        end do
        low = 0.0_dp
        high = tried%h
        g_low = -g(which)   ! the start is before the end of the phase, whatever round-off says
        g_high = g(which)
        side = 0
        again = tried
        middle = share * tried%h
        do i = 1, most_tries
            again%h = middle
            call self%attempt(t, again)
            if (.not. again%error < huge(again%error)) exit
            if (again%error > 1.0_dp) then
                tried = again
                return
            end if
            g = self%equations%switch_values(t + middle, again%y, again%last)
            if (g(which) > 0.0_dp) then
                high = middle
                g_high = g(which)
                if (side == 1) g_low = 0.5_dp * g_low
                side = 1
            else
                low = middle
                g_low = g(which)
                if (side == -1) g_high = 0.5_dp * g_high
                side = -1
            end if
            tried = again
            middle = (low * g_high - high * g_low) / (g_high - g_low)
            if (.not. (middle > low .and. middle < high)) middle = 0.5_dp * (low + high)
            if (abs(middle - again%h) <= max(close * again%h, 0.5_dp * shortest * t)) exit
        end do
        if (g(which) <= 0.0_dp) call pass(self, t, which, high, tried)
        tried%switch = which
    end subroutine locate

    !> Takes a step that ends just before its phase does again, until it ends just after: the next
    !> phase starts where this one has ended.
    subroutine pass(self, t, which, latest, tried)
        class(continuous), intent(inout) :: self
        real(dp), intent(in) :: t        !! [T]
        integer, intent(in) :: which     !! way in which the phase ends
        real(dp), intent(in) :: latest   !! length of a step that is long enough [T]
        type(trial), intent(inout) :: tried
        integer, parameter :: most_tries = 60
        type(trial) :: again
        real(dp) :: nudge, g(switches)
        integer :: i

        again = tried
        nudge = max(1.0e-12_dp * tried%h, shortest * t)
        do i = 1, most_tries
            again%h = min(latest, again%h + nudge)
            nudge = 2.0_dp * nudge
            call self%attempt(t, again)
            if (.not. again%error < huge(again%error)) return
            tried = again
            if (again%error > 1.0_dp) return
            g = self%equations%switch_values(t + again%h, again%y, again%last)
            if (g(which) > 0.0_dp .or. again%h >= latest) return
        end do
    end subroutine pass

    !> Where a switch value first becomes positive on the cubic through the ends of a step, part of
    !> the step.
    function first_root(self, t, tried, which) result(share)
        class(continuous), intent(in) :: self
        real(dp), intent(in) :: t          !! [T]
        type(trial), intent(in) :: tried
        integer, intent(in) :: which
        real(dp) :: share
        integer, parameter :: bisections = 20
        real(dp) :: low, middle, g(switches), y(unknowns), dy(unknowns), change(unknowns)
        logical :: failed
        integer :: i

        low = 0.0_dp
        share = 1.0_dp
        change = tried%y - self%y
        do i = 1, bisections
            middle = 0.5_dp * (low + share)
            y = self%y + middle * change + middle * (middle - 1.0_dp) * ((1.0_dp - 2.0_dp &
                * middle) * change + tried%h * ((middle - 1.0_dp) * self%first + middle &
                * tried%last))
            call self%equations%rates(t + middle * tried%h, y, dy, failed)
            g = self%equations%switch_values(t + middle * tried%h, y, dy)
            if (g(which) > 0.0_dp) then
                share = middle
            else
                low = middle
            end if
        end do
    end function first_root

    !> Enters the next phase.
    subroutine switch(self, t, which)
        class(continuous), intent(inout) :: self
        real(dp), intent(in) :: t   !! [T]
        integer, intent(in) :: which
        real(dp) :: v_drive, pressure, pressure_rate, strength

        self%known = .false.
        associate (eq => self%equations)
            call eq%inputs(t, v_drive, pressure, pressure_rate)
            if (eq%damper > 0.0_dp) then
                if (eq%phase == phase_slide) then
                    eq%phase = phase_stick
                else
                    call slide_on(self, pressure)
                end if
                return
            end if
            strength = min(eq%strength(self%y, pressure), eq%surface%tau_max)
            if (which == 3) then
                self%y(memory) = eq%surface%traits%kink
            else if (eq%phase == phase_stick) then
                eq%sense = eq%sense_of(eq%traction(t, self%y))
                eq%phase = phase_slide
                if (eq%surface%traits%onset == onset_yields .and. .not. strength &
                    < eq%surface%tau_max .and. .not. eq%rigid) eq%phase = phase_capped
                if (.not. eq%rigid) call self%jump(pressure, strength)
            else if (which == 1) then
                eq%phase = merge(phase_slide, phase_stick, eq%surface%traits%onset &
                    == onset_gradual)
                if (eq%rigid) self%y(velocity) = 0.0_dp
            else if (eq%phase == phase_slide) then
                eq%phase = phase_capped
                eq%sense = eq%sense_of(self%y(elastic))
                self%y(elastic) = eq%sense * eq%surface%tau_max / eq%alpha
                if (eq%surface%traits%memory == 1) self%y(ratio) = min(1.0_dp, eq%surface%tau_max &
                    / eq%full_strength(self%y, pressure))
            else
                if (eq%surface%traits%memory == 1) strength = self%y(ratio) &
                    * eq%full_strength(self%y, pressure)
                if (eq%surface%traits%memory == 1 .or. eq%surface%traits%onset &
                    == onset_yields) then
                    self%y(elastic) = sign(min(strength, eq%surface%tau_max) / eq%alpha, eq%sense)
                end if
                eq%phase = phase_slide
                if (eq%surface%traits%memory == 2 .and. eq%surface%traits%onset &
                    == onset_yields) call slip_at_once(self, pressure, abs(self%y(elastic)))
            end if
        end associate
    end subroutine switch

    !> Onset of slip under a law with a yield point. Where the resistance falls faster than the
    !> contact spring unloads, that goes on at once to where it does not.
    subroutine jump(self, pressure, strength)
        class(continuous), intent(inout) :: self
        real(dp), intent(in) :: pressure   !! [F/L^2]
        real(dp), intent(in) :: strength   !! [F/L^2]
        real(dp) :: before, after, by_rate, v
        logical :: failed

        associate (eq => self%equations)
            before = abs(self%y(elastic))
            self%y(elastic) = eq%sense * strength / eq%alpha
            if (eq%phase == phase_capped) return
            if (eq%surface%traits%onset == onset_drops) then
                call eq%find_velocity(self%y, pressure, v, failed)
                call eq%surface%resistance_at(eq%law_state_of(self%y, pressure), max(0.0_dp, &
                    eq%sense * v), pressure, after, by_rate)
                after = min(after, eq%surface%tau_max) / eq%alpha
                self%y(elastic) = eq%sense * after
                self%y(slip) = self%y(slip) + max(0.0_dp, before - after)
                self%y(dissipated) = self%y(dissipated) + max(0.0_dp, 0.5_dp * eq%alpha &
                    * (before**2 - after**2))
            else if (eq%surface%traits%memory == 2) then
                call slip_at_once(self, pressure, before)
            end if
        end associate
    end subroutine jump

    !> Changes the method after fifteen stiff steps of the explicit one, or three calm ones of the
    !> implicit one.
    subroutine choose_method(self, tried)
        class(continuous), intent(inout) :: self
        type(trial), intent(in) :: tried
        real(dp), parameter :: bound = 3.25_dp   !! of Dormand and Prince's method, on the real axis
        integer, parameter :: most_stiff = 15, most_calm = 6, few_calm = 3

        if (self%equations%surface%traits%stiff) return
        if (self%implicit) then
            self%calm = merge(self%calm + 1, 0, self%dt / tried%h * tried%stiffness < 3.0_dp)
            if (self%calm < few_calm) return
            self%implicit = .false.
        else
            if (tried%stiffness > bound) then
                self%stiff = self%stiff + 1
                self%calm = 0
            else
                self%calm = self%calm + 1
                if (self%calm >= most_calm) self%stiff = 0
            end if
            if (self%stiff < most_stiff) return
            self%implicit = .true.
        end if
        self%stiff = 0
        self%calm = 0
    end subroutine choose_method

    !> The state at the end of a step.
    subroutine fill(self, t, piece, old, new)
        class(continuous), intent(inout) :: self
        real(dp), intent(in) :: t   !! [T]
        integer, intent(in) :: piece
        type(slider_state), intent(in) :: old
        type(slider_state), intent(inout) :: new
        real(dp) :: dy(unknowns)
        logical :: failed

        associate (eq => self%equations, y => self%y)
            new%time = t
            new%drive = self%origin + self%drive%position(t)
            new%normal = self%drive%normal_traction(t, piece)
            new%drive_work = y(drive_work)
            new%damped = y(damped)
            if (self%known) then
                dy = self%first
            else
                call eq%rates(t, y, dy, failed)
            end if
            call fill_block(eq, self%system, t, y, dy, 1, old, new)
            if (.not. eq%mass > 0.0_dp) then
                new%v(1) = self%drive%drive_velocity(t, piece) - dy(extension)
                if (eq%rigid .and. eq%phase /= phase_open) new%v(1) = &
                    eq%sense_of(y(extension)) * dy(slip)   ! slow beside the drive, too
            end if
            new%statev(1, statev_u_n) = -new%normal / self%system%props(prop_alpha_n)
        end associate
    end subroutine fill

    !> What a state holds of a block, but for its u_n.
    subroutine fill_block(eq, system, t, y, dy, i, old, new)
        type(slider_equations), intent(in) :: eq
        type(slider), intent(in) :: system
        real(dp), intent(in) :: t                 !! [T]
        real(dp), intent(inout) :: y(unknowns)
        real(dp), intent(in) :: dy(unknowns)
        integer, intent(in) :: i                  !! block
        type(slider_state), intent(in) :: old
        type(slider_state), intent(inout) :: new  !! its time, drive and normal traction are given
        type(law_state) :: state
        real(dp) :: pressure, strength

        ! what accumulates never falls, not even by round-off
        y(slip) = max(y(slip), old%statev(i, statev_slip))
        y(dissipated) = max(y(dissipated), old%statev(i, statev_dissipation))
        new%x(i) = new%drive - y(extension)
        new%spring(i) = system%stiffness * y(extension)
        new%friction(i) = system%area * eq%traction(t, y)
        new%v(i) = y(velocity)
        new%a(i) = dy(velocity)
        pressure = new%normal
        if (allocated(system%load)) pressure = pressure * system%load(i)
        pressure = merge(0.0_dp, max(pressure, eq%least_pressure), eq%phase == phase_open)
        state = eq%law_state_of(y, pressure)
        new%statev(i, statev_status) = 3.0_dp
        if (eq%phase /= phase_open) new%statev(i, statev_status) = merge(2.0_dp, 1.0_dp, &
            dy(slip) > 0.0_dp)
        new%statev(i, statev_u_et) = merge(0.0_dp, y(elastic), eq%rigid)
        new%statev(i, statev_r) = state%r
        if (eq%surface%traits%memory == 1) then
            new%statev(i, statev_mu) = state%mu
        else if (pressure > 0.0_dp) then
            strength = abs(eq%traction(t, y))
            if (eq%surface%traits%onset == onset_yields) strength = eq%strength(y, pressure)
            new%statev(i, statev_mu) = max(0.0_dp, strength - eq%surface%cohesion) / pressure
        end if
        new%statev(i, statev_slip) = y(slip)
        new%statev(i, statev_dissipation) = y(dissipated)
    end subroutine fill_block

    subroutine visit(self, file)
        class(continuous), intent(inout) :: self
        type(archive), intent(inout) :: file

        call self%visit_counts(file)
        call file%visit(self%y)
        call file%visit(self%dt, self%implicit, self%stiff, self%calm, self%equations%phase)
        call file%visit(self%equations%sense)
        self%known = .false.
    end subroutine visit

    subroutine why_stopped(self, status, why)
        class(continuous), intent(in) :: self
        integer, intent(in) :: status
        character(len=:), allocatable, intent(out) :: why

        if (status == friction_no_rate .and. self%system%mass <= 0.0_dp) then
            why = unstable_without_inertia
        else if (status == friction_no_rate) then
            why = 'the contact jumps: friction falls faster than the contact spring unloads. ' &
                // 'Take a larger alpha_t'
        else if (status /= friction_no_convergence) then
            why = trim(friction_message(status))
        else
            why = why_too_short(self%dt_min)
        end if
    end subroutine why_stopped

end module continuous_steps
