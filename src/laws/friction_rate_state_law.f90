!> Rate-and-state friction, regularised (Dieterich 1979, Ruina 1983, Rice et al. 2001):
!>
!>     resistance = mu p,   mu = a asinh(e^X),   X = ln(v/(2 v0)) + (f0 + b ln(v0 theta/d_c))/a
!>
!> with v = slip/dt and the state variable theta, a time, as internal variable. It ages or slips,
!>
!>     ageing law:  theta_dot = 1 - v theta/d_c
!>     slip law:    theta_dot = -(v theta/d_c) ln(v theta/d_c)
!>
!> integrated exactly for a constant v in the increment, with x = slip/d_c:
!>
!>     ageing law:  theta = theta_n e^-x + dt (1 - e^-x)/x
!>     slip law:    ln theta = ln theta_n + (1 - e^-x) (ln(dt/x) - ln theta_n)
!>
!> There is no yield point: under any traction the surface creeps, if only by 1e-50 of d_c. Slips
!> that small are the reason why the arithmetic is in logarithms. Below 1e-100 d_c the resistance is
!> taken as proportional to the slip, so that it starts from zero and every number stays in range.
module friction_rate_state_law
    use friction_kinds, only : largest, wp
    use friction_law, only : internal_variable, law_description, law_state, law_traits, &
        load_rates, named_law, onset_gradual, sliding, unbounded
    use friction_law_constants, only : complete_constants, constant_table, law_constant, &
        no_constants, positive
    use friction_rate_state_bounds, only : aged_bounds, aged_fall, joined, may_turn, &
        may_turn_far, may_vanish, pressed_range, ranges, slip_range, slipped_bounds, slipped_fall
    use friction_rate_state_core, only : aged_slope, aged_state, ageing_rate, asinh_exp, &
        fall_of_mean, mean_decay, mean_growth, pressed_by, slip_law_rate, slipped_slope, &
        slope_asinh_exp, &
        state_exponent
    use friction_status, only : friction_bad_property, friction_bad_size
    implicit none
    private

    public :: rate_state_law

    integer, parameter, public :: ageing = 0, slipping = 1   !! values of the constant `evolution`
    integer, parameter, public :: shifted = 2   !! slip law of an extension with a steady state of
                                                !! its own

    type, extends(named_law) :: rate_state_law
        real(wp) :: a         !! direct effect, > 0 [-]
        real(wp) :: b         !! evolution effect, >= 0 [-]
        real(wp) :: d_c       !! slip over which the state evolves, > 0 [L]
        real(wp) :: v0        !! reference slip rate, > 0 [L/T]
        real(wp) :: f0        !! friction coefficient of steady sliding at v0, >= 0 [-]
        integer :: evolution  !! how theta evolves: one of the three above
        real(wp) :: theta_0   !! theta of a virgin point, > 0 [T]
        real(wp) :: alpha     !! effect of the pressure on the state, >= 0; 0 in this law [-]
    contains
        procedure :: read => read_constants
        procedure :: typical_coefficient
        procedure :: largest_coefficient
        procedure :: virgin
        procedure :: admits
        procedure :: rest
        procedure :: slide
        procedure :: slip_rate
        procedure :: state_rates
        procedure :: resistance_at, resistance_by_memory
        procedure :: traits
        procedure :: slopes
        procedure :: scale_of_terms
        procedure :: settle
        procedure :: needs_time
        procedure :: solve
        procedure :: pressed
        procedure :: read_common
        procedure :: steady_shift => no_shift
        procedure :: steady_bounds => no_steady_bounds
    end type rate_state_law

    !> Its own constants; in `props` they stand from place 4 on.
    type(law_constant), parameter, public :: rate_state_constants(7) = [ &
        law_constant('a', '-', 'direct effect', 'DirectEffect', lower=positive), &
        law_constant('b', '-', 'evolution effect', 'EvolutionEffect', lower=0.0_wp), &
        law_constant('d_c', 'L', 'slip over which the state evolves', 'CriticalSlip', &
        lower=positive), &
        law_constant('v0', 'L/T', 'reference slip rate', 'ReferenceSlipRate', lower=positive), &
        law_constant('f0', '-', 'friction coefficient of steady sliding at v0', &
        'ReferenceFriction', lower=0.0_wp), &
        law_constant('evolution', '-', 'law by which theta evolves', 'StateEvolution', &
        lower=0.0_wp, upper=1.0_wp, &
        optional=.true., whole=.true., words='ageing slip'), &
        law_constant('theta_0', 'T', 'theta of a virgin point', 'InitialState', &
        lower=positive, optional=.true., &
        default_from=3, default_per=4)]

    integer, parameter, public :: n_constants = size(rate_state_constants)
    integer, parameter, public :: n_needed = 5   !! of them, those that extensions start with, too;
                                                 !! the others have defaults

    !> Two slips in an increment, and what the slip law knows of those between them.
    type :: slips_between
        real(wp) :: slip(2)     !! from, to, > 0 [L]
        real(wp) :: dt          !! > 0 [T]
        real(wp) :: theta_n     !! at the start of the increment, > 0 [T]
        real(wp) :: pull(2)     !! ln(theta) of steady sliding less ln(theta_n): most, least
        real(wp) :: growth(2)   !! see `steady_bounds`
    end type slips_between

    type(internal_variable), parameter, public :: state_variable = &
        internal_variable('theta', 'T', exists=.true.)

    type(law_description), parameter, public :: rate_state_description = law_description( &
        name='rate_and_state', &
        summary='Regularised rate-and-state friction, ageing or slip law', &
        constants=constant_table(n_constants, [rate_state_constants, &
        no_constants(n_constants + 1:)]), &
        internal=state_variable)

    real(wp), parameter :: least_slip = 1.0e-100_wp   !! in units of d_c; see above

    !> Least a, by the larger of b and f0: below, round-off of ln(theta) is more than the whole
    !> direct effect.
    real(wp), parameter :: least_direct = 1.0e-12_wp
    real(wp), parameter :: most_pressing = 200.0_wp   !! of ln(theta) in an increment
    real(wp), parameter :: ln_most_state = 690.0_wp   !! of theta, so that it stays a number
    real(wp), parameter :: least_state = 1.0e-250_wp   !! v0 theta/d_c of a shifted law ends there
    real(wp), parameter :: ln_2 = 0.693147180559945309417232121458176568_wp
    real(wp), parameter :: least_rate = tiny(1.0_wp) / epsilon(1.0_wp)   !! slower ones count as it

contains

    pure subroutine read_constants(self, n, constants, n_own, status)
        class(rate_state_law), intent(inout) :: self
        integer, intent(in) :: n
        real(wp), intent(in) :: constants(n)
        integer, intent(out) :: n_own, status
        real(wp) :: c(n_constants)

        n_own = n_constants
        call self%read_common(n_constants, rate_state_constants, n_needed, n, constants, c, &
            status)
        if (status < 0) return
        self%evolution = int(c(6))
        self%theta_0 = c(7)
    end subroutine read_constants

    !> Completes the constants by their table and takes those that extensions have, too.
    pure subroutine read_common(self, n_all, table, needed, n, constants, c, status)
        class(rate_state_law), intent(inout) :: self
        integer, intent(in) :: n_all                 !! size of the table
        type(law_constant), intent(in) :: table(:)   !! starts with those of this law
        integer, intent(in) :: needed                !! how many come first and have no default
        integer, intent(in) :: n                     !! how many are given
        real(wp), intent(in) :: constants(n)         !! finite
        real(wp), intent(out) :: c(n_all)            !! all of them, if the status is ok
        integer, intent(out) :: status               !! ok, bad size, or bad property

        status = friction_bad_size
        if (n < needed) return
        status = friction_bad_property
        if (any(constants(:n_needed) < table(:n_needed)%lower)) return
        self%a = constants(1)
        self%b = constants(2)
        self%d_c = constants(3)
        self%v0 = constants(4)
        self%f0 = constants(5)
        self%alpha = 0.0_wp
        if (self%a < least_direct * max(self%b, self%f0)) return
        call complete_constants(n_needed, table, n, constants, c, status)
    end subroutine read_common

    pure function typical_coefficient(self) result(mu)
        class(rate_state_law), intent(in) :: self
        real(wp) :: mu

        mu = max(self%a, self%f0)
    end function typical_coefficient

    !> It grows with the logarithm of the slip rate.
    pure function largest_coefficient(self) result(mu)
        class(rate_state_law), intent(in) :: self
        real(wp) :: mu

        mu = huge(mu)
    end function largest_coefficient

    pure function virgin(self) result(state)
        class(rate_state_law), intent(in) :: self
        type(law_state) :: state

        state = law_state(mu=0.0_wp, r=self%theta_0)
    end function virgin

    !> The coefficient in the state is for the reader; it follows from theta and the slip rate.
    pure function admits(self, state) result(valid)
        class(rate_state_law), intent(in) :: self
        type(law_state), intent(in) :: state
        logical :: valid

        valid = state%mu >= 0.0_wp .and. state%r > 0.0_wp
    end function admits

    pure function needs_time(self) result(needs)
        class(rate_state_law), intent(in) :: self
        logical :: needs

        needs = .true.
    end function needs_time

    !> A surface without traction does not creep: it ages, or by the slip law it stays as it is.
    pure subroutine rest(self, traction, pressure, dt, old, new, strength)
        class(rate_state_law), intent(in) :: self
        real(wp), intent(in) :: traction, pressure, dt
        type(law_state), intent(in) :: old
        type(law_state), intent(out) :: new
        real(wp), intent(out) :: strength
        real(wp) :: z, mean, fall

        new%mu = 0.0_wp
        new%r = old%r
        if (self%evolution == ageing) new%r = min(old%r + dt, largest)
        strength = 0.0_wp
        if (.not. self%alpha > 0.0_wp) return
        z = pressing(self, pressure)
        new%r = old%r * exp(-z)
        if (self%evolution == ageing) then
            call mean_growth(z, exp(-z), mean, fall)
            new%r = new%r + dt * mean
        end if
        new%r = min(max(new%r, tiny(z)), largest)
    end subroutine rest

    pure subroutine slide(self, slip, pressure, dt, old, new, resistance, d_slip, d_pressure)
        class(rate_state_law), intent(in) :: self
        real(wp), intent(in) :: slip, pressure, dt
        type(law_state), intent(in) :: old
        type(law_state), intent(out) :: new
        real(wp), intent(out) :: resistance, d_slip, d_pressure
        real(wp) :: s, least, ln_theta, by_ln_slip, by_pressing, x, part

        least = least_slip * self%d_c
        s = max(slip, least)
        call evolve(self, s, pressure, dt, old%r, new%r, ln_theta, by_ln_slip, by_pressing)
        x = direct_exponent(self, s, dt, ln_theta)
        new%mu = self%a * asinh_exp(x)
        d_slip = pressure * min(slope_asinh_exp(x) * ((self%a + self%b * by_ln_slip) / s), &
            unbounded)
        if (slip < least) then
            part = slip / least
            d_slip = pressure * min(new%mu / least, unbounded)
            new%mu = part * new%mu
        end if
        d_pressure = new%mu
        if (self%alpha > 0.0_wp) d_pressure = d_pressure + min(slip / least, 1.0_wp) &
            * (slope_asinh_exp(x) * self%alpha * by_pressing)
        resistance = new%mu * pressure
    end subroutine slide

    !> How much ln(theta) falls because the pressure has changed since the start of the increment,
    !> taken to change by the same share in each instant: alpha/b ln(p/p_n). Where it grows from
    !> nothing, or falls to that, the state is left alone.
    pure function pressing(self, pressure) result(fall)
        class(rate_state_law), intent(in) :: self
        real(wp), intent(in) :: pressure   !! at the end of the increment [F/L^2]
        real(wp) :: fall

        fall = 0.0_wp
        if (pressed_throughout(self, pressure)) fall = pressing_between(self, self%pressure_start, &
            pressure)
    end function pressing

    pure function pressing_between(self, before, after) result(fall)
        class(rate_state_law), intent(in) :: self
        real(wp), intent(in) :: before, after   !! pressures, > 0 [F/L^2]
        real(wp) :: fall
        real(wp), parameter :: wide = 1.0e100_wp

        if (after < wide * before .and. before < wide * after) then
            fall = pressed_by(self%alpha / self%b, before, after)
        else   ! the quotient may be out of range
            fall = self%alpha / self%b * (log(after) - log(before))
        end if
        fall = max(-most_pressing, min(fall, most_pressing))
    end function pressing_between

    !> Does that depend on the pressure at the end?
    pure function presses(self, pressure)
        class(rate_state_law), intent(in) :: self
        real(wp), intent(in) :: pressure   !! at the end of the increment [F/L^2]
        logical :: presses

        presses = pressed_throughout(self, pressure)
        if (presses) presses = abs(pressing(self, pressure)) < most_pressing
    end function presses

    !> Is there a pressure both at the start and at the end of the increment?
    pure function pressed_throughout(self, pressure) result(pressed)
        class(rate_state_law), intent(in) :: self
        real(wp), intent(in) :: pressure   !! at the end of the increment [F/L^2]
        logical :: pressed

        pressed = self%pressure_start > 0.0_wp .and. pressure > self%pressure_blur
    end function pressed_throughout

    !> A sudden change of the pressure.
    pure function pressed(self, state, before, after) result(new)
        class(rate_state_law), intent(in) :: self
        type(law_state), intent(in) :: state
        real(wp), intent(in) :: before, after
        type(law_state) :: new

        new = state
        if (self%alpha > 0.0_wp) new%r = min(max(state%r * exp(-pressing_between(self, before, &
            after)), tiny(before)), largest)
    end function pressed

    !> theta after a slip, and how it depends on that.
    pure subroutine evolve(self, slip, pressure, dt, theta_n, theta, ln_theta, by_ln_slip, &
        by_pressing)
        class(rate_state_law), intent(in) :: self
        real(wp), intent(in) :: slip           !! > 0 [L]
        real(wp), intent(in) :: pressure       !! > 0 [F/L^2]
        real(wp), intent(in) :: dt             !! > 0 [T]
        real(wp), intent(in) :: theta_n        !! at the start of the increment, > 0 [T]
        real(wp), intent(out) :: theta         !! at its end, > 0 [T]
        real(wp), intent(out) :: ln_theta      !! ln(theta)
        real(wp), intent(out) :: by_ln_slip    !! d(ln theta)/d(ln slip)
        real(wp), intent(out) :: by_pressing   !! d(ln theta)/d(pressing), see there; 0 at its ends
        real(wp) :: x, z, left, mean, fall

        x = slip / self%d_c
        by_pressing = 0.0_wp
        if (self%evolution == ageing) then
            if (self%alpha > 0.0_wp) then
                z = pressing(self, pressure)
                left = exp(-(x + z))
                call mean_growth(x + z, left, mean, fall)
                theta = aged_state(theta_n, dt, left, mean)
                by_pressing = -(theta_n * left + dt * fall) / theta
                by_ln_slip = x * by_pressing
                if (.not. presses(self, pressure)) by_pressing = 0.0_wp
            else
                left = exp(-x)
                mean = mean_decay(x, left)
                theta = aged_state(theta_n, dt, left, mean)
                by_ln_slip = aged_slope(x, theta_n, dt, left, mean, theta)
            end if
            ln_theta = log(theta)
        else
            left = exp(-x)
            mean = mean_decay(x, left)
            call slip_along(self, slip, dt, theta_n, left, mean, ln_theta, by_ln_slip)
            if (self%alpha > 0.0_wp) then
                z = pressing(self, pressure)
                ln_theta = ln_theta - z * mean
                by_ln_slip = by_ln_slip - z * (left - mean)
                if (presses(self, pressure)) by_pressing = -mean
            end if
            theta = max(exp(min(ln_theta, ln_most_state)), tiny(theta))
            if (self%evolution == shifted) theta = max(theta, least_state * (self%d_c / self%v0))
        end if
    end subroutine evolve

    !> The slip law at constant pressure, plain or shifted.
    pure subroutine slip_along(self, slip, dt, theta_n, left, mean, ln_theta, by_ln_slip)
        class(rate_state_law), intent(in) :: self
        real(wp), intent(in) :: slip, dt, theta_n      !! as above
        real(wp), intent(in) :: left, mean             !! e^-x and `mean_decay`, x = slip/d_c
        real(wp), intent(out) :: ln_theta, by_ln_slip
        real(wp) :: x, pull, shift, by_ln_v

        x = slip / self%d_c
        pull = log(dt) - log(x) - log(theta_n)
        shift = 0.0_wp
        by_ln_v = 0.0_wp
        if (self%evolution == shifted) call self%steady_shift(log(slip) - log(dt), shift, by_ln_v)
        pull = pull + shift
        ln_theta = log(theta_n) + x * mean * pull
        by_ln_slip = slipped_slope(x, left, mean, pull) + x * mean * by_ln_v
    end subroutine slip_along

    !> How an extension shifts ln(theta) of steady sliding from ln(d_c/v): asked of those whose
    !> evolution is `shifted`, and of no other.
    pure subroutine no_shift(self, ln_v, shift, by_ln_v)
        class(rate_state_law), intent(in) :: self
        real(wp), intent(in) :: ln_v       !! ln(slip rate)
        real(wp), intent(out) :: shift     !! of ln(theta)
        real(wp), intent(out) :: by_ln_v   !! its derivative by ln(slip rate), not above 1 for long

        shift = 0.0_wp
        by_ln_v = 0.0_wp
    end subroutine no_shift

    !> Rigorous bounds between two slip rates, of ln(theta) of steady sliding, and of how fast
    !> ln sinh(mu/a) grows there: 1 + (b/a) d(ln theta)/d(ln v), which may be small although its
    !> terms are large.
    pure subroutine no_steady_bounds(self, ln_v, ln_theta, growth)
        class(rate_state_law), intent(in) :: self
        real(wp), intent(in) :: ln_v(2)       !! from, to
        real(wp), intent(out) :: ln_theta(2)  !! least, most, less ln(d_c)
        real(wp), intent(out) :: growth(2)    !! least, most, by ln(v)

        ln_theta = [-ln_v(2), -ln_v(1)]
        growth = 1.0_wp - self%b / self%a
    end subroutine no_steady_bounds

    !> The factors of the slope
    !>
    !>     p S (a/slip - b e/d_c),   S = e^X/sqrt(1 + e^2X),   e = -d(ln theta)/dx
    !>
    !> where each is least and largest. X grows with ln(slip) + b/a ln(theta), of which the first
    !> only grows, and theta has one peak at most.
    pure subroutine slopes(self, first, last, pressure, dt, old, least, most)
        class(rate_state_law), intent(in) :: self
        type(sliding), intent(in) :: first, last
        real(wp), intent(in) :: pressure, dt
        type(law_state), intent(in) :: old
        real(wp), intent(out) :: least, most
        type(slips_between) :: between
        real(wp) :: from, y_first, e_low, e_high, grown, shrunk, high, low, s_high, s_low, growth(2)

        from = max(first%slip, least_slip * self%d_c)
        y_first = first%state%mu / self%a
        if (last%slip < from) then   ! both in the part that is a straight line
            least = last%d_slip
            most = last%d_slip
            return
        end if
        between = between_slips(self, from, last%slip, dt, old%r)
        call evolution_bounds(self, between, pressure, e_low, e_high)
        ! ln(theta) above its last value, and below its first one
        grown = max(0.0_wp, e_high * ((last%slip - from) / self%d_c))
        shrunk = max(0.0_wp, log(first%state%r) - log(last%state%r))
        if (self%evolution == shifted .or. self%alpha > 0.0_wp) shrunk = grown   ! it may have more
        grown = self%b / self%a * grown
        shrunk = self%b / self%a * shrunk
        low = self%a / last%slip - (self%b / self%d_c) * e_high
        high = self%a / from - (self%b / self%d_c) * e_low
        if (self%evolution == shifted) then
            growth = exponent_growth(self, between)
            grown = min(grown, max(0.0_wp, -growth(1)) * log(last%slip / from))
            shrunk = min(shrunk, max(0.0_wp, -growth(1)) * log(last%slip / from))
            low = max(low, self%a * growth(1) / merge(last%slip, from, growth(1) > 0.0_wp))
            high = min(high, self%a * growth(2) / merge(from, last%slip, growth(2) > 0.0_wp))
        end if
        s_high = slope_of_asinh(last%state%mu / self%a, grown)
        s_low = slope_of_asinh(y_first, -shrunk)
        least = pressure * low * merge(s_high, s_low, low < 0.0_wp)
        most = pressure * high * merge(s_high, s_low, high > 0.0_wp)
        if (first%slip < from) then
            least = min(least, first%d_slip)
            most = max(most, first%d_slip)
        end if
    end subroutine slopes

    !> Bounds of dX/d(ln slip) between two slips of the slip law with a steady state of its own,
    !>
    !>     e^-x + (1 - e^-x) growth + (b/a) x e^-x pull,   pull = ln(theta_ss) - ln(theta_n)
    !>
    !> which stay close where the terms of `evolution_bounds` are large and cancel: far along, where
    !> only `growth` is left, and for b far above a.
    pure function exponent_growth(self, between) result(bounds)
        class(rate_state_law), intent(in) :: self
        type(slips_between), intent(in) :: between
        real(wp) :: bounds(2)                 !! least, most
        real(wp) :: x(2), left(2), slipped(2), weight(2)

        x = between%slip / self%d_c
        left = exp(-x)
        slipped = x * mean_decay(x, left)
        weight = x * left   ! it has one peak, at 1
        weight = [minval(weight), maxval(weight)]
        if (x(1) < 1.0_wp .and. x(2) > 1.0_wp) weight(2) = exp(-1.0_wp)
        weight = self%b / self%a * weight
        associate (growth => between%growth, most => between%pull(1), least => between%pull(2))
            bounds(1) = minval(left + slipped * growth(1)) + least * merge(weight(1), weight(2), &
                least > 0.0_wp)
            bounds(2) = maxval(left + slipped * growth(2)) + most * merge(weight(2), weight(1), &
                most > 0.0_wp)
        end associate
    end function exponent_growth

    !> The derivative of asinh(e^X), where that is y, after X has changed.
    pure function slope_of_asinh(y, change) result(slope)
        real(wp), intent(in) :: y        !! >= 0
        real(wp), intent(in) :: change   !! of X
        real(wp) :: slope                !! 0 to 1

        slope = 0.0_wp
        if (y > 0.0_wp) slope = slope_asinh_exp(ln_sinh(y) + change)
    end function slope_of_asinh

    !> ln(sinh(y)), however large y is.
    pure function ln_sinh(y)
        real(wp), intent(in) :: y   !! > 0
        real(wp) :: ln_sinh
        real(wp), parameter :: far = -0.6_wp * log(epsilon(far))   ! exp(-2 y) is lost beside 1

        if (y < 1.0_wp) then
            ln_sinh = log(sinh(y))
        else if (y > far) then
            ln_sinh = y - ln_2
        else
            ln_sinh = y - ln_2 + log(1.0_wp - exp(-2.0_wp * y))
        end if
    end function ln_sinh

    !> Bounds of e = -d(ln theta)/dx between two slips.
    !>
    !>     ageing law:  e = (theta_n e^-x + dt fall)/theta,  fall = -d/dx (1 - e^-x)/x
    !>     slip law:    e = (1 - e^-x)/x - e^-x pull,        pull = ln(dt/x) - ln(theta_n)
    pure subroutine evolution_bounds(self, between, pressure, e_low, e_high)
        class(rate_state_law), intent(in) :: self
        type(slips_between), intent(in) :: between
        real(wp), intent(in) :: pressure       !! > 0 [F/L^2]
        real(wp), intent(out) :: e_low, e_high !! [-]
        real(wp) :: x(2), left(2), mean(2), fall(2), theta(2), by_ln_v(2), z

        z = 0.0_wp
        if (self%alpha > 0.0_wp) z = pressing(self, pressure)
        x = between%slip / self%d_c
        if (self%evolution == ageing) then
            x = x + z
            left = exp(-x)
            call mean_growth(x, left, mean, fall)
            theta = max(between%theta_n * left + between%dt * mean, tiny(z))
            fall = between%theta_n * left + between%dt * fall
            e_low = fall(2) / theta(1)
            e_high = fall(1) / max(fall(1), theta(2))   ! no more than 1
        else
            left = exp(-x)
            mean = mean_decay(x, left)
            e_low = mean(2)
            e_high = mean(1)
            if (self%evolution == shifted) then
                by_ln_v = self%a / self%b * (between%growth - 1.0_wp)
                e_low = -by_ln_v(2) * merge(mean(2), mean(1), by_ln_v(2) < 0.0_wp)
                e_high = -by_ln_v(1) * merge(mean(1), mean(2), by_ln_v(1) < 0.0_wp)
            end if
            associate (most => between%pull(1), least => between%pull(2))
                e_low = e_low - most * merge(left(1), left(2), most > 0.0_wp)
                e_high = e_high - least * merge(left(2), left(1), least > 0.0_wp)
            end associate
            if (abs(z) > 0.0_wp) then
                fall = z * fall_of_mean(x, left, mean)
                e_low = e_low - maxval(fall)
                e_high = e_high - minval(fall)
            end if
        end if
    end subroutine evolution_bounds

    pure function between_slips(self, from, to, dt, theta_n) result(between)
        class(rate_state_law), intent(in) :: self
        real(wp), intent(in) :: from, to, dt, theta_n   !! as there
        type(slips_between) :: between

        between%slip = [from, to]
        between%dt = dt
        between%theta_n = theta_n
        between%growth = 0.0_wp
        between%pull = 0.0_wp
        if (self%evolution == ageing) return
        between%pull = log(dt) - log(between%slip / self%d_c) - log(theta_n)
        if (self%evolution /= shifted) return
        call self%steady_bounds(log(between%slip) - log(dt), between%pull, between%growth)
        between%pull = between%pull([2, 1]) + log(self%d_c) - log(theta_n)
    end function between_slips

    !> Newton's method in ln(slip), bracketed, where there can be one equilibrium only.
    pure subroutine solve(self, trial, stiffness, pressure, dt, old, answer, solved)
        class(rate_state_law), intent(in) :: self
        real(wp), intent(in) :: trial, stiffness, pressure, dt
        type(law_state), intent(in) :: old
        type(sliding), intent(out) :: answer
        logical, intent(out) :: solved
        integer, parameter :: max_iterations = 100
        real(wp) :: small, low, high, misfit, by_ln_slip, fall, step
        integer :: iteration

        solved = .false.
        low = least_slip * self%d_c
        high = trial / stiffness
        if (.not. low < high) return
        if (may_balance_more_than_once(self, trial, stiffness, pressure, dt, old%r)) return

        small = 0.1_wp * sqrt(epsilon(small))   ! the next error is about the square of a step
        answer%slip = max(low, creep(self, trial, pressure, dt, old, high))
        do iteration = 1, max_iterations
            call self%slide(answer%slip, pressure, dt, old, answer%state, answer%resistance, &
                answer%d_slip, answer%d_pressure)
            misfit = trial - stiffness * answer%slip - answer%resistance
            if (solved) then
                call self%settle(misfit, stiffness, pressure, answer)
                return
            end if
            if (misfit > 0.0_wp) then
                low = answer%slip
            else if (answer%slip > low) then
                high = answer%slip
            else   ! in the part that is a straight line
                answer%slip = trial / (stiffness + answer%resistance / low)
                solved = .true.
                cycle
            end if
            by_ln_slip = answer%slip * answer%d_slip
            fall = answer%slip * stiffness + by_ln_slip
            solved = abs(misfit) <= small * fall
            if (solved) solved = abs(misfit) * steepness(self, pressure, by_ln_slip, fall, &
                answer%resistance) <= small * fall
            if (abs(misfit) < 100.0_wp * fall) then
                step = misfit / fall
                answer%slip = answer%slip * exp(step)
            end if
            if (.not. (solved .or. (answer%slip > low .and. answer%slip < high))) then
                answer%slip = sqrt(low) * sqrt(high)
            end if
        end do
        solved = .false.
    end subroutine solve

    !> How fast the slope by ln(slip) changes with that, as a share of it, at most about; as far as
    !> that is a number to go on with.
    pure function steepness(self, pressure, by_ln_slip, fall, resistance)
        class(rate_state_law), intent(in) :: self
        real(wp), intent(in) :: pressure, resistance   !! [F/L^2]
        real(wp), intent(in) :: by_ln_slip   !! d(resistance)/d(ln slip) [F/L^2]
        real(wp), intent(in) :: fall         !! of the misfit with ln(slip) [F/L^2]
        real(wp) :: steepness                !! 1 or more
        real(wp), parameter :: least_share = 1.0e-8_wp
        real(wp) :: least

        least = max(least_share * abs(by_ln_slip), tiny(least) / epsilon(least))
        steepness = abs(by_ln_slip) / max(min(self%a * pressure, resistance), least)
        steepness = max(1.0_wp, steepness * max(1.0_wp, abs(by_ln_slip) / max(fall, least)))
    end function steepness

    !> Where one bound for all slips does not tell that there is one equilibrium, several do.
    pure function may_balance_more_than_once(self, trial, stiffness, pressure, dt, theta_n) &
        result(may)
        class(rate_state_law), intent(in) :: self
        real(wp), intent(in) :: trial, stiffness, pressure, dt, theta_n
        logical :: may
        real(wp), parameter :: least_share = 1.0e-100_wp
        type(slip_range) :: range
        real(wp) :: e_low, e_high, t, k, b_over_a, pressed, x_0, low, high, fall, ln_ratio, &
            aged
        integer :: i

        call evolution_bounds(self, between_slips(self, least_slip * self%d_c, trial / stiffness, &
            dt, theta_n), pressure, e_low, e_high)
        may = pressure * (self%b * e_high / self%d_c - self%a * (stiffness / trial)) > stiffness
        if (.not. may) return
        if (self%a * pressure < least_share * max(trial, stiffness * self%d_c)) return
        t = trial / (self%a * pressure)
        k = stiffness * self%d_c / (self%a * pressure)
        b_over_a = self%b / self%a
        pressed = 0.0_wp
        if (self%alpha > 0.0_wp) pressed = pressing(self, pressure)
        ln_ratio = log(dt) - log(theta_n)
        aged = theta_n / max(dt, 2.0_wp**(-1000) * theta_n)   ! a number for the shortest dt, too
        if (self%evolution == shifted) then
            may = may_turn_anywhere(self, t, k, dt, theta_n)
            return
        end if
        x_0 = direct_exponent(self, self%d_c, dt, log(merge(dt, theta_n, self%evolution == ageing)))
        do i = 1, size(ranges)
            if (k * ranges(i)%from > t) exit
            range = ranges(i)
            if (self%evolution == ageing) then
                if (self%alpha > 0.0_wp) range = pressed_range(range, pressed)
                fall = aged_fall(range, aged)
            else
                fall = slipped_fall(range, ln_ratio - range%ln_to, -1.0_wp, pressed)
            end if
            if (may_turn(range, k, b_over_a * fall) <= 0.0_wp) cycle
            if (self%evolution == ageing) then
                call aged_bounds(range, aged, low, high)
            else
                call slipped_bounds(range, ln_ratio - range%ln_to, ln_ratio - range%ln_from, &
                    pressed, low, high)
            end if
            may = may_vanish(range, t, k, x_0 + b_over_a * low, x_0 + b_over_a * high) > 0.0_wp
            if (may) return
        end do
        may = k * ranges(size(ranges))%to < t .and. may_turn_far(k, b_over_a, aged, pressed) &
            > 0.0_wp
    end function may_balance_more_than_once

    !> The same with a steady state of its own, whose bounds cost more: over wide ranges, and over
    !> narrow ones where these do not tell.
    pure function may_turn_anywhere(self, t, k, dt, theta_n) result(may)
        class(rate_state_law), intent(in) :: self
        real(wp), intent(in) :: t, k        !! of module friction_rate_state_bounds
        real(wp), intent(in) :: dt, theta_n
        logical :: may
        type(slip_range) :: range
        real(wp) :: pull(2), growth(2), low, high, fall, x_0, b_over_a
        integer :: first, last, n, many

        n = count(k * ranges%from <= t)
        may = k * ranges(n)%to < t   ! further than the ranges
        if (may) return
        b_over_a = self%b / self%a
        x_0 = direct_exponent(self, self%d_c, dt, log(theta_n))
        first = 1
        many = n / 4
        do
            last = min(first + max(many, 1) - 1, n)
            range = joined(ranges(first), ranges(last))
            call self%steady_bounds([range%ln_from, range%ln_to] + log(self%d_c) - log(dt), pull, &
                growth)
            pull = pull + log(self%d_c) - log(theta_n)
            fall = slipped_fall(range, pull(1), (growth(1) - 1.0_wp) / b_over_a, 0.0_wp)
            call slipped_bounds(range, pull(1), pull(2), 0.0_wp, low, high)
            may = min(may_turn(range, k, b_over_a * fall), may_vanish(range, t, k, x_0 + b_over_a &
                * low, x_0 + b_over_a * high)) > 0.0_wp
            if (may .and. last == first) return
            if (may) then
                many = (last - first + 1) / 4
            else
                if (last == n) return
                first = last + 1
                many = 2 * max(many, 1)
            end if
        end do
    end function may_turn_anywhere

    !> The stiffer of the two, spring or law, knows the traction better.
    pure subroutine settle(self, misfit, stiffness, pressure, answer)
        class(rate_state_law), intent(in) :: self
        real(wp), intent(in) :: misfit, stiffness, pressure
        type(sliding), intent(inout) :: answer
        real(wp) :: stiff, by_state

        stiff = max(answer%d_slip, 0.0_wp)
        by_state = answer%d_pressure - answer%state%mu
        answer%resistance = max(answer%resistance + misfit * (stiff / (stiffness + stiff)), 0.0_wp)
        answer%state%mu = answer%resistance / pressure
        answer%d_pressure = answer%state%mu + by_state
    end subroutine settle

    !> The exponent X is a sum of logarithms, multiplied by b/a.
    pure function scale_of_terms(self, slid, dt, old) result(scale)
        class(rate_state_law), intent(in) :: self
        type(sliding), intent(in) :: slid
        real(wp), intent(in) :: dt
        type(law_state), intent(in) :: old
        real(wp) :: scale
        real(wp) :: s, terms

        s = max(slid%slip, least_slip * self%d_c)
        terms = abs(log(self%v0)) + abs(log(self%d_c)) + abs(log(old%r)) + abs(log(slid%state%r))
        if (self%evolution == shifted) terms = terms + abs(log(s)) + abs(log(dt))
        terms = 1.0_wp + abs(log(s)) + abs(log(dt)) + abs(log(self%v0)) + (self%f0 + self%b &
            * terms) / self%a
        scale = slid%resistance * (1.0_wp + terms)
    end function scale_of_terms

    !> The slip under a traction if the state does not evolve by slip.
    pure function creep(self, traction, pressure, dt, old, most) result(slip)
        class(rate_state_law), intent(in) :: self
        real(wp), intent(in) :: traction   !! > 0 [F/L^2]
        real(wp), intent(in) :: pressure   !! > 0 [F/L^2]
        real(wp), intent(in) :: dt         !! > 0 [T]
        type(law_state), intent(in) :: old
        real(wp), intent(in) :: most       !! slip that is enough [L]
        real(wp) :: slip                   !! [L]
        real(wp), parameter :: fast = 1.0e6_wp, ln_most = 700.0_wp, little = 0.1_wp
        type(law_state) :: new
        real(wp) :: y, strength

        slip = most
        if (traction > fast * self%a * pressure) return
        y = traction / (self%a * pressure)
        new%r = old%r
        if (self%evolution == ageing) new%r = min(old%r + dt, largest)
        ! where the pressure hardly changes, this is near enough for a start, and cheaper
        if (self%alpha * abs(pressure - self%pressure_start) > little * self%b &
            * self%pressure_start) call self%rest(0.0_wp, pressure, dt, old, new, strength)
        slip = min(most, exp(min(ln_most, ln_sinh(y) - direct_exponent(self, 1.0_wp, dt, &
            log(new%r)))))
    end function creep

    !> The slip rate that the traction asks for, 2 v0 sinh(tau/(a p)) exp(-(f0 + b ln(v0
    !> theta/d_c))/a), as far as that is a number to go on with.
    pure subroutine slip_rate(self, state, load, rate, jumps)
        class(rate_state_law), intent(in) :: self
        type(law_state), intent(in) :: state
        type(load_rates), intent(in) :: load
        real(wp), intent(out) :: rate
        logical, intent(out) :: jumps
        real(wp), parameter :: ln_most = 70.0_wp   ! of the slip rate, in units of v0
        real(wp) :: x, psi

        jumps = .false.
        rate = 0.0_wp
        if (.not. load%pressure > 0.0_wp) return
        psi = state_exponent(self%a, self%b, self%f0, log(self%v0 * state%r / self%d_c))
        x = min(load%traction, self%a * load%pressure * (max(psi, 0.0_wp) + ln_most)) &
            / (self%a * load%pressure)
        if (x > 0.0_wp) rate = 2.0_wp * self%v0 * exp(min(ln_sinh(x) - psi, ln_most))
    end subroutine slip_rate

    pure function state_rates(self, state, load, slip_rate) result(rates)
        class(rate_state_law), intent(in) :: self
        type(law_state), intent(in) :: state
        type(load_rates), intent(in) :: load
        real(wp), intent(in) :: slip_rate
        type(law_state) :: rates
        real(wp) :: x, shift, by_ln_v

        x = slip_rate * state%r / self%d_c
        rates = law_state(mu=0.0_wp, r=ageing_rate(x))
        if (self%evolution /= ageing) then
            shift = 0.0_wp
            if (self%evolution == shifted) call self%steady_shift(log(max(slip_rate, &
                least_slip * self%v0)), shift, by_ln_v)
            rates%r = slip_law_rate(x, log(max(x, tiny(x))) - shift)
        end if
        if (self%alpha > 0.0_wp .and. load%pressure > 0.0_wp) rates%r = rates%r - self%alpha &
            / self%b * state%r * (load%pressure_rate / load%pressure)
        if (load%pressure > 0.0_wp) rates%mu = (load%loading - load%stiffness * slip_rate &
            - load%traction / load%pressure * load%pressure_rate) / load%pressure
    end function state_rates

    pure subroutine resistance_at(self, state, rate, pressure, resistance, by_rate)
        class(rate_state_law), intent(in) :: self
        type(law_state), intent(in) :: state
        real(wp), intent(in) :: rate, pressure
        real(wp), intent(out) :: resistance, by_rate
        real(wp), parameter :: steepest = 2.0_wp**1000   ! so that it stays a number
        real(wp) :: x, direct

        x = direct_exponent(self, max(rate, least_rate), 1.0_wp, log(state%r))
        direct = self%a * pressure
        resistance = direct * asinh_exp(x)
        by_rate = direct * min(slope_asinh_exp(x) / max(rate, least_rate), steepest &
            / max(direct, 1.0_wp))
    end subroutine resistance_at

    pure function resistance_by_memory(self, state, rate, pressure) result(derivative)
        class(rate_state_law), intent(in) :: self
        type(law_state), intent(in) :: state
        real(wp), intent(in) :: rate, pressure
        real(wp) :: derivative

        derivative = self%b * pressure * slope_asinh_exp(direct_exponent(self, max(rate, &
            least_rate), 1.0_wp, log(state%r)))
    end function resistance_by_memory

    pure function traits(self)
        class(rate_state_law), intent(in) :: self
        type(law_traits) :: traits

        traits = law_traits(onset=onset_gradual, stiff=.true., memory=2, logarithmic=.true., &
            weight=self%b, slip_scale=self%d_c, weakening=self%b / self%d_c)
    end function traits

    !> X of the law.
    pure function direct_exponent(self, slip, dt, ln_theta) result(x)
        class(rate_state_law), intent(in) :: self
        real(wp), intent(in) :: slip        !! > 0 [L]
        real(wp), intent(in) :: dt          !! > 0 [T]
        real(wp), intent(in) :: ln_theta    !! theta in [T]
        real(wp) :: x

        x = log(slip) - log(dt) - log(2.0_wp * self%v0) + state_exponent(self%a, self%b, self%f0, &
            log(self%v0) - log(self%d_c) + ln_theta)
    end function direct_exponent

end module friction_rate_state_law
