!> When blocks turn round: when slip begins or ends, and friction has a kink.
module turning_times
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use friction_mod, only : statev_mu, statev_u_et
    use law_facts, only : healing_rate
    use slider_system, only : slider, slider_state
    implicit none
    private

    public :: next_turn, oscillation_of, turn, visible_swing

    !> How a block would swing on its springs, were it not damped.
    type :: oscillation
        real(dp) :: omega       !! [1/T]
        real(dp) :: mean        !! of the velocity [L/T]
        real(dp) :: amplitude   !! of the velocity [L/T]
    end type oscillation

contains

    !> Velocity at which the traction of block `i` grows no faster than its strength: slower, it
    !> sticks. Nearly zero, but for a contact that heals or is being loaded.
    pure function sticking_velocity(system, state, i, loading) result(velocity)
        type(slider), intent(in) :: system
        type(slider_state), intent(in) :: state
        integer, intent(in) :: i
        real(dp), intent(in) :: loading   !! growth of the normal traction, part of it [1/T]
        real(dp) :: velocity              !! [L/T]

        velocity = 0.0_dp
        associate (mu => state%statev(i, statev_mu))
            if (mu > 0.0_dp) velocity = state%statev(i, statev_u_et) &
                * (healing_rate(system%props, mu) / mu + loading)
        end associate
    end function sticking_velocity

    !> When the first block to do so begins or ends to slip between two states: its velocity passes
    !> the one at which it sticks, found by cubic interpolation; huge if none does.
    pure function turn(system, a, b) result(time)
        type(slider), intent(in) :: system
        type(slider_state), intent(in) :: a, b
        real(dp) :: time   !! [T]
        real(dp) :: dt, loading, v_a, v_b, low, high, s
        integer :: i, k

        time = huge(time)
        dt = b%time - a%time
        loading = 0.0_dp
        if (a%normal > 0.0_dp .and. b%normal > 0.0_dp) loading = 2.0_dp * (b%normal - a%normal) &
            / (dt * (a%normal + b%normal))
        do i = 1, size(a%x)
            v_a = a%v(i) - sticking_velocity(system, a, i, loading)
            v_b = b%v(i) - sticking_velocity(system, b, i, loading)
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

    !> When a block that swings begins or ends to slip next. Huge if it never does, or if it swings
    !> by no more than a force that does not matter.
    pure function next_turn(system, state, swing, negligible) result(time)
        type(slider), intent(in) :: system
        type(slider_state), intent(in) :: state   !! of one block, with a mass
        type(oscillation), intent(in) :: swing    !! of that block
        real(dp), intent(in) :: negligible        !! [F]
        real(dp) :: time                          !! [T]
        real(dp), parameter :: just_turned = 0.01_dp, pi = acos(-1.0_dp)
        real(dp) :: sticking, phase, reach

        time = huge(time)
        if (system%mass * swing%omega * swing%amplitude <= negligible) return
        sticking = sticking_velocity(system, state, 1, 0.0_dp)
        if (swing%amplitude <= abs(sticking - swing%mean)) return
        phase = atan2(state%a(1) / swing%omega, state%v(1) - swing%mean)   ! of the velocity's crest
        reach = acos((sticking - swing%mean) / swing%amplitude)            ! from there to a turn
        phase = min(modulo(phase - reach - just_turned, 2.0_dp * pi), &
            modulo(phase + reach - just_turned, 2.0_dp * pi)) + just_turned
        time = state%time + phase / swing%omega
    end function next_turn

    !> The longest step that shows how the force of the drive spring swings; huge if that does not
    !> swing by as much as one would notice.
    pure function visible_swing(system, swing, noticed) result(dt)
        type(slider), intent(in) :: system
        type(oscillation), intent(in) :: swing   !! of one block
        real(dp), intent(in) :: noticed          !! [F]
        real(dp) :: dt                           !! [T]
        real(dp), parameter :: twelfth = acos(-1.0_dp) / 6.0_dp   !! of a period [-]

        dt = huge(dt)
        if (system%stiffness * swing%amplitude > noticed * swing%omega) dt = twelfth / swing%omega
    end function visible_swing

    !> The velocity swings about the one with which the drive pulls the springs along. A block whose
    !> damper keeps it from swinging has no amplitude.
    pure function oscillation_of(system, state, contact, velocity) result(swing)
        type(slider), intent(in) :: system
        type(slider_state), intent(in) :: state   !! of one block, with a mass
        real(dp), intent(in) :: contact           !! stiffness of the contact, >= 0 [F/L]
        real(dp), intent(in) :: velocity          !! of the drive [L/T]
        type(oscillation) :: swing
        real(dp) :: stiffness

        stiffness = system%stiffness + contact
        swing%omega = sqrt(stiffness / system%mass)
        swing%mean = system%stiffness * velocity / stiffness
        swing%amplitude = 0.0_dp
        if (system%damping**2 < 4.0_dp * system%mass * stiffness) swing%amplitude = &
            hypot(state%v(1) - swing%mean, state%a(1) / swing%omega)
    end function oscillation_of

end module turning_times
