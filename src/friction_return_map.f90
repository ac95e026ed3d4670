!> Return mapping: the slip at which the elastic spring and the friction law carry the same
!> traction.
!>
!> One scalar equation in the slip s (docs/theory.md, section 3),
!>
!>     g(s) = trial - stiffness*s - resistance(s) = 0,   g(0) > 0,   g(trial/stiffness) <= 0,
!>
!> whatever the law. Its first root counted from s = 0 is the equilibrium that the contact reaches
!> first. The law's own fast solution is taken where it has one; otherwise a search with a
!> guaranteed bracket.
module friction_return_map
    use friction_kinds, only : wp
    use friction_law, only : law, law_state, sliding
    use friction_status, only : friction_no_convergence, friction_ok, friction_snap_back
    implicit none
    private

    public :: return_map

    !> The equation's data.
    type :: spring
        real(wp) :: trial       !! tangential traction without slip [F/L^2]
        real(wp) :: stiffness   !! [F/L^3]
        real(wp) :: pressure    !! [F/L^2]
        real(wp) :: dt          !! [T]
        type(law_state) :: old  !! state at the start of the increment
    end type spring

contains

    !> Slip, traction and state of a surface whose trial traction is above its strength.
    pure subroutine return_map(surface, trial, stiffness, pressure, dt, old, answer, status)
        class(law), intent(in) :: surface
        real(wp), intent(in) :: trial   !! tangential traction without slip, above the strength
                                        !! [F/L^2]
        real(wp), intent(in) :: stiffness      !! tangential stiffness, > 0 [F/L^3]
        real(wp), intent(in) :: pressure       !! contact pressure, > 0 [F/L^2]
        real(wp), intent(in) :: dt             !! increment of time, >= 0 [T]
        type(law_state), intent(in) :: old     !! state at the start of the increment
        type(sliding), intent(out) :: answer   !! the equilibrium
        integer, intent(out) :: status         !! ok, snap back, or no convergence
        real(wp), parameter :: apart = 1.0e-6_wp   !! relative distance of roots that can be told
                                                   !! apart
        type(spring) :: this
        real(wp) :: low, high
        logical :: solved, found

        status = friction_ok
        call surface%solve(trial, stiffness, pressure, dt, old, answer, solved)
        if (solved) return

        this = spring(trial, stiffness, pressure, dt, old)
        call next_root(surface, this, 0.0_wp, low, high, found)
        if (.not. found) low = high
        call bracketed_newton(surface, this, low, high, answer, status)
        if (status /= friction_ok) return
        ! Close to zero slip, two roots also have to differ by more than round-off of the trial.
        call next_root(surface, this, answer%slip + max(apart * answer%slip, &
            100.0_wp * epsilon(apart) * trial / stiffness), low, high, found)
        if (found) status = friction_snap_back
    end subroutine return_map

    !> Walks from slip `from` over stretches that cannot hold a root of g, to the first that does.
    !>
    !> With L the most that g can rise per slip between a and b, [a, b] holds no root if
    !> g(b) > L (b - a) > 0 or g(a) < -L (b - a) < 0, and one at most if L <= 0.
    pure subroutine next_root(surface, this, from, low, high, found)
        class(law), intent(in) :: surface
        type(spring), intent(in) :: this
        real(wp), intent(in) :: from         !! slip at which the walk starts [L]
        real(wp), intent(out) :: low, high   !! the stretch: slips on either side of the root [L]
        logical, intent(out) :: found   !! false: no root up to the slip that unloads the spring
        integer, parameter :: max_stretches = 5000
        type(sliding) :: there
        real(wp) :: s_max, width, g_low, g_high, rise
        integer :: stretch

        s_max = this%trial / this%stiffness
        low = from
        high = s_max
        found = .false.
        if (low >= s_max) return
        call slide_to(surface, this, low, there, g_low)
        width = s_max - low
        do stretch = 1, max_stretches
            high = min(low + width, s_max)
            call slide_to(surface, this, high, there, g_high)
            rise = max(0.0_wp, surface%weakening(low, high, this%pressure, this%dt, this%old) &
                - this%stiffness) * (high - low)
            if (g_high > rise .or. g_low < -rise) then
                if (high >= s_max) return
                low = high
                g_low = g_high
                width = 2.0_wp * width
            else
                found = (g_low > 0.0_wp .and. .not. rise > 0.0_wp) &   ! down through zero
                    .or. (g_low <= 0.0_wp .and. g_high > 0.0_wp) &     ! up through zero
                    .or. width <= epsilon(width) * high                ! touches zero
                if (found) return
                width = 0.25_wp * width
            end if
        end do
        found = .true.   ! grazes zero over a long way
    end subroutine next_root

    !> Root of g between `a`, where g > 0, and `b`, where g <= 0. The bracket may start at zero
    !> slip, where the resistance can rise at any rate: bisection then halves the exponent, not the
    !> number.
    pure subroutine bracketed_newton(surface, this, a, b, answer, status)
        class(law), intent(in) :: surface
        type(spring), intent(in) :: this
        real(wp), intent(in) :: a, b   !! the bracket [L]
        type(sliding), intent(out) :: answer
        integer, intent(out) :: status
        integer, parameter :: max_iterations = 200
        real(wp) :: low, high, s, next, g, slope
        integer :: iteration

        low = a
        high = b
        s = high
        status = friction_ok
        do iteration = 1, max_iterations
            call slide_to(surface, this, s, answer, g)
            slope = -this%stiffness - answer%d_slip
            if (g > 0.0_wp) then
                low = s
            else
                high = s
            end if
            next = s - g / min(slope, -epsilon(slope) * this%stiffness)
            if (abs(next - s) <= 2.0_wp * epsilon(s) * s .or. high - low <= 2.0_wp * epsilon(s) &
                * high) return
            if (.not. (next > low .and. next < high)) next = middle(low, high)
            s = next
        end do
        status = friction_no_convergence
    end subroutine bracketed_newton

    pure function middle(low, high) result(s)
        real(wp), intent(in) :: low, high   !! 0 <= low < high
        real(wp) :: s

        if (high <= 4.0_wp * low) then
            s = 0.5_wp * (low + high)
        else
            s = sqrt(max(low, 1.0e-8_wp * high)) * sqrt(high)
        end if
    end function middle

    !> The law after slip `s`, and g there.
    pure subroutine slide_to(surface, this, s, there, g)
        class(law), intent(in) :: surface
        type(spring), intent(in) :: this
        real(wp), intent(in) :: s           !! slip [L]
        type(sliding), intent(out) :: there
        real(wp), intent(out) :: g          !! [F/L^2]

        there%slip = s
        call surface%slide(s, this%pressure, this%dt, this%old, there%state, there%resistance, &
            there%d_slip, there%d_pressure)
        g = this%trial - this%stiffness * s - there%resistance
    end subroutine slide_to

end module friction_return_map
