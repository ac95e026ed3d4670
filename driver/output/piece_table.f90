!> The table of the pieces of a loading programme: what an experimenter reads off each of them.
module piece_table
    use, intrinsic :: ieee_arithmetic, only : ieee_quiet_nan, ieee_value
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use loading_programme, only : programme
    use piece_measures, only : piece_effects, read_off
    use run_outcome, only : event_totals, outcome
    use run_settings, only : settings
    use text_file, only : write_numbers
    implicit none
    private

    public :: piece_rows, pieces_reached, write_pieces

    integer, parameter :: n_columns = 18
    character(len=*), parameter, public :: piece_columns = 'piece,start,end,drive_velocity,' &
        // 'normal_traction,events,period,stress_drop,peak_velocity,peak_friction,' &
        // 'least_friction,last_friction,direct_effect,evolution_effect,steady_change,' &
        // 'a_minus_b,hold_time,healing'

contains

    !> One row a piece that the run has come to; NaN for what a piece does not tell.
    function piece_rows(run, result) result(rows)
        type(settings), intent(in) :: run
        type(outcome), intent(in) :: result
        real(dp), allocatable :: rows(:, :)   !! column, piece
        type(piece_effects), allocatable :: effects(:)
        real(dp), allocatable :: ends(:)
        real(dp) :: none
        integer :: n, i

        none = ieee_value(none, ieee_quiet_nan)
        associate (drive => run%drive)
            n = min(drive%listed, pieces_reached(drive, result%time))
            allocate (ends, source=[drive%start(2:n), result%time])
            effects = read_off(result%friction(:n), result%pieces(:n)%events, &
                drive%velocity(:n), ends - drive%start(:n))
            allocate (rows(n_columns, n), source=none)
            do i = 1, n
                rows(1:5, i) = [real(i, dp), drive%start(i), ends(i), drive%velocity(i), &
                    max(0.0_dp, drive%normal_traction(ends(i), i))]
                rows(6:9, i) = event_means(result%pieces(i), run%area)
                if (result%friction(i)%seen) rows(10:12, i) = [result%friction(i)%peak, &
                    result%friction(i)%least, result%friction(i)%last]
                if (effects(i)%after_step) rows(13:16, i) = [effects(i)%direct, &
                    effects(i)%evolution, effects(i)%steady_change, effects(i)%rate_dependence]
                if (effects(i)%after_hold) rows(17:18, i) = [effects(i)%hold_time, &
                    effects(i)%healing]
            end do
        end associate
    end function piece_rows

    !> How many pieces a run to time `t` has come to; starts are sums of durations, with round-off.
    pure integer function pieces_reached(drive, t) result(pieces)
        type(programme), intent(in) :: drive
        real(dp), intent(in) :: t   !! [T]
        real(dp), parameter :: round_off = 1.0e-12_dp   !! part

        pieces = drive%piece(t * (1.0_dp - round_off))
    end function pieces_reached

    !> Number of events, mean recurrence time, mean stress drop, peak velocity.
    pure function event_means(totals, area) result(means)
        type(event_totals), intent(in) :: totals
        real(dp), intent(in) :: area   !! contact area [L^2]
        real(dp) :: means(4)

        means = ieee_value(means, ieee_quiet_nan)
        means(1) = totals%events
        if (totals%recurrences > 0) means(2) = totals%period / totals%recurrences
        if (totals%events == 0) return
        means(3) = totals%force_drop / (totals%events * area)
        means(4) = totals%peak_velocity
    end function event_means

    !> Writes the table of a programme of several pieces.
    subroutine write_pieces(name, run, result, written)
        character(len=*), intent(in) :: name   !! of the file
        type(settings), intent(in) :: run
        type(outcome), intent(in) :: result
        logical, intent(out) :: written        !! or there is nothing to write

        written = .true.
        if (run%drive%listed > 1) call write_numbers(name, piece_columns, piece_rows(run, result), &
            written)
    end subroutine write_pieces

end module piece_table
