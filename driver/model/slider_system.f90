!> Blocks on a base, each pulled by a spring whose far end the drive moves, and by springs between
!> neighbours (docs/theory.md, section 7):
!>
!>     M a_i = K (x_d - x_i) + K_c (x_(i+1) - 2 x_i + x_(i-1)) - C v_i - S f_t,i
!>
!> The friction forces come from the same routines that finite-element hosts call; the normal
!> traction is controlled through the penetration that carries it or, where a block has a mass
!> across the interface, follows from the motion of that (docs/theory.md, section 14).
module slider_system
    use, intrinsic :: iso_c_binding, only : c_intptr_t, c_loc
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use archive_file, only : archive
    use friction_mod, only : facts => law_facts, friction_facts, friction_ok, friction_update, &
        friction_update_batch, prop_alpha_n, prop_alpha_t, statev_dissipation, statev_mu, &
        statev_r, statev_size, statev_status, statev_u_et, statev_u_n
    use law_facts, only : cohesion_of_each
    implicit none
    private

    public :: apply_normal_traction, blend, cohesions, displace, energy_balance, friction_forces, &
        initial_state, initial_values, normal_motion, place, set_accelerations, slider, &
        slider_state, swap_states

    !> What the first and the last block are coupled to.
    integer, parameter, public :: ends_free = 1       !! nothing
    integer, parameter, public :: ends_fixed = 2      !! a wall that stands still
    integer, parameter, public :: ends_periodic = 3   !! each other
    integer, parameter, public :: ends_free_fixed = 4 !! the first to nothing, the last to a wall
    integer, parameter, public :: ends_fixed_free = 5 !! the first to a wall, the last to nothing

    !> How a block moves across the interface, if it does.
    type :: normal_motion
        real(dp) :: mass = 0.0_dp        !! 0: it does not, its normal traction is prescribed
                                         !! [F T^2/L]
        real(dp) :: stiffness = 0.0_dp   !! of the drive spring across the interface [F/L]
        real(dp) :: damping = 0.0_dp     !! [F T/L]
        real(dp) :: tilt = 0.0_dp        !! stiffness of the drive spring between both directions
                                         !! [F/L]
        real(dp) :: rest = 0.0_dp        !! place at which that spring pulls nowhere [L]
    contains
        procedure :: free
    end type normal_motion

    !> What does not change during a run.
    type :: slider
        real(dp) :: mass, stiffness, damping, area   !! [M], [F/L], [F T/L], [L^2]
        real(dp), allocatable :: props(:)            !! constants of the friction routine
        real(dp) :: coupling = 0.0_dp                !! of neighbours [F/L]
        integer :: ends = ends_free
        real(dp) :: walls(2) = 0.0_dp                !! where they stand [L]
        real(dp), allocatable :: load(:)   !! normal traction of each block, relative to that of the
                                           !! programme; all 1 if not allocated [-]
        real(dp), allocatable :: constants(:, :)   !! `props` of each block, one row a block; the
                                                   !! last ones may be left out if they have their
                                                   !! defaults. Not allocated: all have `props`
        type(normal_motion) :: across = normal_motion()
    contains
        procedure :: add_coupling, coupling_energy, props_of
        procedure :: account, carried_pressure, pull, push
        procedure :: take_stock, energy_of, let_go
    end type slider

    !> How a block starts, if not at rest on a virgin contact with a slack spring.
    type :: initial_values
        logical :: any_given = .false.
        logical :: mu_given = .false.          !! or else a law with an R has its virgin one
        real(dp) :: mu = 0.0_dp                !! friction coefficient [-]
        real(dp) :: r = 0.0_dp                 !! similarity ratio; the friction opposes +x [-]
        logical :: has_r = .true.              !! the law has an R; otherwise it is 0 or 1 here
        real(dp) :: displacement = 0.0_dp      !! [L]
        real(dp) :: velocity = 0.0_dp          !! [L/T]
        logical :: spring_given = .false.      !! otherwise the block starts in equilibrium
        real(dp) :: spring_force = 0.0_dp      !! [F]
    end type initial_values

    !> What changes with time.
    type :: slider_state
        real(dp) :: time = 0.0_dp                !! [T]
        real(dp) :: drive = 0.0_dp               !! position of the drive [L]
        real(dp) :: normal = 0.0_dp              !! normal traction [F/L^2]
        real(dp) :: load = 0.0_dp                !! that of the programme [F/L^2]
        real(dp) :: v_n = 0.0_dp, a_n = 0.0_dp   !! across the interface, away from the base; only
                                                 !! where a block is free to [L/T], [L/T^2]
        real(dp) :: drive_work = 0.0_dp          !! of the drive since the start [F L]
        real(dp) :: damped = 0.0_dp              !! energy lost to the dampers since then [F L]
        real(dp), allocatable :: x(:), v(:), a(:)   !! of each block [L], [L/T], [L/T^2]
        real(dp), allocatable :: spring(:)       !! force of the drive spring [F]
        real(dp), allocatable :: friction(:)     !! S f_t, positive when it opposes +x [F]
        real(dp), allocatable :: statev(:, :)    !! of the friction routine, one row a block
    contains
        procedure :: visit
    end type slider_state

    !> Where the work of the drive has gone [F L].
    type :: energy_balance
        real(dp) :: at_start = 0.0_dp   !! held at the start, in all forms
        real(dp) :: drive_work = 0.0_dp
        real(dp) :: most_work = 0.0_dp   !! of the drive, whichever way
        real(dp) :: kinetic = 0.0_dp, spring = 0.0_dp, contact = 0.0_dp   !! held now
        real(dp) :: damped = 0.0_dp, dissipated = 0.0_dp                  !! lost
    contains
        procedure :: held, unbalanced
    end type energy_balance

    integer, parameter :: part = 512   !! blocks that are taken through the friction law together

contains

    !> At rest, pressed on the base, no spring stretched.
    subroutine initial_state(system, n_blocks, normal, state, status)
        type(slider), intent(in) :: system
        integer, intent(in) :: n_blocks
        real(dp), intent(in) :: normal           !! normal traction at the start [F/L^2]
        type(slider_state), intent(out) :: state
        integer, intent(out) :: status           !! of the friction routine
        real(dp), allocatable :: tangent(:), zero(:), virgin(:, :)

        allocate (zero(n_blocks), tangent(n_blocks), virgin(n_blocks, statev_size))
        zero = 0.0_dp
        virgin = 0.0_dp
        state%x = zero
        state%v = zero
        state%a = zero
        state%spring = zero
        state%friction = zero
        state%statev = virgin
        state%normal = normal
        state%load = normal
        call friction_forces(system, virgin, normal, zero, 0.0_dp, state%statev, &
            state%friction, tangent, status)
    end subroutine initial_state

    !> Puts the blocks where the initial values say.
    pure subroutine place(system, values, state)
        type(slider), intent(in) :: system
        type(initial_values), intent(in) :: values
        type(slider_state), intent(inout) :: state   !! as `initial_state` left it
        real(dp), dimension(size(state%x)) :: mu, alpha_t
        real(dp), allocatable :: props(:)
        type(facts) :: law
        integer :: i

        if (.not. values%any_given) return
        state%x = values%displacement
        state%v = values%velocity
        mu = values%mu
        do i = 1, size(mu)
            props = system%props_of(i)
            alpha_t(i) = props(prop_alpha_t)
            law = friction_facts(props)
            if (values%has_r .and. .not. values%mu_given) mu(i) = law%virgin_mu
        end do
        state%statev(:, statev_mu) = mu
        if (values%has_r) state%statev(:, statev_r) = values%r
        state%friction = mu * state%normal
        if (allocated(system%load)) state%friction = state%friction * system%load
        if (values%has_r) state%friction = values%r * (state%friction + cohesions(system, &
            size(mu)))
        state%friction = system%area * state%friction
        state%statev(:, statev_u_et) = state%friction / (system%area * alpha_t)
        state%spring = sum(state%friction) / size(state%friction) &
            + system%damping * values%velocity
        if (values%spring_given) state%spring = values%spring_force
        state%drive = state%x(1) + state%spring(1) / system%stiffness
        call set_accelerations(system, state)
    end subroutine place

    !> Moves blocks at the start; the drive and the contacts stay as they are.
    pure subroutine displace(system, by, state)
        type(slider), intent(in) :: system
        real(dp), intent(in) :: by(:)                !! one a block [L]
        type(slider_state), intent(inout) :: state   !! as `initial_state` or `place` left it

        state%x = state%x + by
        state%spring = state%spring - system%stiffness * by
        call set_accelerations(system, state)
    end subroutine displace

    !> Constants of the friction of a block.
    pure function props_of(self, i) result(props)
        class(slider), intent(in) :: self
        integer, intent(in) :: i   !! block
        real(dp), allocatable :: props(:)

        if (allocated(self%constants)) then
            props = self%constants(i, :)
        else
            props = self%props
        end if
    end function props_of

    !> Traction that the contact of each block carries without pressure.
    pure function cohesions(system, n) result(held)
        type(slider), intent(in) :: system
        integer, intent(in) :: n   !! blocks
        real(dp) :: held(n)        !! [F/L^2]
        type(facts) :: law

        if (allocated(system%constants)) then
            held = cohesion_of_each(system%constants)
        else
            law = friction_facts(system%props)
            held = law%cohesion
        end if
    end function cohesions

    !> Does the block move across the interface by itself?
    pure function free(self) result(yes)
        class(normal_motion), intent(in) :: self
        logical :: yes

        yes = self%mass > 0.0_dp
    end function free

    !> Force of the drive spring along the interface, of a block at x that stands at u_n.
    elemental function pull(self, drive, x, u_n) result(force)
        class(slider), intent(in) :: self
        real(dp), intent(in) :: drive, x, u_n   !! [L]
        real(dp) :: force                       !! [F]

        force = self%stiffness * (drive - x)
        if (self%across%mass > 0.0_dp) force = force - self%across%tilt * (u_n - self%across%rest)
    end function pull

    !> Force on a block away from the base, but for the contact's.
    pure function push(self, drive, load, x, u_n, v_n) result(force)
        class(slider), intent(in) :: self
        real(dp), intent(in) :: drive       !! [L]
        real(dp), intent(in) :: load        !! normal traction of the programme [F/L^2]
        real(dp), intent(in) :: x, u_n      !! [L]
        real(dp), intent(in) :: v_n         !! [L/T]
        real(dp) :: force                   !! [F]

        force = self%across%tilt * (drive - x) - self%across%stiffness * (u_n - self%across%rest) &
            - self%across%damping * v_n - self%area * load
    end function push

    !> Pressure in a contact that stands at u_n.
    pure function carried_pressure(self, u_n) result(pressure)
        class(slider), intent(in) :: self
        real(dp), intent(in) :: u_n   !! [L]
        real(dp) :: pressure          !! [F/L^2]

        pressure = max(0.0_dp, -self%props(prop_alpha_n) * u_n)
    end function carried_pressure

    !> Accelerations by the equation of motion; without a mass they are what they were.
    pure subroutine set_accelerations(system, state)
        type(slider), intent(in) :: system
        type(slider_state), intent(inout) :: state

        if (system%mass <= 0.0_dp) return
        state%a = state%spring - system%damping * state%v - state%friction
        call system%add_coupling(state%x, 1.0_dp, state%a)
        state%a = state%a / system%mass
        if (.not. system%across%free()) return
        associate (u_n => state%statev(1, statev_u_n))
            state%a_n = (system%push(state%drive, state%load, state%x(1), u_n, state%v_n) &
                + system%area * system%carried_pressure(u_n)) / system%across%mass
        end associate
    end subroutine set_accelerations

    !> Adds the forces of the springs between neighbours, times a factor.
    pure subroutine add_coupling(self, x, factor, force)
        class(slider), intent(in) :: self
        real(dp), intent(in) :: x(:)           !! displacements [L]
        real(dp), intent(in) :: factor         !! [-]
        real(dp), intent(inout) :: force(:)    !! [F]
        real(dp) :: k, before, after           ! displacements beyond the ends
        integer :: i, n

        if (self%coupling <= 0.0_dp) return
        n = size(x)
        k = factor * self%coupling
        call beyond_ends(self, x, before, after)
        if (n == 1) then
            force(1) = force(1) + k * (before - 2.0_dp * x(1) + after)
            return
        end if
        force(1) = force(1) + k * (x(2) - 2.0_dp * x(1) + before)
        do i = 2, n - 1
            force(i) = force(i) + k * (x(i + 1) - 2.0_dp * x(i) + x(i - 1))
        end do
        force(n) = force(n) + k * (after - 2.0_dp * x(n) + x(n - 1))
    end subroutine add_coupling

    !> Energy of the springs between neighbours [F L].
    pure function coupling_energy(self, x) result(energy)
        class(slider), intent(in) :: self
        real(dp), intent(in) :: x(:)   !! displacements [L]
        real(dp) :: energy
        real(dp) :: before, after
        integer :: i

        energy = 0.0_dp
        if (self%coupling <= 0.0_dp) return
        do i = 2, size(x)
            energy = energy + (x(i) - x(i - 1))**2
        end do
        call beyond_ends(self, x, before, after)
        energy = energy + (x(1) - before)**2
        if (self%ends /= ends_periodic) energy = energy + (after - x(size(x)))**2
        energy = 0.5_dp * self%coupling * energy
    end function coupling_energy

    !> Displacements of what the first and the last block are coupled to.
    pure subroutine beyond_ends(system, x, before, after)
        class(slider), intent(in) :: system
        real(dp), intent(in) :: x(:)               !! [L]
        real(dp), intent(out) :: before, after     !! [L]

        before = system%walls(1)
        after = system%walls(2)
        if (system%ends == ends_periodic) then
            before = x(size(x))
            after = x(1)
        end if
        ! no force
        if (system%ends == ends_free .or. system%ends == ends_free_fixed) before = x(1)
        if (system%ends == ends_free .or. system%ends == ends_fixed_free) after = x(size(x))
    end subroutine beyond_ends

    !> Weighted sum of states, but for their times, drives and loads.
    pure subroutine blend(states, weights, mixed)
        type(slider_state), intent(in) :: states(:)
        real(dp), intent(in) :: weights(:)           !! one for each state [-]
        type(slider_state), intent(inout) :: mixed   !! allocated like the states
        integer :: k

        mixed%drive_work = dot_product(weights, states%drive_work)
        mixed%damped = dot_product(weights, states%damped)
        mixed%v_n = dot_product(weights, states%v_n)
        mixed%x(:) = weights(1) * states(1)%x
        mixed%v(:) = weights(1) * states(1)%v
        mixed%friction(:) = weights(1) * states(1)%friction
        mixed%statev(:, :) = weights(1) * states(1)%statev
        do k = 2, size(states)
            mixed%x(:) = mixed%x + weights(k) * states(k)%x
            mixed%v(:) = mixed%v + weights(k) * states(k)%v
            mixed%friction(:) = mixed%friction + weights(k) * states(k)%friction
            mixed%statev(:, :) = mixed%statev + weights(k) * states(k)%statev
        end do
    end subroutine blend

    !> Friction force and its derivative on every block, for displacement increments from `old` to a
    !> moment of a given normal traction. What has lost it is open, whatever round-off has gathered
    !> in u_n before.
    subroutine friction_forces(system, old, normal, dx, dt, new, force, stiffness, status)
        type(slider), intent(in) :: system
        real(dp), intent(in) :: old(:, :)        !! state variables at the start of the step
        real(dp), intent(in) :: normal           !! normal traction then [F/L^2]
        real(dp), intent(in) :: dx(:)            !! increment of displacement [L]
        real(dp), intent(in) :: dt               !! [T]
        real(dp), intent(inout) :: new(:, :)     !! state variables at its end
        real(dp), intent(inout) :: force(:)      !! S f_t [F]
        real(dp), intent(inout) :: stiffness(:)  !! S df_t/dx [F/L]
        integer, intent(out) :: status           !! the worst: an error, snap-back, or ok
        integer, parameter :: few = 16   !! blocks for which the batch routine takes longer
        integer :: first, last, part_status

        status = friction_ok
        if (size(dx) < few) then
            do first = 1, size(dx)
                if (allocated(system%constants)) then
                    call force_on_one(first, system%constants(first, :), part_status)
                else
                    call force_on_one(first, system%props, part_status)
                end if
                if (part_status /= friction_ok) status = part_status
                if (status < 0) return
            end do
        else
            do first = 1, size(dx), part
                last = min(first + part - 1, size(dx))
                call forces_on_part(system, old, normal, dx, dt, first, last, new, force, &
                    stiffness, part_status)
                if (part_status /= friction_ok) status = part_status
                if (status < 0) return
            end do
        end if

    contains

        subroutine force_on_one(i, props, point_status)
            integer, intent(in) :: i
            real(dp), intent(in) :: props(:)
            integer, intent(out) :: point_status
            real(dp) :: du(2), statev(statev_size), traction(2), tangent(2, 2)

            du = [-normal / props(prop_alpha_n), dx(i)]
            if (allocated(system%load)) du(1) = du(1) * system%load(i)
            du(1) = du(1) - old(i, statev_u_n)
            statev = old(i, :)
            call friction_update(du, dt, props, statev, traction, tangent, point_status)
            if (point_status < 0) return
            new(i, :) = statev
            force(i) = system%area * traction(2)
            stiffness(i) = system%area * tangent(2, 2)
        end subroutine force_on_one

    end subroutine friction_forces

    !> The same for blocks `first` to `last`, a part that stays in cache: what the friction routine
    !> needs and leaves beside the forces never gets to memory. In three dimensions and from a cache
    !> line on, because the batch routine then works where the numbers are, otherwise on copies.
    subroutine forces_on_part(system, old, normal, dx, dt, first, last, new, force, stiffness, &
        status)
        type(slider), intent(in) :: system
        real(dp), intent(in) :: old(:, :), normal, dx(:), dt
        integer, intent(in) :: first, last
        real(dp), intent(inout) :: new(:, :), force(:), stiffness(:)
        integer, intent(out) :: status
        integer, parameter :: line = 8   ! numbers of a cache line
        real(dp) :: du(last - first + 1, 3), statev(last - first + 1, statev_size), &
            traction(last - first + 1, 3)
        real(dp), target :: room(9 * (last - first + 1) + line - 1)
        real(dp), pointer, contiguous :: tangent(:, :, :)
        integer :: statuses(last - first + 1), n, skipped, k

        n = last - first + 1
        skipped = int(modulo(-transfer(c_loc(room), 0_c_intptr_t) / 8, int(line, c_intptr_t)))
        tangent(1:n, 1:3, 1:3) => room(skipped + 1:skipped + 9 * n)
        if (allocated(system%constants)) then
            du(:, 1) = -normal / system%constants(first:last, prop_alpha_n)
        else
            du(:, 1) = -normal / system%props(prop_alpha_n)
        end if
        if (allocated(system%load)) du(:, 1) = du(:, 1) * system%load(first:last)
        du(:, 1) = du(:, 1) - old(first:last, statev_u_n)
        du(:, 2) = dx(first:last)
        du(:, 3) = 0.0_dp
        do k = 1, statev_size
            statev(:, k) = old(first:last, k)
        end do
        if (allocated(system%constants)) then
            call friction_update_batch(du, dt, system%constants(first:last, :), statev, traction, &
                tangent, statuses)
        else
            call friction_update_batch(du, dt, system%props, statev, traction, tangent, statuses)
        end if
        status = minval(statuses)
        if (status < 0) return
        status = maxval(statuses)
        do k = 1, statev_size
            new(first:last, k) = statev(:, k)
        end do
        force(first:last) = system%area * traction(:, 2)
        stiffness(first:last) = system%area * tangent(:, 2, 2)
    end subroutine forces_on_part

    !> A sudden change of the normal traction, at one moment of time. A loaded contact whose
    !> friction depends on the slip rate needs time for it: there the next step has to press it.
    subroutine apply_normal_traction(system, normal, state, taken)
        type(slider), intent(in) :: system
        real(dp), intent(in) :: normal   !! afterwards [F/L^2]
        type(slider_state), intent(inout) :: state
        logical, intent(out) :: taken    !! or else left to the next step
        real(dp), allocatable :: old(:, :), zero(:), tangent(:)
        integer :: status

        taken = .true.
        state%load = normal
        if (system%across%free()) then
            call set_accelerations(system, state)
            return
        end if
        if (abs(normal - state%normal) <= 1.0e-14_dp * abs(normal)) return
        allocate (zero(size(state%x)), tangent(size(state%x)))
        zero = 0.0_dp
        old = state%statev
        call friction_forces(system, old, normal, zero, 0.0_dp, state%statev, state%friction, &
            tangent, status)
        taken = status >= 0
        state%normal = normal
        call set_accelerations(system, state)
    end subroutine apply_normal_traction

    !> Reads or writes a state; to read, it must be allocated.
    subroutine visit(self, file)
        class(slider_state), intent(inout) :: self
        type(archive), intent(inout) :: file

        call file%visit(self%time, self%drive, self%normal, self%load, self%v_n, self%a_n)
        call file%visit(self%drive_work, self%damped)
        call file%visit(self%x)
        call file%visit(self%v)
        call file%visit(self%a)
        call file%visit(self%spring)
        call file%visit(self%friction)
        call file%visit(self%statev)
    end subroutine visit

    !> Exchanges two states without copying them.
    pure subroutine swap_states(a, b)
        type(slider_state), intent(inout) :: a, b
        type(slider_state) :: other

        call move_state(a, other)
        call move_state(b, a)
        call move_state(other, b)
    end subroutine swap_states

    pure subroutine move_state(from, to)
        type(slider_state), intent(inout) :: from, to

        to%time = from%time
        to%drive = from%drive
        to%normal = from%normal
        to%load = from%load
        to%v_n = from%v_n
        to%a_n = from%a_n
        to%drive_work = from%drive_work
        to%damped = from%damped
        call move_alloc(from%x, to%x)
        call move_alloc(from%v, to%v)
        call move_alloc(from%a, to%a)
        call move_alloc(from%spring, to%spring)
        call move_alloc(from%friction, to%friction)
        call move_alloc(from%statev, to%statev)
    end subroutine move_state

    !> Adds the work of the drive and the energy lost to the dampers from `old` to `new`, by the
    !> mean forces over the step.
    pure subroutine account(self, old, new)
        class(slider), intent(in) :: self
        type(slider_state), intent(in) :: old
        type(slider_state), intent(inout) :: new
        real(dp) :: pull, drag   ! sums over the blocks [F], [L^2/T]
        integer :: i

        pull = 0.0_dp
        drag = 0.0_dp
        do i = 1, size(new%x)
            pull = pull + (old%spring(i) + new%spring(i))
            drag = drag + (old%v(i) + new%v(i)) * (new%x(i) - old%x(i))
        end do
        new%drive_work = old%drive_work + 0.5_dp * pull * (new%drive - old%drive)
        new%damped = old%damped + 0.5_dp * self%damping * drag
        if (.not. self%across%free()) return
        associate (du_n => new%statev(1, statev_u_n) - old%statev(1, statev_u_n))
            new%drive_work = new%drive_work - 0.5_dp * self%area * (old%load + new%load) * du_n
            new%damped = new%damped + 0.5_dp * self%across%damping * (old%v_n + new%v_n) * du_n
        end associate
    end subroutine account

    !> Energies that a state holds: of the motion, of the springs, of the contact; and what has come
    !> and was lost. All in one loop: a sum waits for each addition, four wait together.
    pure subroutine take_stock(self, state, energy)
        class(slider), intent(in) :: self
        type(slider_state), intent(in) :: state
        type(energy_balance), intent(inout) :: energy
        real(dp) :: motion, springs, contact, dissipated   ! sums over the blocks
        integer :: i

        motion = 0.0_dp
        springs = 0.0_dp
        contact = 0.0_dp
        dissipated = 0.0_dp
        do i = 1, size(state%x)
            motion = motion + state%v(i)**2
            springs = springs + state%spring(i)**2
            contact = contact + state%statev(i, statev_u_et)**2
            dissipated = dissipated + state%statev(i, statev_dissipation)
        end do
        if (allocated(self%constants)) contact = sum(self%constants(:, prop_alpha_t) &
            / self%props(prop_alpha_t) * state%statev(:, statev_u_et)**2)
        energy%kinetic = 0.5_dp * self%mass * motion
        energy%spring = 0.5_dp * springs / self%stiffness + self%coupling_energy(state%x)
        energy%contact = 0.5_dp * self%area * self%props(prop_alpha_t) * contact
        energy%dissipated = self%area * dissipated
        energy%drive_work = state%drive_work
        energy%damped = state%damped
        if (self%across%free()) call take_stock_across(self, state, energy)
    end subroutine take_stock

    !> Adds what is held across the interface.
    pure subroutine take_stock_across(self, state, energy)
        class(slider), intent(in) :: self
        type(slider_state), intent(in) :: state
        type(energy_balance), intent(inout) :: energy
        real(dp) :: away, stretch   !! of the drive spring in both directions [L]

        away = state%statev(1, statev_u_n) - self%across%rest
        stretch = state%drive - state%x(1)
        energy%kinetic = energy%kinetic + 0.5_dp * self%across%mass * state%v_n**2
        energy%spring = 0.5_dp * self%stiffness * stretch**2 - self%across%tilt * stretch * away &
            + 0.5_dp * self%across%stiffness * away**2
        energy%contact = energy%contact + 0.5_dp * self%area &
            * self%carried_pressure(state%statev(1, statev_u_n))**2 / self%props(prop_alpha_n)
    end subroutine take_stock_across

    !> Energy that contact springs still held when their contacts opened: nothing gets it back. Nor
    !> what the drive spring of a block without mass and damping held: that follows at once.
    pure function let_go(self, old, new) result(energy)
        class(slider), intent(in) :: self
        type(slider_state), intent(in) :: old, new
        real(dp) :: energy   !! [F L]
        real(dp), parameter :: open = 3.0_dp
        real(dp) :: alpha   !! [F/L^3]
        integer :: i

        energy = 0.0_dp
        alpha = self%props(prop_alpha_t)
        do i = 1, size(new%x)
            if (new%statev(i, statev_status) < open) cycle
            if (allocated(self%constants)) alpha = self%constants(i, prop_alpha_t)
            energy = energy + 0.5_dp * self%area * alpha * old%statev(i, statev_u_et)**2
            if (self%mass > 0.0_dp .or. self%damping > 0.0_dp) cycle
            energy = energy + 0.5_dp * (old%spring(i)**2 - new%spring(i)**2) / self%stiffness
        end do
    end function let_go

    !> Held by the springs, the contact and the motion together.
    pure function energy_of(self, state) result(total)
        class(slider), intent(in) :: self
        type(slider_state), intent(in) :: state
        real(dp) :: total   !! [F L]
        type(energy_balance) :: energy

        call self%take_stock(state, energy)
        total = energy%held()
    end function energy_of

    !> Held by the springs, the contact and the motion together.
    pure function held(self) result(total)
        class(energy_balance), intent(in) :: self
        real(dp) :: total   !! [F L]

        total = self%kinetic + self%spring + self%contact
    end function held

    !> What the balance does not explain: the error of the time integration.
    pure function unbalanced(self) result(rest)
        class(energy_balance), intent(in) :: self
        real(dp) :: rest

        rest = self%at_start + self%drive_work - self%kinetic - self%spring - self%contact &
            - self%damped - self%dissipated
    end function unbalanced

end module slider_system
