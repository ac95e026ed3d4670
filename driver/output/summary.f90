!> What a run has come to, in a screen of text.
module summary
    use, intrinsic :: ieee_arithmetic, only : ieee_quiet_nan, ieee_value
    use, intrinsic :: iso_fortran_env, only : dp => real64, error_unit
    use number_text, only : rounded_text
    use piece_table, only : pieces_reached
    use platform, only : report
    use run_outcome, only : event_totals, outcome
    use run_warnings, only : find_warnings, run_warning
    use run_settings, only : settings
    implicit none
    private

    public :: print_event_times, print_summary, print_warnings, summary_row

    character(len=*), parameter, public :: summary_columns = 'steps,time,newton_iterations,' &
        // 'rejected_steps,snap_back_steps,events,mean_period,mean_stress_drop,peak_velocity,' &
        // 'drive_work,energy_at_start,kinetic,spring,contact,damped,dissipated,unbalanced'

contains

    !> The summary as numbers; means of nothing are NaN.
    function summary_row(run, result) result(row)
        type(settings), intent(in) :: run
        type(outcome), intent(in) :: result
        real(dp) :: row(17)
        type(event_totals) :: all
        real(dp) :: none

        all = total(result%pieces)
        none = ieee_value(none, ieee_quiet_nan)
        row(1:9) = [real(result%steps, dp), result%time, real(result%iterations, dp), &
            real(result%rejected, dp), real(result%snap_backs, dp), real(all%events, dp), none, &
            none, result%peak_velocity]
        if (result%in_rates) row(3) = 0.0_dp
        if (all%recurrences > 0) row(7) = all%period / all%recurrences
        if (all%events > 0) row(8) = all%force_drop / run%area / all%events
        associate (e => result%energy)
            row(10:) = [e%drive_work, e%at_start, e%kinetic, e%spring, e%contact, e%damped, &
                e%dissipated, e%unbalanced()]
        end associate
    end function summary_row

    subroutine print_summary(run, result, table)
        type(settings), intent(in) :: run
        type(outcome), intent(in) :: result
        character(len=*), intent(in) :: table   !! name of the file with the time series
        type(event_totals) :: all
        character(len=:), allocatable :: most

        all = total(result%pieces)
        write (report, '(a, i0, 3a)') 'steps              ', result%steps, ' to time ', &
            rounded_text(result%time, 12, 5), ' [T]'
        if (result%in_rates) then
            write (report, '(3a)') 'rate evaluations   ', trim(per_step(result%iterations, &
                result%steps)), ' per step, rejected steps included'
        else
            most = ', at most '
            if (run%adaptive) most = ' with its substeps, at most per substep '
            write (report, '(4a, i0)') 'Newton iterations  ', &
                trim(per_step(result%iterations, result%steps)), ' per step', most, &
                result%most_iterations
        end if
        if (result%rejected > 0) write (report, '(a, i0)') 'rejected steps     ', result%rejected
        if (result%snap_backs > 0) write (report, '(a, i0, 3a)') 'snap-back          ', &
            result%snap_backs, ' steps had several equilibria: use a smaller ', &
            trim(merge('rtol', 'dt  ', run%adaptive)), ' or a larger alpha_t'
        write (report, '(a, i0)') 'slip events        ', all%events
        if (run%chain%n_blocks > 1) then
            write (report, '(2(a, i0), a)') 'events of blocks   ', result%chain_events, &
                ', and ', result%cut_events, ' still in progress at the end'
            call line('largest moment     ', result%largest_moment, &
                min(1, result%chain_events), '[L^3]')
        end if
        call line('mean period        ', all%period, all%recurrences, '[T]')
        call line('mean stress drop   ', all%force_drop / run%area, all%events, '[F/L^2]')
        call line('peak velocity      ', result%peak_velocity, 1, '[L/T]')
        if (size(result%pieces) > 1) call print_pieces(run, &
            result%pieces(:min(size(result%pieces), pieces_reached(run%drive, result%time))))
        call print_energy(result)
        write (report, '(2a)') 'table              ', table
    end subroutine print_summary

    !> On standard error, a line each.
    subroutine print_warnings(input, run, result)
        character(len=*), intent(in) :: input   !! name of the file
        type(settings), intent(in) :: run
        type(outcome), intent(in) :: result
        type(run_warning), allocatable :: warnings(:)
        integer :: i

        call find_warnings(run, result, warnings)
        do i = 1, size(warnings)
            write (error_unit, '(4a)') 'stickslip: ', input, ': warning: ', trim(warnings(i)%text)
        end do
    end subroutine print_warnings

    !> How far the events of a run are from those of a tighter one.
    subroutine print_event_times(onsets, tighter)
        real(dp), intent(in) :: onsets(:), tighter(:)   !! [T]
        real(dp) :: apart(min(size(onsets), size(tighter)))

        if (size(onsets) /= size(tighter)) write (report, '(a, i0, a, i0)') &
            'events             ', size(onsets), '; in the tighter run ', size(tighter)
        if (size(apart) == 0) then
            write (report, '(a)') 'event-time error   -            no events to compare'
            return
        end if
        apart = abs(onsets(:size(apart)) - tighter(:size(apart)))
        write (report, '(5a)') 'event-time error   largest ', rounded_text(maxval(apart), 10, 3), &
            ', mean ', rounded_text(sum(apart) / size(apart), 10, 3), &
            ' [T], against the tighter run'
    end subroutine print_event_times

    pure character(len=12) function per_step(total, steps) result(text)
        integer, intent(in) :: total, steps

        write (text, '(f12.2)') real(total, dp) / max(1, steps)
        text = adjustl(text)
    end function per_step

    !> Of the pieces together.
    pure type(event_totals) function total(pieces) result(all)
        type(event_totals), intent(in) :: pieces(:)

        all%events = sum(pieces%events)
        all%recurrences = sum(pieces%recurrences)
        all%period = sum(pieces%period)
        all%force_drop = sum(pieces%force_drop)
    end function total

    !> A mean, or a dash where there is nothing to take the mean of.
    subroutine line(title, amount, count, unit)
        character(len=*), intent(in) :: title, unit
        real(dp), intent(in) :: amount
        integer, intent(in) :: count

        write (report, '(4a)') title, mean(amount, count), ' ', unit
    end subroutine line

    pure character(len=12) function mean(total, count) result(text)
        real(dp), intent(in) :: total
        integer, intent(in) :: count

        text = '-'
        if (count > 0) text = rounded_text(total / count, 12, 5)
        text = adjustl(text)
    end function mean

    !> Period and stress drop against drive velocity, one line a piece that the run has come to.
    subroutine print_pieces(run, pieces)
        type(settings), intent(in) :: run
        type(event_totals), intent(in) :: pieces(:)
        integer :: i

        write (report, '(a)') 'from time    velocity     normal       events  period       ' &
            // 'stress drop  peak velocity'
        do i = 1, size(pieces)
            write (report, '(3(a, 2x), i6, 2x, 2(a, 1x), a)') &
                rounded_text(run%drive%start(i), 11, 4), &
                rounded_text(run%drive%velocity(i), 11, 4), &
                rounded_text(run%drive%normal(i), 11, 4), pieces(i)%events, &
                mean(pieces(i)%period, pieces(i)%recurrences), &
                mean(pieces(i)%force_drop / run%area, pieces(i)%events), &
                mean(pieces(i)%peak_velocity, min(1, pieces(i)%events))
        end do
    end subroutine print_pieces

    subroutine print_energy(result)
        type(outcome), intent(in) :: result

        associate (e => result%energy)
            write (report, '(3a)') 'work of the drive  ', &
                rounded_text(e%drive_work, 14, 6), ' [F L] ='
            if (abs(e%at_start) > 0.0_dp) write (report, '(2a)') &
                '  less the start   ', rounded_text(-e%at_start, 14, 6)
            write (report, '(2a)') '  kinetic          ', rounded_text(e%kinetic, 14, 6)
            write (report, '(2a)') '  spring           ', rounded_text(e%spring, 14, 6)
            write (report, '(2a)') '  contact, elastic ', rounded_text(e%contact, 14, 6)
            write (report, '(2a)') '  damped           ', rounded_text(e%damped, 14, 6)
            write (report, '(2a)') '  dissipated       ', rounded_text(e%dissipated, 14, 6)
            write (report, '(2a)') '  unbalanced       ', rounded_text(e%unbalanced(), 14, 6)
        end associate
    end subroutine print_energy

end module summary
