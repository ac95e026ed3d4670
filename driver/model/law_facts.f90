!> What the program asks the library about a friction law, from its constants in the order of
!> `props`.
module law_facts
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use friction_mod, only : facts => law_facts, friction_facts, friction_internal_variable, &
        friction_law_of, friction_place, library_variable => internal_variable
    implicit none
    private

    public :: cohesion, cohesion_of_each, contact_damping, has_r, internal_variable, &
        typical_strength, virgin_mu

contains

    !> Has the law a similarity ratio R, which tells how much of the friction is mobilised?
    pure function has_r(props) result(yes)
        real(dp), intent(in) :: props(:)   !! constants of the friction routine
        logical :: yes
        type(library_variable) :: variable

        variable = friction_internal_variable(friction_law_of(props))
        yes = variable%exists .and. variable%name == 'R'
    end function has_r

    !> What the law calls its internal variable; R if it has none.
    pure function internal_variable(props) result(name)
        real(dp), intent(in) :: props(:)   !! constants of the friction routine
        character(len=5) :: name
        type(library_variable) :: variable

        variable = friction_internal_variable(friction_law_of(props))
        name = variable%name(:len(name))
    end function internal_variable

    !> What stands for the strength of the contact under a pressure: static friction, or that of
    !> steady sliding at the reference rate, and cohesion.
    pure function typical_strength(props, pressure) result(strength)
        real(dp), intent(in) :: props(:)   !! constants of the friction routine
        real(dp), intent(in) :: pressure   !! >= 0 [F/L^2]
        real(dp) :: strength               !! [F/L^2]
        type(facts) :: law

        law = friction_facts(props)
        strength = law%typical_coefficient * pressure + law%cohesion
    end function typical_strength

    !> Of the damper beside the tangential contact spring.
    pure function contact_damping(props) result(damping)
        real(dp), intent(in) :: props(:)   !! constants of the friction routine
        real(dp) :: damping                !! 0: there is none [F T/L^3]
        type(facts) :: law

        law = friction_facts(props)
        damping = law%damping
    end function contact_damping

    !> Traction that the contact carries without pressure.
    pure function cohesion(props) result(traction)
        real(dp), intent(in) :: props(:)   !! constants of the friction routine
        real(dp) :: traction               !! [F/L^2]
        type(facts) :: law

        law = friction_facts(props)
        traction = law%cohesion
    end function cohesion

    !> The same of many points. Its place is asked for once: asking for all facts of each point
    !> takes longer than a step.
    pure function cohesion_of_each(constants) result(tractions)
        real(dp), intent(in) :: constants(:, :)   !! of one law, one row a point; options that are
                                                  !! left out at the end are not there
        real(dp) :: tractions(size(constants, 1)) !! [F/L^2]
        integer :: place

        tractions = 0.0_dp
        place = friction_place(friction_law_of(constants(1, :)), 'cohesion')
        if (place >= 1 .and. place <= size(constants, 2)) tractions = constants(:, place)
    end function cohesion_of_each

    !> Friction coefficient of a virgin contact.
    pure function virgin_mu(props) result(mu)
        real(dp), intent(in) :: props(:)   !! constants of the friction routine
        real(dp) :: mu                     !! [-]
        type(facts) :: law

        law = friction_facts(props)
        mu = law%virgin_mu
    end function virgin_mu

end module law_facts
