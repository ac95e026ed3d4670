!> The update of a block of contact points in vector lanes: `friction_contact` written so that a
!> compiler turns every loop into vector instructions, over any law that has lanes (src/lanes/).
!>
!> Either all points of the block are updated, or nothing is touched and `left` tells which points
!> this kernel does not take: numbers that are not finite or beyond 1e20, states that no update
!> leaves, gaps that close, several possible equilibria, slow convergence. Each point is treated by
!> itself: its result does not depend on its neighbours. No floating-point exception but inexact and
!> underflow; overflow only where numbers beyond 1e307 are judged, by their sum.
module friction_batch_kernel
    use, intrinsic :: iso_c_binding, only : c_double, c_int, c_int64_t
    use friction_lane_block, only : below_largest, block_task, c_alpha_n, c_alpha_t, c_cap, &
        c_mu_0, c_own, c_r_0, c_squeeze, lanes, least_ratio, n_constants, no_cap, rest_block, &
        slide_block, unsure, verge, widest, with_cap, with_two_coefficients
    use friction_law_lanes, only : counts_pressure_before, find_coefficients, follows_path, &
        follows_rate, mobilises, rest_law, slide_law, state_of_law
    use friction_subloading_lanes, only : c_mu_k, c_mu_s
    implicit none
    private

    public :: update_block

    integer, parameter :: wp = c_double
    real(wp), parameter :: largest = 1.0e20_wp   !! of the numbers taken: no product overflows
    real(wp), parameter :: smallest = 1.0e-100_wp   !! of the tractions taken, unless zero
    real(wp), parameter :: least = 1.0e-200_wp      !! below every divisor that counts
    real(wp), parameter :: least_length = 1.0e-150_wp   !! below that of every traction taken

    !> A block with all of its slip prevented.
    type :: trial_block
        type(rest_block) :: rest
        real(wp) :: q1(lanes), q2(lanes)   !! elastic tangential displacement [L]
        real(wp) :: start(lanes)     !! for a law that follows the path: traction at the start,
                                     !! without a cap; else -1 [F/L^2]
        real(wp) :: length(lanes)    !! of q, where two coefficients count [L]
        real(wp) :: stiffness(lanes) !! fall of T_eq with slip [F/L^3]
        integer(c_int) :: slides(lanes)   !! 1 where the traction is beyond the strength, else 0
    end type trial_block

    !> What traction and tangent are made of.
    type :: answer_block
        real(wp) :: t1(lanes), t2(lanes)   !! direction of the slip; 0 where nothing slides [-]
        real(wp) :: per_traction(lanes)   !! 1/T_eq of the trial, where it slides [L^2/F]
        real(wp) :: work_ratio(lanes)     !! work of the traction over slip and T_eq [-]
        real(wp) :: squeezed(lanes)  !! how much the strength depends on the direction [-]
        real(wp) :: share(lanes)     !! of q that stays elastic [-]
        real(wp) :: coupling(lanes)  !! alpha_t/D of docs/theory.md, section 4 [-]
        real(wp) :: d_slip(lanes)    !! d(resistance)/d(slip) [F/L^3]
        real(wp) :: by_du_n(lanes)   !! along the slip, by the normal displacement [F/L^3]
    end type answer_block

contains

    !> Updates points 1 to `lanes` of component-major arrays.
    subroutine update_block(task, constants, du, statev, traction, tangent, left, n_left) &
        bind(C, name='stickslip_batch_kernel')
        type(block_task), intent(in) :: task
        real(wp), intent(in) :: constants(lanes, n_constants)   !! of each point, valid
        real(wp), intent(in) :: du(task%stride, *)              !! 2 or 3 components [L]
        real(wp), intent(inout) :: statev(task%stride, *)       !! 8 components
        real(wp), intent(inout) :: traction(task%stride, *)     !! 2 or 3 components [F/L^2]
        real(wp), intent(inout) :: tangent(task%stride, task%ndir, *)  !! [F/L^3]
        integer(c_int), intent(out) :: left(lanes)   !! 1 for a point that is not taken, else 0
        integer(c_int), intent(out) :: n_left        !! how many; unless 0, nothing is touched

        if (task%viscous > 0.0_wp) then
            call update_damped(task, constants, du, statev, traction, tangent, left, n_left)
        else
            call update_undamped(task, constants, du, statev, traction, tangent, left, n_left)
        end if
    end subroutine update_block

    subroutine update_undamped(task, constants, du, statev, traction, tangent, left, n_left)
        type(block_task), intent(in) :: task
        real(wp), intent(in) :: constants(lanes, n_constants)
        real(wp), intent(in) :: du(task%stride, task%ndir)
        real(wp), intent(inout) :: statev(task%stride, 8), traction(task%stride, task%ndir)
        real(wp), intent(inout) :: tangent(task%stride, task%ndir, task%ndir)
        integer(c_int), intent(out) :: left(lanes), n_left
        type(trial_block) :: trial
        type(slide_block) :: slid
        integer :: n_slides

        call find_trial(task, constants, du, statev, trial, left, n_slides, n_left)
        if (n_left > 0) return
        call find_slip(task, constants, trial, n_slides, slid, left, n_left)
        if (n_left > 0) return
        call finish(task, constants, du, trial, slid, statev, traction, tangent)
    end subroutine update_undamped

    !> With a damper beside the tangential spring: one spring of a higher stiffness, whose
    !> displacement at the start is shorter (docs/theory.md, section 16).
    subroutine update_damped(task, constants, du, statev, traction, tangent, left, n_left)
        type(block_task), intent(in) :: task
        real(wp), intent(in) :: constants(lanes, n_constants)
        real(wp), intent(in) :: du(task%stride, task%ndir)
        real(wp), intent(inout) :: statev(task%stride, 8), traction(task%stride, task%ndir)
        real(wp), intent(inout) :: tangent(task%stride, task%ndir, task%ndir)
        integer(c_int), intent(out) :: left(lanes), n_left
        real(wp) :: stiffened(lanes, n_constants), start(lanes, 8), moved(lanes, 3), u_et(lanes, 2)
        type(block_task) :: own
        type(trial_block) :: trial
        type(slide_block) :: slid
        real(wp) :: share
        integer :: n_slides, i

        own = task
        own%stride = lanes
        stiffened = constants
        start = statev(:lanes, :)
        moved(:, :task%ndir) = du(:lanes, :)
        u_et = start(:, 3:4)
        if (task%ndir == 2) u_et(:, 2) = 0.0_wp
        do i = 1, lanes
            stiffened(i, c_alpha_t) = constants(i, c_alpha_t) + task%viscous
            share = constants(i, c_alpha_t) / stiffened(i, c_alpha_t)
            start(i, 3) = start(i, 3) * share
            start(i, 4) = start(i, 4) * share
        end do
        call find_trial(own, stiffened, moved, start, trial, left, n_slides, n_left)
        if (n_left > 0) return
        call find_slip(task, stiffened, trial, n_slides, slid, left, n_left)
        if (n_left > 0) return
        call finish(task, stiffened, du, trial, slid, statev, traction, tangent)
        call strain_damper(task, stiffened, du, u_et, statev)
    end subroutine update_damped

    !> The elastic displacement at which spring and damper carry the traction, and the energy that
    !> the damper has taken.
    pure subroutine strain_damper(task, stiffened, du, u_et, statev)
        type(block_task), intent(in) :: task
        real(wp), intent(in) :: stiffened(lanes, n_constants)
        real(wp), intent(in) :: du(task%stride, task%ndir)
        real(wp), intent(in) :: u_et(lanes, 2)   !! at the start [L]
        real(wp), intent(inout) :: statev(task%stride, 8)   !! of the stiffened spring, then of both
        real(wp) :: kept, in_space, u1, u2
        integer :: i

        in_space = merge(1.0_wp, 0.0_wp, task%ndir == 3)
        do i = 1, lanes
            kept = task%viscous / stiffened(i, c_alpha_t)
            u1 = statev(i, 3) + kept * u_et(i, 1)
            u2 = statev(i, 4) + kept * u_et(i, 2)
            if (statev(i, 1) < 1.5_wp) then   ! sticks
                u1 = u_et(i, 1) + du(i, 2)
                u2 = u_et(i, 2) + du(i, task%ndir) * in_space
            end if
            if (statev(i, 1) < 2.5_wp) then
                statev(i, 8) = statev(i, 8) + task%viscous * ((u1 - u_et(i, 1))**2 &
                    + (u2 - u_et(i, 2))**2)
                statev(i, 3) = u1
                statev(i, 4) = u2
            end if
        end do
    end subroutine strain_damper

    !> The trial state, and the points that the kernel leaves.
    subroutine find_trial(task, constants, du, statev, trial, left, n_slides, n_left)
        type(block_task), intent(in) :: task
        real(wp), intent(in) :: constants(lanes, n_constants)
        real(wp), intent(in) :: du(task%stride, task%ndir), statev(task%stride, 8)
        type(trial_block), intent(out) :: trial
        integer(c_int), intent(out) :: left(lanes), n_left
        integer, intent(out) :: n_slides
        real(wp) :: valid(lanes), strength
        integer :: i

        n_slides = 0
        call check(task, du, statev, left, n_left)
        if (n_left > 0) return
        call load(task, constants, du, statev, trial, valid)
        if (counts_pressure_before(task)) call find_pressure_before(task, constants, statev, trial)
        call rest_law(task, constants, trial%rest)
        trial%start = -1.0_wp
        if (task%cohesion > 0.0_wp) call add_cohesion(task, du, statev, trial%rest, valid)
        if (follows_path(task) .and. task%viscous <= 0.0_wp) then
            call leave_reloading(task, constants, statev, trial, valid)
        end if
        n_slides = 0
        n_left = 0
        do i = 1, lanes
            trial%slides(i) = 0
            strength = min(trial%rest%strength(i), constants(i, c_cap))
            if (trial%rest%traction(i) > strength * (1.0_wp + verge)) trial%slides(i) = 1
            n_slides = n_slides + trial%slides(i)
            left(i) = 0
            if (min(valid(i), trial%rest%valid(i)) < 0.0_wp) left(i) = 1
            if (abs(trial%rest%traction(i) - strength * (1.0_wp + verge)) < unsure * strength) then
                left(i) = 1
            end if
            n_left = n_left + left(i)
        end do
    end subroutine find_trial

    !> Contact pressures at the start of the increment.
    subroutine find_pressure_before(task, constants, statev, trial)
        type(block_task), intent(in) :: task
        real(wp), intent(in) :: constants(lanes, n_constants)
        real(wp), intent(in) :: statev(task%stride, 8)
        type(trial_block), intent(inout) :: trial
        integer :: i

        do i = 1, lanes
            trial%rest%before(i) = max(0.0_wp, -constants(i, c_alpha_n) * statev(i, 2))
        end do
    end subroutine find_pressure_before

    !> Strengths with cohesion; contacts that just touch are left.
    pure subroutine add_cohesion(task, du, statev, rest, valid)
        type(block_task), intent(in) :: task
        real(wp), intent(in) :: du(task%stride, task%ndir), statev(task%stride, 8)
        type(rest_block), intent(inout) :: rest
        real(wp), intent(inout) :: valid(lanes)
        real(wp) :: full
        integer :: i

        if (mobilises(task)) then
            do i = 1, lanes
                full = rest%mu_rest(i) * rest%pressure(i) + task%cohesion
                rest%strength(i) = max(rest%r(i), least_ratio) * full
                rest%r_rest(i) = min(rest%traction(i) / full, 1.0_wp)
            end do
        else
            do i = 1, lanes
                rest%strength(i) = rest%strength(i) + task%cohesion
            end do
        end if
        do i = 1, lanes
            if (rest%pressure(i) <= 0.0_wp .and. statev(i, 2) + du(i, 1) <= 0.0_wp) then
                valid(i) = -1.0_wp
            end if
        end do
    end subroutine add_cohesion

    !> Leaves the points whose numbers are not finite, too large, or out of the range of every law.
    !> Numbers that are not finite meet nothing here but sums, which raise no exception.
    subroutine check(task, du, statev, left, n_left)
        type(block_task), intent(in) :: task
        real(wp), intent(in) :: du(task%stride, task%ndir), statev(task%stride, 8)
        integer(c_int), intent(out) :: left(lanes), n_left
        integer(c_int64_t) :: wrong(lanes), any_wrong
        real(wp) :: moved, others
        integer :: i

        any_wrong = 0
        do i = 1, lanes
            moved = abs(du(i, 1)) + abs(du(i, 2)) + abs(du(i, task%ndir))
            others = abs(statev(i, 2)) + abs(statev(i, 3)) + abs(statev(i, 4)) + abs(statev(i, 5)) &
                + abs(statev(i, 6)) + abs(statev(i, 7)) + abs(statev(i, 8))
            wrong(i) = not(below_largest(others + abs(statev(i, 1)) + moved, largest))
            any_wrong = ior(any_wrong, wrong(i))
        end do
        n_left = 0
        left = 0
        if (any_wrong == 0) return
        left = int(iand(wrong, 1_c_int64_t), c_int)
        n_left = sum(left)
    end subroutine check

    !> The points at the start of the increment, and the elastic traction at its end.
    subroutine load(task, constants, du, statev, trial, valid)
        type(block_task), intent(in) :: task
        real(wp), intent(in) :: constants(lanes, n_constants)
        real(wp), intent(in) :: du(task%stride, task%ndir), statev(task%stride, 8)
        type(trial_block), intent(inout) :: trial
        real(wp), intent(out) :: valid(lanes)   !! below 0 tells a number out of its range
        real(wp) :: in_space, others, phase, q1, q2, p, traction, mu, r, margin
        integer :: i

        in_space = merge(1.0_wp, 0.0_wp, task%ndir == 3)
        do i = 1, lanes
            phase = statev(i, 1)
            q1 = statev(i, 3) + du(i, 2)
            q2 = (statev(i, 4) + du(i, task%ndir)) * in_space
            mu = statev(i, 5)
            r = statev(i, 6)
            margin = min(statev(i, 7), statev(i, 8), &
                -abs(phase * (phase - 1.0_wp) * (phase - 2.0_wp) * (phase - 3.0_wp)))
            if (phase <= 0.0_wp) then
                others = abs(statev(i, 2)) + abs(statev(i, 3)) + abs(statev(i, 4)) + abs(mu) &
                    + abs(r) + abs(statev(i, 7)) + abs(statev(i, 8))
                margin = min(margin, -others)
                mu = constants(i, c_mu_0)
                r = constants(i, c_r_0)
            end if
            p = max(0.0_wp, -constants(i, c_alpha_n) * (statev(i, 2) + du(i, 1)))
            if (p > 0.0_wp) margin = min(margin, -statev(i, 2), p - smallest)
            q1 = merge(q1, 0.0_wp, p > 0.0_wp)
            q2 = merge(q2, 0.0_wp, p > 0.0_wp)
            traction = constants(i, c_alpha_t) * sqrt(q1**2 + (constants(i, c_squeeze) * q2)**2)
            if (abs(q1) + abs(q2) > 0.0_wp) margin = min(margin, traction - smallest)
            valid(i) = margin
            trial%rest%mu(i) = mu
            trial%rest%r(i) = r
            trial%rest%pressure(i) = p
            trial%rest%traction(i) = traction
            trial%q1(i) = q1
            trial%q2(i) = q2
        end do
    end subroutine load

    !> A law that follows the path, where the increment unloads before it loads again (module
    !> `friction_reloading`): points of which that is true are left.
    subroutine leave_reloading(task, constants, statev, trial, valid)
        type(block_task), intent(in) :: task
        real(wp), intent(in) :: constants(lanes, n_constants)
        real(wp), intent(in) :: statev(task%stride, 8)
        type(trial_block), intent(inout) :: trial
        real(wp), intent(inout) :: valid(lanes)
        real(wp) :: u1, u2, q2, length, along, reach, square
        integer :: i

        do i = 1, lanes
            u1 = statev(i, 3)
            u2 = constants(i, c_squeeze) * statev(i, 4)
            if (task%ndir == 2) u2 = 0.0_wp
            q2 = constants(i, c_squeeze) * trial%q2(i)
            length = sqrt(u1**2 + u2**2)
            along = u1 * trial%q1(i) + u2 * q2
            reach = trial%rest%strength(i) / constants(i, c_alpha_t)
            trial%start(i) = -1.0_wp
            if (constants(i, c_cap) >= no_cap) then
                trial%start(i) = constants(i, c_alpha_t) * length
                if (abs(u1) + abs(u2) > 0.0_wp .and. abs(u1) + abs(u2) < smallest) then
                    valid(i) = -1.0_wp   ! its squares underflow
                end if
                square = trial%q1(i)**2 + q2**2
                if (max(along - (1.0_wp + unsure) * reach * length, reach * along - (1.0_wp + &
                    unsure) * square * length) < 0.0_wp) then
                    valid(i) = -1.0_wp
                end if
            end if
        end do
    end subroutine leave_reloading

    !> Slip of the points that slide.
    subroutine find_slip(task, constants, trial, n_slides, slid, left, n_left)
        type(block_task), intent(in) :: task
        real(wp), intent(in) :: constants(lanes, n_constants)
        type(trial_block), intent(inout) :: trial
        integer, intent(in) :: n_slides
        type(slide_block), intent(out) :: slid   !! of no account where nothing slides
        integer(c_int), intent(inout) :: left(lanes)
        integer(c_int), intent(out) :: n_left
        integer, parameter :: many = (3 * lanes) / 4   !! packing takes longer than to fill gaps

        n_left = 0
        if (n_slides < lanes) call clear(slid)
        call find_stiffness(task, constants, trial)
        if (n_slides == 0) return
        if (n_slides == lanes .or. (n_slides > many .and. task%n_own == 0)) then
            call slide_all(task, constants, trial, slid, left)
        else
            call slide_packed(task, constants, trial, n_slides, slid, left)
        end if
        n_left = sum(left)
    end subroutine find_slip

    !> Numbers for the lanes that do not slide: lanes compute before they choose.
    pure subroutine clear(slid)
        type(slide_block), intent(inout) :: slid
        integer :: i

        do i = 1, lanes
            slid%slip(i) = 0.0_wp
            slid%mu_end(i) = 0.0_wp
            slid%r_end(i) = 0.0_wp
            slid%resistance(i) = 0.0_wp
            slid%d_slip(i) = 0.0_wp
            slid%d_pressure(i) = 0.0_wp
        end do
    end subroutine clear

    !> How the spring unloads: by alpha_t, where one coefficient counts. That a neighbour has two
    !> changes no bit.
    subroutine find_stiffness(task, constants, trial)
        type(block_task), intent(in) :: task
        real(wp), intent(in) :: constants(lanes, n_constants)
        type(trial_block), intent(inout) :: trial
        integer :: i

        if (iand(task%options, with_two_coefficients) == 0) then
            do i = 1, lanes
                trial%stiffness(i) = constants(i, c_alpha_t)
            end do
        else
            do i = 1, lanes
                trial%length(i) = max(sqrt(trial%q1(i)**2 + trial%q2(i)**2), least_length)
                trial%stiffness(i) = max(trial%rest%traction(i), least) / trial%length(i)
                if (abs(constants(i, c_squeeze) - 1.0_wp) <= 0.0_wp) then
                    trial%stiffness(i) = constants(i, c_alpha_t)
                end if
            end do
        end if
    end subroutine find_stiffness

    !> All points of the block; those that do not slide take the numbers of one that does.
    subroutine slide_all(task, constants, trial, slid, left)
        type(block_task), intent(in) :: task
        real(wp), intent(in) :: constants(lanes, n_constants)
        type(trial_block), intent(in) :: trial
        type(slide_block), intent(inout) :: slid
        integer(c_int), intent(inout) :: left(lanes)
        real(wp) :: own_strength(lanes)
        integer :: i, first

        do first = 1, lanes
            if (trial%slides(first) > 0) exit
        end do
        slid%n = lanes
        do i = 1, lanes
            slid%trial(i) = trial%rest%traction(first)
            slid%pressure(i) = trial%rest%pressure(first)
            slid%mu(i) = trial%rest%mu(first)
            slid%r(i) = trial%rest%r(first)
            slid%mu_rest(i) = trial%rest%mu_rest(first)
            own_strength(i) = trial%rest%strength(first)
            slid%stiffness(i) = trial%stiffness(first)
            if (trial%slides(i) > 0) then
                slid%trial(i) = trial%rest%traction(i)
                slid%pressure(i) = trial%rest%pressure(i)
                slid%mu(i) = trial%rest%mu(i)
                slid%r(i) = trial%rest%r(i)
                slid%mu_rest(i) = trial%rest%mu_rest(i)
                own_strength(i) = trial%rest%strength(i)
                slid%stiffness(i) = trial%stiffness(i)
            end if
        end do
        if (counts_pressure_before(task)) then
            do i = 1, lanes
                slid%before(i) = trial%rest%before(merge(i, first, trial%slides(i) > 0))
            end do
        end if
        call slide(task, constants, own_strength, slid)
        do i = 1, lanes
            if (slid%left(i) > 0.0_wp) left(i) = trial%slides(i)
        end do
    end subroutine slide_all

    !> The points that slide, packed together.
    subroutine slide_packed(task, constants, trial, n_slides, slid, left)
        type(block_task), intent(in) :: task
        real(wp), intent(in) :: constants(lanes, n_constants)
        type(trial_block), intent(in) :: trial
        integer, intent(in) :: n_slides
        type(slide_block), intent(inout) :: slid
        integer(c_int), intent(inout) :: left(lanes)
        type(slide_block) :: packed
        real(wp) :: packed_constants(lanes, n_constants), own_strength(lanes)
        integer :: place(lanes), n, i, k

        n = 0
        do i = 1, lanes
            place(n + 1) = i
            n = n + trial%slides(i)
        end do
        packed%n = min(lanes, iand(n_slides + widest - 1, not(widest - 1)))
        place(n_slides + 1:packed%n) = place(1)   ! whole vectors: the first one fills the last
        do i = 1, packed%n
            packed%trial(i) = trial%rest%traction(place(i))
            packed%pressure(i) = trial%rest%pressure(place(i))
            packed%mu(i) = trial%rest%mu(place(i))
            packed%r(i) = trial%rest%r(place(i))
            packed%mu_rest(i) = trial%rest%mu_rest(place(i))
            packed%stiffness(i) = trial%stiffness(place(i))
        end do
        if (iand(task%options, with_cap) > 0) then
            call pack_column(packed%n, place, trial%rest%strength, own_strength)
        end if
        if (counts_pressure_before(task)) then
            call pack_column(packed%n, place, trial%rest%before, packed%before)
        end if
        if (task%n_own > 0) then
            do k = c_own, c_own + task%n_own - 1
                call pack_column(packed%n, place, constants(:, k), packed_constants(:, k))
            end do
            packed_constants(:packed%n, c_cap) = no_cap
            if (iand(task%options, with_cap) > 0) then
                call pack_column(packed%n, place, constants(:, c_cap), packed_constants(:, c_cap))
            end if
            call slide(task, packed_constants, own_strength, packed)
        else
            call slide(task, constants, own_strength, packed)
        end if
        call unpack(n_slides, place, packed, slid, left)
    end subroutine slide_packed

    pure subroutine pack_column(n, place, from, to)
        integer, intent(in) :: n, place(lanes)
        real(wp), intent(in) :: from(lanes)
        real(wp), intent(inout) :: to(lanes)
        integer :: i

        do i = 1, n
            to(i) = from(place(i))
        end do
    end subroutine pack_column

    !> Results of packed points, back in their places.
    pure subroutine unpack(n, place, packed, slid, left)
        integer, intent(in) :: n, place(lanes)
        type(slide_block), intent(in) :: packed
        type(slide_block), intent(inout) :: slid
        integer(c_int), intent(inout) :: left(lanes)
        real(wp) :: any_left
        integer :: i

        do i = 1, n
            slid%slip(place(i)) = packed%slip(i)
            slid%mu_end(place(i)) = packed%mu_end(i)
            slid%r_end(place(i)) = packed%r_end(i)
            slid%resistance(place(i)) = packed%resistance(i)
            slid%d_slip(place(i)) = packed%d_slip(i)
            slid%d_pressure(place(i)) = packed%d_pressure(i)
        end do
        any_left = 0.0_wp
        do i = 1, packed%n
            any_left = max(any_left, packed%left(i))
        end do
        if (any_left <= 0.0_wp) return
        do i = 1, n
            if (packed%left(i) > 0.0_wp) left(place(i)) = 1
        end do
    end subroutine unpack

    !> The first equilibrium under the law, and under its shear cap. Where the law has one
    !> equilibrium at most, the cap holds if and only if the law resists with more than that there,
    !> or if it does not let the surface slide at all. (The slips at both say the same, but lose it
    !> to round-off where the trial is far above the cap.)
    subroutine slide(task, constants, own_strength, block)
        type(block_task), intent(in) :: task
        real(wp), intent(in) :: constants(lanes, n_constants)
        real(wp), intent(in) :: own_strength(lanes)   !! of the law without the cap [F/L^2]
        type(slide_block), intent(inout) :: block
        real(wp), parameter :: of_exponents = 1.0e-8_wp   ! round-off of what follows from them
        real(wp), dimension(lanes) :: trial, held, slip   ! at the cap
        real(wp) :: near, verge_of_cap
        integer :: i

        if (iand(task%options, with_cap) == 0) then
            call slide_by_law(task, constants, block)
            return
        end if
        do i = 1, block%n
            trial(i) = block%trial(i)
            ! a quotient of all points: under a condition it would be one of zeros for the others
            slip(i) = max(trial(i) - constants(i, c_cap), 0.0_wp) / block%stiffness(i)
            held(i) = 0.0_wp
            if (trial(i) <= own_strength(i) * (1.0_wp + verge)) held(i) = 1.0_wp
            if (held(i) > 0.0_wp) block%trial(i) = 1.01_wp * own_strength(i)   ! of no account
        end do
        call slide_by_law(task, constants, block)
        near = 4.0_wp * verge   ! round-off decides whether the cap holds
        if (follows_rate(task)) near = of_exponents
        do i = 1, block%n
            block%trial(i) = trial(i)
            if (block%resistance(i) > constants(i, c_cap)) held(i) = 1.0_wp
            verge_of_cap = min(abs(block%resistance(i) - constants(i, c_cap)), abs(trial(i) &
                - constants(i, c_cap))) - near * constants(i, c_cap)
            if (verge_of_cap <= 0.0_wp) block%left(i) = 1.0_wp
            if (held(i) > 0.0_wp) block%slip(i) = slip(i)
        end do
        if (any(held(:block%n) > 0.0_wp)) call hold_at_cap(task, constants, held, block)
    end subroutine slide

    subroutine slide_by_law(task, constants, block)
        type(block_task), intent(in) :: task
        real(wp), intent(in) :: constants(lanes, n_constants)
        type(slide_block), intent(inout) :: block

        if (.not. task%cohesion > 0.0_wp) then
            call slide_law(task, constants, block)
        else if (mobilises(task)) then
            call slide_mobilising(task, constants, block)
        else
            call slide_above_cohesion(task, constants, block)
        end if
    end subroutine slide_by_law

    !> A law to which a cohesion is added: its equilibrium with what the spring pulls above that.
    subroutine slide_above_cohesion(task, constants, block)
        type(block_task), intent(in) :: task
        real(wp), intent(in) :: constants(lanes, n_constants)
        type(slide_block), intent(inout) :: block
        real(wp), parameter :: few_digits = 0.02_wp
        real(wp) :: trial(lanes)
        integer :: i

        do i = 1, block%n
            trial(i) = block%trial(i)
            block%trial(i) = trial(i) - task%cohesion
        end do
        call slide_law(task, constants, block)
        do i = 1, block%n
            ! the state tells the law's part, of which a difference has too few digits
            if (follows_rate(task) .and. block%trial(i) < few_digits * trial(i)) then
                block%left(i) = 1.0_wp
            end if
            block%trial(i) = trial(i)
            block%resistance(i) = block%resistance(i) + task%cohesion
        end do
    end subroutine slide_above_cohesion

    !> The subloading laws, R (mu p + c): the law without cohesion under the pressure p + c, with
    !> coefficients (mu p + c)/(p + c), which evolve as mu does.
    subroutine slide_mobilising(task, constants, block)
        type(block_task), intent(in) :: task
        real(wp), intent(in) :: constants(lanes, n_constants)
        type(slide_block), intent(inout) :: block
        real(wp) :: shifted(lanes, n_constants)
        real(wp), dimension(lanes) :: pressure, mu, mu_rest
        integer :: i

        shifted = constants
        do i = 1, block%n
            pressure(i) = block%pressure(i)
            mu(i) = block%mu(i)
            mu_rest(i) = block%mu_rest(i)
            block%pressure(i) = pressure(i) + task%cohesion
            block%mu(i) = (mu(i) * pressure(i) + task%cohesion) / block%pressure(i)
            block%mu_rest(i) = (mu_rest(i) * pressure(i) + task%cohesion) / block%pressure(i)
            shifted(i, c_mu_s) = (constants(i, c_mu_s) * pressure(i) + task%cohesion) &
                / block%pressure(i)
            shifted(i, c_mu_k) = (constants(i, c_mu_k) * pressure(i) + task%cohesion) &
                / block%pressure(i)
        end do
        call slide_law(task, shifted, block)
        do i = 1, block%n
            block%pressure(i) = pressure(i)
            block%mu(i) = mu(i)
            block%mu_rest(i) = mu_rest(i)
        end do
        call find_coefficients(task, constants, block)
        do i = 1, block%n
            block%d_pressure(i) = block%r_end(i) * block%mu_end(i)
        end do
    end subroutine slide_mobilising

    !> Where the cap holds: the law's variables follow the slip.
    subroutine hold_at_cap(task, constants, held, block)
        type(block_task), intent(in) :: task
        real(wp), intent(in) :: constants(lanes, n_constants)
        real(wp), intent(in) :: held(lanes)   !! 1 where it does, else 0
        type(slide_block), intent(inout) :: block
        type(slide_block) :: copy
        integer :: i

        copy%n = block%n
        if (counts_pressure_before(task)) copy%before(:block%n) = block%before(:block%n)
        do i = 1, block%n
            copy%slip(i) = block%slip(i)
            copy%trial(i) = block%trial(i)
            copy%stiffness(i) = block%stiffness(i)
            copy%pressure(i) = block%pressure(i)
            copy%mu(i) = block%mu(i)
            copy%r(i) = block%r(i)
            copy%mu_end(i) = block%mu_end(i)   ! of a law without variables
            copy%r_end(i) = block%r_end(i)
            copy%left(i) = 0.0_wp
        end do
        call state_of_law(task, constants, copy)
        do i = 1, block%n
            if (held(i) > 0.0_wp) then
                block%mu_end(i) = copy%mu_end(i)
                block%r_end(i) = copy%r_end(i)
                block%resistance(i) = constants(i, c_cap)
                block%d_slip(i) = 0.0_wp
                block%d_pressure(i) = 0.0_wp
                block%left(i) = max(block%left(i), copy%left(i))
            end if
        end do
    end subroutine hold_at_cap

    !> State, traction and tangent at the end of the increment. Loops of few arrays each, since a
    !> cache holds few lines whose addresses differ by a power of two.
    subroutine finish(task, constants, du, trial, slid, statev, traction, tangent)
        type(block_task), intent(in) :: task
        real(wp), intent(in) :: constants(lanes, n_constants)
        real(wp), intent(in) :: du(task%stride, task%ndir)
        type(trial_block), intent(in) :: trial
        type(slide_block), intent(in) :: slid
        real(wp), intent(inout) :: statev(task%stride, 8), traction(task%stride, task%ndir)
        real(wp), intent(inout) :: tangent(task%stride, task%ndir, task%ndir)
        type(answer_block) :: answer
        real(wp) :: closed, mean, mu, r, slip, share, resistance, d_slip, d_pressure, slides
        integer :: i

        call find_direction(constants, trial, slid, answer)
        if (iand(task%options, with_two_coefficients) > 0) call find_work(constants, trial, answer)
        !GCC$ ivdep
        do i = 1, lanes
            slides = 0.0_wp
            slip = 0.0_wp
            resistance = 0.0_wp
            d_slip = 0.0_wp
            d_pressure = 0.0_wp
            mu = trial%rest%mu_rest(i)
            r = trial%rest%r_rest(i)
            closed = 0.0_wp
            if (trial%rest%pressure(i) > 0.0_wp) closed = 1.0_wp
            share = closed
            if (trial%slides(i) > 0) then
                slides = 1.0_wp
                slip = slid%slip(i)
                resistance = slid%resistance(i)
                d_slip = slid%d_slip(i)
                d_pressure = slid%d_pressure(i)
                mu = slid%mu_end(i)
                r = slid%r_end(i)
                share = resistance * answer%per_traction(i)
            end if
            answer%share(i) = share
            statev(i, 5) = mu
            statev(i, 6) = r
            answer%d_slip(i) = d_slip
            answer%by_du_n(i) = -constants(i, c_alpha_n) * answer%coupling(i) * d_pressure
            statev(i, 1) = 3.0_wp - 2.0_wp * closed + slides
            statev(i, 2) = statev(i, 2) + du(i, 1)
            statev(i, 3) = share * trial%q1(i)
            statev(i, 4) = share * trial%q2(i)
            statev(i, 7) = statev(i, 7) + slip
            mean = resistance
            if (trial%start(i) >= 0.0_wp) mean = 0.5_wp * (mean + trial%start(i))
            statev(i, 8) = statev(i, 8) + mean * slip * answer%work_ratio(i)
        end do
        call write_answer(task, constants, trial, answer, traction, tangent)
    end subroutine finish

    !> Direction and coupling. Quotients of all points, though only those that slide need them: a
    !> quotient under a condition would be one of zeros for the others.
    pure subroutine find_direction(constants, trial, slid, answer)
        real(wp), intent(in) :: constants(lanes, n_constants)
        type(trial_block), intent(in) :: trial
        type(slide_block), intent(in) :: slid
        type(answer_block), intent(out) :: answer
        real(wp) :: force, total, along, shared
        integer :: i

        do i = 1, lanes
            force = max(trial%rest%traction(i), least)
            total = max(trial%stiffness(i) + slid%d_slip(i), epsilon(1.0_wp) * trial%stiffness(i))
            shared = 1.0_wp / (force * total)   ! one division for two
            along = merge(trial%stiffness(i), 0.0_wp, trial%slides(i) > 0)
            answer%per_traction(i) = total * shared
            answer%coupling(i) = constants(i, c_alpha_t) * force * shared
            answer%t1(i) = trial%q1(i) * (along * answer%per_traction(i))
            answer%t2(i) = trial%q2(i) * (along * answer%per_traction(i))
            answer%work_ratio(i) = 1.0_wp
            answer%squeezed(i) = 0.0_wp
        end do
    end subroutine find_direction

    !> What a surface with two friction coefficients, which slides along the trial traction, adds.
    pure subroutine find_work(constants, trial, answer)
        real(wp), intent(in) :: constants(lanes, n_constants)
        type(trial_block), intent(in) :: trial
        type(answer_block), intent(inout) :: answer
        integer :: i

        do i = 1, lanes
            if (abs(constants(i, c_squeeze) - 1.0_wp) > 0.0_wp) then
                answer%work_ratio(i) = constants(i, c_alpha_t) * trial%length(i) &
                    * answer%per_traction(i)
            end if
            answer%squeezed(i) = merge(constants(i, c_squeeze)**2 - 1.0_wp, 0.0_wp, &
                trial%slides(i) > 0) * answer%work_ratio(i)
        end do
    end subroutine find_work

    !> Where nothing slides, `t1` and `t2` are 0 and `stuck` is 1, else 0: with their squares this
    !> is 1 less the other's square, without a difference that would leave round-off of a stiff
    !> damper.
    subroutine write_answer(task, constants, trial, answer, traction, tangent)
        type(block_task), intent(in) :: task
        real(wp), intent(in) :: constants(lanes, n_constants)
        type(trial_block), intent(in) :: trial
        type(answer_block), intent(in) :: answer
        real(wp), intent(inout) :: traction(task%stride, task%ndir)
        real(wp), intent(inout) :: tangent(task%stride, task%ndir, task%ndir)
        real(wp) :: t1, t2, across, stuck, turn, pull_1, pull_2
        integer :: i

        !GCC$ ivdep
        do i = 1, lanes
            t1 = answer%t1(i)
            t2 = answer%t2(i)
            across = answer%share(i) * constants(i, c_alpha_t)
            stuck = merge(0.0_wp, 1.0_wp, trial%slides(i) > 0)
            turn = t1 * t2 * answer%squeezed(i) * across
            pull_1 = answer%coupling(i) * (answer%d_slip(i) * t1 + turn * t2)
            traction(i, 1) = -trial%rest%pressure(i)
            traction(i, 2) = across * trial%q1(i)
            tangent(i, 1, 1) = merge(constants(i, c_alpha_n), 0.0_wp, &
                trial%rest%pressure(i) > 0.0_wp)
            tangent(i, 2, 1) = answer%by_du_n(i) * t1
            tangent(i, 1, 2) = 0.0_wp
            tangent(i, 2, 2) = across * (stuck + t2 * t2) + t1 * pull_1
        end do
        if (task%ndir == 2) return
        !GCC$ ivdep
        do i = 1, lanes
            t1 = answer%t1(i)
            t2 = answer%t2(i)
            across = answer%share(i) * constants(i, c_alpha_t)
            stuck = merge(0.0_wp, 1.0_wp, trial%slides(i) > 0)
            turn = t1 * t2 * answer%squeezed(i) * across
            pull_1 = answer%coupling(i) * (answer%d_slip(i) * t1 + turn * t2)
            pull_2 = answer%coupling(i) * (answer%d_slip(i) * t2 - turn * t1)
            traction(i, 3) = across * trial%q2(i)
            tangent(i, 3, 1) = answer%by_du_n(i) * t2
            tangent(i, 3, 2) = t2 * (pull_1 - across * t1)
            tangent(i, 1, 3) = 0.0_wp
            tangent(i, 2, 3) = t1 * (pull_2 - across * t2)
            tangent(i, 3, 3) = across * (stuck + t1 * t1) + t2 * pull_2
        end do
    end subroutine write_answer

end module friction_batch_kernel
