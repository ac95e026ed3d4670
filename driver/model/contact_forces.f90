!> Friction forces of blocks, by the routines that finite-element hosts call.
module contact_forces
    use, intrinsic :: iso_c_binding, only : c_intptr_t, c_loc
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use friction_mod, only : friction_ok, friction_update, friction_update_batch, prop_alpha_n, &
        prop_alpha_t, statev_dissipation, statev_size, statev_status, statev_u_et, statev_u_n
    use slider_system, only : set_accelerations, slider, slider_state
    implicit none
    private

    public :: apply_normal_traction, friction_forces

    integer, parameter :: part = 512   !! blocks that are taken through the friction law together

contains

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
    !> The blocks stand still meanwhile, so that slip dissipates what the contact springs hold less
    !> afterwards.
    subroutine apply_normal_traction(system, normal, state, taken)
        type(slider), intent(in) :: system
        real(dp), intent(in) :: normal   !! afterwards [F/L^2]
        type(slider_state), intent(inout) :: state
        logical, intent(out) :: taken    !! or else left to the next step
        integer, parameter :: opened = 3
        real(dp), allocatable :: old(:, :), zero(:), tangent(:), props(:)
        integer :: status, i

        taken = .true.
        state%load = normal
        if (system%across%free()) then
            call set_accelerations(system, state)
            return
        end if
        if (abs(normal - state%normal) <= 1.0e-14_dp * abs(normal)) return
        allocate (zero(size(state%x)), tangent(size(state%x)), source=0.0_dp)
        old = state%statev
        call friction_forces(system, old, normal, zero, 0.0_dp, state%statev, state%friction, &
            tangent, status)
        taken = status >= 0
        if (taken) then
            do i = 1, size(zero)
                if (nint(state%statev(i, statev_status)) == opened) cycle
                props = system%props_of(i)
                state%statev(i, statev_dissipation) = old(i, statev_dissipation) + 0.5_dp &
                    * props(prop_alpha_t) * max(0.0_dp, old(i, statev_u_et)**2 &
                    - state%statev(i, statev_u_et)**2)
            end do
        end if
        state%normal = normal
        call set_accelerations(system, state)
    end subroutine apply_normal_traction

end module contact_forces
