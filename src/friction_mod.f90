!> Front door of the library: the friction routine with an FE-interface signature.
!>
!> Traction is what the contact transmits, positive in tension; component 1 is normal, then
!> tangential. See docs/theory.md for the model and docs/user_guide.md for the constants and state
!> variables. Every procedure here is pure: no saved data, no input or output, no allocation. On a
!> negative `status` nothing else is touched.
module friction_mod
    use, intrinsic :: iso_fortran_env, only : int64
    use friction_anisotropy, only : isotropic, largest_mu_ratio, orthotropy, read_orthotropy
    use friction_contact, only : contact_motion, contact_point, contact_springs, contact_update, &
        point_open, point_slip, point_stick, point_virgin
    use friction_kinds, only : wp
    use friction_law, only : law
    use friction_status, only : friction_bad_axis, friction_bad_increment, friction_bad_law, &
        friction_bad_normal, friction_bad_property, friction_bad_size, friction_bad_state, &
        friction_message, friction_no_convergence, friction_null_pointer, friction_ok, &
        friction_snap_back, friction_zero_time_increment
    use friction_coulomb_law, only : read_coulomb_law, coulomb_law
    use friction_static_kinetic_law, only : read_static_kinetic_law, static_kinetic_law
    use friction_rate_state_law, only : read_rate_state_law, rate_state_law
    use friction_shear_cap, only : capped_law
    use friction_slip_weakening_law, only : read_slip_weakening_law, slip_weakening_law
    use friction_subloading_exact_law, only : subloading_exact_law
    use friction_subloading_general_law, only : subloading_general_law, u_cotangent, u_logarithm, &
        u_reciprocal
    use friction_subloading_law, only : read_subloading_law, subloading_law
    implicit none
    private

    public :: friction_update, friction_update_frame, friction_tangential, friction_update_batch, &
        friction_update_points, friction_is_orthotropic, friction_message, friction_version
    public :: update_arrays, update_arrays_batch, update_arrays_points   ! for the C interface
    public :: friction_bad_axis, friction_bad_increment, friction_bad_law, friction_bad_normal, &
        friction_bad_property, friction_bad_size, friction_bad_state, friction_no_convergence, &
        friction_null_pointer, friction_ok, friction_snap_back, friction_zero_time_increment

    character(len=*), parameter :: friction_version = '0.1.0'   !! semantic version of the library

    !> Laws: values of props(1).
    integer, parameter, public :: law_subloading = 1
    integer, parameter, public :: law_coulomb = 2
    integer, parameter, public :: law_static_kinetic = 3
    integer, parameter, public :: law_rate_state = 4
    integer, parameter, public :: law_slip_weakening = 5

    !> Time integration of the subloading law: values of props(10).
    integer, parameter, public :: scheme_backward_euler = 0   !! as the law's authors chose
    integer, parameter, public :: scheme_exact_rate = 1       !! exact for a constant slip rate

    !> Evolution of R in the subloading law: values of props(11).
    public :: u_logarithm, u_cotangent, u_reciprocal

    !> Material constants: places in `props` that all laws share.
    integer, parameter :: prop_law = 1, prop_alpha_n = 2, prop_alpha_t = 3, first_own_prop = 4
    integer, parameter :: prop_scheme = 10   !! of the subloading law; may be left out
    integer, parameter :: prop_u_of_r = 11   !! likewise

    !> Place of the shear cap, after the own constants of each law; may be left out, 0 means none.
    integer, parameter :: prop_tau_max(5) = [12, 5, 7, 11, 7]

    !> The places after it, which may be left out, are for orthotropic friction: mu_2/mu_1, and the
    !> direction of sliding.
    integer, parameter :: ratio_after_tau_max = 1

    !> Direction in which an orthotropic surface slides.
    integer, parameter, public :: direction_associated = 0   !! normal to the surface of strength
    integer, parameter, public :: direction_radial = 1       !! along the trial traction
    public :: largest_mu_ratio

    !> Places in `statev`.
    integer, parameter, public :: statev_size = 8          !! least size
    integer, parameter, public :: statev_status = 1        !! 0 virgin, 1 stick, 2 slip, 3 open
    integer, parameter, public :: statev_u_n = 2           !! normal relative displacement [L]
    integer, parameter, public :: statev_u_et = 3   !! first elastic tangential displacement [L]
    integer, parameter, public :: statev_mu = 5            !! friction coefficient [-]
    integer, parameter, public :: statev_r = 6   !! internal variable of the law, e.g. R
    integer, parameter, public :: statev_slip = 7          !! accumulated slip [L]
    integer, parameter, public :: statev_dissipation = 8   !! accumulated dissipated energy per
                                                           !! area [F/L]

    interface
        !> Friction update of many contact points, all with the same constants and the same
        !> increment of time (docs/performance.md). Arrays are component-major: component j of point
        !> i is du(i, j). Bad input at a point leaves that point's data untouched and harms no other
        !> point.
        module subroutine friction_update_batch(du, dtime, props, statev, traction, tangent, status)
            implicit none
            real(wp), intent(in), contiguous :: du(:, :)   !! increments of relative displacement;
                                                           !! n points, 2 or 3 components [L]
            real(wp), intent(in) :: dtime                  !! increment of time, >= 0 [T]
            real(wp), intent(in), contiguous :: props(:)   !! material constants, as in
                                                           !! `friction_update`
            real(wp), intent(inout), contiguous :: statev(:, :)     !! states, start in, end out; n
                                                                    !! points, 8 or more
            real(wp), intent(inout), contiguous :: traction(:, :)   !! shape of du [F/L^2]
            real(wp), intent(inout), contiguous :: tangent(:, :, :)   !! dT_i/d(du_j) of point k is
                                                                      !! tangent(k, i, j) [F/L^3]
            integer, intent(out), contiguous :: status(:)   !! a named code for each of the n points
        end subroutine friction_update_batch

        !> The same with explicit sizes.
        module subroutine update_arrays_batch(n, ndir, du, dtime, nprops, props, nstatv, statev, &
            traction, tangent, status)
            implicit none
            integer(int64), intent(in) :: n                         !! points
            integer, intent(in) :: ndir, nprops, nstatv             !! sizes
            real(wp), intent(in) :: du(n, ndir), dtime, props(nprops)
            real(wp), intent(inout) :: statev(n, nstatv), traction(n, ndir)
            real(wp), intent(inout), target :: tangent(n, ndir, ndir)
            integer, intent(out) :: status(n)
        end subroutine update_arrays_batch

        !> `friction_update_batch` for arrays that keep each point's numbers together, as C and
        !> numpy order them: component j of point i is du(j, i).
        module subroutine friction_update_points(du, dtime, props, statev, traction, tangent, &
            status)
            implicit none
            real(wp), intent(in), contiguous :: du(:, :)   !! increments of relative displacement; 2
                                                           !! or 3 components, n points [L]
            real(wp), intent(in) :: dtime                  !! increment of time, >= 0 [T]
            real(wp), intent(in), contiguous :: props(:)   !! material constants, as in
                                                           !! `friction_update`
            real(wp), intent(inout), contiguous :: statev(:, :)     !! states, start in, end out; 8
                                                                    !! or more, n points
            real(wp), intent(inout), contiguous :: traction(:, :)   !! shape of du [F/L^2]
            real(wp), intent(inout), contiguous :: tangent(:, :, :)   !! dT_i/d(du_j) of point k is
                                                                      !! tangent(j, i, k) [F/L^3]
            integer, intent(out), contiguous :: status(:)   !! a named code for each of the n points
        end subroutine friction_update_points

        !> The same with explicit sizes.
        module subroutine update_arrays_points(n, ndir, du, dtime, nprops, props, nstatv, statev, &
            traction, tangent, status)
            implicit none
            integer(int64), intent(in) :: n                         !! points
            integer, intent(in) :: ndir, nprops, nstatv             !! sizes
            real(wp), intent(in) :: du(ndir, n), dtime, props(nprops)
            real(wp), intent(inout) :: statev(nstatv, n), traction(ndir, n)
            real(wp), intent(inout) :: tangent(ndir, ndir, n)       !! tangent(j, i, k)
            integer, intent(out) :: status(n)
        end subroutine update_arrays_points
    end interface

contains

    !> Friction update of a contact point in its own axes (docs/theory.md, sections 3 and 4).
    pure subroutine friction_update(du, dtime, props, statev, traction, tangent, status)
        real(wp), intent(in), contiguous :: du(:)   !! increment of relative displacement: normal,
                                                    !! tangential 1[, 2]; size 2 or 3, finite [L]
        real(wp), intent(in) :: dtime               !! increment of time, >= 0 [T]
        real(wp), intent(in), contiguous :: props(:)   !! material constants: number of the law,
                                                       !! alpha_n, alpha_t, its own
        real(wp), intent(inout), contiguous :: statev(:)   !! state, start in, end out; size 8 or
                                                           !! more; all zero = virgin
        real(wp), intent(inout), contiguous :: traction(:)   !! T at the end of the increment; size
                                                             !! of du [F/L^2]
        real(wp), intent(inout), contiguous :: tangent(:, :)   !! dT_i/d(du_j), unsymmetric; size of
                                                               !! du squared [F/L^3]
        integer, intent(out) :: status   !! a named code; `friction_message` gives its text
        integer :: n

        n = size(du)
        status = friction_bad_size
        if (size(traction) /= n .or. size(tangent, 1) /= n .or. size(tangent, 2) /= n) return
        call update_arrays(n, du, dtime, size(props), props, size(statev), statev, traction, &
            tangent, status)
    end subroutine friction_update

    !> `friction_update` with explicit sizes, as the C interface and Fortran 77 hand them over.
    pure subroutine update_arrays(n, du, dtime, nprops, props, nstatv, statev, traction, tangent, &
        status)
        integer, intent(in) :: n, nprops, nstatv          !! sizes
        real(wp), intent(in) :: du(n), dtime, props(nprops)
        real(wp), intent(inout) :: statev(nstatv), traction(n), tangent(n, n)
        integer, intent(out) :: status
        type(contact_motion) :: motion
        real(wp) :: plane_traction(3), plane_tangent(3, 3)

        status = friction_bad_size
        if (n < 2 .or. n > 3) return
        motion%du(1) = du(1)
        motion%du(2) = du(2)
        motion%dt = dtime
        motion%pressure_given = .false.
        motion%pressure = 0.0_wp
        if (n == 3) then
            motion%du(3) = du(3)
            call advance(motion, 2, nprops, props, nstatv, statev, traction, tangent, status)
        else
            motion%du(3) = 0.0_wp
            call advance(motion, 1, nprops, props, nstatv, statev, plane_traction, plane_tangent, &
                status)
            if (status < 0) return
            traction = plane_traction(1:2)
            tangent = plane_tangent(1:2, 1:2)
        end if
    end subroutine update_arrays

    !> The same in any orthonormal frame, given the unit normal (the paper's `I - n n` form).
    !>
    !> Here statev(2:) holds the vector `u_n n + u_et` in the caller's frame. A host that rotates
    !> the frame or the normal during an increment rotates these components as it rotates any vector
    !> of its own. Orthotropic friction in space needs its axis 1, too: the part of `axis` at right
    !> angles to the normal. Axis 2 is normal x axis 1.
    pure subroutine friction_update_frame(du, normal, dtime, props, statev, traction, tangent, &
        status, axis)
        real(wp), intent(in) :: du(:)   !! increment of relative displacement, slave seen from
                                        !! master;
                                                  !! size 2 or 3, finite [L]
        real(wp), intent(in) :: normal(:)   !! unit normal from master to slave; size of du [-]
        real(wp), intent(in) :: dtime             !! increment of time, >= 0 [T]
        real(wp), intent(in) :: props(:)          !! material constants, as in `friction_update`
        real(wp), intent(inout) :: statev(:)   !! state, start in, end out; size 8 or more; all
                                               !! zero = virgin
        real(wp), intent(inout) :: traction(:)  !! T at the end of the increment; size of du [F/L^2]
        real(wp), intent(inout) :: tangent(:, :)   !! dT_i/d(du_j), unsymmetric; size of du squared
                                                   !! [F/L^3]
        integer, intent(out) :: status            !! a named code; also `friction_bad_normal`,
                                                  !! `friction_bad_axis`
        real(wp), intent(in), optional :: axis(:)   !! tangential axis 1, of any length; size of du;
                                                    !! isotropic friction does not need it
        real(wp), parameter :: unit_tolerance = 1.0e-6_wp   !! a normal in single precision still
                                                            !! passes
        real(wp) :: axes(3, 3), state(statev_size)
        type(contact_motion) :: motion
        real(wp) :: contact_traction(3), contact_tangent(3, 3)
        integer :: n

        n = size(du)
        if (n < 2 .or. n > 3 .or. size(normal) /= n .or. size(traction) /= n &
            .or. size(tangent, 1) /= n .or. size(tangent, 2) /= n &
            .or. size(statev) < statev_size) then
            status = friction_bad_size
            return
        end if
        status = friction_bad_normal
        if (.not. all_usable(n, normal)) return
        if (abs(dot_product(normal, normal) - 1.0_wp) > unit_tolerance) return
        status = friction_bad_increment
        if (.not. all_usable(n, du)) return
        status = friction_bad_state
        if (.not. all_usable(statev_size, statev)) return

        axes = contact_axes(normal)
        if (n == 3 .and. friction_is_orthotropic(props)) then
            status = friction_bad_axis
            if (.not. present(axis)) return
            call turn_axes(axis, axes, status)
            if (status < 0) return
        end if
        motion%du(3) = 0.0_wp
        motion%du(1:n) = matmul(du, axes(1:n, 1:n))
        motion%dt = dtime
        motion%pressure_given = .false.
        motion%pressure = 0.0_wp
        state = statev(1:statev_size)
        state(statev_u_n:statev_u_n + n - 1) = matmul(state(statev_u_n:statev_u_n + n - 1), &
            axes(1:n, 1:n))
        call advance(motion, n - 1, size(props), props, statev_size, state, contact_traction, &
            contact_tangent, status)
        if (status < 0) return
        state(statev_u_n:statev_u_n + n - 1) = matmul(axes(1:n, 1:n), &
            state(statev_u_n:statev_u_n + n - 1))
        statev(1:statev_size) = state
        traction = matmul(axes(1:n, 1:n), contact_traction(1:n))
        tangent = matmul(axes(1:n, 1:n), matmul(contact_tangent(1:n, 1:n), &
            transpose(axes(1:n, 1:n))))
    end subroutine friction_update_frame

    !> Do these constants tell one tangential axis from another?
    pure function friction_is_orthotropic(props) result(orthotropic)
        real(wp), intent(in) :: props(:)   !! material constants, as in `friction_update`
        logical :: orthotropic             !! false also for constants that are refused
        integer :: number, place
        real(wp) :: ratio

        orthotropic = .false.
        if (size(props) < first_own_prop) return
        if (.not. all_usable(size(props), props)) return
        number = whole_number(props(prop_law))
        if (number < 1 .or. number > size(prop_tau_max)) return
        place = prop_tau_max(number) + ratio_after_tau_max
        if (size(props) < place) return
        ratio = props(place)
        orthotropic = ratio > 0.0_wp .and. abs(ratio - 1.0_wp) > 0.0_wp
    end function friction_is_orthotropic

    !> Tangential part alone, for hosts that hand in the pressure.
    !>
    !> The normal spring is the host's; alpha_n only turns the pressure into the penetration kept in
    !> statev(2).
    pure subroutine friction_tangential(du, pressure, dtime, props, statev, tau, dtau_ddu, &
        dtau_dp, status)
        real(wp), intent(in) :: du(:)   !! increment of tangential displacement; size 1 or 2,
                                        !! finite [L]
        real(wp), intent(in) :: pressure   !! at the end of the increment; <= 0 is an open contact
                                           !! [F/L^2]
        real(wp), intent(in) :: dtime              !! increment of time, >= 0 [T]
        real(wp), intent(in) :: props(:)           !! material constants, as in `friction_update`
        real(wp), intent(inout) :: statev(:)   !! state, start in, end out; size 8 or more; all
                                               !! zero = virgin
        real(wp), intent(inout) :: tau(:)   !! tangential traction, sign of the slip; size of du
                                            !! [F/L^2]
        real(wp), intent(inout) :: dtau_ddu(:, :)  !! d(tau_i)/d(du_j); size of du squared [F/L^3]
        real(wp), intent(inout) :: dtau_dp(:)      !! d(tau)/d(pressure); size of du [-]
        integer, intent(out) :: status   !! a named code; `friction_message` gives its text
        type(contact_motion) :: motion
        real(wp) :: contact_traction(3), contact_tangent(3, 3)
        integer :: n

        n = size(du)
        if (n < 1 .or. n > 2 .or. size(tau) /= n .or. size(dtau_ddu, 1) /= n &
            .or. size(dtau_ddu, 2) /= n .or. size(dtau_dp) /= n) then
            status = friction_bad_size
            return
        end if
        motion%du = 0.0_wp
        motion%du(2:n + 1) = du
        motion%dt = dtime
        motion%pressure_given = .true.
        motion%pressure = pressure
        call advance(motion, n, size(props), props, size(statev), statev, contact_traction, &
            contact_tangent, status)
        if (status < 0) return
        tau = contact_traction(2:n + 1)
        dtau_ddu = contact_tangent(2:n + 1, 2:n + 1)
        dtau_dp = contact_tangent(2:n + 1, 1)
    end subroutine friction_tangential

    !> Validates, chooses the law, updates, and writes the state back.
    pure subroutine advance(motion, n_tangential, nprops, props, nstatv, statev, traction, &
        tangent, status)
        type(contact_motion), intent(in) :: motion
        integer, intent(in) :: n_tangential             !! 1 or 2 tangential components
        integer, intent(in) :: nprops, nstatv           !! sizes
        real(wp), intent(in) :: props(nprops)
        real(wp), intent(inout) :: statev(nstatv)
        real(wp), intent(inout) :: traction(3), tangent(3, 3)
        integer, intent(out) :: status
        type(subloading_law), target :: subloading
        type(subloading_exact_law), target :: exact
        type(subloading_general_law), target :: general
        type(coulomb_law), target :: coulomb
        type(static_kinetic_law), target :: static_kinetic
        type(rate_state_law), target :: rate_state
        type(slip_weakening_law), target :: slip_weakening
        type(capped_law), target :: capped
        class(law), pointer :: surface
        type(orthotropy) :: plane
        integer :: number, scheme, place
        integer(int64) :: seen

        status = friction_bad_size
        if (nprops < first_own_prop .or. nstatv < statev_size) return
        status = friction_bad_increment
        ! One by one: the caller has only just stored them one by one, and a processor that loads
        ! them in pairs has to wait.
        seen = ior(ior(ior(oversize(motion%du(1)), oversize(motion%du(2))), &
            ior(oversize(motion%du(3)), oversize(motion%dt))), oversize(motion%pressure))
        if (btest(seen, 62)) return
        if (motion%dt < 0.0_wp) return
        status = friction_bad_property
        if (.not. all_usable(nprops, props)) return
        if (props(prop_alpha_n) <= 0.0_wp .or. props(prop_alpha_t) <= 0.0_wp) return

        scheme = scheme_backward_euler
        number = whole_number(props(prop_law))
        select case (number)
        case (law_subloading)
            call read_subloading_law(nprops - first_own_prop + 1, props(first_own_prop), &
                subloading, status)
            if (nprops >= prop_scheme) scheme = whole_number(props(prop_scheme))
            select case (scheme)
            case (scheme_backward_euler)
                surface => subloading
            case (scheme_exact_rate)
                exact%subloading_law = subloading
                surface => exact
            case default
                status = friction_bad_property
            end select
            if (nprops >= prop_u_of_r) then
                general%u_of_r = whole_number(props(prop_u_of_r))
                if (general%u_of_r /= u_logarithm) then
                    general%subloading_law = subloading
                    surface => general
                    if (scheme /= scheme_backward_euler .or. (general%u_of_r /= u_cotangent &
                        .and. general%u_of_r /= u_reciprocal)) status = friction_bad_property
                end if
            end if
        case (law_coulomb)
            call read_coulomb_law(nprops - first_own_prop + 1, props(first_own_prop), coulomb, &
                status)
            surface => coulomb
        case (law_static_kinetic)
            call read_static_kinetic_law(nprops - first_own_prop + 1, props(first_own_prop), &
                static_kinetic, status)
            surface => static_kinetic
        case (law_rate_state)
            call read_rate_state_law(nprops - first_own_prop + 1, props(first_own_prop), &
                rate_state, status)
            surface => rate_state
        case (law_slip_weakening)
            call read_slip_weakening_law(nprops - first_own_prop + 1, props(first_own_prop), &
                slip_weakening, status)
            surface => slip_weakening
        case default
            status = friction_bad_law
        end select
        if (status < 0) return
        surface%follows_path = scheme == scheme_exact_rate
        if (nprops >= prop_tau_max(number)) then
            capped%tau_max = props(prop_tau_max(number))
            status = friction_bad_property
            if (capped%tau_max < 0.0_wp) return
            if (capped%tau_max > 0.0_wp) then
                capped%inner => surface
                capped%follows_path = .false.   ! its strength is not proportional to the pressure
                surface => capped
            end if
        end if
        plane = isotropic
        place = prop_tau_max(number) + ratio_after_tau_max
        if (nprops >= place) then
            call read_orthotropy(nprops - place + 1, props(place), plane, status)
            if (status < 0) return
        end if
        call update_point(surface, plane, props, motion, n_tangential, statev, traction, tangent, &
            status)
    end subroutine advance

    !> One point under a law: unpacks `statev`, updates, and packs it again.
    pure subroutine update_point(surface, plane, props, motion, n_tangential, statev, traction, &
        tangent, status)
        class(law), intent(in) :: surface
        type(orthotropy), intent(in) :: plane
        real(wp), intent(in) :: props(prop_alpha_t)
        type(contact_motion), intent(in) :: motion
        integer, intent(in) :: n_tangential   !! 1 or 2 tangential components
        real(wp), intent(inout) :: statev(statev_size)
        real(wp), intent(inout) :: traction(3), tangent(3, 3)
        integer, intent(out) :: status
        type(contact_point) :: old, new

        status = friction_bad_state
        if (.not. all_usable(statev_size, statev)) return
        old%phase = whole_number(statev(statev_status))
        old%u_n = statev(statev_u_n)
        old%u_et(1) = statev(statev_u_et)
        old%u_et(2) = 0.0_wp
        if (n_tangential > 1) old%u_et(2) = statev(statev_u_et + 1)
        old%inner%mu = statev(statev_mu)
        old%inner%r = statev(statev_r)
        old%slip = statev(statev_slip)
        old%dissipation = statev(statev_dissipation)
        select case (old%phase)
        case (point_virgin)
            if (any(abs(statev) > 0.0_wp)) return
            old%inner = surface%virgin()
        case (point_stick, point_slip, point_open)
            if (old%slip < 0.0_wp .or. old%dissipation < 0.0_wp) return
            if (.not. surface%admits(old%inner)) return
        case default
            return
        end select
        if (.not. motion%dt > 0.0_wp) then
            status = friction_zero_time_increment
            if (surface%needs_time() .and. sheared(motion, old)) return
        end if

        call contact_update(surface, contact_springs(normal=props(prop_alpha_n), &
            tangential=props(prop_alpha_t)), plane, motion, old, new, traction, tangent, status)
        if (status < 0) return
        statev(statev_status) = new%phase
        statev(statev_u_n) = new%u_n
        statev(statev_u_et) = new%u_et(1)
        statev(statev_u_et + 1) = new%u_et(2)
        statev(statev_mu) = new%inner%mu
        statev(statev_r) = new%inner%r
        statev(statev_slip) = new%slip
        statev(statev_dissipation) = new%dissipation
    end subroutine update_point

    !> Does the increment load a closed contact tangentially?
    pure function sheared(motion, old)
        type(contact_motion), intent(in) :: motion
        type(contact_point), intent(in) :: old
        logical :: sheared

        sheared = any(abs(old%u_et + motion%du(2:3)) > 0.0_wp)
        if (motion%pressure_given) then
            sheared = sheared .and. motion%pressure > 0.0_wp
        else
            sheared = sheared .and. old%u_n + motion%du(1) < 0.0_wp
        end if
    end function sheared

    !> Is every number finite and below 2**333 (1.7e100) in magnitude, so that products of three
    !> cannot overflow?
    pure function all_usable(n, x) result(usable)
        integer, intent(in) :: n        !! how many numbers
        real(wp), intent(in) :: x(n)
        logical :: usable
        integer(int64) :: seen
        integer :: i

        seen = 0
        do i = 1, n
            seen = ior(seen, oversize(x(i)))
        end do
        usable = .not. btest(seen, 62)
    end function all_usable

    !> A bit pattern whose bit 62 tells a number too large, infinite or NaN.
    !>
    !> Reads the exponent as an integer: silent where NaN raises a floating-point exception, and
    !> right even where the compiler was told that there are no NaNs. An exponent that is too large
    !> carries into that bit, and nothing else does.
    pure function oversize(x) result(bits)
        real(wp), intent(in) :: x
        integer(int64) :: bits
        integer(int64), parameter :: exponent_bits = shiftl(2047_int64, 51)
        integer(int64), parameter :: carry = shiftl(2048_int64 - (1023 + 333), 51)

        bits = iand(shiftr(transfer(x, bits), 1), exponent_bits) + carry
    end function oversize

    !> A number that counts something; -1, which counts nothing, for all but a small whole number.
    pure function whole_number(x) result(number)
        real(wp), intent(in) :: x
        integer :: number

        number = int(min(max(x, -1.0_wp), 1000.0_wp))
        if (abs(x - number) > 0.0_wp) number = -1
    end function whole_number

    !> Orthonormal axes that start with the normal, as columns; tangential ones are as good as any.
    !> Without a division by a small number for every normal (Duff et al., J. Comput. Graph. Tech.
    !> 6(1), 2017).
    pure function contact_axes(normal) result(axes)
        real(wp), intent(in) :: normal(:)   !! size 2 or 3
        real(wp) :: axes(3, 3)
        real(wp) :: n(3), sign_z, a, b

        n = 0.0_wp
        n(1:size(normal)) = normal / norm2(normal)
        axes = 0.0_wp
        axes(:, 1) = n
        if (size(normal) == 2) then
            axes(1:2, 2) = [-n(2), n(1)]
        else
            sign_z = sign(1.0_wp, n(3))
            a = -1.0_wp / (sign_z + n(3))
            b = n(1) * n(2) * a
            axes(:, 2) = [1.0_wp + sign_z * n(1)**2 * a, sign_z * b, -sign_z * n(1)]
            axes(:, 3) = [b, sign_z + n(2)**2 * a, -n(2)]
        end if
    end function contact_axes

    !> Turns the tangential axes in their plane, so that the first is along `axis`.
    pure subroutine turn_axes(axis, axes, status)
        real(wp), intent(in) :: axis(:)
        real(wp), intent(inout) :: axes(3, 3)   !! as columns, the first is the normal
        integer, intent(out) :: status          !! ok, bad size, or bad axis
        real(wp), parameter :: least = 1.0e-6_wp   !! sine of its angle to the normal
        real(wp) :: part(2), old(3, 2)

        status = friction_bad_size
        if (size(axis) /= 3) return
        status = friction_bad_axis
        if (.not. all_usable(3, axis)) return
        old = axes(:, 2:3)
        part = matmul(axis, old)
        if (.not. norm2(part) > least * norm2(axis)) return
        part = part / norm2(part)
        axes(:, 2) = part(1) * old(:, 1) + part(2) * old(:, 2)
        axes(:, 3) = part(1) * old(:, 2) - part(2) * old(:, 1)
        status = friction_ok
    end subroutine turn_axes

end module friction_mod
