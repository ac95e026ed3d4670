!> Looks for the events of a chain's blocks in a run.
module chain_observer
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use archive_file, only : archive
    use chain_events, only : chain_event, chain_finder
    use run_observer, only : observer, step_news
    use run_settings, only : settings
    use slider_system, only : ends_periodic, slider_state
    implicit none
    private

    public :: chain_watch

    type, extends(observer) :: chain_watch
        logical :: many = .false.               !! one block has no events of this kind
        real(dp) :: area = 1.0_dp               !! contact area of a block [L^2]
        type(chain_finder) :: finder
        integer :: ended = 0                    !! events
        real(dp) :: largest_moment = 0.0_dp     !! of them [L^3]
        integer :: cut_short = 0                !! events that had not ended when the run did
    contains
        procedure :: prepare, see, finish, visit
    end type chain_watch

contains

    subroutine prepare(self, run)
        class(chain_watch), intent(inout) :: self
        type(settings), intent(in) :: run

        self%many = run%chain%n_blocks > 1
        self%area = run%area
        self%finder%slip_rate = run%chain%slip_rate
        self%finder%drop = run%event_force()
        if (.not. run%adaptive) self%finder%duration = 1.5_dp * run%dt
        self%finder%ring = run%chain%ends == ends_periodic
        allocate (self%finder%events(16))
    end subroutine prepare

    subroutine see(self, old, new, news)
        class(chain_watch), intent(inout) :: self
        type(slider_state), intent(in) :: old, new
        type(step_news), intent(inout) :: news
        type(chain_event), allocatable :: ended(:)

        if (.not. self%many) return
        call self%finder%look(old, new, news%sums%most_slip, ended)
        if (size(ended) == 0) return
        self%ended = self%ended + size(ended)
        self%largest_moment = max(self%largest_moment, self%area * maxval(ended%slip))
        call move_alloc(ended, news%chain_events)
    end subroutine see

    !> Reports what the end of the run cuts short. An interrupted run goes on.
    subroutine finish(self, last, news)
        class(chain_watch), intent(inout) :: self
        type(slider_state), intent(in) :: last
        type(step_news), intent(inout) :: news

        if (.not. self%many .or. news%interrupted) return
        call self%finder%close_all(size(last%x), news%chain_events)
        news%cut_short = .true.
        self%cut_short = size(news%chain_events)
    end subroutine finish

    subroutine visit(self, file)
        class(chain_watch), intent(inout) :: self
        type(archive), intent(inout) :: file

        call self%finder%visit(file)
        call file%visit(self%ended, self%largest_moment)
    end subroutine visit

end module chain_observer
