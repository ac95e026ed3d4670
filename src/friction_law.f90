!> What a friction law owes the return mapping, and nothing more.
!>
!> A law answers two questions about one contact point. While it does not slip: how do its internal
!> variables evolve, and which tangential traction starts the slip (`rest`)? After it has slid by
!> `slip` during `dt` under `pressure`: which traction does it carry (`slide`)? The return mapping
!> (module `friction_return_map`) knows no law by name; adding a law means adding one file in
!> src/laws/ and one line where laws are chosen.
!>
!> A `named_law` also tells what its constants mean to those who choose steps and tolerances. What
!> is to be known about it without values, its name and its table of constants, is a constant of its
!> module, the `law_description`.
module friction_law
    use friction_kinds, only : wp
    use friction_law_constants, only : constant_table, name_length, unit_length
    implicit none
    private

    public :: below, internal_variable, law, law_description, law_state, law_traits, load_rates, &
        named_law, sliding

    !> Least share of the strength, for a law whose strength is a share of a larger one: from less,
    !> no slip starts, which would be in the underflow of the arithmetic.
    real(wp), parameter, public :: least_ratio = 1.0e-100_wp

    !> A slope of which nothing better is known: its products with slips stay in range.
    real(wp), parameter, public :: unbounded = 2.0_wp**660   !! [F/L^3]

    !> Internal variables of a law at one contact point.
    type :: law_state
        real(wp) :: mu   !! friction coefficient [-]
        real(wp) :: r    !! the law's internal variable, e.g. the similarity ratio R [-]
    end type law_state

    !> A surface that has slid: the result of the return mapping.
    type :: sliding
        real(wp) :: slip         !! slip in this increment, >= 0 [L]
        type(law_state) :: state          !! internal variables at the end of the increment
        real(wp) :: resistance   !! tangential traction [F/L^2]
        real(wp) :: d_slip       !! d(resistance)/d(slip) [F/L^3]
        real(wp) :: d_pressure   !! d(resistance)/d(pressure) [-]
    end type sliding

    !> A loaded contact in continuous time: what it carries, and how that is about to change.
    type :: load_rates
        real(wp) :: traction        !! tangential traction carried, >= 0 [F/L^2]
        real(wp) :: loading         !! its rate if nothing slipped [F/L^2/T]
        real(wp) :: stiffness       !! what a unit of slip takes from it, > 0 [F/L^3]
        real(wp) :: pressure        !! contact pressure; 0 while open [F/L^2]
        real(wp) :: pressure_rate   !! [F/L^2/T]
        logical :: sliding          !! taken to slide: a rate < 0 tells that it does not
    end type load_rates

    !> How slip starts in continuous time.
    integer, parameter, public :: onset_gradual = 1  !! the slip rate grows from zero with the load
    integer, parameter, public :: onset_yields = 2   !! from the strength on, it is what holds that
    integer, parameter, public :: onset_drops = 3    !! with a fall of the resistance, at once

    !> What the rates of a law are like, for those who integrate them.
    type :: law_traits
        integer :: onset = onset_yields
        logical :: stiff = .false.       !! slip rates go through decades
        integer :: memory = 0            !! what evolves: 0 nothing, 1 `mu`, 2 `r` of its state
        logical :: logarithmic = .false. !! which goes through decades, too, always positive
        real(wp) :: weight = 0.0_wp      !! change of the friction coefficient with a unit of it, or
                                         !! of its logarithm [-]
        real(wp) :: kink = huge(1.0_wp)  !! where the law changes its form
        real(wp) :: slip_scale = huge(1.0_wp)   !! slip over which friction evolves [L]
        real(wp) :: weakening = 0.0_wp   !! how fast the coefficient falls with slip, at most [1/L]
    end type law_traits

    type, abstract :: law
        !> Does the law follow the path within an increment? Then an increment that unloads before
        !> it loads again slides from the least share of the strength on its way: `r` at the start
        !> stands for that share, and the strength is proportional to it and to the pressure.
        !> Whoever makes a law for use says so (an initial value here would be stored at every call
        !> for every law that there is).
        logical :: follows_path

        !> Contact pressure at the start of the increment, 0 while open, for laws whose state
        !> depends on how the pressure changes. Whoever takes a point through an increment sets it;
        !> otherwise it is 0. [F/L^2]
        real(wp) :: pressure_start

        !> Round-off of the pressure at the end, where that is more than its own, else 0: up to it
        !> there may as well be none. Set along with the pressure at the start. [F/L^2]
        real(wp) :: pressure_blur

        !> The largest tangential traction that the surface carries (module friction_shear_cap);
        !> huge for none. Whoever makes a law for use sets it. [F/L^2]
        real(wp) :: tau_max

        !> Tangential traction that the surface carries without pressure (module friction_cohesion);
        !> 0 for none. Whoever makes a law for use sets it. [F/L^2]
        real(wp) :: cohesion
    contains
        procedure(virgin_interface), deferred :: virgin
        procedure(admits_interface), deferred :: admits
        procedure(rest_interface), deferred :: rest
        procedure(slide_interface), deferred :: slide
        procedure(slip_rate_interface), deferred :: slip_rate
        procedure(state_rates_interface), deferred :: state_rates
        procedure :: resistance_at => resistance_at_any_rate
        procedure :: resistance_by_memory => remembers_nothing
        procedure :: traits => simple_traits
        procedure :: slopes => slopes_of_convex
        procedure :: steepest_fall => no_bound
        procedure :: scale_of_terms => scale_of_itself
        procedure :: settle => settled_already
        procedure :: needs_time => needs_no_time
        procedure :: solve => not_solved
        procedure :: start_rate => no_start_rate
        procedure :: pressed => not_pressed
    end type law

    !> What the internal variable `r` of a law is called.
    type :: internal_variable
        character(len=name_length) :: name   !! 'R' for a law without one
        character(len=unit_length) :: unit
        logical :: exists                    !! otherwise `r` is 0
    end type internal_variable

    type(internal_variable), parameter, public :: no_internal_variable = &
        internal_variable('R', '-', exists=.false.)

    integer, parameter, public :: summary_length = 80

    !> What is to be known about a law whatever the values of its constants.
    type :: law_description
        character(len=name_length) :: name          !! as in the program's input
        character(len=summary_length) :: summary    !! what the law is, in words
        type(constant_table) :: constants           !! its own, in the order of `props`
        type(internal_variable) :: internal = no_internal_variable
    end type law_description

    type, abstract, extends(law) :: named_law
    contains
        procedure(read_interface), deferred :: read
        procedure, nopass :: mobilises_cohesion => adds_no_cohesion
        procedure(coefficient_interface), deferred :: typical_coefficient
        procedure :: largest_coefficient => typical_is_largest
        procedure :: kinetic_coefficient => typical_is_kinetic
        procedure :: rate_weakening => no_rate_weakening
        procedure :: healing_rate => never_heals
        procedure :: order => first_order
    end type named_law

    abstract interface
        !> Takes the law's own constants, which it checks by its table of them.
        pure subroutine read_interface(self, n, constants, n_own, status)
            import :: named_law, wp
            implicit none
            class(named_law), intent(inout) :: self
            integer, intent(in) :: n               !! how many are given, those of options included
            real(wp), intent(in) :: constants(n)   !! finite
            integer, intent(out) :: n_own          !! how many of them, at most, are the law's own
            integer, intent(out) :: status         !! ok, bad size, or bad property
        end subroutine read_interface

        !> A friction coefficient that characterises the law.
        pure function coefficient_interface(self) result(mu)
            import :: named_law, wp
            implicit none
            class(named_law), intent(in) :: self
            real(wp) :: mu   !! [-]
        end function coefficient_interface

        !> Internal variables of a point that no load has touched.
        pure function virgin_interface(self) result(state)
            import :: law, law_state
            implicit none
            class(law), intent(in) :: self
            type(law_state) :: state
        end function virgin_interface

        !> Could these internal variables have come from this law?
        pure function admits_interface(self, state) result(valid)
            import :: law, law_state
            implicit none
            class(law), intent(in) :: self
            type(law_state), intent(in) :: state   !! finite numbers
            logical :: valid
        end function admits_interface

        !> An increment without slip; an open contact has no pressure and carries no traction.
        pure subroutine rest_interface(self, traction, pressure, dt, old, new, strength)
            import :: law, law_state, wp
            implicit none
            class(law), intent(in) :: self
            real(wp), intent(in) :: traction   !! tangential traction carried elastically, >= 0
                                               !! [F/L^2]
            real(wp), intent(in) :: pressure        !! contact pressure, >= 0 [F/L^2]
            real(wp), intent(in) :: dt              !! increment of time, >= 0 [T]
            type(law_state), intent(in) :: old      !! state at the start of the increment
            type(law_state), intent(out) :: new   !! state at its end, if the traction is below the
                                                  !! strength
            real(wp), intent(out) :: strength   !! tangential traction at which slip starts [F/L^2]
        end subroutine rest_interface

        !> Resistance after sliding by `slip`, with the derivatives that the consistent tangent
        !> needs; without the cap, which is the return mapping's.
        pure subroutine slide_interface(self, slip, pressure, dt, old, new, resistance, d_slip, &
            d_pressure)
            import :: law, law_state, wp
            implicit none
            class(law), intent(in) :: self
            real(wp), intent(in) :: slip            !! slip in this increment, >= 0 [L]
            real(wp), intent(in) :: pressure        !! contact pressure, > 0 [F/L^2]
            real(wp), intent(in) :: dt              !! increment of time, >= 0 [T]
            type(law_state), intent(in) :: old      !! state at the start of the increment
            type(law_state), intent(out) :: new     !! state at its end
            real(wp), intent(out) :: resistance     !! tangential traction [F/L^2]
            real(wp), intent(out) :: d_slip         !! d(resistance)/d(slip) [F/L^3]
            real(wp), intent(out) :: d_pressure     !! d(resistance)/d(pressure) [-]
        end subroutine slide_interface

        !> Slip rate in continuous time: what keeps the traction at the strength, 0 below it.
        pure subroutine slip_rate_interface(self, state, load, rate, jumps)
            import :: law, law_state, load_rates, wp
            implicit none
            class(law), intent(in) :: self
            type(law_state), intent(in) :: state
            type(load_rates), intent(in) :: load   !! pressure >= 0
            real(wp), intent(out) :: rate          !! >= 0, unless taken to slide [L/T]
            logical, intent(out) :: jumps   !! the strength falls faster than the spring unloads: no
                                            !! rate is fast enough
        end subroutine slip_rate_interface

        !> Rates of the internal variables in continuous time.
        pure function state_rates_interface(self, state, load, slip_rate) result(rates)
            import :: law, law_state, load_rates, wp
            implicit none
            class(law), intent(in) :: self
            type(law_state), intent(in) :: state
            type(load_rates), intent(in) :: load     !! pressure >= 0
            real(wp), intent(in) :: slip_rate        !! >= 0 [L/T]
            type(law_state) :: rates                 !! per unit of time
        end function state_rates_interface
    end interface

contains

    !> Bounds of d(resistance)/d(slip), without the cap, between two slips: rigorous, and the
    !> tighter the closer the two. The search for the first equilibrium rests on them.
    !>
    !> A resistance that is constant or falls ever slower (convex) has them at the ends; a law with
    !> another one overrides this.
    pure subroutine slopes_of_convex(self, first, last, pressure, dt, old, least, most)
        class(law), intent(in) :: self
        type(sliding), intent(in) :: first   !! what `slide` says of the smaller slip, ...
        type(sliding), intent(in) :: last    !! ... and of the larger one
        real(wp), intent(in) :: pressure     !! contact pressure, > 0 [F/L^2]
        real(wp), intent(in) :: dt           !! increment of time, >= 0 [T]
        type(law_state), intent(in) :: old   !! state at the start of the increment
        real(wp), intent(out) :: least, most   !! `unbounded` where nothing better is known [F/L^3]

        least = first%d_slip
        most = last%d_slip
    end subroutine slopes_of_convex

    !> The most that the resistance, without the cap, falls per slip anywhere in an increment. A
    !> spring that unloads faster has one equilibrium with it at most. A law that can tell without
    !> more ado overrides this.
    pure function no_bound(self, pressure, dt, old) result(fall)
        class(law), intent(in) :: self
        real(wp), intent(in) :: pressure     !! contact pressure, > 0 [F/L^2]
        real(wp), intent(in) :: dt           !! increment of time, >= 0 [T]
        type(law_state), intent(in) :: old   !! state at the start of the increment
        real(wp) :: fall                     !! >= 0 [F/L^3]

        fall = unbounded
    end function no_bound

    !> Magnitude of the terms that the resistance is computed from: units of round-off of this are
    !> its error. A law with terms that cancel overrides it.
    pure function scale_of_itself(self, slid, dt, old) result(scale)
        class(law), intent(in) :: self
        type(sliding), intent(in) :: slid      !! what `slide` says
        real(wp), intent(in) :: dt             !! increment of time, >= 0 [T]
        type(law_state), intent(in) :: old     !! state at the start of the increment
        real(wp) :: scale                      !! [F/L^2]

        scale = slid%resistance
    end function scale_of_itself

    !> The search leaves a misfit, which is round-off, between spring and law. A law whose state
    !> tells the traction makes the two agree.
    pure subroutine settled_already(self, misfit, stiffness, pressure, answer)
        class(law), intent(in) :: self
        real(wp), intent(in) :: misfit         !! traction of the spring less resistance [F/L^2]
        real(wp), intent(in) :: stiffness      !! of the spring [F/L^3]
        real(wp), intent(in) :: pressure       !! contact pressure, > 0 [F/L^2]
        type(sliding), intent(inout) :: answer
    end subroutine settled_already

    !> Does the resistance depend on the slip rate, which an increment without time leaves
    !> undefined? A law of which that is true overrides this.
    pure function needs_no_time(self) result(needs)
        class(law), intent(in) :: self
        logical :: needs

        needs = .false.
    end function needs_no_time

    !> The equilibrium `trial - stiffness*slip = resistance(slip)`, without the cap, by a way of the
    !> law's own, where it has a fast one. It may give up (`solved` false): the return mapping's own
    !> search, slower but sure, takes over then.
    !>
    !> To have solved it means that from any slip at which the spring pulls harder than the surface
    !> resists, one equilibrium follows, and no more than one; and that this is it, to round-off.
    pure subroutine not_solved(self, trial, stiffness, pressure, dt, old, answer, solved)
        class(law), intent(in) :: self
        real(wp), intent(in) :: trial           !! tangential traction without slip [F/L^2]
        real(wp), intent(in) :: stiffness       !! tangential stiffness, > 0 [F/L^3]
        real(wp), intent(in) :: pressure        !! contact pressure, > 0 [F/L^2]
        real(wp), intent(in) :: dt              !! increment of time, >= 0 [T]
        type(law_state), intent(in) :: old      !! state at the start of the increment
        type(sliding), intent(out) :: answer    !! the equilibrium, if solved
        logical, intent(out) :: solved          !! see above

        solved = .false.
    end subroutine not_solved

    !> Resistance in continuous time at a slip rate. A law that depends on the rate overrides this.
    pure subroutine resistance_at_any_rate(self, state, rate, pressure, resistance, by_rate)
        class(law), intent(in) :: self
        type(law_state), intent(in) :: state
        real(wp), intent(in) :: rate          !! slip rate, >= 0 [L/T]
        real(wp), intent(in) :: pressure      !! contact pressure, >= 0 [F/L^2]
        real(wp), intent(out) :: resistance   !! [F/L^2]
        real(wp), intent(out) :: by_rate      !! its derivative by the rate [F T/L^3]
        type(law_state) :: new

        call self%rest(0.0_wp, pressure, 0.0_wp, state, new, resistance)
        by_rate = 0.0_wp
    end subroutine resistance_at_any_rate

    !> Derivative of `resistance_at` by what the law remembers, or by its logarithm (`traits`).
    !> Asked of laws without a yield point on a contact without a spring: they override this.
    pure function remembers_nothing(self, state, rate, pressure) result(derivative)
        class(law), intent(in) :: self
        type(law_state), intent(in) :: state
        real(wp), intent(in) :: rate       !! slip rate, >= 0 [L/T]
        real(wp), intent(in) :: pressure   !! contact pressure, >= 0 [F/L^2]
        real(wp) :: derivative             !! [F/L^2]

        derivative = 0.0_wp
    end function remembers_nothing

    !> A law that remembers something, or that starts to slip in another way, overrides this.
    pure function simple_traits(self) result(traits)
        class(law), intent(in) :: self
        type(law_traits) :: traits

        traits = law_traits()
    end function simple_traits

    !> Does a traction stay below a strength by more than round-off?
    pure function below(load, strength) result(sticks)
        type(load_rates), intent(in) :: load
        real(wp), intent(in) :: strength   !! [F/L^2]
        logical :: sticks
        real(wp), parameter :: round_off = 64.0_wp * epsilon(1.0_wp)

        sticks = .not. load%sliding .and. load%traction < strength * (1.0_wp - round_off)
    end function below

    !> d(resistance)/d(r at the start of sliding), for a law that follows the path.
    pure function no_start_rate(self, pressure, start, slid) result(rate)
        class(law), intent(in) :: self
        real(wp), intent(in) :: pressure           !! contact pressure, > 0 [F/L^2]
        type(law_state), intent(in) :: start       !! state at the start of sliding
        type(sliding), intent(in) :: slid          !! slip, and the state after it
        real(wp) :: rate                           !! [F/L^2]

        rate = 0.0_wp
    end function no_start_rate

    !> The state after a sudden change of the pressure, for those who integrate rates. A law whose
    !> state depends on that overrides this.
    pure function not_pressed(self, state, before, after) result(new)
        class(law), intent(in) :: self
        type(law_state), intent(in) :: state
        real(wp), intent(in) :: before, after   !! contact pressure, > 0 [F/L^2]
        type(law_state) :: new

        new = state
    end function not_pressed

    !> Does the law itself add its cohesion to its strength, because it carries a share of that?
    !> Otherwise module friction_cohesion adds it to the resistance.
    pure function adds_no_cohesion() result(mobilises)
        logical :: mobilises

        mobilises = .false.
    end function adds_no_cohesion

    !> The most that friction can be while the surface rests; huge where there is no such bound.
    pure function typical_is_largest(self) result(mu)
        class(named_law), intent(in) :: self
        real(wp) :: mu   !! [-]

        mu = self%typical_coefficient()
    end function typical_is_largest

    !> The friction coefficient that is left when the surface has slid far, where that is a constant
    !> of the law; else the typical one.
    pure function typical_is_kinetic(self) result(mu)
        class(named_law), intent(in) :: self
        real(wp) :: mu   !! [-]

        mu = self%typical_coefficient()
    end function typical_is_kinetic

    !> How fast the friction coefficient falls with the slip rate when slip begins; 0 where it does
    !> not depend on the slip rate then.
    pure function no_rate_weakening(self) result(slope)
        class(named_law), intent(in) :: self
        real(wp) :: slope   !! >= 0 [T/L]

        slope = 0.0_wp
    end function no_rate_weakening

    !> How fast the friction coefficient in the state grows while the surface rests.
    pure function never_heals(self, state) result(rate)
        class(named_law), intent(in) :: self
        type(law_state), intent(in) :: state
        real(wp) :: rate   !! [1/T]

        rate = 0.0_wp
    end function never_heals

    !> Order of accuracy, in the length of an increment in which the slip rate varies.
    pure function first_order(self) result(order)
        class(named_law), intent(in) :: self
        integer :: order

        order = 1
    end function first_order

end module friction_law
