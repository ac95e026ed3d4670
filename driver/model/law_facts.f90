!> What the program asks about a friction law, from its constants in the order of `props`
!> (docs/laws.md).
module law_facts
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use friction_mod, only : law_coulomb, law_rate_state, law_slip_weakening, &
        law_static_kinetic, law_subloading, scheme_exact_rate, statev_mu, statev_r
    implicit none
    private

    public :: coefficient_error, healing_rate, is_second_order, is_subloading, &
        internal_variable, kinetic_coefficient, rate_weakening, shear_cap, static_coefficient, &
        typical_coefficient

contains

    pure function is_subloading(props) result(yes)
        real(dp), intent(in) :: props(:)   !! constants of the friction routine
        logical :: yes

        yes = nint(props(1)) == law_subloading
    end function is_subloading

    !> Is the error of an increment of the third power of its length? Under a shear cap the
    !> exact-rate scheme books what is dissipated in first order only.
    pure function is_second_order(props) result(yes)
        real(dp), intent(in) :: props(:)   !! constants of the friction routine, options included
        logical :: yes

        yes = is_subloading(props) .and. size(props) >= 12
        if (yes) yes = nint(props(10)) == scheme_exact_rate .and. props(12) <= 0.0_dp
    end function is_second_order

    !> Growth of the friction coefficient of a contact at rest [1/T].
    pure function healing_rate(props, mu) result(rate)
        real(dp), intent(in) :: props(:)   !! constants of the friction routine
        real(dp), intent(in) :: mu         !! friction coefficient [-]
        real(dp) :: rate

        rate = 0.0_dp
        if (is_subloading(props)) rate = props(7) * (props(4) - mu)
    end function healing_rate

    !> What errors of the state variables of blocks mean to their friction coefficients later, in
    !> first order. The coefficient itself may jump, where slip or a shear cap begins to rule it;
    !> what the law remembers does not.
    pure function coefficient_error(props, statev, errors) result(error)
        real(dp), intent(in) :: props(:)                     !! constants of the friction routine
        real(dp), intent(in) :: statev(:, :), errors(:, :)   !! state variables, one row a block
        real(dp) :: error(size(errors, 1))                   !! [-]

        select case (nint(props(1)))
        case (law_coulomb)
            error = 0.0_dp
        case (law_rate_state)
            error = abs(props(5) * errors(:, statev_r) / statev(:, statev_r))
        case (law_slip_weakening)
            error = merge((props(4) - props(5)) / props(6) * abs(errors(:, statev_r)), 0.0_dp, &
                statev(:, statev_r) < props(6))   ! then it stays at mu_k
        case default
            error = abs(errors(:, statev_mu))
        end select
    end function coefficient_error

    !> The coefficient that stands for the strength of the contact: the static one, or that of
    !> steady sliding at the reference rate.
    pure function typical_coefficient(props) result(mu)
        real(dp), intent(in) :: props(:)   !! constants of the friction routine
        real(dp) :: mu                     !! [-]

        mu = props(4)
        if (nint(props(1)) == law_rate_state) mu = max(mu, props(8))
    end function typical_coefficient

    !> The most that friction can be while the surface rests; infinite where there is no such bound.
    pure function static_coefficient(props) result(mu)
        real(dp), intent(in) :: props(:)   !! of the friction routine
        real(dp) :: mu                     !! [-]

        mu = props(4)
        if (nint(props(1)) == law_rate_state) mu = huge(mu)
    end function static_coefficient

    !> How fast the friction coefficient falls with the slip rate when slip begins [T/L]; 0 under
    !> laws whose friction does not depend on it then.
    pure function rate_weakening(props) result(slope)
        real(dp), intent(in) :: props(:)   !! constants of the friction routine
        real(dp) :: slope                  !! >= 0

        slope = 0.0_dp
        if (nint(props(1)) == law_static_kinetic) slope = (props(4) - props(5)) * props(6)
    end function rate_weakening

    !> What the law calls its internal variable; R if it has none.
    pure function internal_variable(props) result(name)
        real(dp), intent(in) :: props(:)   !! constants of the friction routine
        character(len=5) :: name

        name = 'R'
        if (nint(props(1)) == law_rate_state) name = 'theta'
        if (nint(props(1)) == law_slip_weakening) name = 'D'
    end function internal_variable

    !> The shear cap, huge without one.
    pure function shear_cap(props) result(tau_max)
        real(dp), intent(in) :: props(:)   !! as `read_friction` makes them
        real(dp) :: tau_max                !! [F/L^2]

        tau_max = props(size(props) - 2)   ! after it mu_ratio and direction
        if (tau_max <= 0.0_dp) tau_max = huge(tau_max)
    end function shear_cap

    !> The friction coefficient that is left when the surface has slid far, where that is a constant
    !> of the law; else the static one.
    pure function kinetic_coefficient(props) result(mu)
        real(dp), intent(in) :: props(:)   !! of the friction routine
        real(dp) :: mu                     !! [-]

        mu = props(5)
        if (any(nint(props(1)) == [law_coulomb, law_rate_state])) mu = typical_coefficient(props)
    end function kinetic_coefficient

end module law_facts
