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
        logical :: by_lines = .false.
        real(dp) :: begun = 0.0_dp, last = 0.0_dp   !! wall-clock times [s]
        real(dp) :: first = 0.0_dp   !! part that was done before
    contains
        procedure :: begin, show, clear
    end type progress

    integer, parameter :: width = 40

contains

    !> Only on a terminal, and only if wanted, will anything be shown. Where a launcher stands
    !> between (mpirun), which hides the terminal, a line now and then may be shown anyway.
    subroutine begin(self, wanted, part, by_lines)
        class(progress), intent(out) :: self
        logical, intent(in) :: wanted
        real(dp), intent(in) :: part   !! done before, 0 to 1
        logical, intent(in), optional :: by_lines   !! where there is no terminal, lines

        self%shown = wanted .and. is_terminal()
        if (present(by_lines)) self%by_lines = wanted .and. by_lines .and. .not. self%shown
        self%begun = seconds()
        self%last = self%begun
        self%first = part
    end subroutine begin

    !> Call as often as you like; draws five times a second at most.
    subroutine show(self, part)
        class(progress), intent(inout) :: self
        real(dp), intent(in) :: part   !! done so far, 0 to 1
        real(dp), parameter :: between_lines = 10.0_dp   !! [s]
        real(dp) :: now
        integer :: filled, left

        if (.not. (self%shown .or. self%by_lines)) return
        now = seconds()
        if (now - self%last < merge(between_lines, 0.2_dp, self%by_lines)) return
        self%last = now
        left = nint(min(1.0e9_dp, (now - self%begun) * (1.0_dp - part) &
            / max(part - self%first, 1.0e-6_dp)))
        if (self%by_lines) then
            write (error_unit, '(a, i0, a, i0, a)') 'stickslip: ', nint(100.0_dp * part), ' %, ', &
                left, ' s left'
            return
        end if
        filled = nint(width * part)
        write (error_unit, '(6a, i4, a, i0, a)', advance='no') achar(13), '[', &
            repeat('#', filled), repeat('.', width - filled), ']', ' ', nint(100.0_dp * part), &
            ' %, ', left, ' s left    '
        flush (error_unit)
    end subroutine show

    subroutine clear(self)
        class(progress), intent(in) :: self

        if (self%shown) write (error_unit, '(3a)', advance='no') achar(13), &
            repeat(' ', width + 30), achar(13)
    end subroutine clear

end module progress_bar
