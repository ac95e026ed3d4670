!> What the program asks the library about a friction law, from its constants in the order of
!> `props`.
module law_facts
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use friction_mod, only : facts => law_facts, friction_facts, friction_internal_variable, &
        friction_law_of, library_variable => internal_variable
    implicit none
    private

    public :: has_r, internal_variable, typical_coefficient

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

end module law_facts
