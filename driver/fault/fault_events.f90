!> Events: times in which a part of the fault slips faster than `seismic_rate`.
module fault_events
    use, intrinsic :: iso_fortran_env, only : dp => real64, int64
    use fault_problem, only : fault, fault_state
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
    subroutine see(self, here, together, time_before, state, ended)
        class(event_watch), intent(inout) :: self
        type(fault), intent(in) :: here
        type(team), intent(in) :: together
        real(dp), intent(in) :: time_before         !! start of the step [T]
        type(fault_state), intent(in) :: state      !! its end
        logical, intent(out) :: ended
        real(dp) :: rate, rate_before, crossing, part

        rate_before = self%largest_rate
        rate = together%largest(maxval(state%rate))
        self%largest_rate = rate
        ended = .false.
        if ((rate > here%plan%seismic_rate) .neqv. self%on) then
            ! the logarithm of the largest rate is taken as linear in the step; a run may start
            ! in an event
            part = 0.0_dp
            if ((rate_before > here%plan%seismic_rate) .eqv. self%on) part = max(0.0_dp, &
                min(1.0_dp, log(here%plan%seismic_rate / max(rate_before, tiny(rate))) &
                / log(max(rate, tiny(rate)) / max(rate_before, tiny(rate)))))
            crossing = time_before + (state%time - time_before) * part
            if (self%on) then
                call self%finish_event(here, together, crossing, state)
                ended = .true.
            else
                self%on = .true.
                self%slip_before = state%slip - state%rate * (state%time - crossing)
                self%took_part = 0.0_dp
                self%event = fault_event(onset=crossing)
                self%event%first_cell = fastest_cell(here, together, state, rate)
            end if
        end if
        if (.not. self%on) return
        self%event%peak_rate = max(self%event%peak_rate, rate_before, rate)
        where (state%rate > here%plan%seismic_rate) self%took_part = 1.0_dp
    end subroutine see

    !> Number of the cell, from 1, along strike first; of several the first one.
    function fastest_cell(here, together, state, rate) result(number)
        type(fault), intent(in) :: here
        type(team), intent(in) :: together
        type(fault_state), intent(in) :: state
        real(dp), intent(in) :: rate   !! the largest
        integer(int64) :: number

        number = huge(number)
        if (any(state%rate >= rate)) number = findloc(state%rate >= rate, .true., dim=1) &
            + int(here%plan%nx, int64) * (here%part%first - 1)
        number = together%lowest(number)
    end function fastest_cell

    subroutine finish_event(self, here, together, time, state)
        class(event_watch), intent(inout) :: self
        type(fault), intent(in) :: here
        type(team), intent(in) :: together
        real(dp), intent(in) :: time
        type(fault_state), intent(in) :: state
        real(dp) :: slip(here%n), cells

        self%on = .false.
        self%events = self%events + 1
        slip = state%slip - self%slip_before
        self%event%duration = time - self%event%onset
        self%event%largest_slip = together%largest(maxval(slip))
        cells = here%part%row_sums(together, self%took_part)
        self%event%mean_slip = here%part%row_sums(together, slip * self%took_part) &
            / max(cells, 1.0_dp)
        self%event%potency = here%part%row_sums(together, slip) * here%plan%cell_area()
    end subroutine finish_event

end module fault_events
