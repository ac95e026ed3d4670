!> Where blocks start.
module initial_states
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use contact_forces, only : friction_forces
    use friction_mod, only : facts => law_facts, friction_facts, onset_gradual, prop_alpha_t, &
        statev_mu, statev_r, statev_size, statev_u_et
    use slider_system, only : cohesions, set_accelerations, slider, slider_state
    implicit none
    private

    public :: displace, initial_state, initial_values, place

    !> How a block starts, if not at rest on a virgin contact with a slack spring.
    type :: initial_values
        logical :: any_given = .false.
        logical :: mu_given = .false.          !! or else a law with an R has its virgin one
        real(dp) :: mu = 0.0_dp                !! friction coefficient [-]
        real(dp) :: r = 0.0_dp                 !! similarity ratio; the friction opposes +x [-]
        logical :: has_r = .true.              !! the law has an R; otherwise it is 0 or 1 here
        real(dp) :: displacement = 0.0_dp      !! [L]
        real(dp) :: velocity = 0.0_dp          !! [L/T]
        logical :: spring_given = .false.      !! otherwise the block starts in equilibrium
        real(dp) :: spring_force = 0.0_dp      !! [F]
    end type initial_values

contains

    !> At rest, pressed on the base, no spring stretched.
    subroutine initial_state(system, n_blocks, normal, state, status)
        type(slider), intent(in) :: system
        integer, intent(in) :: n_blocks
        real(dp), intent(in) :: normal           !! normal traction at the start [F/L^2]
        type(slider_state), intent(out) :: state
        integer, intent(out) :: status           !! of the friction routine
        real(dp), allocatable :: tangent(:), zero(:), virgin(:, :)

        allocate (zero(n_blocks), tangent(n_blocks), state%x(n_blocks), state%v(n_blocks), &
            state%a(n_blocks), state%spring(n_blocks), state%friction(n_blocks), source=0.0_dp)
        allocate (virgin(n_blocks, statev_size), state%statev(n_blocks, statev_size), source=0.0_dp)
        state%normal = normal
        state%load = normal
        call friction_forces(system, virgin, normal, zero, 0.0_dp, state%statev, &
            state%friction, tangent, status)
    end subroutine initial_state

    !> Puts the blocks where the initial values say.
    pure subroutine place(system, values, state)
        type(slider), intent(in) :: system
        type(initial_values), intent(in) :: values
        type(slider_state), intent(inout) :: state   !! as `initial_state` left it
        real(dp), dimension(size(state%x)) :: mu, alpha_t, pressure
        real(dp), allocatable :: props(:)
        type(facts) :: law
        integer :: i

        if (.not. values%any_given) return
        state%x = values%displacement
        state%v = values%velocity
        mu = values%mu
        pressure = state%normal
        if (allocated(system%load)) pressure = pressure * system%load
        do i = 1, size(mu)
            if (i == 1 .or. allocated(system%constants)) then   ! else they are those of the first
                props = system%props_of(i)
                law = friction_facts(props)
            end if
            alpha_t(i) = props(prop_alpha_t)
            if (values%has_r .and. .not. values%mu_given) mu(i) = law%virgin_mu
            ! where strength is reached at once the coefficient is that, however little is carried
            if (values%has_r) then
                state%statev(i, statev_mu) = mu(i)
            else if (mu(i) > 0.0_dp .and. law%traits%onset == onset_gradual) then
                state%statev(i, statev_mu) = max(0.0_dp, mu(i) - law%cohesion / pressure(i))
            end if
        end do
        if (values%has_r) state%statev(:, statev_r) = values%r
        state%friction = mu * pressure
        if (values%has_r) state%friction = values%r * (state%friction + cohesions(system, size(mu)))
        state%friction = system%area * state%friction
        state%statev(:, statev_u_et) = state%friction / (system%area * alpha_t)
        state%spring = sum(state%friction) / size(state%friction) + system%damping * values%velocity
        if (values%spring_given) state%spring = values%spring_force
        state%drive = state%x(1) + state%spring(1) / system%stiffness
        call set_accelerations(system, state)
    end subroutine place

    !> Moves blocks at the start; the drive and the contacts stay as they are.
    pure subroutine displace(system, by, state)
        type(slider), intent(in) :: system
        real(dp), intent(in) :: by(:)                !! one a block [L]
        type(slider_state), intent(inout) :: state   !! as `initial_state` or `place` left it

        state%x = state%x + by
        state%spring = state%spring - system%stiffness * by
        call set_accelerations(system, state)
    end subroutine displace

end module initial_states
