!> One row of the table of a sweep: the values of its keys, and what the run has come to.
module sweep_table
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use run_outcome, only : event_totals, outcome
    use run_settings, only : settings
    use sweep_settings, only : sweep_axis
    implicit none
    private

    public :: failure_text, late_from, number_text, point_text, result_text, table_header

    character(len=*), parameter :: results_header = 'status,regime,events,late_events,period,' &
        // 'stress_drop,peak_velocity,mean_force,energy_defect,reason'

    real(dp), parameter :: start_up = 0.5_dp   !! the part of a run that is taken to be start-up

contains

    !> The time from which on events tell the regime [T].
    pure function late_from(run) result(time)
        type(settings), intent(in) :: run
        real(dp) :: time

        time = start_up * run%t_end
    end function late_from

    pure function table_header(axes) result(text)
        type(sweep_axis), intent(in) :: axes(:)
        character(len=:), allocatable :: text
        integer :: i

        text = ''
        do i = 1, size(axes)
            text = text // axes(i)%name // ','
        end do
        text = text // results_header
    end function table_header

    !> The start of a row, which tells the combination.
    pure function point_text(values) result(text)
        real(dp), intent(in) :: values(:)   !! of the keys
        character(len=:), allocatable :: text
        integer :: i

        text = ''
        do i = 1, size(values)
            text = text // number_text(values(i)) // ','
        end do
    end function point_text

    !> The rest of a row.
    pure function result_text(run, result) result(text)
        type(settings), intent(in) :: run   !! its programme has a piece that starts at `late_from`
        type(outcome), intent(in) :: result
        character(len=:), allocatable :: text
        type(event_totals), allocatable :: late(:)
        integer :: events, late_events
        character(len=40) :: counts

        if (len(result%failure) > 0) then
            text = failure_text(result%failure)
            return
        end if
        events = sum(result%pieces%events)
        late = pack(result%pieces, run%drive%start >= late_from(run))
        late_events = sum(late%events)
        write (counts, '(i0, a, i0)') events, ',', late_events
        text = 'ok,steady,' // trim(counts) // ',NaN,NaN,NaN'
        if (late_events > 1) text = 'ok,stick-slip,' // trim(counts) &
            // ',' // ratio(sum(late%period), real(sum(late%recurrences), dp)) &
            // ',' // ratio(sum(late%force_drop), late_events * run%area) &
            // ',' // number_text(maxval(late%peak_velocity))
        text = text // ',' // ratio(result%energy%drive_work, run%drive%position(result%time)) &
            // ',' // ratio(result%energy%unbalanced(), result%energy%drive_work) // ','
    end function result_text

    !> The rest of a row of a run that did not reach its end.
    pure function failure_text(reason) result(text)
        character(len=*), intent(in) :: reason
        character(len=:), allocatable :: text

        text = 'failed,,,,NaN,NaN,NaN,NaN,NaN,' // quoted(reason)
    end function failure_text

    !> NaN where there is nothing to divide by.
    pure function ratio(total, by) result(text)
        real(dp), intent(in) :: total, by
        character(len=:), allocatable :: text

        text = 'NaN'
        if (abs(by) > 0.0_dp) text = number_text(total / by)
    end function ratio

    !> A number with as many digits as it takes to read the same bits back, and no more.
    pure function number_text(number) result(text)
        real(dp), intent(in) :: number   !! finite
        character(len=:), allocatable :: text
        character(len=32) :: buffer, form
        real(dp) :: back
        integer :: digits, ends

        do digits = 15, 17
            if (abs(number) >= 0.1_dp .and. abs(number) < 1.0e6_dp) then
                write (form, '(a, i0, a)') '(g32.', digits, ')'
            else
                write (form, '(a, i0, a)') '(es32.', digits - 1, 'e3)'
            end if
            write (buffer, form) number
            read (buffer, *) back
            if (.not. abs(back - number) > 0.0_dp) exit
        end do
        ends = index(buffer // 'E', 'E') - 1
        text = trim(buffer(:ends))
        text = text(:verify(text, '0', back=.true.))
        text = text(:verify(text, '.', back=.true.))
        text = trim(adjustl(text // buffer(ends + 1:)))
        if (.not. abs(number) > 0.0_dp) text = '0'
    end function number_text

    !> A text as one field of a CSV file, whatever it contains.
    pure function quoted(text) result(field)
        character(len=*), intent(in) :: text
        character(len=:), allocatable :: field
        integer :: i

        field = '"'
        do i = 1, len(text)
            field = field // text(i:i)
            if (text(i:i) == '"') field = field // '"'
        end do
        field = field // '"'
    end function quoted

end module sweep_table
