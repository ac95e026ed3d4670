!> Chooses the steps in time, and repeats those that fail.
module step_control
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use loading_programme, only : programme
    use run_settings, only : settings
    use slider_system, only : slider, slider_state
    use time_integrator, only : newmark, step_report
    implicit none
    private

    public :: stepper

    type :: stepper
        type(slider) :: system
        type(newmark) :: method
        type(programme) :: drive
        real(dp) :: origin = 0.0_dp    !! of the drive: its position at time 0 [L]
        real(dp) :: dt = 0.0_dp        !! fixed step [T]
        real(dp) :: t_end = 0.0_dp     !! [T]
        integer :: passed = 0          !! multiples of the fixed step behind us
        integer :: parts = 1           !! pieces that the fixed step is being taken in
        integer :: rejected = 0        !! steps that were tried in vain
        integer :: iterations = 0, most_iterations = 0   !! of Newton's method, the latter in a step
    contains
        procedure :: begin, take_step
        procedure, private :: try
    end type stepper

    integer, parameter :: most_parts = 2**20

contains

    subroutine begin(self, run, system, start)
        class(stepper), intent(out) :: self
        type(settings), intent(in) :: run
        type(slider), intent(in) :: system
        type(slider_state), intent(in) :: start   !! the state at time 0

        self%system = system
        self%drive = run%drive
        self%origin = start%drive
        self%dt = run%dt
        self%t_end = run%t_end
        self%method = newmark(run%beta, run%gamma, run%tolerance, run%max_iterations)
    end subroutine begin

    !> The next step. With a mass it is the fixed one; without, a step that fails is taken in parts,
    !> because the balance of forces may be followed in small steps where it cannot be found in a
    !> large one.
    subroutine take_step(self, old, new, report, complete)
        class(stepper), intent(inout) :: self
        type(slider_state), intent(in) :: old
        type(slider_state), intent(inout) :: new
        type(step_report), intent(out) :: report
        logical, intent(out) :: complete   !! `new` is at a multiple of the fixed step
        real(dp) :: aim, part

        aim = min((self%passed + 1) * self%dt, self%t_end)
        do
            part = (aim - old%time) / self%parts
            complete = self%parts == 1
            if (complete) then
                call self%try(old, aim, new, report)
            else
                call self%try(old, old%time + part, new, report)
            end if
            if (report%status >= 0 .or. self%system%mass > 0.0_dp) exit
            if (2 * self%parts > most_parts) exit
            self%parts = 2 * self%parts
            self%rejected = self%rejected + 1
        end do
        if (report%status < 0) return
        if (complete) then
            self%passed = self%passed + 1
        else
            self%parts = self%parts - 1
            if (mod(self%parts, 2) == 0) self%parts = self%parts / 2
        end if
    end subroutine take_step

    !> One step from `old` to `time`.
    subroutine try(self, old, time, new, report)
        class(stepper), intent(inout) :: self
        type(slider_state), intent(in) :: old
        real(dp), intent(in) :: time   !! [T]
        type(slider_state), intent(inout) :: new
        type(step_report), intent(out) :: report

        call self%method%step(self%system, self%origin + self%drive%position(time), &
            self%drive%normal_traction(time, self%drive%piece(time)), time - old%time, old, new, &
            report)
        new%time = time
        self%iterations = self%iterations + report%iterations
        self%most_iterations = max(self%most_iterations, report%iterations)
    end subroutine try

end module step_control
