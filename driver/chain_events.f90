!> Finds the events of a chain: blocks that slip, connected in space and time.
!>
!> In every step, neighbours that slip faster than a limit are a run. A run that touches the blocks
!> of an event that is under way belongs to it, and joins events that it touches together. An event
!> ends with the last step in which one of its blocks slips that fast.
module chain_events
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use friction_mod, only : statev_slip
    use slider_system, only : slider_state
    implicit none
    private

    public :: chain_event, chain_finder

    type :: chain_event
        real(dp) :: onset = 0.0_dp            !! start of the first step [T]
        real(dp) :: end = 0.0_dp              !! end of the last step [T]
        integer :: first = 0, last = 0        !! blocks
        real(dp) :: slip = 0.0_dp             !! sum over the blocks [L]
        real(dp) :: peak_velocity = 0.0_dp    !! largest slip rate of a block [L/T]
        logical :: under_way = .true.         !! some of its blocks slip in this step
    end type chain_event

    !> Events under way, in the order of their blocks; no two of them touch.
    type :: chain_finder
        real(dp) :: slip_rate = 0.0_dp                !! the limit [L/T]
        type(chain_event), allocatable :: events(:)   !! room for `count` and more
        integer :: count = 0
    contains
        procedure :: look
    end type chain_finder

contains

    !> Takes in a step; hands over the events that have ended before it, in the order of their
    !> blocks.
    pure subroutine look(self, old, new, ended)
        class(chain_finder), intent(inout) :: self
        type(slider_state), intent(in) :: old, new
        type(chain_event), allocatable, intent(out) :: ended(:)
        real(dp) :: least   !! slip in the step that counts [L]
        real(dp) :: slip    !! of a block in the step [L]
        integer :: i, k

        k = 1
        self%events(:self%count)%under_way = .false.
        least = self%slip_rate * (new%time - old%time)
        do i = 1, size(new%x)
            slip = new%statev(i, statev_slip) - old%statev(i, statev_slip)
            if (slip > least) call take_in(self, i, slip, old%time, new%time, k)
        end do
        associate (all => self%events(:self%count))
            ended = pack(all, .not. all%under_way)
        end associate
        if (size(ended) == 0) return
        self%events(:self%count - size(ended)) = pack(self%events(:self%count), &
            self%events(:self%count)%under_way)
        self%count = self%count - size(ended)
    end subroutine look

    !> Adds a block that slips; the blocks of a step come one after the other.
    pure subroutine take_in(self, block, slip, start, end, k)
        class(chain_finder), intent(inout) :: self
        integer, intent(in) :: block
        real(dp), intent(in) :: slip         !! in the step [L]
        real(dp), intent(in) :: start, end   !! of the step [T]
        integer, intent(inout) :: k          !! no event before this one can touch the block

        do while (k <= self%count)
            if (self%events(k)%last >= block - 1) exit
            k = k + 1
        end do
        if (k > self%count) then
            call insert(self, k, block, start)
        else if (self%events(k)%first > block + 1) then
            call insert(self, k, block, start)
        end if
        associate (event => self%events(k))
            event%under_way = .true.
            event%end = end
            event%first = min(event%first, block)
            event%last = max(event%last, block)
            event%slip = event%slip + slip
            event%peak_velocity = max(event%peak_velocity, slip / (end - start))
        end associate
        if (k == self%count) return
        if (self%events(k + 1)%first <= self%events(k)%last + 1) call join(self, k)
    end subroutine take_in

    pure subroutine insert(self, k, block, start)
        class(chain_finder), intent(inout) :: self
        integer, intent(in) :: k
        integer, intent(in) :: block
        real(dp), intent(in) :: start   !! [T]
        type(chain_event), allocatable :: more(:)
        integer :: i

        if (self%count == size(self%events)) then
            allocate (more(2 * self%count))
            more(:self%count) = self%events
            call move_alloc(more, self%events)
        end if
        do i = self%count, k, -1
            self%events(i + 1) = self%events(i)
        end do
        self%count = self%count + 1
        self%events(k) = chain_event(onset=start, end=start, first=block, last=block)
    end subroutine insert

    !> Events `k` and `k + 1` are one.
    pure subroutine join(self, k)
        class(chain_finder), intent(inout) :: self
        integer, intent(in) :: k
        integer :: i

        associate (a => self%events(k), b => self%events(k + 1))
            a%onset = min(a%onset, b%onset)
            a%end = max(a%end, b%end)
            a%last = max(a%last, b%last)
            a%slip = a%slip + b%slip
            a%peak_velocity = max(a%peak_velocity, b%peak_velocity)
        end associate
        do i = k + 1, self%count - 1
            self%events(i) = self%events(i + 1)
        end do
        self%count = self%count - 1
    end subroutine join

end module chain_events
