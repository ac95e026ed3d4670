!> Kratos UMAT: the constitutive law of the interface elements `UPwSmallStrainInterfaceElement2D4N`
!> and `...3D8N`, loaded from libstickslip_kratos.so by `SmallStrainUMAT2DInterfaceLaw` and
!> `...3DInterfaceLaw`:
!>
!>     "UDSM_NAME": "libstickslip_kratos.so", "IS_FORTRAN_UDSM": true,
!>     "UMAT_PARAMETERS": [the constants of `friction_update`], "STATE_VARIABLES": [0, ... eight]
!>
!> These elements pass half the gap as strain and take twice the traction as stress. Normal in place
!> 3, shear along x in 6, along y (in space) in 5. Many arguments are NULL and are not touched.
subroutine umat(stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, dstran, &
    time, dtime, temp, dtemp, predef, dpred, cmname, ndi, nshr, ntens, nstatv, props, nprops, &
    coords, drot, pnewdt, celent, dfgrd0, dfgrd1, noel, npt, layer, kspt, jstep, kinc)
    use friction_host, only : error_text, hold_touching, host_update
    use friction_host_end, only : end_host, to_errors
    use friction_kinds, only : wp
    use friction_mod, only : friction_bad_size, statev_size
    implicit none
    integer, intent(in) :: ndi, nshr, ntens           !! ntens 6
    integer, intent(in) :: nstatv, nprops
    real(wp), intent(inout) :: stress(ntens)          !! out: twice the traction [F/L^2]
    real(wp), intent(inout) :: statev(nstatv)         !! state of the friction routine
    real(wp), intent(inout) :: ddsdde(ntens, ntens)   !! d(stress)/d(dstran) [F/L^3]
    real(wp), intent(in) :: dstran(ntens)             !! half the increment of the gap [L]
    real(wp), intent(in) :: dtime, props(nprops)
    ! not touched, and often NULL:
    real(wp), intent(in) :: sse, spd, scd, rpl, ddsddt(*), drplde(*), drpldt, stran(*), time(*), &
        temp, dtemp, predef(*), dpred(*), coords(*), drot(*), pnewdt, celent, dfgrd0(*), dfgrd1(*)
    integer, intent(in) :: noel, npt, layer, kspt, jstep, kinc
    character(len=*), intent(in) :: cmname            ! this host passes no length
    integer, parameter :: places(3) = [3, 6, 5]       ! normal, along x, along y
    real(wp) :: du(3), traction(3), tangent(3, 3)
    integer :: status, i, j

    status = friction_bad_size
    if (ntens == 6 .and. nstatv >= statev_size) then
        do i = 1, 3
            du(i) = 2.0_wp * dstran(places(i))
        end do
        call host_update(3, du, dtime, nprops, props, statev, traction, tangent, status)
    end if
    ! this host has no way to cut the step or to be told of an error
    if (status < 0) call end_host(error_text('Kratos UMAT', status, props), to_errors, 1)
    call hold_touching(3, du, 0.0_wp, props, statev, tangent)
    stress = 0.0_wp
    ddsdde = 0.0_wp
    do j = 1, 3
        stress(places(j)) = 2.0_wp * traction(j)
        do i = 1, 3
            ddsdde(places(i), places(j)) = 4.0_wp * tangent(i, j)
        end do
    end do
end subroutine umat
