!> Return mapping: the slip at which the elastic spring and the friction law carry the same
!> traction.
!>
!> One scalar equation in the slip s (docs/theory.md, section 3),
!>
!>     g(s) = trial - stiffness*s - resistance(s) = 0,   g(0) > 0,   g(trial/stiffness) <= 0,
!>
!> whatever the law. Its first root counted from s = 0 is the equilibrium that the contact reaches
!> first. The law's own fast solution is taken where it has one; otherwise a search with a
!> guaranteed bracket. The search does not need the spring's line to be straight: it follows any
!> curve on which the traction falls ever more slowly with the slip (`return_along`).
module friction_return_map
    use friction_kinds, only : wp
    use friction_law, only : law, law_state, sliding
    use friction_status, only : friction_no_convergence, friction_ok, friction_snap_back
    implicit none
    private

    public :: return_along, return_map, unloading, unloaded

    !> A point of the curve along which the spring unloads while the surface slides.
    type :: unloaded
        real(wp) :: slip        !! [L]
        real(wp) :: traction    !! that the spring still carries [F/L^2]
        real(wp) :: stiffness   !! -d(traction)/d(slip), > 0 [F/L^3]
        real(wp) :: rate        !! d(slip)/dx, > 0
    end type unloaded

    !> That curve, with its parameter x: from 0, the trial, to `x_end`, where nothing is left. The
    !> stiffness must not rise with x. Here it is a straight line, and x the slip.
    type :: unloading
        real(wp) :: trial       !! tangential traction without slip [F/L^2]
        real(wp) :: stiffness   !! at x = 0 [F/L^3]
        real(wp) :: x_end       !! for the line trial/stiffness
    contains
        procedure :: at => on_a_line
    end type unloading

    !> What else the equation needs.
    type :: load
        real(wp) :: pressure    !! [F/L^2]
        real(wp) :: dt          !! [T]
        type(law_state) :: old  !! state at the start of the increment
    end type load

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
        real(wp) :: slip
        logical :: solved

        status = friction_ok
        call surface%solve(trial, stiffness, pressure, dt, old, answer, solved)
        if (solved) return
        call return_along(surface, unloading(trial, stiffness, trial / stiffness), pressure, dt, &
            old, answer, slip, status)
    end subroutine return_map

    !> The same along any unloading curve, by the search alone.
    pure subroutine return_along(surface, spring, pressure, dt, old, answer, x, status)
        class(law), intent(in) :: surface
        class(unloading), intent(in) :: spring
        real(wp), intent(in) :: pressure       !! contact pressure, > 0 [F/L^2]
        real(wp), intent(in) :: dt             !! increment of time, >= 0 [T]
        type(law_state), intent(in) :: old     !! state at the start of the increment
        type(sliding), intent(out) :: answer   !! the equilibrium
        real(wp), intent(out) :: x             !! where it is on the curve
        integer, intent(out) :: status         !! ok, snap back, or no convergence
        real(wp), parameter :: apart = 1.0e-6_wp   !! relative distance of roots that can be told
                                                   !! apart
        type(load) :: this
        type(unloaded) :: there
        type(sliding) :: slid
        real(wp) :: from, low, high, g
        logical :: found, alone

        this = load(pressure, dt, old)
        status = friction_ok
        x = 0.0_wp
        call slide_to(surface, spring, this, x, there, answer, g)
        if (g > 0.0_wp) then   ! else the trial is above the strength by round-off alone
            call next_root(surface, spring, this, x, there, g, low, high, found, alone)
            if (.not. found) low = high
            call bracketed_newton(surface, spring, this, low, high, x, there, answer, status)
            if (status /= friction_ok .or. alone) return
        end if
        ! Close to zero slip, two roots also have to differ by more than round-off of the trial.
        from = x + max(apart * x, 100.0_wp * epsilon(apart) * spring%trial &
            / (there%stiffness * there%rate))
        if (from >= spring%x_end) return
        call slide_to(surface, spring, this, from, there, slid, g)
        call next_root(surface, spring, this, from, there, g, low, high, found, alone)
        if (found) status = friction_snap_back
    end subroutine return_along

    pure subroutine on_a_line(self, x, there)
        class(unloading), intent(in) :: self
        real(wp), intent(in) :: x   !! slip [L]
        type(unloaded), intent(out) :: there

        there%slip = x
        there%traction = self%trial - self%stiffness * x
        there%stiffness = self%stiffness
        there%rate = 1.0_wp
    end subroutine on_a_line

    !> Walks from `from` over stretches of the curve that cannot hold a root of g, to the first that
    !> does.
    !>
    !> With L the most that g can rise per slip between a and b, [a, b] holds no root if
    !> g(b) > L (b - a) > 0 or g(a) < -L (b - a) < 0, and one at most if L <= 0. The spring unloads
    !> most slowly at the end of a stretch.
    pure subroutine next_root(surface, spring, this, from, start, g_start, low, high, found, &
        alone)
        class(law), intent(in) :: surface
        class(unloading), intent(in) :: spring
        type(load), intent(in) :: this
        real(wp), intent(in) :: from         !! x at which the walk starts, before the end
        type(unloaded), intent(in) :: start  !! the spring there
        real(wp), intent(in) :: g_start      !! g there [F/L^2]
        real(wp), intent(out) :: low, high   !! the stretch: x on either side of the root
        logical, intent(out) :: found        !! false: no root up to the end of the curve
        logical, intent(out) :: alone        !! no other root follows
        integer, parameter :: max_stretches = 5000
        type(sliding) :: there
        type(unloaded) :: first, last
        real(wp) :: width, g_low, g_high, rise
        integer :: stretch

        low = from
        first = start
        g_low = g_start
        found = .false.
        alone = .false.
        width = spring%x_end - low
        do stretch = 1, max_stretches
            high = min(low + width, spring%x_end)
            call slide_to(surface, spring, this, high, last, there, g_high)
            rise = max(0.0_wp, surface%weakening(first%slip, last%slip, this%pressure, this%dt, &
                this%old) - last%stiffness) * (last%slip - first%slip)
            if (g_high > rise .or. g_low < -rise) then
                if (high >= spring%x_end) return
                low = high
                first = last
                g_low = g_high
                width = 2.0_wp * width
            else
                found = g_low > 0.0_wp .and. .not. rise > 0.0_wp   ! down through zero
                alone = found .and. high >= spring%x_end
                found = found .or. (g_low <= 0.0_wp .and. g_high > 0.0_wp) &   ! up through zero
                    .or. width <= epsilon(width) * high            ! touches zero
                if (found) return
                width = 0.25_wp * width
            end if
        end do
        found = .true.   ! grazes zero over a long way
    end subroutine next_root

    !> Root of g between `a`, where g > 0, and `b`, where g <= 0. The bracket may start at zero
    !> slip, where the resistance can rise at any rate: bisection then halves the exponent, not the
    !> number.
    pure subroutine bracketed_newton(surface, spring, this, a, b, x, there, answer, status)
        class(law), intent(in) :: surface
        class(unloading), intent(in) :: spring
        type(load), intent(in) :: this
        real(wp), intent(in) :: a, b   !! the bracket
        real(wp), intent(out) :: x     !! the root
        type(unloaded), intent(out) :: there
        type(sliding), intent(out) :: answer
        integer, intent(out) :: status
        integer, parameter :: max_iterations = 200
        real(wp) :: low, high, next, g, fall
        integer :: iteration

        low = a
        high = b
        x = high
        status = friction_ok
        do iteration = 1, max_iterations
            call slide_to(surface, spring, this, x, there, answer, g)
            if (g > 0.0_wp) then
                low = x
            else
                high = x
            end if
            fall = max(there%stiffness + answer%d_slip, epsilon(fall) * there%stiffness)
            next = x + g / (fall * there%rate)
            if (abs(next - x) <= 2.0_wp * epsilon(x) * x .or. high - low <= 2.0_wp * epsilon(x) &
                * high) return
            if (.not. (next > low .and. next < high)) next = middle(low, high)
            x = next
        end do
        ! A root in the round-off of zero slip has no place of its own.
        if (abs(g) > 100.0_wp * epsilon(g) * spring%trial) status = friction_no_convergence
    end subroutine bracketed_newton

    pure function middle(low, high) result(x)
        real(wp), intent(in) :: low, high   !! 0 <= low < high
        real(wp) :: x

        if (high <= 4.0_wp * low) then
            x = 0.5_wp * (low + high)
        else
            x = sqrt(max(low, 1.0e-8_wp * high)) * sqrt(high)
        end if
    end function middle

    !> Spring and law at x, and g there.
    pure subroutine slide_to(surface, spring, this, x, there, slid, g)
        class(law), intent(in) :: surface
        class(unloading), intent(in) :: spring
        type(load), intent(in) :: this
        real(wp), intent(in) :: x
        type(unloaded), intent(out) :: there
        type(sliding), intent(out) :: slid
        real(wp), intent(out) :: g          !! [F/L^2]

        call spring%at(x, there)
        slid%slip = there%slip
        call surface%slide(slid%slip, this%pressure, this%dt, this%old, slid%state, &
            slid%resistance, slid%d_slip, slid%d_pressure)
        g = there%traction - slid%resistance
    end subroutine slide_to

end module friction_return_map
