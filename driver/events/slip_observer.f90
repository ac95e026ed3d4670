!> Looks for slip events in a run and adds them up, piece by piece of the programme, with the range
!> of the friction in each piece.
module slip_observer
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use archive_file, only : archive
    use friction_course, only : course
    use friction_mod, only : facts => law_facts, friction_facts, onset_gradual, statev_mu, &
        statev_status
    use law_facts, only : strength_at
    use loading_programme, only : programme
    use piece_measures, only : friction_range
    use run_observer, only : observer, step_news
    use run_outcome, only : event_totals
    use run_settings, only : settings
    use slider_system, only : slider_state
    use slip_events, only : event_finder, moment, slip_event, turning_point
    use step_sums, only : block_sums
    implicit none
    private

    public :: slip_watch

    real(dp), parameter :: round_off = 1.0e-6_dp   !! of times, as a part of a step
    real(dp), parameter :: thin = 1.0e-3_dp        !! part of the largest normal traction of a piece
                                                   !! below which friction over it tells nothing

    type, extends(observer) :: slip_watch
        type(programme) :: drive
        real(dp) :: stiffness = 0.0_dp                 !! of the drive spring [F/L]
        real(dp) :: damping = 0.0_dp                   !! of a block [F T/L]
        type(event_finder) :: finder
        real(dp) :: area = 1.0_dp                      !! contact area of a block [L^2]
        real(dp) :: coefficient = 0.0_dp               !! of static friction
        type(event_totals), allocatable :: pieces(:)
        type(friction_range), allocatable :: friction(:)   !! in the pieces
        integer, allocatable :: sense(:)               !! of the loading in the pieces, 1 or -1
        real(dp), allocatable :: least_load(:)         !! normal traction that tells friction there
        logical :: prescribed = .true.                 !! the normal traction, not an answer
        logical :: elastic = .true.                    !! there is a contact spring
        logical :: rigid = .false.                     !! there is none, and slip stops at once
        logical :: one_block = .true.
        logical :: jumps = .false.                     !! friction drops as slip begins
        type(facts) :: law
        integer :: events = 0
        real(dp), allocatable :: onsets(:)             !! of the events, and room for more [T]
        real(dp) :: peak_velocity = 0.0_dp             !! [L/T]
    contains
        procedure :: prepare, see, visit
        procedure, private :: measure
    end type slip_watch

contains

    subroutine prepare(self, run)
        class(slip_watch), intent(inout) :: self
        type(settings), intent(in) :: run

        self%drive = run%drive
        self%stiffness = run%stiffness
        self%damping = run%damping
        self%finder%drop = run%event_force()
        self%finder%slip_rate = run%event_slip_rate
        self%finder%stiffness = run%stiffness
        self%finder%impedance = max(run%damping, sqrt(run%stiffness * run%mass))
        self%finder%inertia = run%mass > 0.0_dp
        self%law = friction_facts(run%props)
        self%coefficient = self%law%typical_coefficient
        call self%finder%give_sense(run%loading_sense(), abs(run%drive%first_velocity()))
        self%area = run%area
        allocate (self%pieces(run%drive%listed), self%friction(run%drive%listed), self%onsets(0))
        self%sense = senses(run%drive, run%loading_sense())
        self%prescribed = .not. run%across%free()
        self%elastic = .not. run%rigid_contact
        self%rigid = run%rigid_contact .and. self%law%traits%onset /= onset_gradual
        self%one_block = run%chain%n_blocks == 1
        self%jumps = run%adaptive .and. .not. (run%newmark .or. run%rigid_contact) .and. &
            run%one_by_itself() .and. self%law%traits%onset /= onset_gradual .and. .not. &
            self%law%damping > 0.0_dp .and. max(run%mass, run%damping) > 0.0_dp
        ! the friction force has the error of a step, part of what the largest load makes of it
        self%least_load = max(thin, min(0.1_dp, 100.0_dp * run%rtol)) * largest_loads(run%drive)
    end subroutine prepare

    !> The largest normal traction of each piece.
    pure function largest_loads(drive) result(loads)
        type(programme), intent(in) :: drive
        real(dp) :: loads(drive%listed)   !! [F/L^2]
        integer :: i

        loads = drive%normal(:drive%listed)
        do i = 1, min(drive%listed, size(drive%start) - 1)
            loads(i) = max(loads(i), loads(i) + drive%normal_rate(i) * (drive%start(i + 1) &
                - drive%start(i)))
        end do
        loads = loads + drive%amplitude
    end function largest_loads

    !> In a hold the sense is that of the piece before.
    pure function senses(drive, first) result(list)
        type(programme), intent(in) :: drive
        integer, intent(in) :: first   !! sense of the loading at the start
        integer :: list(drive%listed)
        integer :: sense, i

        sense = first
        do i = 1, drive%listed
            if (drive%velocity(i) > 0.0_dp) sense = 1
            if (drive%velocity(i) < 0.0_dp) sense = -1
            list(i) = sense
        end do
    end function senses

    subroutine see(self, old, new, news)
        class(slip_watch), intent(inout) :: self
        type(slider_state), intent(in) :: old, new
        type(step_news), intent(inout) :: news
        type(moment) :: before, now
        integer :: i, k

        i = self%drive%piece(old%time + round_off * (new%time - old%time))
        before = seen(self, old, news%sums, 1, i)
        now = seen(self, new, news%sums, 2, i)
        call self%finder%follow(before, now, news%last, news%slip_events)
        do k = 1, size(news%slip_events)
            i = min(self%drive%piece(news%slip_events(k)%onset), self%drive%listed)
            call add_event(self%pieces(i), news%slip_events(k), self%drive%start(i))
            if (self%events == size(self%onsets)) self%onsets = [self%onsets, self%onsets, 0.0_dp]
            self%events = self%events + 1
            self%onsets(self%events) = news%slip_events(k)%onset
            self%peak_velocity = max(self%peak_velocity, news%slip_events(k)%peak_velocity)
        end do
        self%peak_velocity = max(self%peak_velocity, news%sums%fastest, abs(self%finder%turning))
        if (self%drive%listed > 1) call self%measure(old, new, before, now)
    end subroutine see

    !> A step belongs to the piece that it ends in, or that ends with it. The first one of a piece
    !> gives it its start, too; but what friction is after a sudden load is seen at the step's end,
    !> unless nothing has slipped or a contact spring carries it. A block without contact spring
    !> slides against another force than what held it before a sudden load, or holds it once it has
    !> come to rest.
    pure subroutine measure(self, old, new, before, now)
        class(slip_watch), intent(inout) :: self
        type(slider_state), intent(in) :: old, new
        type(moment), intent(in) :: before, now   !! the same two
        real(dp) :: aside, between, load, way
        integer :: i
        logical :: turns, slides

        aside = round_off * (new%time - old%time)
        if (aside < 2.0_dp * spacing(new%time)) aside = new%time - old%time   ! within one piece
        i = min(self%drive%listed, self%drive%piece(new%time - aside))
        if (max(old%normal, new%normal) <= self%least_load(i)) return
        slides = now%slip > before%slip
        way = way_of(old, new)
        if (.not. self%friction(i)%seen .and. old%time > self%drive%start(i) - aside) then
            load = old%normal
            if (self%prescribed) load = self%drive%normal_traction(old%time, i)
            if (load > self%least_load(i)) then
                if (is_gradual(self%drive, i) .or. keeps_traction(self) .or. .not. &
                    (self%prescribed .and. slides)) then
                    call self%friction(i)%take(over_load(self, i, mean_of(old), load))
                else if (self%rigid .and. old%normal > 0.0_dp) then
                    call self%friction(i)%take(over_load(self, i, sliding(self, old, load, way), &
                        load))
                end if
            end if
        end if
        if (load_changes(self, i)) call find_extremes(self, i, old, new, before, now)
        if (new%normal <= self%least_load(i)) return
        if (slides .and. drops(self, i, old)) call self%friction(i)%take(over_load(self, i, &
            held(self, old, new), new%normal))
        call find_turn(self, i, old, new, before, now, between, turns)
        if (turns) call self%friction(i)%take(between)
        if (self%rigid .and. slides .and. .not. abs(new%v(1)) > 0.0_dp) then
            call self%friction(i)%take(over_load(self, i, sliding(self, new, new%normal, way), &
                new%normal))
        end if
        call self%friction(i)%take(over_load(self, i, mean_of(new), new%normal))
    end subroutine measure

    !> Has a step with slip begun with a contact that stuck? Then friction dropped at its end.
    pure logical function drops(self, i, old) result(yes)
        class(slip_watch), intent(in) :: self
        integer, intent(in) :: i   !! piece
        type(slider_state), intent(in) :: old
        integer, parameter :: sticks = 1

        yes = self%jumps
        if (yes) yes = nint(old%statev(1, statev_status)) == sticks
        if (yes) yes = old%time > self%drive%start(i) .or. is_gradual(self%drive, i)
    end function drops

    !> The friction of such a step before: the contact spring went with the block [F].
    pure real(dp) function held(self, old, new) result(force)
        class(slip_watch), intent(in) :: self
        type(slider_state), intent(in) :: old, new

        force = old%friction(1) + self%area * self%law%alpha_t * (new%x(1) - old%x(1))
    end function held

    !> Does the normal traction of a block change within a piece?
    pure logical function load_changes(self, i) result(yes)
        class(slip_watch), intent(in) :: self
        integer, intent(in) :: i   !! piece

        yes = self%one_block .and. (self%drive%amplitude > 0.0_dp &
            .or. abs(self%drive%normal_rate(i)) > 0.0_dp .or. .not. self%prescribed)
    end function load_changes

    !> Friction over a normal traction that changes may be largest or least within the step.
    pure subroutine find_extremes(self, i, old, new, before, now)
        class(slip_watch), intent(inout) :: self
        integer, intent(in) :: i                  !! piece
        type(slider_state), intent(in) :: old, new
        type(moment), intent(in) :: before, now   !! the same two
        type(course) :: step
        real(dp) :: range(2)

        step%start = old%time
        step%length = new%time - old%time
        step%slides = now%slip > before%slip
        step%prescribed = self%prescribed
        step%load = [old%normal, new%normal]
        if (self%prescribed) step%load(1) = self%drive%normal_traction(old%time, i)
        if (step%slides .and. abs(step%load(1) - old%normal) > round_off * new%normal .and. .not. &
            self%rigid) return   ! a sudden load: what comes of it at once is not known
        step%load_rate = -self%law%alpha_n * [old%v_n, new%v_n]
        step%law = self%law
        step%yields = .not. self%law%traits%stiff
        step%force = self%sense(i) * [old%friction(1), new%friction(1)] / self%area
        if (step%slides .and. drops(self, i, old)) then
            step%slides = .false.
            step%force(2) = self%sense(i) * held(self, old, new) / self%area
        end if
        if (step%slides .and. self%law%traits%stiff) step%slides = follows_load(self, step, i, &
            now%slip - before%slip)
        step%coefficient = [old%statev(1, statev_mu), new%statev(1, statev_mu)]
        step%rate = self%sense(i) * [before%rate, now%rate] / self%area
        if (self%elastic) step%rate = self%sense(i) * (self%law%alpha_t * [old%v, new%v] &
            + self%law%damping * [old%a, new%a])
        if (self%rigid) then
            if (step%slides) step%force = self%sense(i) * sign(strength_at(self%law, &
                step%coefficient, step%load), way_of(old, new))
        else if (self%law%traits%stiff) then
            where (step%load > 0.0_dp) step%coefficient = max(0.0_dp, abs(step%force) &
                - self%law%cohesion) / step%load
        end if
        if (self%law%traits%stiff .or. .not. self%finder%inertia) step%rate = monotonic(step%rate, &
            (step%force(2) - step%force(1)) / step%length)
        range = [huge(range), -huge(range)]
        if (self%friction(i)%seen) range = [self%friction(i)%least, self%friction(i)%peak]
        call step%extremes(self%drive, i, self%least_load(i), range)
        call self%friction(i)%widen(range)
    end subroutine find_extremes

    !> Is the traction that of the contact spring, also under a load that changes at once?
    pure logical function keeps_traction(self) result(yes)
        class(slip_watch), intent(in) :: self

        yes = self%law%traits%stiff .and. self%elastic .and. .not. self%law%damping > 0.0_dp
    end function keeps_traction

    !> Does friction that creeps follow the load of a step? Not with less slip than it takes to let
    !> the spring that holds the traction change with the load.
    pure logical function follows_load(self, step, i, slip) result(follows)
        class(slip_watch), intent(in) :: self
        type(course), intent(in) :: step
        integer, intent(in) :: i         !! piece
        real(dp), intent(in) :: slip     !! in the step [L]
        real(dp) :: loads(3), stiffness

        loads = [step%load, step%load(2)]
        if (self%prescribed) loads(3) = self%drive%normal_traction(step%start + 0.5_dp &
            * step%length, i)
        stiffness = merge(self%law%alpha_t, self%stiffness / self%area, self%elastic)
        follows = slip * stiffness * maxval(loads) > maxval(abs(step%force)) * (maxval(loads) &
            - minval(loads))
    end function follows_load

    !> A number with the sense in which a block moves in a step, also less than its place can tell.
    pure real(dp) function way_of(old, new) result(way)
        type(slider_state), intent(in) :: old, new

        way = old%v(1) + new%v(1)
        if (.not. abs(way) > 0.0_dp) way = new%x(1) - old%x(1)
    end function way_of

    !> Rates with which a cubic does not turn between its ends. Those of a block without mass may be
    !> of what it does after the step: its velocity jumps where a phase of the contact ends.
    elemental real(dp) function monotonic(rate, mean) result(limited)
        real(dp), intent(in) :: rate
        real(dp), intent(in) :: mean   !! between the ends

        limited = sign(min(max(0.0_dp, sign(1.0_dp, mean) * rate), 3.0_dp * abs(mean)), mean)
    end function monotonic

    !> Where the drive spring turns within a step, friction does, unless inertia or a damper has a
    !> say in it.
    pure subroutine find_turn(self, i, old, new, before, now, friction, found)
        class(slip_watch), intent(in) :: self
        integer, intent(in) :: i                  !! piece
        type(slider_state), intent(in) :: old, new
        type(moment), intent(in) :: before, now   !! the same two
        real(dp), intent(out) :: friction         !! there [-]
        logical, intent(out) :: found
        real(dp), parameter :: no_say = 0.5_dp   !! part of what the turn has beyond the ends
        type(moment) :: turn
        real(dp) :: rest(2), damped(2)   ! of the spring's force [F]

        friction = 0.0_dp
        call turning_point(before, now, turn, found)
        found = found .and. .not. abs(new%normal - old%normal) > 0.0_dp
        if (.not. found) return
        rest = [before%force - mean_of(old), now%force - mean_of(new)]
        ! a block that swings against steady friction has the same rest at two times about the turn
        damped = self%damping * [before%velocity, now%velocity]
        found = maxval(abs(rest - damped)) + abs(damped(2) - damped(1)) <= no_say &
            * min(abs(turn%force - before%force), abs(turn%force - now%force))
        friction = over_load(self, i, turn%force - rest(1) - (rest(2) - rest(1)) * (turn%time &
            - old%time) / (new%time - old%time), new%normal)
    end subroutine find_turn

    !> Friction of a block that slides without contact spring, from its friction coefficient [F].
    pure real(dp) function sliding(self, state, load, way) result(force)
        class(slip_watch), intent(in) :: self
        type(slider_state), intent(in) :: state
        real(dp), intent(in) :: load   !! normal traction [F/L^2]
        real(dp), intent(in) :: way    !! with the sense of its slip

        force = sign(self%area * strength_at(self%law, state%statev(1, statev_mu), load), way)
    end function sliding

    !> Friction coefficient in the sense of the loading of a piece [-].
    pure real(dp) function over_load(self, i, force, load) result(friction)
        class(slip_watch), intent(in) :: self
        integer, intent(in) :: i          !! piece
        real(dp), intent(in) :: force     !! of friction [F]
        real(dp), intent(in) :: load      !! normal traction [F/L^2]

        friction = force / (self%area * load)
        if (abs(friction) > 0.0_dp) friction = self%sense(i) * friction   ! no -0 in a table
    end function over_load

    pure function mean_of(state) result(friction)
        type(slider_state), intent(in) :: state
        real(dp) :: friction   !! mean over the blocks [F]

        friction = sum(state%friction) / size(state%friction)
    end function mean_of

    !> Does a piece start with the normal traction that the one before ends with?
    pure logical function is_gradual(drive, i) result(yes)
        type(programme), intent(in) :: drive
        integer, intent(in) :: i   !! piece
        real(dp), parameter :: round_off = 1.0e-12_dp   !! part
        real(dp) :: before, after

        yes = i == 1
        if (yes) return
        before = drive%normal_traction(drive%start(i), i - 1)
        after = drive%normal_traction(drive%start(i), i)
        yes = abs(after - before) <= round_off * max(before, after)
    end function is_gradual

    !> What the finder looks at, as means over the blocks.
    pure type(moment) function seen(self, state, sums, k, i) result(now)
        class(slip_watch), intent(in) :: self
        type(slider_state), intent(in) :: state
        type(block_sums), intent(in) :: sums   !! over the blocks in a step
        integer, intent(in) :: k   !! 1: the state at its start, 2: at its end
        integer, intent(in) :: i   !! piece of the programme
        real(dp) :: means(3)       !! over the blocks: velocity, force, slip

        means = [sums%velocity(k), sums%spring(k), sums%slip(k)]
        if (size(state%x) > 1) means = means / size(state%x)
        now = moment(state%time, means(2), means(3), means(1), self%stiffness &
            * (self%drive%drive_velocity(state%time, i) - means(1)), state%drive, self%area &
            * self%coefficient * max(0.0_dp, self%drive%normal_traction(state%time, i)))
        if (self%one_block) now%acceleration = state%a(1)
    end function seen

    !> Counts an event in the piece of the programme that starts at `piece_start`. A recurrence time
    !> that began in the piece before says nothing about either.
    pure subroutine add_event(totals, event, piece_start)
        type(event_totals), intent(inout) :: totals
        type(slip_event), intent(in) :: event
        real(dp), intent(in) :: piece_start

        totals%events = totals%events + 1
        totals%force_drop = totals%force_drop + event%force_drop
        totals%peak_velocity = max(totals%peak_velocity, event%peak_velocity)
        if (event%first .or. event%onset - event%recurrence < piece_start) return
        totals%recurrences = totals%recurrences + 1
        totals%period = totals%period + event%recurrence
    end subroutine add_event

    subroutine visit(self, file)
        class(slip_watch), intent(inout) :: self
        type(archive), intent(inout) :: file
        integer :: i

        call self%finder%visit(file)
        do i = 1, size(self%pieces)
            call self%pieces(i)%visit(file)
            call self%friction(i)%visit(file)
        end do
        self%onsets = self%onsets(:self%events)
        call file%visit_list(self%onsets)
        self%events = size(self%onsets)
        call file%visit(self%peak_velocity)
    end subroutine visit

end module slip_observer
