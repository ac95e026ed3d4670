!> CalculiX UMAT: the contact as a thin layer of solid elements. Loaded from libSTICKSLIP.so:
!>
!>     *MATERIAL, NAME=@ABAQUS_STICKSLIP
!>     *USER MATERIAL, CONSTANTS=11    thickness, in-plane modulus, then the constants of
!>     *DEPVAR                         `friction_update`, eight a line
!>     8
!>
!> The layer's normal is local axis 3 (*ORIENTATION). CalculiX keeps the symmetric part of the
!> stiffness only; half of the coupling of friction to the pressure would mislead it, so the
!> coupling is left out of the stiffness (not of the stress).
!>
!> Under NLGEOM strain and stress are those of Green-Lagrange and Piola-Kirchhoff.
!>
!> In a perturbation step (*FREQUENCY) the layer is elastic about the base state, which stays.
subroutine umat(stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, dstran, &
    time, dtime, temp, dtemp, predef, dpred, cmname, ndi, nshr, ntens, nstatv, props, nprops, &
    coords, drot, pnewdt, celent, dfgrd0, dfgrd1, noel, npt, layer, kspt, jstep, kinc)
    use friction_host, only : append, append_number, cut_factor, error_length, usable, used_length
    use friction_host_end, only : end_host, to_output
    use friction_kinds, only : wp
    use friction_finite_layer, only : finite_layer_update
    use friction_layer, only : layer_error_text, layer_update, make_symmetric, perturb_layer
    use friction_mod, only : friction_bad_increment, friction_bad_size, statev_size
    implicit none
    integer, intent(in) :: ndi, nshr, ntens           !! 3, 3, 6: 11, 22, 33, 12, 13, 23
    integer, intent(in) :: nstatv, nprops, noel, npt, kinc
    integer, intent(in) :: jstep(4)                   !! (3): 1 under NLGEOM
    real(wp), intent(inout) :: stress(ntens)          !! start in, end out [F/L^2]
    real(wp), intent(inout) :: statev(nstatv)         !! state of the friction routine
    real(wp), intent(inout) :: ddsdde(ntens, ntens)   !! d(stress)/d(dstran) [F/L^2]
    real(wp), intent(inout) :: pnewdt                 !! any positive value makes CalculiX cut
    real(wp), intent(in) :: dstran(ntens), dtime, props(nprops)
    real(wp), intent(in) :: stran(ntens), time(2), temp, dtemp, coords(3), drot(3, 3), &
        dfgrd0(3, 3), dfgrd1(3, 3)
    real(wp), intent(in) :: sse, spd, scd, rpl, ddsddt(ntens), drplde(ntens), drpldt, predef(*), &
        dpred(*), celent
    integer, intent(in) :: layer, kspt   ! and these are not set by CalculiX
    character(len=80), intent(in) :: cmname
    character(len=*), parameter :: rotated = '@ABAQUSNL'
    integer, parameter :: large_displacements = 1     ! in jstep(3)
    integer, parameter :: perturbation = 1            ! in jstep(4)
    real(wp) :: state(statev_size), start(6), increment(6), change(6), dt, elastic, dissipated, &
        shear(2, 2)
    integer :: status
    logical :: perturbed, as_it_is   ! from the strain to itself

    if (cmname(1:len(rotated)) == rotated) call stop_with_cause('stickslip, UMAT: ' // rotated &
        // '_STICKSLIP hands over logarithmic strain, whose axes turn with the slip; write ' &
        // '@ABAQUS_STICKSLIP, with or without NLGEOM')
    ! At the start of a dynamic step CalculiX asks for the forces as they are: with a time before
    ! the step, any dtime, and the whole strain as its increment. So it asks for the stiffness that
    ! a perturbation step is about, and then for the stress of each mode, with that mode's strain.
    status = friction_bad_size
    perturbed = jstep(4) == perturbation
    as_it_is = time(1) < 0.0_wp .or. perturbed
    if (nstatv >= statev_size .and. ntens == 6) then
        state = statev(1:statev_size)
        increment = dstran
        dt = dtime
        if (as_it_is) then
            increment = 0.0_wp
            dt = 0.0_wp
        end if
        if (jstep(3) == large_displacements) then
            status = friction_bad_increment
            if (all(usable(stran) .and. usable(dstran))) then
                start = stran + (dstran - increment)
                call finite_layer_update(nprops, props, start, increment, dt, state, stress, &
                    ddsdde, status)
            end if
        else if (perturbed) then
            call perturb_layer(ndi, nshr, nprops, props, dstran, state, stress, ddsdde, change, &
                status)
            if (status >= 0) stress = change
        else
            call layer_update(ndi, nshr, nprops, props, increment, dt, state, stress, ddsdde, &
                elastic, dissipated, status)
            if (status >= 0) then
                ddsdde(5:6, 3) = 0.0_wp
                shear = ddsdde(5:6, 5:6)
                call make_symmetric(nprops, props, stress(5:6), shear)
                ddsdde(5:6, 5:6) = shear
            end if
        end if
        if (.not. perturbed) statev(1:statev_size) = state
    end if
    if (status < 0 .and. (perturbed .or. .not. cut_factor(status) < 1.0_wp)) then
        call stop_with_cause(layer_error_text(status, props))
    end if
    if (cut_factor(status) < 1.0_wp) pnewdt = cut_factor(status)

contains

    !> As CalculiX ends for errors in an input deck.
    subroutine stop_with_cause(cause)
        character(len=*), intent(in) :: cause
        integer, parameter :: bad_input = 201
        character(len=error_length) :: text
        integer :: length

        length = 0
        call append(text, length, ' *ERROR in umat: ')
        call append(text, length, cause(:used_length(cause)))
        call append(text, length, ', element ')
        call append_number(text, length, noel)
        call append(text, length, ', point ')
        call append_number(text, length, npt)
        call end_host(text, to_output, bad_input)
    end subroutine stop_with_cause

end subroutine umat
