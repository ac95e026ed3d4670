!> Where the work of the drive goes: held by springs, contacts and motion, or lost.
module energies
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use friction_mod, only : prop_alpha_n, prop_alpha_t, statev_dissipation, statev_u_et, statev_u_n
    use slider_system, only : slider, slider_state
    use step_sums, only : block_sums
    implicit none
    private

    public :: account, energy_balance, take_stock

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
    pure subroutine account(system, sums, old, new)
        type(slider), intent(in) :: system
        type(block_sums), intent(in) :: sums   !! over the blocks in this step
        type(slider_state), intent(in) :: old
        type(slider_state), intent(inout) :: new

        new%drive_work = old%drive_work + 0.5_dp * sum(sums%spring) * (new%drive - old%drive)
        new%damped = old%damped + 0.5_dp * system%damping * sums%drag + sums%relaxed
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

    !> Held by the springs, the contact and the motion together [F L].
    pure real(dp) function held(self) result(total)
        class(energy_balance), intent(in) :: self

        total = self%kinetic + self%spring + self%contact
    end function held

    !> What the balance does not explain: the error of the time integration.
    pure real(dp) function unbalanced(self) result(rest)
        class(energy_balance), intent(in) :: self

        rest = self%at_start + self%drive_work - self%kinetic - self%spring - self%contact &
            - self%damped - self%dissipated
    end function unbalanced

end module energies
