!> A step of a long chain, part by part: the blocks of a part go through all of Newton's iterations
!> while they are in cache, and no part waits for the slowest one.
!>
!> A part is solved together with a margin of its neighbours' blocks, between walls that stand where
!> the blocks beyond are expected. What the expectation is wrong by fades with each block of the
!> margin, because inertia and drive spring hold it; the margin is as wide as it takes to be
!> lost in round-off. Afterwards the parts must agree at their seams, within the tolerance of the
!> residual. If they do not, and where margins would be too wide, the whole chain is solved at once.
module chain_parts
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use abstract_integrator, only : step_report
    use friction_mod, only : statev_size
    use run_settings, only : settings
    use slider_system, only : ends_fixed, ends_fixed_free, ends_free, ends_free_fixed, &
        ends_periodic, slider, slider_state
    use step_sums, only : block_sums, sum_blocks
    use two_way_steps, only : two_way_newmark
    use time_integrator, only : generalised_alpha, newmark
    !$ use omp_lib, only : omp_get_max_threads, omp_get_thread_num
    implicit none
    private

    public :: choose_method, parted_chain

    integer, parameter :: most_at_once = 1024   !! blocks that stay in cache as a whole
    !> Blocks of a part with its margins: three of those that the batch routine takes together. With
    !> four, a power of two, arrays of a part would get into each other's way in cache.
    integer, parameter :: width = 384
    integer, parameter :: widest_margin = 64    !! [blocks]
    integer, parameter :: parts_of_thread = 8   !! that are worth a thread

    !> What a thread works with: a part with its margins as a chain of its own.
    type :: part_workspace
        type(newmark) :: method
        type(slider) :: system
        type(slider_state) :: old, new
        real(dp), allocatable :: guess(:)   !! of its displacements at the end [L]
    end type part_workspace

    !> How the step of a part went.
    type :: part_report
        type(step_report) :: step
        type(block_sums) :: sums         !! over its blocks
        real(dp) :: beyond(2) = 0.0_dp   !! displacements that it found for its neighbours' next
                                         !! blocks [L]
    end type part_report

    !> The step that all parts take.
    type :: chain_step
        real(dp) :: drive, normal, dt   !! at the end [L], [F/L^2]; [T]
        integer :: margin               !! [blocks]
        integer :: parts
    end type chain_step

    !> Of one system: its step is one of Newmark's, taken in parts.
    type, extends(newmark) :: parted_chain
        integer :: split = 0                 !! steps that were taken in parts
        integer, private :: parts = 0        !! of the last one; 0: it was taken at once
        type(part_workspace), allocatable, private :: workspaces(:)
        type(part_report), allocatable, private :: reports(:)
    contains
        procedure :: step, sums
    end type parted_chain

contains

    !> Newmark's or the generalised-alpha method, as a run asks for it and its blocks need it.
    subroutine choose_method(run, method)
        type(settings), intent(in) :: run
        class(newmark), allocatable, intent(out) :: method

        if (run%chain%n_blocks > most_at_once) then
            allocate (parted_chain :: method)
        else if (run%across%free()) then
            allocate (two_way_newmark :: method)
        else
            allocate (newmark :: method)
        end if
        if (run%rho_infinity >= 0.0_dp) then
            call method%set_as(generalised_alpha(run%rho_infinity, run%tolerance, &
                run%max_iterations))
        else
            method%beta = run%beta
            method%gamma = run%gamma
            method%tolerance = run%tolerance
            method%max_iterations = run%max_iterations
        end if
    end subroutine choose_method

    subroutine step(self, system, drive, normal, dt, old, new, report, guess)
        class(parted_chain), intent(inout) :: self
        type(slider), intent(in) :: system
        real(dp), intent(in) :: drive, normal, dt
        type(slider_state), intent(in) :: old
        type(slider_state), intent(inout) :: new
        type(step_report), intent(out) :: report
        real(dp), intent(in), optional :: guess(:)
        type(chain_step) :: this
        logical :: solved
        integer :: iterations

        solved = .false.
        iterations = 0
        self%parts = 0
        this = chain_step(drive, normal, dt, margin=huge(this%margin), parts=0)
        if (size(old%x) > most_at_once) this%margin = margin_of(self, system, dt)
        if (this%margin <= widest_margin) then
            this%parts = (size(old%x) - 1) / (width - 2 * this%margin) + 1
            call solve_parts(self, system, this, old, new, report, guess)
            if (report%status >= 0) solved = seams_hold(self, system, this, new)
            if (solved) then
                self%split = self%split + 1
                self%parts = this%parts
                return
            end if
            iterations = report%iterations
        end if
        call self%newmark%step(system, drive, normal, dt, old, new, report, guess)
        report%iterations = report%iterations + iterations
    end subroutine step

    !> Part after part, so that they do not depend on how many threads there were.
    pure function sums(self, system, old, new) result(over_step)
        class(parted_chain), intent(in) :: self
        type(slider), intent(in) :: system
        type(slider_state), intent(in) :: old, new
        type(block_sums) :: over_step
        integer :: i

        if (self%parts == 0) then
            over_step = self%newmark%sums(system, old, new)
        else
            do i = 1, self%parts
                call over_step%add(self%reports(i)%sums)
            end do
        end if
    end function sums

    !> Blocks after which a displacement at a wall is lost in round-off. From block to block it
    !> falls by r, where k (1/r - 2 + r) = d: k of the coupling, d of all that holds a block in
    !> place. The contact's share in d is left out: it may be anything from its elastic stiffness to
    !> nothing.
    pure function margin_of(method, system, dt) result(blocks)
        class(newmark), intent(in) :: method
        type(slider), intent(in) :: system
        real(dp), intent(in) :: dt   !! [T]
        integer :: blocks
        real(dp), parameter :: lost = 1.0e-15_dp
        integer, parameter :: least = 4
        real(dp) :: y

        blocks = huge(blocks)
        if (system%mass <= 0.0_dp) return
        blocks = least
        if (system%coupling <= 0.0_dp) return
        y = 0.5_dp * (system%stiffness + ((1.0_dp - method%alpha_m) * system%mass / dt &
            + (1.0_dp - method%alpha_f) * system%damping * method%gamma) / (method%beta * dt) &
            / (1.0_dp - method%alpha_f)) / system%coupling
        y = log(1.0_dp + y + sqrt(y * (y + 2.0_dp)))
        if (-log(lost) > y * widest_margin) then
            blocks = huge(blocks)
        else
            blocks = max(least, ceiling(-log(lost) / y))
        end if
    end function margin_of

    !> Every part by itself: the result does not depend on how many threads there are.
    subroutine solve_parts(self, system, this, old, new, report, guess)
        class(parted_chain), intent(inout) :: self
        type(slider), intent(in) :: system
        type(chain_step), intent(in) :: this
        type(slider_state), intent(in) :: old
        type(slider_state), intent(inout) :: new
        type(step_report), intent(out) :: report
        real(dp), intent(in), optional :: guess(:)
        integer :: threads, thread, i

        threads = 1
        !$ threads = max(1, min(omp_get_max_threads(), this%parts / parts_of_thread))
        call prepare_workspaces(self, threads, this%parts, system)
        !$omp parallel do num_threads(threads) schedule(static) private(thread)
        do i = 1, this%parts
            thread = 1
            !$ thread = omp_get_thread_num() + 1
            call solve_part(self%workspaces(thread), i, system, this, old, new, self%reports(i), &
                guess)
        end do
        !$omp end parallel do
        new%time = old%time + this%dt
        new%drive = this%drive
        new%normal = this%normal
        report%status = minval(self%reports(:this%parts)%step%status)
        if (report%status >= 0) report%status = maxval(self%reports(:this%parts)%step%status)
        report%iterations = maxval(self%reports(:this%parts)%step%iterations)
        report%stiffness = maxval(self%reports(:this%parts)%step%stiffness)
        report%scale = maxval(self%reports(:this%parts)%step%scale)
    end subroutine solve_parts

    !> Makes room for every thread and every part.
    subroutine prepare_workspaces(self, threads, parts, system)
        class(parted_chain), intent(inout) :: self
        integer, intent(in) :: threads, parts
        type(slider), intent(in) :: system
        integer :: i

        if (allocated(self%reports)) then
            if (size(self%reports) < parts) deallocate (self%reports)
        end if
        if (.not. allocated(self%reports)) allocate (self%reports(parts))
        if (allocated(self%workspaces)) then
            if (size(self%workspaces) >= threads) return
            deallocate (self%workspaces)
        end if
        allocate (self%workspaces(threads))
        do i = 1, threads
            associate (w => self%workspaces(i))
                call w%method%set_as(self%newmark)
                w%system = slider(system%mass, system%stiffness, system%damping, system%area, &
                    system%props, system%coupling)
                if (allocated(system%load)) allocate (w%system%load(width))
                if (allocated(system%constants)) allocate (w%system%constants(width, &
                    size(system%constants, 2)))
                allocate (w%guess(width))
                call make_room(w%old)
                call make_room(w%new)
            end associate
        end do
    end subroutine prepare_workspaces

    pure subroutine make_room(state)
        type(slider_state), intent(inout) :: state

        allocate (state%x(width), state%v(width), state%a(width), state%spring(width), &
            state%friction(width), state%statev(width, statev_size))
        state%spring = 0.0_dp
        state%friction = 0.0_dp
    end subroutine make_room

    !> Blocks of part `i`, and the first one of its window: the part with its margins, which at the
    !> ends of an open chain lie on one side. On a ring the window may reach over the seam.
    pure subroutine place_part(this, ring, n, i, first, last, start)
        type(chain_step), intent(in) :: this
        logical, intent(in) :: ring
        integer, intent(in) :: n, i
        integer, intent(out) :: first, last, start

        first = 1 + (i - 1) * (width - 2 * this%margin)
        last = min(n, i * (width - 2 * this%margin))
        start = first - this%margin
        if (.not. ring) start = max(1, min(start, n - width + 1))
    end subroutine place_part

    subroutine solve_part(w, i, system, this, old, new, report, guess)
        type(part_workspace), intent(inout) :: w
        integer, intent(in) :: i
        type(slider), intent(in) :: system
        type(chain_step), intent(in) :: this
        type(slider_state), intent(in) :: old
        type(slider_state), intent(inout) :: new   !! gets the blocks of the part
        type(part_report), intent(inout) :: report
        real(dp), intent(in), optional :: guess(:)
        integer :: n, first, last, start, k

        n = size(old%x)
        call place_part(this, system%ends == ends_periodic, n, i, first, last, start)
        call fetch_window(w, system, this, old, start, guess)
        call put_walls(w, system, this, old, start, guess)   ! beside what is in cache now
        call w%method%step(w%system, this%drive, this%normal, this%dt, w%old, w%new, report%step, &
            w%guess)
        if (report%step%status < 0) return
        associate (a => first - start + 1, b => last - start + 1)
            new%x(first:last) = w%new%x(a:b)
            new%v(first:last) = w%new%v(a:b)
            new%a(first:last) = w%new%a(a:b)
            new%spring(first:last) = w%new%spring(a:b)
            new%friction(first:last) = w%new%friction(a:b)
            do k = 1, size(new%statev, 2)
                new%statev(first:last, k) = w%new%statev(a:b, k)
            end do
            call sum_blocks(w%system, w%old, w%new, a, b, report%sums)
            report%beyond = [w%new%x(max(1, a - 1)), w%new%x(min(width, b + 1))]
        end associate
    end subroutine solve_part

    !> Walls where the blocks before and after the window are expected, or at the ends of the chain
    !> what there is.
    subroutine put_walls(w, system, this, old, start, guess)
        type(part_workspace), intent(inout) :: w
        type(slider), intent(in) :: system
        type(chain_step), intent(in) :: this
        type(slider_state), intent(in) :: old
        integer, intent(in) :: start
        real(dp), intent(in), optional :: guess(:)
        integer :: n

        n = size(old%x)
        w%system%ends = ends_fixed
        w%system%walls = [wall(start - 1), wall(start + width)]
        if (system%ends /= ends_free) return
        if (start == 1) w%system%ends = ends_free_fixed
        if (start + width - 1 == n) w%system%ends = ends_fixed_free

    contains

        pure function wall(block) result(x)
            integer, intent(in) :: block   !! beyond an end of an open chain: the wall there
            real(dp) :: x
            integer :: i

            i = block
            if (system%ends == ends_periodic) i = modulo(block - 1, n) + 1
            if (i < 1 .or. i > n) then
                x = system%walls(merge(1, 2, i < 1))
                return
            end if
            if (present(guess)) then
                x = guess(i)
            else
                x = expected(old%x(i), old%v(i), old%a(i), this%dt)
            end if
        end function wall

    end subroutine put_walls

    !> Where a block will be.
    elemental function expected(x, v, a, dt) result(then)
        real(dp), intent(in) :: x, v, a, dt
        real(dp) :: then

        then = x + (dt * v + 0.5_dp * dt**2 * a)
    end function expected

    !> The old state of the window's blocks.
    subroutine fetch_window(w, system, this, old, start, guess)
        type(part_workspace), intent(inout) :: w
        type(slider), intent(in) :: system
        type(chain_step), intent(in) :: this
        type(slider_state), intent(in) :: old
        integer, intent(in) :: start
        real(dp), intent(in), optional :: guess(:)
        integer :: k

        w%old%time = old%time
        w%old%drive = old%drive
        w%old%normal = old%normal
        call fetch(old%x, start, w%old%x)
        call fetch(old%v, start, w%old%v)
        call fetch(old%a, start, w%old%a)
        call fetch(old%spring, start, w%old%spring)
        if (abs(w%method%alpha_f) > 0.0_dp .or. abs(w%method%alpha_m) > 0.0_dp) call fetch( &
            old%friction, start, w%old%friction)   ! Newmark's method does not need it
        do k = 1, size(old%statev, 2)
            call fetch(old%statev(:, k), start, w%old%statev(:, k))
        end do
        if (allocated(system%load)) call fetch(system%load, start, w%system%load)
        if (allocated(system%constants)) then
            do k = 1, size(system%constants, 2)
                call fetch(system%constants(:, k), start, w%system%constants(:, k))
            end do
        end if
        if (present(guess)) then
            call fetch(guess, start, w%guess)
        else
            w%guess = expected(w%old%x, w%old%v, w%old%a, this%dt)
        end if
    end subroutine fetch_window

    pure subroutine fetch(from, start, to)
        real(dp), intent(in), contiguous :: from(:)
        integer, intent(in) :: start   !! less than 1, or too near the end: round the ring
        real(dp), intent(inout), contiguous :: to(:)
        integer :: i, n

        n = size(from)
        if (start >= 1 .and. start + size(to) - 1 <= n) then
            to(:) = from(start:start + size(to) - 1)
        else
            do i = 1, size(to)
                to(i) = from(modulo(start + i - 2, n) + 1)
            end do
        end if
    end subroutine fetch

    !> Have neighbouring parts found the same displacements at their seam, but for a force that is a
    !> tenth of the residual that is tolerated, or but for round-off?
    pure function seams_hold(self, system, this, new) result(yes)
        class(parted_chain), intent(in) :: self
        type(slider), intent(in) :: system
        type(chain_step), intent(in) :: this
        type(slider_state), intent(in) :: new
        logical :: yes
        real(dp), parameter :: share = 0.1_dp
        real(dp) :: apart, largest
        integer :: i, first, last, start, n, before, after

        n = size(new%x)
        yes = .true.
        do i = 1, this%parts
            call place_part(this, system%ends == ends_periodic, n, i, first, last, start)
            before = first - 1
            after = last + 1
            if (system%ends == ends_periodic) then
                before = modulo(before - 1, n) + 1
                after = modulo(after - 1, n) + 1
            end if
            associate (r => self%reports(i))
                apart = 0.0_dp
                if (before >= 1) apart = abs(new%x(before) - r%beyond(1))
                if (after <= n) apart = max(apart, abs(new%x(after) - r%beyond(2)))
                largest = max(abs(new%x(first)), abs(new%x(last)))
                yes = system%coupling * apart <= share * self%tolerance * r%step%scale &
                    .or. apart <= 2.0_dp * epsilon(apart) * largest
            end associate
            if (.not. yes) return
        end do
    end function seams_hold

end module chain_parts
