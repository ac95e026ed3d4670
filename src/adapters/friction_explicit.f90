!> One point of Abaqus/Explicit's friction routines, VFRIC and VFRICTION, which hand in the normal
!> force and the slip in axes that turn from call to call.
!>
!> Those axes say nothing of the surface: the first is along the slip, and arbitrary where there is
!> none. So the law has axes of its own that stay with the surface, and statev(2:4) holds the
!> elastic tangential displacement as a vector in global axes; the normal displacement is Abaqus's
!> own.
module friction_explicit
    use friction_host, only : host_tangential, usable
    use friction_kinds, only : wp
    use friction_law_constants, only : positive
    use friction_mod, only : friction_bad_increment, friction_bad_state, friction_ok, &
        friction_zero_time_increment, statev_size, statev_u_et, statev_u_n
    implicit none
    private

    public :: explicit_point, rest_out_of_contact, slide_in_contact

    !> What the host says of a point in contact.
    type :: explicit_point
        integer :: ndir              !! components, 2 or 3
        real(wp) :: along(3)         !! host's local axis 1 in global axes
        real(wp) :: normal(3)        !! of the master, in global axes
        real(wp) :: slip(2)          !! increment, host's local axes [L]
        real(wp) :: stick_force      !! that would prevent the slip [F]
        real(wp) :: normal_force     !! [F]
        real(wp) :: area             !! [L^2]
        real(wp) :: dt               !! [T]
    end type explicit_point

contains

    !> The friction force in the host's local axes, against the slip; none where there is no area.
    pure subroutine slide_in_contact(point, props, statev, force, status)
        type(explicit_point), intent(in) :: point
        real(wp), intent(in), contiguous :: props(:)     !! constants of the friction routine
        real(wp), intent(inout) :: statev(statev_size)   !! elastic displacement in global axes
        real(wp), intent(out) :: force(2)                !! [F]
        integer, intent(out) :: status                   !! of the friction routine
        real(wp) :: host_axes(3, 2), own_axes(3, 2), turn(2, 2), state(statev_size)
        real(wp) :: du(2), tau(2), by_du(2, 2), by_p(2), pressure
        integer :: n

        status = friction_bad_increment
        if (.not. (usable(point%area) .and. usable(point%normal_force) &
            .and. usable(point%stick_force))) return
        if (point%area > 0.0_wp .and. point%area < positive) return   ! the pressure overflows
        status = friction_ok
        force = 0.0_wp
        if (.not. point%area > 0.0_wp) return
        n = point%ndir - 1
        call check_numbers(point, statev, status)
        if (status < 0) return
        host_axes = tangential_axes(point%ndir, point%along, point%normal)
        own_axes = tangential_axes(point%ndir, surface_axis(point%ndir, point%normal), point%normal)
        turn = matmul(transpose(own_axes), host_axes)
        du = matmul(turn, point%slip)
        pressure = point%normal_force / point%area
        state = statev
        state(statev_u_n) = 0.0_wp
        state(statev_u_et:statev_u_et + 1) = &
            matmul(statev(statev_u_n:statev_u_n + 2), own_axes)
        call tangential(n, du, pressure, point%dt, props, state, tau, by_du, by_p, status)
        ! where no time has passed nothing has slid, whatever the host moved into place
        if (status == friction_zero_time_increment) then
            du = 0.0_wp
            call tangential(n, du, pressure, point%dt, props, state, tau, by_du, by_p, status)
        end if
        if (status < 0) return
        statev = state
        statev(statev_u_n:statev_u_n + 2) = &
            matmul(own_axes, state(statev_u_et:statev_u_et + 1))
        force = -matmul(tau, turn) * point%area
        ! The host takes what opposes the slip, and no more than prevents it. Without slip its axis
        ! 1 is arbitrary, and the force stored in the surface is handed over as it is.
        if (any(abs(point%slip) > 0.0_wp)) then
            force(1) = min(max(force(1), -point%stick_force), 0.0_wp)
        end if
    end subroutine slide_in_contact

    !> What is turned into the law's axes has to be numbers, and cosines at most 1 (in single
    !> precision still): a host that traps exceptions is told, too.
    pure subroutine check_numbers(point, statev, status)
        type(explicit_point), intent(in) :: point
        real(wp), intent(in) :: statev(statev_size)
        integer, intent(out) :: status   !! ok, bad increment, or bad state
        real(wp), parameter :: largest_cosine = 1.0_wp + 1.0e-6_wp
        integer :: d

        d = point%ndir
        status = friction_bad_increment
        if (.not. all(usable(point%slip(1:d - 1)))) return
        if (.not. (all(usable(point%along(1:d))) .and. all(usable(point%normal(1:d))))) return
        if (max(maxval(abs(point%along(1:d))), maxval(abs(point%normal(1:d)))) &
            > largest_cosine) return
        status = friction_bad_state
        if (.not. all(usable(statev(statev_u_n:statev_u_n + 2)))) return
        status = friction_ok
    end subroutine check_numbers

    !> A point that is not in contact carries nothing and heals.
    pure subroutine rest_out_of_contact(dt, props, statev, status)
        real(wp), intent(in) :: dt                       !! [T]
        real(wp), intent(in), contiguous :: props(:)     !! constants of the friction routine
        real(wp), intent(inout) :: statev(statev_size)
        integer, intent(out) :: status                   !! of the friction routine
        real(wp) :: tau(2), by_du(2, 2), by_p(2)

        call host_tangential([0.0_wp, 0.0_wp], -1.0_wp, dt, props, statev, tau, by_du, by_p, status)
        if (status < 0) return
        statev(statev_u_n:statev_u_n + 2) = 0.0_wp
    end subroutine rest_out_of_contact

    !> One or two tangential directions; what is not used is zero.
    pure subroutine tangential(n, du, pressure, dt, props, state, tau, by_du, by_p, status)
        integer, intent(in) :: n
        real(wp), intent(in) :: du(2), pressure, dt
        real(wp), intent(in), contiguous :: props(:)
        real(wp), intent(inout) :: state(statev_size)
        real(wp), intent(inout) :: tau(2), by_du(2, 2), by_p(2)
        integer, intent(out) :: status
        real(wp) :: one(1, 1)

        tau = 0.0_wp
        if (n == 2) then
            call host_tangential(du, pressure, dt, props, state, tau, by_du, by_p, status)
        else
            call host_tangential(du(1:1), pressure, dt, props, state, tau(1:1), one, by_p(1:1), &
                status)
        end if
    end subroutine tangential

    !> Tangential axes as columns: one that is given, and in space what is at right angles to it and
    !> to the normal.
    pure function tangential_axes(ndir, along, normal) result(columns)
        integer, intent(in) :: ndir
        real(wp), intent(in) :: along(3), normal(3)
        real(wp) :: columns(3, 2)

        columns = 0.0_wp
        columns(1:ndir, 1) = along(1:ndir)
        if (ndir == 2) return
        columns(1, 2) = normal(2) * along(3) - normal(3) * along(2)
        columns(2, 2) = normal(3) * along(1) - normal(1) * along(3)
        columns(3, 2) = normal(1) * along(2) - normal(2) * along(1)
    end function tangential_axes

    !> The law's tangential axis 1: the projection of the global x axis on the surface, or of z
    !> where x is the normal. So Abaqus chooses axes, too.
    pure function surface_axis(ndir, normal) result(along)
        integer, intent(in) :: ndir
        real(wp), intent(in) :: normal(3)
        real(wp) :: along(3)
        real(wp), parameter :: within = 1.75e-3_wp   ! a tenth of a degree
        integer :: axis

        along = 0.0_wp
        if (ndir == 2) then
            along(1) = normal(2)
            along(2) = -normal(1)
            return
        end if
        axis = 1
        if (hypot(normal(2), normal(3)) < within) axis = 3
        along = -normal(axis) * normal
        along(axis) = along(axis) + 1.0_wp
        along = along / norm2(along)
    end function surface_axis

end module friction_explicit
