!> Where the work of the drive goes: held by springs, contacts and motion, or lost.
module energies
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use friction_mod, only : prop_alpha_n, prop_alpha_t, statev_dissipation, statev_slip, &
        statev_status, statev_u_et, statev_u_n
    use slider_system, only : slider, slider_state
    implicit none
    private

    public :: account, energy_balance, jumped, let_go, take_stock

    !> Where the work of the drive has gone [F L].
    type :: energy_balance
        real(dp) :: at_start = 0.0_dp   !! held at the start, in all forms
        real(dp) :: drive_work = 0.0_dp
        real(dp) :: most_work = 0.0_dp   !! of the drive, whichever way
        real(dp) :: kinetic = 0.0_dp, spring = 0.0_dp, contact = 0.0_dp   !! held now
        real(dp) :: damped = 0.0_dp, dissipated = 0.0_dp                  !! lost
    contains
        procedure :: held, unbalanced
    end type energy_balance

contains

    !> Adds the work of the drive and the energy lost to the dampers from `old` to `new`, by the
    !> mean forces over the step.
    pure subroutine account(system, old, new)
        type(slider), intent(in) :: system
        type(slider_state), intent(in) :: old
        type(slider_state), intent(inout) :: new
        real(dp) :: pull, drag   ! sums over the blocks [F], [L^2/T]
        integer :: i

        pull = 0.0_dp
        drag = 0.0_dp
        do i = 1, size(new%x)
            pull = pull + (old%spring(i) + new%spring(i))
            drag = drag + (old%v(i) + new%v(i)) * (new%x(i) - old%x(i))
        end do
        new%drive_work = old%drive_work + 0.5_dp * pull * (new%drive - old%drive)
        new%damped = old%damped + 0.5_dp * system%damping * drag
        if (.not. system%across%free()) return
        associate (du_n => new%statev(1, statev_u_n) - old%statev(1, statev_u_n))
            new%drive_work = new%drive_work - 0.5_dp * system%area * (old%load + new%load) * du_n
            new%damped = new%damped + 0.5_dp * system%across%damping * (old%v_n + new%v_n) * du_n
        end associate
    end subroutine account

    !> Energies that a state holds: of the motion, of the springs, of the contact; and what has come
    !> and was lost. All in one loop: a sum waits for each addition, four wait together.
    pure subroutine take_stock(system, state, energy)
        type(slider), intent(in) :: system
        type(slider_state), intent(in) :: state
        type(energy_balance), intent(inout) :: energy
        real(dp) :: motion, springs, contact, dissipated   ! sums over the blocks
        integer :: i

        motion = 0.0_dp
        springs = 0.0_dp
        contact = 0.0_dp
        dissipated = 0.0_dp
        do i = 1, size(state%x)
            motion = motion + state%v(i)**2
            springs = springs + state%spring(i)**2
            contact = contact + state%statev(i, statev_u_et)**2
            dissipated = dissipated + state%statev(i, statev_dissipation)
        end do
        if (allocated(system%constants)) contact = sum(system%constants(:, prop_alpha_t) &
            / system%props(prop_alpha_t) * state%statev(:, statev_u_et)**2)
        energy%kinetic = 0.5_dp * system%mass * motion
        energy%spring = 0.5_dp * springs / system%stiffness + system%coupling_energy(state%x)
        energy%contact = 0.5_dp * system%area * system%props(prop_alpha_t) * contact
        energy%dissipated = system%area * dissipated
        energy%drive_work = state%drive_work
        energy%damped = state%damped
        if (system%across%free()) call take_stock_across(system, state, energy)
    end subroutine take_stock

    !> Adds what is held across the interface.
    pure subroutine take_stock_across(system, state, energy)
        type(slider), intent(in) :: system
        type(slider_state), intent(in) :: state
        type(energy_balance), intent(inout) :: energy
        real(dp) :: away, stretch   !! of the drive spring in both directions [L]

        away = state%statev(1, statev_u_n) - system%across%rest
        stretch = state%drive - state%x(1)
        energy%kinetic = energy%kinetic + 0.5_dp * system%across%mass * state%v_n**2
        energy%spring = 0.5_dp * system%stiffness * stretch**2 - system%across%tilt * stretch &
            * away + 0.5_dp * system%across%stiffness * away**2
        energy%contact = energy%contact + 0.5_dp * system%area &
            * system%carried_pressure(state%statev(1, statev_u_n))**2 / system%props(prop_alpha_n)
    end subroutine take_stock_across

    !> Energy that contact springs still held when their contacts opened: nothing gets it back. Nor
    !> what the drive spring of a block without mass and damping held: that follows at once.
    pure function let_go(system, old, new) result(energy)
        type(slider), intent(in) :: system
        type(slider_state), intent(in) :: old, new
        real(dp) :: energy   !! [F L]
        real(dp), parameter :: open = 3.0_dp
        real(dp) :: alpha   !! [F/L^3]
        integer :: i

        energy = 0.0_dp
        alpha = system%props(prop_alpha_t)
        do i = 1, size(new%x)
            if (new%statev(i, statev_status) < open) cycle
            if (allocated(system%constants)) alpha = system%constants(i, prop_alpha_t)
            energy = energy + 0.5_dp * system%area * alpha * old%statev(i, statev_u_et)**2
            if (system%mass > 0.0_dp .or. system%damping > 0.0_dp) cycle
            energy = energy + 0.5_dp * (old%spring(i)**2 - new%spring(i)**2) / system%stiffness
        end do
    end function let_go

    !> What contact springs give up at once where friction falls, and with them the drive spring of
    !> a block without mass and damping: of it the states of friction count too little, however
    !> short the step, since they take its slip under the traction at its end. What a block gains or
    !> loses by its way in the step is no part of it: an error of the step.
    pure function jumped(system, old, new) result(energy)
        type(slider), intent(in) :: system
        type(slider_state), intent(in) :: old, new   !! start and end of a step
        real(dp) :: energy   !! [F L]
        real(dp) :: alpha    !! [F/L^3]
        real(dp) :: back     !! way that the contact spring goes back [L]
        real(dp) :: slip     !! in the step [L]
        real(dp) :: counted  !! dissipated beyond slip under the last traction [F L]
        real(dp) :: given    !! [F L]
        integer :: i

        energy = 0.0_dp
        alpha = system%props(prop_alpha_t)
        do i = 1, size(new%x)
            slip = new%statev(i, statev_slip) - old%statev(i, statev_slip)
            back = abs(old%statev(i, statev_u_et)) - abs(new%statev(i, statev_u_et))
            if (.not. (slip > 0.0_dp .and. back > 0.0_dp)) cycle
            if (allocated(system%constants)) alpha = system%constants(i, prop_alpha_t)
            given = 0.5_dp * system%area * alpha * back**2
            if (.not. (system%mass > 0.0_dp .or. system%damping > 0.0_dp)) given = given &
                + 0.5_dp * (system%area * alpha * back)**2 / system%stiffness
            counted = system%area * (new%statev(i, statev_dissipation) - old%statev(i, &
                statev_dissipation)) - abs(new%friction(i)) * slip
            energy = energy + max(0.0_dp, given - counted)
        end do
    end function jumped

    !> Held by the springs, the contact and the motion together.
    pure function held(self) result(total)
        class(energy_balance), intent(in) :: self
        real(dp) :: total   !! [F L]

        total = self%kinetic + self%spring + self%contact
    end function held

    !> What the balance does not explain: the error of the time integration.
    pure function unbalanced(self) result(rest)
        class(energy_balance), intent(in) :: self
        real(dp) :: rest

        rest = self%at_start + self%drive_work - self%kinetic - self%spring - self%contact &
            - self%damped - self%dissipated
    end function unbalanced

end module energies
