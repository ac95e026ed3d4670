!> The name that Abaqus/Explicit looks for. Left out, it is free for a routine of the user's own.
subroutine vfric(ftangential, statev, kstep, kinc, ncontact, nfacnod, nslvnod, nmstnod, &
    nfricdir, ndir, nstatevar, nprops, ntemp, npred, numdeftfv, jslvuid, jmstuid, jconslvid, &
    jconmstid, timstep, timglb, dtimprev, surfint, surfslv, surfmst, lconttype, dslipfric, &
    fstickforce, ftangprev, fnormal, frictionwork, shape, coordslv, coordmst, dircossl, &
    dircosn, props, areaslv, tempslv, predefslv, tempmst, predefmst)
    use friction_kinds, only : wp
    implicit none
    integer, intent(in) :: kstep, kinc, ncontact, nfacnod, nslvnod, nmstnod, nfricdir, &
        ndir, nstatevar, nprops, ntemp, npred, numdeftfv, lconttype
    integer, intent(in) :: jslvuid(*), jmstuid(*), jconslvid(*), jconmstid(*)
    real(wp), intent(inout) :: ftangential(*), statev(*)
    real(wp), intent(in) :: timstep, timglb, dtimprev, frictionwork
    real(wp), intent(in) :: dslipfric(*), fstickforce(*), ftangprev(*), fnormal(*), &
        shape(*), coordslv(*), coordmst(*), dircossl(*), dircosn(*), props(*), areaslv(*), &
        tempslv(*), predefslv(*), tempmst(*), predefmst(*)
    character(len=80), intent(in) :: surfint, surfslv, surfmst
    external :: stickslip_vfric

    call stickslip_vfric(ftangential, statev, kstep, kinc, ncontact, nfacnod, nslvnod, &
        nmstnod, nfricdir, ndir, nstatevar, nprops, ntemp, npred, numdeftfv, jslvuid, jmstuid, &
        jconslvid, jconmstid, timstep, timglb, dtimprev, surfint, surfslv, surfmst, lconttype, &
        dslipfric, fstickforce, ftangprev, fnormal, frictionwork, shape, coordslv, coordmst, &
        dircossl, dircosn, props, areaslv, tempslv, predefslv, tempmst, predefmst)
end subroutine vfric
