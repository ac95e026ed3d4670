!> The name that Abaqus/Standard looks for. Left out, it is free for a routine of the user's own.
subroutine uinter(stress, ddsddr, amki, amski, flux, ddfddt, ddsddt, ddfddr, statev, sed, &
    sfd, spd, svd, scd, pnewdt, rdisp, drdisp, temp, dtemp, predef, dpred, time, dtime, freqr, &
    ciname, slname, msname, props, coords, alocaldir, drot, area, chrlngth, node, ndir, &
    nstatv, npred, nprops, mcrd, kstep, kinc, kit, linper, lopenclose, lstate, lsdi, lprint)
    use friction_kinds, only : wp
    implicit none
    integer, intent(inout) :: lopenclose, lstate, lsdi
    integer, intent(in) :: node, ndir, nstatv, npred, nprops, mcrd, kstep, kinc, kit, &
        linper, lprint
    real(wp), intent(inout) :: sed, sfd, spd, svd, scd, pnewdt
    real(wp), intent(inout) :: stress(*), ddsddr(*), amki(*), amski(*), flux(*), &
        ddfddt(*), ddsddt(*), ddfddr(*), statev(*)
    real(wp), intent(in) :: dtime, freqr, area, chrlngth
    real(wp), intent(in) :: rdisp(*), drdisp(*), temp(*), dtemp(*), predef(*), dpred(*), &
        time(*), props(*), coords(*), alocaldir(*), drot(*)
    character(len=80), intent(in) :: ciname, slname, msname
    external :: stickslip_uinter

    call stickslip_uinter(stress, ddsddr, amki, amski, flux, ddfddt, ddsddt, ddfddr, &
        statev, sed, sfd, spd, svd, scd, pnewdt, rdisp, drdisp, temp, dtemp, predef, dpred, &
        time, dtime, freqr, ciname, slname, msname, props, coords, alocaldir, drot, area, &
        chrlngth, node, ndir, nstatv, npred, nprops, mcrd, kstep, kinc, kit, linper, &
        lopenclose, lstate, lsdi, lprint)
end subroutine uinter
