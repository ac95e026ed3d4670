!> A friction law with its options, read once and asked often: for programs that integrate the rates
!> of a contact themselves (docs/theory.md, section 10).
module friction_surface
    use friction_cohesion, only : cohesive_resistance, cohesive_slip_rate, cohesive_state_rates
    use friction_kinds, only : wp
    use friction_law, only : law, law_state, law_traits, load_rates, onset_drops, onset_gradual, &
        onset_yields
    implicit none
    private

    public :: law_state, law_traits, load_rates, read_surface, sliding_surface
    public :: onset_drops, onset_gradual, onset_yields

    !> Friction along tangential axis 1.
    type :: sliding_surface
        class(law), allocatable :: law              !! without shear cap; without cohesion, unless
                                                    !! it is mobilised as the law's strength is
        real(wp) :: tau_max = huge(1.0_wp)          !! the cap [F/L^2]
        real(wp) :: cohesion = 0.0_wp               !! added to what the law resists with [F/L^2]
        type(law_traits) :: traits                  !! what the law remembers
    contains
        procedure :: slip_rate, state_rates, resistance_at
    end type sliding_surface

    interface
        !> The law of a surface. Not pure: a polymorphic component may not come out of a pure
        !> procedure.
        module subroutine read_surface(props, surface, status)
            implicit none
            real(wp), intent(in) :: props(:)                !! material constants, as in
                                                            !! `friction_update`, valid
            type(sliding_surface), intent(out) :: surface   !! if the status is ok
            integer, intent(out) :: status   !! ok, bad size, bad law, or bad property
        end subroutine read_surface
    end interface

contains

    !> The law's `slip_rate` with its cohesion, but for the cap.
    pure subroutine slip_rate(self, state, load, rate, jumps)
        class(sliding_surface), intent(in) :: self
        type(law_state), intent(in) :: state
        type(load_rates), intent(in) :: load   !! pressure >= 0
        real(wp), intent(out) :: rate          !! [L/T]
        logical, intent(out) :: jumps

        if (self%cohesion > 0.0_wp) then
            call cohesive_slip_rate(self%law, self%cohesion, state, load, rate, jumps)
        else
            call self%law%slip_rate(state, load, rate, jumps)
        end if
    end subroutine slip_rate

    !> The law's `state_rates`, likewise.
    pure function state_rates(self, state, load, rate) result(rates)
        class(sliding_surface), intent(in) :: self
        type(law_state), intent(in) :: state
        type(load_rates), intent(in) :: load   !! pressure >= 0
        real(wp), intent(in) :: rate           !! of slip, >= 0 [L/T]
        type(law_state) :: rates               !! per unit of time

        if (self%cohesion > 0.0_wp) then
            rates = cohesive_state_rates(self%law, self%cohesion, state, load, rate)
        else
            rates = self%law%state_rates(state, load, rate)
        end if
    end function state_rates

    !> The law's `resistance_at`, likewise.
    pure subroutine resistance_at(self, state, rate, pressure, resistance, by_rate)
        class(sliding_surface), intent(in) :: self
        type(law_state), intent(in) :: state
        real(wp), intent(in) :: rate          !! slip rate, >= 0 [L/T]
        real(wp), intent(in) :: pressure      !! contact pressure, >= 0 [F/L^2]
        real(wp), intent(out) :: resistance   !! [F/L^2]
        real(wp), intent(out) :: by_rate      !! its derivative by the rate [F T/L^3]

        call cohesive_resistance(self%law, self%cohesion, state, rate, pressure, resistance, &
            by_rate)
    end subroutine resistance_at

end module friction_surface
