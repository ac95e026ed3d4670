!> What the program asks the library about a friction law, from its constants in the order of
!> `props`.
module law_facts
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use friction_mod, only : facts => law_facts, friction_coefficient_change, friction_facts, &
        friction_healing_rate, friction_internal_variable, friction_law_of, library_variable => &
        internal_variable, statev_mu, statev_r, statev_size
    implicit none
    private

    public :: coefficient_error, coefficient_range, healing_rate, internal_variable, has_r, &
        rate_weakening, typical_coefficient

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

    !> The coefficient that stands for the strength of the contact: the static one, or that of
    !> steady sliding at the reference rate.
    pure function typical_coefficient(props) result(mu)
        real(dp), intent(in) :: props(:)   !! constants of the friction routine
        real(dp) :: mu                     !! [-]
        type(facts) :: law

        law = friction_facts(props)
        mu = law%typical_coefficient
    end function typical_coefficient

    !> Between which coefficients the friction of a law with an R stays: the kinetic and the static
    !> one.
    pure function coefficient_range(props) result(bounds)
        real(dp), intent(in) :: props(:)   !! constants of the friction routine
        real(dp) :: bounds(2)              !! [-]
        type(facts) :: law

        law = friction_facts(props)
        bounds = [law%kinetic_coefficient, law%largest_coefficient]
    end function coefficient_range

    !> How fast the friction coefficient falls with the slip rate when slip begins [T/L]; 0 under
    !> laws whose friction does not depend on it then.
    pure function rate_weakening(props) result(slope)
        real(dp), intent(in) :: props(:)   !! constants of the friction routine
        real(dp) :: slope                  !! >= 0
        type(facts) :: law

        law = friction_facts(props)
        slope = law%rate_weakening
    end function rate_weakening

    !> Growth of the friction coefficient of a contact at rest [1/T].
    pure function healing_rate(props, mu) result(rate)
        real(dp), intent(in) :: props(:)   !! constants of the friction routine
        real(dp), intent(in) :: mu         !! friction coefficient [-]
        real(dp) :: rate
        real(dp) :: statev(statev_size)

        statev = 0.0_dp
        statev(statev_mu) = mu
        rate = friction_healing_rate(props, statev)
    end function healing_rate

    !> What errors of the state variables of blocks mean to their friction coefficients later, in
    !> first order.
    pure function coefficient_error(props, statev, errors) result(error)
        real(dp), intent(in) :: props(:)                     !! constants of the friction routine
        real(dp), intent(in) :: statev(:, :), errors(:, :)   !! state variables, one row a block
        real(dp) :: error(size(errors, 1))                   !! [-]
        type(facts) :: law

        law = friction_facts(props)
        error = friction_coefficient_change(law%traits, statev(:, statev_r), &
            errors(:, statev_mu), errors(:, statev_r))
    end function coefficient_error

end module law_facts
