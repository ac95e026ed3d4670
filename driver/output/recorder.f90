!> Writes what a run has found: the time series and the slip events, as CSV. What is written stays
!> written, whatever happens to the run.
module recorder
    use, intrinsic :: iso_fortran_env, only : dp => real64, int64
    use archive_file, only : archive
    use chain_fields, only : chain_field_file
    use number_text, only : full_row, whole_text
    use run_observer, only : observer, step_news
    use run_rows, only : chain_event_columns, chain_event_row, event_columns, event_row, &
        row_clock, series_columns, series_row, series_size
    use run_settings, only : settings
    use slider_system, only : slider_state
    use text_file, only : gigabyte, output_file, write_numbers
    use thinned_series, only : thinned
    implicit none
    private

    public :: csv_recorder

    integer, parameter :: rows_between_flushes = 200

    type, extends(observer) :: csv_recorder
        type(output_file) :: series, events
        type(chain_field_file) :: fields
        type(thinned) :: picture        !! rows for the picture of a long series
        character(len=:), allocatable :: base   !! of the files' names, with the directory
        integer :: n_blocks = 1
        real(dp) :: area = 1.0_dp       !! contact area of a block [L^2]
        type(row_clock) :: clock
        character(len=:), allocatable :: columns   !! of the time series
        integer :: fields_interval = 0  !! steps between two rows of fields; 0: none
        integer :: rows = 0
        real(dp) :: table_limit = huge(1.0_dp)   !! [bytes]
        integer :: fields_due = 0       !! steps since the last row of fields
    contains
        procedure :: prepare, open, begin, see, finish, visit
        procedure :: flush_all, failed, picture_file
        procedure, private :: tell_loss, write_state, write_chain_events
    end type csv_recorder

contains

    !> For files BASE.csv and so on.
    subroutine prepare(self, run, base)
        class(csv_recorder), intent(inout) :: self
        type(settings), intent(in) :: run
        character(len=*), intent(in) :: base

        self%base = base
        self%n_blocks = run%chain%n_blocks
        self%area = run%area
        self%clock = row_clock(run%interval, run%every)
        self%columns = series_columns(run)
        self%fields_interval = run%fields
        self%table_limit = gigabyte * run%table_limit
        call self%picture%prepare(columns=series_size(run), force=6, speed=4)
    end subroutine prepare

    !> Begins the files of a new run. The catalogue of a chain has other columns than that of one
    !> block.
    subroutine open(self)
        class(csv_recorder), intent(inout) :: self

        call self%series%create(self%base // '.csv')
        call self%events%create(self%base // '_events.csv')
        call self%series%write_line(trim(self%columns))
        if (self%n_blocks > 1) then
            call self%events%write_line(chain_event_columns)
        else
            call self%events%write_line(event_columns)
        end if
        if (self%fields_interval > 0) call self%fields%prepare(self%base, self%n_blocks)
        call self%flush_all()
    end subroutine open

    !> Row 0 is the initial state.
    subroutine begin(self, start, news)
        class(csv_recorder), intent(inout) :: self
        type(slider_state), intent(in) :: start
        type(step_news), intent(inout) :: news

        call self%write_state(start)
        if (self%fields_interval > 0) call self%fields%write_record(start, start)
        call self%tell_loss(news)
    end subroutine begin

    subroutine see(self, old, new, news)
        class(csv_recorder), intent(inout) :: self
        type(slider_state), intent(in) :: old, new
        type(step_news), intent(inout) :: news
        logical :: due
        integer :: i

        call self%clock%tick(old, new, news, due)
        if (due) call self%write_state(new)
        if (self%fields_interval > 0) then
            self%fields_due = self%fields_due + 1
            if (self%fields_due == self%fields_interval) then
                call self%fields%write_record(old, new)
                self%fields_due = 0
            end if
        end if
        if (self%n_blocks == 1) then
            do i = 1, size(news%slip_events)
                call self%events%write_line(full_row(event_row(news%slip_events(i), self%area)))
                call self%events%flush_lines()
            end do
        end if
        call self%write_chain_events(news)
        call self%tell_loss(news)
    end subroutine see

    subroutine tell_loss(self, news)
        class(csv_recorder), intent(in) :: self
        type(step_news), intent(inout) :: news

        if (self%series%failed) call news%stop_run('cannot write the time series (disk full?)')
        if (self%events%failed) call news%stop_run('cannot write the events (disk full?)')
        if (self%fields%parts%failed) call news%stop_run('cannot write the fields (disk full?)')
        if (self%series%bytes + self%fields%bytes() > self%table_limit) call news%stop_run( &
            'the tables have reached &output table_limit: use --resume with a larger limit')
    end subroutine tell_loss

    !> Writes what was cut short, and closes the files. However a run ends, its last row is its last
    !> state.
    subroutine finish(self, last, news)
        class(csv_recorder), intent(inout) :: self
        type(slider_state), intent(in) :: last
        type(step_news), intent(inout) :: news
        logical :: written

        call self%write_chain_events(news)
        if (.not. self%clock%shown) call self%write_state(last)
        call self%series%finish()
        call self%events%finish()
        call self%fields%save()
        if (self%rows > self%picture%kept()) then
            call write_numbers(self%base // '_picture.csv', self%columns, &
                self%picture%rows(:, :self%picture%kept()), written)
            self%series%failed = self%series%failed .or. .not. written
        end if
        if (self%failed()) call news%stop_run('cannot write the last rows (disk full?)')
    end subroutine finish

    !> Keeps how much is in the files, and goes on behind that when it is read.
    subroutine visit(self, file)
        class(csv_recorder), intent(inout) :: self
        type(archive), intent(inout) :: file
        integer(int64) :: series, events, fields   ! bytes, bytes, records

        series = self%series%bytes
        events = self%events%bytes
        fields = self%fields%parts%records
        call file%visit(self%rows, self%clock%steps, self%clock%shown, self%fields_due)
        call self%picture%visit(file)
        call file%visit(series, events, fields)
        if (file%writing) return
        call self%series%go_on(self%base // '.csv', series)
        call self%events%go_on(self%base // '_events.csv', events)
        if (self%fields_interval > 0) call self%fields%go_on(self%base, self%n_blocks, fields)
    end subroutine visit

    !> The file of which a picture is drawn: the series itself, unless it is long.
    pure function picture_file(self) result(name)
        class(csv_recorder), intent(in) :: self
        character(len=:), allocatable :: name

        name = self%base(index(self%base, '/', back=.true.) + 1:) // '.csv'
        if (self%rows > self%picture%kept()) name = name(:len(name) - 4) // '_picture.csv'
    end function picture_file

    subroutine flush_all(self)
        class(csv_recorder), intent(inout) :: self

        call self%series%flush_lines()
        call self%events%flush_lines()
        call self%fields%save()
    end subroutine flush_all

    !> Has something been lost on its way to the disk?
    pure logical function failed(self) result(lost)
        class(csv_recorder), intent(in) :: self

        lost = self%series%failed .or. self%events%failed .or. self%fields%parts%failed
    end function failed

    !> One row of the time series.
    subroutine write_state(self, state)
        class(csv_recorder), intent(inout) :: self
        type(slider_state), intent(in) :: state
        real(dp) :: values(self%picture%columns)

        values = series_row(state, size(values))
        call self%series%write_line(full_row(values))
        call self%picture%add(values)
        self%rows = self%rows + 1
        if (mod(self%rows, rows_between_flushes) == 0) call self%series%flush_lines()
    end subroutine write_state

    !> Rows of the catalogue of a chain.
    subroutine write_chain_events(self, news)
        class(csv_recorder), intent(inout) :: self
        type(step_news), intent(in) :: news
        real(dp) :: row(8)
        integer :: i

        do i = 1, size(news%chain_events)
            row = chain_event_row(news%chain_events(i), self%area, news%cut_short)
            call self%events%write_line(full_row(row(:2)) // ',' // whole_text(nint(row(3))) &
                // ',' // whole_text(nint(row(4))) // ',' // full_row(row(5:7)) // ',' &
                // whole_text(nint(row(8))))
            call self%events%flush_lines()
        end do
    end subroutine write_chain_events

end module recorder
