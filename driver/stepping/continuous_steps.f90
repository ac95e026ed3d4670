!> Adaptive steps of one block in continuous time: the rate equations of module `slider_rates` by an
!> explicit method where they are not stiff, by Rodas4 where they are. Both take each step from the
!> state alone, so that a run goes on from a checkpoint as if it had never stopped.
!>
!> Steps end where a phase of the contact ends, found by taking them again until they do.
module continuous_steps
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use abstract_integrator, only : step_report, unstable_without_inertia
    use archive_file, only : archive
    use block_motion, only : fill_block, moving_block, set_growing_weights, set_up
    use block_steps, only : block_integrator, is_short, shortest
    use explicit_pairs, only : dormand_prince, tsitouras
    use friction_mod, only : friction_bad_state, friction_message, friction_no_convergence, &
        friction_no_rate, law_state, load_rates, prop_alpha_n, statev_u_n
    use phase_changes, only : change_phase, follow_velocity, lifts, phase_at_rest, settle
    use run_settings, only : settings
    use slider_rates, only : away, damped, drive_work, elastic, extension, memory, &
        most_logarithm, phase_open, phase_slide, phase_stick, place, slip, slider_equations, &
        velocity
    use slider_system, only : slider, slider_state
    use step_ends, only : end_of_step, find_opening, next_limit, vanishing_part, why_too_short
    use sudden_changes, only : stopped, take_load, take_off_spring
    use swing_bound, only : oscillation, oscillation_of
    use trial_step, only : most_open, trial
    implicit none
    private

    public :: continuous, creep_weight

    !> Part of the time that is lost in round-off, but for the steps that it takes to follow a decay
    !> which has gone on for as long.
    real(dp), parameter, public :: lost = 256.0_dp * shortest
    !> Part of it that a step takes which follows what happens at once.
    real(dp), parameter :: at_once = 1.0e3_dp * shortest
    real(dp), parameter :: quarter = 2.0_dp * atan(1.0_dp)   !! of a swing [rad]

    type, extends(block_integrator) :: continuous
        real(dp) :: limit = 0.0_dp   !! where the step ends at the latest [T]
        real(dp) :: rtol = 0.0_dp
        integer :: stiff = 0, calm = 0          !! steps in favour of the other method
        real(dp) :: passed = 0.0_dp             !! since the time of the step's start, in parts [T]
        type(oscillation) :: ringing            !! of a contact that sticks
        type(oscillation) :: swinging           !! on the drive spring alone
        type(oscillation) :: lifting            !! of the motion across the interface
        real(dp) :: largest = 0.0_dp            !! normal traction [F/L^2]
        logical :: reloaded = .false.           !! it is not always the same
        logical :: heals = .false.              !! at rest the law forgets how far it has slipped
    contains
        procedure :: prepare, step, visit, why_stopped
        procedure, non_overridable :: take_limit, can_shorten, lengthen
        procedure, private :: begin, go_on, choose_method, set_weights, choose_unknown, fill
    end type continuous

contains

    subroutine prepare(self, run, system, start)
        class(continuous), intent(inout) :: self
        type(settings), intent(in) :: run
        type(slider), intent(in) :: system
        type(slider_state), intent(in) :: start

        call self%take_run(run, system, start)
        self%in_rates = .true.
        self%rtol = run%rtol
        self%largest = run%drive%largest_normal()
        associate (normal => run%drive%normal)
            self%reloaded = minval(normal) < maxval(normal) .or. run%load_varies() &
                .or. run%across%free()
        end associate
        associate (eq => self%block%equations)
            self%block%props = run%props
            call set_up(run, run%props, self%largest, eq, self%natural)
            eq%drive = run%drive
            eq%across = system%across
            self%implicit = eq%surface%traits%stiff
            eq%open_below = self%largest * vanishing_part(eq%surface%traits%stiff, run%rtol)
            if (eq%surface%traits%memory == 1) eq%open_below = self%largest * max(1.0e-6_dp, &
                16.0_dp * epsilon(1.0_dp) / run%rtol)   ! R is lost in its round-off
            call eq%find_least_share(run%rtol)
            self%heals = heals_at_rest(eq)
            if (max(eq%surface%cohesion, eq%surface%law%cohesion) > 0.0_dp) then
                ! closed without pressure; slip that goes with an exponential needs some
                if (eq%surface%traits%stiff) eq%least_pressure = max(eq%least_pressure, &
                    eq%open_below)
                eq%eased = eq%surface%traits%stiff
                eq%open_below = -tiny(self%largest)
            end if
            self%weights = 1.0_dp / (self%rtol * self%natural)
            self%swinging = oscillation_of(eq%mass, eq%stiffness, eq%damping)
            self%ringing = self%swinging
            if (.not. eq%rigid) self%ringing = oscillation_of(eq%mass, eq%stiffness + eq%area &
                * eq%alpha, eq%damping + eq%area * eq%damper)
            self%lifting = oscillation_of(eq%across%mass, eq%across%stiffness + eq%area &
                * eq%alpha_n, eq%across%damping)
            call self%free%prepare(eq)
            eq%may_rest = eq%surface%traits%memory == 1 .and. self%free%frequency > 0.0_dp &
                .and. .not. (eq%damper > 0.0_dp .or. eq%surface%tau_max < huge(eq%damper) &
                .or. eq%surface%cohesion > 0.0_dp .or. eq%across%free())
            call self%block%synchronise(start)
            eq%phase = phase_at_rest(eq)
            if (start%normal <= min(0.0_dp, eq%open_below)) eq%phase = phase_open
            eq%sense = eq%sense_of(self%block%y(elastic))
            if (eq%rigid) call take_off_spring(self%block, start)
        end associate
    end subroutine prepare

    pure function heals_at_rest(eq) result(heals)
        type(slider_equations), intent(in) :: eq
        logical :: heals
        type(law_state) :: changes

        heals = .false.
        if (.not. eq%surface%traits%kink < huge(1.0_dp)) return
        changes = eq%surface%state_rates(law_state(mu=0.0_dp, r=eq%surface%traits%kink), &
            load_rates(0.0_dp, 0.0_dp, eq%alpha, 0.0_dp, 0.0_dp, .false.), 0.0_dp)
        heals = changes%r < 0.0_dp
    end function heals_at_rest

    !> One step, of parts where what happens is over in less than the time can tell.
    subroutine step(self, old, new, report)
        class(continuous), intent(inout) :: self
        type(slider_state), intent(inout) :: old
        type(slider_state), intent(inout) :: new
        type(step_report), intent(out) :: report
        integer, parameter :: most_parts = 10000
        real(dp) :: end
        integer :: piece, i

        self%passed = 0.0_dp
        end = old%time
        do i = 1, most_parts
            call self%begin(old, piece)
            call self%go_on(old%time, piece, end, report)
            if (report%status < 0) return
            if (end > old%time) exit
        end do
        if (end > old%time) then
            call self%fill(end, piece, old, new)
        else
            report%status = friction_no_convergence
        end if
    end subroutine step

    !> Takes the block through one step, or a part of one.
    subroutine go_on(self, t, piece, end, report)
        class(continuous), intent(inout) :: self
        real(dp), intent(in) :: t           !! of its start, but for what has passed since [T]
        integer, intent(in) :: piece
        real(dp), intent(out) :: end        !! [T]; not after the start: it is not over
        type(step_report), intent(inout) :: report
        type(trial) :: tried
        real(dp) :: wanted, stable, slipped
        real(dp) :: h, error   ! of the step in whole, before it ends with a phase
        logical :: again

        again = .false.
        do
            stable = longest(self)
            wanted = min(merge(stable, self%dt, self%swings), self%dt_max, stable)
            call plan(self, t, piece, wanted, end, tried%h)
            call self%attempt(t, tried)
            h = tried%h
            error = tried%error
            if (tried%error <= 1.0_dp) call self%locate(t, tried)
            if (tried%error <= 1.0_dp) exit
            again = .true.
            if (.not. self%can_shorten(t, tried%h, tried%error)) then
                if (stopped(self%block, t, lost * t)) then
                    call settle(self%block, t)
                    call know_velocity(self%block)
                    self%dt = at_once * t
                else if (.not. can_part(self, t)) then
                    report%status = merge(friction_no_rate, friction_no_convergence, jumps(self, t))
                    return
                end if
            end if
        end do
        call pass_time(self, t, tried, end)
        if (.not. self%swings) then
            call self%lengthen(h, error, wanted, again)
            call self%choose_method(tried, stable)
        end if
        associate (block => self%block, eq => self%block%equations)
            slipped = block%y(slip)
            block%y = tried%y
            block%first = tried%last
            call follow_velocity(block, end, slipped)
            call know_velocity(block)
            if (eq%surface%traits%logarithmic .and. abs(block%y(memory)) > most_logarithm) then
                report%status = friction_bad_state
            end if
            block%known = eq%steady .and. .not. self%implicit .and. tried%switch == 0
            if (tried%switch > 0 .and. .not. waits(eq, tried%switch)) call change_phase(block, &
                end, tried%switch)
            call block%find_balance(self%rtol * self%natural(elastic))
        end associate
    end subroutine go_on

    !> Where a step is to end, and its length. The end is a time that can be told, which a short
    !> step does not wait for.
    subroutine plan(self, t, piece, wanted, end, h)
        class(continuous), intent(in) :: self
        real(dp), intent(in) :: t         !! of its start [T]
        integer, intent(in) :: piece
        real(dp), intent(in) :: wanted    !! [T]
        real(dp), intent(out) :: end, h   !! [T]
        real(dp) :: before, opening

        end = end_of_step(t, self%passed + wanted, self%limit)
        associate (eq => self%block%equations)
            if (.not. (eq%steady .or. eq%across%free())) then
                call find_opening(self%drive, piece, eq%open_below, eq%phase == phase_open, t, &
                    end, before, opening)
                end = min(end, opening)
            end if
        end associate
        h = (end - t) - self%passed
        if (is_short(t, h) .and. .not. end < t + (self%passed + wanted)) h = wanted
    end subroutine plan

    !> The time at the end of a step that was planned, which may have ended earlier.
    subroutine pass_time(self, t, tried, end)
        class(continuous), intent(inout) :: self
        real(dp), intent(in) :: t         !! of its start [T]
        type(trial), intent(in) :: tried
        real(dp), intent(inout) :: end    !! as planned; then the time that can be told [T]
        real(dp) :: passed

        passed = self%passed + tried%h
        if (tried%switch > 0 .or. passed < end - t .or. is_short(t, tried%h)) end = t + passed
        self%passed = passed
    end subroutine pass_time

    !> May a step have parts that are shorter than what the time can tell?
    pure function can_part(self, t) result(yes)
        class(continuous), intent(in) :: self
        real(dp), intent(in) :: t   !! [T]
        logical :: yes

        yes = .not. (self%dt_min > 0.0_dp .or. jumps(self, t)) .and. self%dt > epsilon(t) &
            * shortest * t
    end function can_part

    !> Does the next step begin with the next phase: with a contact that opens or closes, or with a
    !> block that jumps?
    pure function waits(eq, switch) result(yes)
        type(slider_equations), intent(in) :: eq
        integer, intent(in) :: switch   !! way in which the phase ends
        logical :: yes

        yes = switch == lifts .or. may_jump(eq) .and. eq%phase == phase_stick
    end function waits

    !> Does the block go along where its contact jumps?
    pure function may_jump(eq) result(yes)
        type(slider_equations), intent(in) :: eq
        logical :: yes

        yes = eq%springs_alone() .and. .not. eq%rigid
    end function may_jump

    !> The velocity of a block that follows the traction: that may be less than round-off of the
    !> drive's.
    pure subroutine know_velocity(block)
        type(moving_block), intent(inout) :: block

        associate (eq => block%equations)
            if (eq%follows_traction()) block%y(velocity) = eq%sense_of(block%y(elastic)) &
                * block%first(slip)
        end associate
    end subroutine know_velocity

    !> Does the block swing on a contact that rests, by what explicit steps would have to follow?
    pure function swings_freely(self) result(yes)
        class(continuous), intent(in) :: self
        logical :: yes
        real(dp), parameter :: unseen = 0.01_dp   !! part of the tolerated error

        yes = .false.
        associate (eq => self%block%equations)
            if (.not. eq%rests .or. eq%phase /= phase_stick) return
            yes = self%free_amplitude() * self%weights(elastic) > unseen
        end associate
    end function swings_freely

    !> Length of the longest step that is stable [T]: of an explicit one that which amplifies no
    !> swing, on the springs that the block has at its slip rate. In closed form a quarter of one.
    pure function longest(self) result(dt)
        class(continuous), intent(in) :: self
        real(dp) :: dt
        real(dp), parameter :: slow = 0.1_dp   !! slip rate, part of the velocity

        dt = huge(dt)
        if (self%swings) dt = quarter / self%free%frequency
        if (self%swings .or. self%implicit) return
        associate (eq => self%block%equations, slip_rate => self%block%first(slip), &
            speed => abs(self%block%y(velocity)))
            if (eq%phase == phase_open) then
                dt = self%swinging%longest_step(self%pair)
                return
            end if
            dt = self%lifting%longest_step(self%pair)
            if (eq%rigid .and. eq%phase == phase_stick) return
            if (slip_rate <= slow * speed) then
                dt = min(dt, self%ringing%longest_step(self%pair))
            else
                dt = min(dt, self%swinging%longest_step(self%pair))
                if (slip_rate >= speed .or. self%ringing%radian >= dt) return
                dt = min(dt, self%ringing%radian * max(1.0_dp, 1.15_dp * self%ringing%phase) &
                    / sqrt(1.0_dp - slip_rate / speed))
            end if
        end associate
    end function longest

    !> Takes the block to what holds from the start of a step on.
    subroutine begin(self, old, piece)
        class(continuous), intent(inout) :: self
        type(slider_state), intent(inout) :: old
        integer, intent(out) :: piece   !! of the programme
        real(dp) :: pressure, open_below
        real(dp) :: before   !! extension of the drive spring [L]
        logical :: touches, jumps_along

        before = self%block%y(extension)
        piece = self%drive%piece(old%time)
        if (piece /= self%block%equations%piece) then
            call self%block%equations%enter(piece)
            self%block%known = .false.
            self%pair = dormand_prince
            if (self%block%equations%rests) self%pair = tsitouras
        end if
        associate (eq => self%block%equations)
            if (eq%may_rest .and. .not. eq%rests .and. eq%phase == phase_stick) eq%phase &
                = phase_at_rest(eq)
            if (.not. (eq%constant .and. self%block%known)) then   ! else the load is what it was
                pressure = self%drive%normal_traction(old%time, piece)
                open_below = eq%open_below
                if (eq%across%free()) then
                    pressure = eq%pressed_to(self%block%y)
                else if (eq%steady) then   ! it is taken as it is
                    open_below = min(0.0_dp, open_below)
                end if
                call take_load(self%block, self%system, pressure, open_below, lost * max(old%time, &
                    self%dt_min), old, touches)
                if (touches) then   ! so steeply that Rodas4's differences tell nothing
                    self%implicit = .false.
                    self%stiff = 0
                end if
            end if
        end associate
        call self%take_limit(old%time)
        call settle(self%block, old%time)
        call self%block%find_balance(self%rtol * self%natural(elastic))
        if (.not. self%block%known) call settle(self%block, old%time)
        jumps_along = may_jump(self%block%equations) .and. abs(self%block%y(extension) - before) &
            > 0.0_dp
        ! the fall of the block is a step of its own
        if (jumps_along) self%dt = min(self%dt, max(at_once * old%time, self%dt_min))
        call self%set_weights(old%time)
        if ((self%reloaded .or. self%block%equations%rigid) .and. &
            self%block%equations%creeps_along()) call self%choose_unknown(old%time)
        self%swings = swings_freely(self)
    end subroutine begin

    !> Has slip no rate any more, or one that leaves its block far behind?
    pure function jumps(self, t) result(yes)
        class(continuous), intent(in) :: self
        real(dp), intent(in) :: t   !! [T]
        logical :: yes

        yes = self%jumped
        if (self%block%known) yes = yes .or. self%block%equations%runs_away(t, self%block%first, &
            maxval(abs(self%drive%velocity)))
    end function jumps

    subroutine take_limit(self, t)
        class(continuous), intent(inout) :: self
        real(dp), intent(in) :: t   !! [T]

        if (t >= self%limit) self%limit = next_limit(self%drive, self%every, self%t_end, &
            4.0_dp * shortest, t)
    end subroutine take_limit

    !> Chooses a shorter step in the place of one that was refused, if there is one.
    function can_shorten(self, t, h, error) result(yes)
        class(continuous), intent(inout) :: self
        real(dp), intent(in) :: t, h    !! [T]
        real(dp), intent(in) :: error   !! part of the tolerated one
        logical :: yes

        self%rejected = self%rejected + 1
        self%dt = h * max(0.2_dp, 0.9_dp * error**power_of(self))
        yes = self%dt > max(self%dt_min, shortest * t)
    end function can_shorten

    !> Chooses the next step. One that a limit has cut says nothing against the one that was wanted.
    subroutine lengthen(self, h, error, wanted, again)
        class(continuous), intent(inout) :: self
        real(dp), intent(in) :: h        !! the step that was taken [T]
        real(dp), intent(in) :: error    !! part of the tolerated one
        real(dp), intent(in) :: wanted   !! [T]
        logical, intent(in) :: again     !! longer ones were refused

        self%dt = h * min(merge(1.0_dp, 5.0_dp, again), 0.9_dp * max(error, &
            1.0e-10_dp)**power_of(self))
        if (h < 0.99_dp * wanted) self%dt = max(self%dt, wanted)
    end subroutine lengthen

    !> Power of the error by which a step's length changes: one over the order of its estimate.
    pure function power_of(self) result(power)
        class(continuous), intent(in) :: self
        real(dp) :: power

        power = merge(-1.0_dp / 4.0_dp, -1.0_dp / 5.0_dp, self%implicit)
    end function power_of

    !> What the error of each unknown is compared with.
    subroutine set_weights(self, t)
        class(continuous), intent(inout) :: self
        real(dp), intent(in) :: t   !! [T]
        real(dp) :: v_drive, pressure, pressure_rate

        call set_growing_weights(self%block%equations%acting, self%rtol, self%natural, &
            self%block%y, self%weights)
        associate (eq => self%block%equations, y => self%block%y)
            ! how fast friction falls is decided by velocities that are a small part of an event's
            if (eq%falling < self%natural(velocity)) self%weights(velocity) = 1.0_dp / (self%rtol &
                * max(eq%falling, abs(y(velocity))))
            ! beside a damper the velocity tells the traction, unless the contact slides
            if (eq%slides_damped() .and. (eq%phase == phase_stick .or. eq%phase == phase_slide &
                .and. eq%surface%traits%stiff)) self%weights(velocity) = max( &
                self%weights(velocity), 1.0_dp / (self%rtol * max(self%damper_velocity(), &
                abs(y(velocity)))))
            ! friction that has weakened for good does not ask how far it slips
            self%weights(memory) = merge(0.0_dp, 1.0_dp / (self%rtol * self%natural(memory)), &
                y(memory) > eq%surface%traits%kink .and. .not. self%heals)
        end associate
        if (.not. self%reloaded) return
        call self%block%equations%inputs(t, self%block%y, v_drive, pressure, pressure_rate)
        pressure = max(pressure, self%block%equations%open_below, &
            self%block%equations%least_pressure)
        if (self%block%equations%surface%traits%stiff) then
            self%pressed = min(1.0_dp, pressure / self%largest)
            self%weights(elastic) = creep_weight(self%natural(elastic), self%rtol, self%pressed)
        else if (self%block%equations%surface%traits%memory == 1) then
            ! R is traction over strength, and how it grows from a touchdown on is not forgotten
            self%weights(elastic) = 1.0_dp / (self%natural(elastic) * self%rtol * min(1.0_dp, &
                max(pressure, self%block%equations%surface%law%cohesion) / self%largest))
        end if
    end subroutine set_weights

    !> Inverse of the tolerated error of the contact's spring where slip goes with an exponential:
    !> what counts for that is traction over pressure [1/L].
    elemental real(dp) function creep_weight(natural, rtol, pressed) result(weight)
        real(dp), intent(in) :: natural   !! elastic displacement, under the largest load [L]
        real(dp), intent(in) :: rtol
        real(dp), intent(in) :: pressed   !! pressure, part of the largest
        real(dp), parameter :: tight = 1.0e-4_dp   !! tolerated error of it, part of friction

        weight = 1.0_dp / (natural * min(rtol, tight * pressed))
    end function creep_weight

    !> Velocity or traction of a contact that creeps. Of a rigid one each tells the other: the
    !> traction is the unknown, unless its tolerated error leaves the velocity open by many times
    !> its own. Of a surface that carries next to nothing the traction tells no velocity at all, nor
    !> does that of a contact spring, which is left out if it is much less than its tolerated error;
    !> not while it unloads by itself, for then it is what the surface slides by.
    subroutine choose_unknown(self, t)
        class(continuous), intent(inout) :: self
        real(dp), intent(in) :: t   !! [T]
        real(dp) :: v_drive, pressure, pressure_rate, resistance, by_rate, many
        logical :: by_velocity

        many = merge(most_open, most_open / self%rtol, self%block%equations%rigid)
        associate (block => self%block, eq => self%block%equations)
            call eq%inputs(t, block%y, v_drive, pressure, pressure_rate)
            call eq%surface%resistance_at(eq%law_state_of(block%y, pressure), &
                abs(block%y(velocity)), pressure, resistance, by_rate)
            by_velocity = many * by_rate * self%weights(elastic) < self%weights(velocity) &
                * eq%alpha
            if (.not. eq%rigid) by_velocity = by_velocity .and. abs(sign(resistance, &
                block%y(velocity)) / eq%alpha - block%y(elastic)) * self%weights(elastic) <= 1.0_dp
            if (by_velocity .eqv. eq%by_velocity) return
            eq%by_velocity = by_velocity
            block%known = .false.
            call settle(block, t)
        end associate
    end subroutine choose_unknown

    !> Changes the method after fifteen steps of the explicit one that stability held far shorter
    !> than the error would (or shorter at all, where there is no swing to lose), or three calm ones
    !> of the implicit one.
    subroutine choose_method(self, tried, stable)
        class(continuous), intent(inout) :: self
        type(trial), intent(in) :: tried
        real(dp), intent(in) :: stable   !! length of the longest step that is [T]
        integer, parameter :: most_stiff = 15, most_calm = 6, few_calm = 3
        real(dp) :: far

        if (self%block%equations%surface%traits%stiff) return
        far = merge(1.0_dp, 4.0_dp, self%ringing%decays)
        if (self%implicit) then
            self%calm = merge(self%calm + 1, 0, self%dt / tried%h * tried%stiffness < 3.0_dp)
            if (self%calm < few_calm) return
            self%implicit = .false.
        else
            if (tried%stiffness > self%pair%bound .or. self%dt / far > stable) then
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
        logical :: failed

        associate (eq => self%block%equations, y => self%block%y, dy => self%block%first)
            new%time = t
            new%drive = self%origin + self%drive%position(t)
            new%load = self%drive%normal_traction(t, piece)
            new%normal = new%load
            if (eq%across%mass > 0.0_dp) new%normal = self%system%carried_pressure(y(place))
            new%drive_work = y(drive_work)
            new%damped = y(damped)
            if (.not. self%block%known) call eq%rates(t, y, dy, failed)
            call fill_block(eq, new%normal, t, y, dy, 1, old, new)
            if (.not. eq%mass > 0.0_dp) then
                new%v(1) = self%drive%drive_velocity(t, piece) - dy(extension)
                if (eq%rigid .and. eq%phase /= phase_open) new%v(1) = &
                    eq%sense_of(y(extension)) * dy(slip)   ! slow beside the drive, too
            end if
            new%statev(1, statev_u_n) = -new%normal / self%system%props(prop_alpha_n)
            if (.not. eq%across%mass > 0.0_dp) return
            new%statev(1, statev_u_n) = y(place)
            new%v_n = y(away)
            new%a_n = dy(away)
        end associate
    end subroutine fill

    subroutine visit(self, file)
        class(continuous), intent(inout) :: self
        type(archive), intent(inout) :: file

        call self%visit_counts(file)
        call file%visit(self%block%y)
        call file%visit(self%dt, self%implicit, self%stiff, self%calm, self%block%equations%phase)
        call file%visit(self%block%equations%sense)
        self%block%known = .false.
    end subroutine visit

    subroutine why_stopped(self, status, why)
        class(continuous), intent(in) :: self
        integer, intent(in) :: status
        character(len=:), allocatable, intent(out) :: why

        if (status == friction_no_rate .and. self%system%mass <= 0.0_dp) then
            why = unstable_without_inertia
        else if (status == friction_no_rate) then
            why = 'the contact jumps: friction falls faster than the contact spring unloads. ' &
                // 'Use a larger alpha_t'
        else if (status == friction_bad_state) then
            why = 'theta leaves the range of numbers, as it grows with exp(mu/b). ' &
                // 'Use a larger b'
        else if (status /= friction_no_convergence) then
            why = trim(friction_message(status))
        else
            why = why_too_short(self%dt_min)
        end if
    end subroutine why_stopped

end module continuous_steps
