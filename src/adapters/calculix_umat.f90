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
subroutine umat(stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, dstran, &
    time, dtime, temp, dtemp, predef, dpred, cmname, ndi, nshr, ntens, nstatv, props, nprops, &
    coords, drot, pnewdt, celent, dfgrd0, dfgrd1, noel, npt, layer, kspt, jstep, kinc)
    use friction_host, only : append, append_number, cut_factor, error_length, error_text, &
        used_length
    use friction_host_end, only : end_host, to_output
    use friction_kinds, only : wp
    use friction_layer, only : layer_update
    use friction_mod, only : friction_bad_size, friction_no_convergence, statev_size
    implicit none
    integer, intent(in) :: ndi, nshr, ntens           !! 3, 3, 6: 11, 22, 33, 12, 13, 23
    integer, intent(in) :: nstatv, nprops, noel, npt, jstep(4), kinc
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
    real(wp) :: increment(ntens), dt, elastic, dissipated
    integer :: status

    ! At the start of a dynamic step CalculiX asks for the forces as they are: with a time before
    ! the step, any dtime, and the whole strain as its increment.
    increment = dstran
    dt = dtime
    if (time(1) < 0.0_wp) then
        increment = 0.0_wp
        dt = 0.0_wp
    end if

    status = friction_bad_size
    if (nstatv >= statev_size) call layer_update(ndi, nshr, props, increment, dt, statev, stress, &
        ddsdde, elastic, dissipated, status)
    if (status < 0 .and. status /= friction_no_convergence) then
        call stop_with_cause(error_text('UMAT', status))
    end if
    if (cut_factor(status) < 1.0_wp) pnewdt = cut_factor(status)
    if (status < 0) return
    ddsdde(5:6, 3) = 0.0_wp

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
