!> Abaqus/Standard UMAT: the contact as a thin layer of solid or cohesive elements.
!>
!>     *USER MATERIAL, CONSTANTS=11, UNSYMM   thickness, in-plane modulus, then the constants of
!>     *DEPVAR 8                               `friction_update`
!>
!> gap = thickness * strain, traction = stress; tension positive. The layer's normal is local axis 3
!> of a solid (ntens 6), local axis 2 in plane strain (ntens 4), and the first component of a
!> cohesive element (ntens 2 or 3). Under NLGEOM a layer of solid elements, without *ORIENTATION,
!> may slide as far as it likes, as its strain increments are those of the deformed layer; but it
!> must not turn.
!>
!> In a linear perturbation step the layer has the stiffness of the base state, moves elastically
!> from where it stands, and keeps its state.
subroutine stickslip_umat(stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, &
    drpldt, stran, dstran, time, dtime, temp, dtemp, predef, dpred, cmname, ndi, nshr, ntens, &
    nstatv, props, nprops, coords, drot, pnewdt, celent, dfgrd0, dfgrd1, noel, npt, layer, kspt, &
    jstep, kinc)
    use friction_host, only : cut_factor, error_length, rotate_tangential, severity, &
        stdb_abqerr, usable
    use friction_kinds, only : wp
    use friction_layer, only : layer_error_text, layer_update, perturb_layer
    use friction_mod, only : friction_bad_size, friction_ok, statev_size
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
    integer, parameter :: large_displacements = 1   ! in jstep(3)
    integer, parameter :: perturbation = 1          ! in jstep(4)
    real(wp), parameter :: largest_tilt = 1.0e-3_wp
    real(wp) :: state(statev_size), change(6)
    integer :: status

    if (ndi == 3 .and. jstep(3) == large_displacements) then
        if (tilt() > largest_tilt) then
            call tell(-3, 'stickslip, UMAT: under NLGEOM a layer of solid elements has turned ' &
                // 'out of its plane, and its normal is no longer the local axis; use cohesive ' &
                // 'elements or UINTER')
            return
        end if
    end if
    status = friction_bad_size
    if (nstatv >= statev_size) then
        state = statev(1:statev_size)
        if (jstep(4) == perturbation) then
            call perturb_layer(ndi, nshr, nprops, props, dstran, state, stress, ddsdde, change, &
                status)
            if (status >= 0) stress = stress + change(:ntens)
        else
            status = friction_ok
            if (ntens == 6) call rotate_tangential(spin_in_plane(drot), state, status)
            if (status >= 0) call layer_update(ndi, nshr, nprops, props, dstran, dtime, state, &
                stress, ddsdde, sse, spd, status)
        end if
    end if
    if (cut_factor(status) < 1.0_wp) pnewdt = min(pnewdt, cut_factor(status))
    if (status < 0) then
        ! in a perturbation there is no step to cut
        call tell(merge(-3, severity(status), jstep(4) == perturbation), &
            layer_error_text(status, props))
    else
        statev(1:statev_size) = state
    end if

contains

    !> How far the fibres of the layer's plane have turned towards its normal. What is no number is
    !> for the update to tell.
    pure function tilt()
        real(wp) :: tilt
        integer :: normal

        normal = nshr / 2 + 2   ! 3 in space, 2 in plane strain
        tilt = 0.0_wp
        if (.not. all(usable(dfgrd1(normal, 1:normal - 1)))) return
        tilt = maxval(abs(dfgrd1(normal, 1:normal - 1)))
    end function tilt

    !> The part of a rotation that is about the layer's normal. The rest comes of the shear, in
    !> which the layer's plane does not turn. What is no number stays none.
    pure function spin_in_plane(rotation) result(spin)
        real(wp), intent(in) :: rotation(3, 3)
        real(wp) :: spin(2, 2)
        real(wp) :: cosine, sine, length

        spin = huge(spin)
        if (.not. all(usable(rotation))) return
        cosine = rotation(1, 1) + rotation(2, 2)
        sine = rotation(2, 1) - rotation(1, 2)
        length = hypot(cosine, sine)
        if (.not. length > 0.0_wp) then
            cosine = 1.0_wp
            length = 1.0_wp
        end if
        spin(1, 1) = cosine / length
        spin(2, 1) = sine / length
        spin(1, 2) = -spin(2, 1)
        spin(2, 2) = spin(1, 1)
    end function spin_in_plane

    subroutine tell(lop, cause)
        integer, intent(in) :: lop   !! kind of the message
        character(len=*), intent(in) :: cause
        character(len=error_length) :: text

        text = cause
        call stdb_abqerr(lop, text, [noel, npt], time, [cmname(1:8)])
    end subroutine tell

end subroutine stickslip_umat
