!> Shows on the terminal how far a run has come.
module progress_observer
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use progress_bar, only : progress
    use run_observer, only : observer, step_news
    use slider_system, only : slider_state
    implicit none
    private

    public :: progress_watch

    type, extends(observer) :: progress_watch
        type(progress) :: bar
        real(dp) :: t_end = 0.0_dp   !! [T]
    contains
        procedure :: prepare, see, finish
    end type progress_watch

contains

    subroutine prepare(self, wanted, now, t_end)
        class(progress_watch), intent(inout) :: self
        logical, intent(in) :: wanted
        real(dp), intent(in) :: now, t_end   !! [T]

        self%t_end = t_end
        call self%bar%begin(wanted, now / t_end)
    end subroutine prepare

    subroutine see(self, old, new, news)
        class(progress_watch), intent(inout) :: self
        type(slider_state), intent(in) :: old, new
        type(step_news), intent(inout) :: news

        call self%bar%show(new%time / self%t_end)
    end subroutine see

    subroutine finish(self, last, news)
        class(progress_watch), intent(inout) :: self
        type(slider_state), intent(in) :: last
        type(step_news), intent(inout) :: news

        call self%bar%clear()
    end subroutine finish

end module progress_observer
