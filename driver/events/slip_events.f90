!> Finds slip events in the force of the drive spring: falls from a peak to a trough that both
!> outlast noise. Ripples smaller than a threshold do not count, neither as events nor as their
!> ends.
module slip_events
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use archive_file, only : archive
    implicit none
    private

    public :: event_finder, moment, slip_event, turning_point

    !> What the finder looks at in one instant.
    type :: moment
        real(dp) :: time = 0.0_dp       !! [T]
        real(dp) :: force = 0.0_dp      !! of the drive spring [F]
        real(dp) :: slip = 0.0_dp       !! accumulated [L]
        real(dp) :: velocity = 0.0_dp   !! of the block [L/T]
        real(dp) :: rate = 0.0_dp       !! of the force [F/T]
    contains
        procedure, private :: visit => visit_moment
    end type moment

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
        real(dp) :: threshold = 0.0_dp     !! smallest fall and rise that count [F]
        logical :: started = .false.
        logical :: falling = .false.       !! the fall since the peak has passed the threshold
        type(moment) :: peak, trough       !! extremes since the last turn
        real(dp) :: fastest = 0.0_dp       !! largest velocity since the peak [L/T]
        type(slip_event) :: current        !! the fall so far
        logical :: any_before = .false.
        real(dp) :: last_onset = 0.0_dp    !! of the event before [T]
    contains
        procedure :: look, visit
    end type event_finder

contains

    !> The moment between two others at which the force turns, by cubic interpolation.
    pure subroutine turning_point(a, b, between, found)
        type(moment), intent(in) :: a, b
        type(moment), intent(out) :: between
        logical, intent(out) :: found
        real(dp) :: dt, c0, c1, c2, root, s

        found = a%rate * b%rate < 0.0_dp
        if (.not. found) return
        dt = b%time - a%time
        c0 = dt * a%rate   ! d(force)/ds = c0 + c1 s + c2 s^2 for s = 0 to 1
        c1 = 6.0_dp * (b%force - a%force) - dt * (4.0_dp * a%rate + 2.0_dp * b%rate)
        c2 = 3.0_dp * dt * (a%rate + b%rate) - 6.0_dp * (b%force - a%force)
        root = sqrt(max(0.0_dp, c1**2 - 4.0_dp * c0 * c2))
        ! the one root in (0, 1), without cancellation
        if (c0 * sign(1.0_dp, c1) > 0.0_dp) then
            s = -0.5_dp * (c1 + sign(root, c1)) / c2
        else
            s = -2.0_dp * c0 / (c1 + sign(root, c1))
        end if
        s = min(1.0_dp, max(0.0_dp, s))
        between%time = a%time + s * dt
        between%force = a%force + s * (c0 + s * (0.5_dp * c1 + s * c2 / 3.0_dp))
        between%slip = a%slip + s * (b%slip - a%slip)
        between%velocity = a%velocity + s * (b%velocity - a%velocity)
    end subroutine turning_point

    !> Takes in the next instant. An event is known once the force has risen again.
    pure subroutine look(self, now, event, found)
        class(event_finder), intent(inout) :: self
        type(moment), intent(in) :: now
        type(slip_event), intent(out) :: event
        logical, intent(out) :: found

        found = self%falling .and. now%force > self%trough%force + self%threshold
        if (found) then
            event = self%current
            event%first = .not. self%any_before
            if (self%any_before) event%recurrence = event%onset - self%last_onset
            self%any_before = .true.
            self%last_onset = event%onset
        end if
        if (found .or. .not. self%started .or. (now%force >= self%peak%force)) then
            self%started = .true.
            self%falling = .false.
            self%peak = now
            self%trough = now
            self%fastest = now%velocity
        else
            call follow_fall(self, now)
        end if
    end subroutine look

    pure subroutine follow_fall(self, now)
        type(event_finder), intent(inout) :: self
        type(moment), intent(in) :: now

        self%fastest = max(self%fastest, now%velocity)
        self%falling = self%falling .or. now%force < self%peak%force - self%threshold
        if (now%force > self%trough%force) return
        self%trough = now
        self%current%onset = self%peak%time
        self%current%duration = now%time - self%peak%time
        self%current%force_drop = self%peak%force - now%force
        self%current%slip = now%slip - self%peak%slip
        self%current%peak_velocity = self%fastest
    end subroutine follow_fall

    !> Reads or writes what has to be kept to go on.
    subroutine visit(self, file)
        class(event_finder), intent(inout) :: self
        type(archive), intent(inout) :: file

        call file%visit(self%started)
        call file%visit(self%falling)
        call self%peak%visit(file)
        call self%trough%visit(file)
        call file%visit(self%fastest)
        call self%current%visit(file)
        call file%visit(self%any_before)
        call file%visit(self%last_onset)
    end subroutine visit

    subroutine visit_moment(self, file)
        class(moment), intent(inout) :: self
        type(archive), intent(inout) :: file

        call file%visit(self%time)
        call file%visit(self%force)
        call file%visit(self%slip)
        call file%visit(self%velocity)
        call file%visit(self%rate)
    end subroutine visit_moment

    subroutine visit_event(self, file)
        class(slip_event), intent(inout) :: self
        type(archive), intent(inout) :: file

        call file%visit(self%onset)
        call file%visit(self%duration)
        call file%visit(self%force_drop)
        call file%visit(self%slip)
        call file%visit(self%peak_velocity)
        call file%visit(self%recurrence)
        call file%visit(self%first)
    end subroutine visit_event

end module slip_events
