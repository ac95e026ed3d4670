!> What all ways of stepping the fault in time have in common.
module fault_stepper
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use fault_problem, only : fault, fault_state
    use processes, only : team
    implicit none
    private

    public :: stepper

    type, abstract :: stepper
    contains
        procedure(start_interface), deferred :: start
        procedure(begin_interface), deferred :: begin
        procedure(begin_interface), deferred :: step
        procedure(columns_interface), deferred :: columns
        procedure(visit_interface), deferred :: keep
        procedure(visit_interface), deferred :: take
    end type stepper

    abstract interface
        !> The state at the start of a new run, and the fault's prestress.
        subroutine start_interface(self, here, together, state, problem)
            import :: fault, fault_state, stepper, team
            implicit none
            class(stepper), intent(inout) :: self
            type(fault), intent(inout) :: here
            type(team), intent(in) :: together
            type(fault_state), intent(inout) :: state
            character(len=:), allocatable, intent(out) :: problem   !! empty if there is none
        end subroutine start_interface

        !> begin: makes ready to go on from a state, and completes it. step: one step of `state%dt`
        !> or less. Not sound, on all processes: the state has no slip rates; no step is short
        !> enough.
        subroutine begin_interface(self, here, together, state, sound)
            import :: fault, fault_state, stepper, team
            implicit none
            class(stepper), intent(inout) :: self
            type(fault), intent(inout) :: here
            type(team), intent(in) :: together
            type(fault_state), intent(inout) :: state
            logical, intent(out) :: sound
        end subroutine begin_interface

        !> How many columns a checkpoint needs.
        pure integer function columns_interface(self) result(n)
            import :: stepper
            implicit none
            class(stepper), intent(in) :: self
        end function columns_interface

        !> Puts all that the steps need into a checkpoint, or takes it from there.
        subroutine visit_interface(self, state, columns, number)
            import :: dp, fault_state, stepper
            implicit none
            class(stepper), intent(inout) :: self
            type(fault_state), intent(inout) :: state
            real(dp), intent(inout) :: columns(:, :)   !! cell, column
            real(dp), intent(inout) :: number          !! one for all cells
        end subroutine visit_interface
    end interface

end module fault_stepper
