!> One block in continuous time: its rate equations, in each phase of its contact (docs/theory.md,
!> section 13).
module slider_rates
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use friction_mod, only : law_state, load_rates, onset_drops, onset_gradual, sliding_surface
    use loading_programme, only : programme
    use slider_system, only : normal_motion
    use slip_balance, only : damper_balance, slip_of
    implicit none
    private

    public :: contact_motion, slider_equations

    !> Unknowns. Those of the error norm come first, of them those along the interface; the others
    !> follow from them.
    integer, parameter, public :: unknowns = 11, controlled = 7, along = 5
    integer, parameter, public :: extension = 1    !! of the drive spring [L]
    integer, parameter, public :: velocity = 2     !! of the block; without mass seldom [L/T]
    integer, parameter, public :: elastic = 3      !! elastic displacement of the contact [L]
    integer, parameter, public :: memory = 4       !! of the law: mu, D, or ln(theta)
    integer, parameter, public :: ratio = 5        !! R while a shear cap holds the traction, or
                                                   !! beside a damper [-]
    integer, parameter, public :: place = 6        !! u_n of a block that moves across [L]
    integer, parameter, public :: away = 7         !! its velocity away from the base [L/T]
    integer, parameter, public :: slip = 8         !! accumulated [L]
    integer, parameter, public :: drive_work = 9   !! [F L]
    integer, parameter, public :: damped = 10      !! energy [F L]
    integer, parameter, public :: dissipated = 11  !! energy per area [F/L]

    !> Phases of the contact. A law without a yield point always slides, if only by a little.
    integer, parameter, public :: phase_open = 0
    integer, parameter, public :: phase_stick = 1
    integer, parameter, public :: phase_slide = 2    !! as the law says
    integer, parameter, public :: phase_capped = 3   !! as the shear cap says

    real(dp), parameter :: too_large = 1.0e100_dp   !! for what is to be squared or multiplied
    !> Largest logarithm of what the law remembers: its exponential and rates are in range.
    real(dp), parameter, public :: most_logarithm = 600.0_dp

    type :: slider_equations
        type(sliding_surface) :: surface
        real(dp) :: mass = 0.0_dp, stiffness = 0.0_dp, damping = 0.0_dp   !! as of `slider`
        real(dp) :: area = 0.0_dp
        real(dp) :: alpha = 0.0_dp       !! tangential stiffness of the contact [F/L^3]
        real(dp) :: damper = 0.0_dp      !! beside that [F T/L^3]; with it and without mass, all but
                                         !! a subloading surface slides, if only at a rate of zero
        real(dp) :: least_share = 0.0_dp !! R beside a damper grows as from here at least: its rate
                                         !! at 0 has no bound, its way from there is short [-]
        logical :: rigid = .false.       !! the contact has no spring
        logical :: by_velocity = .false. !! where it creeps, its traction follows the block's
                                         !! velocity, which is the unknown
        type(normal_motion) :: across    !! the interface: there the pressure follows from `place`
        real(dp) :: alpha_n = 0.0_dp     !! normal stiffness of the contact [F/L^3]
        real(dp) :: falling = 1.0e200_dp !! velocity by which friction falls that falls with it, as
                                         !! far as round-off of the forces tells [L/T]
        real(dp) :: open_below = 0.0_dp  !! pressure that counts as none [F/L^2]
        type(programme) :: drive
        integer :: piece = 0             !! of the programme, in which the rates are taken
        logical :: steady = .false.      !! drive and load do not change in it
        logical :: constant = .false.    !! nor does the pressure: they are
        real(dp), private :: constant_velocity = 0.0_dp   !! [L/T]
        real(dp), private :: constant_pressure = 0.0_dp   !! [F/L^2]
        real(dp) :: least_pressure = 0.0_dp   !! of a contact that is not open [F/L^2]
        logical :: may_rest = .false.    !! under a constant load, slip that comes gradually has a
                                         !! phase of its own, and none of it another
        logical :: rests = .false.       !! so it is in this piece
        logical :: eased = .false.       !! the pressure comes to that smoothly
        integer :: acting = controlled   !! first unknowns, which act on the others
        integer :: phase = phase_stick
        real(dp) :: sense = 1.0_dp       !! of the slip in x, where the phase has one
        real(dp) :: forward = 1.0_dp     !! sense of the loading in x, 1 or -1
    contains
        procedure :: enter, rates, find_velocity, law_state_of, strength, full_strength, &
            traction, inputs, pull, slip_tendency, creeps_along, follows_traction, sense_of, &
            follows_share, runs_away, damped_contact, balance_at, pressed_to, find_least_share, &
            share_rate, springs_alone, keeps_velocity, slides_damped
    end type slider_equations

    !> What a contact does to the block. Those that find it fill in what is not zero.
    type :: contact_motion
        real(dp) :: velocity = 0.0_dp   !! of the block [L/T]
        real(dp) :: traction = 0.0_dp   !! opposes +x [F/L^2]
        real(dp) :: elastic = 0.0_dp, memory = 0.0_dp, ratio = 0.0_dp, slip = 0.0_dp   !! rates
    end type contact_motion

contains

    !> Takes the equations to a piece of the programme.
    subroutine enter(self, piece)
        class(slider_equations), intent(inout) :: self
        integer, intent(in) :: piece

        self%piece = piece
        self%steady = .not. (abs(self%drive%acceleration(piece)) > 0.0_dp &
            .or. abs(self%drive%normal_rate(piece)) > 0.0_dp .or. self%drive%amplitude > 0.0_dp)
        self%constant = self%steady .and. .not. self%across%free()
        self%rests = self%may_rest .and. self%constant
        self%acting = ratio - 1
        if (self%damper > 0.0_dp .or. self%surface%tau_max < huge(1.0_dp)) self%acting = ratio
        if (self%across%free()) self%acting = controlled
        self%constant_velocity = self%drive%velocity(piece)
        self%constant_pressure = max(self%drive%normal(piece), self%least_pressure)
    end subroutine enter

    !> The sense of a motion or a force; of none, that of the loading: a mirrored motion has the
    !> mirrored steps, to the last bit.
    pure function sense_of(self, motion) result(sense)
        class(slider_equations), intent(in) :: self
        real(dp), intent(in) :: motion
        real(dp) :: sense   !! 1 or -1

        sense = self%forward
        if (abs(motion) > 0.0_dp) sense = sign(1.0_dp, motion)
    end function sense_of

    !> Velocity of the drive, pressure and its rate.
    pure subroutine inputs(self, t, y, drive_velocity, pressure, pressure_rate)
        class(slider_equations), intent(in) :: self
        real(dp), intent(in) :: t                 !! [T]
        real(dp), intent(in) :: y(controlled)
        real(dp), intent(out) :: drive_velocity   !! [L/T]
        real(dp), intent(out) :: pressure         !! [F/L^2]
        real(dp), intent(out) :: pressure_rate    !! [F/L^2/T]

        drive_velocity = self%constant_velocity
        pressure = self%constant_pressure
        pressure_rate = 0.0_dp
        if (.not. self%constant) call changing_inputs(self, t, y, drive_velocity, pressure, &
            pressure_rate)
        if (self%phase /= phase_open) return
        pressure = 0.0_dp
        pressure_rate = 0.0_dp
    end subroutine inputs

    !> Pressure in the contact of a block that moves across the interface; of an open one below 0.
    pure function pressed_to(self, y) result(pressure)
        class(slider_equations), intent(in) :: self
        real(dp), intent(in) :: y(controlled)
        real(dp) :: pressure   !! [F/L^2]

        pressure = -self%alpha_n * y(place)
    end function pressed_to

    !> Force of the drive spring along the interface [F].
    pure function pull(self, y) result(force)
        class(slider_equations), intent(in) :: self
        real(dp), intent(in) :: y(controlled)
        real(dp) :: force

        force = self%stiffness * y(extension)
        if (self%across%mass > 0.0_dp) force = force - self%across%tilt * (y(place) &
            - self%across%rest)
    end function pull

    !> Those that change with time. By themselves, so that the rest is small enough to be inlined.
    pure subroutine changing_inputs(self, t, y, drive_velocity, pressure, pressure_rate)
        class(slider_equations), intent(in) :: self
        real(dp), intent(in) :: t, y(controlled)
        real(dp), intent(out) :: drive_velocity, pressure, pressure_rate
        real(dp), parameter :: two_pi = 8.0_dp * atan(1.0_dp)

        associate (d => self%drive, i => self%piece)
            drive_velocity = d%drive_velocity(t, i)
            pressure = d%normal_traction(t, i)
            pressure_rate = d%normal_rate(i)
            if (d%amplitude > 0.0_dp) pressure_rate = pressure_rate + d%amplitude * two_pi &
                * d%frequency * cos(two_pi * d%frequency * t + d%phase)
        end associate
        if (self%across%free()) then
            pressure = self%pressed_to(y)
            pressure_rate = -self%alpha_n * y(away)
        end if
        if (self%eased) then
            call ease(self%least_pressure, pressure, pressure_rate)
        else if (pressure < self%least_pressure) then
            pressure = self%least_pressure
            pressure_rate = 0.0_dp
        end if
    end subroutine changing_inputs

    !> A pressure that is `least` where there is none, and itself where it is much larger. An edge
    !> would be one of a state that follows the pressure's logarithm, too: no step is short enough.
    pure subroutine ease(least, pressure, pressure_rate)
        real(dp), intent(in) :: least
        real(dp), intent(inout) :: pressure, pressure_rate   !! [F/L^2], [F/L^2/T]
        real(dp) :: root, eased

        root = hypot(pressure, 2.0_dp * least)
        eased = 0.5_dp * (pressure + root)
        if (pressure < 0.0_dp) eased = 2.0_dp * least**2 / (root - pressure)
        pressure = eased
        pressure_rate = pressure_rate * (eased / root)
    end subroutine ease

    !> Rates of the unknowns.
    pure subroutine rates(self, t, y, dy, failed)
        class(slider_equations), intent(in) :: self
        real(dp), intent(in) :: t               !! [T]
        real(dp), intent(in) :: y(controlled)   !! the others do not matter
        real(dp), intent(out) :: dy(unknowns)
        logical, intent(out) :: failed          !! slip has no rate: it jumps
        type(contact_motion) :: contact
        real(dp) :: force, v_drive, pressure, pressure_rate

        call inputs(self, t, y, v_drive, pressure, pressure_rate)
        force = pull(self, y)
        if (self%rests .and. self%phase /= phase_open) then
            call swinging_contact(self, y, contact, failed)
        else if (self%damper > 0.0_dp .and. self%phase /= phase_open) then
            call damped_contact(self, y, force, v_drive, pressure, pressure_rate, contact, failed)
        else if (self%phase /= phase_open .and. without_spring(self)) then
            if (self%follows_traction()) then
                call following_contact(self, y, force, pressure, pressure_rate, contact)
                failed = .false.
            else
                call rigid_contact(self, y, force, pressure, pressure_rate, contact, failed)
            end if
        else if (self%phase == phase_slide .and. self%surface%traits%onset == onset_drops) then
            call dropping_contact(self, y, force, v_drive, pressure, pressure_rate, contact, failed)
        else
            call elastic_contact(self, y, v_drive, pressure, pressure_rate, contact, failed)
        end if
        ! stages of a step that is going to be refused may be anywhere
        failed = failed .or. max(abs(contact%velocity), abs(contact%slip), abs(contact%traction)) &
            > too_large
        if (failed) then
            dy = 0.0_dp
            return
        end if
        dy(extension) = v_drive - contact%velocity
        dy(velocity) = 0.0_dp
        if (self%mass > 0.0_dp .and. .not. (self%rigid .and. self%phase == phase_stick)) then
            dy(velocity) = (force - self%damping * contact%velocity - self%area &
                * contact%traction) / self%mass
        else if (keeps_velocity(self)) then
            dy(velocity) = (self%stiffness * dy(extension) - self%area * self%alpha &
                * contact%elastic) / self%damping
        end if
        dy(elastic) = contact%elastic
        dy(memory) = contact%memory
        dy(ratio) = contact%ratio
        dy(place:away) = 0.0_dp
        dy(slip) = contact%slip
        dy(drive_work) = force * v_drive
        dy(damped) = self%damping * contact%velocity**2
        dy(dissipated) = abs(contact%traction) * contact%slip
        if (self%damper > 0.0_dp) then
            if (self%follows_share() .and. self%phase == phase_stick) dy(ratio) = 0.0_dp
            dy(dissipated) = dy(dissipated) + self%damper * contact%elastic**2
        end if
        if (self%across%mass > 0.0_dp) call move_across(self, t, y, dy)
    end subroutine rates

    !> The motion across the interface, which friction does not act on.
    pure subroutine move_across(self, t, y, dy)
        class(slider_equations), intent(in) :: self
        real(dp), intent(in) :: t   !! [T]
        real(dp), intent(in) :: y(controlled)
        real(dp), intent(inout) :: dy(unknowns)
        real(dp) :: load   !! of the programme [F]

        load = self%area * self%drive%normal_traction(t, self%piece)
        dy(place) = y(away)
        dy(away) = (self%across%force(y(extension), y(place), y(away)) - load + self%area &
            * max(0.0_dp, self%pressed_to(y))) / self%across%mass
        dy(drive_work) = dy(drive_work) - load * y(away)
        dy(damped) = dy(damped) + self%across%damping * y(away)**2
    end subroutine move_across

    !> A contact on its spring. Without mass and damper, that and the drive spring are one.
    pure subroutine elastic_contact(self, y, v_drive, pressure, pressure_rate, contact, failed)
        class(slider_equations), intent(in) :: self
        real(dp), intent(in) :: y(controlled), v_drive, pressure, pressure_rate
        type(contact_motion), intent(inout) :: contact
        logical, intent(out) :: failed
        type(load_rates) :: load
        type(law_state) :: state, changes
        !> R of a surface that slides fully is 1 but for the error of a step. Cut at 1 rates would
        !> have a kink there, where a surface slides whose strength falls, and derivatives on either
        !> side of it would not fit together. Stages of a step to be refused may be anywhere.
        real(dp), parameter :: just_beyond = 1.01_dp
        real(dp) :: sense
        logical :: in_series

        failed = .false.
        if (self%phase /= phase_open) contact%traction = self%alpha * y(elastic)
        in_series = springs_alone(self)
        load%stiffness = self%alpha
        contact%velocity = y(velocity)
        if (in_series) then
            contact%velocity = v_drive
            load%stiffness = self%alpha * self%stiffness / (self%stiffness + self%area * self%alpha)
        else if (.not. (self%mass > 0.0_dp .or. keeps_velocity(self))) then
            contact%velocity = (self%stiffness * y(extension) - self%area * contact%traction) &
                / self%damping
        end if
        if (self%surface%traits%onset == onset_gradual) then
            sense = sign(1.0_dp, contact%traction)
            if (.not. abs(contact%traction) > 0.0_dp) sense = self%sense_of(contact%velocity)
        else
            sense = self%sense
        end if
        load%traction = abs(contact%traction)
        load%loading = sense * load%stiffness * contact%velocity
        load%pressure = pressure
        load%pressure_rate = pressure_rate
        load%sliding = self%surface%traits%onset /= onset_gradual
        state = law_state_of(self, y, pressure)
        if (self%phase == phase_slide) then
            if (self%surface%traits%memory == 1 .and. state%r >= 1.0_dp) state%r = carried_share( &
                self%alpha * abs(y(elastic)), full_strength(self, y, pressure), just_beyond)
            call self%surface%slip_rate(state, load, contact%slip, failed)
        else if (self%phase == phase_capped) then
            contact%slip = load%loading / load%stiffness
        end if
        if (self%phase /= phase_open) contact%elastic = contact%velocity - sense * contact%slip
        if (in_series) then
            contact%elastic = contact%elastic * (load%stiffness / self%alpha)
            if (self%phase /= phase_open) contact%velocity = contact%elastic + sense * contact%slip
        end if
        if (self%surface%traits%memory == 0) return
        if (self%surface%traits%memory == 1 .and. self%phase /= phase_capped) then
            state%r = 0.0_dp   ! R' is not needed, and costs a logarithm or two divisions
            load%pressure = 0.0_dp
        end if
        changes = self%surface%state_rates(state, load, contact%slip)
        call take_memory(self, changes, state, contact)
    end subroutine elastic_contact

    !> The traction's part of what a subloading surface carries when it slides fully.
    pure function carried_share(traction, full, most) result(share)
        real(dp), intent(in) :: traction, full   !! [F/L^2]
        real(dp), intent(in) :: most
        real(dp) :: share

        share = 0.0_dp
        if (full > 0.0_dp) share = min(most, traction / full)
    end function carried_share

    !> The same of a surface with phases of rest, most steps of which are short: without what such a
    !> block does not have.
    pure subroutine swinging_contact(self, y, contact, failed)
        class(slider_equations), intent(in) :: self
        real(dp), intent(in) :: y(controlled)
        type(contact_motion), intent(inout) :: contact
        logical, intent(out) :: failed
        type(law_state) :: changes
        real(dp) :: sense

        failed = .false.
        contact%traction = self%alpha * y(elastic)
        contact%velocity = y(velocity)
        sense = sign(1.0_dp, contact%traction)
        if (.not. abs(contact%traction) > 0.0_dp) sense = self%sense_of(y(velocity))
        if (self%phase == phase_slide) call slide(self, y, sense, contact%slip, failed)
        contact%elastic = y(velocity) - sense * contact%slip
        changes = self%surface%law%state_rates(law_state(mu=y(memory), r=0.0_dp), load_rates(&
            0.0_dp, 0.0_dp, self%alpha, 0.0_dp, 0.0_dp, .true.), contact%slip)
        contact%memory = changes%mu
    end subroutine swinging_contact

    !> Slip rate of such a surface; below 0, it is about to rest.
    pure subroutine slide(self, y, sense, rate, jumps)
        class(slider_equations), intent(in) :: self
        real(dp), intent(in) :: y(controlled)
        real(dp), intent(in) :: sense   !! of the slip in x
        real(dp), intent(out) :: rate   !! [L/T]
        logical, intent(out) :: jumps
        real(dp) :: carried, share

        carried = self%alpha * abs(y(elastic))
        share = carried_share(carried, y(memory) * self%constant_pressure &
            + self%surface%law%cohesion, 1.0_dp)
        call self%surface%law%slip_rate(law_state(mu=y(memory), r=share), load_rates(carried, &
            sense * self%alpha * y(velocity), self%alpha, self%constant_pressure, 0.0_dp, .true.), &
            rate, jumps)
    end subroutine slide

    !> Slip rate of a surface that rests as it would be while it slides: above 0, it is about to.
    pure function slip_tendency(self, y) result(rate)
        class(slider_equations), intent(in) :: self
        real(dp), intent(in) :: y(controlled)
        real(dp) :: rate   !! [L/T]
        logical :: jumps

        call slide(self, y, self%sense, rate, jumps)
    end function slip_tendency

    !> A contact whose spring has a damper beside it (section 16): the traction follows from the
    !> slip rate, and that from a balance.
    pure subroutine damped_contact(self, y, pull, v_drive, pressure, pressure_rate, contact, failed)
        class(slider_equations), intent(in) :: self
        real(dp), intent(in) :: y(controlled), pull, v_drive, pressure, pressure_rate
        type(contact_motion), intent(inout) :: contact
        logical, intent(out) :: failed
        type(damper_balance) :: balance
        type(load_rates) :: load
        type(law_state) :: state, changes
        real(dp) :: acceleration, without_slip

        state = law_state_of(self, y, pressure)
        balance = balance_at(self, y, pull)
        failed = .false.
        if (self%follows_share()) then
            if (self%phase /= phase_stick) contact%slip = (balance%push &
                - min(self%surface%tau_max, state%r * full_strength(self, y, pressure))) &
                / balance%drag
        else if (self%slides_damped()) then
            if (self%phase /= phase_stick) call slide_beside_damper(self, state, pressure, &
                balance, contact%slip, failed)
        else
            call slip_of(self%surface, state, pressure, balance, self%surface%tau_max, &
                contact%slip, failed)
        end if
        if (failed) return
        contact%traction = balance%sense * (balance%push - balance%drag * contact%slip)
        contact%elastic = (contact%traction - self%alpha * y(elastic)) / self%damper
        contact%velocity = contact%elastic + balance%sense * contact%slip
        if (self%mass > 0.0_dp) contact%velocity = y(velocity)
        if (self%surface%traits%memory == 0) return
        if (self%mass > 0.0_dp) then
            acceleration = (pull - self%damping * contact%velocity - self%area &
                * contact%traction) / self%mass
        else   ! of a block that sticks
            acceleration = (self%stiffness * (v_drive - contact%velocity) - self%area &
                * self%alpha * contact%elastic) / (self%damping + self%area * self%damper)
        end if
        without_slip = self%alpha * contact%velocity + self%damper * acceleration
        load = load_rates(abs(contact%traction), balance%sense * without_slip, self%alpha, &
            pressure, pressure_rate, .false.)
        if (self%follows_share()) state%r = max(state%r, self%least_share)
        changes = self%surface%state_rates(state, load, contact%slip)
        call take_memory(self, changes, state, contact)
        contact%ratio = 0.0_dp
        if (.not. self%follows_share()) return
        if (contact%slip > 0.0_dp .or. self%phase == phase_stick) contact%ratio = changes%r
        if (contact%slip < 0.0_dp) then   ! just before it sticks: as smooth as derivatives need it
            changes = self%surface%state_rates(state, load, -contact%slip)
            contact%ratio = -changes%r
        end if
    end subroutine damped_contact

    !> Slip rate beside a damper in a phase of sliding; below 0, a surface with a yield point is
    !> about to stick.
    pure subroutine slide_beside_damper(self, state, pressure, balance, rate, failed)
        class(slider_equations), intent(in) :: self
        type(law_state), intent(in) :: state
        real(dp), intent(in) :: pressure
        type(damper_balance), intent(inout) :: balance   !! in the sense of the phase, afterwards
        real(dp), intent(out) :: rate       !! [L/T]
        logical, intent(out) :: failed      !! there is none
        real(dp) :: resistance, by_rate

        if (self%surface%traits%onset == onset_gradual .and. self%phase == phase_slide) then
            call slip_of(self%surface, state, pressure, balance, huge(rate), rate, failed)
            return
        end if
        failed = .false.
        balance%push = self%sense * balance%sense * balance%push
        balance%sense = self%sense
        resistance = self%surface%tau_max
        if (self%phase == phase_slide) then
            call slip_of(self%surface, state, pressure, balance, resistance, rate, failed)
            if (failed .or. rate > 0.0_dp) return
            call self%surface%resistance_at(state, 0.0_dp, pressure, resistance, by_rate)
        end if
        rate = (balance%push - min(resistance, self%surface%tau_max)) / balance%drag
    end subroutine slide_beside_damper

    !> Is it a contact with a damper on a block with a mass, but for a subloading surface? Then it
    !> sticks and slides in phases, or creeps and slides at its cap: slip rates have kinks between
    !> these, sharp ones beside a stiff damper.
    pure function slides_damped(self) result(yes)
        class(slider_equations), intent(in) :: self
        logical :: yes

        yes = self%damper > 0.0_dp .and. self%mass > 0.0_dp .and. .not. self%follows_share()
    end function slides_damped

    !> Is it a subloading surface beside a damper? Then R follows the traction while that falls:
    !> the surface sticks. When it grows, the surface slides.
    pure function follows_share(self) result(follows)
        class(slider_equations), intent(in) :: self
        logical :: follows

        follows = self%damper > 0.0_dp .and. self%surface%traits%memory == 1
    end function follows_share

    !> Finds `least_share`: the slip to it is a small part of the tolerated error, counted by the
    !> slip that it takes to mobilise half of the strength.
    pure subroutine find_least_share(self, rtol)
        class(slider_equations), intent(inout) :: self
        real(dp), intent(in) :: rtol
        integer, parameter :: iterations = 30   !! each halves the distance at least
        real(dp), parameter :: small = 0.1_dp
        integer :: i

        self%least_share = 0.0_dp
        if (.not. self%follows_share()) return
        self%least_share = rtol
        do i = 1, iterations
            self%least_share = sqrt(self%least_share * small * rtol &
                * self%share_rate(self%least_share) / self%share_rate(0.5_dp))
        end do
    end subroutine find_least_share

    !> How fast R grows with slip beside a damper [1/L].
    pure function share_rate(self, r) result(rate)
        class(slider_equations), intent(in) :: self
        real(dp), intent(in) :: r
        real(dp) :: rate
        type(law_state) :: changes

        changes = self%surface%state_rates(law_state(mu=0.0_dp, r=max(r, self%least_share)), &
            load_rates(0.0_dp, 0.0_dp, self%alpha, 0.0_dp, 0.0_dp, .true.), 1.0_dp)
        rate = changes%r
    end function share_rate

    !> What a subloading surface carries when it slides fully [F/L^2].
    pure function full_strength(self, y, pressure) result(full)
        class(slider_equations), intent(in) :: self
        real(dp), intent(in) :: y(controlled)
        real(dp), intent(in) :: pressure
        real(dp) :: full

        full = y(memory) * pressure + self%surface%law%cohesion
    end function full_strength

    !> What pushes the contact, and what a slip rate takes of that. Without mass the slider's damper
    !> is in it, for the block's velocity goes with the slip rate.
    pure function balance_at(self, y, pull) result(balance)
        class(slider_equations), intent(in) :: self
        real(dp), intent(in) :: y(controlled)
        real(dp), intent(in) :: pull   !! of the drive spring [F]
        type(damper_balance) :: balance
        real(dp) :: push, part

        push = self%alpha * y(elastic) + self%damper * y(velocity)
        balance%drag = self%damper
        if (.not. self%mass > 0.0_dp) then
            part = self%damping / self%damper
            push = (pull + part * self%alpha * y(elastic)) / (part + self%area)
            balance%drag = self%damping / (part + self%area)
        end if
        balance%sense = self%sense_of(push)
        balance%push = abs(push)
    end function balance_at

    !> Rates of what the law remembers.
    pure subroutine take_memory(self, changes, state, contact)
        class(slider_equations), intent(in) :: self
        type(law_state), intent(in) :: changes, state
        type(contact_motion), intent(inout) :: contact

        if (self%surface%traits%memory == 1) then
            contact%memory = changes%mu
            if (self%phase == phase_capped) contact%ratio = changes%r
        else if (self%surface%traits%logarithmic) then
            contact%memory = changes%r / state%r
        else
            contact%memory = changes%r
        end if
    end subroutine take_memory

    !> Velocity of a block that slides on a law with a yield point: its own, or without mass that at
    !> which the damper and the resistance balance the drive spring [L/T].
    pure subroutine find_velocity(self, y, pressure, v, failed)
        class(slider_equations), intent(in) :: self
        real(dp), intent(in) :: y(controlled)
        real(dp), intent(in) :: pressure   !! [F/L^2]
        real(dp), intent(out) :: v         !! [L/T]
        logical, intent(out) :: failed     !! there is no such velocity
        real(dp) :: push

        failed = .false.
        v = y(velocity)
        if (self%mass > 0.0_dp) return
        push = self%sense * self%stiffness * y(extension) / self%area
        call slip_of(self%surface, law_state_of(self, y, pressure), pressure, &
            damper_balance(self%sense, push, self%damping / self%area), self%surface%tau_max, v, &
            failed)
        if (.not. (failed .or. v > 0.0_dp)) then   ! pushed back: where slip ends is seen by that
            v = (push - min(strength(self, y, pressure), self%surface%tau_max)) * self%area &
                / self%damping
        end if
        v = self%sense * v
    end subroutine find_velocity

    !> Friction that falls as soon as it slides leaves the spring no rate of its own: the traction
    !> follows the block's velocity.
    pure subroutine dropping_contact(self, y, pull, v_drive, pressure, pressure_rate, contact, &
        failed)
        class(slider_equations), intent(in) :: self
        real(dp), intent(in) :: y(controlled), pull, v_drive, pressure, pressure_rate
        type(contact_motion), intent(inout) :: contact
        logical, intent(out) :: failed
        real(dp) :: v, resistance, by_rate, acceleration

        call find_velocity(self, y, pressure, v, failed)
        if (failed) return
        contact%velocity = v
        call self%surface%resistance_at(law_state_of(self, y, pressure), max(0.0_dp, &
            self%sense * v), pressure, resistance, by_rate)
        if (self%sense * v <= 0.0_dp) by_rate = 0.0_dp
        if (resistance > self%surface%tau_max) then
            resistance = self%surface%tau_max
            by_rate = 0.0_dp
            contact%elastic = 0.0_dp
        else if (pressure > 0.0_dp) then
            contact%elastic = self%sense * (resistance - self%surface%cohesion) / pressure &
                * pressure_rate
        end if
        contact%traction = self%sense * resistance
        if (self%mass > 0.0_dp) then
            acceleration = (pull - self%damping * v - self%area * contact%traction) / self%mass
        else
            acceleration = (self%stiffness * (v_drive - v) - self%area * contact%elastic) &
                / (self%damping + self%area * by_rate)
        end if
        contact%elastic = (contact%elastic + by_rate * acceleration) / self%alpha
        contact%slip = self%sense * (v - contact%elastic)
    end subroutine dropping_contact

    !> A contact without a spring: the block's velocity is the slip rate.
    pure subroutine rigid_contact(self, y, pull, pressure, pressure_rate, contact, failed)
        class(slider_equations), intent(in) :: self
        real(dp), intent(in) :: y(controlled), pull, pressure, pressure_rate
        type(contact_motion), intent(inout) :: contact
        logical, intent(out) :: failed
        type(load_rates) :: load
        type(law_state) :: state
        real(dp) :: sense, by_rate

        failed = .false.
        state = law_state_of(self, y, pressure)
        sense = self%sense
        if (self%phase == phase_stick) then
            contact%traction = pull / self%area
        else
            contact%velocity = y(velocity)
            if (self%surface%traits%onset == onset_gradual .and. self%phase /= phase_capped) sense &
                = self%sense_of(y(velocity))   ! or a step that ends a cap would go beyond, and back
            if (.not. self%mass > 0.0_dp) then
                if (self%surface%traits%onset == onset_gradual) sense = self%sense_of(pull)
                call slip_of(self%surface, state, pressure, damper_balance(sense, sense * pull &
                    / self%area, self%damping / self%area), self%surface%tau_max, contact%slip, &
                    failed)
                if (failed) return
                contact%velocity = sense * contact%slip
            end if
            contact%slip = sense * contact%velocity
            call self%surface%resistance_at(state, max(0.0_dp, contact%slip), pressure, &
                contact%traction, by_rate)
            contact%traction = sense * min(contact%traction, self%surface%tau_max)
            if (self%phase == phase_capped) contact%traction = sense * self%surface%tau_max
        end if
        if (self%surface%traits%memory == 0) return
        load = load_rates(abs(contact%traction), 0.0_dp, 1.0_dp, pressure, pressure_rate, .false.)
        call take_memory(self, self%surface%state_rates(state, load, contact%slip), state, &
            contact)
    end subroutine rigid_contact

    !> Does the surface slip far faster than the block moves? Then friction that falls lets the
    !> contact spring unload by itself, ever faster, without inertia. A block without mass and
    !> damper moves with the surface: then, far faster than the drive.
    pure function runs_away(self, t, dy, fastest) result(yes)
        class(slider_equations), intent(in) :: self
        real(dp), intent(in) :: t              !! [T]
        real(dp), intent(in) :: dy(unknowns)   !! rates there
        real(dp), intent(in) :: fastest        !! velocity of the drive in the programme [L/T]
        logical :: yes
        real(dp), parameter :: far = 100.0_dp
        real(dp) :: moved

        moved = fastest
        if (max(self%mass, self%damping) > 0.0_dp) moved = max(moved, &
            abs(self%drive%drive_velocity(t, self%piece) - dy(extension)))
        yes = dy(slip) > far * moved .and. .not. self%rigid
    end function runs_away

    !> Has the contact no spring, or one that is left out?
    pure function without_spring(self) result(yes)
        class(slider_equations), intent(in) :: self
        logical :: yes

        yes = self%rigid .or. self%by_velocity .and. self%phase == phase_slide
    end function without_spring

    !> Has the block neither mass nor damper, so that its springs alone tell where it is?
    pure function springs_alone(self) result(yes)
        class(slider_equations), intent(in) :: self
        logical :: yes

        yes = .not. (self%mass > 0.0_dp .or. self%damping > 0.0_dp)
    end function springs_alone

    !> Is the velocity of a block without mass an unknown? It is a small difference of forces: under
    !> a slow drive their tolerated errors would turn it back and forth, and a subloading surface
    !> slips each time that it is loaded.
    pure function keeps_velocity(self) result(keeps)
        class(slider_equations), intent(in) :: self
        logical :: keeps

        keeps = self%damping > 0.0_dp .and. self%phase /= phase_open .and. .not. (self%mass &
            > 0.0_dp .or. self%damper > 0.0_dp .or. self%rigid .or. self%across%free() &
            .or. self%surface%traits%stiff .or. self%surface%traits%onset == onset_drops)
    end function keeps_velocity

    !> Is it a block with a mass on a contact that creeps? Without a contact spring its velocity and
    !> its traction tell each other, and nearly so beside one if the traction is next to nothing.
    pure function creeps_along(self) result(creeps)
        class(slider_equations), intent(in) :: self
        logical :: creeps

        creeps = self%surface%traits%stiff .and. self%phase == phase_slide .and. self%mass &
            > 0.0_dp .and. .not. self%damper > 0.0_dp
    end function creeps_along

    !> Is its velocity that of its slip under the traction? Then that is an unknown, in the place of
    !> the elastic displacement: slip rates go through decades.
    pure function follows_traction(self) result(follows)
        class(slider_equations), intent(in) :: self
        logical :: follows

        follows = self%rigid .and. self%creeps_along() .and. .not. self%by_velocity
    end function follows_traction

    !> A rigid contact that creeps, on a block with a mass: `traction(v, theta, p)` changes as its
    !> arguments do.
    pure subroutine following_contact(self, y, pull, pressure, pressure_rate, contact)
        class(slider_equations), intent(in) :: self
        real(dp), intent(in) :: y(controlled), pull, pressure, pressure_rate
        type(contact_motion), intent(inout) :: contact
        type(load_rates) :: load
        type(law_state) :: state
        real(dp) :: sense, tau, by_rate, by_memory, acceleration
        logical :: jumps

        contact%traction = self%alpha * y(elastic)
        sense = self%sense_of(contact%traction)
        state = law_state_of(self, y, pressure)
        load = load_rates(abs(contact%traction), 0.0_dp, 1.0_dp, pressure, pressure_rate, .false.)
        call self%surface%slip_rate(state, load, contact%slip, jumps)
        contact%velocity = sense * contact%slip
        call take_memory(self, self%surface%state_rates(state, load, contact%slip), state, &
            contact)
        call self%surface%resistance_at(state, contact%slip, pressure, tau, by_rate)
        by_memory = self%surface%law%resistance_by_memory(state, contact%slip, pressure)
        acceleration = (pull - self%damping * contact%velocity - self%area * contact%traction) &
            / self%mass
        contact%elastic = (by_rate * acceleration + sense * (tau / pressure * pressure_rate &
            + by_memory * contact%memory)) / self%alpha
    end subroutine following_contact

    !> What the law knows of the contact.
    pure function law_state_of(self, y, pressure) result(state)
        class(slider_equations), intent(in) :: self
        real(dp), intent(in) :: y(controlled)
        real(dp), intent(in) :: pressure   !! [F/L^2]
        type(law_state) :: state
        type(damper_balance) :: balance
        real(dp) :: carried

        state = law_state(mu=0.0_dp, r=0.0_dp)
        select case (self%surface%traits%memory)
        case (1)
            state%mu = y(memory)
            if (self%phase == phase_capped .or. self%damper > 0.0_dp .and. self%phase &
                /= phase_stick) then
                state%r = min(1.0_dp, max(y(ratio), 0.0_dp))
            else
                carried = self%alpha * abs(y(elastic))
                if (self%damper > 0.0_dp) then
                    balance = balance_at(self, y, self%pull(y))
                    carried = balance%push
                end if
                state%r = carried_share(carried, full_strength(self, y, pressure), 1.0_dp)
            end if
        case (2)
            state%r = y(memory)
            ! stages of a step that is going to be refused may be anywhere
            if (self%surface%traits%logarithmic) state%r = exp(min(max(y(memory), &
                -most_logarithm), most_logarithm))
        case default   ! nothing
        end select
    end function law_state_of

    !> Traction at which a law with a yield point starts to slip, but for its cap.
    pure function strength(self, y, pressure) result(traction)
        class(slider_equations), intent(in) :: self
        real(dp), intent(in) :: y(controlled)
        real(dp), intent(in) :: pressure   !! [F/L^2]
        real(dp) :: traction               !! [F/L^2]
        real(dp) :: by_rate

        call self%surface%resistance_at(law_state_of(self, y, pressure), 0.0_dp, pressure, &
            traction, by_rate)
    end function strength

    !> Traction that the contact carries [F/L^2].
    pure function traction(self, t, y) result(tau)
        class(slider_equations), intent(in) :: self
        real(dp), intent(in) :: t   !! [T]
        real(dp), intent(in) :: y(controlled)
        real(dp) :: tau
        type(contact_motion) :: contact
        real(dp) :: v_drive, pressure, pressure_rate
        logical :: failed

        tau = 0.0_dp
        if (self%phase == phase_open) return
        tau = self%alpha * y(elastic)
        if (.not. (without_spring(self) .or. self%damper > 0.0_dp)) return
        if (self%follows_traction()) return
        call inputs(self, t, y, v_drive, pressure, pressure_rate)
        if (self%damper > 0.0_dp) then
            call damped_contact(self, y, self%pull(y), v_drive, pressure, pressure_rate, contact, &
                failed)
        else
            call rigid_contact(self, y, self%pull(y), pressure, pressure_rate, contact, failed)
        end if
        tau = contact%traction
    end function traction

end module slider_rates
