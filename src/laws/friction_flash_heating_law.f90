!> Rate-and-state friction with flash heating (Rice 2006; Noda, Dunham and Rice 2009): strong
!> velocity weakening beyond the slip rate v_w, at which asperities melt where they touch.
!>
!>     mu = a asinh(v/(2 v0) e^(psi/a)),   psi = f0 + b ln(v0 theta/d_c)
!>     psi_dot = -(v/d_c) (psi - psi_ss(v)),   psi_ss = a ln(2 v0/v sinh(f_ss/a))
!>     f_ss = f_w + (f_LV - f_w)/(1 + (v/v_w)^n)^(1/n)
!>
!> The slip law, whose steady state is another one: law and search of rate-and-state friction are
!> taken as they are. f_LV, in steady sliding at low rates, is regularised like mu,
!>
!>     f_LV = a asinh(v/(2 v0) e^((f0 - b ln(v/v0))/a))
!>
!> where the references have f0 + (a - b) ln(v/v0): so f_ss is never negative, and without heating
!> this is the slip law, exactly. The state is theta, as there; with it
!>
!>     d(ln theta)/dt = -(v/d_c) (ln(v theta/d_c) - shift(v)),
!>     shift = (a/b) (ln sinh(f_ss/a) - ln sinh(f_LV/a))
module friction_flash_heating_law
    use friction_flash_heating_core, only : kept_share, least_ratio, steady_ratio, &
        steady_ratio_slope, weak_part
    use friction_kinds, only : wp
    use friction_law, only : law_description, law_traits
    use friction_law_constants, only : constant_table, law_constant, no_constants, positive
    use friction_rate_state_core, only : asinh_exp, decayed_part, mean_decay, slope_asinh_exp
    use friction_rate_state_law, only : rate_state_constants, rate_state_law, shifted, &
        state_variable
    use friction_status, only : friction_bad_property, friction_ok
    implicit none
    private

    public :: flash_heating_law

    type, extends(rate_state_law) :: flash_heating_law
        real(wp) :: f_w   !! friction coefficient of a weak surface, 0 to f0 [-]
        real(wp) :: v_w   !! slip rate at which it weakens, > 0 [L/T]
        real(wp) :: n     !! how sharply it does, 1 to 1000 [-]
    contains
        procedure :: read => read_constants
        procedure :: traits
        procedure :: steady_shift
        procedure :: steady_bounds
    end type flash_heating_law

    !> Its own constants; in `props` they stand from place 4 on.
    type(law_constant), parameter :: table(9) = [ &
        rate_state_constants(1), &
        law_constant('b', '-', 'evolution effect', 'EvolutionEffect', lower=positive), &
        rate_state_constants(3:5), &
        law_constant('f_w', '-', 'friction coefficient far above v_w', 'WeakFriction', &
        lower=0.0_wp, not_above=5), &
        law_constant('v_w', 'L/T', 'slip rate beyond which friction weakens', 'WeakeningSlipRate', &
        lower=positive), &
        law_constant('n', '-', 'how sharply it weakens there', 'WeakeningExponent', &
        lower=1.0_wp, upper=1.0e3_wp, &
        optional=.true., default=8.0_wp), &
        law_constant('theta_0', 'T', 'theta of a virgin point', 'InitialState', &
        lower=positive, optional=.true., &
        default_from=3, default_per=4)]

    type(law_description), parameter, public :: flash_heating_description = law_description( &
        name='flash_heating', &
        summary='Rate-and-state friction, slip law, that weakens strongly beyond a slip rate', &
        constants=constant_table(size(table), [table, no_constants(size(table) + 1:)]), &
        internal=state_variable)
    integer, parameter :: n_needed = 7

    !> Least a, by b: the bounds of the search are differences of terms that large.
    real(wp), parameter :: least_direct = 1.0e-9_wp
    !> Least b, by a and by f0: with less, theta has to leave the range of numbers.
    real(wp), parameter :: least_evolution = 1.0e-9_wp

    !> Steady sliding at a slip rate.
    type :: steady_sliding
        real(wp) :: u          !! ln sinh of the next
        real(wp) :: low        !! f_LV/a
        real(wp) :: g, lost    !! G and 1 - G of the core
        real(wp) :: h          !! -d(ln G)/d(ln v)
    end type steady_sliding

contains

    pure subroutine read_constants(self, n, constants, n_own, status)
        class(flash_heating_law), intent(inout) :: self
        integer, intent(in) :: n
        real(wp), intent(in) :: constants(n)
        integer, intent(out) :: n_own, status
        real(wp) :: c(size(table))

        n_own = size(table)
        call self%read_common(table, n_needed, n, constants, c, status)
        if (status < 0) return
        status = friction_bad_property
        if (self%a < least_direct * self%b) return
        if (self%b < least_evolution * max(self%a, self%f0)) return
        self%evolution = shifted
        self%f_w = c(6)
        self%v_w = c(7)
        self%n = c(8)
        self%theta_0 = c(9)
        status = friction_ok
    end subroutine read_constants

    pure function traits(self)
        class(flash_heating_law), intent(in) :: self
        type(law_traits) :: traits

        traits = self%rate_state_law%traits()
        traits%weakening = max(self%b, self%f0 - self%f_w) / self%d_c
    end function traits

    pure subroutine steady_shift(self, ln_v, shift, by_ln_v)
        class(flash_heating_law), intent(in) :: self
        real(wp), intent(in) :: ln_v
        real(wp), intent(out) :: shift, by_ln_v
        real(wp) :: growth

        call shift_and_growth(self, ln_v, shift, growth)
        by_ln_v = self%a / self%b * (growth - u_slope(self))
    end subroutine steady_shift

    !> The shift, and what its derivative comes from: that of ln sinh(f_ss/a) by ln(v).
    pure subroutine shift_and_growth(self, ln_v, shift, growth)
        class(flash_heating_law), intent(in) :: self
        real(wp), intent(in) :: ln_v
        real(wp), intent(out) :: shift, growth
        type(steady_sliding) :: steady
        real(wp) :: w, y, part

        steady = sliding_at(self, ln_v)
        w = self%f_w / self%a
        y = steady_ratio(steady%low, w, steady%g, steady%lost)
        part = decayed_part(y, exp(-y))
        growth = (2.0_wp - part) / part * steady_ratio_slope(steady%low, &
            slope_asinh_exp(steady%u) * u_slope(self), w, steady%g, steady%h)
        if (w * steady%lost + steady%low * steady%g < y) growth = 0.0_wp   ! at its end
        shift = self%a / self%b * (y + log(0.5_wp * part) - steady%u)
    end subroutine shift_and_growth

    pure function sliding_at(self, ln_v) result(steady)
        class(flash_heating_law), intent(in) :: self
        real(wp), intent(in) :: ln_v
        type(steady_sliding) :: steady
        real(wp) :: beyond, x, l
        real(wp), parameter :: ln_2 = log(2.0_wp)

        beyond = ln_v - log(self%v0)
        steady%u = beyond - ln_2 + (self%f0 - self%b * beyond) / self%a
        steady%low = asinh_exp(steady%u)
        x = self%n * (ln_v - log(self%v_w))
        l = kept_share(x, self%n)
        steady%g = exp(-l)
        steady%lost = l * mean_decay(l, steady%g)
        steady%h = weak_part(x)
    end function sliding_at

    !> d(u)/d(ln v)
    pure function u_slope(self) result(slope)
        class(flash_heating_law), intent(in) :: self
        real(wp) :: slope

        slope = 1.0_wp - self%b / self%a
    end function u_slope

    !> Bounds, between two slip rates, of the growth of ln sinh(f_ss/a) with ln(v), once by the
    !> factors of
    !>
    !>     growth = u' G C + coth(y) G h (w - y_LV),   C = tanh(y_LV)/tanh(y)
    !>
    !> at the ends, which is close where these are, and once for all rates up to the larger one; the
    !> closer of the two counts. From them bounds of ln(theta/d_c) in steady sliding, whose
    !> derivative is (a/b) (growth - 1). docs/theory.md, section 12.
    pure subroutine steady_bounds(self, ln_v, ln_theta, growth)
        class(flash_heating_law), intent(in) :: self
        real(wp), intent(in) :: ln_v(2)
        real(wp), intent(out) :: ln_theta(2), growth(2)
        real(wp) :: ends(2), at_ends(2), near(2), all_rates(2), by_ln_v(2), width, gained

        call shift_and_growth(self, ln_v(1), ends(1), at_ends(1))
        call shift_and_growth(self, ln_v(2), ends(2), at_ends(2))
        near = growth_between(self, sliding_at(self, ln_v(1)), sliding_at(self, ln_v(2)))
        all_rates = growth_below(self, ln_v)
        growth(1) = min(max(near(1), all_rates(1)), at_ends(1), at_ends(2))
        growth(2) = max(min(near(2), all_rates(2)), at_ends(1), at_ends(2))
        ends = ends - ln_v
        ln_theta = [minval(ends), maxval(ends)]
        by_ln_v = self%a / self%b * (growth - 1.0_wp)
        if (by_ln_v(1) >= 0.0_wp .or. by_ln_v(2) <= 0.0_wp) return
        ! Straight lines from both ends meet below and above.
        width = ln_v(2) - ln_v(1)
        gained = ends(2) - ends(1)
        near = (by_ln_v([2, 1]) * width - gained) / (by_ln_v([2, 1]) - by_ln_v)   ! where
        near = ends(1) + by_ln_v * max(0.0_wp, min(near, width))
        ln_theta = [min(near(1), ln_theta(1)), max(near(2), ln_theta(2))]
        ln_theta(1) = max(ln_theta(1), min(ends(2), -ln_v(2)))
    end subroutine steady_bounds

    pure function growth_between(self, first, last) result(bounds)
        class(flash_heating_law), intent(in) :: self
        type(steady_sliding), intent(in) :: first, last   !! at the smaller and the larger rate
        real(wp) :: bounds(2)
        real(wp) :: low(2), y(2), corners(4), w, share(2), pull(2), coth(2), part(2)

        w = self%f_w / self%a
        low = [min(first%low, last%low), max(first%low, last%low)]
        corners = steady_ratio([low, low], w, [first%g, first%g, last%g, last%g], &
            [first%lost, first%lost, last%lost, last%lost])   ! it is bilinear
        y = [minval(corners), maxval(corners)]
        bounds = 0.0_wp
        if (y(2) <= least_ratio) return   ! it is at its end
        part = decayed_part(y, exp(-y))
        coth = (2.0_wp - part) / part   ! the first is the larger one
        share = tanh(low) * coth([2, 1]) * [last%g, first%g]
        share = min(share, 1.0_wp)
        if (u_slope(self) < 0.0_wp) share = share([2, 1])
        bounds = u_slope(self) * share
        pull = w - low([2, 1])
        bounds(1) = bounds(1) + pull(1) * merge(coth(2) * (last%g * first%h), &
            coth(1) * (first%g * last%h), pull(1) > 0.0_wp)
        bounds(2) = bounds(2) + pull(2) * merge(coth(1) * (first%g * last%h), &
            coth(2) * (last%g * first%h), pull(2) > 0.0_wp)
        if (y(1) <= least_ratio) bounds = [min(bounds(1), 0.0_wp), max(bounds(2), 0.0_wp)]
    end function growth_between

    !> G C is between 0 and 1; G h (y_LV - w) is largest at v_w, or at the end; coth(y) is below
    !> 1 + 1/y.
    pure function growth_below(self, ln_v) result(bounds)
        class(flash_heating_law), intent(in) :: self
        real(wp), intent(in) :: ln_v(2)
        real(wp) :: bounds(2)
        type(steady_sliding) :: first, last, at_v_w
        real(wp) :: w, most, heated

        w = self%f_w / self%a
        first = sliding_at(self, ln_v(1))
        last = sliding_at(self, ln_v(2))
        at_v_w = sliding_at(self, min(log(self%v_w), ln_v(2)))
        heated = min(1.0_wp, 2.0_wp * last%h)
        most = max(0.0_wp, max(at_v_w%low, last%low) - w + max(0.0_wp, -u_slope(self)))
        bounds(1) = min(u_slope(self), 0.0_wp) - heated * (most + 1.0_wp)
        bounds(2) = max(u_slope(self), 0.0_wp)
        if (min(first%low, last%low) < w) bounds(2) = bounds(2) + w * heated + self%n
    end function growth_below

end module friction_flash_heating_law
