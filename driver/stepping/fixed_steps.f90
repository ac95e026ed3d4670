!> Steps of one length, by Newmark's or the generalised-alpha method.
module fixed_steps
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use abstract_integrator, only : integrator, step_report
    use archive_file, only : archive
    use chain_parts, only : choose_method
    use energies, only : account
    use friction_mod, only : statev_r
    use law_facts, only : largest_pressure_effect, pressure_effects
    use run_settings, only : settings
    use slider_system, only : slider, slider_state
    use step_ends, only : load_at, most_change, none_below, within_range
    use step_sums, only : block_sums
    use time_integrator, only : newmark
    implicit none
    private

    public :: fixed

    type, extends(integrator) :: fixed
        class(newmark), allocatable :: method
        integer :: passed = 0          !! whole steps behind us
        integer :: parts = 1           !! pieces that the step is being taken in
        type(block_sums), private :: over_step   !! the last one
        real(dp), allocatable :: effects(:)   !! of the pressure on what the law remembers, of each
                                              !! block; one, if all are alike [-]
        real(dp) :: open_below = 0.0_dp       !! normal traction that counts as none, where it
                                              !! varies under a law with such an effect [F/L^2]
    contains
        procedure :: prepare, step, sums, visit, why_stopped
        procedure, private :: carry_over
    end type fixed

    integer, parameter :: most_parts = 2**20   !! of a step
    real(dp), parameter :: round_off = 1.0e-9_dp   !! part of a step

contains

    subroutine prepare(self, run, system, start)
        class(fixed), intent(inout) :: self
        type(settings), intent(in) :: run
        type(slider), intent(in) :: system
        type(slider_state), intent(in) :: start
        real(dp), parameter :: least_part = 1.0e-6_dp   !! of the largest, which counts as none

        call self%take_run(run, system, start)
        call choose_method(run, self%method)
        self%effects = pressure_effects(system%props, system%constants)
        if (any(self%effects > 0.0_dp)) self%open_below = run%drive%largest_normal() &
            * max(least_part, within_range(min(largest_pressure_effect, maxval(self%effects))))
    end subroutine prepare

    !> A state that depends on the pressure has no bound where that vanishes; the law keeps it as it
    !> is in an increment that opens or closes the contact, wherever within the step that happens.
    !> What has a limit is `theta p^(alpha/b)`. So the contact opens, and closes, at one small
    !> pressure, and the state goes to it from that at the start, and from it to that at the end.
    subroutine carry_over(self, old, new)
        class(fixed), intent(in) :: self
        type(slider_state), intent(in) :: old
        type(slider_state), intent(inout) :: new
        real(dp) :: change
        integer :: i

        if (.not. self%open_below > 0.0_dp) return
        if (old%normal > 0.0_dp .eqv. new%normal > 0.0_dp) return
        if (.not. (self%system%across%free() .or. none_below(self%drive, self%drive%piece( &
            new%time - round_off * self%dt), self%open_below) > 0.0_dp)) return
        if (old%normal > 0.0_dp) then
            change = log(old%normal / self%open_below)
        else
            change = -log(new%normal / self%open_below)
        end if
        do i = 1, size(new%x)
            associate (theta => new%statev(i, statev_r), &
                effect => self%effects(min(i, size(self%effects))))
                theta = theta * exp(max(-most_change, min(most_change, effect * change)))
            end associate
        end do
    end subroutine carry_over

    !> With a mass the step is the fixed one; without, or where a block moves across the interface,
    !> a step that fails is taken in parts, because the balance of forces may be followed in small
    !> steps where it cannot be found in a large one.
    subroutine step(self, old, new, report)
        class(fixed), intent(inout) :: self
        type(slider_state), intent(inout) :: old
        type(slider_state), intent(inout) :: new
        type(step_report), intent(out) :: report
        real(dp) :: aim, time
        logical :: complete

        aim = (self%passed + 1) * self%dt
        if (aim > self%t_end * (1.0_dp - round_off)) aim = self%t_end
        do
            complete = self%parts == 1
            time = aim
            if (.not. complete) time = old%time + (aim - old%time) / self%parts
            call self%method%step(self%system, self%origin + self%drive%position(time), &
                load_at(self%drive, time, self%drive%piece(time + round_off * self%dt), &
                self%open_below), time - old%time, old, new, report)
            if (report%status >= 0) then
                self%over_step = self%method%sums(self%system, old, new)
                call account(self%system, self%over_step, old, new)
            end if
            new%time = time
            if (report%status >= 0) call self%carry_over(old, new)
            call self%count_iterations(report%iterations)
            if (report%status >= 0) exit
            if (self%system%mass > 0.0_dp .and. .not. self%system%across%free()) exit
            if (2 * self%parts > most_parts) exit
            self%parts = 2 * self%parts
            self%rejected = self%rejected + 1
        end do
        report%complete = complete
        if (report%status < 0) return
        if (complete) then
            self%passed = self%passed + 1
        else
            self%parts = self%parts - 1
            if (mod(self%parts, 2) == 0) self%parts = self%parts / 2
        end if
    end subroutine step

    pure subroutine sums(self, old, new, over_step)
        class(fixed), intent(in) :: self
        type(slider_state), intent(in) :: old, new
        type(block_sums), intent(out) :: over_step

        over_step = self%over_step
    end subroutine sums

    subroutine visit(self, file)
        class(fixed), intent(inout) :: self
        type(archive), intent(inout) :: file

        call self%visit_counts(file)
        call file%visit(self%passed, self%parts)
    end subroutine visit

    subroutine why_stopped(self, status, why)
        class(fixed), intent(in) :: self
        integer, intent(in) :: status
        character(len=:), allocatable, intent(out) :: why

        call self%explain_status(status, 'Newton''s method finds no balance of forces at the end ' &
            // 'of the step: use a smaller dt, or adaptive steps (rtol)', why)
    end subroutine why_stopped

end module fixed_steps
