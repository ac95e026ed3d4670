!> Times of repetitions, and what to report of them.
module stopwatch
    use, intrinsic :: iso_fortran_env, only : dp => real64, int64
    implicit none
    private

    public :: repetitions_for, timer

    !> Collects the time of each repetition: what lies between `start` and `stop` counts.
    type :: timer
        private
        real(dp), allocatable :: laps(:)   !! [s], ascending
        integer(int64) :: started = 0      !! ticks
    contains
        procedure :: start
        procedure :: stop => stop_lap
        procedure :: median
        procedure :: lowest
    end type timer

contains

    !> How often to repeat a measurement over `n` points: often where a repetition is short.
    pure function repetitions_for(n) result(repetitions)
        integer, intent(in) :: n   !! points in a repetition
        integer :: repetitions     !! odd, 11 to 501

        repetitions = max(11, min(501, 20000000 / n))
        repetitions = repetitions + 1 - mod(repetitions, 2)
    end function repetitions_for

    subroutine start(self)
        class(timer), intent(inout) :: self

        if (.not. allocated(self%laps)) allocate (self%laps(0))
        call system_clock(self%started)
    end subroutine start

    subroutine stop_lap(self)
        class(timer), intent(inout) :: self
        integer(int64) :: stopped, rate
        real(dp) :: lap
        integer :: place

        call system_clock(stopped, rate)
        lap = real(stopped - self%started, dp) / real(rate, dp)
        place = count(self%laps < lap)
        self%laps = [self%laps(:place), lap, self%laps(place + 1:)]
    end subroutine stop_lap

    pure function median(self) result(time)
        class(timer), intent(in) :: self
        real(dp) :: time   !! [s]
        integer :: n

        n = size(self%laps)
        time = 0.5_dp * (self%laps((n + 1) / 2) + self%laps(n / 2 + 1))
    end function median

    pure function lowest(self) result(time)
        class(timer), intent(in) :: self
        real(dp) :: time   !! [s]

        time = self%laps(1)
    end function lowest

end module stopwatch
