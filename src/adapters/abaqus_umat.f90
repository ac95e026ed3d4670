!> Abaqus/Standard UMAT: the contact as a thin layer of solid or cohesive elements.
!>
!>     *USER MATERIAL, CONSTANTS=11, UNSYMM   thickness, in-plane modulus, then the constants of
!>     *DEPVAR 8                               `friction_update`
!>
!> gap = thickness * strain, traction = stress; tension positive. The layer's normal is local axis 3
!> of a solid (ntens 6), local axis 2 in plane strain (ntens 4), and the first component of a
!> cohesive element (ntens 2 or 3).
subroutine umat(stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, dstran, &
    time, dtime, temp, dtemp, predef, dpred, cmname, ndi, nshr, ntens, nstatv, props, nprops, &
    coords, drot, pnewdt, celent, dfgrd0, dfgrd1, noel, npt, layer, kspt, jstep, kinc)
    use friction_host, only : cut_factor, error_text, rotate_tangential, stdb_abqerr
    use friction_kinds, only : wp
    use friction_layer, only : layer_update
    use friction_mod, only : friction_bad_size, friction_no_convergence, statev_size
    implicit none
    integer, intent(in) :: ndi, nshr, ntens           !! direct, shear and all components
    integer, intent(in) :: nstatv, nprops, noel, npt, layer, kspt, jstep(4), kinc
    real(wp), intent(inout) :: stress(ntens)          !! start in, end out [F/L^2]
    real(wp), intent(inout) :: statev(nstatv)         !! state of the friction routine
    real(wp), intent(inout) :: ddsdde(ntens, ntens)   !! d(stress)/d(dstran) [F/L^2]
    real(wp), intent(inout) :: sse, spd, scd   !! energy per volume: elastic, dissipated [F/L^2]
    real(wp), intent(inout) :: rpl, ddsddt(ntens), drplde(ntens), drpldt, pnewdt
    real(wp), intent(in) :: stran(ntens), dstran(ntens), dtime
    real(wp), intent(in) :: props(nprops), drot(3, 3)
    real(wp), intent(in) :: time(2), temp, dtemp, predef(*), dpred(*), coords(3), celent, &
        dfgrd0(3, 3), dfgrd1(3, 3)
    character(len=80), intent(in) :: cmname
    real(wp) :: state(statev_size)
    integer :: status

    status = friction_bad_size
    if (nstatv >= statev_size) then
        state = statev(1:statev_size)
        if (ntens == 6) call rotate_tangential(drot(1:2, 1:2), state)
        call layer_update(ndi, nshr, props, dstran, dtime, state, stress, ddsdde, sse, spd, status)
    end if
    if (status < 0 .and. status /= friction_no_convergence) then
        call stdb_abqerr(-3, error_text('UMAT', status), [noel, npt], time, [cmname(1:8)])
        return
    end if
    if (cut_factor(status) < 1.0_wp) pnewdt = min(pnewdt, cut_factor(status))
    if (status >= 0) statev(1:statev_size) = state
end subroutine umat
