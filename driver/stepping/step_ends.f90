!> Where an adaptive step ends for other reasons than its error, and what normal traction counts as
!> none.
module step_ends
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use loading_programme, only : programme
    use number_text, only : rounded_text
    use run_settings, only : next_row
    implicit none
    private

    public :: end_of_step, find_opening, load_at, next_limit, none_below, vanishing_part, &
        why_too_short, within_range

    !> Of the logarithm of what the law remembers by a change of the pressure, as the law has it.
    real(dp), parameter, public :: most_change = 200.0_dp

contains

    !> Where a step from a time ends at the latest: at the next piece, the next row, or the end of
    !> the run. Of those that are no step apart it is the last.
    pure function next_limit(drive, every, t_end, shortest, time) result(limit)
        type(programme), intent(in) :: drive
        real(dp), intent(in) :: every      !! time between rows, or 0 [T]
        real(dp), intent(in) :: t_end      !! [T]
        real(dp), intent(in) :: shortest   !! part of the time that no step is shorter than
        real(dp), intent(in) :: time       !! [T]
        real(dp) :: limit                  !! [T]
        real(dp) :: next

        next = time
        do
            limit = next
            next = min(drive%next_start(limit), next_row(every, limit), t_end)
            if (limit >= t_end) return
            if (limit > time .and. next > limit * (1.0_dp + shortest)) return
        end do
    end function next_limit

    !> No step is left that is much shorter than the one before the limit.
    pure function end_of_step(start, dt, limit) result(end)
        real(dp), intent(in) :: start, dt, limit   !! [T]
        real(dp) :: end                            !! [T]

        end = start + dt
        if (end >= limit - 1.0e-3_dp * dt) then
            end = limit
        else if (end > limit - dt) then
            end = start + 0.5_dp * (limit - start)
        end if
    end function end_of_step

    !> Part of the largest normal traction below which a contact under a varying one counts as open:
    !> what is left out is an impulse, and of the order of the square. As the normal traction
    !> vanishes, the slip rates of rate-and-state friction have no bound, and a state that depends
    !> on the pressure has none either.
    pure function vanishing_part(stiff, rtol) result(part)
        logical, intent(in) :: stiff     !! slip rates of the law go through decades
        real(dp), intent(in) :: rtol
        real(dp) :: part

        part = merge(1.0e-2_dp * sqrt(rtol), 0.0_dp, stiff)
    end function vanishing_part

    !> Part of the largest normal traction down to which what the law remembers stays in the range
    !> of numbers, if it depends on the pressure.
    pure function within_range(effect) result(part)
        real(dp), intent(in) :: effect   !! of the pressure [-]
        real(dp) :: part

        part = 0.0_dp
        if (effect > 0.0_dp) part = exp(-most_change / effect)
    end function within_range

    !> The normal traction that counts as none in a piece of the programme: one that does not vary
    !> is taken as it is.
    pure function none_below(drive, piece, open_below) result(pressure)
        type(programme), intent(in) :: drive
        integer, intent(in) :: piece
        real(dp), intent(in) :: open_below   !! what counts as none where it varies [F/L^2]
        real(dp) :: pressure                 !! [F/L^2]

        pressure = 0.0_dp
        if (drive%amplitude > 0.0_dp .or. abs(drive%normal_rate(piece)) > 0.0_dp) pressure &
            = open_below
    end function none_below

    !> The normal traction at a time, 0 where it counts as none [F/L^2].
    pure function load_at(drive, time, piece, open_below) result(load)
        type(programme), intent(in) :: drive
        real(dp), intent(in) :: time   !! [T]
        integer, intent(in) :: piece
        real(dp), intent(in) :: open_below   !! as in `none_below` [F/L^2]
        real(dp) :: load

        load = drive%normal_traction(time, piece)
        if (load <= none_below(drive, piece, open_below)) load = min(0.0_dp, load)
    end function load_at

    !> When the normal traction falls to a threshold within a step, or rises above: the last moment
    !> before and the first one after; huge if neither happens.
    pure subroutine find_opening(drive, piece, threshold, open_now, start, end, before, after)
        type(programme), intent(in) :: drive
        integer, intent(in) :: piece
        real(dp), intent(in) :: threshold    !! [F/L^2]
        logical, intent(in) :: open_now      !! at the start: not above it
        real(dp), intent(in) :: start, end   !! of the step [T]
        real(dp), intent(out) :: before, after   !! [T]
        real(dp) :: middle

        before = huge(before)
        after = huge(after)
        if (open_now .eqv. drive%normal_traction(end, piece) <= threshold) return
        before = start
        after = end
        do
            middle = before + 0.5_dp * (after - before)
            if (.not. (middle > before .and. middle < after)) return
            if (open_now .eqv. drive%normal_traction(middle, piece) <= threshold) then
                before = middle
            else
                after = middle
            end if
        end do
    end subroutine find_opening

    !> Why a run ends whose steps would have to be shorter than is allowed.
    pure function why_too_short(dt_min) result(why)
        real(dp), intent(in) :: dt_min   !! shortest step [T]; 0: what round-off of the time allows
        character(len=:), allocatable :: why

        why = 'the error exceeds rtol even in steps as short as the round-off of the time. Start ' &
            // 'the run (&initial) shortly before this time, where round-off is smaller'
        if (.not. dt_min > 0.0_dp) return
        why = 'the error exceeds rtol even in steps as short as dt_min = ' &
            // trim(adjustl(rounded_text(dt_min, 10, 3)))
    end function why_too_short

end module step_ends
