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
    use fault_problem, only : fault, fault_state
    use fault_start, only : start_contacts
    use fault_stepper, only : stepper
    use friction_mod, only : friction_facts, friction_update_batch, law_facts, statev_r, &
        statev_size, statev_slip
    use minres, only : solve_minres
    use processes, only : team
    implicit none
    private

    public :: contact, implicit_steps

    !> The contact of all cells at a time.
    type :: contact
        real(dp), allocatable :: statev(:, :)      !! cell, place
        real(dp), allocatable :: traction(:)       !! [F/L^2]
        real(dp), allocatable :: slip(:)           !! [L]
        real(dp), allocatable :: last_slip(:)      !! in the step before [L]
        real(dp) :: last_dt = huge(1.0_dp)         !! length of that step [T]
    end type contact

    type, extends(stepper) :: implicit_steps
        type(contact) :: now
        real(dp) :: force_scale = 0.0_dp           !! tractions are held against it [F/L^2]
        integer, allocatable, private :: first(:)  !! cells from which on the constants are others
        real(dp), allocatable, private :: props(:, :)    !! of each cell
        real(dp), allocatable, private :: stiffness(:)   !! alpha_t of each cell [F/L^3]
        real(dp), allocatable, private :: tangent(:), rate(:)
    contains
        procedure :: start => start_implicit
        procedure :: begin
        procedure :: step
        procedure :: columns
        procedure :: keep
        procedure :: take
        procedure, private :: advance, update
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
    end subroutine start_implicit

    pure function columns(self) result(n)
        class(implicit_steps), intent(in) :: self
        integer :: n

        n = 5 + statev_size
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
        columns(:, 6:) = self%now%statev
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
        self%now%statev = columns(:, 6:)
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

        self%first = [integer ::]
        do i = 1, here%n
            if (i > 1) then
                if (all(abs(here%props(i, :) - here%props(i - 1, :)) <= 0.0_dp)) cycle
            end if
            self%first = [self%first, i]
        end do
        self%first = [self%first, here%n + 1]
        self%props = here%props
        allocate (self%tangent(here%n), self%rate(here%n), self%stiffness(here%n))
        do i = 1, size(self%first) - 1
            facts = friction_facts(here%props(self%first(i), :))
            self%stiffness(self%first(i):self%first(i + 1) - 1) = facts%alpha_t
        end do
        self%rate = state%rate
        self%force_scale = together%largest(maxval(here%pressure))
        if (.not. state%dt > 0.0_dp) state%dt = 1.0e-9_dp * here%plan%t_end
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
        real(dp) :: dt, error, factor

        do
            dt = min(state%dt, here%plan%t_end - state%time)
            sound = state%time + 0.5_dp * dt > state%time
            if (.not. sound) return
            self%rate = state%rate
            call self%advance(here, together, self%now, state%time, dt, whole, sound)
            if (sound) call self%advance(here, together, self%now, state%time, 0.5_dp * dt, half, &
                sound)
            if (sound) call self%advance(here, together, half, state%time + 0.5_dp * dt, &
                0.5_dp * dt, two, sound)
            factor = least
            error = huge(error)
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
        self%now = two
        state%time = state%time + dt
        if (dt >= here%plan%t_end - (state%time - dt)) state%time = here%plan%t_end
        state%steps = state%steps + 1
        state%slip = two%slip
        state%rate = self%rate
        state%traction = two%traction
        state%memory = two%statev(:, statev_r)
    end subroutine step

    !> From a contact to that a time `dt` later, by Newton's method on displacements.
    subroutine advance(self, here, together, from, time, dt, to, sound)
        class(implicit_steps), intent(inout) :: self
        type(fault), intent(inout) :: here
        type(team), intent(in) :: together
        type(contact), intent(in) :: from
        real(dp), intent(in) :: time, dt
        type(contact), intent(inout) :: to
        logical, intent(out) :: sound
        integer, parameter :: most = 25
        real(dp), parameter :: round_off = 1.0e-12_dp   !! of the compliance left by the spring
        real(dp), dimension(here%n) :: du, residual, compliance, x
        real(dp) :: ratio, lead, tail, misfit, before
        integer :: iteration

        ratio = dt / from%last_dt
        lead = (1.0_dp + 2.0_dp * ratio) / (1.0_dp + ratio) / dt   ! BDF2 for steps of two lengths
        tail = ratio**2 / (1.0_dp + ratio) / dt
        du = max(self%rate, 0.0_dp) * dt
        before = huge(before)
        do iteration = 1, most
            call self%update(from, du, dt, to, sound)
            if (together%any_of(.not. sound)) exit
            call here%tractions(together, time + dt, to%slip, residual)
            x = lead * (to%slip - from%slip) - tail * from%last_slip
            residual = residual - here%damping * x - to%traction
            misfit = together%largest(maxval(abs(residual)))
            sound = misfit < 2.0e-7_dp * here%plan%rtol * self%force_scale
            if (sound) exit
            if (iteration > 5 .and. misfit > 0.9_dp * before) exit
            before = misfit
            compliance = max(1.0_dp - self%tangent / self%stiffness, round_off)
            call solve_minres(here, together, self%tangent / compliance + here%damping * lead, &
                residual, 1.0e-3_dp, x)
            du = du + x / compliance
        end do
        sound = .not. together%any_of(.not. sound)
        if (.not. sound) return
        self%rate = x
        to%last_slip = to%slip - from%slip
        to%last_dt = dt
    end subroutine advance

    !> Friction of all cells for increments of displacement.
    subroutine update(self, from, du, dt, to, sound)
        class(implicit_steps), intent(inout) :: self
        type(contact), intent(in) :: from
        real(dp), intent(in) :: du(:), dt
        type(contact), intent(inout) :: to
        logical, intent(out) :: sound
        integer :: group, first, last

        to%statev = from%statev
        to%statev(:, statev_slip) = 0.0_dp   ! small increments of slip must not drown in its sum
        if (.not. allocated(to%traction)) allocate (to%traction(size(du)), to%slip(size(du)))
        sound = .true.
        do group = 1, size(self%first) - 1
            first = self%first(group)
            last = self%first(group + 1) - 1
            call update_group(self, last - first + 1, first, du, dt, to, sound)
        end do
        if (.not. sound) return
        to%slip = from%slip + sign(to%statev(:, statev_slip), to%traction)
    end subroutine update

    !> Cells that have the same constants.
    subroutine update_group(self, n, first, du, dt, to, sound)
        type(implicit_steps), intent(inout) :: self
        integer, intent(in) :: n, first
        real(dp), intent(in) :: du(:), dt
        type(contact), intent(inout) :: to
        logical, intent(inout) :: sound
        real(dp) :: statev(n, statev_size), motion(n, 2), traction(n, 2), tangent(n, 2, 2)
        integer :: status(n)

        statev = to%statev(first:first + n - 1, :)
        motion(:, 1) = 0.0_dp
        motion(:, 2) = du(first:first + n - 1)
        call friction_update_batch(motion, dt, self%props(first, :), statev, traction, tangent, &
            status)
        sound = sound .and. all(status >= 0)
        if (.not. sound) return
        to%statev(first:first + n - 1, :) = statev
        to%traction(first:first + n - 1) = traction(:, 2)
        self%tangent(first:first + n - 1) = tangent(:, 2, 2)
    end subroutine update_group

end module fault_implicit
