!> One step of Newmark's or the generalised-alpha method, with equilibrium by Newton-Raphson on the
!> consistent tangent (docs/theory.md, section 7).
module time_integrator
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use abstract_integrator, only : most_shown, step_report
    use friction_mod, only : friction_no_convergence, friction_ok, prop_alpha_t
    use chain_solver, only : chain_matrix
    use contact_forces, only : friction_forces
    use slider_system, only : ends_fixed_free, ends_free, ends_free_fixed, ends_periodic, &
        slider, slider_state
    use step_sums, only : block_sums, sum_blocks
    implicit none
    private

    public :: generalised_alpha, newmark, round_off_of

    !> Room for a step, kept from one to the next; one number a block.
    type :: workspace
        real(dp), allocatable, dimension(:) :: dx, dx_old, correction, residual, tangent, &
            rest_of_old   !! what the old state adds to the balance of forces
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

    !> Encloses the first root of a block's residual.
    type :: root_bracket
        real(dp) :: sense = 1.0_dp    !! in which it is looked for, 1 or -1
        real(dp) :: low = 0.0_dp      !! the last place before the root [L]
        real(dp) :: high = 0.0_dp     !! a place beyond, if `closed` [L]
        real(dp) :: stride = 0.0_dp   !! to the next place [L]
        logical :: closed = .false., halve = .false.
    contains
        procedure :: narrow
    end type root_bracket

    type :: newmark
        real(dp) :: beta = 0.25_dp, gamma = 0.5_dp   !! mean acceleration
        real(dp) :: tolerance = 1.0e-10_dp   !! of the residual, relative to the largest force
        integer :: max_iterations = 25
        real(dp) :: alpha_m = 0.0_dp, alpha_f = 0.0_dp   !! parts of the old state in the balance
        type(workspace), private :: work
        type(balance), private :: now
    contains
        procedure :: step, sums, set_as, motion
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
        self%work%rest_of_old = 0.0_dp
        if (self%now%inertial .and. max(abs(self%alpha_f), abs(self%alpha_m)) > 0.0_dp) then
            self%work%rest_of_old = self%alpha_f * (old%spring - system%damping * old%v &
                - old%friction) - self%alpha_m * system%mass * old%a
            call system%add_coupling(old%x, self%alpha_f, self%work%rest_of_old)
        end if
        call iterate(self, system, old, new, report, balanced)
        if (.not. balanced) call search(self, system, old, new, report, balanced)
        if (report%status < 0) return
        report%status = friction_no_convergence
        if (.not. balanced) return
        report%status = self%now%friction_status
        report%scale = self%now%scale
        report%stiffness = system%stiffness + maxval(self%work%tangent) + 4.0_dp * system%coupling
        if (.not. self%now%inertial) call look_for_another_balance(self, system, old, new, report)
    end subroutine step

    !> Over the blocks, for the step that was taken last.
    pure function sums(self, system, old, new) result(over_step)
        class(newmark), intent(in) :: self
        type(slider), intent(in) :: system
        type(slider_state), intent(in) :: old, new   !! of this step
        type(block_sums) :: over_step

        call sum_blocks(system, old, new, 1, size(new%x), over_step)
    end function sums

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
        logical :: solved, final

        most = self%max_iterations
        if (size(old%x) == 1) most = min(most, most_of_one)
        most = report%iterations + most
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
                final = all(abs(w%correction) <= round_off_of(w%dx, old%v, old%a, self%now%dt))
                w%dx_old = w%dx
                norm_old = self%now%norm
                do halving = 0, max_halvings
                    w%dx = w%dx_old + w%correction / 2**halving
                    call evaluate(self, system, old, new, report)
                    if (report%status < 0) return
                    if (self%now%norm < norm_old .or. final) exit
                end do
                balanced = final
                if (balanced) return
            end do
        end associate
    end subroutine iterate

    !> To what a step's displacements can be known: by the size of what they are made of, which is
    !> less than where the blocks are by many digits. Velocities and accelerations follow from it.
    elemental function round_off_of(dx, v, a, dt) result(length)
        real(dp), intent(in) :: dx         !! displacement in the step [L]
        real(dp), intent(in) :: v, a       !! before it [L/T, L/T^2]
        real(dp), intent(in) :: dt         !! [T]
        real(dp) :: length                 !! [L]

        length = 4.0_dp * epsilon(dx) * (abs(dx) + dt * (abs(v) + dt * abs(a)))
    end function round_off_of

    !> The balance by brackets, where Newton's method does not settle: blocks that are no neighbours
    !> of one another each go to their own first balance while the others stand still, in turns.
    !>
    !> Where the forces pull all blocks the same way none goes beyond the first balance of the
    !> whole, since a block that advances pulls its neighbours along; and every turn lowers the
    !> potential of the step, for friction in a step depends on the block's own displacement alone.
    !> With stiff couplings the turns approach slowly: Newton's method goes on from where they have
    !> come to.
    subroutine search(self, system, old, new, report, balanced)
        class(newmark), intent(inout) :: self
        type(slider), intent(in) :: system
        type(slider_state), intent(in) :: old
        type(slider_state), intent(inout) :: new
        type(step_report), intent(inout) :: report
        logical, intent(out) :: balanced
        integer, parameter :: most_rounds = 100, turns_in_round = 4
        real(dp) :: reached(size(old%x))
        integer :: round, turn, n, pairs

        n = size(old%x)
        pairs = n - mod(n, 2)   ! in a ring the last of an odd number is a neighbour of the first
        self%work%dx = 0.0_dp
        call evaluate(self, system, old, new, report)
        do round = 1, most_rounds
            do turn = 1, turns_in_round
                call bracket(self, system, old, new, report, 1, pairs, balanced)
                call bracket(self, system, old, new, report, 2, pairs, balanced)
                call bracket(self, system, old, new, report, pairs + 1, n, balanced)
                if (report%status < 0 .or. n == 1) return
            end do
            reached = self%work%dx
            call iterate(self, system, old, new, report, balanced)
            if (balanced) return
            self%work%dx = reached   ! wherever that has led, be it out of range
            call evaluate(self, system, old, new, report)
        end do
    end subroutine search

    !> Takes every second block from `first` to `last` to its own balance, the first one in the
    !> sense in which the forces pull it. It cannot be closer than the residual over the largest
    !> stiffness there is, and there is one, because the springs bound how far friction lets a block
    !> go.
    subroutine bracket(self, system, old, new, report, first, last, balanced)
        class(newmark), intent(inout) :: self
        type(slider), intent(in) :: system
        type(slider_state), intent(in) :: old
        type(slider_state), intent(inout) :: new   !! at the displacements in the workspace
        type(step_report), intent(inout) :: report
        integer, intent(in) :: first, last
        logical, intent(out) :: balanced           !! each of these blocks
        integer, parameter :: most_evaluations = 400
        type(root_bracket) :: brackets(first:last)
        real(dp) :: stiffest   !! contact spring [F/L^3]
        logical :: settled
        integer :: i, evaluation

        balanced = .true.
        if (report%status < 0) return
        stiffest = system%props(prop_alpha_t)
        if (allocated(system%constants)) stiffest = maxval(system%constants(:, prop_alpha_t))
        associate (w => self%work)
            call fill(self, system)
            do i = first, last, 2
                brackets(i) = root_bracket(sense=sign(1.0_dp, w%residual(i)), low=w%dx(i), &
                    stride=w%residual(i) / (w%matrix%diagonal(i) + (1.0_dp - self%alpha_f) &
                    * (system%area * stiffest - w%tangent(i))))
            end do
            do evaluation = 1, most_evaluations
                balanced = .true.
                do i = first, last, 2
                    if (abs(w%residual(i)) <= 0.5_dp * self%tolerance * self%now%scale) cycle
                    call brackets(i)%narrow(w%residual(i), w%matrix%diagonal(i), &
                        round_off_of(w%dx(i), old%v(i), old%a(i), self%now%dt), w%dx(i), settled)
                    balanced = balanced .and. settled
                end do
                if (balanced) return
                call evaluate(self, system, old, new, report)
                report%iterations = report%iterations + 1
                if (report%status < 0) return
                call fill(self, system)
            end do
        end associate
    end subroutine bracket

    !> The next place to look at, from the residual and its slope at the one before: twice as far
    !> each time until the force has turned, then by Newton's method and halves in turns.
    pure subroutine narrow(self, residual, slope, finest, place, settled)
        class(root_bracket), intent(inout) :: self
        real(dp), intent(in) :: residual      !! at `place` [F]
        real(dp), intent(in) :: slope         !! by which it falls there [F/L]
        real(dp), intent(in) :: finest        !! round-off of `place` [L]
        real(dp), intent(inout) :: place      !! [L]
        logical, intent(out) :: settled       !! the bracket is as narrow as round-off lets it be
        real(dp) :: newton

        settled = .false.
        if (self%sense * residual > 0.0_dp) then
            self%low = place
        else
            self%high = place
            self%closed = .true.
        end if
        if (.not. self%closed) then
            place = self%low + self%stride
            self%stride = 2.0_dp * self%stride
            return
        end if
        settled = abs(self%high - self%low) <= finest
        if (settled) return
        newton = place + residual / slope
        self%halve = .not. self%halve
        place = self%low + 0.5_dp * (self%high - self%low)
        if (self%halve) return
        if ((newton - self%low) * (newton - self%high) < 0.0_dp) place = newton
    end subroutine narrow

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
            do i = 1, size(dx)
                new%x(i) = old%x(i) + dx(i)
                if (self%now%inertial) then
                    call motion(self, self%now%dt, dx(i), old%v(i), old%a(i), new%v(i), new%a(i))
                else
                    new%v(i) = (dx(i) / self%now%dt - (1.0_dp - self%gamma) * old%v(i)) / self%gamma
                end if
                new%spring(i) = system%stiffness * (new%drive - new%x(i))
            end do
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
            ! the forces of springs are no better known than the places of their ends
            scale = max(scale, 8.0_dp * epsilon(scale) * (system%stiffness + system%coupling) &
                * farthest / self%tolerance)
            call system%add_coupling(new%x, 1.0_dp - self%alpha_f, residual)
            norm = 0.0_dp
            do i = 1, size(dx)
                norm = max(norm, abs(residual(i)))
            end do
        end associate
        self%now%scale = scale
        self%now%norm = norm
    end subroutine evaluate

    !> Newmark's formulas.
    pure subroutine motion(self, dt, moved, old_v, old_a, v, a)
        class(newmark), intent(in) :: self
        real(dp), intent(in) :: dt, moved, old_v, old_a
        real(dp), intent(out) :: v, a

        a = (moved - dt * old_v) / (self%beta * dt**2) - (0.5_dp / self%beta - 1.0_dp) * old_a
        v = old_v + dt * ((1.0_dp - self%gamma) * old_a + self%gamma * a)
    end subroutine motion

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
