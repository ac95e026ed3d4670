!> A step in continuous time that has been tried, and what a step of Rodas4 has to be looked at for
!> beside its error.
module trial_step
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use block_motion, only : moving_block
    use friction_mod, only : onset_gradual
    use slider_rates, only : controlled, damped, dissipated, elastic, extension, phase_slide, &
        ratio, slip, slider_equations, unknowns, velocity
    implicit none
    private

    public :: look_at, trial, wild

    !> Tolerated errors of its velocity by which the traction of a rigid contact that creeps may
    !> leave it open.
    real(dp), parameter, public :: most_open = 10.0_dp
    real(dp), parameter, public :: wild_error = 2.0_dp**4   !! of a step that is to be halved

    type :: trial
        real(dp) :: h                !! [T]
        real(dp) :: y(unknowns)      !! its end
        real(dp) :: last(unknowns)   !! rates there
        real(dp) :: error            !! part of the tolerated one
        real(dp) :: stiffness        !! h times the size of the equations' derivative
        integer :: switch            !! which way its phase has ended; 0: it has not
    end type trial

contains

    !> Looks at a step of Rodas4 with an error that is tolerated.
    subroutine look_at(block, t, weights, tried)
        type(moving_block), intent(in) :: block
        real(dp), intent(in) :: t                     !! of its start [T]
        real(dp), intent(in) :: weights(controlled)   !! inverse of the tolerated errors
        type(trial), intent(inout) :: tried
        real(dp), parameter :: long = 1.0e3_dp   !! step, beside the swings of a block with a mass
        logical :: failed

        if (block%equations%surface%traits%memory == 1) call limit_share(block%equations, t, &
            1.0_dp / weights(elastic), tried)
        call block%equations%rates(t + tried%h, tried%y, tried%last, failed)
        if (failed) tried%error = huge(tried%error)
        associate (eq => block%equations)
            if (eq%creeps_along() .and. eq%by_velocity) tried%y(elastic) = eq%traction(t &
                + tried%h, tried%y) / eq%alpha
        end associate
        if (wild(block%equations, block%y, tried%y, weights(elastic))) tried%error &
            = max(tried%error, wild_error)
        if (.not. block%equations%mass > 0.0_dp) then
            call damp(block, t, tried)
        else if (tried%stiffness > long) then
            call limit_losses(block, t, tried)
        end if
        if (block%equations%follows_traction() .and. .not. failed) call balance(block, t, &
            weights, tried)
        if (block%equations%follows_share()) call mobilise(block, tried)
    end subroutine look_at

    !> What a subloading surface carries beyond its full strength, and the tolerated error, is one
    !> that errors of long steps add up to: it slips by that.
    pure subroutine limit_share(eq, t, tolerated, tried)
        type(slider_equations), intent(in) :: eq
        real(dp), intent(in) :: t           !! of the step's start [T]
        real(dp), intent(in) :: tolerated   !! error of the elastic displacement [L]
        type(trial), intent(inout) :: tried
        real(dp) :: v_drive, pressure, pressure_rate, most

        if (eq%phase /= phase_slide .or. eq%damper > 0.0_dp) return
        call eq%inputs(t + tried%h, tried%y, v_drive, pressure, pressure_rate)
        most = eq%full_strength(tried%y, pressure) / eq%alpha
        if (abs(tried%y(elastic)) <= most + tolerated) return
        tried%y(slip) = tried%y(slip) + (abs(tried%y(elastic)) - most)
        tried%y(dissipated) = tried%y(dissipated) + 0.5_dp * eq%alpha * (tried%y(elastic)**2 &
            - most**2)
        tried%y(elastic) = sign(most, tried%y(elastic))
    end subroutine limit_share

    !> R of a surface beside a damper follows the traction so closely, while it is small, that the
    !> estimate of the error does not see how much slip that takes: the step may change its rate
    !> by so much only.
    pure subroutine mobilise(block, tried)
        type(moving_block), intent(in) :: block
        type(trial), intent(inout) :: tried
        real(dp), parameter :: most = 4.0_dp, small = 0.5_dp
        real(dp) :: fall

        associate (eq => block%equations, after => tried%y(ratio))
            if (eq%phase /= phase_slide .or. after > small) return
            fall = eq%share_rate(block%y(ratio)) / eq%share_rate(after)
            tried%error = max(tried%error, (fall / most)**4)
        end associate
    end subroutine mobilise

    !> The traction of a rigid contact that creeps comes to balance the faster the slower it slips.
    !> Where neither inertia nor damper has a say, it is the balance's. Else, unless it is that
    !> within the tolerated error, the slip rate may grow by so much only: where the traction comes
    !> to balance far more slowly at the end of a step than at its start, the estimate of the error
    !> sees nothing. Nor does it see what velocity a traction means that is known to all its digits:
    !> where that grows it has to be the one that momentum tells.
    subroutine balance(block, t, weights, tried)
        type(moving_block), intent(in) :: block
        real(dp), intent(in) :: t                     !! [T]
        real(dp), intent(in) :: weights(controlled)   !! inverse of the tolerated errors
        type(trial), intent(inout) :: tried
        real(dp), parameter :: no_say = 1.0e-8_dp   !! part
        real(dp), parameter :: most = 3.0_dp        !! logarithm of the growth
        real(dp) :: v_drive, pressure, pressure_rate, resistance, by_rate
        logical :: failed

        associate (eq => block%equations, before => block%first(slip), &
            after => tried%last(slip))
            if (after > before) tried%error = max(tried%error, abs(tried%y(velocity) &
                - eq%sense_of(tried%y(elastic)) * after) * weights(velocity) / most_open)
            call eq%inputs(t + tried%h, tried%y, v_drive, pressure, pressure_rate)
            call eq%surface%resistance_at(eq%law_state_of(tried%y, pressure), after, pressure, &
                resistance, by_rate)
            if (max(eq%mass, eq%damping * tried%h) < no_say * tried%h * by_rate * eq%area) then
                tried%y(elastic) = eq%pull(tried%y) / (eq%area * eq%alpha)
                call eq%rates(t + tried%h, tried%y, tried%last, failed)
                if (failed) tried%error = huge(tried%error)
            else if (after > before .and. eq%mass * abs(tried%last(velocity)) * weights(elastic) &
                > eq%area * eq%alpha) then
                tried%error = max(tried%error, (log(after / max(before, tiny(before))) / most)**4)
            end if
        end associate
    end subroutine balance

    !> Have the stages of a step been far from where it starts and ends? Then what slip dissipates
    !> over the slip is no traction of these.
    pure function wild(eq, before, after, weight)
        type(slider_equations), intent(in) :: eq
        real(dp), intent(in) :: before(unknowns), after(unknowns)   !! start and end of the step
        real(dp), intent(in) :: weight   !! inverse of the tolerated error of the contact's spring
        logical :: wild
        real(dp), parameter :: far = 1.5_dp, round_off = 16.0_dp * epsilon(1.0_dp)
        real(dp) :: tractions(2), way, work, lost, least

        way = after(slip) - before(slip)
        work = after(dissipated) - before(dissipated)
        tractions = eq%alpha * abs([before(elastic), after(elastic)])
        wild = .false.
        if (eq%damper > 0.0_dp .or. .not. maxval(tractions) > 0.0_dp) return
        lost = round_off * after(dissipated)
        wild = abs(work) - lost > far * maxval(tractions) * max(way, 1.0_dp / weight, &
            round_off * after(slip))
        if (way * weight <= 1.0_dp .or. way <= round_off * after(slip)) return
        least = minval(tractions) * (way - round_off * after(slip))
        wild = wild .or. far * (work + lost) < least
    end function wild

    !> In a step far longer than the block swings its slip rate is a small difference of large ones,
    !> and its stages may add up to what is no work of the friction: that is near the mean of the
    !> tractions of its ends times the slip, and as near as they are to each other.
    pure subroutine limit_losses(block, t, tried)
        type(moving_block), intent(in) :: block
        real(dp), intent(in) :: t   !! [T]
        type(trial), intent(inout) :: tried
        real(dp), parameter :: near = 0.05_dp   !! part
        real(dp) :: tractions(2), way, by_damper, mean

        associate (eq => block%equations)
            if (eq%surface%traits%onset == onset_gradual) return
            way = tried%y(slip) - block%y(slip)
            by_damper = eq%damper * (tried%y(elastic) - block%y(elastic))**2 / tried%h
            tractions = abs([eq%traction(t, block%y), eq%traction(t + tried%h, tried%y)])
            mean = block%y(dissipated) + 0.5_dp * sum(tractions) * way + by_damper
            if (abs(tried%y(dissipated) - mean) > near * (abs(tractions(2) - tractions(1)) * way &
                + by_damper)) tried%y(dissipated) = mean
        end associate
    end subroutine limit_losses

    !> What damper and slip take of a block without mass, whose velocity is a small difference of
    !> forces: within a long step of Rodas4 it is not well enough known to be squared, or multiplied
    !> by a traction that changes, its mean is.
    pure subroutine damp(block, t, tried)
        type(moving_block), intent(in) :: block
        real(dp), intent(in) :: t             !! [T]
        type(trial), intent(inout) :: tried
        real(dp) :: way, v(2)

        associate (d => block%equations%drive, i => block%equations%piece)
            way = tried%h * 0.5_dp * (d%drive_velocity(t, i) + d%drive_velocity(t + tried%h, i)) &
                - (tried%y(extension) - block%y(extension))
            v = [d%drive_velocity(t, i) - block%first(extension), &
                d%drive_velocity(t + tried%h, i) - tried%last(extension)]
        end associate
        tried%y(damped) = block%y(damped) + 0.5_dp * block%equations%damping * sum(v) * way
        associate (eq => block%equations)
            tried%y(dissipated) = block%y(dissipated) + 0.5_dp * abs(eq%traction(t, block%y) &
                + eq%traction(t + tried%h, tried%y)) * (tried%y(slip) - block%y(slip))
        end associate
    end subroutine damp

end module trial_step
