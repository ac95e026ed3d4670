!> Random histories of a contact point under each law, what the routine makes of one of their
!> increments, and a measure of how far an adapter's answer is from that.
!>
!> Every increment is compared from the adapter's own state on, so that a difference does not grow
!> from increment to increment; a state that is carried on wrongly shows where it is written.
module law_histories
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use draws, only : draw, seed_draws
    use friction_mod, only : friction_tangential, friction_update
    use law_suite, only : law_case, law_point, laws, random_law_point
    use worst_errors, only : worse, worst_of
    implicit none
    private

    public :: another_path, compare, elastic_energy, expected_answer, expected_tangential, &
        follow_every_law, friction_status, hold, random_history, rotated, sheared_point, take_in

    integer, parameter, public :: history_length = 40
    real(dp), parameter, public :: round_off = 1.0e-13_dp   !! some hundred roundings

    type, public :: law_history
        real(dp), allocatable :: props(:)
        real(dp) :: du(3, history_length)    !! normal (> 0 opens), tangential 1 and 2
        real(dp) :: dt(history_length)
        real(dp) :: depth                    !! penetrations are of this size [L]
        real(dp) :: reach                    !! slips and elastic displacements are of this size [L]
        real(dp) :: worst = 0.0_dp           !! difference so far; 1 is all that is allowed
        real(dp) :: largest(8) = 0.0_dp      !! state variables so far
        integer :: phases(0:3) = 0           !! increments that end virgin, in stick, slip, open
    end type law_history

    !> Traction and tangent in the routine's own signs, two directions or one with zeros behind.
    type, public :: contact_answer
        real(dp) :: traction(3) = 0.0_dp
        real(dp) :: tangent(3, 3) = 0.0_dp
        real(dp) :: start(8) = 0.0_dp    !! state at the start of the increment
        real(dp) :: statev(8) = 0.0_dp   !! and at its end
        integer :: status = 0
    end type contact_answer

    interface
        !> Takes an adapter along a history, compares, and leaves in it what was seen.
        subroutine follower(h)
            import :: law_history
            implicit none
            type(law_history), intent(inout) :: h
        end subroutine follower
    end interface

contains

    !> Takes an adapter through every law of the suite. The complaint names the law at which it does
    !> not give what the routine gives, or whose histories hardly slip; empty if there is none.
    subroutine follow_every_law(adapter, seed, n_histories, follow, complaint)
        character(len=*), intent(in) :: adapter
        integer, intent(in) :: seed, n_histories
        procedure(follower) :: follow
        character(len=:), allocatable, intent(out) :: complaint
        type(law_history) :: h, seen
        integer :: i, k

        complaint = ''
        do k = 1, size(laws)
            call seed_draws(seed + k)
            seen%worst = 0.0_dp
            seen%phases = 0
            do i = 1, n_histories
                h = random_history(laws(k))
                call follow(h)
                call take_in(seen, h)
            end do
            write (*, '(5a, es8.1, 3(a, i0), a)') '  ', adapter, ', ', laws(k)%name, &
                ' difference ', seen%worst, ' of what is allowed; ', seen%phases(1), ' stick, ', &
                seen%phases(2), ' slip, ', seen%phases(3), ' open'
            if (seen%worst < 1.0_dp .and. seen%phases(2) > sum(seen%phases) / 5) cycle
            complaint = complaint // trim(laws(k)%name) // '; '
        end do
    end subroutine follow_every_law

    !> What was seen of another history counts here, too.
    pure subroutine take_in(seen, h)
        type(law_history), intent(inout) :: seen
        type(law_history), intent(in) :: h

        seen%worst = worse(seen%worst, h%worst)
        seen%phases = seen%phases + h%phases
    end subroutine take_in

    function random_history(this) result(h)
        type(law_case), intent(in) :: this
        type(law_history) :: h
        type(law_point) :: p
        integer :: k

        p = random_law_point(this, 1.0_dp)
        h%props = p%props
        h%reach = p%reach
        h%depth = p%reach * p%props(3) / (0.4_dp * p%props(2))
        do k = 1, history_length
            h%dt(k) = p%dt * draw(0.5_dp, 2.0_dp)
        end do
        call draw_path(h)
    end function random_history

    !> Another point of the same surface at the same times.
    function another_path(h) result(other)
        type(law_history), intent(in) :: h
        type(law_history) :: other

        other = h
        other%worst = 0.0_dp
        other%phases = 0
        call draw_path(other)
    end function another_path

    !> Pressed, sheared, reversed, held, opened, closed and sheared this way and that.
    subroutine draw_path(h)
        type(law_history), intent(inout) :: h
        real(dp) :: u_n, next, angle, turn, length
        integer :: k

        u_n = 0.0_dp
        angle = draw(0.0_dp, 8.0_dp * atan(1.0_dp))
        do k = 1, history_length
            next = -h%depth * draw(0.8_dp, 1.2_dp)
            length = h%reach * draw(0.3_dp, 1.2_dp)
            turn = draw(-0.4_dp, 0.4_dp)
            select case (k)
            case (1)
                length = 0.0_dp
            case (13:22)
                turn = turn + 4.0_dp * atan(1.0_dp)
            case (23:24)
                next = u_n
                length = 0.0_dp
            case (25:27)
                next = h%depth * draw(0.2_dp, 0.5_dp)
            case (29:)
                turn = 10.0_dp * turn
            case default
                continue   ! sheared on
            end select
            h%du(:, k) = [next - u_n, length * cos(angle + turn), length * sin(angle + turn)]
            u_n = next
        end do
    end subroutine draw_path

    !> A point that has slid and sticks or slides: pressed and sheared by more than it bears.
    function sheared_point(h) result(statev)
        type(law_history), intent(in) :: h
        real(dp) :: statev(8)
        type(contact_answer) :: answer
        integer :: k

        do k = 1, 12
            answer = expected_answer(h%props, h%du(:, k), h%dt(k), answer%statev)
        end do
        statev = answer%statev
    end function sheared_point

    !> What `friction_update` makes of an increment with 2 or 3 components.
    function expected_answer(props, du, dt, start) result(answer)
        real(dp), intent(in) :: props(:), du(:), dt, start(8)
        type(contact_answer) :: answer
        integer :: n

        n = size(du)
        answer%start = start
        answer%statev = start
        call friction_update(du, dt, props, answer%statev, answer%traction(1:n), &
            answer%tangent(1:n, 1:n), answer%status)
    end function expected_answer

    !> The same of `friction_tangential`, with 1 or 2 directions; column 1 of the tangent is by the
    !> normal displacement that would change the pressure, row 1 is left out.
    function expected_tangential(props, du, pressure, dt, start) result(answer)
        real(dp), intent(in) :: props(:), du(:), pressure, dt, start(8)
        type(contact_answer) :: answer
        integer :: n

        n = size(du)
        answer%start = start
        answer%statev = start
        call friction_tangential(du, pressure, dt, props, answer%statev, answer%traction(2:n + 1), &
            answer%tangent(2:n + 1, 2:n + 1), answer%tangent(2:n + 1, 1), answer%status)
        answer%traction(1) = -pressure
        answer%tangent(2:3, 1) = -props(2) * answer%tangent(2:3, 1)
    end function expected_tangential

    !> Measures an answer in what some hundred roundings of the displacements make of it: they reach
    !> the traction through the tangent, and the tangent through its own change, which where a
    !> contact is nearly unstable goes with the square of its excess over the springs.
    subroutine compare(h, moved, expected, found)
        type(law_history), intent(inout) :: h
        real(dp), intent(in) :: moved   !! displacements that were rounded are of this size [L]
        type(contact_answer), intent(in) :: expected, found
        real(dp) :: stiff, steep, excess, pressure, slip, allowed(8), off(3)

        if (.not. h%worst < 1.0_dp) return   ! what follows an error means nothing
        stiff = maxval(h%props(2:3))
        steep = max(stiff, maxval(abs(expected%tangent)))
        excess = steep / stiff
        pressure = -expected%traction(1)
        h%largest = max(h%largest, abs(expected%statev))
        allowed = excess * (h%largest + 1.0e-200_dp)
        allowed(2:4) = excess * moved
        if (pressure > 0.0_dp) allowed(5) = allowed(5) + steep * moved / pressure
        slip = expected%statev(7) - expected%start(7)
        if (slip > 0.0_dp) allowed(6) = allowed(6) + excess * moved * abs(expected%statev(6) &
            - expected%start(6)) / slip
        allowed(7) = allowed(7) + excess * moved
        allowed(8) = allowed(8) + steep * moved**2
        off = [worst_of(abs(expected%traction - found%traction)) / (steep * moved), &
            worst_of(abs(expected%tangent - found%tangent)) / (excess * steep), &
            worst_of(abs(expected%statev - found%statev) / allowed)]
        h%worst = worse(h%worst, worst_of(off) / round_off)
        if (expected%status /= found%status) h%worst = huge(1.0_dp)
        if (nint(expected%statev(1)) /= nint(found%statev(1))) h%worst = huge(1.0_dp)
        if (expected%status < 0) h%worst = huge(1.0_dp)
        h%phases(nint(expected%statev(1))) = h%phases(nint(expected%statev(1))) + 1
    end subroutine compare

    !> Two numbers that some hundred roundings of a third may tell apart.
    pure subroutine hold(h, expected, found, scale)
        type(law_history), intent(inout) :: h
        real(dp), intent(in) :: expected, found, scale

        h%worst = worse(h%worst, abs(expected - found) / (round_off * max(scale, tiny(1.0_dp))))
    end subroutine hold

    !> Elastic energy of the contact's springs per area (docs/theory.md, section 5).
    pure function elastic_energy(props, statev) result(energy)
        real(dp), intent(in) :: props(:), statev(8)
        real(dp) :: energy

        energy = 0.5_dp * (props(2) * min(statev(2), 0.0_dp)**2 + props(3) * sum(statev(3:4)**2))
    end function elastic_energy

    !> A state whose surface axes have turned.
    pure function rotated(statev, turn) result(turned)
        real(dp), intent(in) :: statev(8), turn(2, 2)
        real(dp) :: turned(8)

        turned = statev
        turned(3:4) = matmul(turn, statev(3:4))
    end function rotated

    !> The status that an adapter tells its host by the step it asks for; `none` is no wish.
    pure integer function friction_status(pnewdt, none) result(status)
        real(dp), intent(in) :: pnewdt, none

        status = -1
        if (abs(pnewdt - none) <= 0.0_dp) status = 0
        if (abs(pnewdt - 0.5_dp) <= 0.0_dp) status = 1
    end function friction_status

end module law_histories
