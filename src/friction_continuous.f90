!> One contact point in continuous time: the rates of its state for a relative velocity
!> (docs/theory.md, section 10). The update of module `friction_contact` tends to them as its
!> increment of time tends to zero.
module friction_continuous
    use friction_anisotropy, only : orthotropy
    use friction_contact, only : contact_point, contact_springs
    use friction_kinds, only : wp
    use friction_law, only : law, law_state, load_rates
    implicit none
    private

    public :: contact_rates, point_rates

    !> Rates of a contact point's state.
    type :: point_rates
        real(wp) :: u_n            !! normal relative displacement [L/T]
        real(wp) :: u_et(2)        !! elastic tangential displacement [L/T]
        type(law_state) :: inner   !! internal variables of the law
        real(wp) :: slip           !! accumulated slip, >= 0 [L/T]
        real(wp) :: dissipation    !! accumulated dissipated energy per area, >= 0 [F/L/T]
    end type point_rates

contains

    !> What slips and what evolves under a velocity.
    pure subroutine contact_rates(surface, springs, plane, velocity, point, rates, jumps)
        class(law), intent(in) :: surface
        type(contact_springs), intent(in) :: springs
        type(orthotropy), intent(in) :: plane    !! how friction depends on the direction
        real(wp), intent(in) :: velocity(3)      !! relative: normal, tangential 1 and 2 [L/T]
        type(contact_point), intent(in) :: point
        type(point_rates), intent(out) :: rates
        logical, intent(out) :: jumps   !! slip starts with a jump: it has no rate
        type(load_rates) :: load
        real(wp) :: gradient(2), along(2), v(2)

        v = velocity(2:3)
        load%pressure = max(0.0_wp, -springs%normal * point%u_n)
        load%pressure_rate = 0.0_wp
        load%sliding = .false.
        rates%u_n = velocity(1)
        rates%u_et = 0.0_wp
        rates%slip = 0.0_wp
        rates%dissipation = 0.0_wp
        if (load%pressure > 0.0_wp) then
            load%pressure_rate = -springs%normal * velocity(1)
            call slip_directions(plane, point%u_et, v, gradient, along)
            load%traction = springs%tangential * hypot(point%u_et(1), plane%squeeze &
                * point%u_et(2))
            load%loading = springs%tangential * dot_product(gradient, v)
            load%stiffness = springs%tangential * dot_product(gradient, along)
            call surface%slip_rate(point%inner, load, rates%slip, jumps)
            rates%u_et = v - rates%slip * along
            rates%dissipation = max(0.0_wp, springs%tangential * dot_product(point%u_et, along) &
                * rates%slip)
        else
            jumps = .false.
            load%traction = 0.0_wp
            load%loading = 0.0_wp
            load%stiffness = springs%tangential
        end if
        rates%inner = surface%state_rates(point%inner, load, rates%slip)
    end subroutine contact_rates

    !> The gradient of the equivalent traction by the traction, and the unit vector of the slip. A
    !> contact that carries nothing goes where it is pulled.
    pure subroutine slip_directions(plane, u_et, v, gradient, along)
        type(orthotropy), intent(in) :: plane
        real(wp), intent(in) :: u_et(2)       !! elastic tangential displacement [L]
        real(wp), intent(in) :: v(2)          !! tangential velocity [L/T]
        real(wp), intent(out) :: gradient(2)  !! [-]
        real(wp), intent(out) :: along(2)     !! [-]
        logical :: loaded

        along = u_et
        loaded = any(abs(u_et) > 0.0_wp)
        if (.not. loaded) along = v
        if (.not. any(abs(along) > 0.0_wp)) along = [1.0_wp, 0.0_wp]
        along = along / hypot(along(1), along(2))
        gradient = along * [1.0_wp, plane%squeeze**2] / hypot(along(1), plane%squeeze * along(2))
        if (plane%associated .and. loaded) along = gradient / hypot(gradient(1), gradient(2))
    end subroutine slip_directions

end module friction_continuous
