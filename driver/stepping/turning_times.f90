!> When blocks turn round: when slip begins or ends, and friction has a kink.
module turning_times
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use friction_mod, only : friction_healing_rate, statev_mu, statev_size, statev_u_et
    use slider_system, only : cohesions, slider, slider_state
    implicit none
    private

    public :: turn

contains

    !> Velocity at which the traction of block `i` grows no faster than its strength: slower, it
    !> sticks. Nearly zero, but for a contact that heals or is being loaded.
    pure function sticking_velocity(system, state, i, loading, cohesion) result(velocity)
        type(slider), intent(in) :: system
        type(slider_state), intent(in) :: state
        integer, intent(in) :: i
        real(dp), intent(in) :: loading    !! growth of the normal traction, part of it [1/T]
        real(dp), intent(in) :: cohesion   !! of the block [F/L^2]
        real(dp) :: velocity              !! [L/T]
        real(dp) :: pressure, healing, resting(statev_size)   ! of the block at rest

        velocity = 0.0_dp
        pressure = state%normal
        if (allocated(system%load)) pressure = pressure * system%load(i)
        associate (mu => state%statev(i, statev_mu))
            resting = 0.0_dp
            resting(statev_mu) = mu
            if (.not. mu * pressure > 0.0_dp) return
            if (allocated(system%constants)) then
                healing = friction_healing_rate(system%constants(i, :), resting)
            else
                healing = friction_healing_rate(system%props, resting)
            end if
            velocity = state%statev(i, statev_u_et) * (healing + mu * loading) / (mu &
                + cohesion / pressure)
        end associate
    end function sticking_velocity

    !> When the first block to do so begins or ends to slip between two states: its velocity passes
    !> the one at which it sticks, found by cubic interpolation; huge if none does.
    pure function turn(system, a, b) result(time)
        type(slider), intent(in) :: system
        type(slider_state), intent(in) :: a, b
        real(dp) :: time   !! [T]
        real(dp) :: dt, loading, v_a, v_b, low, high, s, cohesion(size(a%x))
        integer :: i, k

        time = huge(time)
        cohesion = cohesions(system, size(cohesion))
        dt = b%time - a%time
        loading = 0.0_dp
        if (a%normal > 0.0_dp .and. b%normal > 0.0_dp) loading = 2.0_dp * (b%normal - a%normal) &
            / (dt * (a%normal + b%normal))
        do i = 1, size(a%x)
            v_a = a%v(i) - sticking_velocity(system, a, i, loading, cohesion(i))
            v_b = b%v(i) - sticking_velocity(system, b, i, loading, cohesion(i))
            if (v_a * v_b >= 0.0_dp) cycle
            low = 0.0_dp
            high = 1.0_dp
            do k = 1, 30
                s = 0.5_dp * (low + high)
                if ((v_a * (1.0_dp + 2.0_dp * s) + dt * a%a(i) * s) * (1.0_dp - s)**2 * v_a &
                    + (v_b * (3.0_dp - 2.0_dp * s) - dt * b%a(i) * (1.0_dp - s)) * s**2 &
                    * v_a > 0.0_dp) then
                    low = s
                else
                    high = s
                end if
            end do
            time = min(time, a%time + s * dt)
        end do
    end function turn

end module turning_times
