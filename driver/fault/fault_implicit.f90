!> Implicit steps for every law, through `friction_update_batch`, which is what finite-element codes
!> call. At the end of a step
!>
!>     T = tau_0 + K (s - V_p t) - eta V
!>
!> holds, with V by BDF2 from the slips at the end, at the start and before, and with the traction T
!> and the state that one update of the law gives for the same displacement: nothing is
!> extrapolated, so that states always fit tractions. BDF2 is of second order and L-stable; so is
!> the whole where the law's update is of second order (the subloading law with scheme =
!> 'exact_rate', laws of slip alone), else of first order. Each step is taken as a whole and in two
!> halves; the halves count, the difference tells the error.
!>
!> The contact springs are no approximation: slip is told from elastic displacement.
module fault_implicit
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use fault_energy, only : power_slip, powers, row_powers
    use fault_problem, only : fault, fault_state
    use fault_start, only : start_contacts
    use fault_stepper, only : stepper
    use friction_mod, only : friction_facts, friction_update_batch, law_facts, &
        statev_dissipation, statev_mu, statev_r, statev_size, statev_slip
    use minres, only : solve_minres
    use processes, only : team
    implicit none
    private

    public :: contact, implicit_steps

    real(dp), parameter :: least_compliance = 1.0e-12_dp   !! left by the spring: round-off

    !> The contact of all cells at a time.
    type :: contact
        real(dp), allocatable :: statev(:, :)      !! cell, place
        real(dp), allocatable :: traction(:)       !! [F/L^2]
        real(dp), allocatable :: slip(:)           !! [L]
        real(dp), allocatable :: last_slip(:)      !! in the last step; the difference of slips
                                                   !! would be round-off in short steps [L]
        real(dp) :: last_dt = huge(1.0_dp)         !! length of that step [T]
    end type contact

    type, extends(stepper) :: implicit_steps
        type(contact) :: now
        real(dp) :: force_scale = 0.0_dp           !! tractions are held against it [F/L^2]
        real(dp) :: resolved = 0.0_dp              !! a step that sees any instability [T]
        real(dp), allocatable :: mode(:)           !! of slip, nearest to instability
        real(dp), allocatable, private :: stiffness(:)   !! alpha_t of each cell [F/L^3]
        real(dp), allocatable, private :: rate(:)
        real(dp), allocatable, private :: motion(:, :), answer(:, :), tangent(:, :, :)
                                                   !! of friction: normal, tangential
        integer, allocatable, private :: status(:)
    contains
        procedure :: start => start_implicit
        procedure :: begin
        procedure :: step
        procedure :: columns
        procedure :: keep
        procedure :: take
        procedure, private :: add_energy, advance, see_instability, update
    end type implicit_steps

contains

    subroutine start_implicit(self, here, together, state, problem)
        class(implicit_steps), intent(inout) :: self
        type(fault), intent(inout) :: here
        type(team), intent(in) :: together
        type(fault_state), intent(inout) :: state
        character(len=:), allocatable, intent(out) :: problem

        allocate (self%now%statev(here%n, statev_size))
        call start_contacts(here, together, state, self%now%statev, problem)
        self%now%traction = state%traction
        self%now%slip = state%slip
        self%now%last_slip = 0.0_dp * state%slip
        self%mode = 0.0_dp * state%slip + 1.0_dp
    end subroutine start_implicit

    pure integer function columns(self) result(n)
        class(implicit_steps), intent(in) :: self

        n = 6 + statev_size
    end function columns

    subroutine keep(self, state, columns, number)
        class(implicit_steps), intent(inout) :: self
        type(fault_state), intent(inout) :: state
        real(dp), intent(inout) :: columns(:, :), number

        columns(:, 1) = state%slip
        columns(:, 2) = state%memory
        columns(:, 3) = state%rate
        columns(:, 4) = state%traction
        columns(:, 5) = self%now%last_slip
        columns(:, 6) = self%mode
        columns(:, 7:) = self%now%statev
        number = self%now%last_dt
    end subroutine keep

    subroutine take(self, state, columns, number)
        class(implicit_steps), intent(inout) :: self
        type(fault_state), intent(inout) :: state
        real(dp), intent(inout) :: columns(:, :), number

        state%slip = columns(:, 1)
        state%memory = columns(:, 2)
        state%rate = columns(:, 3)
        state%traction = columns(:, 4)
        self%now%slip = columns(:, 1)
        self%now%traction = columns(:, 4)
        self%now%last_slip = columns(:, 5)
        self%mode = columns(:, 6)
        self%now%statev = columns(:, 7:)
        self%now%last_dt = number
    end subroutine take

    subroutine begin(self, here, together, state, sound)
        class(implicit_steps), intent(inout) :: self
        type(fault), intent(inout) :: here
        type(team), intent(in) :: together
        type(fault_state), intent(inout) :: state
        logical, intent(out) :: sound
        type(law_facts) :: facts
        integer :: i

        sound = .true.
        allocate (self%motion(here%n, 2), self%answer(here%n, 2), self%tangent(here%n, 2, 2), &
            self%status(here%n), self%stiffness(here%n))
        do i = 1, here%n
            facts = friction_facts(here%props(i, :))
            self%stiffness(i) = facts%alpha_t
        end do
        self%motion(:, 1) = 0.0_dp
        self%rate = state%rate
        self%resolved = 0.5_dp * min(max(here%cohesive_length, here%plan%dz()), here%plan%width) &
            / here%plan%wave_speed   ! where nothing weakens that length has no bound
        self%force_scale = together%largest(maxval(here%pressure))
        if (.not. state%dt > 0.0_dp) state%dt = self%resolved
    end subroutine begin

    !> One step of `state%dt` or less. Not sound: no step is short enough.
    subroutine step(self, here, together, state, sound)
        class(implicit_steps), intent(inout) :: self
        type(fault), intent(inout) :: here
        type(team), intent(in) :: together
        type(fault_state), intent(inout) :: state
        logical, intent(out) :: sound
        real(dp), parameter :: part = 0.01_dp   !! of the normal traction, in which tractions count
        real(dp), parameter :: safety = 0.8_dp, least = 0.2_dp, most = 2.0_dp
        type(contact) :: whole, half, two
        real(dp) :: dt, error, factor, half_rate(here%n)

        do
            dt = min(state%dt, here%plan%t_end - state%time)
            sound = state%time + 0.5_dp * dt > state%time
            if (.not. sound) return
            self%rate = state%rate
            call self%advance(here, together, self%now, state%time, dt, whole, sound)
            if (sound) call self%advance(here, together, self%now, state%time, 0.5_dp * dt, half, &
                sound)
            half_rate = self%rate
            if (sound) call self%advance(here, together, half, state%time + 0.5_dp * dt, &
                0.5_dp * dt, two, sound)
            factor = least
            error = huge(error)
            if (sound) call self%see_instability(here, together, dt, two, sound)
            if (sound) then
                error = together%largest(max(maxval(abs(two%slip - whole%slip) / here%slip_scale), &
                    maxval(abs(two%traction - whole%traction) / (part * here%pressure)))) &
                    / here%plan%rtol
                factor = min(most, max(least, safety * max(error, 1.0e-6_dp)**(-1.0_dp / 3.0_dp)))
            end if
            state%dt = dt * factor
            if (error <= 1.0_dp) exit
            state%rejected = state%rejected + 1
        end do
        call self%add_energy(here, together, dt, half, half_rate, two, state)
        self%now = two
        state%time = state%time + dt
        if (dt >= here%plan%t_end - (state%time - dt)) state%time = here%plan%t_end
        state%steps = state%steps + 1
        state%slip = two%slip
        state%rate = self%rate
        state%traction = two%traction
        state%memory = two%statev(:, statev_r)
        if (here%plan%rate_state) state%memory = logarithms(state%memory)
    end subroutine step

    !> Of whole vectors: what is left over would go to a function that rounds otherwise, and what
    !> that is follows from the number of processes.
    pure function logarithms(numbers) result(logs)
        real(dp), intent(in) :: numbers(:)
        real(dp) :: logs(size(numbers))
        integer, parameter :: widest = 8   !! numbers of a vector instruction
        real(dp) :: filled(size(numbers) + modulo(-size(numbers), widest))

        filled(size(numbers) + 1:) = 1.0_dp
        filled(:size(numbers)) = numbers
        filled = log(filled)
        logs = filled(:size(numbers))
    end function logarithms

    !> Work of a step, from its start and the ends of its halves: what friction dissipates is its
    !> own account, the rest the trapezoidal rule's.
    subroutine add_energy(self, here, together, dt, half, half_rate, two, state)
        class(implicit_steps), intent(in) :: self
        type(fault), intent(in) :: here
        type(team), intent(in) :: together
        real(dp), intent(in) :: dt               !! of the step [T]
        type(contact), intent(in) :: half, two   !! after a half, and after both
        real(dp), intent(in) :: half_rate(:)     !! slip rate after a half [L/T]
        type(fault_state), intent(inout) :: state   !! at the start of the step
        real(dp), dimension(here%part%rows, powers) :: first, middle, last

        call row_powers(here%part%nx, here%part%rows, state%traction + here%damping * state%rate, &
            state%rate, here%damping, first)
        call row_powers(here%part%nx, here%part%rows, half%traction + here%damping * half_rate, &
            half_rate, here%damping, middle)
        call row_powers(here%part%nx, here%part%rows, two%traction + here%damping * self%rate, &
            self%rate, here%damping, last)
        first = 0.25_dp * dt * (first + 2.0_dp * middle + last)
        first(:, power_slip) = 0.0_dp
        call here%add_powers(together, first, state%energy)
        state%energy%dissipated = state%energy%dissipated + here%plan%cell_area() &
            * here%part%row_sums(together, half%statev(:, statev_dissipation) &
            + two%statev(:, statev_dissipation))
    end subroutine add_energy

    !> From a contact to that a time `dt` later, by Newton's method on displacements.
    subroutine advance(self, here, together, from, time, dt, to, sound)
        class(implicit_steps), intent(inout) :: self
        type(fault), intent(inout) :: here
        type(team), intent(in) :: together
        type(contact), intent(in) :: from
        real(dp), intent(in) :: time, dt
        type(contact), intent(inout) :: to
        logical, intent(out) :: sound
        logical :: definite
        integer, parameter :: most = 25
        real(dp), parameter :: mostly_spring = 0.5_dp
        real(dp), dimension(here%n) :: du, residual, compliance, x, elastic
        real(dp) :: ratio, lead, tail, misfit, before, round_off
        integer :: iteration

        ratio = dt / from%last_dt
        lead = (1.0_dp + 2.0_dp * ratio) / (1.0_dp + ratio) / dt   ! BDF2 for steps of two lengths
        tail = ratio**2 / (1.0_dp + ratio) / dt
        du = max(self%rate, 0.0_dp) * dt
        before = huge(before)
        round_off = 4.0_dp * epsilon(before) * (self%force_scale &
            + here%surroundings%self_stiffness * together%largest(maxval(abs(from%slip &
            - here%plan%plate_rate * time))))
        do iteration = 1, most
            call self%update(here, from, du, dt, to, sound)
            if (together%any_of(.not. sound)) exit
            call here%tractions(together, time + dt, to%slip, residual)
            x = lead * to%last_slip - tail * from%last_slip
            residual = residual - here%damping * x - to%traction
            misfit = together%largest(maxval(abs(residual)))
            sound = misfit < 2.0e-7_dp * here%plan%rtol * self%force_scale + round_off
            if (sound) exit
            if (iteration > 5 .and. misfit > 0.9_dp * before) exit
            before = misfit
            compliance = max(1.0_dp - self%tangent(:, 2, 2) / self%stiffness, least_compliance)
            call solve_minres(here, together, self%tangent(:, 2, 2) / compliance + here%damping &
                * lead, residual, 1.0e-3_dp, x, definite)
            call here%surroundings%apply(together, x, elastic)
            where (compliance > mostly_spring)
                du = du + x / compliance
            else where   ! such slip says too little of the spring
                du = du + (residual + elastic - here%damping * lead * x) / self%tangent(:, 2, 2)
            end where
        end do
        sound = .not. together%any_of(.not. sound)
        if (.not. sound) return
        self%rate = x
        to%last_dt = dt
    end subroutine advance

    !> Is a step so long that an instability would be stepped over? Where friction weakens faster
    !> than the surroundings unload, slip grows at a rate of (weakening - unloading)/(2 damping) or
    !> more, which takes hours to months. BDF2 damps what grows within a step of many times that
    !> long: nothing but the matrix, which is then not definite, tells. The mode that is nearest to
    !> it is followed from step to step by inverse iteration. A step in which a cell weakens and
    !> slips far may hold the whole of it, and look stable at both of its ends.
    subroutine see_instability(self, here, together, dt, last, sound)
        class(implicit_steps), intent(inout) :: self
        type(fault), intent(inout) :: here
        type(team), intent(in) :: together
        real(dp), intent(in) :: dt
        type(contact), intent(in) :: last   !! after the step
        logical, intent(out) :: sound       !! the step sees it, or there is none
        real(dp), parameter :: tolerance = 0.1_dp
        real(dp), parameter :: far = 0.3_dp          !! of the slip over which the law evolves
        real(dp), parameter :: weaker = 1.0e-3_dp    !! fall of the friction coefficient
        real(dp), dimension(here%n) :: compliance, x
        real(dp) :: size_of_x
        logical :: passes

        compliance = max(1.0_dp - self%tangent(:, 2, 2) / self%stiffness, least_compliance)
        call solve_minres(here, together, self%tangent(:, 2, 2) / compliance + here%damping &
            * 1.5_dp / dt, self%mode, tolerance, x, sound)
        passes = any(abs(last%slip - self%now%slip) > far * here%slip_scale &
            .and. self%now%statev(:, statev_mu) - last%statev(:, statev_mu) > weaker)
        sound = sound .and. .not. together%any_of(passes) .or. dt <= self%resolved
        size_of_x = sqrt(here%part%row_sums(together, x**2))
        if (size_of_x > 0.0_dp) self%mode = x / size_of_x
    end subroutine see_instability

    !> Friction of all cells for increments of displacement.
    subroutine update(self, here, from, du, dt, to, sound)
        class(implicit_steps), intent(inout) :: self
        type(fault), intent(in) :: here
        type(contact), intent(in) :: from
        real(dp), intent(in) :: du(:), dt
        type(contact), intent(inout) :: to
        logical, intent(out) :: sound

        to%statev = from%statev
        to%statev(:, [statev_slip, statev_dissipation]) = 0.0_dp   ! small increments must not
                                                                   ! drown in their sums
        self%motion(:, 2) = du
        call friction_update_batch(self%motion, dt, here%props, to%statev, self%answer, &
            self%tangent, self%status)
        sound = all(self%status >= 0)
        if (.not. sound) return
        to%traction = self%answer(:, 2)
        to%last_slip = sign(to%statev(:, statev_slip), to%traction)
        to%slip = from%slip + to%last_slip
    end subroutine update

end module fault_implicit
