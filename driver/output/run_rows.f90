!> Rows and columns of what a run finds: one definition for the CSV files and for tables in memory.
module run_rows
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use, intrinsic :: ieee_arithmetic, only : ieee_quiet_nan, ieee_value
    use chain_events, only : chain_event
    use friction_mod, only : statev_mu, statev_r, statev_slip, statev_u_n
    use law_facts, only : internal_variable
    use run_observer, only : step_news
    use run_settings, only : next_row, settings
    use slider_system, only : slider_state
    use slip_events, only : slip_event
    implicit none
    private

    public :: chain_event_row, event_row, row_clock, series_columns, series_row, series_size

    character(len=*), parameter, public :: event_columns = &
        'onset,duration,stress_drop,slip,peak_velocity,recurrence_time'
    character(len=*), parameter, public :: chain_event_columns = &
        'onset,duration,first_block,blocks,slip,moment,peak_velocity,ended'

    !> Tells when a row of the time series is due.
    type :: row_clock
        integer :: interval = 1      !! steps between two rows
        real(dp) :: every = 0.0_dp   !! time between two rows; 0: rows by `interval` [T]
        integer :: steps = 0         !! since the last row by `interval`
        logical :: shown = .true.    !! the state at the end of the last step has its row
    contains
        procedure :: tick
    end type row_clock

contains

    !> After each step.
    pure subroutine tick(self, old, new, news, due)
        class(row_clock), intent(inout) :: self
        type(slider_state), intent(in) :: old, new
        type(step_news), intent(in) :: news
        logical, intent(out) :: due

        if (news%complete) self%steps = self%steps + 1
        due = self%steps == self%interval .or. news%last &
            .or. next_row(self%every, old%time) <= new%time
        self%shown = due
        if (self%steps == self%interval) self%steps = 0
    end subroutine tick

    !> How many columns has the time series of a run?
    pure integer function series_size(run) result(columns)
        type(settings), intent(in) :: run

        columns = merge(13, 11, run%across%free())
    end function series_size

    !> Their names; the law's internal variable has its own.
    pure function series_columns(run) result(names)
        type(settings), intent(in) :: run
        character(len=:), allocatable :: names

        names = 'time,drive,displacement,velocity,acceleration,spring_force,friction_force,mu,' &
            // trim(internal_variable(run%props)) // ',slip,normal_traction'
        if (run%across%free()) names = names // ',normal_displacement,normal_velocity'
    end function series_columns

    !> A row of the time series. Of several blocks it shows the means.
    pure function series_row(state, columns) result(row)
        type(slider_state), intent(in) :: state
        integer, intent(in) :: columns   !! how many there are
        real(dp) :: row(columns)

        row(:11) = [state%time, state%drive, mean(state%x), mean(state%v), mean(state%a), &
            mean(state%spring), mean(state%friction), mean(state%statev(:, statev_mu)), &
            mean(state%statev(:, statev_r)), mean(state%statev(:, statev_slip)), &
            max(0.0_dp, state%normal)]
        if (columns > 11) row(12:) = [state%statev(1, statev_u_n), state%v_n]
    end function series_row

    pure real(dp) function mean(values)
        real(dp), intent(in) :: values(:)

        mean = sum(values) / size(values)
    end function mean

    !> A row of the table of events. The first event has no recurrence time: NaN.
    function event_row(event, area) result(row)
        type(slip_event), intent(in) :: event
        real(dp), intent(in) :: area   !! contact area, turns forces into stresses [L^2]
        real(dp) :: row(6)

        row = [event%onset, event%duration, event%force_drop / area, event%slip, &
            event%peak_velocity, event%recurrence]
        if (event%first) row(6) = ieee_value(row(6), ieee_quiet_nan)
    end function event_row

    !> A row of the catalogue of a chain.
    pure function chain_event_row(event, area, cut_short) result(row)
        type(chain_event), intent(in) :: event
        real(dp), intent(in) :: area         !! contact area of a block [L^2]
        logical, intent(in) :: cut_short     !! it had not ended when the run did
        real(dp) :: row(8)
        integer :: blocks

        blocks = event%last - event%first + 1
        row = [event%onset, event%end - event%onset, real(event%first, dp), real(blocks, dp), &
            event%slip / blocks, area * event%slip, event%peak_velocity, &
            merge(0.0_dp, 1.0_dp, cut_short)]
    end function chain_event_row

end module run_rows
