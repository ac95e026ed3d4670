!> One row of the table of a sweep: the values of its keys, and what the run has come to.
module sweep_table
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use linear_stability, only : analyse, stability, undecided, verdicts
    use number_text, only : quoted_field, short_text, whole_text
    use piece_table, only : pieces_reached
    use run_outcome, only : event_totals, outcome
    use run_settings, only : settings
    use steady_sliding, only : sliding_case, take_piece
    use sweep_settings, only : sweep_axis
    use run_warnings, only : find_warnings, run_warning
    implicit none
    private

    public :: failure_text, key_names, late_from, point_text, result_text, table_header

    character(len=*), parameter :: results_header = 'status,regime,events,late_events,period,' &
        // 'stress_drop,peak_velocity,mean_force,energy_defect,stability,growth_rate,' &
        // 'warnings,reason'

    real(dp), parameter :: start_up = 0.5_dp   !! the part of a run that is taken to be start-up

contains

    !> The time from which on events tell the regime [T].
    pure real(dp) function late_from(run) result(time)
        type(settings), intent(in) :: run

        time = start_up * run%t_end
    end function late_from

    pure function table_header(axes) result(text)
        type(sweep_axis), intent(in) :: axes(:)
        character(len=:), allocatable :: text

        text = key_names(axes) // results_header
    end function table_header

    !> The names of the keys of a sweep, as the first columns.
    pure function key_names(axes) result(names)
        type(sweep_axis), intent(in) :: axes(:)
        character(len=:), allocatable :: names
        integer :: i

        names = ''
        do i = 1, size(axes)
            names = names // axes(i)%name // ','
        end do
    end function key_names

    !> The start of a row, which tells the combination.
    pure function point_text(values) result(text)
        real(dp), intent(in) :: values(:)   !! of the keys
        character(len=:), allocatable :: text
        integer :: i

        text = ''
        do i = 1, size(values)
            text = text // short_text(values(i)) // ','
        end do
    end function point_text

    !> The rest of a row.
    function result_text(run, result) result(text)
        type(settings), intent(in) :: run   !! its programme has a piece that starts at `late_from`
        type(outcome), intent(in) :: result
        character(len=:), allocatable :: text
        type(event_totals), allocatable :: late(:)
        character(len=:), allocatable :: counts
        integer :: late_events

        if (len(result%failure) > 0) then
            text = failure_text(result%failure)
            return
        end if
        late = pack(result%pieces, run%drive%start >= late_from(run))
        late_events = sum(late%events)
        counts = whole_text(sum(result%pieces%events)) // ',' // whole_text(late_events)
        text = 'ok,steady,' // counts // ',NaN,NaN,NaN'
        if (late_events > 1) text = 'ok,stick-slip,' // counts &
            // ',' // ratio(sum(late%period), real(sum(late%recurrences), dp)) &
            // ',' // ratio(sum(late%force_drop), late_events * run%area) &
            // ',' // short_text(maxval(late%peak_velocity))
        text = text // ',' // ratio(result%energy%drive_work, run%drive%position(result%time)) &
            // ',' // ratio(result%energy%unbalanced(), result%energy%drive_work) // ',' &
            // steady_text(run) // ',' // warning_codes(run, result) // ','
    end function result_text

    !> Is steady sliding stable as the run ends? And the rate at which a small disturbance grows.
    function steady_text(run) result(text)
        type(settings), intent(in) :: run
        character(len=:), allocatable :: text
        type(sliding_case) :: this
        type(stability) :: steady

        call take_piece(this, run, pieces_reached(run%drive, run%t_end))
        call analyse(this, steady)
        text = 'NaN'
        if (steady%verdict /= undecided) text = short_text(steady%growth)
        text = trim(verdicts(steady%verdict)) // ',' // text
    end function steady_text

    !> Codes of the warnings, blanks between them.
    function warning_codes(run, result) result(codes)
        type(settings), intent(in) :: run
        type(outcome), intent(in) :: result
        character(len=:), allocatable :: codes
        type(run_warning), allocatable :: warnings(:)
        integer :: i

        call find_warnings(run, result, warnings)
        codes = ''
        do i = 1, size(warnings)
            if (i > 1) codes = codes // ' '
            codes = codes // trim(warnings(i)%code)
        end do
    end function warning_codes

    !> The rest of a row of a run that did not reach its end.
    pure function failure_text(reason) result(text)
        character(len=*), intent(in) :: reason
        character(len=:), allocatable :: text

        text = 'failed,,,,NaN,NaN,NaN,NaN,NaN,,NaN,,' // quoted_field(reason)
    end function failure_text

    !> NaN where there is nothing to divide by.
    pure function ratio(total, by) result(text)
        real(dp), intent(in) :: total, by
        character(len=:), allocatable :: text

        text = 'NaN'
        if (abs(by) > 0.0_dp) text = short_text(total / by)
    end function ratio

end module sweep_table
