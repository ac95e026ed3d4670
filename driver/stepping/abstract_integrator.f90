!> Who carries a state on in time. An integrator chooses where its steps end, repeats those that
!> fail, and keeps from one step to the next what it needs.
module abstract_integrator
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use archive_file, only : archive
    use friction_mod, only : friction_message, friction_no_convergence, friction_ok
    use loading_programme, only : programme
    use run_settings, only : settings
    use slider_system, only : slider, slider_state
    use step_sums, only : block_sums, sum_blocks
    implicit none
    private

    public :: integrator, step_report

    !> What a block does that no balance of forces holds.
    character(len=*), parameter, public :: unstable_without_inertia = 'the slider is unstable ' &
        // 'without inertia: friction falls faster than the spring unloads. Give it a mass to ' &
        // 'see the jump, or a stiffer spring'

    integer, parameter, public :: most_shown = 20   !! residuals of a step

    !> How a step went.
    type :: step_report
        integer :: status = friction_ok     !! ok, snap back, or the error that ended the step
        logical :: complete = .true.        !! false: a part of a fixed step, others follow
        integer :: iterations = 0           !! linear systems solved
        real(dp) :: stiffness = 0.0_dp      !! of drive spring and contact at the end, largest [F/L]
        real(dp) :: scale = 0.0_dp          !! the largest force, by which a residual is held [F]
        real(dp) :: residual(0:most_shown)  !! relative, before each iteration and at the end; not
                                            !! set beyond these
    end type step_report

    type, abstract :: integrator
        type(slider) :: system
        type(programme) :: drive
        real(dp) :: origin = 0.0_dp    !! of the drive: its position at time 0 [L]
        real(dp) :: t_end = 0.0_dp     !! [T]
        real(dp) :: dt = 0.0_dp        !! the step, or the next to try [T]
        real(dp) :: dt_min = 0.0_dp, dt_max = 0.0_dp   !! of adaptive steps [T]
        real(dp) :: every = 0.0_dp     !! these end at multiples of this time, unless it is 0 [T]
        integer :: rejected = 0        !! steps that were tried in vain
        integer :: iterations = 0, most_iterations = 0   !! the latter in a step
        logical :: in_rates = .false.  !! these are evaluations of rates, not Newton's iterations
    contains
        procedure(get_ready), deferred :: prepare
        procedure(take_step), deferred :: step
        procedure(keep), deferred :: visit
        procedure(explain), deferred :: why_stopped
        procedure :: finished, sums
        procedure, non_overridable :: take_run, visit_counts, count_iterations, explain_status
    end type integrator

    abstract interface
        !> Before the first step, or before `visit` reads what a checkpoint holds.
        subroutine get_ready(self, run, system, start)
            import :: integrator, settings, slider, slider_state
            implicit none
            class(integrator), intent(inout) :: self
            type(settings), intent(in) :: run
            type(slider), intent(in) :: system
            type(slider_state), intent(in) :: start   !! the state at time 0
        end subroutine get_ready

        !> The next step. `status` of the report is negative if there is none.
        subroutine take_step(self, old, new, report)
            import :: integrator, slider_state, step_report
            implicit none
            class(integrator), intent(inout) :: self
            type(slider_state), intent(inout) :: old     !! a jump of the normal traction changes it
            type(slider_state), intent(inout) :: new     !! allocated like `old`
            type(step_report), intent(out) :: report
        end subroutine take_step

        !> Reads or writes what has to be kept to go on.
        subroutine keep(self, file)
            import :: archive, integrator
            implicit none
            class(integrator), intent(inout) :: self
            type(archive), intent(inout) :: file
        end subroutine keep

        !> What stands behind a step that cannot be taken.
        subroutine explain(self, status, why)
            import :: integrator
            implicit none
            class(integrator), intent(in) :: self
            integer, intent(in) :: status                       !! of the report, < 0
            character(len=:), allocatable, intent(out) :: why
        end subroutine explain
    end interface

contains

    !> What all integrators need of a run.
    subroutine take_run(self, run, system, start)
        class(integrator), intent(inout) :: self
        type(settings), intent(in) :: run
        type(slider), intent(in) :: system
        type(slider_state), intent(in) :: start   !! the state at time 0

        self%system = system
        self%drive = run%drive
        self%origin = start%drive
        self%t_end = run%t_end
        self%dt = run%dt
        self%dt_min = run%dt_min
        self%dt_max = run%dt_max
        ! what swings within a step is not seen at its ends
        if (run%drive%amplitude > 0.0_dp) self%dt_max = min(run%dt_max, 1.0_dp &
            / (16.0_dp * run%drive%frequency))
        self%every = run%every
    end subroutine take_run

    pure function finished(self, state) result(yes)
        class(integrator), intent(in) :: self
        type(slider_state), intent(in) :: state
        logical :: yes

        yes = state%time >= self%t_end
    end function finished

    !> Over the blocks, for the step that was taken last. An integrator may have them already.
    pure subroutine sums(self, old, new, over_step)
        class(integrator), intent(in) :: self
        type(slider_state), intent(in) :: old, new   !! of this step
        type(block_sums), intent(out) :: over_step

        call sum_blocks(self%system, old, new, 1, size(new%x), over_step)
    end subroutine sums

    !> The part of `visit` that all integrators share.
    subroutine visit_counts(self, file)
        class(integrator), intent(inout) :: self
        type(archive), intent(inout) :: file

        call file%visit(self%rejected, self%iterations, self%most_iterations)
    end subroutine visit_counts

    subroutine count_iterations(self, iterations)
        class(integrator), intent(inout) :: self
        integer, intent(in) :: iterations   !! of a step

        self%iterations = self%iterations + iterations
        self%most_iterations = max(self%most_iterations, iterations)
    end subroutine count_iterations

    !> Why a step ends with a status: a message of the library's; without inertia no balance of
    !> forces that could be followed; or else what the integrator says.
    subroutine explain_status(self, status, otherwise, why)
        class(integrator), intent(in) :: self
        integer, intent(in) :: status
        character(len=*), intent(in) :: otherwise
        character(len=:), allocatable, intent(out) :: why

        why = otherwise
        if (self%system%mass <= 0.0_dp) why = unstable_without_inertia
        if (status /= friction_no_convergence) why = trim(friction_message(status))
    end subroutine explain_status

end module abstract_integrator
