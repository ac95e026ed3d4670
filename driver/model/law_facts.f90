!> What the program asks the library about a friction law, from its constants in the order of
!> `props`.
module law_facts
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use friction_mod, only : facts => law_facts, friction_facts, friction_internal_variable, &
        friction_law_of, friction_place, library_variable => internal_variable
    implicit none
    private

    public :: cohesion_of_each, has_r, internal_variable, pressure_effect, pressure_effects, &
        strength_at, typical_strength

    !> Of `pressure_effect`, where the contact counts as open before its pressure vanishes: below
    !> 8e-4 of the largest [-].
    real(dp), parameter, public :: largest_pressure_effect = 28.0_dp

contains

    !> Has the law a similarity ratio R, which tells how much of the friction is mobilised?
    pure logical function has_r(props) result(yes)
        real(dp), intent(in) :: props(:)   !! constants of the friction routine
        type(library_variable) :: variable

        variable = friction_internal_variable(friction_law_of(props))
        yes = variable%exists .and. variable%name == 'R'
    end function has_r

    !> What the law calls its internal variable; R if it has none.
    pure character(len=5) function internal_variable(props) result(name)
        real(dp), intent(in) :: props(:)   !! constants of the friction routine
        type(library_variable) :: variable

        variable = friction_internal_variable(friction_law_of(props))
        name = variable%name(:len(name))
    end function internal_variable

    !> What stands for the strength of the contact under a pressure: static friction, or that of
    !> steady sliding at the reference rate, and cohesion [F/L^2].
    pure real(dp) function typical_strength(props, pressure) result(strength)
        real(dp), intent(in) :: props(:)   !! constants of the friction routine
        real(dp), intent(in) :: pressure   !! >= 0 [F/L^2]
        type(facts) :: law

        law = friction_facts(props)
        strength = law%typical_coefficient * pressure + law%cohesion
    end function typical_strength

    !> What a surface that slides carries under a pressure, from its friction coefficient, as
    !> `statev` has it [F/L^2].
    elemental real(dp) function strength_at(law, mu, pressure) result(strength)
        type(facts), intent(in) :: law
        real(dp), intent(in) :: mu         !! [-]
        real(dp), intent(in) :: pressure   !! >= 0 [F/L^2]

        strength = min(law%shear_cap, mu * pressure + law%cohesion)
    end function strength_at

    !> How much the logarithm of what a law remembers falls with that of the pressure [-].
    !> Of several blocks it is the largest.
    pure real(dp) function pressure_effect(props, constants) result(effect)
        real(dp), intent(in) :: props(:)                    !! constants of the friction routine
        real(dp), intent(in), optional :: constants(:, :)   !! of each block, one row a block

        effect = maxval(pressure_effects(props, constants))
    end function pressure_effect

    !> The same of each block; one number, if all are alike.
    pure function pressure_effects(props, constants) result(effects)
        real(dp), intent(in) :: props(:)                    !! constants of the friction routine
        real(dp), intent(in), optional :: constants(:, :)   !! of each block, one row a block
        real(dp), allocatable :: effects(:)                 !! [-]
        integer :: pressed, evolves

        effects = [0.0_dp]
        pressed = friction_place(friction_law_of(props), 'alpha')
        if (pressed < 1) return
        evolves = friction_place(friction_law_of(props), 'b')
        effects = [props(pressed) / props(evolves)]
        if (present(constants)) effects = constants(:, pressed) / constants(:, evolves)
    end function pressure_effects

    !> Tractions that contacts carry without pressure. The place of that constant is asked for once:
    !> asking for all facts of each point takes longer than a step.
    pure function cohesion_of_each(constants) result(tractions)
        real(dp), intent(in) :: constants(:, :)   !! of one law, one row a point; options that are
                                                  !! left out at the end are not there
        real(dp) :: tractions(size(constants, 1)) !! [F/L^2]
        integer :: place

        tractions = 0.0_dp
        place = friction_place(friction_law_of(constants(1, :)), 'cohesion')
        if (place >= 1 .and. place <= size(constants, 2)) tractions = constants(:, place)
    end function cohesion_of_each

end module law_facts
