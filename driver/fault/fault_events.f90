!> Events: times in which a part of the fault slips faster than `seismic_rate`.
module fault_events
    use, intrinsic :: iso_fortran_env, only : dp => real64, int64
    use fault_problem, only : fault, fault_state, step_start
    use processes, only : team
    implicit none
    private

    public :: event_watch, fault_event

    type :: fault_event
        real(dp) :: onset = 0.0_dp, duration = 0.0_dp          !! [T]
        real(dp) :: peak_rate = 0.0_dp                         !! of slip [L/T]
        real(dp) :: largest_slip = 0.0_dp, mean_slip = 0.0_dp  !! the mean of the cells that took
                                                               !! part [L]
        real(dp) :: potency = 0.0_dp                           !! area times slip, of all cells
        integer(int64) :: first_cell = 0                       !! where it started
    end type fault_event

    type :: event_watch
        logical :: on = .false.                    !! an event is under way
        type(fault_event) :: event                 !! that one
        integer :: events = 0                      !! that have ended
        real(dp) :: largest_rate = 0.0_dp          !! at the end of the last step [L/T]
        real(dp), allocatable :: slip_before(:)    !! at the onset [L]
        real(dp), allocatable :: took_part(:)      !! 1 or 0
    contains
        procedure :: start
        procedure :: see
        procedure, private :: finish_event
    end type event_watch

contains

    subroutine start(self, here, together, state)
        class(event_watch), intent(inout) :: self
        type(fault), intent(in) :: here
        type(team), intent(in) :: together
        type(fault_state), intent(in) :: state

        allocate (self%slip_before(here%n), self%took_part(here%n))
        self%slip_before = state%slip
        self%took_part = 0.0_dp
        self%largest_rate = together%largest(maxval(state%rate))
    end subroutine start

    !> Follows a step; `ended` tells that an event has, which is then `self%event`.
    subroutine see(self, here, together, before, state, ended)
        class(event_watch), intent(inout) :: self
        type(fault), intent(in) :: here
        type(team), intent(in) :: together
        type(step_start), intent(in) :: before
        type(fault_state), intent(in) :: state      !! the end of the step
        logical, intent(out) :: ended
        real(dp) :: rate, rate_before, crossing, mean(here%n)

        rate_before = self%largest_rate
        rate = together%largest(maxval(state%rate))
        self%largest_rate = rate
        ended = .false.
        if ((rate > here%plan%seismic_rate) .neqv. self%on) then
            crossing = before%time   ! a run may start in an event
            if ((rate_before > here%plan%seismic_rate) .eqv. self%on) crossing = &
                crossing_time(here, together, before, state, self%on)
            if (self%on) then
                call self%finish_event(here, together, crossing, before%slip_at(crossing, state))
                ended = .true.
            else
                self%on = .true.
                self%slip_before = before%slip_at(crossing, state)
                self%took_part = 0.0_dp
                self%event = fault_event(onset=crossing)
                self%event%first_cell = fastest_cell(here, together, state, rate)
            end if
        end if
        if (.not. self%on) return
        self%event%peak_rate = max(self%event%peak_rate, rate_before, rate)
        if (here%plan%explicit) then   ! else rates may jump within the step
            mean = (state%slip - before%slip) / (state%time - before%time)
            self%event%peak_rate = max(self%event%peak_rate, &
                together%largest(maxval(largest_within(before%rate, state%rate, mean))))
        end if
        where (state%rate > here%plan%seismic_rate) self%took_part = 1.0_dp
    end subroutine see

    !> When the first cell exceeds the seismic rate in a step, or the last one no longer does: by
    !> the cubic of its slip, whose rate comes to a rate between those of both ends once.
    real(dp) function crossing_time(here, together, before, state, falls) result(time)
        type(fault), intent(in) :: here
        type(team), intent(in) :: together
        type(step_start), intent(in) :: before
        type(fault_state), intent(in) :: state   !! at the end of the step
        logical, intent(in) :: falls             !! the largest rate does
        real(dp) :: dt, part(here%n)

        dt = state%time - before%time
        part = part_until(before%rate, state%rate, (state%slip - before%slip) / dt, &
            here%plan%seismic_rate)
        if (falls) then
            part = merge(part, 0.0_dp, before%rate > here%plan%seismic_rate)
            time = before%time + dt * together%largest(maxval(part))
        else
            part = merge(part, 1.0_dp, state%rate > here%plan%seismic_rate)
            time = before%time - dt * together%largest(maxval(-part))
        end if
    end function crossing_time

    !> Part of a step after which its rate is a number between those of its ends, the rate being
    !> the parabola that these and their mean tell.
    elemental real(dp) function part_until(first, last, mean, rate) result(part)
        real(dp), intent(in) :: first, last, mean, rate
        real(dp) :: a, b, c, q

        a = 3.0_dp * (first + last - 2.0_dp * mean)
        b = 6.0_dp * mean - 4.0_dp * first - 2.0_dp * last
        c = first - rate
        q = -0.5_dp * (b + sign(sqrt(max(b**2 - 4.0_dp * a * c, 0.0_dp)), b))
        part = 0.0_dp
        if (abs(q) > 0.0_dp) part = c / q
        if (.not. (part >= 0.0_dp .and. part <= 1.0_dp) .and. abs(a) > 0.0_dp) part = q / a
        part = max(0.0_dp, min(1.0_dp, part))
    end function part_until

    !> The largest rate of that parabola in the step.
    elemental real(dp) function largest_within(first, last, mean) result(rate)
        real(dp), intent(in) :: first, last, mean
        real(dp) :: a, b

        a = 3.0_dp * (first + last - 2.0_dp * mean)
        b = 6.0_dp * mean - 4.0_dp * first - 2.0_dp * last
        rate = max(first, last)
        if (b > 0.0_dp .and. b < -2.0_dp * a) rate = first - 0.25_dp * b**2 / a
    end function largest_within

    !> Number of the cell, from 1, along strike first; of several the first one.
    integer(int64) function fastest_cell(here, together, state, rate) result(number)
        type(fault), intent(in) :: here
        type(team), intent(in) :: together
        type(fault_state), intent(in) :: state
        real(dp), intent(in) :: rate   !! the largest

        number = huge(number)
        if (any(state%rate >= rate)) number = findloc(state%rate >= rate, .true., dim=1) &
            + int(here%plan%nx, int64) * (here%part%first - 1)
        number = together%lowest(number)
    end function fastest_cell

    subroutine finish_event(self, here, together, time, slip_then)
        class(event_watch), intent(inout) :: self
        type(fault), intent(in) :: here
        type(team), intent(in) :: together
        real(dp), intent(in) :: time
        real(dp), intent(in) :: slip_then(:)   !! at that time [L]
        real(dp) :: slip(here%n), cells

        self%on = .false.
        self%events = self%events + 1
        slip = slip_then - self%slip_before
        self%event%duration = time - self%event%onset
        self%event%largest_slip = together%largest(maxval(slip))
        cells = here%part%row_sums(together, self%took_part)
        self%event%mean_slip = here%part%row_sums(together, slip * self%took_part) &
            / max(cells, 1.0_dp)
        self%event%potency = here%part%row_sums(together, slip) * here%plan%cell_area()
    end subroutine finish_event

end module fault_events
