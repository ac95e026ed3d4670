!> Finds the events of a chain: blocks that slip, connected in space and time.
!>
!> In every step, neighbours that slip faster than a limit are a run. A run that touches the blocks
!> of an event that is under way belongs to it, and joins events that it touches together. An event
!> ends with the last step in which one of its blocks slips that fast. It counts if the drive
!> springs of its blocks have changed their force meanwhile by more than a limit: contact springs
!> that only let go do not move blocks; and if it took more than one fixed step, which cannot tell.
!>
!> On a ring the last block touches the first. An event over that seam is kept as two, one from the
!> first block on and one up to the last, that are under way and end together, as one.
module chain_events
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use archive_file, only : archive
    use friction_mod, only : statev_slip
    use slider_system, only : slider_state
    implicit none
    private

    public :: chain_event, chain_finder

    type :: chain_event
        real(dp) :: onset = 0.0_dp            !! start of the first step [T]
        real(dp) :: end = 0.0_dp              !! end of the last step [T]
        integer :: first = 0, last = 0        !! blocks; over a ring's seam `last` goes on
        real(dp) :: slip = 0.0_dp             !! sum over the blocks [L]
        real(dp) :: spring = 0.0_dp           !! change of the drive springs' forces, likewise [F]
        real(dp) :: peak_velocity = 0.0_dp    !! largest slip rate of a block [L/T]
        logical :: under_way = .true.         !! some of its blocks slip in this step
    end type chain_event

    !> Events under way, in the order of their blocks; no two of them touch.
    type :: chain_finder
        real(dp) :: slip_rate = 0.0_dp                !! that must be exceeded [L/T]
        real(dp) :: drop = 0.0_dp                     !! of the drive springs' forces, likewise [F]
        real(dp) :: duration = 0.0_dp                 !! likewise [T]
        integer :: unresolved = 0                     !! events that were too short to count
        logical :: ring = .false.                     !! the last block touches the first
        type(chain_event), allocatable :: events(:)   !! room for `count` and more
        integer :: count = 0
    contains
        procedure :: look, close_all, visit
        procedure, private :: over_seam, take_ended
    end type chain_finder

contains

    !> Takes in a step; returns the events that have ended before it, in the order of their
    !> blocks.
    pure subroutine look(self, old, new, most_slip, ended)
        class(chain_finder), intent(inout) :: self
        type(slider_state), intent(in) :: old, new
        real(dp), intent(in) :: most_slip   !! of a block in the step [L]
        type(chain_event), allocatable, intent(out) :: ended(:)
        real(dp) :: least   !! slip in the step that counts [L]
        real(dp) :: slip    !! of a block in the step [L]
        integer :: i, k, slipping

        k = 1
        self%events(:self%count)%under_way = .false.
        least = self%slip_rate * (new%time - old%time)
        slipping = merge(size(new%x), 0, most_slip > least)   ! none: a chain is long
        do i = 1, slipping
            slip = new%statev(i, statev_slip) - old%statev(i, statev_slip)
            if (slip > least) call take_in(self, chain_event(old%time, new%time, i, i, slip, &
                new%spring(i) - old%spring(i), slip / (new%time - old%time)), k)
        end do
        if (self%over_seam(size(new%x))) then
            associate (low => self%events(1), high => self%events(self%count))
                low%under_way = low%under_way .or. high%under_way
                high%under_way = low%under_way
            end associate
        end if
        call self%take_ended(size(new%x), ended)
        self%unresolved = self%unresolved + count(ended%end - ended%onset <= self%duration)
        ended = pack(ended, ended%end - ended%onset > self%duration)
    end subroutine look

    !> Returns all that is under way.
    pure subroutine close_all(self, n_blocks, rest)
        class(chain_finder), intent(inout) :: self
        integer, intent(in) :: n_blocks
        type(chain_event), allocatable, intent(out) :: rest(:)

        self%events(:self%count)%under_way = .false.
        call self%take_ended(n_blocks, rest)
    end subroutine close_all

    !> Are the first and the last event one, over the seam of a ring? Once they are they stay so:
    !> events never shrink.
    pure logical function over_seam(self, n_blocks) result(yes)
        class(chain_finder), intent(in) :: self
        integer, intent(in) :: n_blocks

        yes = .false.
        if (self%ring .and. self%count > 1) yes = self%events(1)%first == 1 &
            .and. self%events(self%count)%last == n_blocks
    end function over_seam

    !> Takes events that have ended out of the list.
    pure subroutine take_ended(self, n_blocks, ended)
        class(chain_finder), intent(inout) :: self
        integer, intent(in) :: n_blocks
        type(chain_event), allocatable, intent(out) :: ended(:)
        logical :: joined

        joined = self%over_seam(n_blocks)
        if (joined) joined = .not. self%events(1)%under_way
        ended = pack(self%events(:self%count), .not. self%events(:self%count)%under_way)
        if (size(ended) == 0) return
        self%events(:self%count - size(ended)) = pack(self%events(:self%count), &
            self%events(:self%count)%under_way)
        self%count = self%count - size(ended)
        if (joined) then
            ended(1)%first = n_blocks + ended(1)%first
            ended(1)%last = n_blocks + ended(1)%last
            call absorb(ended(size(ended)), ended(1))
            ended = ended(2:)
        end if
        ended = pack(ended, abs(ended%spring) > self%drop)
    end subroutine take_ended

    !> Adds a block that slips; the blocks of a step come one after the other.
    pure subroutine take_in(self, this, k)
        class(chain_finder), intent(inout) :: self
        type(chain_event), intent(in) :: this   !! the block in the step
        integer, intent(inout) :: k             !! no event before this one can touch the block
        logical :: touches

        do while (k <= self%count)
            if (self%events(k)%last >= this%first - 1) exit
            k = k + 1
        end do
        touches = k <= self%count
        if (touches) touches = self%events(k)%first <= this%last + 1
        if (touches) then
            call absorb(self%events(k), this)
        else
            call insert(self, k, this)
        end if
        if (k == self%count) return
        if (self%events(k + 1)%first > self%events(k)%last + 1) return
        call absorb(self%events(k), self%events(k + 1))   ! the two are one
        self%events(k + 1:self%count - 1) = self%events(k + 2:self%count)
        self%count = self%count - 1
    end subroutine take_in

    pure subroutine insert(self, k, this)
        class(chain_finder), intent(inout) :: self
        integer, intent(in) :: k
        type(chain_event), intent(in) :: this

        if (self%count == size(self%events)) self%events = [self%events, self%events]   ! room
        self%events(k + 1:self%count + 1) = self%events(k:self%count)
        self%count = self%count + 1
        self%events(k) = this
    end subroutine insert

    !> Adds to an event another one.
    pure subroutine absorb(event, other)
        type(chain_event), intent(inout) :: event
        type(chain_event), intent(in) :: other

        event%onset = min(event%onset, other%onset)
        event%end = max(event%end, other%end)
        event%first = min(event%first, other%first)
        event%last = max(event%last, other%last)
        event%slip = event%slip + other%slip
        event%spring = event%spring + other%spring
        event%peak_velocity = max(event%peak_velocity, other%peak_velocity)
        event%under_way = event%under_way .or. other%under_way
    end subroutine absorb

    !> Reads or writes the events under way.
    subroutine visit(self, file)
        class(chain_finder), intent(inout) :: self
        type(archive), intent(inout) :: file
        integer :: i

        call file%visit(self%unresolved, self%count)
        if (size(self%events) < self%count) then
            deallocate (self%events)
            allocate (self%events(self%count))
        end if
        do i = 1, self%count
            associate (event => self%events(i))
                call file%visit(event%onset, event%end, event%first, event%last, event%slip)
                call file%visit(event%spring, event%peak_velocity, event%under_way)
            end associate
        end do
    end subroutine visit

end module chain_events
