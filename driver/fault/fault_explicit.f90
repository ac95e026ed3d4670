!> Explicit steps for friction that is a function of the slip rate (rate-and-state): the method of
!> Dormand and Prince, of order 5(4), in slip and the logarithm of theta. The slip rate of each cell
!> follows from its traction (`friction_slip_rates`).
!>
!> The error of a step is that of slip, in parts of the slip over which friction evolves, and that
!> of ln(theta), the largest of all cells. A stage that overshoots, so that theta leaves the range
!> of the arithmetic or no slip rate is found, refuses the step.
module fault_explicit
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use fault_problem, only : fault, fault_state
    use fault_start, only : start_rate_state
    use fault_stepper, only : stepper
    use friction_mod, only : friction_slip_rates
    use processes, only : team
    implicit none
    private

    public :: explicit_steps

    integer, parameter :: stages = 7
    real(dp), parameter :: node(stages) = [0.0_dp, 0.2_dp, 0.3_dp, 0.8_dp, 8.0_dp / 9.0_dp, &
        1.0_dp, 1.0_dp]
    real(dp), parameter :: weight(stages - 1, 2:stages) = reshape([ &
        1.0_dp / 5.0_dp, 0.0_dp, 0.0_dp, 0.0_dp, 0.0_dp, 0.0_dp, &
        3.0_dp / 40.0_dp, 9.0_dp / 40.0_dp, 0.0_dp, 0.0_dp, 0.0_dp, 0.0_dp, &
        44.0_dp / 45.0_dp, -56.0_dp / 15.0_dp, 32.0_dp / 9.0_dp, 0.0_dp, 0.0_dp, 0.0_dp, &
        19372.0_dp / 6561.0_dp, -25360.0_dp / 2187.0_dp, 64448.0_dp / 6561.0_dp, &
        -212.0_dp / 729.0_dp, 0.0_dp, 0.0_dp, &
        9017.0_dp / 3168.0_dp, -355.0_dp / 33.0_dp, 46732.0_dp / 5247.0_dp, 49.0_dp / 176.0_dp, &
        -5103.0_dp / 18656.0_dp, 0.0_dp, &
        35.0_dp / 384.0_dp, 0.0_dp, 500.0_dp / 1113.0_dp, 125.0_dp / 192.0_dp, &
        -2187.0_dp / 6784.0_dp, 11.0_dp / 84.0_dp], [stages - 1, stages - 1])
    real(dp), parameter :: error_weight(stages) = [71.0_dp / 57600.0_dp, 0.0_dp, &
        -71.0_dp / 16695.0_dp, 71.0_dp / 1920.0_dp, -17253.0_dp / 339200.0_dp, 22.0_dp / 525.0_dp, &
        -1.0_dp / 40.0_dp]
    integer, parameter :: block = 512   !! cells whose stages stay in cache

    type, extends(stepper) :: explicit_steps
        private
        real(dp), allocatable :: slip_rate(:, :), memory_rate(:, :)   !! cell, stage
        real(dp), allocatable :: slip(:), memory(:)                   !! of a stage
        real(dp), allocatable :: traction(:), theta(:), theta_rate(:)
        integer, allocatable :: status(:)
        integer :: first_stage = 1, last_stage = stages    !! places of the rates: they swap
    contains
        procedure :: start => start_explicit
        procedure :: begin
        procedure :: step
        procedure :: columns
        procedure :: keep
        procedure :: take
        procedure, private :: rates, to_stage, error_of
    end type explicit_steps

contains

    subroutine start_explicit(self, here, together, state, problem)
        class(explicit_steps), intent(inout) :: self
        type(fault), intent(inout) :: here
        type(team), intent(in) :: together
        type(fault_state), intent(inout) :: state
        character(len=:), allocatable, intent(out) :: problem

        problem = ''
        call start_rate_state(here, together, state)
    end subroutine start_explicit

    pure function columns(self) result(n)
        class(explicit_steps), intent(in) :: self
        integer :: n

        n = 2
    end function columns

    subroutine keep(self, state, columns, number)
        class(explicit_steps), intent(inout) :: self
        type(fault_state), intent(inout) :: state
        real(dp), intent(inout) :: columns(:, :), number

        columns(:, 1) = state%slip
        columns(:, 2) = state%memory
        number = 0.0_dp
    end subroutine keep

    subroutine take(self, state, columns, number)
        class(explicit_steps), intent(inout) :: self
        type(fault_state), intent(inout) :: state
        real(dp), intent(inout) :: columns(:, :), number

        state%slip = columns(:, 1)
        state%memory = columns(:, 2)
    end subroutine take

    !> Completes slip rates and tractions.
    subroutine begin(self, here, together, state, sound)
        class(explicit_steps), intent(inout) :: self
        type(fault), intent(inout) :: here
        type(team), intent(in) :: together
        type(fault_state), intent(inout) :: state
        logical, intent(out) :: sound

        allocate (self%slip_rate(here%n, stages), self%memory_rate(here%n, stages), &
            self%slip(here%n), self%memory(here%n), self%traction(here%n), self%theta(here%n), &
            self%theta_rate(here%n), self%status(here%n))
        self%slip = state%slip
        self%memory = state%memory
        call self%rates(here, together, state%time, 1, sound)
        sound = .not. together%any_of(.not. sound)
        if (.not. sound) return
        state%rate = self%slip_rate(:, 1)
        state%traction = self%traction - here%damping * state%rate
        if (state%dt > 0.0_dp) return
        state%dt = 1.0e-2_dp / together%largest(max(maxval(abs(state%rate) / here%slip_scale), &
            maxval(abs(self%memory_rate(:, 1))), tiny(1.0_dp)))
    end subroutine begin

    !> One step of `state%dt` or less, not beyond the end of the run. Not sound: no step is short
    !> enough.
    subroutine step(self, here, together, state, sound)
        class(explicit_steps), intent(inout) :: self
        type(fault), intent(inout) :: here
        type(team), intent(in) :: together
        type(fault_state), intent(inout) :: state
        logical, intent(out) :: sound
        real(dp), parameter :: safety = 0.95_dp, least = 0.2_dp, most = 4.0_dp
        real(dp) :: dt, error
        integer :: swap

        do
            dt = min(state%dt, here%plan%t_end - state%time)
            sound = state%time + dt > state%time
            if (.not. sound) return
            call try_step(self, here, together, state%time, dt, state, error)
            error = together%largest(error) / here%plan%rtol
            error = max(error, 1.0e-8_dp)
            if (error <= 1.0_dp) exit
            state%dt = dt * max(least, safety * error**(-0.2_dp))
            state%rejected = state%rejected + 1
        end do
        ! the error of the step before dampens the choice: fewer steps are refused
        state%dt = dt * min(most, max(least, safety * error**(-0.7_dp / 5.0_dp) &
            * state%error**(0.4_dp / 5.0_dp)))
        state%error = error
        state%time = state%time + dt
        if (dt >= here%plan%t_end - (state%time - dt)) state%time = here%plan%t_end
        state%steps = state%steps + 1
        state%slip = self%slip
        state%memory = self%memory
        state%rate = self%slip_rate(:, self%last_stage)
        state%traction = self%traction - here%damping * state%rate
        swap = self%first_stage   ! the last stage of a step is the first of the next
        self%first_stage = self%last_stage
        self%last_stage = swap
    end subroutine step

    !> All stages; the error is huge where one of them is not sound.
    subroutine try_step(self, here, together, time, dt, state, error)
        class(explicit_steps), intent(inout) :: self
        type(fault), intent(inout) :: here
        type(team), intent(in) :: together
        real(dp), intent(in) :: time, dt
        type(fault_state), intent(in) :: state
        real(dp), intent(out) :: error
        logical :: sound
        integer :: stage

        error = huge(error)
        do stage = 2, stages
            call self%to_stage(stage, dt, state)
            call self%rates(here, together, time + node(stage) * dt, place(self, stage), sound)
            if (together%any_of(.not. sound)) return
        end do
        error = self%error_of(here, dt)
    end subroutine try_step

    !> Where the rates of a stage are.
    pure function place(self, stage)
        class(explicit_steps), intent(in) :: self
        integer, intent(in) :: stage
        integer :: place

        place = stage
        if (stage == 1) place = self%first_stage
        if (stage == stages) place = self%last_stage
    end function place

    !> Slip and memory of a stage.
    subroutine to_stage(self, stage, dt, state)
        class(explicit_steps), intent(inout) :: self
        integer, intent(in) :: stage
        real(dp), intent(in) :: dt
        type(fault_state), intent(in) :: state
        integer :: first, last, j, k
        real(dp) :: part

        do first = 1, size(self%slip), block
            last = min(first + block - 1, size(self%slip))
            self%slip(first:last) = state%slip(first:last)
            self%memory(first:last) = state%memory(first:last)
            do j = 1, stage - 1
                part = dt * weight(j, stage)
                if (.not. abs(part) > 0.0_dp) cycle
                k = place(self, j)
                self%slip(first:last) = self%slip(first:last) + part * self%slip_rate(first:last, k)
                self%memory(first:last) = self%memory(first:last) &
                    + part * self%memory_rate(first:last, k)
            end do
        end do
    end subroutine to_stage

    !> Rates of slip and memory of the stage that is at hand.
    subroutine rates(self, here, together, time, k, sound)
        class(explicit_steps), intent(inout) :: self
        type(fault), intent(inout) :: here
        type(team), intent(in) :: together
        real(dp), intent(in) :: time
        integer, intent(in) :: k        !! place of the rates
        logical, intent(out) :: sound
        real(dp), parameter :: most_memory = 400.0_dp   !! e^that is no time of this world

        call here%tractions(together, time, self%slip, self%traction)
        sound = all(abs(self%memory) < most_memory) .and. all(abs(self%traction) < huge(1.0_dp))
        if (.not. sound) return
        self%theta = exp(self%memory)
        self%theta_rate = abs(self%traction)
        call friction_slip_rates(self%theta_rate, here%pressure, here%damping, here%props, &
            self%theta, self%slip_rate(:, k), self%memory_rate(:, k), self%status)
        sound = all(self%status >= 0)
        if (.not. sound) return
        self%slip_rate(:, k) = sign(self%slip_rate(:, k), self%traction)
        self%memory_rate(:, k) = self%memory_rate(:, k) / self%theta
    end subroutine rates

    function error_of(self, here, dt) result(error)
        class(explicit_steps), intent(in) :: self
        type(fault), intent(in) :: here
        real(dp), intent(in) :: dt
        real(dp) :: error
        real(dp) :: of_slip(block), of_memory(block)
        integer :: first, last, n, j, k

        error = 0.0_dp
        do first = 1, size(self%slip), block
            last = min(first + block - 1, size(self%slip))
            n = last - first + 1
            of_slip(:n) = 0.0_dp
            of_memory(:n) = 0.0_dp
            do j = 1, stages
                if (.not. abs(error_weight(j)) > 0.0_dp) cycle
                k = place(self, j)
                of_slip(:n) = of_slip(:n) + (dt * error_weight(j)) * self%slip_rate(first:last, k)
                of_memory(:n) = of_memory(:n) &
                    + (dt * error_weight(j)) * self%memory_rate(first:last, k)
            end do
            error = max(error, maxval(abs(of_slip(:n)) / here%slip_scale(first:last)), &
                maxval(abs(of_memory(:n))))
        end do
    end function error_of

end module fault_explicit
