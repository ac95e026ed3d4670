!> Who watches a run: files that grow, events that are found, a progress bar. The simulation knows
!> none of them by name.
module run_observer
    use chain_events, only : chain_event
    use slider_system, only : slider_state
    use slip_events, only : slip_event
    use step_sums, only : block_sums
    implicit none
    private

    public :: observer, observer_slot, step_news

    !> What is known of a step beside its two states. Observers that find events put them here,
    !> those after them read them.
    type :: step_news
        integer :: steps = 0            !! taken so far, this one included
        logical :: complete = .true.    !! not a part of a fixed step
        logical :: last = .false.       !! no step follows: the end has been reached
        type(block_sums) :: sums        !! over the blocks in this step
        type(slip_event), allocatable :: slip_events(:)     !! known to have ended in this step
        type(chain_event), allocatable :: chain_events(:)   !! likewise, of a chain's blocks
        logical :: cut_short = .false.  !! these chain events had not ended when the run did
        logical :: interrupted = .false.                    !! by the user; the run can be resumed
        character(len=:), allocatable :: problem            !! why the run cannot go on; or empty
    contains
        procedure :: clear, stop_run
    end type step_news

    type, abstract :: observer
    contains
        procedure :: begin, finish
        procedure(see_step), deferred :: see
    end type observer

    abstract interface
        !> After each step.
        subroutine see_step(self, old, new, news)
            import :: observer, slider_state, step_news
            implicit none
            class(observer), intent(inout) :: self
            type(slider_state), intent(in) :: old, new
            type(step_news), intent(inout) :: news
        end subroutine see_step
    end interface

    !> One of a list of observers.
    type :: observer_slot
        class(observer), pointer :: it => null()
    end type observer_slot

contains

    !> Before the first step; not in a run that is resumed.
    subroutine begin(self, start, news)
        class(observer), intent(inout) :: self
        type(slider_state), intent(in) :: start
        type(step_news), intent(inout) :: news
    end subroutine begin

    !> After the last step, or where the run has failed or was interrupted.
    subroutine finish(self, last, news)
        class(observer), intent(inout) :: self
        type(slider_state), intent(in) :: last
        type(step_news), intent(inout) :: news
    end subroutine finish

    !> Before a step: nothing is known of it.
    pure subroutine clear(self)
        class(step_news), intent(inout) :: self

        if (.not. allocated(self%problem)) self%problem = ''
        if (.not. allocated(self%slip_events)) allocate (self%slip_events(0))
        if (.not. allocated(self%chain_events)) allocate (self%chain_events(0))
        if (size(self%slip_events) > 0) self%slip_events = [slip_event ::]
        if (size(self%chain_events) > 0) self%chain_events = [chain_event ::]
    end subroutine clear

    !> Ends the run after this step. The first reason is the one that counts.
    pure subroutine stop_run(self, why)
        class(step_news), intent(inout) :: self
        character(len=*), intent(in) :: why

        if (len(self%problem) == 0) self%problem = why
    end subroutine stop_run

end module run_observer
