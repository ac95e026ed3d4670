!> Random path test of the library: soak [SEED [N]], N updates (default: seed 1, 1e5).
!>
!> Points of every law, option and entry go through paths of random increments. Every update is
!> checked for what must always hold, and by the batch; some are put into the discrete equations in
!> extended precision, compared with a dense grid of the curve and with derivatives in extended
!> precision (docs/developing.md). Ends with 1 if anything was wrong.
program soak
    use, intrinsic :: iso_fortran_env, only : dp => real64, error_unit
    use counted_friction_kinds, only : evaluations
    use counted_friction_mod, only : counted_update => friction_update
    use draws, only : draw, random_rotation, seed_draws
    use friction_mod, only : friction_bad_increment, friction_bad_property, friction_bad_state, &
        friction_no_convergence, friction_tangential, friction_update, friction_update_batch, &
        friction_update_frame, friction_zero_time_increment
    use independent_laws, only : creeps
    use path_checks, only : capped, check_equations, check_first_root, check_range, check_tangent, &
        check_hold, expects_time, k_batch, k_batch_status, k_code, k_convergence, k_entry, &
        k_hold, k_refused, kinds, n_kinds, tally, trial_of, viscous_of
    use path_draws, only : draw_increment, draw_props, draw_state, draw_time, path, points
    use worst_errors, only : worse, worst_of
    implicit none

    integer, parameter :: steps = 8   !! increments of a path
    integer, parameter :: n_bins = 12   !! of evaluations: 2**(k-1) to 2**k - 1
    integer, parameter :: as_update = 1, in_a_plane = 2, pressure_given = 3, in_a_frame = 4

    type(tally) :: sum_
    type(trial_of) :: worst
    integer :: some, few, very_few   !! one of so many is looked at: of 1e6 at most as many
    integer :: bins(n_bins), seed, n, most_evaluations

    seed = 1
    n = 100000
    if (command_argument_count() > 0) seed = argument(1)
    if (command_argument_count() > 1) n = argument(2)
    some = 8 * max(1, n / 1000000)
    few = 32 * some
    very_few = 8 * few
    call seed_draws(seed)
    bins = 0
    most_evaluations = 0
    do while (sum_%updates < n)
        call try_path()
    end do
    call report()
    if (any(sum_%faults > 0)) stop 1

contains

    integer function argument(place) result(number)
        integer, intent(in) :: place
        character(len=20) :: text

        call get_command_argument(place, text)
        read (text, *) number
    end function argument

    !> Some points under one law through some increments.
    subroutine try_path()
        type(path) :: this
        integer :: entry_, step, i

        call draw_props(this)
        entry_ = max(1, int(draw(0.0_dp, 6.0_dp)) - 1)
        do i = 1, points
            call draw_state(this, i)
            if (entry_ == in_a_plane) this%statev(i, 4) = 0.0_dp
        end do
        do step = 1, steps
            call draw_time(this)
            do i = 1, points
                if (draw(0.0_dp, 1.0_dp) < 0.02_dp) call draw_state(this, i)
                call draw_increment(this, i)
                if (entry_ == in_a_plane) this%du(i, 3) = 0.0_dp
                if (entry_ == in_a_plane) this%statev(i, 4) = 0.0_dp
            end do
            call try_increment(this, entry_)
        end do
    end subroutine try_path

    !> All points of a path through one increment: one by one, and together.
    subroutine try_increment(this, entry_)
        type(path), intent(inout) :: this
        integer, intent(in) :: entry_
        type(trial_of) :: one(points)
        integer :: i

        do i = 1, points
            one(i)%props = this%props
            one(i)%du = this%du(i, :)
            one(i)%dt = this%dt
            one(i)%old = this%statev(i, :)
            one(i)%given = entry_ == pressure_given
            one(i)%pressure = this%pressure * draw(-0.2_dp, 2.0_dp)
            if (draw(0.0_dp, 1.0_dp) < 0.05_dp) one(i)%pressure = 0.0_dp
            call update(one(i), entry_)
            call examine(this, entry_, one(i))
            if (entry_ == in_a_frame .and. .not. this%extreme .and. mod(i, 8) == 0) then
                call compare_frame(one(i))
            end if
        end do
        if (entry_ == as_update .or. entry_ == in_a_plane) call compare_batch(this, one, entry_)
        do i = 1, points
            if (one(i)%status >= 0) this%statev(i, :) = one(i)%new
        end do
    end subroutine try_increment

    subroutine update(t, entry_)
        type(trial_of), intent(inout) :: t
        integer, intent(in) :: entry_
        real(dp) :: by_p(2)

        t%new = t%old
        t%traction = 0.0_dp
        t%tangent = 0.0_dp
        if (entry_ == in_a_plane) then
            call friction_update(t%du(1:2), t%dt, t%props, t%new, t%traction(1:2), &
                t%tangent(1:2, 1:2), t%status)
        else if (entry_ == pressure_given) then
            call friction_tangential(t%du(2:3), t%pressure, t%dt, t%props, t%new, &
                t%traction(2:3), t%tangent(2:3, 2:3), by_p, t%status)
            t%traction(1) = -max(t%pressure, 0.0_dp)
            t%tangent(2:3, 1) = by_p
        else
            call friction_update(t%du, t%dt, t%props, t%new, t%traction, t%tangent, t%status)
        end if
        sum_%updates = sum_%updates + 1
    end subroutine update

    !> One update that has been made.
    subroutine examine(this, entry_, t)
        type(path), intent(in) :: this
        integer, intent(in) :: entry_
        type(trial_of), intent(in) :: t
        integer :: kind_
        logical :: skipped

        if (t%status < 0) then
            call examine_code(this, t)
            return
        end if
        kind_ = check_range(t)
        if (kind_ > 0) call note(kind_, t)
        if (kind_ > 0 .or. this%extreme) return
        if (nint(t%new(1)) == 2) sum_%slips = sum_%slips + 1
        if (t%status > 0) sum_%several = sum_%several + 1
        if (mod(sum_%updates, some) == 0) then
            sum_%equations = sum_%equations + 1
            kind_ = check_equations(t, sum_%residual)
            if (kind_ > 0) call note(kind_, t)
            if (kind_ > 0) return
            if (.not. t%given) call count_evaluations(t)
            kind_ = check_hold(t)
            if (kind_ > 0) call note(kind_, t)
        end if
        if (nint(t%new(1)) == 2 .and. (mod(sum_%updates, very_few) == 0 .or. t%status == 1 &
            .and. mod(sum_%updates, few) == 1)) then
            sum_%roots = sum_%roots + 1
            kind_ = check_first_root(t)
            if (kind_ > 0) call note(kind_, t)
        end if
        if (mod(sum_%updates, few) == 0 .and. .not. t%given .and. nint(t%new(1)) < 3) then
            kind_ = check_tangent(t, merge(2, 3, entry_ == in_a_plane), sum_%tangent, skipped)
            if (skipped) sum_%skipped = sum_%skipped + 1
            sum_%tangents = sum_%tangents + 1
            if (kind_ > 0) call note(kind_, t)
        end if
    end subroutine examine

    !> A negative status: rightly so?
    subroutine examine_code(this, t)
        type(path), intent(in) :: this
        type(trial_of), intent(in) :: t

        select case (t%status)
        case (friction_no_convergence)
            call note(k_convergence, t)
        case (friction_bad_state)
            call note(k_refused, t)
        case (friction_zero_time_increment)
            sum_%refused_time = sum_%refused_time + 1
            if (.not. expects_time(t)) call note(k_code, t)
        case (friction_bad_increment, friction_bad_property)
            sum_%beyond = sum_%beyond + 1
            if (.not. this%extreme .and. all(abs(t%du) < 1.0e60_dp)) call note(k_code, t)
        case default
            call note(k_code, t)
        end select
    end subroutine examine_code

    !> By the copy of the library that counts how often a law was asked.
    subroutine count_evaluations(t)
        type(trial_of), intent(in) :: t
        real(dp) :: state(8), traction(3), tangent(3, 3)
        integer :: status, bin

        evaluations = 0
        state = t%old
        call counted_update(t%du, t%dt, t%props, state, traction, tangent, status)
        if (evaluations == 0) return
        bin = 1 + int(log(real(evaluations, dp)) / log(2.0_dp) + 1.0e-9_dp)
        bins(min(bin, n_bins)) = bins(min(bin, n_bins)) + 1
        if (evaluations <= most_evaluations) return
        most_evaluations = evaluations
        worst = t
    end subroutine count_evaluations

    !> The batch's answers: equal status, values on their natural scales.
    subroutine compare_batch(this, one, entry_)
        type(path), intent(in) :: this
        type(trial_of), intent(in) :: one(points)
        integer, intent(in) :: entry_
        real(dp), allocatable :: du(:, :), traction(:, :), tangent(:, :, :)
        real(dp) :: statev(points, 8), value, by_du
        integer :: status(points), m, i

        m = merge(2, 3, entry_ == in_a_plane)
        allocate (du(points, m), traction(points, m), tangent(points, m, m))
        du(:, :) = this%du(:, :m)
        statev = this%statev
        call friction_update_batch(du, this%dt, this%props, statev, traction, tangent, status)
        do i = 1, points
            if (status(i) /= one(i)%status) call note(k_batch_status, one(i))
            if (status(i) /= one(i)%status .or. status(i) < 0 .or. this%extreme) cycle
            if (nint(statev(i, 1)) /= nint(one(i)%new(1))) call note(k_batch_status, one(i))
            value = distance(one(i), statev(i, :), traction(i, :))
            by_du = tangent_distance(one(i), tangent(i, :, :))
            sum_%batch_value = worse(sum_%batch_value, value)
            sum_%batch_tangent = worse(sum_%batch_tangent, by_du)
            if (.not. (value <= 1.0e-13_dp .and. by_du <= 1.0e-12_dp)) call note(k_batch, one(i))
        end do
    end subroutine compare_batch

    !> Between two answers, each number on its natural scale.
    function distance(t, state, traction) result(apart)
        type(trial_of), intent(in) :: t
        real(dp), intent(in) :: state(8), traction(:)
        real(dp) :: apart
        real(dp) :: force, length, slip, condition, inner(2), damper
        integer :: m

        m = size(traction)
        length = max(displaced(t), tiny(length))
        ! Round-off of the displacements changes the traction by the tangent.
        force = max(norm2(t%traction), maxval(abs(t%tangent(2:m, 2:m))) * length, tiny(force))
        apart = worst_of(abs(traction - t%traction(:m))) / force
        apart = worse(apart, worst_of(abs(state(2:4) - t%new(2:4)) / max(length, abs(t%new(2)), &
            force / (t%props(3) + viscous_of(t)))))
        condition = 1.0_dp
        ! The coefficient of rate-and-state friction is exp(u), where u is the sum of large terms.
        if (creeps(nint(t%props(1)))) condition = 1.0_dp + (t%props(8) + t%props(5) &
            * state_term(t)) / t%props(4) / 30.0_dp
        inner = max(abs(t%new(5:6)), [1.0e-20_dp, 1.0e-300_dp])   ! a coefficient that small is none
        ! Their friction is mu_s less what the slip D took away, which rounds by that of mu_s.
        if (any(nint(t%props(1)) == [5, 6])) inner = max(inner, [t%props(4), length])
        ! Under a cap R does not follow from the traction but from the slip, a difference.
        slip = t%new(7) - t%old(7)
        if (nint(t%props(1)) == 1 .and. slip > 0.0_dp .and. capped(t)) inner = max(inner, &
            abs(t%new(5:6) - t%old(5:6)) * (length / slip))
        ! Its coefficient falls with the slip, which rounds by the displacements; beside a cohesion
        ! that carries nearly all of the traction nothing else tells the slip.
        if (nint(t%props(1)) == 1 .and. slip > 0.0_dp) condition = 1.0_dp + abs(t%new(5) &
            - t%old(5)) / inner(1) * (length / slip) / 300.0_dp
        apart = worse(apart, abs(state(5) - t%new(5)) / inner(1) / condition)
        if (nint(t%props(1)) == 1) condition = 1.0_dp
        if (creeps(nint(t%props(1)))) condition = condition + blur_of_state(t, length) / 300.0_dp
        ! With flash heating ln(theta) tends to (psi_ss - f0)/b.
        if (nint(t%props(1)) == 7) condition = condition + t%props(8) / t%props(5) / 30.0_dp
        apart = worse(apart, abs(state(6) - t%new(6)) / inner(2) / condition)
        apart = worse(apart, abs(state(7) - t%new(7)) / (length + t%new(7)))
        damper = viscous_of(t) * (norm2(t%new(3:4) - t%old(3:4)) + epsilon(damper) * length)
        apart = worse(apart, abs(state(8) - t%new(8)) / max((force + damper) * length + t%new(8), &
            1.0e-300_dp))
    end function distance

    !> The larger one of |ln(v0 theta/d_c)| before and after [-].
    function state_term(t) result(term)
        type(trial_of), intent(in) :: t
        real(dp) :: term

        term = abs(log(t%props(7)) + log(t%new(6)) - log(t%props(6)))
        if (t%old(6) > 0.0_dp) term = max(term, abs(log(t%props(7)) + log(t%old(6)) &
            - log(t%props(6))))
    end function state_term

    !> By how many units of round-off theta may differ because the slip is a difference of
    !> displacements and has the round-off of these: length/d_c times d(ln theta)/d(slip/d_c), which
    !> beside a cohesion that carries nearly all of the traction is large.
    function blur_of_state(t, length) result(blur)
        type(trial_of), intent(in) :: t
        real(dp), intent(in) :: length   !! of the displacements [L]
        real(dp) :: blur
        real(dp) :: x

        x = (t%new(7) - t%old(7)) / t%props(6)
        blur = 0.0_dp
        if (nint(t%old(1)) == 0 .or. x <= 0.0_dp .or. x > 500.0_dp) return
        blur = length / t%props(6) * abs(log(t%new(6) / t%old(6))) / max(exp(x) - 1.0_dp, x)
    end function blur_of_state

    !> Between two tangents, by stiffness, which is that of spring and damper, and condition.
    function tangent_distance(t, tangent) result(apart)
        type(trial_of), intent(in) :: t
        real(dp), intent(in) :: tangent(:, :)
        real(dp) :: apart
        real(dp) :: stick, largest_, slip
        integer :: m

        m = size(tangent, 1)
        stick = max(t%props(2), t%props(3) + viscous_of(t))
        largest_ = max(stick, maxval(abs(tangent)))
        apart = worst_of(abs(tangent - t%tangent(:m, :m))) / (largest_ * (largest_ / stick))
        ! It depends on the slip, a difference of displacements, which round.
        slip = t%new(7) - t%old(7)
        if (slip > 0.0_dp) apart = apart / (1.0_dp + 1.0e12_dp * epsilon(slip) * displaced(t) &
            / slip)
    end function tangent_distance

    !> The displacements whose difference the slip is [L].
    pure function displaced(t) result(length)
        type(trial_of), intent(in) :: t
        real(dp) :: length

        length = norm2(t%old(3:4)) + norm2(t%du(2:3))
    end function displaced

    !> The same increment in a turned frame; its state is taken again.
    subroutine compare_frame(t)
        type(trial_of), intent(in) :: t
        real(dp) :: q(3, 3), state(8), traction(3), tangent(3, 3), scale, zero(3)
        integer :: status
        logical :: slid

        if (t%status < 0) return
        if (abs(t%new(2)) < 1.0e-10_dp * (norm2(t%du) + norm2(t%old(2:4)))) return   ! open or not?
        if (nint(t%props(1)) == 8 .and. abs(t%old(2)) > 0.0_dp .and. abs(t%old(2)) < 1.0e-10_dp &
            * norm2(t%old(2:4))) return   ! a pressure or none?
        if (norm2(t%old(3:4)) < 1.0e-12_dp * abs(t%old(2))) return   ! its direction gets lost
        q = random_rotation()
        state = t%old
        state(2:4) = matmul(q, state(2:4))
        call friction_update_frame(matmul(q, t%du), q(:, 1), t%dt, t%props, state, traction, &
            tangent, status, axis=q(:, 2))
        scale = 1.0e-13_dp * (maxval(t%props(2:3)) + viscous_of(t)) * (norm2(t%du) &
            + norm2(t%old(2:4)))
        if (status < 0) then
            call note(k_entry, t)
            return
        end if
        if (nint(state(1)) == 2 .and. t%status == 0 .and. status == 0) then
            if (.not. norm2(matmul(q, t%traction) - traction) <= 100.0_dp * scale * max(1.0_dp, &
                maxval(abs(t%tangent)) / maxval(t%props(2:3)))) call note(k_entry, t)
        end if
        slid = nint(state(1)) == 2 .and. .not. creeps(nint(t%props(1))) &
            .and. .not. (nint(t%props(1)) == 3 .and. .not. t%dt > 0.0_dp) &
            .and. .not. viscous_of(t) > 0.0_dp
        zero = 0.0_dp
        call friction_update_frame(zero, q(:, 1), t%dt, t%props, state, traction, tangent, &
            status, axis=q(:, 2))
        if (status < 0 .or. slid .and. nint(state(1)) /= 1) call note(k_hold, t)
    end subroutine compare_frame

    !> Counts a fault, and shows the first ones of its kind.
    subroutine note(kind_, t)
        integer, intent(in) :: kind_
        type(trial_of), intent(in) :: t

        sum_%faults(kind_) = sum_%faults(kind_) + 1
        if (sum_%faults(kind_) > 3) return
        write (*, '(2a)') 'FAULT: ', trim(kinds(kind_))
        call show(t)
    end subroutine note

    subroutine show(t)
        type(trial_of), intent(in) :: t

        write (*, '(a, 14es25.17)') '  props    ', t%props(:min(7, size(t%props)))
        if (size(t%props) > 7) write (*, '(a, 14es25.17)') '           ', t%props(8:)
        write (*, '(a, 8es25.17)') '  old      ', t%old
        write (*, '(a, 4es25.17)') '  du dt    ', t%du, t%dt
        if (t%given) write (*, '(a, es25.17)') '  pressure ', t%pressure
        write (*, '(a, i0)') '  status   ', t%status
        write (*, '(a, 8es25.17)') '  new      ', t%new
        write (*, '(a, 3es25.17)') '  traction ', t%traction
    end subroutine show

    subroutine report()
        integer :: k

        write (*, '(a, i0, a, i0, a, i0, a, i0, a, i0, a)') 'seed ', seed, ': ', sum_%updates, &
            ' updates, of which ', sum_%slips, ' slip, ', sum_%several, &
            ' with several equilibria, ', sum_%beyond, ' beyond the range'
        write (*, '(3(a, i0), a, i0, a)') 'checked closely: equations ', sum_%equations, &
            ', first root ', sum_%roots, ', tangent ', sum_%tangents, ' (', sum_%skipped, &
            ' at a kink)'
        write (*, '(a, es9.1)') 'worst residual of the discrete equations ', sum_%residual
        write (*, '(a, es9.1)') 'worst error of the tangent               ', sum_%tangent
        write (*, '(a, 2es9.1)') 'batch against one point: value, tangent  ', sum_%batch_value, &
            sum_%batch_tangent
        write (*, '(a)') 'evaluations of the law by an update that slips:'
        do k = 1, n_bins
            if (bins(k) > 0) write (*, '(i8, a, i6, i10)') 2**(k - 1), ' to ', 2**k - 1, bins(k)
        end do
        write (*, '(a, i0)') 'the most: ', most_evaluations
        if (most_evaluations > 0) call show(worst)
        do k = 1, n_kinds
            write (*, '(i10, 2a)') sum_%faults(k), '  ', trim(kinds(k))
        end do
    end subroutine report

end program soak
