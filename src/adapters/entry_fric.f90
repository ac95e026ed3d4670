!> The name that Abaqus/Standard looks for. Left out, it is free for a routine of the user's own.
subroutine fric(lm, tau, ddtddg, ddtddp, dslip, sed, sfd, ddtddt, pnewdt, statev, dgam, &
    taulm, press, dpress, ddpddh, slip, kstep, kinc, time, dtime, noel, ciname, slname, &
    msname, npt, node, npatch, coords, rcoord, drot, temp, predef, nfdir, mcrd, npred, nstatv, &
    chrlngth, props, nprops)
    use friction_kinds, only : wp
    implicit none
    integer, intent(inout) :: lm
    integer, intent(in) :: kstep, kinc, noel, npt, node, npatch, nfdir, mcrd, npred, &
        nstatv, nprops
    real(wp), intent(inout) :: sed, sfd, pnewdt
    real(wp), intent(inout) :: tau(*), ddtddg(*), ddtddp(*), dslip(*), ddtddt(*), &
        statev(*)
    real(wp), intent(in) :: press, dpress, ddpddh, dtime, chrlngth
    real(wp), intent(in) :: dgam(*), taulm(*), slip(*), time(*), coords(*), rcoord(*), &
        drot(*), temp(*), predef(*), props(*)
    character(len=80), intent(in) :: ciname, slname, msname
    external :: stickslip_fric

    call stickslip_fric(lm, tau, ddtddg, ddtddp, dslip, sed, sfd, ddtddt, pnewdt, statev, &
        dgam, taulm, press, dpress, ddpddh, slip, kstep, kinc, time, dtime, noel, ciname, &
        slname, msname, npt, node, npatch, coords, rcoord, drot, temp, predef, nfdir, mcrd, &
        npred, nstatv, chrlngth, props, nprops)
end subroutine fric
