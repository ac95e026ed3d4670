!> Abaqus/Standard UINTER: the whole of a contact point, normal and tangential.
!>
!>     *SURFACE INTERACTION, USER, DEPVAR=8, PROPERTIES=9, UNSYMM   with the constants of
!> `friction_update`
!>
!> Abaqus counts compression and penetration positive: the first component changes its sign.
subroutine stickslip_uinter(stress, ddsddr, amki, amski, flux, ddfddt, ddsddt, ddfddr, &
    statev, sed, sfd, spd, svd, scd, pnewdt, rdisp, drdisp, temp, dtemp, predef, dpred, time, &
    dtime, freqr, ciname, slname, msname, props, coords, alocaldir, drot, area, chrlngth, node, &
    ndir, nstatv, npred, nprops, mcrd, kstep, kinc, kit, linper, lopenclose, lstate, lsdi, &
    lprint)
    use friction_contact, only : point_open
    use friction_host, only : cut_factor, elastic_energy, error_text, hold_touching, &
        host_update, interface_update, rotate_tangential, severity, stdb_abqerr, usable
    use friction_kinds, only : wp
    use friction_mod, only : friction_bad_size, friction_ok, statev_dissipation, statev_size, &
        statev_status, statev_u_et, statev_u_n
    implicit none
    integer, intent(in) :: ndir                   !! components, 2 or 3
    integer, intent(in) :: nstatv, npred, nprops, mcrd
    real(wp), intent(inout) :: stress(ndir)       !! normal, tangential; end out [F/L^2]
    real(wp), intent(inout) :: ddsddr(ndir, ndir) !! d(stress)/d(rdisp) [F/L^3]
    real(wp), intent(inout) :: amki(ndir, ndir), amski(ndir, ndir), flux(2), ddfddt(2, 2), &
        ddsddt(ndir, 2), ddfddr(2, ndir)
    real(wp), intent(inout) :: statev(nstatv)     !! state of the friction routine
    real(wp), intent(inout) :: sed                !! elastic energy at the end [F/L]
    real(wp), intent(inout) :: sfd, spd, svd, scd !! dissipation in the increment, by kind [F/L]
    real(wp), intent(inout) :: pnewdt
    real(wp), intent(in) :: rdisp(ndir)           !! relative position at the end [L]
    real(wp), intent(in) :: drdisp(ndir)          !! its increment [L]
    real(wp), intent(in) :: dtime                 !! [T]
    real(wp), intent(in) :: props(nprops)         !! constants of the friction routine
    real(wp), intent(in) :: drot(2, 2)            !! rotation of the surface axes in the increment
    real(wp), intent(in) :: temp(2), dtemp(2), predef(2, npred), dpred(2, npred), time(2), freqr, &
        coords(mcrd), alocaldir(mcrd, mcrd), area, chrlngth
    integer, intent(in) :: node, kstep, kinc, kit, linper, lprint
    integer, intent(inout) :: lopenclose          !! out: 0 open, 1 closed
    integer, intent(inout) :: lstate              !! out: status of the friction routine's point
    integer, intent(inout) :: lsdi                !! out: 1 if the point has opened or closed
    character(len=80), intent(in) :: ciname, slname, msname
    integer, parameter :: perturbation = 1
    real(wp) :: state(statev_size), dissipated, second
    integer :: status, now

    if (linper == perturbation) then
        call base_stiffness()
        return
    end if
    status = friction_bad_size
    if (nstatv >= statev_size) then
        state = statev(1:statev_size)
        dissipated = state(statev_dissipation)
        status = friction_ok
        if (ndir == 3) call rotate_tangential(drot, state, status)
        if (status >= 0) call interface_update(ndir, rdisp, drdisp, dtime, props, state, stress, &
            ddsddr, status)
        if (status >= 0) call hold_touching(ndir, drdisp, gap_of_none(), props, state, ddsddr)
    end if
    if (cut_factor(status) < 1.0_wp) pnewdt = min(pnewdt, cut_factor(status))
    if (status < 0) then
        call stdb_abqerr(severity(status), error_text('UINTER', status, props), [node], time, &
            [ciname(1:8)])
        return
    end if

    second = 0.0_wp
    if (ndir == 3) second = state(statev_u_et + 1)
    sed = elastic_energy(props, state(statev_u_n), state(statev_u_et), second)
    sfd = state(statev_dissipation) - dissipated
    spd = 0.0_wp
    svd = 0.0_wp
    scd = 0.0_wp
    lstate = nint(state(statev_status))
    now = merge(0, 1, lstate == point_open)
    lsdi = merge(1, 0, lopenclose >= 0 .and. lopenclose /= now)
    lopenclose = now
    statev(1:statev_size) = state

contains

    !> The gap that round-off of coordinates, up to some 1e6 elements from their origin, leaves
    !> between surfaces that share them.
    pure function gap_of_none() result(gap)
        real(wp) :: gap
        real(wp), parameter :: share = 1.0e-9_wp   ! of an element's length

        gap = 0.0_wp
        if (usable(chrlngth)) gap = share * max(chrlngth, 0.0_wp)
    end function gap_of_none

    !> A linear perturbation step asks for the stiffness of the base state: about it the contact
    !> moves without time, nothing of it changes, and no friction follows the pressure.
    subroutine base_stiffness()
        real(wp) :: base(statev_size), traction(3), tangent(9), still(3)

        status = friction_bad_size
        still = 0.0_wp
        if (nstatv >= statev_size) then
            base = statev(1:statev_size)
            call host_update(ndir, still, 0.0_wp, nprops, props, base, traction, tangent, status)
        end if
        if (status < 0) then
            call stdb_abqerr(-3, error_text('UINTER', status, props), [node], time, [ciname(1:8)])
            return
        end if
        if (nint(statev(statev_status)) == point_open) then   ! a virgin point's gap is not known
            call hold_touching(ndir, still, gap_of_none(), props, base, tangent)
        end if
        ddsddr(1:ndir, 1:ndir) = reshape(tangent(1:ndir**2), [ndir, ndir])
    end subroutine base_stiffness

end subroutine stickslip_uinter
