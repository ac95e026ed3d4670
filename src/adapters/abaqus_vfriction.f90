!> Abaqus/Explicit VFRICTION: friction forces under general contact, where VFRIC is not called. Run
!> the job with `double=both`.
!>
!>     *FRICTION, USER, DEPVAR=8, PROPERTIES=9   with the constants of `friction_update`
!>
!> Contact of nodes with faces and with analytical surfaces; contact of edges, whose points are made
!> of two nodes each, is refused. A point that leaves contact is not heard of until it is back.
subroutine stickslip_vfriction(ftangential, state, nblock, nblockanal, nblockedge, &
    nnodstate, nnodslv, nnodmst, nfricdir, ndir, nstates, nprops, ntemp, nfields, jflags, rdata, &
    surfint, surfslv, surfmst, jconslvuid, jconmstuid, props, dslipfric, fstickforce, ftangprev, &
    fnormal, areacont, dircosn, dircossl, shapeslv, shapemst, coordslv, coordmst, velslv, &
    velmst, tempslv, tempmst, fieldslv, fieldmst)
    use friction_explicit, only : explicit_point, slide_in_contact
    use friction_host, only : error_length, error_text, xplb_abqerr
    use friction_kinds, only : wp
    use friction_mod, only : friction_bad_size, statev_size
    implicit none
    integer, intent(in) :: nblock                          !! points in contact
    integer, intent(in) :: nnodstate                       !! states of a point: 1; 4 for edges
    integer, intent(in) :: nfricdir                        !! tangential directions, 2
    integer, intent(in) :: ndir                            !! components, 3
    integer, intent(in) :: nstates, nprops, nblockanal, nblockedge, nnodslv, nnodmst, ntemp, nfields
    integer, intent(in) :: jflags(3)                       !! step, increment, kind of contact
    real(wp), intent(in) :: rdata(4)   !! time in the step and in all, time increment, work
    real(wp), intent(inout) :: ftangential(nfricdir, nblock)   !! out, local axes: against the slip
                                                               !! [F]
    real(wp), intent(inout) :: state(nstates, nnodstate, nblock)   !! of the friction routine
    real(wp), intent(in) :: props(nprops)                  !! constants of the friction routine
    real(wp), intent(in) :: dslipfric(ndir, nblock)        !! slip increment, local axes [L]
    real(wp), intent(in) :: fstickforce(nblock)            !! force that would prevent the slip [F]
    real(wp), intent(in) :: fnormal(nblock)                !! normal force [F]
    real(wp), intent(in) :: areacont(nblock)               !! area of a point [L^2]
    real(wp), intent(in) :: dircosn(ndir, nblock)          !! normal of the master, global axes
    real(wp), intent(in) :: dircossl(ndir, nblock)         !! local axis 1, along the slip, global
                                                           !! axes
    real(wp), intent(in) :: ftangprev(*), shapeslv(*), shapemst(*), coordslv(*), coordmst(*), &
        velslv(*), velmst(*), tempslv(*), tempmst(*), fieldslv(*), fieldmst(*)
    integer, intent(in) :: jconslvuid(nnodslv, nblock)     !! numbers of the nodes
    integer, intent(in) :: jconmstuid(*)
    character(len=80), intent(in) :: surfint, surfslv, surfmst
    integer, parameter :: time_increment = 3, total_time = 2   ! in rdata
    type(explicit_point) :: point
    real(wp) :: force(2)
    integer :: c, status

    if (nnodstate /= 1) then
        call refuse('stickslip, VFRICTION: contact of edges is not served; leave edges out of ' &
            // 'the contact domain', 1)
        return
    end if
    status = friction_bad_size
    if (nstates < statev_size .or. nfricdir /= ndir - 1) then
        call refuse(error_text('VFRICTION', status, props), 1)
        return
    end if
    point = explicit_point(ndir, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, &
        rdata(time_increment))
    do c = 1, nblock
        point%along(1:ndir) = dircossl(:, c)
        point%normal(1:ndir) = dircosn(:, c)
        point%slip(1:nfricdir) = dslipfric(1:nfricdir, c)
        point%stick_force = fstickforce(c)
        point%normal_force = fnormal(c)
        point%area = areacont(c)
        call slide_in_contact(point, props, state(1:statev_size, 1, c), force, status)
        if (status < 0) then
            call refuse(error_text('VFRICTION', status, props), c)
            return
        end if
        ftangential(:, c) = force(1:nfricdir)
    end do

contains

    subroutine refuse(cause, place)
        character(len=*), intent(in) :: cause
        integer, intent(in) :: place   !! in the block
        character(len=error_length) :: text

        text = cause
        call xplb_abqerr(-3, text, jconslvuid(1:1, place), rdata(total_time:total_time), &
            [surfint(1:8)])
    end subroutine refuse

end subroutine stickslip_vfriction
