!> Adaptive steps of a chain in continuous time by Rodas4, under rate-and-state friction and its
!> relatives: what the law remembers changes so fast in slip that methods of low order take most of
!> their steps for it. Without a shear cap, a damper beside the contact spring, or a normal traction
!> that changes, so that the contacts of all blocks slide from first to last, if only by a little.
module continuous_chain
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use abstract_integrator, only : step_report
    use archive_file, only : archive
    use block_motion, only : fill_block, set_growing_weights, set_up, unknowns_of
    use block_steps, only : implicit_rates
    use chain_rates, only : chain_equations
    use continuous_steps, only : continuous
    use friction_mod, only : friction_bad_state, friction_facts, friction_no_convergence, &
        friction_no_rate, law_facts
    use rosenbrock, only : chain_stepper
    use run_settings, only : settings
    use slider_rates, only : along, damped, drive_work, memory, most_logarithm, phase_slide, &
        unknowns
    use slider_system, only : ends_periodic, slider, slider_state
    use step_ends, only : end_of_step
    implicit none
    private

    public :: chain_in_continuous_time, continuous_blocks

    type, extends(continuous) :: continuous_blocks
        type(chain_equations) :: chain
        type(chain_stepper) :: rodas
        !> Unknowns and their rates, before and after a step; one column a block.
        real(dp), allocatable, dimension(:, :) :: now, now_rates, then, then_rates
    contains
        procedure :: prepare, step, visit
        procedure, private :: try, finish, jumps
    end type continuous_blocks

contains

    !> Is a run one of a chain that this integrator takes?
    function chain_in_continuous_time(run) result(yes)
        type(settings), intent(in) :: run
        logical :: yes
        type(law_facts) :: law
        integer :: i

        law = friction_facts(run%props)
        associate (normal => run%drive%normal)
            yes = law%traits%stiff .and. .not. run%newmark .and. minval(normal) > 0.0_dp &
                .and. maxval(normal) <= minval(normal) .and. .not. run%drive%amplitude > 0.0_dp &
                .and. .not. any(abs(run%drive%normal_rate) > 0.0_dp) .and. plain(law)
        end associate
        if (.not. (yes .and. allocated(run%chain%constants))) return
        do i = 1, size(run%chain%constants, 1)
            yes = yes .and. plain(friction_facts(run%chain%constants(i, :)))
        end do

    contains

        pure function plain(law) result(yes)
            type(law_facts), intent(in) :: law
            logical :: yes

            yes = .not. (law%shear_cap < huge(law%shear_cap) .or. law%damping > 0.0_dp)
        end function plain

    end function chain_in_continuous_time

    subroutine prepare(self, run, system, start)
        class(continuous_blocks), intent(inout) :: self
        type(settings), intent(in) :: run
        type(slider), intent(in) :: system
        type(slider_state), intent(in) :: start
        real(dp) :: normal
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
        different = merge(n, 1, allocated(system%load) .or. allocated(system%constants))
        allocate (self%chain%blocks(different))
        do i = 1, n
            associate (block => self%chain%blocks(min(i, different)))
                normal = start%normal
                if (allocated(system%load)) normal = normal * system%load(i)
                if (i <= different) then
                    call set_up(run, system%props_of(i), normal, block, self%rodas%natural(:, i))
                    block%phase = phase_slide
                    block%drive%normal = [normal]
                    block%drive%normal_rate = [0.0_dp]
                else
                    self%rodas%natural(:, i) = self%rodas%natural(:, 1)
                end if
                self%now(:, i) = unknowns_of(block, start, i)
            end associate
        end do
        self%rodas%weights = 1.0_dp / (self%rtol * self%rodas%natural)
        self%now(drive_work, 1) = start%drive_work
        self%now(damped, 1) = start%damped
    end subroutine prepare

    subroutine step(self, old, new, report)
        class(continuous_blocks), intent(inout) :: self
        type(slider_state), intent(inout) :: old
        type(slider_state), intent(inout) :: new
        type(step_report), intent(out) :: report
        real(dp) :: end, wanted, h, error
        integer :: piece, i
        logical :: failed, again

        piece = self%drive%piece(old%time)
        if (piece /= self%chain%piece) then
            call self%chain%enter(piece)
            self%block%known = .false.
        end if
        call self%take_limit(old%time)
        if (.not. self%block%known) call self%chain%rates(old%time, self%now, self%now_rates, &
            failed)
        do i = 1, size(self%now, 2)
            call set_growing_weights(along, self%rtol, self%rodas%natural(:, i), self%now(:, i), &
                self%rodas%weights(:, i))
        end do
        again = .false.
        do
            wanted = min(self%dt, self%dt_max)
            end = end_of_step(old%time, wanted, self%limit)
            h = end - old%time
            call self%try(old%time, end, error)
            if (error <= 1.0_dp) exit
            again = .true.
            if (.not. self%can_shorten(old%time, h, error)) then
                report%status = friction_no_convergence
                if (self%jumps(old%time, error)) report%status = friction_no_rate
                return
            end if
        end do
        call self%lengthen(h, error, wanted, again)
        if (any(abs(self%then(memory, :)) > most_logarithm)) report%status = friction_bad_state
        call self%finish(end, old, new)
    end subroutine step

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

        call self%rodas%step(self%chain, start, end - start, self%now, self%now_rates, self%then, &
            error)
        call self%count_iterations(implicit_rates)
        if (error > 1.0_dp) return
        call self%chain%rates(end, self%then, self%then_rates, failed)
        if (failed) error = huge(error)
    end subroutine try

    !> Takes over the end of a step.
    subroutine finish(self, t, old, new)
        class(continuous_blocks), intent(inout) :: self
        real(dp), intent(in) :: t   !! [T]
        type(slider_state), intent(in) :: old
        type(slider_state), intent(inout) :: new
        integer :: i

        self%now(:, :) = self%then
        self%now_rates(:, :) = self%then_rates
        self%block%known = .true.
        new%time = t
        new%drive = self%origin + self%drive%position(t)
        new%normal = old%normal
        new%load = old%load
        new%drive_work = sum(self%now(drive_work, :))
        new%damped = sum(self%now(damped, :))
        new%statev(:, :) = old%statev
        do i = 1, size(new%x)
            associate (block => self%chain%blocks(min(i, size(self%chain%blocks))))
                call fill_block(block, block%drive%normal(1), t, self%now(:, i), &
                    self%now_rates(:, i), i, old, new)
            end associate
        end do
    end subroutine finish

    subroutine visit(self, file)
        class(continuous_blocks), intent(inout) :: self
        type(archive), intent(inout) :: file

        call self%visit_counts(file)
        call file%visit(self%now)
        call file%visit(self%dt)
        self%block%known = .false.
    end subroutine visit

end module continuous_chain
