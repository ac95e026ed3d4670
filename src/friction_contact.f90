!> One contact point through one increment: normal and tangential springs, open, touchdown, stick
!> and slip, and the consistent tangent (docs/theory.md, sections 2 to 5).
module friction_contact
    use friction_anisotropy, only : orthotropy, slide_associated, sliding_way, tangential_trial
    use friction_kinds, only : largest, wp
    use friction_law, only : law, law_state, least_ratio, sliding
    use friction_reloading, only : find_reloading, reloading
    use friction_return_map, only : return_map
    use friction_status, only : friction_bad_increment, friction_ok
    implicit none
    private

    public :: contact_constants, contact_motion, contact_point, contact_update, touches
    public :: answer_of_slip, answer_of_stick, follow_trial, tangential_answer, write_answer

    !> A trial sticks if it is above the strength by no more than this share, which is round-off
    !> (docs/theory.md, section 3).
    real(wp), parameter, public :: verge = 32.0_wp * epsilon(verge)

    !> Pressures [F/L^2] and displacements [L] below this are none: their quotients would leave the
    !> range of the arithmetic.
    real(wp), parameter, public :: least = 2.0_wp**(-960)

    !> The square of a length above this does not underflow [L].
    real(wp), parameter, public :: near_underflow = 2.0_wp**(-450)

    integer, parameter, public :: point_virgin = 0   !! nothing has happened yet
    integer, parameter, public :: point_stick = 1    !! closed, tangentially elastic
    integer, parameter, public :: point_slip = 2     !! closed, has slid in this increment
    integer, parameter, public :: point_open = 3     !! no pressure

    !> What a contact is made of beside its friction law.
    type :: contact_constants
        real(wp) :: normal        !! penalty stiffness alpha_n, > 0 [F/L^3]
        real(wp) :: tangential    !! penalty stiffness alpha_t, > 0 [F/L^3]
        real(wp) :: damping       !! of the damper beside that, >= 0 [F T/L^3]
        type(orthotropy) :: plane !! how friction depends on the direction
    end type contact_constants

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

    !> What the contact carries tangentially, and its derivatives.
    type :: tangential_answer
        real(wp) :: tau(2)           !! traction [F/L^2]
        real(wp) :: by_q(2, 2)       !! d(tau)/dq, q being the trial displacement [F/L^3]
        real(wp) :: by_pressure(2)   !! d(tau)/d(pressure) [-]
    end type tangential_answer

contains

    !> Traction, consistent tangent and new state of a contact point. Only on a status >= 0 do they
    !> mean anything, and only then are traction and tangent written.
    pure subroutine contact_update(surface, constants, motion, old, new, traction, tangent, status)
        class(law), intent(in) :: surface
        type(contact_constants), intent(in) :: constants
        type(contact_motion), intent(in) :: motion
        type(contact_point), intent(in) :: old       !! state at the start of the increment
        type(contact_point), intent(out) :: new      !! state at its end
        real(wp), intent(inout) :: traction(3)   !! transmitted, normal (negative = compression),
                                                 !! tangential [F/L^2]
        real(wp), intent(inout) :: tangent(3, 3)   !! d(traction)/d(du); where the pressure is
                                                   !! given, column 1 is d/d(pressure)
        integer, intent(out) :: status   !! ok, snap back, bad increment, or no convergence
        type(tangential_trial) :: trial
        type(tangential_answer) :: answer
        real(wp) :: loaded, normal
        logical :: closed, simple

        call find_normal(surface, constants, motion, old, new, trial%pressure, closed, status)
        if (status < 0) return
        if (.not. closed) then
            call open_contact(surface, motion%dt, old, new)
            traction = 0.0_wp
            tangent = 0.0_wp
            return
        end if
        trial%stiffness = constants%tangential
        trial%q(1) = old%u_et(1) + motion%du(2)
        trial%q(2) = old%u_et(2) + motion%du(3)
        loaded = 1.0_wp
        simple = .not. (constants%damping > 0.0_wp .or. old%u_n > 0.0_wp)
        if (.not. simple) call load(constants, motion, old, new, loaded, trial)
        call tangential_update(surface, constants%plane, motion, old, trial, new, answer, status)
        if (status < 0) return
        if (.not. motion%pressure_given) answer%by_pressure = -constants%normal &
            * answer%by_pressure
        if (.not. simple) then
            if (constants%damping > 0.0_wp) call strain_damper(constants, motion, loaded, old, &
                answer%tau, new)
            if (loaded < 1.0_wp) call touch_down(motion%du, old%u_n, loaded, answer)
        end if
        normal = constants%normal
        if (motion%pressure_given) normal = -1.0_wp
        call write_answer(normal, trial%pressure, answer, traction, tangent)
    end subroutine contact_update

    !> What a closed contact carries, component by component.
    pure subroutine write_answer(normal, pressure, answer, traction, tangent)
        real(wp), intent(in) :: normal     !! derivative of the normal traction by what moves it
        real(wp), intent(in) :: pressure   !! [F/L^2]
        type(tangential_answer), intent(in) :: answer
        real(wp), intent(inout) :: traction(3), tangent(3, 3)   !! out, as of `contact_update`

        traction(1) = -pressure
        traction(2) = answer%tau(1)
        traction(3) = answer%tau(2)
        tangent(1, 1) = normal
        tangent(1, 2) = 0.0_wp
        tangent(1, 3) = 0.0_wp
        tangent(2, 1) = answer%by_pressure(1)
        tangent(3, 1) = answer%by_pressure(2)
        tangent(2, 2) = answer%by_q(1, 1)
        tangent(3, 2) = answer%by_q(2, 1)
        tangent(2, 3) = answer%by_q(1, 2)
        tangent(3, 3) = answer%by_q(2, 2)
    end subroutine write_answer

    !> Normal displacement and pressure at the end of the increment, and whether the contact is
    !> closed then.
    pure subroutine find_normal(surface, constants, motion, old, new, pressure, closed, status)
        class(law), intent(in) :: surface
        type(contact_constants), intent(in) :: constants
        type(contact_motion), intent(in) :: motion
        type(contact_point), intent(in) :: old
        type(contact_point), intent(inout) :: new   !! out: normal displacement
        real(wp), intent(out) :: pressure           !! [F/L^2]
        logical, intent(out) :: closed
        integer, intent(out) :: status              !! ok or bad increment

        new%u_n = old%u_n + motion%du(1)
        pressure = -constants%normal * new%u_n
        if (motion%pressure_given) then
            pressure = motion%pressure
            new%u_n = -pressure / constants%normal
        end if
        status = friction_bad_increment
        if (max(abs(new%u_n), pressure) > largest) return
        status = friction_ok
        closed = pressure > least
        if (closed) return
        closed = touches(surface%cohesion, motion%blur, new%u_n)
        if (closed) new%u_n = min(new%u_n, 0.0_wp)   ! or round-off would add up to a gap
        pressure = 0.0_wp
    end subroutine find_normal

    !> Only the part of an increment after touchdown loads a contact that was open, unless the
    !> pressure is given: the share of that.
    pure function share_after_touchdown(motion, old, new) result(share)
        type(contact_motion), intent(in) :: motion
        type(contact_point), intent(in) :: old    !! with a gap
        type(contact_point), intent(in) :: new    !! closed
        real(wp) :: share                         !! 0 to 1 [-]

        share = 1.0_wp
        if (motion%pressure_given) return
        if (.not. old%u_n > motion%blur) return   ! touches from the start
        share = min(new%u_n, 0.0_wp) / motion%du(1)
    end function share_after_touchdown

    !> What loads a contact that was open, or has a damper. Spring and damper side by side, by
    !> backward Euler, are one spring of a higher stiffness with a shorter displacement
    !> (docs/theory.md, section 16).
    pure subroutine load(constants, motion, old, new, loaded, trial)
        type(contact_constants), intent(in) :: constants
        type(contact_motion), intent(in) :: motion
        type(contact_point), intent(in) :: old
        type(contact_point), intent(in) :: new     !! closed
        real(wp), intent(inout) :: loaded   !! in: 1, out: share of the motion that loads it [-]
        type(tangential_trial), intent(inout) :: trial   !! out: q and its stiffness

        if (old%u_n > 0.0_wp) loaded = share_after_touchdown(motion, old, new)
        trial%q = old%u_et
        if (constants%damping > 0.0_wp) then
            trial%stiffness = constants%tangential + damping_per_time(constants%damping, motion%dt)
            trial%q = (constants%tangential / trial%stiffness) * old%u_et
        end if
        trial%q = trial%q + loaded * motion%du(2:3)
    end subroutine load

    !> The elastic displacement at which spring and damper carry the traction, and the energy that
    !> the damper has taken.
    pure subroutine strain_damper(constants, motion, loaded, old, tau, new)
        type(contact_constants), intent(in) :: constants
        type(contact_motion), intent(in) :: motion
        real(wp), intent(in) :: loaded      !! share of the motion that loads the contact [-]
        type(contact_point), intent(in) :: old
        real(wp), intent(in) :: tau(2)      !! [F/L^2]
        type(contact_point), intent(inout) :: new
        real(wp) :: viscous, stiffness

        viscous = damping_per_time(constants%damping, motion%dt)
        stiffness = constants%tangential + viscous
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
    pure subroutine touch_down(du, gap, loaded, answer)
        real(wp), intent(in) :: du(3)              !! increment of displacement [L]
        real(wp), intent(in) :: gap                !! at its start, > 0 [L]
        real(wp), intent(in) :: loaded             !! share after touchdown [-]
        type(tangential_answer), intent(inout) :: answer   !! in: by the loaded displacement and
                                                           !! by du(1), out: by du
        real(wp) :: by_loaded(2)   !! no more than some tractions, which end with the pressure

        by_loaded = answer%by_q(:, 1) * du(2) + answer%by_q(:, 2) * du(3)
        answer%by_pressure = answer%by_pressure - (gap / du(1)) * (by_loaded / du(1))
        answer%by_q = loaded * answer%by_q
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
    pure subroutine tangential_update(surface, plane, motion, old, trial, new, answer, status)
        class(law), intent(in) :: surface
        type(orthotropy), intent(in) :: plane
        type(contact_motion), intent(in) :: motion
        type(contact_point), intent(in) :: old
        type(tangential_trial), intent(inout) :: trial   !! out: distance and start, too; a q next
                                                         !! to nothing is none
        type(contact_point), intent(inout) :: new
        type(tangential_answer), intent(out) :: answer
        integer, intent(out) :: status
        type(reloading) :: reload
        real(wp) :: strength, limit, blur, stiffness

        status = friction_bad_increment
        stiffness = trial%stiffness
        trial%distance = sqrt(trial%q(1)**2 + (plane%squeeze * trial%q(2))**2)
        blur = max(1.0_wp, plane%squeeze) * motion%blur
        if (trial%distance <= max(near_underflow, blur)) call measure(trial%q, plane%squeeze, &
            max(least, motion%blur), trial%distance)
        if (max(trial%distance, stiffness * trial%distance) > largest) return
        status = friction_ok
        call surface%rest(stiffness * trial%distance, trial%pressure, motion%dt, old%inner, &
            new%inner, strength)
        if (surface%follows_path) then   ! in the axes where the ellipse is a circle
            call find_reloading([old%u_et(1), plane%squeeze * old%u_et(2)], &
                [trial%q(1), plane%squeeze * trial%q(2)], strength / stiffness, &
                max(old%inner%r, least_ratio) * new%inner%mu / stiffness, motion%blur_start, &
                reload)
            reload%by_q(2) = plane%squeeze * reload%by_q(2)
            strength = max(reload%share, least_ratio / max(old%inner%r, least_ratio)) * strength
        end if
        limit = strength * (1.0_wp + verge)
        if (blur > 0.0_wp) limit = limit + stiffness * blur + strength * relative_blur(surface, &
            motion%blur, new, trial%pressure)
        if (stiffness * trial%distance <= limit) then
            call answer_of_stick(trial, old, new, answer)
        else
            trial%dt = motion%dt
            trial%start = old%inner
            if (stiffness * trial%distance > surface%tau_max) call lower_to_cap(surface%tau_max, &
                blur, trial)
            if (surface%follows_path) trial%start%r = reload%share * trial%start%r
            call slip_update(surface, plane, trial, reload, old, new, answer, status)
        end if
    end subroutine tangential_update

    !> Nothing slips: all of the motion strains the spring.
    pure subroutine answer_of_stick(trial, old, new, answer)
        type(tangential_trial), intent(in) :: trial
        type(contact_point), intent(in) :: old
        type(contact_point), intent(inout) :: new   !! out: all but normal displacement and `inner`
        type(tangential_answer), intent(out) :: answer

        new%phase = point_stick
        new%u_et(1) = trial%q(1)
        new%u_et(2) = trial%q(2)
        new%slip = old%slip
        new%dissipation = old%dissipation
        answer%tau(1) = trial%stiffness * trial%q(1)
        answer%tau(2) = trial%stiffness * trial%q(2)
        answer%by_q(1, 1) = trial%stiffness
        answer%by_q(2, 1) = 0.0_wp
        answer%by_q(1, 2) = 0.0_wp
        answer%by_q(2, 2) = trial%stiffness
        answer%by_pressure = 0.0_wp
    end subroutine answer_of_stick

    !> A trial that round-off alone holds above the cap is put just below it: so a surface which
    !> creeps under any traction creeps there, whatever the last bits say, as others stick.
    pure subroutine lower_to_cap(tau_max, blur, trial)
        real(wp), intent(in) :: tau_max   !! below the trial [F/L^2]
        real(wp), intent(in) :: blur      !! round-off of displacements, as in `contact_motion` [L]
        type(tangential_trial), intent(inout) :: trial
        real(wp) :: share

        if (trial%stiffness * trial%distance > tau_max * (1.0_wp + verge) + trial%stiffness &
            * blur) return
        share = (1.0_wp - 2.0_wp * epsilon(share)) * (tau_max / (trial%stiffness * trial%distance))
        trial%q(1) = share * trial%q(1)
        trial%q(2) = share * trial%q(2)
        trial%distance = share * trial%distance
    end subroutine lower_to_cap

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
    pure subroutine slip_update(surface, plane, trial, reload, old, new, answer, status)
        class(law), intent(in) :: surface
        type(orthotropy), intent(in) :: plane
        type(tangential_trial), intent(in) :: trial
        type(reloading), intent(in) :: reload   !! for a law that follows the path
        type(contact_point), intent(in) :: old
        type(contact_point), intent(inout) :: new
        type(tangential_answer), intent(out) :: answer
        integer, intent(out) :: status
        type(sliding) :: slid
        type(sliding_way) :: way
        real(wp) :: mean, by_p, pull(2), start_rate

        if (plane%associated) then
            call slide_associated(surface, plane%squeeze, trial, slid, way, status)
        else
            call slide_radially(surface, plane%squeeze, trial, slid, way, status)
        end if
        if (status < 0) return

        ! How the slip's resistance grows with q, and with the pressure.
        pull(1) = slid%d_slip * way%along(1) + way%cross_stiffness * way%along(2)
        pull(2) = slid%d_slip * way%along(2) - way%cross_stiffness * way%along(1)
        by_p = slid%d_pressure
        mean = slid%resistance
        if (surface%follows_path) then   ! the traction at the start of sliding counts, too
            if (any(abs(reload%by_q) > 0.0_wp)) then
                start_rate = old%inner%r * surface%start_rate(trial%pressure, trial%start, slid)
                pull = pull + start_rate * reload%by_q
                by_p = by_p + start_rate * reload%by_pressure
            end if
            mean = 0.5_wp * (mean + trial%stiffness * reload%share * hypot(old%u_et(1), &
                plane%squeeze * old%u_et(2)))
        end if

        new%dissipation = min(old%dissipation + mean * slid%slip * way%work_ratio, largest)
        call answer_of_slip(trial%stiffness, slid, way, pull, by_p, old, new, answer)
    end subroutine slip_update

    !> State and traction of a contact that has slid, and the derivatives (docs/theory.md, section
    !> 4).
    pure subroutine answer_of_slip(stiffness, slid, way, pull, by_p, old, new, answer)
        real(wp), intent(in) :: stiffness   !! of the tangential spring [F/L^3]
        type(sliding), intent(in) :: slid
        type(sliding_way), intent(in) :: way
        real(wp), intent(in) :: pull(2)     !! growth of the resistance with q [F/L^3]
        real(wp), intent(in) :: by_p        !! and with the pressure [-]
        type(contact_point), intent(in) :: old
        type(contact_point), intent(inout) :: new   !! out: all but normal displacement and
                                                    !! dissipation
        type(tangential_answer), intent(out) :: answer
        real(wp) :: share, coupling, response(2)

        new%phase = point_slip
        new%inner%mu = min(slid%state%mu, largest)
        new%inner%r = min(slid%state%r, largest)
        share = 1.0_wp / stiffness
        new%u_et(1) = share * way%tau(1)
        new%u_et(2) = share * way%tau(2)
        new%slip = min(old%slip + slid%slip, largest)
        answer%tau(1) = way%tau(1)
        answer%tau(2) = way%tau(2)
        coupling = stiffness / max(way%stiffness + slid%d_slip, epsilon(share) * way%stiffness)
        response(1) = coupling * way%response(1)
        response(2) = coupling * way%response(2)
        answer%by_pressure(1) = response(1) * by_p
        answer%by_pressure(2) = response(2) * by_p
        answer%by_q(1, 1) = response(1) * pull(1) + way%across * way%along(2)**2
        answer%by_q(2, 1) = response(2) * pull(1) - way%across * way%along(1) * way%along(2)
        answer%by_q(1, 2) = response(1) * pull(2) - way%across * way%along(1) * way%along(2)
        answer%by_q(2, 2) = response(2) * pull(2) + way%across * way%along(1)**2
    end subroutine answer_of_slip

    !> Along the trial traction, as every isotropic surface slides (squeeze = 1), and an orthotropic
    !> one by option. How much of the traction counts depends on the direction alone.
    pure subroutine slide_radially(surface, squeeze, trial, slid, way, status)
        class(law), intent(in) :: surface
        real(wp), intent(in) :: squeeze         !! [-]
        type(tangential_trial), intent(in) :: trial
        type(sliding), intent(out) :: slid
        type(sliding_way), intent(out) :: way
        integer, intent(out) :: status          !! ok, snap back, or no convergence
        real(wp) :: inverse

        inverse = 1.0_wp / trial%distance
        way%stiffness = trial%stiffness
        way%work_ratio = 1.0_wp
        way%cross_stiffness = 0.0_wp
        if (abs(squeeze - 1.0_wp) > 0.0_wp) then
            inverse = 1.0_wp / hypot(trial%q(1), trial%q(2))
            way%stiffness = trial%stiffness * trial%distance * inverse
            way%work_ratio = trial%stiffness / way%stiffness
            way%cross_stiffness = (trial%q(1) * inverse) * (trial%q(2) * inverse) &
                * (squeeze**2 - 1.0_wp) * way%work_ratio
        end if
        call return_map(surface, trial%stiffness * trial%distance, way%stiffness, trial%pressure, &
            trial%dt, trial%start, slid, status)
        if (status < 0) return
        call follow_trial(trial%q, inverse, slid%resistance * way%work_ratio, way)
        way%cross_stiffness = way%cross_stiffness * way%across
    end subroutine slide_radially

    !> A traction along the trial displacement, and a slip along both.
    pure subroutine follow_trial(q, inverse, traction, way)
        real(wp), intent(in) :: q(2)       !! trial displacement [L]
        real(wp), intent(in) :: inverse    !! of its length [1/L]
        real(wp), intent(in) :: traction   !! [F/L^2]
        type(sliding_way), intent(inout) :: way   !! out: traction, directions, and `across`

        way%across = traction * inverse
        way%tau(1) = way%across * q(1)
        way%tau(2) = way%across * q(2)
        way%along(1) = q(1) * inverse
        way%along(2) = q(2) * inverse
        way%response(1) = way%along(1)
        way%response(2) = way%along(2)
    end subroutine follow_trial

end module friction_contact
