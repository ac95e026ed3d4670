!> Explicit steps for friction that is a function of the slip rate (rate-and-state): the method of
!> Dormand and Prince, of order 5(4), in slip and the logarithm of theta. The slip rate of each cell
!> follows from its traction (`friction_slip_rates`).
!>
!> The error of a step is that of slip, in parts of the slip over which friction evolves, and that
!> of ln(theta), the largest of all cells. A stage that overshoots, so that theta leaves the range
!> of the arithmetic or no slip rate is found, refuses the step.
module fault_explicit
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use fault_energy, only : powers, row_powers
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
    real(dp), parameter :: step_weight(stages) = [weight(:, stages), 0.0_dp]
    real(dp), parameter :: error_weight(stages) = [71.0_dp / 57600.0_dp, 0.0_dp, &
        -71.0_dp / 16695.0_dp, 71.0_dp / 1920.0_dp, -17253.0_dp / 339200.0_dp, 22.0_dp / 525.0_dp, &
        -1.0_dp / 40.0_dp]
    integer, parameter :: block_size = 512   !! cells whose rates stay in cache
    integer, parameter :: widest = 8         !! numbers of a vector instruction

    !> Cells that are treated one after the other, all of an evaluation at once.
    type :: cell_block
        integer :: first = 1, last = 0
        integer :: set = 0    !! of constants
    end type cell_block

    !> Constants of friction of a block's cells; blocks with the same ones share them.
    type :: constant_set
        real(dp), allocatable :: props(:, :)    !! cell of the block, constant
    end type constant_set

    type, extends(stepper) :: explicit_steps
        private
        type(cell_block), allocatable :: blocks(:)
        type(constant_set), allocatable :: sets(:)
        real(dp), allocatable :: slip_rate(:, :), memory_rate(:, :)   !! cell, stage
        real(dp), allocatable :: slip(:), deficit(:), memory(:)       !! of a stage
        real(dp), allocatable :: traction(:)   !! of a stage, elastic
        real(dp), allocatable :: power(:, :)         !! row, power: of the last stage
        real(dp), allocatable :: first_power(:, :)   !! of the first stage
        real(dp), allocatable :: work(:, :)          !! of the step
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

        call start_rate_state(here, together, state, problem)
    end subroutine start_explicit

    pure integer function columns(self) result(n)
        class(explicit_steps), intent(in) :: self

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

        integer :: i

        call divide(self, here)
        allocate (self%slip_rate(here%n, stages), self%memory_rate(here%n, stages), &
            self%slip(here%n), self%deficit(here%n), self%memory(here%n), self%traction(here%n))
        allocate (self%power(here%part%rows, powers), self%first_power(here%part%rows, powers), &
            self%work(here%part%rows, powers))
        self%memory = state%memory
        self%deficit = state%slip - here%plan%plate_rate * state%time
        call here%surroundings%apply(together, self%deficit, self%traction)
        sound = .true.
        do i = 1, size(self%blocks)
            call self%rates(here, self%blocks(i), 1, sound)
        end do
        sound = .not. together%any_of(.not. sound)
        if (.not. sound) return
        call settle(self, here, 1, state)
        call row_powers(here%part%nx, here%part%rows, self%traction, self%slip_rate(:, 1), &
            here%damping, self%first_power)
        if (state%dt > 0.0_dp) return
        state%dt = 1.0e-2_dp / together%largest(max(maxval(abs(state%rate) / here%slip_scale), &
            maxval(abs(self%memory_rate(:, 1))), tiny(1.0_dp)))
    end subroutine begin

    !> Blocks of cells. The constants move there: a block's must be an array by themselves.
    subroutine divide(self, here)
        type(explicit_steps), intent(inout) :: self
        type(fault), intent(inout) :: here
        type(constant_set), allocatable :: sets(:)
        integer :: i, used
        logical :: same

        allocate (self%blocks((here%n + block_size - 1) / block_size))
        allocate (sets(size(self%blocks)))
        used = 0
        do i = 1, size(self%blocks)
            associate (block => self%blocks(i))
                block%first = (i - 1) * block_size + 1
                block%last = min(i * block_size, here%n)
                same = used > 0 .and. block%last - block%first + 1 == block_size
                if (same) same = all(abs(here%props(block%first:block%last, :) &
                    - sets(used)%props) <= 0.0_dp)
                if (.not. same) then
                    used = used + 1
                    sets(used)%props = here%props(block%first:block%last, :)
                end if
                block%set = used
            end associate
        end do
        allocate (self%sets(used))
        do i = 1, used
            call move_alloc(sets(i)%props, self%sets(i)%props)
        end do
        deallocate (here%props)
    end subroutine divide

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
        call swap_arrays(state%slip, self%slip)
        call swap_arrays(state%memory, self%memory)
        call settle(self, here, self%last_stage, state)
        self%first_power = self%power
        call here%add_powers(together, self%work, state%energy)
        swap = self%first_stage   ! the last stage of a step is the first of the next
        self%first_stage = self%last_stage
        self%last_stage = swap
    end subroutine step

    pure subroutine swap_arrays(a, b)
        real(dp), allocatable, intent(inout) :: a(:), b(:)
        real(dp), allocatable :: kept(:)

        call move_alloc(a, kept)
        call move_alloc(b, a)
        call move_alloc(kept, b)
    end subroutine swap_arrays

    !> Slip rates and tractions of the state, from the evaluation that was the last.
    subroutine settle(self, here, k, state)
        type(explicit_steps), intent(in) :: self
        type(fault), intent(in) :: here
        integer, intent(in) :: k   !! place of the rates
        type(fault_state), intent(inout) :: state

        state%rate = self%slip_rate(:, k)
        state%traction = self%traction - here%damping * state%rate
    end subroutine settle

    !> All stages. A stage that is not sound counts as a huge error at the end: processes that are
    !> well go on with those that are not, and need not ask each other in each stage.
    subroutine try_step(self, here, together, time, dt, state, error)
        class(explicit_steps), intent(inout) :: self
        type(fault), intent(inout) :: here
        type(team), intent(in) :: together
        real(dp), intent(in) :: time, dt
        type(fault_state), intent(in) :: state
        real(dp), intent(out) :: error
        real(dp), parameter :: refused = 1.0e30_dp
        logical :: sound
        integer :: stage, i

        sound = .true.
        error = 0.0_dp
        do i = 1, size(self%blocks)
            call self%to_stage(here, self%blocks(i), 2, time, dt, state)
        end do
        self%work = dt * step_weight(1) * self%first_power
        do stage = 2, stages
            call here%surroundings%apply(together, self%deficit, self%traction)
            do i = 1, size(self%blocks)
                call self%rates(here, self%blocks(i), place(self, stage), sound)
                if (stage < stages) then
                    call self%to_stage(here, self%blocks(i), stage + 1, time, dt, state)
                else
                    call self%error_of(here, self%blocks(i), dt, error)
                end if
            end do
            if (stage == 2) cycle   ! of no weight
            call row_powers(here%part%nx, here%part%rows, self%traction, &
                self%slip_rate(:, place(self, stage)), here%damping, self%power)
            self%work = self%work + dt * step_weight(stage) * self%power
        end do
        if (.not. sound) error = refused
    end subroutine try_step

    !> Where the rates of a stage are.
    pure integer function place(self, stage)
        class(explicit_steps), intent(in) :: self
        integer, intent(in) :: stage

        place = stage
        if (stage == 1) place = self%first_stage
        if (stage == stages) place = self%last_stage
    end function place

    !> Slip, its deficit and memory of a stage, in a block.
    subroutine to_stage(self, here, block, stage, time, dt, state)
        class(explicit_steps), intent(inout) :: self
        type(fault), intent(in) :: here
        type(cell_block), intent(in) :: block
        integer, intent(in) :: stage
        real(dp), intent(in) :: time, dt
        type(fault_state), intent(in) :: state
        integer, allocatable :: before(:)
        integer :: j

        before = pack([(j, j = 1, stage - 1)], abs(weight(:stage - 1, stage)) > 0.0_dp)
        associate (first => block%first, last => block%last, k => [(place(self, before(j)), &
            j = 1, size(before))])
            call add_rates(first, k, dt * weight(before, stage), self%slip_rate, &
                state%slip(first:last), self%slip(first:last))
            call add_rates(first, k, dt * weight(before, stage), self%memory_rate, &
                state%memory(first:last), self%memory(first:last))
            self%deficit(first:last) = self%slip(first:last) - here%plan%plate_rate * (time &
                + node(stage) * dt)
        end associate
    end subroutine to_stage

    !> y = x + the sum of parts of rates, two at a time.
    pure subroutine add_rates(first, places, parts, rates, x, y)
        integer, intent(in) :: first, places(:)             !! cell of x(1); stages of the rates
        real(dp), intent(in) :: parts(:)
        real(dp), intent(in), contiguous :: rates(:, :)     !! cell, stage
        real(dp), intent(in), contiguous :: x(:)
        real(dp), intent(inout), contiguous :: y(:)
        integer :: before, i, j

        before = first - 1
        if (modulo(size(places), 2) == 1) then
            do i = 1, size(x)
                y(i) = x(i) + parts(1) * rates(before + i, places(1))
            end do
        else
            do i = 1, size(x)
                y(i) = x(i) + (parts(1) * rates(before + i, places(1)) + parts(2) &
                    * rates(before + i, places(2)))
            end do
        end if
        do j = 2 + modulo(size(places) + 1, 2), size(places), 2
            do i = 1, size(x)
                y(i) = y(i) + (parts(j) * rates(before + i, places(j)) + parts(j + 1) &
                    * rates(before + i, places(j + 1)))
            end do
        end do
    end subroutine add_rates

    !> Rates of slip and memory of the stage that is at hand, in a block. Where a block is not
    !> sound, its rates are 0.
    subroutine rates(self, here, block, k, sound)
        class(explicit_steps), intent(inout) :: self
        type(fault), intent(in) :: here
        type(cell_block), intent(in) :: block
        integer, intent(in) :: k           !! place of the rates
        logical, intent(inout) :: sound
        real(dp), parameter :: most_memory = 400.0_dp   !! e^that is no time of this world
        real(dp), dimension(block%last - block%first + 1) :: load, theta_rate
        real(dp) :: theta(block_size)
        integer :: status(block%last - block%first + 1), n, filled

        associate (first => block%first, last => block%last)
            self%traction(first:last) = self%traction(first:last) + here%prestress(first:last)
            load = self%traction(first:last)
            if (count(abs(self%memory(first:last)) < most_memory .and. abs(load) < huge(load)) &
                < size(load)) sound = .false.
            if (sound) then
                ! whole vectors: what is left over would go to a function that rounds otherwise
                n = last - first + 1
                filled = n + modulo(-n, widest)
                theta(n + 1:filled) = 0.0_dp
                theta(:n) = self%memory(first:last)
                theta(:filled) = exp(theta(:filled))
                call friction_slip_rates(abs(load), here%pressure(first:last), here%damping, &
                    self%sets(block%set)%props, theta(:n), self%slip_rate(first:last, k), &
                    theta_rate, status)
                if (minval(status) < 0) sound = .false.
            end if
            if (sound) then
                self%slip_rate(first:last, k) = sign(self%slip_rate(first:last, k), load)
                self%memory_rate(first:last, k) = theta_rate / theta(:n)
            else
                self%slip_rate(first:last, k) = 0.0_dp
                self%memory_rate(first:last, k) = 0.0_dp
            end if
        end associate
    end subroutine rates

    !> The largest error of slip and memory in a block, if it is larger than `error`.
    subroutine error_of(self, here, block, dt, error)
        class(explicit_steps), intent(in) :: self
        type(fault), intent(in) :: here
        type(cell_block), intent(in) :: block
        real(dp), intent(in) :: dt
        real(dp), intent(inout) :: error
        integer, parameter :: counted(6) = [1, 3, 4, 5, 6, 7]
        real(dp), dimension(block%last - block%first + 1) :: of_slip, of_memory, nothing
        integer :: places(size(counted)), j

        places = [(place(self, counted(j)), j = 1, size(counted))]
        nothing = 0.0_dp
        associate (first => block%first, last => block%last)
            call add_rates(first, places, dt * error_weight(counted), self%slip_rate, nothing, &
                of_slip)
            call add_rates(first, places, dt * error_weight(counted), self%memory_rate, nothing, &
                of_memory)
            error = max(error, maxval(abs(of_slip) / here%slip_scale(first:last)), &
                maxval(abs(of_memory)))
        end associate
    end subroutine error_of

end module fault_explicit
