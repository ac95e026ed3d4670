!> Writes what a run has found: the time series and the slip events, as CSV. What is written stays
!> written, whatever happens to the run.
module recorder
    use, intrinsic :: iso_fortran_env, only : dp => real64, int64
    use chain_events, only : chain_event
    use field_file, only : netcdf_fields
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
    character(len=*), parameter :: chain_events_header = &
        'onset,duration,first_block,blocks,slip,moment,peak_velocity,ended'
    character(len=*), parameter :: fields_header = 'time,block,slip_rate,slip,mu'
    integer, parameter :: rows_between_flushes = 200
    integer, parameter, public :: most_in_csv = 1000   !! blocks whose fields fit in a CSV file

    type :: csv_recorder
        type(output_file) :: series, events, fields
        type(netcdf_fields) :: netcdf   !! in place of `fields` for a long chain
        integer :: rows = 0
    contains
        procedure :: start, go_on, flush_all, fields_place, write_state, write_event, &
            write_chain_event, write_fields, failed, finish
    end type csv_recorder

contains

    !> The catalogue of a chain has other columns than that of one block. Without a name for fields
    !> none are written.
    subroutine start(self, series_name, events_name, n_blocks, fields_name)
        class(csv_recorder), intent(inout) :: self
        character(len=*), intent(in) :: series_name, events_name
        integer, intent(in) :: n_blocks               !! more than one: a chain
        character(len=*), intent(in) :: fields_name   !! may be empty

        call self%series%create(series_name)
        call self%events%create(events_name)
        call self%series%write_line(series_header)
        if (n_blocks > 1) then
            call self%events%write_line(chain_events_header)
        else
            call self%events%write_line(events_header)
        end if
        if (is_netcdf(fields_name)) then
            call self%netcdf%create(fields_name, n_blocks)
        else if (len(fields_name) > 0) then
            call self%fields%create(fields_name)
            call self%fields%write_line(fields_header)
        end if
        call self%flush_all()
    end subroutine start

    !> Goes on in the files of an interrupted run, behind what they held at its last checkpoint.
    subroutine go_on(self, series_name, events_name, fields_name, rows, bytes)
        class(csv_recorder), intent(inout) :: self
        character(len=*), intent(in) :: series_name, events_name, fields_name
        integer, intent(in) :: rows              !! of the time series
        integer(int64), intent(in) :: bytes(3)   !! of the time series, the events, the fields (rows
                                                 !! in a NetCDF file)

        call self%series%go_on(series_name, bytes(1))
        call self%events%go_on(events_name, bytes(2))
        if (is_netcdf(fields_name)) then
            call self%netcdf%go_on(fields_name, int(bytes(3)))
        else if (len(fields_name) > 0) then
            call self%fields%go_on(fields_name, bytes(3))
        end if
        self%rows = rows
    end subroutine go_on

    !> How much of the fields there is: bytes, or rows of a NetCDF file.
    pure function fields_place(self) result(place)
        class(csv_recorder), intent(in) :: self
        integer(int64) :: place

        place = self%fields%bytes + self%netcdf%rows   ! one of them is 0
    end function fields_place

    pure function is_netcdf(name)
        character(len=*), intent(in) :: name
        logical :: is_netcdf

        is_netcdf = index(name, '.nc', back=.true.) > 0 &
            .and. index(name, '.nc', back=.true.) == len(name) - 2
    end function is_netcdf

    subroutine flush_all(self)
        class(csv_recorder), intent(inout) :: self

        call self%series%flush_lines()
        call self%events%flush_lines()
        call self%fields%flush_lines()
    end subroutine flush_all

    !> Has something been lost on its way to the disk?
    pure function failed(self) result(lost)
        class(csv_recorder), intent(in) :: self
        logical :: lost

        lost = self%series%failed .or. self%events%failed .or. self%fields%failed &
            .or. self%netcdf%failed
    end function failed

    !> One row of the time series. Of several blocks it shows the means.
    subroutine write_state(self, state)
        class(csv_recorder), intent(inout) :: self
        type(slider_state), intent(in) :: state

        call self%series%write_line(row([state%time, state%drive, mean(state%x), mean(state%v), &
            mean(state%a), mean(state%spring), mean(state%friction), &
            mean(state%statev(:, statev_mu)), mean(state%statev(:, statev_r)), &
            mean(state%statev(:, statev_slip))]))
        self%rows = self%rows + 1
        if (mod(self%rows, rows_between_flushes) == 0) call self%series%flush_lines()
    end subroutine write_state

    pure function mean(values)
        real(dp), intent(in) :: values(:)
        real(dp) :: mean

        mean = sum(values) / size(values)
    end function mean

    !> One row of the catalogue of a chain.
    subroutine write_chain_event(self, event, area, ended)
        class(csv_recorder), intent(inout) :: self
        type(chain_event), intent(in) :: event
        real(dp), intent(in) :: area   !! contact area of a block [L^2]
        logical, intent(in) :: ended   !! before the run did
        character(len=24) :: blocks

        write (blocks, '(i0, ",", i0)') event%first, event%last - event%first + 1
        call self%events%write_line(row([event%onset, event%end - event%onset]) // ',' &
            // trim(blocks) // ',' // row([event%slip / (event%last - event%first + 1), &
            area * event%slip, event%peak_velocity]) // merge(',1', ',0', ended))
        call self%events%flush_lines()
    end subroutine write_chain_event

    !> The blocks after the step from `old` to `new`: a row of the NetCDF file, or in CSV a line
    !> each and an empty line for gnuplot.
    subroutine write_fields(self, old, new)
        class(csv_recorder), intent(inout) :: self
        type(slider_state), intent(in) :: old, new
        character(len=12) :: block
        real(dp) :: dt
        integer :: i

        dt = max(new%time - old%time, tiny(dt))
        if (size(new%x) > most_in_csv) then
            call self%netcdf%write_row(new%time, (new%statev(:, statev_slip) - old%statev(:, &
                statev_slip)) / dt, new%statev(:, statev_slip), new%statev(:, statev_mu))
            return
        end if
        do i = 1, size(new%x)
            write (block, '(",", i0, ",")') i
            call self%fields%write_line(row([new%time]) // trim(block) &
                // row([(new%statev(i, statev_slip) - old%statev(i, statev_slip)) / dt, &
                new%statev(i, statev_slip), new%statev(i, statev_mu)]))
        end do
        call self%fields%write_line('')
        call self%fields%flush_lines()
    end subroutine write_fields

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
        call self%fields%finish()
        call self%netcdf%finish()
    end subroutine finish

end module recorder
