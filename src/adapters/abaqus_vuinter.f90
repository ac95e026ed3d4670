!> Abaqus/Explicit VUINTER: the whole of a surface's contact points. Run the job with `double=both`.
!>
!>     *SURFACE INTERACTION, USER, DEPVAR=8, PROPERTIES=9   with the constants of `friction_update`
!>
!> Abaqus counts compression and penetration positive: the first component changes its sign.
subroutine stickslip_vuinter(sfd, scd, spd, svd, stress, fluxslv, fluxmst, sed, statev, &
    kstep, kinc, nfacnod, nslvnod, nmstnod, nsurfdir, ndir, nstatevar, nprops, ntemp, npred, &
    numdeftfv, jslvuid, jmstuid, jconmstid, timstep, timglb, dtimcur, surfint, surfslv, surfmst, &
    rdisp, drdisp, drot, stiffdflt, conddflt, shape, coordslv, coordmst, alocaldir, props, &
    areaslv, tempslv, dtempslv, predefslv, dpredefslv, tempmst, dtempmst, predefmst, dpredefmst)
    use friction_host, only : elastic_energy, error_text, interface_update, rotate_tangential, &
        xplb_abqerr
    use friction_kinds, only : wp
    use friction_mod, only : friction_bad_size, friction_ok, friction_zero_time_increment, &
        statev_dissipation, statev_size, statev_u_et, statev_u_n
    implicit none
    integer, intent(in) :: nslvnod                         !! points
    integer, intent(in) :: ndir                            !! components, 2 or 3
    integer, intent(in) :: nstatevar, nprops, kstep, kinc, nfacnod, nmstnod, nsurfdir, ntemp, &
        npred, numdeftfv
    real(wp), intent(inout) :: sfd(nslvnod)                !! dissipation in the increment [F/L]
    real(wp), intent(inout) :: sed(nslvnod)                !! elastic energy at the end [F/L]
    real(wp), intent(inout) :: scd(nslvnod), spd(nslvnod), svd(nslvnod)
    real(wp), intent(inout) :: stress(ndir, nslvnod)       !! normal, tangential; end out [F/L^2]
    real(wp), intent(inout) :: statev(nstatevar, nslvnod)  !! state of the friction routine
    real(wp), intent(in) :: rdisp(ndir, nslvnod)           !! relative position at the end [L]
    real(wp), intent(in) :: drdisp(ndir, nslvnod)          !! its increment [L]
    real(wp), intent(in) :: drot(2, 2, nslvnod)            !! rotation of the surface axes
    real(wp), intent(in) :: dtimcur                        !! [T]
    real(wp), intent(in) :: props(nprops)                  !! constants of the friction routine
    real(wp), intent(in) :: timstep, timglb, stiffdflt, conddflt
    real(wp), intent(in) :: fluxslv(*), fluxmst(*), shape(*), coordslv(*), coordmst(*), &
        alocaldir(*), areaslv(*), tempslv(*), dtempslv(*), predefslv(*), dpredefslv(*), &
        tempmst(*), dtempmst(*), predefmst(*), dpredefmst(*)
    integer, intent(in) :: jslvuid(*), jmstuid(*), jconmstid(*)
    character(len=80), intent(in) :: surfint, surfslv, surfmst
    real(wp) :: state(statev_size), stiffness(9), no_motion(3), dissipated, second
    integer :: i, status

    no_motion = 0.0_wp
    do i = 1, nslvnod
        status = friction_bad_size
        if (nstatevar >= statev_size) then
            state = statev(1:statev_size, i)
            dissipated = state(statev_dissipation)
            status = friction_ok
            if (ndir == 3) call rotate_tangential(drot(:, :, i), state, status)
            if (status >= 0) call interface_update(ndir, rdisp(:, i), drdisp(:, i), dtimcur, &
                props, state, stress(:, i), stiffness, status)
            ! where no time has passed nothing has slid, whatever the host moved into place
            if (status == friction_zero_time_increment) call interface_update(ndir, &
                rdisp(:, i), no_motion, dtimcur, props, state, stress(:, i), stiffness, status)
        end if
        if (status < 0) then
            call xplb_abqerr(-3, error_text('VUINTER', status, props), jslvuid(i:i), [timglb], &
                [surfint(1:8)])
            return
        end if
        second = 0.0_wp
        if (ndir == 3) second = state(statev_u_et + 1)
        sed(i) = elastic_energy(props, state(statev_u_n), state(statev_u_et), second)
        sfd(i) = state(statev_dissipation) - dissipated
        scd(i) = 0.0_wp
        spd(i) = 0.0_wp
        svd(i) = 0.0_wp
        statev(1:statev_size, i) = state
    end do
end subroutine stickslip_vuinter
