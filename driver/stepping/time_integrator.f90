!> One step of Newmark's or the generalised-alpha method, with equilibrium by Newton-Raphson on the
!> consistent tangent (docs/theory.md, section 7).
module time_integrator
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use abstract_integrator, only : most_shown, step_report
    use friction_mod, only : friction_no_convergence, friction_ok, prop_alpha_t
    use chain_solver, only : chain_matrix
    use slider_system, only : ends_fixed_free, ends_free, ends_free_fixed, ends_periodic, &
        friction_forces, slider, slider_state
    implicit none
    private

    public :: generalised_alpha, newmark

    !> Room for a step, kept from one to the next; one number a block.
    type :: workspace
        real(dp), allocatable, dimension(:) :: dx, dx_old, correction, residual, tangent, &
            rest_of_old
        type(chain_matrix) :: matrix
    end type workspace

    !> The balance of forces that a step looks for.
    type :: balance
        real(dp) :: dt = 0.0_dp            !! of the step [T]
        logical :: inertial = .false.
        real(dp) :: inertia = 0.0_dp       !! of mass and damper, as a stiffness [F/L]
        real(dp) :: norm = 0.0_dp          !! largest residual [F]
        real(dp) :: scale = 0.0_dp         !! largest force, by which that is held [F]
        integer :: friction_status = friction_ok
    end type balance

    type :: newmark
        real(dp) :: beta = 0.25_dp, gamma = 0.5_dp   !! mean acceleration
        real(dp) :: tolerance = 1.0e-10_dp   !! of the residual, relative to the largest force
        integer :: max_iterations = 25
        real(dp) :: alpha_m = 0.0_dp, alpha_f = 0.0_dp   !! parts of the old state in the balance
        type(workspace), private :: work
        type(balance), private :: now
    contains
        procedure :: step, set_as
    end type newmark

contains

    !> The generalised-alpha method (Chung and Hulbert, J. Appl. Mech. 60, 1993) of second order
    !> whose spectral radius at high frequencies is `rho`; 1 is Newmark's mean acceleration.
    pure function generalised_alpha(rho, tolerance, max_iterations) result(method)
        real(dp), intent(in) :: rho          !! 0 to 1 [-]
        real(dp), intent(in) :: tolerance    !! of the residual, relative to the largest force
        integer, intent(in) :: max_iterations
        type(newmark) :: method

        method%tolerance = tolerance
        method%max_iterations = max_iterations
        if (rho >= 1.0_dp) return
        method%alpha_m = (2.0_dp * rho - 1.0_dp) / (rho + 1.0_dp)
        method%alpha_f = rho / (rho + 1.0_dp)
        method%gamma = 0.5_dp - method%alpha_m + method%alpha_f
        method%beta = 0.25_dp * (1.0_dp - method%alpha_m + method%alpha_f)**2
    end function generalised_alpha

    !> Takes over the constants of a method, not its workspace.
    pure subroutine set_as(self, other)
        class(newmark), intent(inout) :: self
        type(newmark), intent(in) :: other

        self%beta = other%beta
        self%gamma = other%gamma
        self%tolerance = other%tolerance
        self%max_iterations = other%max_iterations
        self%alpha_m = other%alpha_m
        self%alpha_f = other%alpha_f
    end subroutine set_as

    !> Moves `old` by `dt` to `new`, under the drive position and normal traction at the end.
    !>
    !> Without a mass the displacement follows from the balance of the other forces, and the
    !> velocity from dx = dt ((1 - gamma) v_old + gamma v_new). Where that balance breaks down,
    !> because the force that the block meets falls faster than the spring's, the step fails.
    subroutine step(self, system, drive, normal, dt, old, new, report, guess)
        class(newmark), intent(inout) :: self
        type(slider), intent(in) :: system
        real(dp), intent(in) :: drive            !! position of the drive at the end [L]
        real(dp), intent(in) :: normal           !! normal traction at the end [F/L^2]
        real(dp), intent(in) :: dt               !! 0 cannot be done [T]
        type(slider_state), intent(in) :: old
        type(slider_state), intent(inout) :: new   !! allocated like `old`
        type(step_report), intent(out) :: report
        real(dp), intent(in), optional :: guess(:)   !! of the displacements at the end [L]
        logical :: balanced

        report%iterations = 0
        report%status = friction_no_convergence
        if (dt <= 0.0_dp) return   ! steps so short that time stands still
        self%now = balance(dt=dt, inertial=system%mass > 0.0_dp)
        if (self%now%inertial) then
            self%now%inertia = (1.0_dp - self%alpha_m) * system%mass / (self%beta * dt**2) &
                + (1.0_dp - self%alpha_f) * system%damping * self%gamma / (self%beta * dt)
        else
            self%now%inertia = system%damping / (self%gamma * dt)
        end if
        new%time = old%time + dt
        new%drive = drive
        new%normal = normal
        call make_room(self%work, size(old%x), system)
        if (present(guess)) then
            self%work%dx = guess - old%x
        else
            self%work%dx = dt * old%v + 0.5_dp * dt**2 * old%a
        end if
        call weigh_old_state(self, system, old)
        call iterate(self, system, old, new, report, balanced)
        if (.not. balanced .and. size(old%x) == 1) call search(self, system, old, new, report, &
            balanced)
        if (report%status < 0) return
        report%status = friction_no_convergence
        if (.not. balanced) return
        report%status = self%now%friction_status
        report%scale = self%now%scale
        report%stiffness = system%stiffness + maxval(self%work%tangent) + 4.0_dp * system%coupling
        if (.not. self%now%inertial) call look_for_another_balance(self, system, old, new, report)
    end subroutine step

    !> Newton's method, with steps cut where the residual would rise.
    subroutine iterate(self, system, old, new, report, balanced)
        class(newmark), intent(inout) :: self
        type(slider), intent(in) :: system
        type(slider_state), intent(in) :: old
        type(slider_state), intent(inout) :: new
        type(step_report), intent(inout) :: report   !! status: of the friction routine, if negative
        logical, intent(out) :: balanced
        integer, parameter :: max_halvings = 8, most_of_one = 12   !! iterations of one block, which
                                                                   !! a search serves better then
        real(dp) :: norm_old
        integer :: halving, most
        logical :: solved

        most = self%max_iterations
        if (size(old%x) == 1) most = min(most, most_of_one)
        balanced = .false.
        call evaluate(self, system, old, new, report)
        associate (w => self%work)
            do while (report%status >= 0)
                report%residual(min(report%iterations, most_shown)) = self%now%norm &
                    / max(self%now%scale, tiny(norm_old))
                balanced = self%now%norm <= self%tolerance * self%now%scale
                if (balanced .or. report%iterations == most) return
                call fill(self, system)
                if (.not. self%now%inertial .and. any(w%matrix%diagonal <= 0.0_dp)) return
                w%correction = w%residual
                call w%matrix%solve(w%correction, solved)
                if (.not. solved) return
                report%iterations = report%iterations + 1
                ! too small a correction to change the displacements: as exact as they get
                balanced = all(abs(w%correction) <= epsilon(w%dx) * abs(old%x + w%dx))
                if (balanced) return

                w%dx_old = w%dx
                norm_old = self%now%norm
                do halving = 0, max_halvings
                    w%dx = w%dx_old + w%correction / 2**halving
                    call evaluate(self, system, old, new, report)
                    if (report%status < 0) return
                    if (self%now%norm < norm_old) exit
                end do
            end do
        end associate
    end subroutine iterate

    !> The balance of one block by a bracket: the first one from no displacement on, in the sense in
    !> which the forces pull. It cannot be closer than the residual over the largest stiffness there
    !> is, and there is one, because the drive spring bounds how far friction lets the block go.
    subroutine search(self, system, old, new, report, balanced)
        class(newmark), intent(inout) :: self
        type(slider), intent(in) :: system
        type(slider_state), intent(in) :: old
        type(slider_state), intent(inout) :: new
        type(step_report), intent(inout) :: report
        logical, intent(out) :: balanced
        integer, parameter :: most_doublings = 200, most_bisections = 200
        real(dp) :: ahead, low, high, stride, middle, next
        integer :: i

        low = 0.0_dp
        call residual_at(low)
        if (report%status < 0) return
        ahead = sign(1.0_dp, self%work%residual(1))
        stride = ahead * self%now%norm / (self%now%inertia + (1.0_dp - self%alpha_f) &
            * (system%stiffness + system%area * system%props(prop_alpha_t)))
        do i = 1, most_doublings
            balanced = self%now%norm <= self%tolerance * self%now%scale
            if (balanced) return
            high = low + stride
            call residual_at(high)
            if (report%status < 0) return
            if (ahead * self%work%residual(1) <= 0.0_dp) exit
            low = high
            stride = 2.0_dp * stride
        end do
        middle = high
        do i = 1, most_bisections
            balanced = self%now%norm <= self%tolerance * self%now%scale .or. abs(high - low) &
                <= 2.0_dp * epsilon(low) * abs(old%x(1) + middle)
            if (balanced) return
            if (ahead * self%work%residual(1) > 0.0_dp) then
                low = middle
            else
                high = middle
            end if
            call fill(self, system)
            next = middle + self%work%residual(1) / self%work%matrix%diagonal(1)
            middle = low + 0.5_dp * (high - low)
            if (mod(i, 2) == 0 .and. (next - low) * (next - high) < 0.0_dp) middle = next
            call residual_at(middle)
            if (report%status < 0) return
        end do

    contains

        subroutine residual_at(dx)
            real(dp), intent(in) :: dx   !! increment of displacement [L]

            self%work%dx = dx
            call evaluate(self, system, old, new, report)
            report%iterations = report%iterations + 1
        end subroutine residual_at

    end subroutine search

    !> What the old state adds to the balance of forces.
    subroutine weigh_old_state(self, system, old)
        class(newmark), intent(inout) :: self
        type(slider), intent(in) :: system
        type(slider_state), intent(in) :: old

        self%work%rest_of_old = 0.0_dp
        if (.not. self%now%inertial) return
        if (.not. (abs(self%alpha_f) > 0.0_dp .or. abs(self%alpha_m) > 0.0_dp)) return
        self%work%rest_of_old = self%alpha_f * (old%spring - system%damping * old%v &
            - old%friction) - self%alpha_m * system%mass * old%a
        call system%add_coupling(old%x, self%alpha_f, self%work%rest_of_old)
    end subroutine weigh_old_state

    !> State and force residual at the end of the step for the displacement increments in the
    !> workspace.
    subroutine evaluate(self, system, old, new, report)
        class(newmark), intent(inout) :: self
        type(slider), intent(in) :: system
        type(slider_state), intent(in) :: old
        type(slider_state), intent(inout) :: new
        type(step_report), intent(inout) :: report
        real(dp) :: farthest, scale, norm
        integer :: i

        associate (dx => self%work%dx, residual => self%work%residual)
            call move_to(self, system, old, dx, new)
            call friction_forces(system, old%statev, new%normal, dx, self%now%dt, new%statev, &
                new%friction, self%work%tangent, self%now%friction_status)
            report%status = min(0, self%now%friction_status)
            if (report%status < 0) return
            scale = 0.0_dp
            farthest = 0.0_dp
            do i = 1, size(dx)
                residual(i) = (1.0_dp - self%alpha_f) * (new%spring(i) - system%damping &
                    * new%v(i) - new%friction(i)) - (1.0_dp - self%alpha_m) * system%mass &
                    * new%a(i) + self%work%rest_of_old(i)
                scale = max(scale, abs(new%spring(i)) + abs(system%damping * new%v(i)) &
                    + abs(new%friction(i)) + abs(system%mass * new%a(i)))
                farthest = max(farthest, abs(new%x(i)))
            end do
            ! the forces of stiff springs between neighbours are no better known than by round-off
            scale = max(scale, 8.0_dp * epsilon(scale) * system%coupling * farthest &
                / self%tolerance)
            call system%add_coupling(new%x, 1.0_dp - self%alpha_f, residual)
            norm = 0.0_dp
            do i = 1, size(dx)
                norm = max(norm, abs(residual(i)))
            end do
        end associate
        self%now%scale = scale
        self%now%norm = norm
    end subroutine evaluate

    !> Newmark's formulas, and the drive springs.
    subroutine move_to(self, system, old, dx, new)
        class(newmark), intent(in) :: self
        type(slider), intent(in) :: system
        type(slider_state), intent(in) :: old
        real(dp), intent(in), contiguous :: dx(:)   !! [L]
        type(slider_state), intent(inout) :: new
        integer :: i

        associate (dt => self%now%dt)
            do i = 1, size(dx)
                new%x(i) = old%x(i) + dx(i)
                if (self%now%inertial) then
                    new%a(i) = (dx(i) - dt * old%v(i)) / (self%beta * dt**2) &
                        - (0.5_dp / self%beta - 1.0_dp) * old%a(i)
                    new%v(i) = old%v(i) + dt * ((1.0_dp - self%gamma) * old%a(i) &
                        + self%gamma * new%a(i))
                else
                    new%v(i) = (dx(i) / dt - (1.0_dp - self%gamma) * old%v(i)) / self%gamma
                end if
                new%spring(i) = system%stiffness * (new%drive - new%x(i))
            end do
        end associate
    end subroutine move_to

    !> The derivative of the residual, with the opposite sign.
    subroutine fill(self, system)
        class(newmark), intent(inout) :: self
        type(slider), intent(in) :: system
        real(dp) :: k
        integer :: n

        associate (matrix => self%work%matrix, tangent => self%work%tangent)
            k = (1.0_dp - self%alpha_f) * system%coupling
            matrix%beside = -k
            matrix%diagonal = self%now%inertia + 2.0_dp * k + (1.0_dp - self%alpha_f) &
                * (system%stiffness + tangent)
            n = size(tangent)
            if (system%ends == ends_free .or. system%ends == ends_free_fixed) then
                matrix%diagonal(1) = matrix%diagonal(1) - k
            end if
            if (system%ends == ends_free .or. system%ends == ends_fixed_free) then
                matrix%diagonal(n) = matrix%diagonal(n) - k
            end if
        end associate
    end subroutine fill

    !> The forces must fall all the way from no displacement to the one found: otherwise there is
    !> another balance before it, and no quasi-static motion leads past that.
    subroutine look_for_another_balance(self, system, old, new, report)
        class(newmark), intent(in) :: self
        type(slider), intent(in) :: system
        type(slider_state), intent(in) :: old, new
        type(step_report), intent(inout) :: report
        integer, parameter :: samples = 8
        real(dp) :: statev(size(old%x), size(old%statev, 2)), force(size(old%x)), &
            tangent(size(old%x))
        integer :: i, status

        do i = 1, samples
            call friction_forces(system, old%statev, new%normal, self%work%dx * i / samples, &
                self%now%dt, statev, force, tangent, status)
            if (status < 0) return
            if (any(self%now%inertia + system%stiffness + tangent <= 0.0_dp)) then
                report%status = friction_no_convergence
                return
            end if
        end do
    end subroutine look_for_another_balance

    pure subroutine make_room(work, n, system)
        type(workspace), intent(inout) :: work
        integer, intent(in) :: n                !! blocks
        type(slider), intent(in) :: system

        if (allocated(work%dx)) then
            if (size(work%dx) == n) return
            deallocate (work%dx, work%dx_old, work%correction, work%residual, work%tangent, &
                work%rest_of_old)
        end if
        allocate (work%dx(n), work%dx_old(n), work%correction(n), work%residual(n), &
            work%tangent(n), work%rest_of_old(n))
        call work%matrix%make_room(n, system%ends == ends_periodic .and. n > 1)
    end subroutine make_room

end module time_integrator
