!> A line on the terminal that says how far a run has come and how long it still takes.
module progress_bar
    use, intrinsic :: iso_fortran_env, only : dp => real64, error_unit
    use platform, only : is_terminal, seconds
    implicit none
    private

    public :: progress

    type :: progress
        private
        logical :: shown = .false.
        real(dp) :: begun = 0.0_dp, last = 0.0_dp   !! wall-clock times [s]
        real(dp) :: first = 0.0_dp   !! part that was done before
    contains
        procedure :: begin, show, clear
    end type progress

    integer, parameter :: width = 40

contains

    !> Only on a terminal, and only if wanted, will anything be shown.
    subroutine begin(self, wanted, part)
        class(progress), intent(out) :: self
        logical, intent(in) :: wanted
        real(dp), intent(in) :: part   !! done before, 0 to 1

        self%shown = wanted .and. is_terminal()
        self%begun = seconds()
        self%last = self%begun
        self%first = part
    end subroutine begin

    !> Call as often as you like; draws five times a second at most.
    subroutine show(self, part)
        class(progress), intent(inout) :: self
        real(dp), intent(in) :: part   !! done so far, 0 to 1
        real(dp) :: now
        integer :: filled

        if (.not. self%shown) return
        now = seconds()
        if (now - self%last < 0.2_dp) return
        self%last = now
        filled = nint(width * part)
        write (error_unit, '(6a, i4, a, i0, a)', advance='no') achar(13), '[', &
            repeat('#', filled), repeat('.', width - filled), ']', ' ', nint(100.0_dp * part), &
            ' %, ', nint((now - self%begun) * (1.0_dp - part) &
            / max(part - self%first, 1.0e-6_dp)), ' s left    '
        flush (error_unit)
    end subroutine show

    subroutine clear(self)
        class(progress), intent(in) :: self

        if (self%shown) write (error_unit, '(3a)', advance='no') achar(13), &
            repeat(' ', width + 30), achar(13)
    end subroutine clear

end module progress_bar
