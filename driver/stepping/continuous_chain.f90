!> Adaptive steps of a chain in continuous time by Rodas4, under rate-and-state friction and its
!> relatives: what the law remembers changes so fast in slip that methods of low order take most of
!> their steps for it. The contacts of all blocks open and close together; between, they slide from
!> first to last, if only by a little, or as a shear cap says.
module continuous_chain
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use abstract_integrator, only : step_report
    use archive_file, only : archive
    use block_motion, only : fill_block, moving_block, set_growing_weights, set_up, unknowns_of
    use block_steps, only : implicit_rates, shortest
    use chain_rates, only : chain_equations
    use continuous_steps, only : continuous, creep_weight, lost
    use friction_mod, only : friction_bad_state, friction_facts, friction_no_convergence, &
        friction_no_rate, law_facts, statev_u_n
    use phase_changes, only : change_phase, first_root, root_bracket, switch_values, switches
    use law_facts, only : cohesion_of_each
    use rosenbrock, only : chain_stepper
    use run_settings, only : settings
    use slider_rates, only : along, controlled, damped, drive_work, elastic, memory, &
        most_logarithm, phase_open, phase_slide, unknowns
    use slider_system, only : ends_periodic, slider, slider_state
    use step_ends, only : end_of_step, find_opening, vanishing_part
    use sudden_changes, only : creep_at_once, open_or_touch, press
    use trial_step, only : wild, wild_error
    implicit none
    private

    public :: chain_in_continuous_time, continuous_blocks

    type, extends(continuous) :: continuous_blocks
        type(chain_equations) :: chain
        type(chain_stepper) :: rodas
        !> Unknowns and their rates, before and after a step; one column a block.
        real(dp), allocatable, dimension(:, :) :: now, now_rates, then, then_rates
        real(dp), allocatable :: elastic_sizes(:)   !! natural ones, under the largest load
        logical :: capped = .false.                 !! tractions of blocks, where they reach a cap
    contains
        procedure :: prepare, step, visit
        procedure, private :: take_normal, open_below, settle_all, set_all_weights, try, &
            end_at_cap, find_first, part, put_back, finish, jumps
    end type continuous_blocks

contains

    !> Is a run one of a chain that this integrator takes?
    function chain_in_continuous_time(run) result(yes)
        type(settings), intent(in) :: run
        logical :: yes
        type(law_facts) :: law

        law = friction_facts(run%props)
        yes = law%traits%stiff .and. .not. run%newmark
        if (.not. yes .or. minval(run%drive%normal) - run%drive%amplitude &
            > run%drive%largest_normal() * vanishing_part(.true., run%rtol)) return
        yes = .not. law%cohesion > 0.0_dp
        if (allocated(run%chain%constants)) yes = .not. any(cohesion_of_each( &
            run%chain%constants) > 0.0_dp)
    end function chain_in_continuous_time

    subroutine prepare(self, run, system, start)
        class(continuous_blocks), intent(inout) :: self
        type(settings), intent(in) :: run
        type(slider), intent(in) :: system
        type(slider_state), intent(in) :: start
        type(law_facts) :: law
        real(dp) :: load
        integer :: i, n, different

        call self%continuous%prepare(run, system, start)
        n = size(start%x)
        allocate (self%now(unknowns, n), self%now_rates(unknowns, n), self%then(unknowns, n), &
            self%then_rates(unknowns, n))
        self%block%known = .false.
        call self%rodas%make_room(n, system%ends == ends_periodic)
        self%chain%system = system
        self%chain%drive = run%drive
        self%chain%origin = self%origin
        law = friction_facts(run%props)
        different = merge(n, 1, allocated(system%load) .or. allocated(system%constants) &
            .or. law%shear_cap < huge(load))
        allocate (self%chain%blocks(different))
        do i = 1, n
            associate (block => self%chain%blocks(min(i, different)))
                load = 1.0_dp
                if (allocated(system%load)) load = system%load(i)
                if (i <= different) then
                    call set_up(run, system%props_of(i), self%largest * load, block, &
                        self%rodas%natural(:, i))
                    block%phase = phase_slide
                    self%capped = self%capped .or. block%surface%tau_max < huge(load)
                else
                    self%rodas%natural(:, i) = self%rodas%natural(:, 1)
                end if
                self%now(:, i) = unknowns_of(block, start, i)
            end associate
        end do
        self%rodas%weights = 1.0_dp / (self%rtol * self%rodas%natural)
        self%elastic_sizes = self%rodas%natural(elastic, :)
        self%now(drive_work, 1) = start%drive_work
        self%now(damped, 1) = start%damped
    end subroutine prepare

    subroutine step(self, old, new, report)
        class(continuous_blocks), intent(inout) :: self
        type(slider_state), intent(inout) :: old
        type(slider_state), intent(inout) :: new
        type(step_report), intent(out) :: report
        real(dp) :: end, wanted, h, error, error_in_whole, before, opening
        integer :: piece
        logical :: failed, again

        piece = self%drive%piece(old%time)
        if (piece /= self%chain%piece) then
            call self%chain%enter(piece)
            self%block%known = .false.
        end if
        if (self%reloaded) call self%take_normal(old)
        call self%take_limit(old%time)
        if (self%capped) call self%settle_all(old%time)
        if (.not. self%block%known) call self%chain%rates(old%time, self%now, self%now_rates, &
            failed)
        call self%set_all_weights(self%drive%normal_traction(old%time, piece))
        again = .false.
        do
            wanted = min(self%dt, self%dt_max)
            end = end_of_step(old%time, wanted, self%limit)
            if (self%reloaded) then
                call find_opening(self%drive, piece, self%open_below(), self%chain%blocks(1)%phase &
                    == phase_open, old%time, end, before, opening)
                end = min(end, opening)
            end if
            h = end - old%time
            call self%try(old%time, end, error)
            error_in_whole = error
            if (error <= 1.0_dp .and. self%capped) call self%end_at_cap(old%time, end, error)
            if (error <= 1.0_dp) exit
            again = .true.
            if (.not. self%can_shorten(old%time, end - old%time, error)) then
                report%status = friction_no_convergence
                if (self%jumps(old%time, error)) report%status = friction_no_rate
                return
            end if
        end do
        call self%lengthen(h, error_in_whole, wanted, again)
        if (any(abs(self%then(memory, :)) > most_logarithm)) report%status = friction_bad_state
        call self%finish(end, old, new)
    end subroutine step

    !> Takes the blocks to the normal traction that holds from now on: it may have jumped, all
    !> contacts may open or close.
    subroutine take_normal(self, old)
        class(continuous_blocks), intent(inout) :: self
        type(slider_state), intent(inout) :: old
        type(moving_block) :: block
        real(dp) :: normal, after
        logical :: closed, was_closed
        integer :: i

        normal = self%drive%normal_traction(old%time, self%chain%piece)
        closed = normal > self%open_below()
        was_closed = self%chain%blocks(1)%phase /= phase_open
        if (closed .eqv. was_closed) then
            if (.not. closed .or. abs(normal - old%normal) <= 1.0e-14_dp * normal) return
        end if
        do i = 1, size(self%now, 2)
            call self%part(i, block)
            after = block%equations%drive%normal_traction(old%time, 1)
            block%equations%phase = merge(phase_slide, phase_open, closed)
            if (closed .and. was_closed) then
                call press(block, after * old%normal / normal, after, lost * old%time)
                call creep_at_once(block, old%time, lost * old%time)
            else
                call open_or_touch(block, after, .false.)
            end if
            call self%put_back(i, block)
        end do
        old%normal = normal
        old%load = normal
    end subroutine take_normal

    !> Normal traction that counts as none in the piece: one that does not vary is taken as it is.
    pure real(dp) function open_below(self)
        class(continuous_blocks), intent(in) :: self

        open_below = self%block%equations%open_below
        if (self%chain%blocks(1)%steady) open_below = min(0.0_dp, open_below)
    end function open_below

    !> One block by itself.
    subroutine part(self, i, block)
        class(continuous_blocks), intent(in) :: self
        integer, intent(in) :: i
        type(moving_block), intent(inout) :: block

        block%equations = self%chain%blocks(min(i, size(self%chain%blocks)))
        block%y = self%now(:, i)
        block%first = self%now_rates(:, i)
    end subroutine part

    !> Where it is now, and in which phase.
    subroutine put_back(self, i, block)
        class(continuous_blocks), intent(inout) :: self
        integer, intent(in) :: i
        type(moving_block), intent(in) :: block

        self%now(:, i) = block%y
        associate (eq => self%chain%blocks(min(i, size(self%chain%blocks))))
            eq%phase = block%equations%phase
            eq%sense = block%equations%sense
        end associate
        self%block%known = .false.
    end subroutine put_back

    !> Rates at the start of a step, in the phases that hold there.
    subroutine settle_all(self, t)
        class(continuous_blocks), intent(inout) :: self
        real(dp), intent(in) :: t   !! [T]
        integer, parameter :: most_switches = 6
        type(moving_block) :: block
        real(dp) :: g(switches)
        logical :: failed
        integer :: i, k

        do k = 1, most_switches
            if (.not. self%block%known) call self%chain%rates(t, self%now, self%now_rates, failed)
            self%block%known = .true.
            do i = 1, size(self%now, 2)
                call switch_values(self%chain%blocks(i), t, self%now(:controlled, i), &
                    self%now_rates(:, i), g)
                if (all(g <= 0.0_dp)) cycle
                call self%part(i, block)
                call change_phase(block, t, merge(1, 2, g(1) > 0.0_dp))
                call self%put_back(i, block)
            end do
            if (self%block%known) return
        end do
    end subroutine settle_all

    !> What the errors of each block are compared with.
    subroutine set_all_weights(self, normal)
        class(continuous_blocks), intent(inout) :: self
        real(dp), intent(in) :: normal   !! traction [F/L^2]
        real(dp) :: pressed
        integer :: i

        if (self%reloaded) then
            pressed = min(1.0_dp, max(normal, self%block%equations%open_below) / self%largest)
            self%rodas%natural(elastic, :) = self%elastic_sizes * pressed
            self%rodas%weights(elastic, :) = creep_weight(self%elastic_sizes, self%rtol, pressed)
        end if
        do i = 1, size(self%now, 2)
            call set_growing_weights(along, self%rtol, self%rodas%natural(:, i), self%now(:, i), &
                self%rodas%weights(:, i))
        end do
    end subroutine set_all_weights

    !> Has slip no rate any more, or one that leaves its block far behind?
    pure function jumps(self, t, error) result(yes)
        class(continuous_blocks), intent(in) :: self
        real(dp), intent(in) :: t       !! [T]
        real(dp), intent(in) :: error   !! of the last attempt
        logical :: yes
        integer :: i

        yes = .not. error < huge(error)
        do i = 1, size(self%now, 2)
            yes = yes .or. self%chain%blocks(min(i, size(self%chain%blocks)))%runs_away(t, &
                self%now_rates(:, i), maxval(abs(self%drive%velocity)))
        end do
    end function jumps

    subroutine try(self, start, end, error)
        class(continuous_blocks), intent(inout) :: self
        real(dp), intent(in) :: start, end   !! [T]
        real(dp), intent(out) :: error       !! part of the tolerated one
        logical :: failed
        integer :: i

        call self%rodas%step(self%chain, start, end - start, self%now, self%now_rates, self%then, &
            error)
        call self%count_iterations(implicit_rates)
        if (error > 1.0_dp) return
        call self%chain%rates(end, self%then, self%then_rates, failed)
        if (failed) error = huge(error)
        do i = 1, size(self%now, 2)
            if (wild(self%chain%blocks(min(i, size(self%chain%blocks))), self%now(:, i), &
                self%then(:, i), self%rodas%weights(elastic, i))) error = max(error, wild_error)
        end do
    end subroutine try

    !> Ends a step where the traction of the first block to do so reaches its cap, or leaves it.
    subroutine end_at_cap(self, t, end, error)
        class(continuous_blocks), intent(inout) :: self
        real(dp), intent(in) :: t          !! of its start [T]
        real(dp), intent(inout) :: end     !! of it as tried [T]
        real(dp), intent(inout) :: error   !! part of the tolerated one
        integer, parameter :: most_tries = 60
        real(dp), parameter :: close = 1.0e-12_dp
        real(dp), parameter :: unseen = 0.02_dp   !! part of the tolerated error
        integer, parameter :: traction = 2        !! what compares it with the cap
        type(root_bracket) :: bracket
        real(dp) :: h, next, nudge, enough, g(switches)
        integer :: i, block, which

        call self%find_first(t, end - t, next, block, which, g)
        if (block == 0) return
        enough = 0.0_dp
        if (which == traction) enough = unseen * self%chain%blocks(block)%alpha &
            / self%rodas%weights(elastic, block)
        bracket%high = end - t
        bracket%g_high = g(which) - 0.5_dp * enough
        bracket%g_low = -g(which)
        nudge = max(close * bracket%high, shortest * t)
        do i = 1, most_tries
            h = max(next, shortest * t)
            if (i == most_tries) h = bracket%high
            end = t + h
            call self%try(t, end, error)
            if (error > 1.0_dp) return
            call switch_values(self%chain%blocks(block), end, self%then(:controlled, block), &
                self%then_rates(:, block), g)
            if (g(which) > 0.0_dp .and. g(which) <= enough) return
            call bracket%take(h, g(which) - 0.5_dp * enough)
            next = bracket%guess()
            if (abs(next - h) > nudge) cycle
            if (g(which) > 0.0_dp) return
            next = min(bracket%high, h + nudge)   ! the step ends just after
            nudge = 2.0_dp * nudge
        end do
    end subroutine end_at_cap

    !> Which block does so first in a step, and where on the cubics through its ends.
    subroutine find_first(self, t, h, from_start, block, which, g)
        class(continuous_blocks), intent(in) :: self
        real(dp), intent(in) :: t, h   !! start and length of the step [T]
        real(dp), intent(out) :: from_start     !! [T]
        integer, intent(out) :: block, which    !! block 0: none does; which way
        real(dp), intent(out) :: g(switches)    !! of that block at the end
        type(moving_block) :: candidate
        real(dp) :: found, at_end(switches)
        integer :: i, k

        block = 0
        from_start = 2.0_dp * h
        do i = 1, size(self%now, 2)
            call switch_values(self%chain%blocks(i), t + h, self%then(:controlled, i), &
                self%then_rates(:, i), at_end)
            if (all(at_end <= 0.0_dp)) cycle
            call self%part(i, candidate)
            do k = 1, switches
                if (at_end(k) <= 0.0_dp) cycle
                found = h * first_root(candidate, t, h, self%then(:, i), self%then_rates(:, i), k)
                if (found >= from_start) cycle
                from_start = found
                block = i
                which = k
                g = at_end
            end do
        end do
    end subroutine find_first

    !> Takes over the end of a step.
    subroutine finish(self, t, old, new)
        class(continuous_blocks), intent(inout) :: self
        real(dp), intent(in) :: t   !! [T]
        type(slider_state), intent(in) :: old
        type(slider_state), intent(inout) :: new
        real(dp) :: normal   !! traction on a block [F/L^2]
        integer :: i

        self%now(:, :) = self%then
        self%now_rates(:, :) = self%then_rates
        self%block%known = .true.
        new%time = t
        new%drive = self%origin + self%drive%position(t)
        new%normal = self%drive%normal_traction(t, self%chain%piece)
        new%load = new%normal
        new%drive_work = sum(self%now(drive_work, :))
        new%damped = sum(self%now(damped, :))
        new%statev(:, :) = old%statev
        do i = 1, size(new%x)
            associate (block => self%chain%blocks(min(i, size(self%chain%blocks))))
                normal = block%drive%normal_traction(t, 1)
                call fill_block(block, normal, t, self%now(:, i), self%now_rates(:, i), i, old, &
                    new)
                new%statev(i, statev_u_n) = -normal / block%alpha_n
            end associate
        end do
    end subroutine finish

    subroutine visit(self, file)
        class(continuous_blocks), intent(inout) :: self
        type(archive), intent(inout) :: file

        integer :: i

        call self%visit_counts(file)
        call file%visit(self%now)
        do i = 1, size(self%chain%blocks)
            call file%visit(self%chain%blocks(i)%phase, self%chain%blocks(i)%sense)
        end do
        call file%visit(self%dt)
        self%block%known = .false.
    end subroutine visit

end module continuous_chain
