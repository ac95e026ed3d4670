!> Writes what a run has found: the time series and the slip events, as CSV. What is written stays
!> written, whatever happens to the run.
module recorder
    use, intrinsic :: iso_fortran_env, only : dp => real64, int64
    use friction_mod, only : statev_mu, statev_r, statev_slip
    use slider_system, only : slider_state
    use slip_events, only : slip_event
    use text_file, only : output_file
    implicit none
    private

    public :: csv_recorder

    character(len=*), parameter :: series_header = &
        'time,drive,displacement,velocity,acceleration,spring_force,friction_force,mu,R,slip'
    character(len=*), parameter :: events_header = &
        'onset,duration,stress_drop,slip,peak_velocity,recurrence_time'
    integer, parameter :: rows_between_flushes = 200

    type :: csv_recorder
        type(output_file) :: series, events
        integer :: rows = 0
    contains
        procedure :: start, go_on, flush_all, write_state, write_event, failed, finish
    end type csv_recorder

contains

    subroutine start(self, series_name, events_name)
        class(csv_recorder), intent(inout) :: self
        character(len=*), intent(in) :: series_name, events_name

        call self%series%create(series_name)
        call self%events%create(events_name)
        call self%series%write_line(series_header)
        call self%events%write_line(events_header)
        call self%series%flush_lines()
        call self%events%flush_lines()
    end subroutine start

    !> Goes on in the files of an interrupted run, behind what they held at its last checkpoint.
    subroutine go_on(self, series_name, events_name, rows, bytes)
        class(csv_recorder), intent(inout) :: self
        character(len=*), intent(in) :: series_name, events_name
        integer, intent(in) :: rows              !! of the time series
        integer(int64), intent(in) :: bytes(2)   !! of the time series, of the events

        call self%series%go_on(series_name, bytes(1))
        call self%events%go_on(events_name, bytes(2))
        self%rows = rows
    end subroutine go_on

    subroutine flush_all(self)
        class(csv_recorder), intent(inout) :: self

        call self%series%flush_lines()
        call self%events%flush_lines()
    end subroutine flush_all

    !> Has something been lost on its way to the disk?
    pure function failed(self) result(lost)
        class(csv_recorder), intent(in) :: self
        logical :: lost

        lost = self%series%failed .or. self%events%failed
    end function failed

    !> One row of the time series. Of several blocks it shows the first.
    subroutine write_state(self, state)
        class(csv_recorder), intent(inout) :: self
        type(slider_state), intent(in) :: state

        call self%series%write_line(row([state%time, state%drive, state%x(1), state%v(1), &
            state%a(1), state%spring(1), state%friction(1), state%statev(statev_mu, 1), &
            state%statev(statev_r, 1), state%statev(statev_slip, 1)]))
        self%rows = self%rows + 1
        if (mod(self%rows, rows_between_flushes) == 0) call self%series%flush_lines()
    end subroutine write_state

    !> One row of the table of events. The first event has no recurrence time: NaN.
    subroutine write_event(self, event, area)
        class(csv_recorder), intent(inout) :: self
        type(slip_event), intent(in) :: event
        real(dp), intent(in) :: area   !! contact area, turns forces into stresses [L^2]
        character(len=:), allocatable :: recurrence

        recurrence = 'NaN'
        if (.not. event%first) recurrence = row([event%recurrence])
        call self%events%write_line(row([event%onset, event%duration, event%force_drop / area, &
            event%slip, event%peak_velocity]) // ',' // recurrence)
        call self%events%flush_lines()
    end subroutine write_event

    !> Numbers with 17 significant digits, so that reading them back gives the same bits.
    pure function row(numbers) result(line)
        real(dp), intent(in) :: numbers(:)
        character(len=:), allocatable :: line
        character(len=25 * size(numbers)) :: buffer, packed
        integer :: i, n

        write (buffer, '(*(es24.16e3, :, ","))') numbers
        n = 0
        do i = 1, len(buffer)
            if (buffer(i:i) == ' ') cycle
            n = n + 1
            packed(n:n) = buffer(i:i)
        end do
        line = packed(:n)
    end function row

    subroutine finish(self)
        class(csv_recorder), intent(inout) :: self

        call self%series%finish()
        call self%events%finish()
    end subroutine finish

end module recorder
