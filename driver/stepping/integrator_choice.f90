!> Which integrator takes the steps of a run.
module integrator_choice
    use abstract_integrator, only : integrator
    use adaptive_steps, only : adaptive
    use continuous_chain, only : chain_in_continuous_time, continuous_blocks
    use continuous_steps, only : continuous
    use fixed_steps, only : fixed
    use run_settings, only : settings
    use slider_system, only : slider, slider_state
    implicit none
    private

    public :: choose_integrator

contains

    subroutine choose_integrator(run, system, start, chosen)
        type(settings), intent(in) :: run
        type(slider), intent(in) :: system
        type(slider_state), intent(in) :: start   !! the state at time 0
        class(integrator), allocatable, intent(out) :: chosen

        if (run%adaptive .and. .not. run%newmark .and. run%one_by_itself()) then
            allocate (continuous :: chosen)
        else if (run%adaptive .and. chain_in_continuous_time(run)) then
            allocate (continuous_blocks :: chosen)
        else if (run%adaptive) then
            allocate (adaptive :: chosen)
        else
            allocate (fixed :: chosen)
        end if
        call chosen%prepare(run, system, start)
    end subroutine choose_integrator

end module integrator_choice
