!> Rate-and-state friction whose state depends on the contact pressure (Linker and Dieterich 1992):
!> where that rises, contacts are younger on average,
!>
!>     theta_dot = (ageing or slip law) - (alpha/b) theta p_dot/p
!>
!> so that friction does not follow a step of the pressure at once but by 1 - alpha/mu of it, and
!> by the rest over the slip d_c. Law, evolution and search are those of rate-and-state friction,
!> which know of alpha; within an increment ln(p) is taken to change evenly, for which both
!> evolutions have closed forms.
module friction_linker_dieterich_law
    use friction_kinds, only : wp
    use friction_law, only : law_description
    use friction_law_constants, only : constant_table, law_constant, no_constants, positive
    use friction_rate_state_law, only : rate_state_constants, rate_state_law, state_variable
    implicit none
    private

    public :: linker_dieterich_law

    type, extends(rate_state_law) :: linker_dieterich_law
    contains
        procedure :: read => read_constants
    end type linker_dieterich_law

    !> Its own constants; in `props` they stand from place 4 on.
    type(law_constant), parameter :: table(8) = [ &
        rate_state_constants(1), &
        law_constant('b', '-', 'evolution effect', 'EvolutionEffect', lower=positive), &
        rate_state_constants(3:5), &
        law_constant('alpha', '-', 'effect of the pressure on the state', 'PressureEffect', &
        lower=0.0_wp), &
        rate_state_constants(6:7)]

    type(law_description), parameter, public :: linker_dieterich_description = law_description( &
        name='linker_dieterich', &
        summary='Rate-and-state friction whose state depends on the contact pressure', &
        constants=constant_table(size(table), [table, no_constants(size(table) + 1:)]), &
        internal=state_variable)
    integer, parameter :: n_needed = 6

contains

    pure subroutine read_constants(self, n, constants, n_own, status)
        class(linker_dieterich_law), intent(inout) :: self
        integer, intent(in) :: n
        real(wp), intent(in) :: constants(n)
        integer, intent(out) :: n_own, status
        real(wp) :: c(size(table))

        n_own = size(table)
        call self%read_common(size(table), table, n_needed, n, constants, c, status)
        if (status < 0) return
        self%alpha = c(6)
        self%evolution = int(c(7))
        self%theta_0 = c(8)
    end subroutine read_constants

end module friction_linker_dieterich_law
