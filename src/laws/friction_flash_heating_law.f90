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
    use friction_flash_heating_core, only : bounds_between, bounds_of_steady => steady_bounds, &
        heating, shift_slope, sliding_at, steady_sliding
    use friction_kinds, only : wp
    use friction_law, only : law_description, law_traits
    use friction_law_constants, only : constant_table, law_constant, no_constants, positive
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

contains

    pure subroutine read_constants(self, n, constants, n_own, status)
        class(flash_heating_law), intent(inout) :: self
        integer, intent(in) :: n
        real(wp), intent(in) :: constants(n)
        integer, intent(out) :: n_own, status
        real(wp) :: c(size(table))

        n_own = size(table)
        call self%read_common(size(table), table, n_needed, n, constants, c, status)
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
        type(steady_sliding) :: steady

        steady = sliding_at(heating_of(self), ln_v)
        shift = self%a / self%b * steady%rise
        by_ln_v = shift_slope(self%b / self%a, steady%growth)
    end subroutine steady_shift

    pure subroutine steady_bounds(self, ln_v, ln_theta, growth)
        class(flash_heating_law), intent(in) :: self
        real(wp), intent(in) :: ln_v(2)
        real(wp), intent(out) :: ln_theta(2), growth(2)
        type(bounds_of_steady) :: bounds

        bounds = bounds_between(heating_of(self), sliding_at(heating_of(self), ln_v(1)), &
            sliding_at(heating_of(self), ln_v(2)))
        ln_theta = [bounds%ln_low, bounds%ln_high]
        growth = [bounds%growth_low, bounds%growth_high]
    end subroutine steady_bounds

    pure function heating_of(self) result(constants)
        class(flash_heating_law), intent(in) :: self
        type(heating) :: constants

        constants = heating(ln_v0=log(self%v0), ln_v_w=log(self%v_w), f0=self%f0 / self%a, &
            b=self%b / self%a, f_w=self%f_w / self%a, n=self%n)
    end function heating_of

end module friction_flash_heating_law
