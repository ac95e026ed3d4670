!> Tables of a run of the fault, as CSV, written by the first process: the global series, events,
!> stations and contours of slip. Rows are the ends of steps.
module fault_recorder
    use, intrinsic :: iso_fortran_env, only : dp => real64, int64
    use fault_events, only : event_watch, fault_event
    use fault_problem, only : fault, fault_state, step_start
    use number_text, only : full_row, whole_text
    use processes, only : team
    use result_files, only : of_run, remove_results
    use text_file, only : gigabyte, output_file
    implicit none
    private

    public :: recorder

    character(len=*), parameter :: event_columns = &
        'onset,duration,peak_slip_rate,largest_slip,mean_slip,potency,first_cell'

    type :: recorder
        type(output_file) :: global, events, contours
        type(output_file), allocatable :: stations(:)
        character(len=:), allocatable :: base    !! of the files' names, with the directory
        integer, allocatable :: cells(:)         !! of the stations; 0: on another process
        real(dp) :: next_contour = 0.0_dp        !! time [T]
        type(step_start) :: before               !! the last step's
        logical :: writes = .false.              !! this process does
        logical :: full = .false.                !! a step has more contours than the files may hold
        logical, private :: draws_contours = .false.
    contains
        procedure :: prepare, create, go_on, begin, see, show_last, flush_all, finish, failed, sizes
        procedure, private :: write_rows, write_contours, contours_until, write_event
    end type recorder

contains

    subroutine prepare(self, here, together, base)
        class(recorder), intent(inout) :: self
        type(fault), intent(in) :: here
        type(team), intent(in) :: together
        character(len=*), intent(in) :: base
        integer :: i

        self%base = base
        self%writes = together%rank == 0
        associate (plan => here%plan)
            self%cells = [(here%cell_of(plan%station_x(i), plan%station_z(i)), &
                i = 1, size(plan%station_z))]
            self%draws_contours = plan%nx == 1 .and. plan%contours(1) > 0.0_dp
        end associate
        allocate (self%stations(size(self%cells)))
    end subroutine prepare

    !> Begins the files of a new run.
    subroutine create(self, here)
        class(recorder), intent(inout) :: self
        type(fault), intent(in) :: here
        integer :: i

        if (.not. self%writes) return
        call remove_results(self%base, of_run)
        call self%global%create(self%base // '_global.csv')
        call self%global%write_line('time,log10_slip_rate,moment_rate,loading_work,' &
            // 'elastic_energy,dissipated,radiated')
        call self%events%create(self%base // '_events.csv')
        call self%events%write_line(event_columns)
        do i = 1, size(self%stations)
            call self%stations(i)%create(station_name(self%base, i))
            call self%stations(i)%write_line('time,slip,log10_slip_rate,traction,' &
                // memory_column(here))
        end do
        if (.not. self%draws_contours) return
        call self%contours%create(self%base // '_contours.csv')
        call self%contours%write_line('time,event,z,slip,log10_slip_rate')
    end subroutine create

    !> The column of the law's internal variable.
    pure function memory_column(here) result(name)
        type(fault), intent(in) :: here
        character(len=:), allocatable :: name

        name = 'state'
        if (here%plan%rate_state) name = 'log10_theta'
    end function memory_column

    function station_name(base, i) result(name)
        character(len=*), intent(in) :: base
        integer, intent(in) :: i
        character(len=:), allocatable :: name

        name = base // '_station_' // whole_text(i) // '.csv'
    end function station_name

    !> Opens the files where a checkpoint has left them.
    subroutine go_on(self, bytes)
        class(recorder), intent(inout) :: self
        real(dp), intent(in) :: bytes(:)   !! of the files, in the order of `sizes`
        integer :: i

        if (.not. self%writes) return
        call self%global%go_on(self%base // '_global.csv', int(bytes(1), int64))
        call self%events%go_on(self%base // '_events.csv', int(bytes(2), int64))
        if (self%draws_contours) call self%contours%go_on(self%base // '_contours.csv', &
            int(bytes(3), int64))
        do i = 1, size(self%stations)
            call self%stations(i)%go_on(station_name(self%base, i), int(bytes(3 + i), int64))
        end do
    end subroutine go_on

    !> Lengths of the files so far [bytes]; whole numbers, 0 on all processes but the first.
    pure function sizes(self) result(bytes)
        class(recorder), intent(in) :: self
        real(dp), allocatable :: bytes(:)

        bytes = real([self%global%bytes, self%events%bytes, self%contours%bytes, &
            self%stations%bytes], dp)
    end function sizes

    !> The first row, of the state at the start.
    subroutine begin(self, here, together, state, watch)
        class(recorder), intent(inout) :: self
        type(fault), intent(in) :: here
        type(team), intent(in) :: together
        type(fault_state), intent(in) :: state
        type(event_watch), intent(in) :: watch

        call self%write_rows(here, together, state, watch)
        self%next_contour = here%plan%contours(1)
    end subroutine begin

    !> A step: from `before` to the state.
    subroutine see(self, here, together, state, watch, ended)
        class(recorder), intent(inout) :: self
        type(fault), intent(in) :: here
        type(team), intent(in) :: together
        type(fault_state), intent(in) :: state
        type(event_watch), intent(in) :: watch
        logical, intent(in) :: ended   !! an event has, in this step

        if (mod(state%steps, int(here%plan%interval, int64)) == 0 &
            .or. state%time >= here%plan%t_end) call self%write_rows(here, together, state, watch)
        if (ended) call self%write_event(watch%event)
        if (self%draws_contours) call self%write_contours(here, together, state, watch, ended)
    end subroutine see

    !> Where the run ends before `t_end`: its last row is its last state. One that is resumed goes
    !> on from its checkpoint, without that row.
    subroutine show_last(self, here, together, state, watch)
        class(recorder), intent(inout) :: self
        type(fault), intent(in) :: here
        type(team), intent(in) :: together
        type(fault_state), intent(in) :: state
        type(event_watch), intent(in) :: watch

        if (mod(state%steps, int(here%plan%interval, int64)) /= 0 &
            .and. state%time < here%plan%t_end) call self%write_rows(here, together, state, watch)
    end subroutine show_last

    subroutine write_rows(self, here, together, state, watch)
        class(recorder), intent(inout) :: self
        type(fault), intent(in) :: here
        type(team), intent(in) :: together
        type(fault_state), intent(in) :: state
        type(event_watch), intent(in) :: watch
        real(dp) :: moment_rate, elastic, values(4, size(self%cells)), flat(4 * size(self%cells))
        integer :: i

        moment_rate = here%plan%shear_modulus * here%plan%cell_area() &
            * here%part%row_sums(together, state%rate)
        elastic = here%elastic_energy(together, state)
        values = -huge(1.0_dp)
        do i = 1, size(self%cells)
            if (self%cells(i) == 0) cycle
            values(:, i) = [state%slip(self%cells(i)), log10_of(state%rate(self%cells(i))), &
                state%traction(self%cells(i)), state%memory(self%cells(i))]
            if (here%plan%rate_state) values(4, i) = values(4, i) / log(10.0_dp)
        end do
        flat = reshape(values, [size(flat)])
        if (size(flat) > 0) call together%largest_of_each(flat)
        if (.not. self%writes) return
        call self%global%write_line(full_row([state%time, log10_of(watch%largest_rate), &
            moment_rate, state%energy%loading, elastic, state%energy%dissipated, &
            state%energy%radiated]))
        do i = 1, size(self%cells)
            call self%stations(i)%write_line(full_row([state%time, flat(4 * i - 3:4 * i)]))
        end do
    end subroutine write_rows

    elemental real(dp) function log10_of(rate) result(number)
        real(dp), intent(in) :: rate

        number = log10(max(abs(rate), 1.0e-300_dp))
    end function log10_of

    subroutine write_event(self, event)
        class(recorder), intent(inout) :: self
        type(fault_event), intent(in) :: event
        character(len=24) :: number

        if (.not. self%writes) return
        write (number, '(i0)') event%first_cell
        call self%events%write_line(full_row([event%onset, event%duration, event%peak_rate, &
            event%largest_slip, event%mean_slip, event%potency]) // ',' // trim(number))
    end subroutine write_event

    !> Slip along depth at even times, between events and in them.
    subroutine write_contours(self, here, together, state, watch, ended)
        class(recorder), intent(inout) :: self
        type(fault), intent(in) :: here
        type(team), intent(in) :: together
        type(fault_state), intent(in) :: state
        type(event_watch), intent(in) :: watch
        logical, intent(in) :: ended
        logical :: in_event
        real(dp) :: last

        in_event = watch%on .or. ended
        if (in_event .and. watch%event%onset >= self%before%time) then
            call self%contours_until(here, together, state, .false., watch%event%onset)
            self%next_contour = watch%event%onset
        end if
        last = state%time
        if (ended) last = watch%event%onset + watch%event%duration
        call self%contours_until(here, together, state, in_event, last)
        if (ended) self%next_contour = here%plan%contours(1) * (1 + aint(state%time &
            / here%plan%contours(1)))
    end subroutine write_contours

    !> The contours of a step up to a time, by cubic interpolation between its ends.
    subroutine contours_until(self, here, together, state, in_event, last)
        class(recorder), intent(inout) :: self
        type(fault), intent(in) :: here
        type(team), intent(in) :: together
        type(fault_state), intent(in) :: state   !! at the end of the step
        logical, intent(in) :: in_event
        real(dp), intent(in) :: last             !! [T]
        real(dp) :: u, own(here%n)
        real(dp), dimension(here%plan%nz) :: slip, rate, rate_before
        integer :: k

        do while (self%next_contour <= last)
            self%full = together%any_of(sum(self%sizes()) > gigabyte * here%plan%table_limit)
            if (self%full) return
            u = (self%next_contour - self%before%time) / (state%time - self%before%time)
            own = self%before%slip_at(self%next_contour, state)
            call together%gather(own, here%part%counts, slip)
            call together%gather(self%before%rate, here%part%counts, rate_before)
            call together%gather(state%rate, here%part%counts, rate)
            rate = (1.0_dp - u) * log10_of(rate_before) + u * log10_of(rate)
            do k = 1, here%plan%nz, here%plan%contour_stride()
                if (self%writes) call self%contours%write_line(full_row([self%next_contour, &
                    merge(1.0_dp, 0.0_dp, in_event), here%plan%z_of(k), slip(k), rate(k)]))
            end do
            if (self%writes) call self%contours%write_line('')
            self%next_contour = self%next_contour + here%plan%contours(merge(2, 1, in_event))
        end do
    end subroutine contours_until

    subroutine flush_all(self)
        class(recorder), intent(inout) :: self
        integer :: i

        call self%global%flush_lines()
        call self%events%flush_lines()
        call self%contours%flush_lines()
        do i = 1, size(self%stations)
            call self%stations(i)%flush_lines()
        end do
    end subroutine flush_all

    subroutine finish(self)
        class(recorder), intent(inout) :: self
        integer :: i

        call self%global%finish()
        call self%events%finish()
        call self%contours%finish()
        do i = 1, size(self%stations)
            call self%stations(i)%finish()
        end do
    end subroutine finish

    logical function failed(self)
        class(recorder), intent(in) :: self

        failed = self%global%failed .or. self%events%failed .or. self%contours%failed &
            .or. any(self%stations%failed)
    end function failed

end module fault_recorder
