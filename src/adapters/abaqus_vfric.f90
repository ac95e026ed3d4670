!> Abaqus/Explicit VFRIC: friction forces of the closed points of a surface. Run the job with
!> `double=both`.
!>
!>     *FRICTION, USER, DEPVAR=8, PROPERTIES=9   with the constants of `friction_update`
!>
!> With penalty contact: kinematic contact hands in a slip that is only predicted.
subroutine stickslip_vfric(ftangential, statev, kstep, kinc, ncontact, nfacnod, nslvnod, &
    nmstnod, nfricdir, ndir, nstatevar, nprops, ntemp, npred, numdeftfv, jslvuid, jmstuid, &
    jconslvid, jconmstid, timstep, timglb, dtimprev, surfint, surfslv, surfmst, lconttype, &
    dslipfric, fstickforce, ftangprev, fnormal, frictionwork, shape, coordslv, coordmst, &
    dircossl, dircosn, props, areaslv, tempslv, predefslv, tempmst, predefmst)
    use friction_explicit, only : explicit_point, rest_out_of_contact, slide_in_contact
    use friction_host, only : error_text, xplb_abqerr
    use friction_kinds, only : wp
    use friction_mod, only : friction_bad_size, statev_size
    implicit none
    integer, intent(in) :: ncontact                            !! points in contact
    integer, intent(in) :: nslvnod                             !! points of the surface
    integer, intent(in) :: nfricdir                            !! tangential directions, 1 or 2
    integer, intent(in) :: ndir                                !! components, 2 or 3
    integer, intent(in) :: nstatevar, nprops, kstep, kinc, nfacnod, nmstnod, ntemp, npred, &
        numdeftfv, lconttype
    real(wp), intent(inout) :: ftangential(nfricdir, ncontact)   !! out, local axes: against the
                                                                 !! slip [F]
    real(wp), intent(inout) :: statev(nstatevar, nslvnod)      !! state of the friction routine
    integer, intent(in) :: jconslvid(ncontact)   !! place of the contact points in the surface
    real(wp), intent(in) :: dslipfric(ndir, ncontact)          !! slip increment, local axes [L]
    real(wp), intent(in) :: fstickforce(ncontact)   !! force that would prevent the slip [F]
    real(wp), intent(in) :: ftangprev(ndir, ncontact)          !! friction force before [F]
    real(wp), intent(in) :: fnormal(ncontact)                  !! normal force [F]
    real(wp), intent(in) :: dircossl(ndir, ncontact)   !! local axis 1, along the slip, in global
                                                       !! axes
    real(wp), intent(in) :: dircosn(ndir, ncontact)   !! normal of the master, in global axes
    real(wp), intent(in) :: areaslv(nslvnod)                   !! area of a point [L^2]
    real(wp), intent(in) :: dtimprev                           !! [T]
    real(wp), intent(in) :: props(nprops)                      !! constants of the friction routine
    real(wp), intent(in) :: timstep, timglb, frictionwork
    real(wp), intent(in) :: shape(*), coordslv(*), coordmst(*), tempslv(*), predefslv(*), &
        tempmst(*), predefmst(*)
    integer, intent(in) :: jslvuid(*), jmstuid(*), jconmstid(*)
    character(len=80), intent(in) :: surfint, surfslv, surfmst
    type(explicit_point) :: point
    integer, parameter :: many = 4096
    real(wp) :: force(2)
    integer :: c, i, status

    status = friction_bad_size
    if (nstatevar < statev_size .or. nfricdir /= ndir - 1) then
        call refuse(0)
        return
    end if
    point = explicit_point(ndir, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, dtimprev)
    do c = 1, ncontact
        i = jconslvid(c)
        point%along(1:ndir) = dircossl(:, c)
        point%normal(1:ndir) = dircosn(:, c)
        point%slip(1:nfricdir) = dslipfric(1:nfricdir, c)
        point%stick_force = fstickforce(c)
        point%normal_force = fnormal(c)
        point%area = areaslv(i)
        call slide_in_contact(point, props, statev(1:statev_size, i), force, status)
        if (status < 0) then
            call refuse(i)
            return
        end if
        ftangential(:, c) = force(1:nfricdir)
    end do
    do i = 1, nslvnod, many
        call rest_among(i, min(i + many - 1, nslvnod))
        if (status < 0) return
    end do

contains

    !> Those of the points first to last that are not in contact. Looked for many at a time: one by
    !> one, large surfaces would take a time that goes with the square of their points.
    subroutine rest_among(first, last)
        integer, intent(in) :: first, last   !! places in the surface
        logical :: in_contact(many)
        integer :: c, i

        in_contact = .false.
        do c = 1, ncontact
            i = jconslvid(c)
            if (i < first .or. i > last) cycle
            in_contact(i - first + 1) = areaslv(i) > 0.0_wp
        end do
        do i = first, last
            if (in_contact(i - first + 1)) cycle
            call rest_out_of_contact(dtimprev, props, statev(1:statev_size, i), status)
            if (status < 0) then
                call refuse(i)
                return
            end if
        end do
    end subroutine rest_among

    subroutine refuse(place)
        integer, intent(in) :: place   !! in the surface; 0 for all

        call xplb_abqerr(-3, error_text('VFRIC', status, props), [place], [timglb], [surfint(1:8)])
    end subroutine refuse

end subroutine stickslip_vfric
