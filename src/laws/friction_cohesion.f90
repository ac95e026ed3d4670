!> Cohesion for any friction law: a tangential traction that a closed contact carries without
!> pressure (docs/theory.md, section 15),
!>
!>     resistance = resistance of the law + cohesion
!>
!> The law's internal variables evolve as without it, with the slip that results; a surface that
!> creeps under any traction rests below the cohesion. A law that carries a share of its strength
!> (`mobilises_cohesion`) adds that share of the cohesion itself, in place of this module.
!>
!> A contact may be closed without pressure: there the law has no say, and the surface resists with
!> the cohesion alone.
module friction_cohesion
    use friction_kinds, only : wp
    use friction_law, only : below, law, law_state, load_rates, sliding
    use friction_law_around, only : law_around
    use friction_law_constants, only : law_constant
    implicit none
    private

    public :: cohesive_law, cohesive_resistance, cohesive_slip_rate, cohesive_state_rates

    !> The constant that every law takes after those of orthotropic friction.
    type(law_constant), parameter, public :: cohesion_constants(1) = [ &
        law_constant('cohesion', 'F/L^2', 'tangential traction that is carried without pressure', &
        'Cohesion', &
        lower=0.0_wp, optional=.true.)]

    type, extends(law_around) :: cohesive_law
    contains
        procedure :: rest
        procedure :: slide
        procedure :: slip_rate
        procedure :: state_rates
        procedure :: resistance_at
        procedure :: scale_of_terms
        procedure :: settle
        procedure :: slopes
        procedure :: solve
    end type cohesive_law

contains

    pure subroutine rest(self, traction, pressure, dt, old, new, strength)
        class(cohesive_law), intent(in) :: self
        real(wp), intent(in) :: traction, pressure, dt
        type(law_state), intent(in) :: old
        type(law_state), intent(out) :: new
        real(wp), intent(out) :: strength

        call self%inner%rest(traction, pressure, dt, old, new, strength)
        strength = strength + self%cohesion
    end subroutine rest

    pure subroutine slide(self, slip, pressure, dt, old, new, resistance, d_slip, d_pressure)
        class(cohesive_law), intent(in) :: self
        real(wp), intent(in) :: slip, pressure, dt
        type(law_state), intent(in) :: old
        type(law_state), intent(out) :: new
        real(wp), intent(out) :: resistance, d_slip, d_pressure

        call self%inner%slide(slip, pressure, dt, old, new, resistance, d_slip, d_pressure)
        resistance = resistance + self%cohesion
    end subroutine slide

    !> The equilibrium of the law with what the spring pulls above the cohesion.
    pure subroutine solve(self, trial, stiffness, pressure, dt, old, answer, solved)
        class(cohesive_law), intent(in) :: self
        real(wp), intent(in) :: trial, stiffness, pressure, dt
        type(law_state), intent(in) :: old
        type(sliding), intent(out) :: answer
        logical, intent(out) :: solved

        if (pressure > 0.0_wp) then
            call self%inner%solve(trial - self%cohesion, stiffness, pressure, dt, old, answer, &
                solved)
            answer%resistance = answer%resistance + self%cohesion
        else
            answer%slip = (trial - self%cohesion) / stiffness
            call self%slide(answer%slip, pressure, dt, old, answer%state, answer%resistance, &
                answer%d_slip, answer%d_pressure)
            solved = .true.
        end if
    end subroutine solve

    pure subroutine slopes(self, first, last, pressure, dt, old, least, most)
        class(cohesive_law), intent(in) :: self
        type(sliding), intent(in) :: first, last
        real(wp), intent(in) :: pressure, dt
        type(law_state), intent(in) :: old
        real(wp), intent(out) :: least, most

        least = 0.0_wp
        most = 0.0_wp
        if (pressure > 0.0_wp) call self%inner%slopes(first, last, pressure, dt, old, least, most)
    end subroutine slopes

    pure function scale_of_terms(self, slid, dt, old) result(scale)
        class(cohesive_law), intent(in) :: self
        type(sliding), intent(in) :: slid
        real(wp), intent(in) :: dt
        type(law_state), intent(in) :: old
        real(wp) :: scale
        type(sliding) :: own

        own = slid
        own%resistance = slid%resistance - self%cohesion
        scale = self%cohesion + abs(self%inner%scale_of_terms(own, dt, old))
    end function scale_of_terms

    pure subroutine settle(self, misfit, stiffness, pressure, answer)
        class(cohesive_law), intent(in) :: self
        real(wp), intent(in) :: misfit, stiffness, pressure
        type(sliding), intent(inout) :: answer

        if (.not. pressure > 0.0_wp) return
        answer%resistance = answer%state%mu * pressure   ! a difference would lose its digits
        call self%inner%settle(misfit, stiffness, pressure, answer)
        answer%resistance = answer%resistance + self%cohesion
    end subroutine settle

    pure subroutine slip_rate(self, state, load, rate, jumps)
        class(cohesive_law), intent(in) :: self
        type(law_state), intent(in) :: state
        type(load_rates), intent(in) :: load
        real(wp), intent(out) :: rate
        logical, intent(out) :: jumps

        call cohesive_slip_rate(self%inner, self%cohesion, state, load, rate, jumps)
    end subroutine slip_rate

    pure function state_rates(self, state, load, slip_rate) result(rates)
        class(cohesive_law), intent(in) :: self
        type(law_state), intent(in) :: state
        type(load_rates), intent(in) :: load
        real(wp), intent(in) :: slip_rate
        type(law_state) :: rates

        rates = cohesive_state_rates(self%inner, self%cohesion, state, load, slip_rate)
    end function state_rates

    pure subroutine resistance_at(self, state, rate, pressure, resistance, by_rate)
        class(cohesive_law), intent(in) :: self
        type(law_state), intent(in) :: state
        real(wp), intent(in) :: rate, pressure
        real(wp), intent(out) :: resistance, by_rate

        call cohesive_resistance(self%inner, self%cohesion, state, rate, pressure, resistance, &
            by_rate)
    end subroutine resistance_at

    !> The slip rate of a law that has a cohesion added to it: with none, that of the law.
    pure subroutine cohesive_slip_rate(inner, cohesion, state, load, rate, jumps)
        class(law), intent(in) :: inner
        real(wp), intent(in) :: cohesion       !! >= 0 [F/L^2]
        type(law_state), intent(in) :: state
        type(load_rates), intent(in) :: load   !! pressure >= 0
        real(wp), intent(out) :: rate          !! as of `slip_rate` [L/T]
        logical, intent(out) :: jumps

        jumps = .false.
        if (.not. cohesion > 0.0_wp) then
            call inner%slip_rate(state, load, rate, jumps)
        else if (below(load, cohesion)) then
            rate = 0.0_wp
        else if (load%pressure > 0.0_wp) then
            call inner%slip_rate(state, without(load, cohesion), rate, jumps)
        else
            rate = (load%loading - state%mu * load%pressure_rate) / load%stiffness
            if (.not. load%sliding) rate = max(0.0_wp, rate)
        end if
    end subroutine cohesive_slip_rate

    !> Rates of the internal variables of such a law.
    pure function cohesive_state_rates(inner, cohesion, state, load, slip_rate) result(rates)
        class(law), intent(in) :: inner
        real(wp), intent(in) :: cohesion         !! >= 0 [F/L^2]
        type(law_state), intent(in) :: state
        type(load_rates), intent(in) :: load     !! pressure >= 0
        real(wp), intent(in) :: slip_rate        !! >= 0 [L/T]
        type(law_state) :: rates                 !! per unit of time
        type(load_rates) :: rest

        if (.not. cohesion > 0.0_wp) then
            rates = inner%state_rates(state, load, slip_rate)
        else if (slip_rate > 0.0_wp) then
            rates = inner%state_rates(state, without(load, cohesion), slip_rate)
        else   ! the law carries nothing
            rest = without(load, load%traction)
            rest%loading = 0.0_wp
            rates = inner%state_rates(state, rest, slip_rate)
        end if
    end function cohesive_state_rates

    !> Its resistance at a slip rate.
    pure subroutine cohesive_resistance(inner, cohesion, state, rate, pressure, resistance, by_rate)
        class(law), intent(in) :: inner
        real(wp), intent(in) :: cohesion      !! >= 0 [F/L^2]
        type(law_state), intent(in) :: state
        real(wp), intent(in) :: rate          !! slip rate, >= 0 [L/T]
        real(wp), intent(in) :: pressure      !! contact pressure, >= 0 [F/L^2]
        real(wp), intent(out) :: resistance   !! [F/L^2]
        real(wp), intent(out) :: by_rate      !! its derivative by the rate [F T/L^3]

        call inner%resistance_at(state, rate, pressure, resistance, by_rate)
        resistance = resistance + cohesion
    end subroutine cohesive_resistance

    !> A load of which a part is carried by something else.
    pure function without(load, part) result(rest)
        type(load_rates), intent(in) :: load
        real(wp), intent(in) :: part   !! [F/L^2]
        type(load_rates) :: rest

        rest = load
        rest%traction = max(0.0_wp, load%traction - part)
    end function without

end module friction_cohesion
