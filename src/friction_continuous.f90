!> One contact point in continuous time: the rates of its state for a relative velocity
!> (docs/theory.md, section 10). The update of module `friction_contact` tends to them as its
!> increment of time tends to zero.
module friction_continuous
    use friction_anisotropy, only : associated_spring, associated_way, orthotropy, sliding_way
    use friction_contact, only : contact_constants, contact_point
    use friction_kinds, only : wp
    use friction_law, only : law, law_state, law_traits, load_rates
    use friction_return_map, only : middle, unloaded, unloading
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
    pure subroutine contact_rates(surface, constants, velocity, point, rates, jumps)
        class(law), intent(in) :: surface
        type(contact_constants), intent(in) :: constants
        real(wp), intent(in) :: velocity(3)      !! relative: normal, tangential 1 and 2 [L/T]
        type(contact_point), intent(in) :: point
        type(point_rates), intent(out) :: rates
        logical, intent(out) :: jumps   !! slip starts with a jump: it has no rate
        type(load_rates) :: load
        real(wp) :: gradient(2), along(2), v(2)
        logical :: closed

        v = velocity(2:3)
        load%pressure = max(0.0_wp, -constants%normal * point%u_n)
        load%pressure_rate = 0.0_wp
        load%sliding = .false.
        rates%u_n = velocity(1)
        rates%u_et = 0.0_wp
        rates%slip = 0.0_wp
        rates%dissipation = 0.0_wp
        closed = load%pressure > 0.0_wp
        if (.not. closed) closed = surface%cohesion > 0.0_wp .and. point%u_n <= 0.0_wp &
            .and. .not. velocity(1) > 0.0_wp
        if (closed) then
            load%pressure_rate = -constants%normal * velocity(1)
            if (constants%damping > 0.0_wp) then
                call damped_rates(surface, constants, v, point, load, rates, jumps)
                return
            end if
            call slip_directions(constants%plane, point%u_et, v, gradient, along)
            load%traction = constants%tangential * hypot(point%u_et(1), constants%plane%squeeze &
                * point%u_et(2))
            load%loading = constants%tangential * dot_product(gradient, v)
            load%stiffness = constants%tangential * dot_product(gradient, along)
            call surface%slip_rate(point%inner, load, rates%slip, jumps)
            rates%u_et = v - rates%slip * along
            rates%dissipation = max(0.0_wp, constants%tangential * dot_product(point%u_et, along) &
                * rates%slip)
        else
            jumps = .false.
            load%traction = 0.0_wp
            load%loading = 0.0_wp
            load%stiffness = constants%tangential
        end if
        rates%inner = surface%state_rates(point%inner, load, rates%slip)
    end subroutine contact_rates

    !> The same of a closed contact with a damper beside its spring, which tells the traction for
    !> any slip rate: the balance of section 16 in place of the consistency of section 10. The rates
    !> of what follows from the traction are those at a constant slip rate.
    pure subroutine damped_rates(surface, constants, v, point, load, rates, jumps)
        class(law), intent(in) :: surface
        type(contact_constants), intent(in) :: constants
        real(wp), intent(in) :: v(2)              !! tangential velocity [L/T]
        type(contact_point), intent(in) :: point
        type(load_rates), intent(inout) :: load   !! with the pressure and its rate
        type(point_rates), intent(inout) :: rates
        logical, intent(out) :: jumps
        type(law_traits) :: traits
        type(sliding_way) :: way
        real(wp) :: pull(2), gradient(2), along(2)

        pull = constants%tangential * point%u_et + constants%damping * v
        call balance_damper(surface, constants, pull, load%pressure, point%inner, way, &
            rates%slip, jumps)
        if (jumps) return
        rates%u_et = v - rates%slip * way%along
        rates%dissipation = dot_product(way%tau, way%along) * rates%slip + constants%damping &
            * dot_product(rates%u_et, rates%u_et)
        call slip_directions(constants%plane, way%tau, v, gradient, along)
        load%traction = hypot(way%tau(1), constants%plane%squeeze * way%tau(2))
        load%loading = constants%tangential * dot_product(gradient, v)
        load%stiffness = constants%tangential * dot_product(gradient, along)
        rates%inner = surface%state_rates(point%inner, load, rates%slip)
        traits = surface%traits()   ! an R leaves zero faster than at any rate
        jumps = traits%memory == 1 .and. rates%slip > 0.0_wp .and. .not. point%inner%r > 0.0_wp
    end subroutine damped_rates

    !> Slip rate and traction at which damper and surface balance: where there are several, the
    !> least slip rate.
    pure subroutine balance_damper(surface, constants, pull, pressure, state, way, rate, fails)
        class(law), intent(in) :: surface
        type(contact_constants), intent(in) :: constants   !! with a damper
        real(wp), intent(in) :: pull(2)         !! traction without slip [F/L^2]
        real(wp), intent(in) :: pressure        !! [F/L^2]
        type(law_state), intent(in) :: state
        type(sliding_way), intent(out) :: way   !! traction and direction of the slip are
        real(wp), intent(out) :: rate           !! of slip, >= 0 [L/T]
        logical, intent(out) :: fails           !! it was not found
        real(wp) :: trial, strength, by_rate, stiffness, squeeze, x
        real(wp), parameter :: round_off = 64.0_wp * epsilon(1.0_wp)

        fails = .false.
        rate = 0.0_wp
        way%tau = pull
        way%along = 0.0_wp
        squeeze = constants%plane%squeeze
        trial = hypot(pull(1), squeeze * pull(2))
        call surface%resistance_at(state, 0.0_wp, pressure, strength, by_rate)
        if (trial <= strength * (1.0_wp + round_off)) return
        if (constants%plane%associated) then
            associate (spring => associated_spring(constants%damping, squeeze, pull &
                / constants%damping, trial / constants%damping))
                call balance(surface, spring, pressure, state, x, rate, strength, fails)
                way = associated_way(spring, x, strength)
            end associate
        else
            way%along = pull / hypot(pull(1), pull(2))
            stiffness = constants%damping * (trial / hypot(pull(1), pull(2)))
            call balance(surface, unloading(trial, stiffness, trial / stiffness), pressure, state, &
                x, rate, strength, fails)
            way%tau = pull * (strength / trial)
        end if
    end subroutine balance_damper

    !> The first balance of the law's resistance at a slip rate with what is left of the pull at
    !> that: Newton's method, bracketed. The laws' resistances meet the pull once, since they rise
    !> with the slip rate, or fall ever slower; under a shear cap, too.
    pure subroutine balance(surface, spring, pressure, state, x, rate, resistance, fails)
        class(law), intent(in) :: surface
        class(unloading), intent(in) :: spring   !! with slip rates for slips
        real(wp), intent(in) :: pressure         !! [F/L^2]
        type(law_state), intent(in) :: state
        real(wp), intent(out) :: x               !! where it is
        real(wp), intent(out) :: rate            !! slip rate [L/T]
        real(wp), intent(out) :: resistance      !! [F/L^2]
        logical, intent(out) :: fails            !! it was not found
        integer, parameter :: max_iterations = 200
        real(wp), parameter :: round_off = epsilon(round_off)
        type(unloaded) :: there
        real(wp) :: low, high, misfit, fall, by_rate, next
        integer :: iteration

        low = 0.0_wp
        high = spring%x_end
        x = low
        do iteration = 1, max_iterations
            call spring%at(x, there)
            rate = there%slip
            call surface%resistance_at(state, rate, pressure, resistance, by_rate)
            misfit = there%traction - resistance
            fall = (there%stiffness + by_rate) * there%rate
            fails = .false.
            if (abs(misfit) <= 4.0_wp * round_off * there%scale) return
            if (misfit > 0.0_wp) then
                low = x
            else
                high = x
            end if
            if (high - low <= 2.0_wp * round_off * high) return
            next = middle(low, high)
            if (fall > 0.0_wp) then
                if (x + misfit / fall > low .and. x + misfit / fall < high) next = x + misfit / fall
            end if
            x = next
            fails = .true.
        end do
    end subroutine balance

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
