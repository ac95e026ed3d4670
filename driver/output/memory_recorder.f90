!> Keeps in memory what a run has found: the same rows and columns that the CSV files have.
module memory_recorder
    use, intrinsic :: iso_c_binding, only : c_null_char
    use, intrinsic :: iso_fortran_env, only : dp => real64, int64
    use run_observer, only : observer, step_news
    use run_rows, only : chain_event_columns, chain_event_row, event_columns, event_row, &
        row_clock, series_columns, series_row, series_size
    use run_settings, only : settings
    use slider_system, only : slider_state
    implicit none
    private

    public :: memory_table, memory_watch

    !> Rows of numbers, growing.
    type :: memory_table
        character(len=:), allocatable :: columns   !! names, with commas between them
        real(dp), allocatable :: values(:, :)      !! column, row; room for more than there is
        integer(int64) :: rows = 0
    contains
        procedure :: start => start_table
        procedure :: add
    end type memory_table

    type, extends(observer) :: memory_watch
        type(memory_table) :: series, events
        type(memory_table) :: catalogue   !! of a chain's events
        type(row_clock) :: clock
        real(dp) :: area = 1.0_dp   !! contact area of a block [L^2]
        integer :: columns = 0      !! of the time series
    contains
        procedure :: prepare, begin, see, finish
        procedure, private :: add_chain_events
    end type memory_watch

contains

    subroutine prepare(self, run)
        class(memory_watch), intent(inout) :: self
        type(settings), intent(in) :: run

        self%area = run%area
        self%clock = row_clock(run%interval, run%every)
        self%columns = series_size(run)
        call self%series%start(series_columns(run))
        call self%events%start(event_columns)
        call self%catalogue%start(chain_event_columns)
    end subroutine prepare

    subroutine begin(self, start, news)
        class(memory_watch), intent(inout) :: self
        type(slider_state), intent(in) :: start
        type(step_news), intent(inout) :: news

        call self%series%add(series_row(start, self%columns))
    end subroutine begin

    subroutine see(self, old, new, news)
        class(memory_watch), intent(inout) :: self
        type(slider_state), intent(in) :: old, new
        type(step_news), intent(inout) :: news
        logical :: due
        integer :: i

        call self%clock%tick(old, new, news, due)
        if (due) call self%series%add(series_row(new, self%columns))
        do i = 1, size(news%slip_events)
            call self%events%add(event_row(news%slip_events(i), self%area))
        end do
        call self%add_chain_events(news)
    end subroutine see

    subroutine add_chain_events(self, news)
        class(memory_watch), intent(inout) :: self
        type(step_news), intent(in) :: news
        integer :: i

        do i = 1, size(news%chain_events)
            call self%catalogue%add(chain_event_row(news%chain_events(i), self%area, &
                news%cut_short))
        end do
    end subroutine add_chain_events

    !> However a run ends, its last row is its last state.
    subroutine finish(self, last, news)
        class(memory_watch), intent(inout) :: self
        type(slider_state), intent(in) :: last
        type(step_news), intent(inout) :: news

        call self%add_chain_events(news)
        if (.not. self%clock%shown) call self%series%add(series_row(last, self%columns))
    end subroutine finish

    subroutine start_table(self, columns)
        class(memory_table), intent(inout) :: self
        character(len=*), intent(in) :: columns   !! names, with commas between them
        integer, parameter :: first_rows = 256
        integer :: commas, i

        commas = count([(columns(i:i) == ',', i = 1, len(columns))])
        self%columns = columns // c_null_char   ! C reads it too
        allocate (self%values(commas + 1, first_rows))
    end subroutine start_table

    subroutine add(self, row)
        class(memory_table), intent(inout) :: self
        real(dp), intent(in) :: row(:)
        real(dp), allocatable :: larger(:, :)

        if (self%rows == size(self%values, 2, int64)) then
            allocate (larger(size(self%values, 1), 2 * self%rows))
            larger(:, :self%rows) = self%values
            call move_alloc(larger, self%values)
        end if
        self%rows = self%rows + 1
        self%values(:, self%rows) = row
    end subroutine add

end module memory_recorder
