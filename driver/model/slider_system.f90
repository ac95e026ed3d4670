!> Blocks on a base, each pulled by a spring whose far end the drive moves, and by springs between
!> neighbours (docs/theory.md, section 7):
!>
!>     M a_i = K (x_d - x_i) + K_c (x_(i+1) - 2 x_i + x_(i-1)) - C v_i - S f_t,i
!>
!> The normal traction is controlled through the penetration that carries it or, where a block has a
!> mass across the interface, follows from the motion of that (docs/theory.md, section 14).
module slider_system
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use archive_file, only : archive
    use friction_mod, only : facts => law_facts, friction_facts, prop_alpha_n, statev_u_n
    use law_facts, only : cohesion_of_each
    use platform, only : use_large_pages
    implicit none
    private

    public :: cohesions, normal_motion, set_accelerations, slider, slider_state, swap_states

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
        procedure :: free, force
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
        procedure :: carried_pressure, pull, push
    end type slider

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
        procedure :: use_large_pages => state_in_large_pages, visit
    end type slider_state

contains

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
    pure logical function free(self) result(yes)
        class(normal_motion), intent(in) :: self

        yes = self%mass > 0.0_dp
    end function free

    !> Force of drive spring and damper away from the base [F].
    pure real(dp) function force(self, stretch, u_n, v_n)
        class(normal_motion), intent(in) :: self
        real(dp), intent(in) :: stretch   !! of the drive spring along the interface [L]
        real(dp), intent(in) :: u_n       !! [L]
        real(dp), intent(in) :: v_n       !! [L/T]

        force = self%tilt * stretch - self%stiffness * (u_n - self%rest) - self%damping * v_n
    end function force

    !> Force of the drive spring along the interface, of a block at x that stands at u_n [F].
    elemental real(dp) function pull(self, drive, x, u_n) result(force)
        class(slider), intent(in) :: self
        real(dp), intent(in) :: drive, x, u_n   !! [L]

        force = self%stiffness * (drive - x)
        if (self%across%mass > 0.0_dp) force = force - self%across%tilt * (u_n - self%across%rest)
    end function pull

    !> Force on a block away from the base, but for the contact's [F].
    pure real(dp) function push(self, drive, load, x, u_n, v_n) result(force)
        class(slider), intent(in) :: self
        real(dp), intent(in) :: drive       !! [L]
        real(dp), intent(in) :: load        !! normal traction of the programme [F/L^2]
        real(dp), intent(in) :: x, u_n      !! [L]
        real(dp), intent(in) :: v_n         !! [L/T]

        force = self%across%force(drive - x, u_n, v_n) - self%area * load
    end function push

    !> Pressure in a contact that stands at u_n [F/L^2].
    pure real(dp) function carried_pressure(self, u_n) result(pressure)
        class(slider), intent(in) :: self
        real(dp), intent(in) :: u_n   !! [L]

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
    pure real(dp) function coupling_energy(self, x) result(energy)
        class(slider), intent(in) :: self
        real(dp), intent(in) :: x(:)   !! displacements [L]
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

    !> Keeps the state of a long chain where a step goes through it without waiting for page tables.
    subroutine state_in_large_pages(self)
        class(slider_state), intent(in) :: self

        call use_large_pages(size(self%x), self%x)
        call use_large_pages(size(self%v), self%v)
        call use_large_pages(size(self%a), self%a)
        call use_large_pages(size(self%spring), self%spring)
        call use_large_pages(size(self%friction), self%friction)
        call use_large_pages(size(self%statev), self%statev)
    end subroutine state_in_large_pages

    !> Exchanges two states without copying them.
    pure subroutine swap_states(a, b)
        type(slider_state), allocatable, intent(inout) :: a, b
        type(slider_state), allocatable :: other

        call move_alloc(a, other)
        call move_alloc(b, a)
        call move_alloc(other, b)
    end subroutine swap_states

end module slider_system
