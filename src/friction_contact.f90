!> One contact point through one increment: normal and tangential springs, open, touchdown, stick
!> and slip, and the consistent tangent (docs/theory.md, sections 2 to 5).
module friction_contact
    use friction_kinds, only : wp
    use friction_law, only : law, law_state, sliding
    use friction_return_map, only : return_map
    use friction_status, only : friction_ok
    implicit none
    private

    public :: contact_motion, contact_point, contact_response, contact_springs, contact_update

    integer, parameter, public :: point_virgin = 0   !! nothing has happened yet
    integer, parameter, public :: point_stick = 1    !! closed, tangentially elastic
    integer, parameter, public :: point_slip = 2     !! closed, has slid in this increment
    integer, parameter, public :: point_open = 3     !! no pressure

    !> Elastic (penalty) stiffness of the contact.
    type :: contact_springs
        real(wp) :: normal       !! alpha_n, > 0 [F/L^3]
        real(wp) :: tangential   !! alpha_t, > 0 [F/L^3]
    end type contact_springs

    !> What happens in an increment. A host that controls the pressure itself hands it in.
    type :: contact_motion
        real(wp) :: du(3) = 0.0_wp   !! relative displacement: normal, tangential 1 and 2 [L]
        real(wp) :: dt = 0.0_wp                !! increment of time, >= 0 [T]
        logical :: pressure_given = .false.    !! the pressure below replaces the normal spring
        real(wp) :: pressure = 0.0_wp          !! at the end of the increment [F/L^2]
    end type contact_motion

    !> State of a contact point.
    type :: contact_point
        integer :: phase = point_virgin      !! one of the four above
        real(wp) :: u_n = 0.0_wp   !! normal relative displacement, negative = penetration [L]
        real(wp) :: u_et(2) = 0.0_wp         !! elastic tangential displacement [L]
        type(law_state) :: inner             !! internal variables of the law
        real(wp) :: slip = 0.0_wp            !! accumulated slip [L]
        real(wp) :: dissipation = 0.0_wp     !! accumulated dissipated energy per area [F/L]
    end type contact_point

    type :: contact_response
        real(wp) :: traction(3)  !! transmitted: normal (negative = compression), tangential [F/L^2]
        real(wp) :: tangent(3, 3)   !! d(traction)/d(du); where the pressure is given, column 1 is
                                    !! d/d(pressure)
    end type contact_response

contains

    !> Traction, consistent tangent and new state of a contact point.
    pure subroutine contact_update(surface, springs, motion, old, new, response, status)
        class(law), intent(in) :: surface
        type(contact_springs), intent(in) :: springs
        type(contact_motion), intent(in) :: motion
        type(contact_point), intent(in) :: old         !! state at the start of the increment
        type(contact_point), intent(out) :: new        !! state at its end
        type(contact_response), intent(out) :: response
        integer, intent(out) :: status                 !! ok, snap back, or no convergence
        real(wp) :: pressure, loaded, d_loaded, q(2)

        new = old
        status = friction_ok
        if (motion%pressure_given) then
            pressure = motion%pressure
            new%u_n = -pressure / springs%normal
        else
            new%u_n = old%u_n + motion%du(1)
            pressure = -springs%normal * new%u_n
        end if
        if (.not. pressure > 0.0_wp) then
            call open_contact(surface, motion%dt, old, new, response)
            return
        end if

        ! Only the part of the increment after touchdown loads the contact.
        loaded = 1.0_wp
        d_loaded = 0.0_wp
        if (old%u_n > 0.0_wp .and. .not. motion%pressure_given) then
            loaded = new%u_n / motion%du(1)
            d_loaded = -old%u_n / motion%du(1)**2
        end if
        q = old%u_et + loaded * motion%du(2:3)

        call tangential_update(surface, springs%tangential, q, pressure, motion%dt, old, new, &
            response, status)
        response%traction(1) = -pressure
        response%tangent(1, 1:3) = 0.0_wp
        if (motion%pressure_given) then
            response%tangent(1, 1) = -1.0_wp
        else
            response%tangent(1, 1) = springs%normal
            response%tangent(2:3, 1) = -springs%normal * response%tangent(2:3, 1) &
                + d_loaded * matmul(response%tangent(2:3, 2:3), motion%du(2:3))
            response%tangent(2:3, 2:3) = loaded * response%tangent(2:3, 2:3)
        end if
    end subroutine contact_update

    !> No pressure: nothing is carried, the surfaces forget their elastic displacement and heal.
    pure subroutine open_contact(surface, dt, old, new, response)
        class(law), intent(in) :: surface
        real(wp), intent(in) :: dt                  !! increment of time [T]
        type(contact_point), intent(in) :: old
        type(contact_point), intent(inout) :: new
        type(contact_response), intent(out) :: response
        real(wp) :: strength

        new%phase = point_open
        new%u_et = 0.0_wp
        call surface%rest(0.0_wp, 0.0_wp, dt, old%inner, new%inner, strength)
        response%traction = 0.0_wp
        response%tangent = 0.0_wp
    end subroutine open_contact

    !> Stick or slip under pressure: tangential traction, its derivatives by `q` (columns 2, 3) and
    !> by the pressure (column 1).
    pure subroutine tangential_update(surface, alpha_t, q, pressure, dt, old, new, response, status)
        class(law), intent(in) :: surface
        real(wp), intent(in) :: alpha_t       !! tangential stiffness [F/L^3]
        real(wp), intent(in) :: q(2)          !! trial elastic tangential displacement [L]
        real(wp), intent(in) :: pressure      !! > 0 [F/L^2]
        real(wp), intent(in) :: dt            !! increment of time [T]
        type(contact_point), intent(in) :: old
        type(contact_point), intent(inout) :: new
        type(contact_response), intent(inout) :: response
        integer, intent(out) :: status
        type(sliding) :: slid
        real(wp) :: distance, strength, t(2), along, across, stiffness

        status = friction_ok
        distance = sqrt(q(1)**2 + q(2)**2)
        call surface%rest(alpha_t * distance, pressure, dt, old%inner, new%inner, strength)
        if (alpha_t * distance <= strength) then
            new%phase = point_stick
            new%u_et = q
            response%traction(2:3) = alpha_t * q
            response%tangent(2:3, 1) = 0.0_wp
            response%tangent(2:3, 2) = [alpha_t, 0.0_wp]
            response%tangent(2:3, 3) = [0.0_wp, alpha_t]
            return
        end if

        call return_map(surface, alpha_t * distance, alpha_t, pressure, dt, old%inner, slid, status)
        t = q / distance
        new%phase = point_slip
        new%inner = slid%state
        new%u_et = slid%resistance / alpha_t * t
        new%slip = old%slip + slid%slip
        new%dissipation = old%dissipation + slid%resistance * slid%slip

        ! d(tau)/d(trial): `along` the sliding direction, `across` it by its rotation alone.
        stiffness = max(alpha_t + slid%d_slip, epsilon(alpha_t) * alpha_t)
        along = alpha_t * slid%d_slip / stiffness
        across = slid%resistance / distance
        response%traction(2:3) = slid%resistance * t
        response%tangent(2:3, 1) = alpha_t / stiffness * slid%d_pressure * t
        response%tangent(2, 2) = along * t(1)**2 + across * t(2)**2
        response%tangent(3, 3) = along * t(2)**2 + across * t(1)**2
        response%tangent(3, 2) = (along - across) * t(1) * t(2)
        response%tangent(2, 3) = response%tangent(3, 2)
    end subroutine tangential_update

end module friction_contact
