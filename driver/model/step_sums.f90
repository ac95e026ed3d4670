!> What the blocks of a chain add up to in a step: all in one loop, which a long chain goes through
!> while its blocks are in cache.
module step_sums
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use friction_mod, only : prop_alpha_t, statev_dissipation, statev_slip, statev_status, &
        statev_u_et
    use slider_system, only : slider, slider_state
    implicit none
    private

    public :: block_sums, sum_blocks

    !> Sums over the blocks, at the start and at the end of the step where there are two.
    type :: block_sums
        real(dp) :: velocity(2) = 0.0_dp   !! [L/T]
        real(dp) :: spring(2) = 0.0_dp     !! force of the drive springs [F]
        real(dp) :: slip(2) = 0.0_dp       !! accumulated [L]
        real(dp) :: drag = 0.0_dp          !! twice the mean velocity times the way [L^2/T]
        real(dp) :: let_go = 0.0_dp        !! what contact springs still held when their contacts
                                           !! opened, which nothing gets back; and what the drive
                                           !! spring of a block without mass and damping held, which
                                           !! follows at once [F L]
        real(dp) :: jumped = 0.0_dp        !! see `add_jump` [F L]
        real(dp) :: relaxed = 0.0_dp       !! by dampers after that [F L]
        real(dp) :: fastest = 0.0_dp       !! largest velocity at the end, no sum [L/T]
        real(dp) :: most_slip = 0.0_dp     !! of a block in the step, no sum [L]
    contains
        procedure :: add
    end type block_sums

contains

    !> Sums over the blocks `first` to `last`.
    pure subroutine sum_blocks(system, old, new, first, last, sums)
        type(slider), intent(in) :: system
        type(slider_state), intent(in) :: old, new   !! start and end of a step
        integer, intent(in) :: first, last
        type(block_sums), intent(out) :: sums
        real(dp), parameter :: open = 3.0_dp
        real(dp) :: slip   !! of a block in the step [L]
        real(dp) :: back   !! way that its contact spring goes back [L]
        integer :: i

        do i = first, last
            sums%velocity = sums%velocity + [old%v(i), new%v(i)]
            sums%spring = sums%spring + [old%spring(i), new%spring(i)]
            sums%slip = sums%slip + [old%statev(i, statev_slip), new%statev(i, statev_slip)]
            sums%drag = sums%drag + (old%v(i) + new%v(i)) * (new%x(i) - old%x(i))
            sums%fastest = max(sums%fastest, abs(new%v(i)))
            if (new%statev(i, statev_status) >= open) then
                sums%let_go = sums%let_go + 0.5_dp * system%area * alpha_of(system, i) &
                    * old%statev(i, statev_u_et)**2
                if (.not. (system%mass > 0.0_dp .or. system%damping > 0.0_dp)) sums%let_go = &
                    sums%let_go + 0.5_dp * (old%spring(i)**2 - new%spring(i)**2) / system%stiffness
            end if
            slip = new%statev(i, statev_slip) - old%statev(i, statev_slip)
            back = abs(old%statev(i, statev_u_et)) - abs(new%statev(i, statev_u_et))
            sums%most_slip = max(sums%most_slip, slip)
            if (slip > 0.0_dp .and. back > 0.0_dp) call add_jump(system, old, new, i, slip, back, &
                sums)
        end do
    end subroutine sum_blocks

    pure function alpha_of(system, i) result(alpha)
        type(slider), intent(in) :: system
        integer, intent(in) :: i   !! block
        real(dp) :: alpha          !! [F/L^3]

        alpha = system%props(prop_alpha_t)
        if (allocated(system%constants)) alpha = system%constants(i, prop_alpha_t)
    end function alpha_of

    !> Adds what a contact spring gives up at once where friction falls, and with it the drive
    !> spring of a block without mass: of it the states of friction count too little, however short
    !> the step, since they take its slip under the traction at its end. What a block gains or loses
    !> by its way in the step is no part of it: an error of the step.
    !>
    !> Without mass, a damper lets the drive spring relax in the time C/K after the drop. The mean
    !> of the velocities at the ends of a step misses the one that the block has as it begins.
    pure subroutine add_jump(system, old, new, i, slip, back, sums)
        type(slider), intent(in) :: system
        type(slider_state), intent(in) :: old, new
        integer, intent(in) :: i        !! block
        real(dp), intent(in) :: slip    !! in the step, > 0 [L]
        real(dp), intent(in) :: back    !! way that the contact spring goes back, > 0 [L]
        type(block_sums), intent(inout) :: sums
        real(dp) :: drop                !! of the friction force [F]
        real(dp) :: contact, both       !! what that spring gives up, and with the drive's [F L]
        real(dp) :: counted             !! dissipated beyond slip under the last traction [F L]

        drop = system%area * alpha_of(system, i) * back
        contact = 0.5_dp * drop * back
        both = contact
        if (.not. system%mass > 0.0_dp) both = contact + 0.5_dp * drop**2 / (system%stiffness &
            + system%damping / (new%time - old%time))
        counted = system%area * (new%statev(i, statev_dissipation) - old%statev(i, &
            statev_dissipation)) - abs(new%friction(i)) * slip
        both = max(0.0_dp, both - counted)
        contact = max(0.0_dp, contact - counted)
        if (.not. system%damping > 0.0_dp) contact = both
        sums%jumped = sums%jumped + contact
        sums%relaxed = sums%relaxed + (both - contact)
    end subroutine add_jump

    !> Takes in the sums over further blocks of the same step.
    pure subroutine add(self, others)
        class(block_sums), intent(inout) :: self
        type(block_sums), intent(in) :: others

        self%velocity = self%velocity + others%velocity
        self%spring = self%spring + others%spring
        self%slip = self%slip + others%slip
        self%drag = self%drag + others%drag
        self%let_go = self%let_go + others%let_go
        self%jumped = self%jumped + others%jumped
        self%relaxed = self%relaxed + others%relaxed
        self%fastest = max(self%fastest, others%fastest)
        self%most_slip = max(self%most_slip, others%most_slip)
    end subroutine add

end module step_sums
