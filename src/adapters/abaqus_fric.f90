!> Abaqus/Standard FRIC: friction of a closed contact point whose pressure Abaqus hands in.
!>
!>     *FRICTION, USER, DEPVAR=8, PROPERTIES=9, UNSYMM   with the constants of `friction_update`
!>
!> Abaqus leaves the routine out while the contact is open, so mu does not recover then. In the
!> increment that closes it the routine only notes that it was open.
subroutine stickslip_fric(lm, tau, ddtddg, ddtddp, dslip, sed, sfd, ddtddt, pnewdt, statev, &
    dgam, taulm, press, dpress, ddpddh, slip, kstep, kinc, time, dtime, noel, ciname, slname, &
    msname, npt, node, npatch, coords, rcoord, drot, temp, predef, nfdir, mcrd, npred, nstatv, &
    chrlngth, props, nprops)
    use friction_host, only : cut_factor, elastic_energy, error_text, forget_elastic, &
        hold_without_pressure, host_tangential, rotate_tangential, severity, &
        stdb_abqerr, usable
    use friction_kinds, only : wp
    use friction_mod, only : friction_bad_size, friction_ok, statev_dissipation, statev_size, &
        statev_u_et
    implicit none
    integer, intent(inout) :: lm              !! in: 2 was open; out: 0 relative motion
    integer, intent(in) :: nfdir              !! tangential directions, 1 or 2
    integer, intent(in) :: nstatv, nprops, mcrd, npred
    real(wp), intent(inout) :: tau(nfdir)     !! friction stress, start in, end out [F/L^2]
    real(wp), intent(inout) :: ddtddg(nfdir, nfdir)   !! d(tau)/d(dgam) [F/L^3]
    real(wp), intent(inout) :: ddtddp(nfdir)  !! d(tau)/d(press) [-]
    real(wp), intent(inout) :: dslip(nfdir)   !! non-recoverable slip increment [L]
    real(wp), intent(inout) :: sed, sfd       !! elastic energy, dissipation in the increment [F/L]
    real(wp), intent(inout) :: ddtddt(nfdir, 2), pnewdt
    real(wp), intent(inout) :: statev(*)      !! state of the friction routine, start in, end out
    real(wp), intent(in) :: dgam(nfdir)       !! increment of relative motion [L]
    real(wp), intent(in) :: press             !! pressure at the end of the increment [F/L^2]
    real(wp), intent(in) :: dtime             !! [T]
    real(wp), intent(in) :: drot(2, 2)        !! rotation of the surface axes in the increment
    real(wp), intent(in) :: props(nprops)     !! constants of the friction routine
    real(wp), intent(in) :: taulm(nfdir), dpress, ddpddh, slip(nfdir), time(2), coords(mcrd), &
        rcoord(mcrd), temp(2), predef(2, *), chrlngth
    integer, intent(in) :: kstep, kinc, noel, npt, node, npatch
    character(len=80), intent(in) :: ciname, slname, msname
    integer, parameter :: was_open = 2, relative_motion = 0
    real(wp) :: state(statev_size), start(statev_size), second
    integer :: status, last

    status = friction_bad_size
    if (nstatv >= statev_size) then
        state = statev(1:statev_size)
        if (lm == was_open) then
            call forget_elastic(props, state, status)
        else
            status = friction_ok
            if (nfdir == 2) call rotate_tangential(drot, state, status)
            ! a displacement without its stress: open since, although LM does not say so
            if (all(usable(tau)) .and. all(usable(state))) then
                if (all(abs(tau) <= 0.0_wp) .and. any(abs(state(statev_u_et:statev_u_et + 1)) &
                    > 0.0_wp)) call forget_elastic(props, state, status)
            end if
            start = state
            if (status >= 0) call host_tangential(dgam, press, dtime, props, state, tau, ddtddg, &
                ddtddp, status)
            if (status >= 0) call hold_without_pressure(dgam, press, props, state, ddtddg)
        end if
    end if
    if (cut_factor(status) < 1.0_wp) pnewdt = min(pnewdt, cut_factor(status))
    if (status < 0) then
        call stdb_abqerr(severity(status), error_text('FRIC', status, props), [noel, npt], time, &
            [ciname(1:8)])
        return
    end if

    statev(1:statev_size) = state
    if (lm == was_open) return
    lm = relative_motion
    last = statev_u_et + nfdir - 1
    dslip = dgam - (state(statev_u_et:last) - start(statev_u_et:last))
    second = 0.0_wp
    if (nfdir == 2) second = state(last)
    sed = elastic_energy(props, 0.0_wp, state(statev_u_et), second)
    sfd = state(statev_dissipation) - start(statev_dissipation)
    ddtddt = 0.0_wp

end subroutine stickslip_fric
