!> The name that Abaqus/Explicit looks for. Left out, it is free for a routine of the user's own.
subroutine vfriction(ftangential, state, nblock, nblockanal, nblockedge, nnodstate, &
    nnodslv, nnodmst, nfricdir, ndir, nstates, nprops, ntemp, nfields, jflags, rdata, surfint, &
    surfslv, surfmst, jconslvuid, jconmstuid, props, dslipfric, fstickforce, ftangprev, &
    fnormal, areacont, dircosn, dircossl, shapeslv, shapemst, coordslv, coordmst, velslv, &
    velmst, tempslv, tempmst, fieldslv, fieldmst)
    use friction_kinds, only : wp
    implicit none
    integer, intent(in) :: nblock, nblockanal, nblockedge, nnodstate, nnodslv, nnodmst, &
        nfricdir, ndir, nstates, nprops, ntemp, nfields
    integer, intent(in) :: jflags(*), jconslvuid(*), jconmstuid(*)
    real(wp), intent(inout) :: ftangential(*), state(*)
    real(wp), intent(in) :: rdata(*), props(*), dslipfric(*), fstickforce(*), &
        ftangprev(*), fnormal(*), areacont(*), dircosn(*), dircossl(*), shapeslv(*), &
        shapemst(*), coordslv(*), coordmst(*), velslv(*), velmst(*), tempslv(*), tempmst(*), &
        fieldslv(*), fieldmst(*)
    character(len=80), intent(in) :: surfint, surfslv, surfmst
    external :: stickslip_vfriction

    call stickslip_vfriction(ftangential, state, nblock, nblockanal, nblockedge, &
        nnodstate, nnodslv, nnodmst, nfricdir, ndir, nstates, nprops, ntemp, nfields, jflags, &
        rdata, surfint, surfslv, surfmst, jconslvuid, jconmstuid, props, dslipfric, &
        fstickforce, ftangprev, fnormal, areacont, dircosn, dircossl, shapeslv, shapemst, &
        coordslv, coordmst, velslv, velmst, tempslv, tempmst, fieldslv, fieldmst)
end subroutine vfriction
