!> The name that Abaqus/Standard looks for. Left out, it is free for a routine of the user's own.
subroutine umat(stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, &
    dstran, time, dtime, temp, dtemp, predef, dpred, cmname, ndi, nshr, ntens, nstatv, props, &
    nprops, coords, drot, pnewdt, celent, dfgrd0, dfgrd1, noel, npt, layer, kspt, jstep, kinc)
    use friction_kinds, only : wp
    implicit none
    integer, intent(in) :: ndi, nshr, ntens, nstatv, nprops, noel, npt, layer, kspt, kinc
    integer, intent(in) :: jstep(*)
    real(wp), intent(inout) :: sse, spd, scd, rpl, drpldt, pnewdt
    real(wp), intent(inout) :: stress(*), statev(*), ddsdde(*), ddsddt(*), drplde(*)
    real(wp), intent(in) :: dtime, temp, dtemp, celent
    real(wp), intent(in) :: stran(*), dstran(*), time(*), predef(*), dpred(*), props(*), &
        coords(*), drot(*), dfgrd0(*), dfgrd1(*)
    character(len=80), intent(in) :: cmname
    external :: stickslip_umat

    call stickslip_umat(stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, &
        drpldt, stran, dstran, time, dtime, temp, dtemp, predef, dpred, cmname, ndi, nshr, &
        ntens, nstatv, props, nprops, coords, drot, pnewdt, celent, dfgrd0, dfgrd1, noel, npt, &
        layer, kspt, jstep, kinc)
end subroutine umat
