!> Return mapping: the slip at which the elastic spring and the friction law carry the same
!> traction.
!>
!> One scalar equation in the slip s (docs/theory.md, section 3),
!>
!>     g(s) = trial - stiffness*s - resistance(s) = 0,   g(0) > 0,   g(trial/stiffness) <= 0,
!>
!> whatever the law. Its first root counted from s = 0 is the equilibrium that the contact reaches
!> first. The law's own fast solution is taken where it has one; otherwise a search that proves,
!> stretch by stretch, that it passes no root (docs/theory.md, section 12). The search does not need
!> the spring's line to be straight: it follows any curve on which the traction falls ever more
!> slowly with the slip (`return_along`).
!>
!> A law with a shear cap resists with the smaller of its own resistance and the cap. As long as the
!> spring pulls harder than the cap there is no equilibrium; from there on the law alone counts.
module friction_return_map
    use friction_kinds, only : wp
    use friction_law, only : law, law_state, sliding, unbounded
    use friction_status, only : friction_no_convergence, friction_ok, friction_snap_back
    implicit none
    private

    public :: middle, return_along, return_map, unloading, unloaded

    !> A point of the curve along which the spring unloads while the surface slides.
    type :: unloaded
        real(wp) :: slip        !! [L]
        real(wp) :: traction    !! that the spring still carries [F/L^2]
        real(wp) :: stiffness   !! -d(traction)/d(slip), > 0 [F/L^3]
        real(wp) :: rate        !! d(slip)/dx, > 0
        real(wp) :: scale       !! of the terms of the traction, whose round-off it has [F/L^2]
    end type unloaded

    !> That curve, with its parameter x: from 0, the trial, to `x_end`, where nothing is left. The
    !> stiffness must not rise with x. Here it is a straight line, and x the slip.
    type :: unloading
        real(wp) :: trial       !! tangential traction without slip [F/L^2]
        real(wp) :: stiffness   !! tangential stiffness [F/L^3]
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

    !> Spring and law at a point of the curve.
    type :: place
        real(wp) :: x
        type(unloaded) :: spring
        type(sliding) :: law    !! without the cap
        real(wp) :: g           !! how much harder the spring pulls than the law resists [F/L^2]
    end type place

    !> Part of the curve between two places.
    type :: stretch
        type(place) :: first, last
        logical :: holds_root   !! false: no root up to the end of the curve
    end type stretch

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
        type(unloading) :: spring
        type(load) :: this
        type(place) :: here
        logical :: capped, solved, started

        spring = unloading(trial, stiffness, trial / stiffness)
        this = load(pressure, dt, old)
        status = friction_ok
        capped = trial > surface%tau_max
        started = capped
        if (started) then
            call find_start(surface, spring, this, here)
            capped = here%g <= 0.0_wp
        end if
        if (.not. capped) then
            call surface%solve(trial, stiffness, pressure, dt, old, answer, solved)
            if (solved) return
            if (.not. started) call find_start(surface, spring, this, here)
        end if
        call return_from(surface, spring, this, here, status)
        answer = here%law
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
        type(load) :: this
        type(place) :: here

        this = load(pressure, dt, old)
        call find_start(surface, spring, this, here)
        call return_from(surface, spring, this, here, status)
        answer = here%law
        x = here%x
    end subroutine return_along

    !> Where the search starts: at the trial, or where the spring is down at the cap. There g tells
    !> whether the law itself resists less than its cap.
    pure subroutine find_start(surface, spring, this, here)
        class(law), intent(in) :: surface
        class(unloading), intent(in) :: spring
        type(load), intent(in) :: this
        type(place), intent(out) :: here

        here%x = 0.0_wp
        if (spring%trial > surface%tau_max) call unload_to(surface%tau_max, spring, here%x)
        call slide_to(surface, spring, this, here)
        if (here%x > 0.0_wp) here%g = surface%tau_max - here%law%resistance
    end subroutine find_start

    !> The first equilibrium from the start of the search on, and whether another one follows.
    pure subroutine return_from(surface, spring, this, here, status)
        class(law), intent(in) :: surface
        class(unloading), intent(in) :: spring
        type(load), intent(in) :: this
        type(place), intent(inout) :: here     !! in: the start, out: the equilibrium
        integer, intent(out) :: status         !! ok, snap back, or no convergence
        type(place) :: start
        type(stretch) :: part
        type(unloaded) :: end_

        status = friction_ok
        part%last = here
        if (here%g > 0.0_wp) then
            start = here
            call next_root(surface, spring, this, start, part, status)
            if (status == friction_ok) call pin_down(surface, spring, this, part, here, status)
            if (status < 0) return
        else if (here%x > 0.0_wp) then   ! the cap holds
            here%law%resistance = surface%tau_max
            here%law%d_slip = 0.0_wp
            here%law%d_pressure = 0.0_wp
        end if   ! else the trial is above the strength by round-off alone

        if (part%last%x >= spring%x_end) return
        call spring%at(spring%x_end, end_)
        if (surface%steepest_fall(this%pressure, this%dt, this%old) < end_%stiffness) return
        start = part%last
        call next_root(surface, spring, this, start, part, status)
        if (part%holds_root .or. status < 0) status = friction_snap_back
    end subroutine return_from

    pure subroutine on_a_line(self, x, there)
        class(unloading), intent(in) :: self
        real(wp), intent(in) :: x   !! slip [L]
        type(unloaded), intent(out) :: there

        there%slip = x
        there%traction = self%trial - self%stiffness * x
        there%stiffness = self%stiffness
        there%rate = 1.0_wp
        there%scale = self%trial
    end subroutine on_a_line

    !> Where the spring is down at a traction below its trial: Newton's method from the left, where
    !> a convex curve lets it climb on the root without fail.
    pure subroutine unload_to(traction, spring, x)
        real(wp), intent(in) :: traction      !! [F/L^2]
        class(unloading), intent(in) :: spring
        real(wp), intent(out) :: x
        integer, parameter :: max_iterations = 200
        type(unloaded) :: there
        real(wp) :: step
        integer :: iteration

        x = 0.0_wp
        do iteration = 1, max_iterations
            call spring%at(x, there)
            step = max((there%traction - traction) / (there%stiffness * there%rate), 0.0_wp)
            x = min(x + step, spring%x_end)
            if (step <= epsilon(step) * x) exit
        end do
    end subroutine unload_to

    !> Walks over stretches of the curve that are proven to hold no root of g, to the first that
    !> holds one. Where g comes down through zero it falls all the way along that stretch, so that
    !> there is one root in it.
    pure subroutine next_root(surface, spring, this, from, part, status)
        class(law), intent(in) :: surface
        class(unloading), intent(in) :: spring
        type(load), intent(in) :: this
        type(place), intent(in) :: from      !! where the walk starts, before the end
        type(stretch), intent(out) :: part   !! where it ends
        integer, intent(out) :: status       !! ok or no convergence
        integer, parameter :: max_stretches = 2000
        real(wp) :: width, least, most
        integer :: step
        logical :: crosses, thin, passed

        status = friction_ok
        part%first = from
        width = spring%x_end - from%x
        do step = 1, max_stretches
            part%last%x = spring%x_end
            if (width < spring%x_end - part%first%x) part%last%x = part%first%x + width
            call slide_to(surface, spring, this, part%last)
            call surface%slopes(part%first%law, part%last%law, this%pressure, this%dt, this%old, &
                least, most)
            least = least + part%last%spring%stiffness   ! the spring unloads ever more slowly
            most = most + part%first%spring%stiffness

            thin = part%last%x - part%first%x <= 2.0_wp * epsilon(width) * part%last%x
            crosses = (part%first%g > 0.0_wp) .neqv. (part%last%g > 0.0_wp)
            part%holds_root = crosses .and. (thin .or. least >= 0.0_wp .or. part%last%g > 0.0_wp)
            if (part%holds_root) return
            passed = .false.
            if (.not. crosses) passed = thin .or. keeps_sign(part, least, most)
            if (passed) then
                if (part%last%x >= spring%x_end) return
                part%first = part%last
                width = 2.0_wp * width
            else
                width = 0.25_wp * (part%last%x - part%first%x)
            end if
        end do
        status = friction_no_convergence
    end subroutine next_root

    !> Is g above zero (or below it) all along a stretch, if it falls per slip by `least` to `most`?
    !> The straight lines from both ends with the steepest slopes that this allows enclose it.
    pure function keeps_sign(part, least, most) result(keeps)
        type(stretch), intent(in) :: part      !! g has the same sign at both ends
        real(wp), intent(in) :: least, most    !! [F/L^3]
        logical :: keeps
        real(wp) :: first, last, approach, retreat, share

        first = abs(part%first%g)
        last = abs(part%last%g)
        approach = most     ! to zero
        retreat = -least    ! from it, all that `last` can have gained on the way
        if (.not. part%first%g > 0.0_wp) then
            approach = -least
            retreat = most
        end if
        keeps = retreat <= 0.0_wp .or. approach <= 0.0_wp
        if (keeps .or. retreat >= unbounded) return
        last = last - retreat * (part%last%law%slip - part%first%law%slip)
        keeps = last > 0.0_wp
        if (keeps .or. approach >= unbounded) return
        share = retreat / (retreat + approach)
        keeps = share * first + (1.0_wp - share) * last > 0.0_wp
    end function keeps_sign

    !> The root of g in a stretch along which it falls through zero; or its end, where only
    !> round-off is left of the traction. The stretch may start at zero slip, where the resistance
    !> can rise at any rate: bisection then halves the exponent, not the number.
    pure subroutine pin_down(surface, spring, this, part, root, status)
        class(law), intent(in) :: surface
        class(unloading), intent(in) :: spring
        type(load), intent(in) :: this
        type(stretch), intent(in) :: part
        type(place), intent(out) :: root
        integer, intent(out) :: status     !! ok or no convergence
        integer, parameter :: max_iterations = 200
        real(wp), parameter :: round_off = epsilon(round_off)
        real(wp) :: low, high, next, step, last_step, fall, scale
        integer :: iteration

        low = part%first%x
        high = part%last%x
        root = part%last
        last_step = high - low
        do iteration = 1, max_iterations
            fall = (root%spring%stiffness + root%law%d_slip) * root%spring%rate
            scale = root%spring%scale + root%law%resistance
            if (abs(root%g) <= round_off * scale .or. high - low <= 2.0_wp * round_off * high) exit
            if (root%g > 0.0_wp) then
                low = root%x
            else
                high = root%x
            end if
            next = middle(low, high)
            if (fall > 0.0_wp .and. abs(root%g) < 0.5_wp * fall * last_step) then
                step = root%g / fall
                if (abs(step) <= round_off * root%x) exit
                if (root%x + step > low .and. root%x + step < high) next = root%x + step
            end if
            last_step = abs(next - root%x)
            root%x = next
            call slide_to(surface, spring, this, root)
        end do
        status = friction_ok
        if (root%law%slip > tiny(high)) then
            call surface%settle(root%g, root%spring%stiffness, this%pressure, root%law)
        else   ! the slip is in the underflow
            call surface%settle(root%g, tiny(high), this%pressure, root%law)
            root%g = root%spring%traction - root%law%resistance
        end if
        if (abs(root%g) <= 100.0_wp * round_off * (scale + root%x * abs(fall))) return
        scale = scale + surface%scale_of_terms(root%law, this%dt, this%old)
        if (abs(root%g) <= 100.0_wp * round_off * (scale + root%x * abs(fall))) return
        status = friction_no_convergence
    end subroutine pin_down

    !> Halves a bracket: by its exponents where its ends are of different size.
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
    pure subroutine slide_to(surface, spring, this, there)
        class(law), intent(in) :: surface
        class(unloading), intent(in) :: spring
        type(load), intent(in) :: this
        type(place), intent(inout) :: there   !! x in, all the rest out

        call spring%at(there%x, there%spring)
        there%law%slip = there%spring%slip
        call surface%slide(there%law%slip, this%pressure, this%dt, this%old, there%law%state, &
            there%law%resistance, there%law%d_slip, there%law%d_pressure)
        there%g = there%spring%traction - there%law%resistance
    end subroutine slide_to

end module friction_return_map
