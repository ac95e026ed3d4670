!> Finds slip events in the force of the drive spring: falls in the sense of the loading, in which
!> the block slips faster than the drive can account for.
!>
!> A fall goes from a peak to a trough and is over when the force has risen again, by `drop` or so,
!> and by a twentieth of the fall, so that ringing does not divide it. It is an event if it
!> is larger than `drop` and the slip rate in it exceeds `slip_rate`, or without that a multiple of
!> what the loading accounts for since the peak: the drive's largest speed, and that at which the
!> block follows a normal traction that falls. In a hold the drive counts as fast as before.
!> Everything is looked at in the sense of the loading: a mirrored motion has the same events.
!>
!> Where a fall goes on slowly - into steady sliding - the event ends when that has lasted as long
!> as the fall before. This moment, and the one from which on slip is slow, are found between the
!> steps: mean slip rates are those of the middles of the steps.
!>
!> A force that does not change but for round-off is a plateau: an event begins at the end of one,
!> and is over at the start of one.
!>
!> The sense turns once the drive has come back by so much that the force could change by `drop`;
!> meanwhile, behind the place that the drive has reached, nothing counts.
module slip_events
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use archive_file, only : archive
    implicit none
    private

    public :: cubic, event_finder, moment, slip_event, turning_point

    !> A harmonic oscillation that just sticks reaches twice the drive's speed, forced modulation of
    !> stable sliding a little more than once.
    real(dp), parameter :: fast = 1.5_dp
    !> Rise after a fall that ends it: `drop`, but at least and at most these parts of the fall.
    real(dp), parameter :: least_rise = 0.05_dp, most_rise = 0.2_dp
    real(dp), parameter :: round_off = 1.0e-3_dp   !! part of the slack that is no way back
    real(dp), parameter :: mostly = 0.5_dp         !! part of the block's way in a fall that is slip

    !> What the finder looks at in one instant.
    type :: moment
        real(dp) :: time = 0.0_dp       !! [T]
        real(dp) :: force = 0.0_dp      !! of the drive spring [F]
        real(dp) :: slip = 0.0_dp       !! accumulated [L]
        real(dp) :: velocity = 0.0_dp   !! of the block [L/T]
        real(dp) :: rate = 0.0_dp       !! of the force [F/T]
        real(dp) :: drive = 0.0_dp      !! position of the spring's far end [L]
        real(dp) :: holds = 0.0_dp      !! static friction force under the normal traction [F]
        real(dp) :: acceleration = 0.0_dp   !! of the block, if it is known [L/T^2]
    contains
        procedure, private :: visit => visit_moment, mirrored
    end type moment

    !> Magnitudes are positive, whichever way the drive goes.
    type :: slip_event
        real(dp) :: onset = 0.0_dp            !! time of the peak force [T]
        real(dp) :: duration = 0.0_dp         !! from peak to trough [T]
        real(dp) :: force_drop = 0.0_dp       !! [F]
        real(dp) :: slip = 0.0_dp             !! [L]
        real(dp) :: peak_velocity = 0.0_dp    !! [L/T]
        real(dp) :: recurrence = 0.0_dp       !! onset less the onset of the event before [T]
        logical :: first = .true.             !! no event before: no recurrence time
    contains
        procedure, private :: visit => visit_event
    end type slip_event

    type :: event_finder
        real(dp) :: drop = 0.0_dp          !! smallest fall and rise that count [F]
        real(dp) :: slip_rate = 0.0_dp     !! that is fast [L/T]; 0: by the drive's speed
        real(dp) :: stiffness = 1.0_dp     !! of the drive spring [F/L]
        real(dp) :: impedance = 0.0_dp     !! force that gives the block a velocity [F T/L]
        logical :: inertia = .false.       !! the block's velocity does not jump
        real(dp) :: speed = 0.0_dp         !! of the drive when it last moved [L/T]
        real(dp) :: turning = 0.0_dp       !! velocity of the block where it is largest or least in
                                           !! this step; if at the ends, the first one [L/T]
        integer, private :: sense = 1      !! of the loading, 1 or -1
        logical, private :: started = .false.
        real(dp), private :: reached = 0.0_dp     !! farthest place of the drive in that sense [L]
        real(dp), private :: change = 0.0_dp      !! of the force in the step before [F]
        type(moment), private :: peak = moment(), trough = moment()   !! since the last turn
        real(dp), private :: fastest = 0.0_dp     !! largest velocity since the peak [L/T]
        real(dp), private :: slipping = 0.0_dp    !! largest slip rate since the peak [L/T]
        real(dp), private :: driving = 0.0_dp     !! largest speed of the drive since the peak [L/T]
        real(dp), private :: yielding = 0.0_dp    !! the same of what friction that falls with the
                                                  !! normal traction lets go [L/T]
        real(dp), private :: held = 0.0_dp        !! static friction force a step ago [F]
        type(slip_event), private :: current = slip_event()           !! the fall so far
        logical, private :: is_event = .false.    !! it was fast enough to be an event
        real(dp), private :: fast_until = 0.0_dp  !! it was so at this time, if ever [T]
        real(dp), private :: rate = 0.0_dp        !! slip rate in the step before [L/T]
        real(dp), private :: middle = 0.0_dp      !! of that step [T]
        type(moment), private :: since = moment() !! start of this step, in the sense of the loading
        logical, private :: any_before = .false.
        real(dp), private :: last_onset = 0.0_dp  !! of the event before [T]
    contains
        procedure :: follow, give_sense, visit
        procedure, private :: take, look, start_at, conclude
    end type event_finder

contains

    !> The sense of the loading at the start, and the speed that the drive counts to have if it does
    !> not move at first.
    pure subroutine give_sense(self, sense, speed)
        class(event_finder), intent(inout) :: self
        integer, intent(in) :: sense    !! 1 or -1
        real(dp), intent(in) :: speed   !! of the drive when it first moves [L/T]

        self%sense = sense
        self%speed = speed
    end subroutine give_sense

    !> Takes in a step, and returns the events that are known to have ended in it. After the last
    !> step, an event has ended if the block no longer slips fast.
    pure subroutine follow(self, old, new, last, events)
        class(event_finder), intent(inout) :: self
        type(moment), intent(in) :: old, new   !! `new` is the `old` of the next step
        logical, intent(in) :: last            !! no step follows
        type(slip_event), allocatable, intent(inout) :: events(:)   !! they are added to these
        integer, parameter :: parts = 4
        type(moment) :: before, now
        integer :: k

        self%turning = velocity_at_turn(old, new)
        before = old
        if (tells_more(self, old, new)) then
            do k = 1, parts - 1
                now = within(self, old, new, old%time + k * (new%time - old%time) / parts)
                call self%take(before, now, .false., events)
                before = now
            end do
        end if
        call self%take(before, new, last, events)
    end subroutine follow

    !> Is slip in a step so fast, and does it change so much, that it counts when it is how fast?
    pure logical function tells_more(self, old, new) result(yes)
        class(event_finder), intent(in) :: self
        type(moment), intent(in) :: old, new
        real(dp), parameter :: even = 0.02_dp   !! part of the velocity
        real(dp), parameter :: least = 64.0_dp * epsilon(1.0_dp)   !! part of the time, that can be
                                                                   !! told in parts
        real(dp) :: mean

        yes = .false.
        if (.not. self%inertia .or. new%time - old%time < least * new%time) return
        ! a parabola that is not negative is three times its mean at most
        if (3.0_dp * (new%slip - old%slip) <= limit(self) * (new%time - old%time)) return
        mean = mean_velocity(self, old, new)
        if (max(abs(old%velocity - mean), abs(new%velocity - mean)) <= even * abs(mean)) return
        yes = goes_on(old, new, mean)
    end function tells_more

    !> Of the block between two moments [L/T].
    pure real(dp) function mean_velocity(self, a, b) result(v)
        class(event_finder), intent(in) :: self
        type(moment), intent(in) :: a, b

        v = (b%drive - a%drive - (b%force - a%force) / self%stiffness) / (b%time - a%time)
    end function mean_velocity

    !> Does a block whose place is a cubic of time move in one direction alone? Velocities at the
    !> ends of long steps may be uncertain; such ones tell nothing.
    pure logical function goes_on(a, b, mean) result(yes)
        type(moment), intent(in) :: a, b
        real(dp), intent(in) :: mean   !! velocity [L/T]

        yes = .false.
        if (abs(mean) > 0.0_dp) yes = min(a%velocity / mean, b%velocity / mean) >= 0.0_dp .and. &
            max(a%velocity / mean, b%velocity / mean) <= 3.0_dp
    end function goes_on

    !> Takes in a step or a part of one.
    pure subroutine take(self, old, new, last, events)
        class(event_finder), intent(inout) :: self
        type(moment), intent(in) :: old, new
        logical, intent(in) :: last
        type(slip_event), allocatable, intent(inout) :: events(:)
        type(moment) :: before, now, turn
        real(dp) :: slip_rate, slack, release
        logical :: turns

        before = old%mirrored(self%sense)
        now = new%mirrored(self%sense)
        ! a contact spring that lets go at once does not move the block
        slip_rate = min(new%slip - old%slip, max(0.0_dp, now%drive - before%drive - (now%force &
            - before%force) / self%stiffness)) / (new%time - old%time)
        ! a fixed step in which a hold begins has as much of the drive's speed as there was motion
        if (abs(new%drive - old%drive) > 0.0_dp) self%speed = max(abs(new%drive - old%drive) &
            / (new%time - old%time), min(self%speed, abs(old%velocity + old%rate &
            / self%stiffness)))
        if (.not. self%started) then
            call self%start_at(before)
            self%reached = before%drive
            self%held = before%holds
        end if
        self%since = before
        release = freed(self, now, new%time - old%time)
        self%held = now%holds
        slack = self%drop / self%stiffness
        if (now%drive < self%reached - slack) then
            call self%conclude(events)
            self%sense = -self%sense
            call self%start_at(new%mirrored(self%sense))
            self%reached = self%sense * new%drive
        else if (now%drive >= self%reached - round_off * slack) then
            call turning_point(before, now, turn, turns)
            if (turns) turn = within(self, before, now, turn%time)
            if (turns) turns = beyond(before, now, turn) <= 2.0_dp * max(self%change, &
                abs(now%force - before%force))
            if (turns .and. before%drive >= self%reached - round_off * slack) then
                call self%look(turn, slip_rate, release, events)
            end if
            call self%look(now, slip_rate, release, events)
            self%reached = max(self%reached, now%drive)
        end if
        self%change = abs(new%force - old%force)
        self%rate = slip_rate
        self%middle = 0.5_dp * (old%time + new%time)
        if (last .and. slip_rate <= limit(self)) call self%conclude(events)
    end subroutine take

    !> Slip rate that an event must exceed [L/T].
    pure real(dp) function limit(self) result(rate)
        class(event_finder), intent(in) :: self

        rate = self%slip_rate
        if (rate <= 0.0_dp) rate = fast * (self%driving + self%yielding)
    end function limit

    !> Velocity at which a block follows friction that falls with the normal traction: as the drive
    !> spring gives way, but no more than the whole fall can accelerate it to [L/T].
    pure real(dp) function freed(self, now, dt) result(v)
        class(event_finder), intent(in) :: self
        type(moment), intent(in) :: now
        real(dp), intent(in) :: dt   !! since `held` [T]

        v = 0.0_dp
        if (now%holds >= self%held) return
        v = (self%held - now%holds) / (self%stiffness * dt)
        if (self%impedance > 0.0_dp) v = min(v, max(0.0_dp, self%peak%holds - now%holds) &
            / self%impedance)
    end function freed

    !> By how much does the force at a turn within a step exceed those at its ends [F]? An excess
    !> larger than the change in a step is refused: velocities at the ends of long steps are
    !> uncertain.
    pure real(dp) function beyond(before, now, turn) result(excess)
        type(moment), intent(in) :: before, now, turn

        excess = max(turn%force - max(before%force, now%force), &
            min(before%force, now%force) - turn%force)
    end function beyond

    !> Takes in an instant. An event is known once the force has risen again.
    pure subroutine look(self, now, slip_rate, release, events)
        class(event_finder), intent(inout) :: self
        type(moment), intent(in) :: now
        real(dp), intent(in) :: slip_rate   !! in the step [L/T]
        real(dp), intent(in) :: release     !! as of `freed` [L/T]
        type(slip_event), allocatable, intent(inout) :: events(:)
        type(moment) :: before
        real(dp) :: fall, yielding

        fall = self%peak%force - self%trough%force
        if (fall > self%drop .and. now%force > self%trough%force + max(least_rise * fall, &
            min(self%drop, most_rise * fall))) then
            call self%conclude(events)
            call self%start_at(now)
        else if (now%force >= self%peak%force - uncertainty(self, now)) then
            before = self%peak
            yielding = max(self%yielding, release)
            call self%start_at(now)
            self%peak%force = max(now%force, before%force)   ! a slow fall does not drag it along
            if (now%force > before%force + uncertainty(self, now)) return
            self%peak%holds = max(now%holds, before%holds)   ! what falls on a plateau counts
            self%yielding = yielding
        else
            self%yielding = max(self%yielding, release)
            call follow_fall(self, now, slip_rate)
        end if
    end subroutine look

    !> Round-off of the force, which is a difference of two positions [F].
    pure real(dp) function uncertainty(self, now) result(force)
        class(event_finder), intent(in) :: self
        type(moment), intent(in) :: now

        force = 4.0_dp * epsilon(force) * (abs(now%force) + self%stiffness * abs(now%drive))
    end function uncertainty

    !> A peak that nothing has followed yet.
    pure subroutine start_at(self, now)
        class(event_finder), intent(inout) :: self
        type(moment), intent(in) :: now

        self%started = .true.
        self%is_event = .false.
        self%peak = now
        self%trough = now
        self%fastest = now%velocity
        self%slipping = 0.0_dp
        self%driving = self%speed
        self%yielding = 0.0_dp
    end subroutine start_at

    pure subroutine follow_fall(self, now, slip_rate)
        type(event_finder), intent(inout) :: self
        type(moment), intent(in) :: now
        real(dp), intent(in) :: slip_rate   !! in the step [L/T]
        type(moment) :: end
        real(dp) :: latest   !! end of an event that goes on slowly [T]

        self%fastest = max(self%fastest, now%velocity, self%sense * self%turning)
        self%slipping = max(self%slipping, slip_rate)
        self%driving = max(self%driving, self%speed)
        if (slip_rate > limit(self)) then
            self%fast_until = now%time
        else if (self%rate > limit(self)) then
            self%fast_until = max(self%peak%time, slow_from(self, now, slip_rate))
        end if
        if (now%force >= self%trough%force - uncertainty(self, now)) return
        self%trough = now
        end = now
        latest = 2.0_dp * self%fast_until - self%peak%time
        if (now%time > latest .and. self%slipping > limit(self)) then
            if (self%since%time < latest) end = within(self, self%since, now, latest)
            if (self%is_event .and. self%since%time >= latest) return
            if (.not. (self%is_event .or. self%peak%force - end%force > self%drop)) end = now
        end if
        self%current%onset = self%peak%time
        self%current%duration = end%time - self%peak%time
        self%current%force_drop = self%peak%force - end%force
        self%current%slip = end%slip - self%peak%slip
        self%current%peak_velocity = self%fastest
        self%is_event = self%current%force_drop > self%drop .and. self%slipping > limit(self) &
            .and. self%current%slip >= mostly * (end%drive - self%peak%drive &
            + self%current%force_drop / self%stiffness)
    end subroutine follow_fall

    !> When slip becomes slow: by the mean slip rates of a fast step and of the next one, which is
    !> not, as rates in their middles. What exceeds the speed of the loading decays exponentially,
    !> and is its mean a little before the middle [T].
    pure real(dp) function slow_from(self, now, slip_rate) result(time)
        type(event_finder), intent(in) :: self
        type(moment), intent(in) :: now
        real(dp), intent(in) :: slip_rate   !! in the step that is not [L/T]
        real(dp) :: rates(3)    ! in the fast step, at the limit, in the other step
        real(dp) :: steps(2), times(2), speed

        steps = [2.0_dp * (self%since%time - self%middle), now%time - self%since%time]
        times = [self%middle, self%since%time + 0.5_dp * steps(2)]
        rates = [self%rate, limit(self), slip_rate]
        speed = self%driving + self%yielding
        if (minval(rates) > speed .and. times(2) > times(1)) then
            rates = log(rates - speed)
            times = times - (rates(1) - rates(3)) / (times(2) - times(1)) * steps**2 / 24.0_dp
        end if
        time = times(1) + (rates(1) - rates(2)) / (rates(1) - rates(3)) * (times(2) - times(1))
    end function slow_from

    !> The fall is over: adds it to the events if it is one.
    pure subroutine conclude(self, events)
        class(event_finder), intent(inout) :: self
        type(slip_event), allocatable, intent(inout) :: events(:)

        if (.not. self%is_event) return
        self%current%first = .not. self%any_before
        self%current%recurrence = 0.0_dp
        if (self%any_before) self%current%recurrence = self%current%onset - self%last_onset
        self%any_before = .true.
        self%last_onset = self%current%onset
        events = [events, self%current]
    end subroutine conclude

    !> The same in the sense of the loading.
    pure type(moment) function mirrored(self, sense) result(image)
        class(moment), intent(in) :: self
        integer, intent(in) :: sense   !! 1 or -1

        image = moment(self%time, sense * self%force, self%slip, sense * self%velocity, &
            sense * self%rate, sense * self%drive, self%holds, sense * self%acceleration)
    end function mirrored

    !> The moment between two others at which the force turns, by cubic interpolation.
    pure subroutine turning_point(a, b, between, found)
        type(moment), intent(in) :: a, b
        type(moment), intent(out) :: between
        logical, intent(out) :: found
        real(dp) :: dt, s

        dt = b%time - a%time
        call turn_of_cubic([a%force, b%force], dt * [a%rate, b%rate], s, found)
        if (.not. found) return
        between = between_moments(a, b, a%time + s * dt)
        between%rate = 0.0_dp
    end subroutine turning_point

    !> The velocity of a block where it turns from growing to falling, or the reverse, between two
    !> moments, by cubic interpolation; if it does not, that of the first [L/T].
    pure real(dp) function velocity_at_turn(a, b) result(velocity)
        type(moment), intent(in) :: a, b
        real(dp) :: values(2), rates(2), s
        logical :: turns

        velocity = a%velocity
        if (.not. a%acceleration * b%acceleration < 0.0_dp) return
        values = [a%velocity, b%velocity]
        rates = (b%time - a%time) * [a%acceleration, b%acceleration]
        call turn_of_cubic(values, rates, s, turns)
        if (turns) velocity = cubic(values, rates, s)
    end function velocity_at_turn

    !> Where a cubic turns in an interval of length 1, by its values and rates at both ends. What
    !> changes all the way as at one end turns at the other: there it has a kink.
    pure subroutine turn_of_cubic(values, rates, s, found)
        real(dp), intent(in) :: values(2), rates(2)
        real(dp), intent(out) :: s
        logical, intent(out) :: found
        real(dp), parameter :: bend = 0.1_dp   !! of the mean rate from either, part of their
                                               !! difference; of a parabola a half
        real(dp) :: c1, c2, root

        s = 0.0_dp
        found = rates(1) * rates(2) < 0.0_dp
        if (.not. found) return
        s = (values(2) - values(1) - rates(1)) / (rates(2) - rates(1))
        found = s > bend .and. s < 1.0_dp - bend
        if (.not. found) return
        ! the rate is rates(1) + c1 s + c2 s^2
        c1 = 6.0_dp * (values(2) - values(1)) - 4.0_dp * rates(1) - 2.0_dp * rates(2)
        c2 = 3.0_dp * (rates(1) + rates(2)) - 6.0_dp * (values(2) - values(1))
        root = sqrt(max(0.0_dp, c1**2 - 4.0_dp * rates(1) * c2))
        ! the one root in (0, 1), without cancellation
        if (rates(1) * sign(1.0_dp, c1) > 0.0_dp) then
            s = -0.5_dp * (c1 + sign(root, c1)) / c2
        else
            s = -2.0_dp * rates(1) / (c1 + sign(root, c1))
        end if
        s = min(1.0_dp, max(0.0_dp, s))
    end subroutine turn_of_cubic

    !> A moment within a step, whose slip is spread as the block's way is.
    pure type(moment) function within(self, a, b, time) result(between)
        class(event_finder), intent(in) :: self
        type(moment), intent(in) :: a, b
        real(dp), intent(in) :: time   !! [T]
        real(dp) :: s, dt, mean, way

        between = between_moments(a, b, time)
        mean = mean_velocity(self, a, b)
        if (.not. goes_on(a, b, mean)) return
        dt = b%time - a%time
        s = (time - a%time) / dt
        way = between%drive - a%drive - (between%force - a%force) / self%stiffness
        between%slip = a%slip + (b%slip - a%slip) * min(1.0_dp, max(0.0_dp, way / (mean * dt)))
        between%velocity = between%velocity + 6.0_dp * s * (1.0_dp - s) * (mean &
            - 0.5_dp * (a%velocity + b%velocity))
        between%rate = self%stiffness * ((b%drive - a%drive) / dt - between%velocity)
    end function within

    !> A moment between two others: the force by cubic interpolation.
    pure type(moment) function between_moments(a, b, time) result(between)
        type(moment), intent(in) :: a, b
        real(dp), intent(in) :: time   !! [T]
        real(dp) :: s, dt

        dt = b%time - a%time
        s = (time - a%time) / dt
        between%time = time
        between%force = cubic([a%force, b%force], dt * [a%rate, b%rate], s)
        between%slip = a%slip + s * (b%slip - a%slip)
        between%velocity = a%velocity + s * (b%velocity - a%velocity)
        between%drive = a%drive + s * (b%drive - a%drive)
        between%holds = a%holds + s * (b%holds - a%holds)
    end function between_moments

    !> Of the values and rates at both ends of an interval of length 1.
    pure function cubic(values, rates, x) result(value)
        real(dp), intent(in) :: values(2), rates(2), x
        real(dp) :: value, change

        change = values(2) - values(1)
        value = values(1) + x * change + x * (x - 1.0_dp) * ((1.0_dp - 2.0_dp * x) * change &
            + (x - 1.0_dp) * rates(1) + x * rates(2))
    end function cubic

    !> Reads or writes what has to be kept to go on.
    subroutine visit(self, file)
        class(event_finder), intent(inout) :: self
        type(archive), intent(inout) :: file

        call file%visit(self%speed, self%sense, self%started, self%reached, self%change)
        call self%peak%visit(file)
        call self%trough%visit(file)
        call file%visit(self%fastest, self%slipping, self%driving, self%yielding, self%held)
        call self%current%visit(file)
        call file%visit(self%is_event, self%any_before, self%last_onset, self%fast_until)
        call file%visit(self%rate, self%middle)
    end subroutine visit

    subroutine visit_moment(self, file)
        class(moment), intent(inout) :: self
        type(archive), intent(inout) :: file

        call file%visit(self%time, self%force, self%slip, self%velocity, self%rate, self%drive)
        call file%visit(self%holds)
    end subroutine visit_moment

    subroutine visit_event(self, file)
        class(slip_event), intent(inout) :: self
        type(archive), intent(inout) :: file

        call file%visit(self%onset, self%duration, self%force_drop, self%slip, self%peak_velocity)
        call file%visit(self%recurrence, self%first)
    end subroutine visit_event

end module slip_events
