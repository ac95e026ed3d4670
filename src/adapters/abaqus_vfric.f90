!> Abaqus/Explicit VFRIC: friction forces of the closed points of a surface. Run the job with
!> `double=both`.
!>
!>     *FRICTION, USER, DEPVAR=8, PROPERTIES=9   with the constants of `friction_update`
!>
!> The local axes turn with the slip from call to call. So statev(2:4) holds the elastic tangential
!> displacement as a vector in global axes; the normal displacement is Abaqus's own. Nothing tells
!> axes of the surface: orthotropic friction is refused in three dimensions.
subroutine vfric(ftangential, statev, kstep, kinc, ncontact, nfacnod, nslvnod, nmstnod, nfricdir, &
    ndir, nstatevar, nprops, ntemp, npred, numdeftfv, jslvuid, jmstuid, jconslvid, jconmstid, &
    timstep, timglb, dtimprev, surfint, surfslv, surfmst, lconttype, dslipfric, fstickforce, &
    ftangprev, fnormal, frictionwork, shape, coordslv, coordmst, dircossl, dircosn, props, &
    areaslv, tempslv, predefslv, tempmst, predefmst)
    use friction_host, only : error_text, xplb_abqerr
    use friction_kinds, only : wp
    use friction_mod, only : friction_bad_axis, friction_bad_size, friction_is_orthotropic, &
        friction_tangential, statev_size, statev_u_et, statev_u_n
    implicit none
    integer, intent(in) :: ncontact                            !! points in contact
    integer, intent(in) :: nslvnod                             !! points of the surface
    integer, intent(in) :: nfricdir                            !! tangential directions, 1 or 2
    integer, intent(in) :: ndir                                !! components, 2 or 3
    integer, intent(in) :: nstatevar, nprops, kstep, kinc, nfacnod, nmstnod, ntemp, npred, &
        numdeftfv, lconttype
    real(wp), intent(inout) :: ftangential(nfricdir, ncontact)   !! out, local axes: against the
                                                                 !! slip [F]
    real(wp), intent(inout) :: statev(nstatevar, nslvnod)      !! state of the friction routine
    integer, intent(in) :: jconslvid(ncontact)   !! place of the contact points in the surface
    real(wp), intent(in) :: dslipfric(ndir, ncontact)          !! slip increment, local axes [L]
    real(wp), intent(in) :: fstickforce(ncontact)   !! force that would prevent the slip [F]
    real(wp), intent(in) :: ftangprev(ndir, ncontact)          !! friction force before [F]
    real(wp), intent(in) :: fnormal(ncontact)                  !! normal force [F]
    real(wp), intent(in) :: dircossl(ndir, ncontact)   !! local axis 1, along the slip, in global
                                                       !! axes
    real(wp), intent(in) :: dircosn(ndir, ncontact)   !! normal of the master, in global axes
    real(wp), intent(in) :: areaslv(nslvnod)                   !! area of a point [L^2]
    real(wp), intent(in) :: dtimprev                           !! [T]
    real(wp), intent(in) :: props(nprops)                      !! constants of the friction routine
    real(wp), intent(in) :: timstep, timglb, frictionwork
    real(wp), intent(in) :: shape(*), coordslv(*), coordmst(*), tempslv(*), predefslv(*), &
        tempmst(*), predefmst(*)
    integer, intent(in) :: jslvuid(*), jmstuid(*), jconmstid(*)
    character(len=80), intent(in) :: surfint, surfslv, surfmst
    real(wp) :: tau(nfricdir), dtau_du(nfricdir, nfricdir), dtau_dp(nfricdir), area
    real(wp) :: axes(ndir, nfricdir), state(statev_size), no_slip(nfricdir)
    logical :: in_contact(nslvnod)
    integer :: c, i, status

    status = friction_bad_size
    if (nstatevar < statev_size .or. nfricdir /= ndir - 1) then
        call refuse(0)
        return
    end if
    status = friction_bad_axis
    if (nfricdir > 1 .and. friction_is_orthotropic(props)) then
        call refuse(0)
        return
    end if

    in_contact = .false.
    do c = 1, ncontact
        i = jconslvid(c)
        area = areaslv(i)
        in_contact(i) = area > 0.0_wp
        ftangential(:, c) = 0.0_wp
        if (.not. in_contact(i)) cycle
        axes = local_axes(dircossl(:, c), dircosn(:, c))
        call load_state(i)
        call friction_tangential(dslipfric(1:nfricdir, c), fnormal(c) / area, dtimprev, props, &
            state, tau, dtau_du, dtau_dp, status)
        if (status < 0) then
            call refuse(i)
            return
        end if
        call store_state(i)
        ftangential(:, c) = -tau * area
        ! the host takes what opposes the slip, and no more than prevents it
        ftangential(1, c) = min(max(ftangential(1, c), -fstickforce(c)), 0.0_wp)
    end do

    ! points out of contact carry nothing and heal
    axes = 0.0_wp
    no_slip = 0.0_wp
    do i = 1, nslvnod
        if (in_contact(i)) cycle
        call load_state(i)
        call friction_tangential(no_slip, 0.0_wp, dtimprev, props, state, tau, dtau_du, &
            dtau_dp, status)
        if (status < 0) then
            call refuse(i)
            return
        end if
        call store_state(i)
    end do

contains

    !> Tangential axes as columns: along the slip, and in space at right angles to it and the
    !> normal.
    pure function local_axes(along, normal) result(columns)
        real(wp), intent(in) :: along(ndir), normal(ndir)
        real(wp) :: columns(ndir, nfricdir)

        columns(:, 1) = along
        if (ndir == 3) columns(:, 2) = [normal(2) * along(3) - normal(3) * along(2), &
            normal(3) * along(1) - normal(1) * along(3), &
            normal(1) * along(2) - normal(2) * along(1)]
    end function local_axes

    !> State with the elastic displacement in local axes.
    subroutine load_state(point)
        integer, intent(in) :: point

        state = statev(1:statev_size, point)
        state(statev_u_n:statev_u_et + 1) = 0.0_wp
        state(statev_u_et:statev_u_et + nfricdir - 1) = &
            matmul(statev(statev_u_n:statev_u_n + ndir - 1, point), axes)
    end subroutine load_state

    !> And back in global axes.
    subroutine store_state(point)
        integer, intent(in) :: point

        statev(1:statev_size, point) = state
        statev(statev_u_n:statev_u_et + 1, point) = 0.0_wp
        statev(statev_u_n:statev_u_n + ndir - 1, point) = &
            matmul(axes, state(statev_u_et:statev_u_et + nfricdir - 1))
    end subroutine store_state

    subroutine refuse(point)
        integer, intent(in) :: point   !! in the surface; 0 for all

        call xplb_abqerr(-3, error_text('VFRIC', status), [point], [timglb], [surfint(1:8)])
    end subroutine refuse

end subroutine vfric
