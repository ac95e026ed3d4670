!> One contact point through one increment: normal and tangential springs, open, touchdown, stick
!> and slip, and the consistent tangent (docs/theory.md, sections 2 to 5).
module friction_contact
    use friction_anisotropy, only : orthotropy, slide_associated, sliding_way
    use friction_kinds, only : largest, wp
    use friction_law, only : law, law_state, least_ratio, sliding
    use friction_reloading, only : find_reloading, reloading
    use friction_return_map, only : return_map
    use friction_status, only : friction_bad_increment, friction_ok
    implicit none
    private

    public :: contact_motion, contact_point, contact_springs, contact_update, touches

    !> A trial sticks if it is above the strength by no more than this share, which is round-off
    !> (docs/theory.md, section 3).
    real(wp), parameter :: verge = 32.0_wp * epsilon(verge)

    !> Pressures [F/L^2] and displacements [L] below this are none: their quotients would leave the
    !> range of the arithmetic.
    real(wp), parameter :: least = 2.0_wp**(-960)

    integer, parameter, public :: point_virgin = 0   !! nothing has happened yet
    integer, parameter, public :: point_stick = 1    !! closed, tangentially elastic
    integer, parameter, public :: point_slip = 2     !! closed, has slid in this increment
    integer, parameter, public :: point_open = 3     !! no pressure

    !> Elastic (penalty) stiffness of the contact.
    type :: contact_springs
        real(wp) :: normal       !! alpha_n, > 0 [F/L^3]
        real(wp) :: tangential   !! alpha_t, > 0 [F/L^3]
        real(wp) :: damping      !! of the damper beside the tangential one, >= 0 [F T/L^3]
    end type contact_springs

    !> What happens in an increment. A host that controls the pressure itself hands it in.
    type :: contact_motion
        real(wp) :: du(3)           !! relative displacement: normal, tangential 1 and 2 [L]
        real(wp) :: dt              !! increment of time, >= 0 [T]
        real(wp) :: pressure        !! at the end of the increment, if given [F/L^2]
        logical :: pressure_given   !! the pressure replaces the normal spring
        real(wp) :: blur            !! round-off of displacements, where it is more than that of
                                    !! each component, else 0 [L]
        real(wp) :: blur_start      !! the same at the start of the increment [L]
    end type contact_motion

    !> State of a contact point.
    type :: contact_point
        integer :: phase            !! one of the four above
        real(wp) :: u_n             !! normal relative displacement, negative = penetration [L]
        real(wp) :: u_et(2)         !! elastic tangential displacement [L]
        type(law_state) :: inner    !! internal variables of the law
        real(wp) :: slip            !! accumulated slip [L]
        real(wp) :: dissipation     !! accumulated dissipated energy per area [F/L]
    end type contact_point

contains

    !> Traction, consistent tangent and new state of a contact point. Only on a status >= 0 do they
    !> mean anything, and only then are traction and tangent written.
    pure subroutine contact_update(surface, springs, plane, motion, old, new, traction, tangent, &
        status)
        class(law), intent(in) :: surface
        type(contact_springs), intent(in) :: springs
        type(orthotropy), intent(in) :: plane        !! how friction depends on the direction
        type(contact_motion), intent(in) :: motion
        type(contact_point), intent(in) :: old       !! state at the start of the increment
        type(contact_point), intent(out) :: new      !! state at its end
        real(wp), intent(inout) :: traction(3)   !! transmitted, normal (negative = compression),
                                                 !! tangential [F/L^2]
        real(wp), intent(inout) :: tangent(3, 3)   !! d(traction)/d(du); where the pressure is
                                                   !! given, column 1 is d/d(pressure)
        integer, intent(out) :: status   !! ok, snap back, bad increment, or no convergence
        real(wp) :: pressure, loaded, q(2), tau(2), by_q(2, 2), by_pressure(2), stiffness
        logical :: closes

        new%u_n = old%u_n + motion%du(1)
        pressure = -springs%normal * new%u_n
        if (motion%pressure_given) then
            pressure = motion%pressure
            new%u_n = -pressure / springs%normal
        end if
        status = friction_bad_increment
        if (max(abs(new%u_n), pressure) > largest) return
        status = friction_ok
        if (.not. pressure > least) then
            if (.not. touches(surface%cohesion, motion%blur, new%u_n)) then
                call open_contact(surface, motion%dt, old, new)
                traction = 0.0_wp
                tangent = 0.0_wp
                return
            end if
            pressure = 0.0_wp
        end if

        ! Only the part of the increment after touchdown loads the contact.
        closes = old%u_n > 0.0_wp .and. .not. motion%pressure_given
        if (closes .and. surface%cohesion > 0.0_wp) closes = old%u_n > motion%blur &
            .and. motion%du(1) < 0.0_wp   ! else it touched from the start
        loaded = 1.0_wp
        if (closes) loaded = min(new%u_n, 0.0_wp) / motion%du(1)
        stiffness = springs%tangential
        q(1) = old%u_et(1) + loaded * motion%du(2)
        q(2) = old%u_et(2) + loaded * motion%du(3)
        if (springs%damping > 0.0_wp) call stiffen(springs, motion, loaded, old, stiffness, q)

        call tangential_update(surface, stiffness, plane, q, pressure, motion, old, new, tau, &
            by_q, by_pressure, status)
        if (status < 0) return
        if (springs%damping > 0.0_wp) call strain_damper(springs, motion, loaded, old, tau, new)
        if (.not. motion%pressure_given) by_pressure = -springs%normal * by_pressure
        if (closes) call touch_down(motion%du, old%u_n, loaded, by_q, by_pressure)
        traction(1) = -pressure
        traction(2) = tau(1)
        traction(3) = tau(2)
        tangent(1, 1) = springs%normal
        if (motion%pressure_given) tangent(1, 1) = -1.0_wp
        tangent(1, 2) = 0.0_wp
        tangent(1, 3) = 0.0_wp
        tangent(2, 1) = by_pressure(1)
        tangent(3, 1) = by_pressure(2)
        tangent(2, 2) = by_q(1, 1)
        tangent(3, 2) = by_q(2, 1)
        tangent(2, 3) = by_q(1, 2)
        tangent(3, 3) = by_q(2, 2)
    end subroutine contact_update

    !> Spring and damper side by side, by backward Euler, are one spring of a higher stiffness with
    !> a shorter displacement (docs/theory.md, section 16).
    pure subroutine stiffen(springs, motion, loaded, old, stiffness, q)
        type(contact_springs), intent(in) :: springs
        type(contact_motion), intent(in) :: motion
        real(wp), intent(in) :: loaded           !! share of the motion that loads the contact [-]
        type(contact_point), intent(in) :: old
        real(wp), intent(out) :: stiffness       !! of both [F/L^3]
        real(wp), intent(out) :: q(2)            !! of which this is the traction without slip [L]

        stiffness = springs%tangential + damping_per_time(springs%damping, motion%dt)
        q = (springs%tangential / stiffness) * old%u_et + loaded * motion%du(2:3)
    end subroutine stiffen

    !> The elastic displacement at which spring and damper carry the traction, and the energy that
    !> the damper has taken.
    pure subroutine strain_damper(springs, motion, loaded, old, tau, new)
        type(contact_springs), intent(in) :: springs
        type(contact_motion), intent(in) :: motion
        real(wp), intent(in) :: loaded      !! share of the motion that loads the contact [-]
        type(contact_point), intent(in) :: old
        real(wp), intent(in) :: tau(2)      !! [F/L^2]
        type(contact_point), intent(inout) :: new
        real(wp) :: viscous, stiffness

        viscous = damping_per_time(springs%damping, motion%dt)
        stiffness = springs%tangential + viscous
        new%u_et = old%u_et + loaded * motion%du(2:3)
        if (new%phase == point_slip) new%u_et = tau / stiffness + (viscous / stiffness) * old%u_et
        new%dissipation = min(new%dissipation + viscous * sum((new%u_et - old%u_et)**2), largest)
    end subroutine strain_damper

    !> eta_t/dt, as far as that is a stiffness with a trial traction in range: from there on the
    !> damper is as good as rigid. An increment without time does not strain it.
    pure function damping_per_time(damping, dt) result(viscous)
        real(wp), intent(in) :: damping   !! > 0 [F T/L^3]
        real(wp), intent(in) :: dt        !! >= 0 [T]
        real(wp) :: viscous               !! [F/L^3]
        real(wp), parameter :: rigid = 2.0_wp**166

        viscous = 0.0_wp
        if (dt > 0.0_wp) viscous = min(damping, rigid * dt) / dt
    end function damping_per_time

    !> Is a contact without pressure closed all the same? With cohesion it is, where there is no
    !> gap: it carries that (docs/theory.md, section 15).
    pure function touches(cohesion, blur, u_n)
        real(wp), intent(in) :: cohesion   !! [F/L^2]
        real(wp), intent(in) :: blur       !! round-off of displacements, as in `contact_motion` [L]
        real(wp), intent(in) :: u_n   !! normal displacement at the end of the increment [L]
        logical :: touches

        touches = cohesion > 0.0_wp .and. u_n <= blur
    end function touches

    !> Derivatives where the increment closes a gap: its tangential part counts from touchdown on,
    !> and touchdown moves with the normal part.
    pure subroutine touch_down(du, gap, loaded, by_q, by_du_n)
        real(wp), intent(in) :: du(3)              !! increment of displacement [L]
        real(wp), intent(in) :: gap                !! at its start, > 0 [L]
        real(wp), intent(in) :: loaded             !! share after touchdown [-]
        real(wp), intent(inout) :: by_q(2, 2)      !! in: by the loaded displacement, out: by du
        real(wp), intent(inout) :: by_du_n(2)      !! by du(1) [F/L^3]
        real(wp) :: by_loaded(2)   !! no more than some tractions, which end with the pressure

        by_loaded = by_q(:, 1) * du(2) + by_q(:, 2) * du(3)
        by_du_n = by_du_n - (gap / du(1)) * (by_loaded / du(1))
        by_q = loaded * by_q
    end subroutine touch_down

    !> No pressure: nothing is carried, the surfaces forget their elastic displacement and heal.
    pure subroutine open_contact(surface, dt, old, new)
        class(law), intent(in) :: surface
        real(wp), intent(in) :: dt                  !! increment of time [T]
        type(contact_point), intent(in) :: old
        type(contact_point), intent(inout) :: new
        real(wp) :: strength

        new%phase = point_open
        new%u_et = 0.0_wp
        call surface%rest(0.0_wp, 0.0_wp, dt, old%inner, new%inner, strength)
        new%slip = old%slip
        new%dissipation = old%dissipation
    end subroutine open_contact

    !> Stick or slip under pressure: the tangential traction, its derivatives by `q` and by the
    !> pressure.
    pure subroutine tangential_update(surface, alpha_t, plane, q, pressure, motion, old, new, &
        tau, by_q, by_pressure, status)
        class(law), intent(in) :: surface
        real(wp), intent(in) :: alpha_t       !! tangential stiffness [F/L^3]
        type(orthotropy), intent(in) :: plane
        real(wp), intent(inout) :: q(2)       !! trial elastic tangential displacement [L]
        real(wp), intent(in) :: pressure      !! > 0, or with cohesion 0 [F/L^2]
        type(contact_motion), intent(in) :: motion
        type(contact_point), intent(in) :: old
        type(contact_point), intent(inout) :: new
        real(wp), intent(out) :: tau(2)             !! tangential traction [F/L^2]
        real(wp), intent(out) :: by_q(2, 2)         !! d(tau)/dq [F/L^3]
        real(wp), intent(out) :: by_pressure(2)     !! d(tau)/d(pressure) [-]
        integer, intent(out) :: status
        real(wp), parameter :: near_underflow = 2.0_wp**(-450)   !! of a length, in its square [L]
        type(law_state) :: start
        type(reloading) :: reload
        real(wp) :: distance, strength, limit, blur

        status = friction_bad_increment
        distance = sqrt(q(1)**2 + (plane%squeeze * q(2))**2)
        blur = max(1.0_wp, plane%squeeze) * motion%blur
        if (distance <= max(near_underflow, blur)) call measure(q, plane%squeeze, max(least, &
            motion%blur), distance)
        if (max(distance, alpha_t * distance) > largest) return
        status = friction_ok
        call surface%rest(alpha_t * distance, pressure, motion%dt, old%inner, new%inner, strength)
        start = old%inner
        if (surface%follows_path) then   ! in the axes where the ellipse is a circle
            call find_reloading([old%u_et(1), plane%squeeze * old%u_et(2)], &
                [q(1), plane%squeeze * q(2)], strength / alpha_t, max(old%inner%r, least_ratio) &
                * new%inner%mu / alpha_t, motion%blur_start, reload)
            reload%by_q(2) = plane%squeeze * reload%by_q(2)
            start%r = reload%share * start%r
            strength = max(reload%share, least_ratio / max(old%inner%r, least_ratio)) * strength
        end if
        limit = strength * (1.0_wp + verge)
        if (blur > 0.0_wp) limit = limit + alpha_t * blur + strength * relative_blur(surface, &
            motion%blur, new, pressure)
        if (alpha_t * distance <= limit) then
            new%phase = point_stick
            new%u_et(1) = q(1)
            new%u_et(2) = q(2)
            new%slip = old%slip
            new%dissipation = old%dissipation
            tau(1) = alpha_t * q(1)
            tau(2) = alpha_t * q(2)
            by_q(1, 1) = alpha_t
            by_q(2, 1) = 0.0_wp
            by_q(1, 2) = 0.0_wp
            by_q(2, 2) = alpha_t
            by_pressure = 0.0_wp
        else
            call slip_update(surface, alpha_t, plane, q, distance, pressure, motion%dt, start, &
                reload, old, new, tau, by_q, by_pressure, status)
        end if
    end subroutine tangential_update

    !> Round-off of a displacement that is not known better, as a share of the strength.
    pure function relative_blur(surface, blur, new, pressure) result(share)
        class(law), intent(in) :: surface
        real(wp), intent(in) :: blur       !! > 0 [L]
        type(contact_point), intent(in) :: new   !! what `rest` says
        real(wp), intent(in) :: pressure   !! [F/L^2]
        real(wp) :: share                  !! [-]
        real(wp) :: friction

        friction = 1.0_wp
        if (surface%cohesion > 0.0_wp) friction = new%inner%mu * pressure / (new%inner%mu &
            * pressure + surface%cohesion)   ! cohesion does not depend on the pressure
        share = 0.0_wp
        if (friction > 0.0_wp) share = friction * (blur / abs(new%u_n))
    end function relative_blur

    !> Length of a displacement whose squares may underflow; below the least one it is none.
    pure subroutine measure(q, squeeze, shortest, distance)
        real(wp), intent(inout) :: q(2)       !! [L]
        real(wp), intent(in) :: squeeze       !! how much more the second counts [-]
        real(wp), intent(in) :: shortest      !! [L]
        real(wp), intent(out) :: distance     !! its equivalent length [L]

        distance = hypot(q(1), squeeze * q(2))
        if (hypot(q(1), q(2)) > shortest) return
        q = 0.0_wp
        distance = 0.0_wp
    end subroutine measure

    !> The same where the trial traction is above the strength.
    pure subroutine slip_update(surface, alpha_t, plane, q, distance, pressure, dt, start, reload, &
        old, new, tau, by_q, by_pressure, status)
        class(law), intent(in) :: surface
        real(wp), intent(in) :: alpha_t       !! tangential stiffness [F/L^3]
        type(orthotropy), intent(in) :: plane
        real(wp), intent(in) :: q(2)          !! trial elastic tangential displacement [L]
        real(wp), intent(in) :: distance      !! its equivalent length [L]
        real(wp), intent(in) :: pressure      !! > 0 [F/L^2]
        real(wp), intent(in) :: dt            !! increment of time [T]
        type(law_state), intent(in) :: start  !! internal variables at the start of sliding
        type(reloading), intent(in) :: reload   !! for a law that follows the path
        type(contact_point), intent(in) :: old
        type(contact_point), intent(inout) :: new
        real(wp), intent(out) :: tau(2)             !! tangential traction [F/L^2]
        real(wp), intent(out) :: by_q(2, 2)         !! d(tau)/dq [F/L^3]
        real(wp), intent(out) :: by_pressure(2)     !! d(tau)/d(pressure) [-]
        integer, intent(out) :: status
        type(sliding) :: slid
        type(sliding_way) :: way
        real(wp) :: mean, share, coupling, by_p, pull(2), start_rate

        if (plane%associated) then
            call slide_associated(surface, alpha_t, plane%squeeze, q, distance, pressure, dt, &
                start, slid, way, status)
        else
            call slide_radially(surface, alpha_t, plane%squeeze, q, distance, pressure, dt, &
                start, slid, way, status)
        end if
        if (status < 0) return

        ! How the slip's resistance grows with q, and with the pressure.
        pull(1) = slid%d_slip * way%along(1) + way%cross_stiffness * way%along(2)
        pull(2) = slid%d_slip * way%along(2) - way%cross_stiffness * way%along(1)
        by_p = slid%d_pressure
        mean = slid%resistance
        if (surface%follows_path) then   ! the traction at the start of sliding counts, too
            start_rate = old%inner%r * surface%start_rate(pressure, start, slid%state)
            pull = pull + start_rate * reload%by_q
            by_p = by_p + start_rate * reload%by_pressure
            mean = 0.5_wp * (mean + alpha_t * reload%share * hypot(old%u_et(1), &
                plane%squeeze * old%u_et(2)))
        end if
        coupling = alpha_t / max(way%stiffness + slid%d_slip, epsilon(alpha_t) * way%stiffness)

        tau(1) = way%tau(1)
        tau(2) = way%tau(2)
        new%phase = point_slip
        new%inner%mu = min(slid%state%mu, largest)
        new%inner%r = min(slid%state%r, largest)
        share = 1.0_wp / alpha_t
        new%u_et(1) = share * tau(1)
        new%u_et(2) = share * tau(2)
        new%slip = min(old%slip + slid%slip, largest)
        new%dissipation = min(old%dissipation + mean * slid%slip * way%work_ratio, largest)
        by_pressure(1) = coupling * by_p * way%response(1)
        by_pressure(2) = coupling * by_p * way%response(2)
        by_q(1, 1) = coupling * way%response(1) * pull(1) + way%across * way%along(2)**2
        by_q(2, 1) = coupling * way%response(2) * pull(1) - way%across * way%along(1) * way%along(2)
        by_q(1, 2) = coupling * way%response(1) * pull(2) - way%across * way%along(1) * way%along(2)
        by_q(2, 2) = coupling * way%response(2) * pull(2) + way%across * way%along(1)**2
    end subroutine slip_update

    !> Along the trial traction, as every isotropic surface slides (squeeze = 1), and an orthotropic
    !> one by option. How much of the traction counts depends on the direction alone.
    pure subroutine slide_radially(surface, alpha_t, squeeze, q, distance, pressure, dt, start, &
        slid, way, status)
        class(law), intent(in) :: surface
        real(wp), intent(in) :: alpha_t         !! tangential stiffness [F/L^3]
        real(wp), intent(in) :: squeeze         !! [-]
        real(wp), intent(in) :: q(2)            !! trial elastic displacement [L]
        real(wp), intent(in) :: distance        !! its equivalent length [L]
        real(wp), intent(in) :: pressure        !! > 0 [F/L^2]
        real(wp), intent(in) :: dt              !! increment of time [T]
        type(law_state), intent(in) :: start    !! at the start of sliding
        type(sliding), intent(out) :: slid
        type(sliding_way), intent(out) :: way
        integer, intent(out) :: status          !! ok, snap back, or no convergence
        real(wp) :: inverse

        inverse = 1.0_wp / distance
        way%stiffness = alpha_t
        way%work_ratio = 1.0_wp
        way%cross_stiffness = 0.0_wp
        if (abs(squeeze - 1.0_wp) > 0.0_wp) then
            inverse = 1.0_wp / hypot(q(1), q(2))
            way%stiffness = alpha_t * distance * inverse
            way%work_ratio = alpha_t / way%stiffness
            way%cross_stiffness = (q(1) * inverse) * (q(2) * inverse) * (squeeze**2 - 1.0_wp) &
                * way%work_ratio
        end if
        call return_map(surface, alpha_t * distance, way%stiffness, pressure, dt, start, slid, &
            status)
        if (status < 0) return
        way%across = slid%resistance * way%work_ratio * inverse
        way%cross_stiffness = way%cross_stiffness * way%across
        way%tau(1) = way%across * q(1)
        way%tau(2) = way%across * q(2)
        way%along(1) = q(1) * inverse
        way%along(2) = q(2) * inverse
        way%response(1) = way%along(1)
        way%response(2) = way%along(2)
    end subroutine slide_radially

end module friction_contact
