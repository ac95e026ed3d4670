!> The name that Abaqus/Explicit looks for. Left out, it is free for a routine of the user's own.
subroutine vuinter(sfd, scd, spd, svd, stress, fluxslv, fluxmst, sed, statev, kstep, kinc, &
    nfacnod, nslvnod, nmstnod, nsurfdir, ndir, nstatevar, nprops, ntemp, npred, numdeftfv, &
    jslvuid, jmstuid, jconmstid, timstep, timglb, dtimcur, surfint, surfslv, surfmst, rdisp, &
    drdisp, drot, stiffdflt, conddflt, shape, coordslv, coordmst, alocaldir, props, areaslv, &
    tempslv, dtempslv, predefslv, dpredefslv, tempmst, dtempmst, predefmst, dpredefmst)
    use friction_kinds, only : wp
    implicit none
    integer, intent(in) :: kstep, kinc, nfacnod, nslvnod, nmstnod, nsurfdir, ndir, &
        nstatevar, nprops, ntemp, npred, numdeftfv
    integer, intent(in) :: jslvuid(*), jmstuid(*), jconmstid(*)
    real(wp), intent(inout) :: sfd(*), scd(*), spd(*), svd(*), stress(*), sed(*), &
        statev(*)
    real(wp), intent(in) :: timstep, timglb, dtimcur, stiffdflt, conddflt
    real(wp), intent(in) :: fluxslv(*), fluxmst(*), rdisp(*), drdisp(*), drot(*), &
        shape(*), coordslv(*), coordmst(*), alocaldir(*), props(*), areaslv(*), tempslv(*), &
        dtempslv(*), predefslv(*), dpredefslv(*), tempmst(*), dtempmst(*), predefmst(*), &
        dpredefmst(*)
    character(len=80), intent(in) :: surfint, surfslv, surfmst
    external :: stickslip_vuinter

    call stickslip_vuinter(sfd, scd, spd, svd, stress, fluxslv, fluxmst, sed, statev, &
        kstep, kinc, nfacnod, nslvnod, nmstnod, nsurfdir, ndir, nstatevar, nprops, ntemp, &
        npred, numdeftfv, jslvuid, jmstuid, jconmstid, timstep, timglb, dtimcur, surfint, &
        surfslv, surfmst, rdisp, drdisp, drot, stiffdflt, conddflt, shape, coordslv, coordmst, &
        alocaldir, props, areaslv, tempslv, dtempslv, predefslv, dpredefslv, tempmst, &
        dtempmst, predefmst, dpredefmst)
end subroutine vuinter
