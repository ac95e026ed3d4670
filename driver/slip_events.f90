!> Finds slip events in the force of the drive spring: falls from a peak to a trough that both
!> outlast noise. Ripples smaller than a threshold do not count, neither as events nor as their
!> ends.
module slip_events
    use, intrinsic :: iso_fortran_env, only : dp => real64
    implicit none
    private

    public :: event_finder, moment, slip_event

    !> What the finder looks at in one instant.
    type :: moment
        real(dp) :: time = 0.0_dp       !! [T]
        real(dp) :: force = 0.0_dp      !! of the drive spring [F]
        real(dp) :: slip = 0.0_dp       !! accumulated [L]
        real(dp) :: velocity = 0.0_dp   !! of the block [L/T]
    end type moment

    type :: slip_event
        real(dp) :: onset = 0.0_dp            !! time of the peak force [T]
        real(dp) :: duration = 0.0_dp         !! from peak to trough [T]
        real(dp) :: force_drop = 0.0_dp       !! [F]
        real(dp) :: slip = 0.0_dp             !! [L]
        real(dp) :: peak_velocity = 0.0_dp    !! [L/T]
        real(dp) :: recurrence = 0.0_dp       !! onset less the onset of the event before [T]
        logical :: first = .true.             !! no event before: no recurrence time
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
        procedure :: look
    end type event_finder

contains

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

end module slip_events
