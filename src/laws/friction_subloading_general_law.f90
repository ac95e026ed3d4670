!> The subloading law with another choice of the function U in
!>
!>     R_dot = m U(R) |v_p|
!>
!> which falls from infinity at R = 0 to zero at R = 1: instead of `-ln R`
!>
!>     U(R) = cot(pi R/2)     or     U(R) = 1/R - 1
!>
!> Backward Euler as in module `friction_subloading_law`; R(s) is the root in [R_n, 1] of
!>
!>     R - R_n = m s U(R)
!>
!> 1/U is convex, so R rises ever slower with s.
module friction_subloading_general_law
    use friction_kinds, only : wp
    use friction_law, only : law_state, sliding, unbounded
    use friction_subloading_general_core, only : half_pi, reciprocal_root, start_slip
    use friction_subloading_law, only : subloading_law, u_reciprocal
    implicit none
    private

    public :: subloading_general_law

    type, extends(subloading_law) :: subloading_general_law
    contains
        procedure :: slide
        procedure :: solve
        procedure :: u_of
    end type subloading_general_law

contains

    pure subroutine slide(self, slip, pressure, dt, old, new, resistance, d_slip, d_pressure)
        class(subloading_general_law), intent(in) :: self
        real(wp), intent(in) :: slip, pressure, dt
        type(law_state), intent(in) :: old
        type(law_state), intent(out) :: new
        real(wp), intent(out) :: resistance, d_slip, d_pressure
        real(wp) :: fall, rate

        call friction_coefficient(self, slip, dt, old, new%mu, fall)
        call similarity_ratio(self, old%r, slip, new%r, rate)
        d_pressure = new%r * new%mu
        resistance = d_pressure * pressure + new%r * self%cohesion
        d_slip = pressure * (min(new%mu * rate, unbounded) - new%r * fall) + min(self%cohesion &
            * rate, unbounded)
    end subroutine slide

    !> Newton's method in the slip, bracketed, where there can be one equilibrium only.
    pure subroutine solve(self, trial, stiffness, pressure, dt, old, answer, solved)
        class(subloading_general_law), intent(in) :: self
        real(wp), intent(in) :: trial, stiffness, pressure, dt
        type(law_state), intent(in) :: old
        type(sliding), intent(out) :: answer
        logical, intent(out) :: solved
        integer, parameter :: max_iterations = 30
        real(wp) :: mu, fall, s, low, high, slope, step, small
        integer :: iteration

        solved = .false.
        call friction_coefficient(self, 0.0_wp, dt, old, mu, fall)
        if (stiffness <= pressure * fall) return   ! several equilibria possible
        small = 0.1_wp * sqrt(epsilon(small))      ! the next error is about the square of a step
        low = 0.0_wp
        high = trial / stiffness
        s = start_slip(self%m, old%r, mu * pressure + self%cohesion, trial, stiffness)
        do iteration = 1, max_iterations
            answer%slip = s
            call slide(self, s, pressure, dt, old, answer%state, answer%resistance, &
                answer%d_slip, answer%d_pressure)
            if (solved) return
            slope = stiffness + answer%d_slip
            step = (trial - stiffness * s - answer%resistance) / slope
            if (step > 0.0_wp) then
                low = s
            else
                high = s
            end if
            solved = abs(step) <= max(small * s, epsilon(step) * trial / slope)
            s = s + step
            if (.not. (solved .or. (s > low .and. s < high))) s = 0.5_wp * (low + high)
            s = max(s, 0.0_wp)
        end do
        solved = .false.
    end subroutine solve

    pure function u_of(self, r) result(u)
        class(subloading_general_law), intent(in) :: self
        real(wp), intent(in) :: r
        real(wp) :: u

        if (self%u_of_r == u_reciprocal) then
            u = (1.0_wp - r) / r
        else
            u = sin(half_pi * (1.0_wp - r)) / sin(half_pi * r)
        end if
    end function u_of

    !> mu after a slip, and -d(mu)/ds, which is never negative and shrinks with the slip.
    pure subroutine friction_coefficient(self, slip, dt, old, mu, fall)
        class(subloading_general_law), intent(in) :: self
        real(wp), intent(in) :: slip          !! in the increment, >= 0 [L]
        real(wp), intent(in) :: dt            !! increment of time, >= 0 [T]
        type(law_state), intent(in) :: old    !! state at the start of the increment
        real(wp), intent(out) :: mu           !! within its bounds in spite of round-off [-]
        real(wp), intent(out) :: fall         !! -d(mu)/ds [1/L]
        real(wp) :: c, w

        c = (old%mu - self%mu_k) + self%xi * dt * (self%mu_s - self%mu_k)
        w = 1.0_wp + self%kappa * slip + self%xi * dt
        mu = min(max(self%mu_k + c / w, self%mu_k), self%mu_s)
        fall = (self%kappa / w) * (c / w)
    end subroutine friction_coefficient

    !> R after a slip, and dR/ds.
    pure subroutine similarity_ratio(self, r_n, slip, r, rate)
        class(subloading_general_law), intent(in) :: self
        real(wp), intent(in) :: r_n    !! R at the start of the increment, 0 to 1 [-]
        real(wp), intent(in) :: slip   !! slip in the increment, >= 0 [L]
        real(wp), intent(out) :: r     !! R at its end [-]
        real(wp), intent(out) :: rate  !! [1/L]
        real(wp), parameter :: least = 1.0e-201_wp   ! below R = 1e-100 the rate stays in range
        real(wp) :: e, ms, sine, cosine

        ms = self%m * slip
        if (self%u_of_r == u_reciprocal) then
            call reciprocal_root(r_n, ms, r, e)
            rate = self%m * e * r / (r**2 + ms + least)
        else
            call cotangent_root(r_n, ms, r, e)
            sine = sin(half_pi * r)
            cosine = sin(half_pi * e)
            rate = self%m * cosine * sine / (sine**2 + half_pi * ms + least)
        end if
    end subroutine similarity_ratio

    !> The root of `R - R_n = ms cot(pi R/2)` by Newton's method from the left, where it climbs
    !> without fail because the equation is concave: `cot(pi R/2) >= (1/R - 1)/(pi/2)`.
    pure subroutine cotangent_root(r_n, ms, r, e)
        real(wp), intent(in) :: r_n     !! R at the start of the increment [-]
        real(wp), intent(in) :: ms      !! m times the slip, >= 0 [-]
        real(wp), intent(out) :: r, e   !! R at its end, and 1 - R [-]
        integer, parameter :: max_iterations = 100
        real(wp) :: sine, cosine, gain, dr
        integer :: iteration

        call reciprocal_root(r_n, ms / half_pi, r, e)
        if (.not. (ms > 0.0_wp .and. e > 0.0_wp)) return
        do iteration = 1, max_iterations
            sine = sin(half_pi * r)
            cosine = sin(half_pi * e)
            gain = sine / (sine**2 + half_pi * ms)
            if (r < 0.5_wp) then
                dr = gain * (ms * cosine - (r - r_n) * sine)
                r = r + dr
                e = 1.0_wp - r
            else   ! 1 - R is the number that counts
                dr = gain * (ms * cosine - ((1.0_wp - r_n) - e) * sine)
                e = e - dr
                r = 1.0_wp - e
            end if
            if (abs(dr) <= 0.1_wp * sqrt(epsilon(dr)) * min(r, e)) exit
        end do
    end subroutine cotangent_root

end module friction_subloading_general_law
