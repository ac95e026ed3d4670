!> One contact point through one increment: validates, chooses the law, updates, and writes the
!> state back (public names and arguments: module friction_mod).
!>
!> What every update passes through is in this file, so that a compiler that works file by file can
!> inline it, too.
submodule(friction_mod) friction_advance
    use friction_anisotropy, only : sliding_way, tangential_trial
    use friction_axes, only : contact_axes, is_unit_vector, turn_axes
    use friction_contact, only : answer_of_slip, answer_of_stick, contact_constants, &
        contact_motion, contact_point, contact_update, follow_trial, least, near_underflow, &
        point_open, point_slip, point_stick, point_virgin, tangential_answer, touches, verge, &
        write_answer
    use friction_continuous, only : contact_rates, point_rates
    use friction_kinds, only : largest
    use friction_law, only : law, law_state, sliding
    use friction_law_choice, only : choose_law, first_own_prop, law_storage, law_subloading, &
        prop_alpha_n, prop_alpha_t, spring_constants, surface_options
    use friction_subloading_law, only : subloading_law
    implicit none

contains

    module procedure friction_update
        integer :: n

        n = size(du)
        status = friction_bad_size
        if (size(traction) /= n .or. size(tangent, 1) /= n .or. size(tangent, 2) /= n) return
        call update_arrays(array_sizes(1, n, size(props), size(statev)), du, dtime, props, statev, &
            traction, tangent, status)
    end procedure friction_update

    module procedure update_arrays
        real(wp) :: space(3), plane_traction(3), plane_tangent(3, 3)

        status = friction_bad_size
        if (sizes%ndir < 2 .or. sizes%ndir > 3) return
        if (sizes%ndir == 3) then
            call advance_in_space(du, dtime, sizes, props, statev, traction, tangent, status)
        else
            space(1) = du(1)
            space(2) = du(2)
            space(3) = 0.0_wp
            call advance_in_space(space, dtime, sizes, props, statev, plane_traction, &
                plane_tangent, status)
            if (status < 0) return
            traction = plane_traction(1:2)
            tangent = plane_tangent(1:2, 1:2)
        end if
    end procedure update_arrays

    !> An update with three components, of which the last is zero where there are two.
    pure subroutine advance_in_space(du, dt, sizes, props, statev, traction, tangent, status)
        real(wp), intent(in) :: du(3), dt
        type(array_sizes), intent(in) :: sizes
        real(wp), intent(in) :: props(sizes%nprops)
        real(wp), intent(inout) :: statev(sizes%nstatv)
        real(wp), intent(inout) :: traction(3), tangent(3, 3)
        integer, intent(out) :: status
        type(contact_motion) :: motion
        logical :: done

        call advance_plainly(du, dt, sizes, props, statev, traction, tangent, done)
        status = friction_ok
        if (done) return
        motion%du(1) = du(1)
        motion%du(2) = du(2)
        motion%du(3) = du(3)
        motion%dt = dt
        motion%pressure_given = .false.
        motion%pressure = 0.0_wp
        motion%blur = 0.0_wp
        motion%blur_start = 0.0_wp
        call advance(motion, sizes, props, statev, traction, tangent, status)
    end subroutine advance_in_space

    module procedure friction_update_frame
        real(wp) :: axes(3, 3), state(statev_size), contact_traction(3), contact_tangent(3, 3)
        real(wp) :: vector(3), matrix(3, 3)
        real(wp), parameter :: turning = 8.0_wp * epsilon(turning)   !! what it takes in and out
        type(contact_motion) :: motion
        integer :: n, answer

        n = size(du)
        status = friction_bad_size
        if (n < 2 .or. n > 3 .or. size(normal) /= n .or. size(traction) /= n &
            .or. size(tangent, 1) /= n .or. size(tangent, 2) /= n &
            .or. size(statev) < statev_size) return
        status = friction_bad_normal
        if (.not. all_usable(n, normal)) return
        if (.not. is_unit_vector(normal)) return
        status = friction_bad_increment
        if (.not. all_usable(n, du)) return
        status = friction_bad_state
        if (.not. all_usable(statev_size, statev)) return

        axes = contact_axes(normal)
        if (n == 3 .and. friction_is_orthotropic(props)) then
            call turn_to(axis, axes, status)
            if (status < 0) return
        end if
        ! In the plane the third axis is zero, and so is all that it takes part in: products of a
        ! fixed shape need no run-time library.
        vector = 0.0_wp
        vector(1:n) = du
        motion%du = matmul(vector, axes)
        motion%dt = dtime
        motion%pressure_given = .false.
        motion%pressure = 0.0_wp
        state = statev(1:statev_size)
        motion%blur_start = turning * sum(abs(state(statev_u_n:statev_u_n + n - 1)))
        motion%blur = motion%blur_start + turning * sum(abs(du))
        vector = matmul(state(statev_u_n:statev_u_n + 2), axes)
        state(statev_u_n:statev_u_n + n - 1) = vector(1:n)
        call advance(motion, array_sizes(1, n, size(props), statev_size), props, state, &
            contact_traction, contact_tangent, answer)
        status = answer
        if (status < 0) return
        vector = matmul(axes, state(statev_u_n:statev_u_n + 2))
        status = friction_bad_increment
        if (.not. all_usable(3, vector)) return
        status = answer
        state(statev_u_n:statev_u_n + n - 1) = vector(1:n)
        statev(1:statev_size) = state
        vector = matmul(axes, contact_traction)
        traction = vector(1:n)
        matrix = matmul(axes, matmul(contact_tangent, transpose(axes)))
        tangent = matrix(1:n, 1:n)
    end procedure friction_update_frame

    !> Turns the axes to the one that a caller may have given.
    pure subroutine turn_to(axis, axes, status)
        real(wp), intent(in), contiguous, optional :: axis(:)
        real(wp), intent(inout) :: axes(3, 3)   !! as columns, the first is the normal
        integer, intent(out) :: status          !! ok, bad size, or bad axis

        status = friction_bad_axis
        if (.not. present(axis)) return
        status = friction_bad_size
        if (size(axis) /= 3) return
        status = friction_bad_axis
        if (all_usable(3, axis)) call turn_axes(axis, axes, status)
    end subroutine turn_to

    module procedure friction_is_orthotropic
        type(law_storage), target :: storage
        class(law), pointer :: surface
        type(surface_options) :: options
        integer :: status

        orthotropic = .false.
        if (size(props) < first_own_prop) return
        if (.not. all_usable(size(props), props)) return
        call choose_law(size(props), props, storage, surface, options, status)
        if (status == friction_ok) orthotropic = abs(options%plane%squeeze - 1.0_wp) > 0.0_wp
    end procedure friction_is_orthotropic

    module procedure friction_tangential
        type(contact_motion) :: motion
        real(wp) :: contact_traction(3), contact_tangent(3, 3)
        integer :: n

        n = size(du)
        status = friction_bad_size
        if (n < 1 .or. n > 2 .or. size(tau) /= n .or. size(dtau_ddu, 1) /= n &
            .or. size(dtau_ddu, 2) /= n .or. size(dtau_dp) /= n) return
        motion%du = 0.0_wp
        motion%du(2:n + 1) = du
        motion%dt = dtime
        motion%pressure_given = .true.
        motion%pressure = pressure
        motion%blur = 0.0_wp
        motion%blur_start = 0.0_wp
        call advance(motion, array_sizes(1, n + 1, size(props), size(statev)), props, statev, &
            contact_traction, contact_tangent, status)
        if (status < 0) return
        tau = contact_traction(2:n + 1)
        dtau_ddu = contact_tangent(2:n + 1, 2:n + 1)
        dtau_dp = contact_tangent(2:n + 1, 1)
    end procedure friction_tangential

    module procedure friction_rates
        type(law_storage), target :: storage
        class(law), pointer :: surface
        type(surface_options) :: options
        type(contact_point) :: point
        type(point_rates) :: by_time
        real(wp) :: v(3)
        logical :: jumps
        integer :: n

        n = size(velocity)
        status = friction_bad_size
        if (n < 2 .or. n > 3 .or. size(props) < first_own_prop .or. size(statev) < statev_size &
            .or. size(rates) < statev_size) return
        status = friction_bad_increment
        v = 0.0_wp
        v(1:n) = velocity
        if (.not. all_usable(3, v)) return
        status = friction_bad_property
        if (.not. all_usable(size(props), props)) return
        call choose_law(size(props), props, storage, surface, options, status)
        if (status < 0) return
        call unpack_state(surface, n, statev, point, status)
        if (status < 0) return
        call contact_rates(surface, contact_constants(normal=props(prop_alpha_n), &
            tangential=props(prop_alpha_t), damping=options%damping, plane=options%plane), v, &
            point, by_time, jumps)
        status = friction_no_rate
        if (jumps) return
        status = friction_ok
        rates(statev_status) = 0.0_wp
        rates(statev_u_n) = by_time%u_n
        rates(statev_u_et:statev_u_et + 1) = by_time%u_et
        rates(statev_mu) = by_time%inner%mu
        rates(statev_r) = by_time%inner%r
        rates(statev_slip) = by_time%slip
        rates(statev_dissipation) = by_time%dissipation
    end procedure friction_rates

    !> The update that hosts ask for most, by itself: the subloading law without options, in a
    !> contact that was closed and stays so. Nothing is chosen while it runs, so that a compiler
    !> inlines all of it (docs/performance_notes.md). Whatever is not plain, and every fault, is
    !> left to `advance`, which does the same for any law.
    pure subroutine advance_plainly(du, dt, sizes, props, statev, traction, tangent, done)
        real(wp), intent(in) :: du(3), dt
        type(array_sizes), intent(in) :: sizes
        real(wp), intent(in) :: props(sizes%nprops)
        real(wp), intent(inout) :: statev(sizes%nstatv)
        real(wp), intent(inout) :: traction(3), tangent(3, 3)
        logical, intent(out) :: done   !! false: nothing is touched
        type(subloading_law) :: surface
        type(contact_point) :: old, new
        type(law_state) :: start
        type(tangential_trial) :: trial
        type(tangential_answer) :: answer
        type(sliding) :: slid
        type(sliding_way) :: way
        real(wp) :: strength, load, pull(2)

        call read_plainly(sizes, du, dt, props, statev, surface, old, done)
        if (.not. done) return
        done = .false.
        new%u_n = old%u_n + du(1)
        trial%pressure = -props(prop_alpha_n) * new%u_n
        trial%stiffness = props(prop_alpha_t)
        trial%q(1) = old%u_et(1) + du(2)
        trial%q(2) = old%u_et(2) + du(3)
        trial%distance = sqrt(trial%q(1)**2 + trial%q(2)**2)
        load = trial%stiffness * trial%distance
        if (max(abs(new%u_n), trial%pressure, trial%distance, load) > largest &
            .or. trial%pressure <= least .or. trial%distance <= near_underflow) return
        start = old%inner
        call surface%rest(load, trial%pressure, dt, start, new%inner, strength)
        if (load <= strength * (1.0_wp + verge)) then
            call answer_of_stick(trial, old, new, answer)
        else
            call surface%solve(load, trial%stiffness, trial%pressure, dt, start, slid, done)
            if (.not. done) return
            way%stiffness = trial%stiffness
            call follow_trial(trial%q, 1.0_wp / trial%distance, slid%resistance, way)
            pull(1) = slid%d_slip * way%along(1)
            pull(2) = slid%d_slip * way%along(2)
            new%dissipation = min(old%dissipation + slid%resistance * slid%slip, largest)
            call answer_of_slip(trial%stiffness, slid, way, pull, slid%d_pressure, old, new, answer)
            answer%by_pressure = -props(prop_alpha_n) * answer%by_pressure
        end if
        call write_answer(props(prop_alpha_n), trial%pressure, answer, traction, tangent)
        call pack_state(new, statev)
        done = .true.
    end subroutine advance_plainly

    !> Law and state of such an update, once all its numbers are known to be plain. Conditions are
    !> put together: a compiler takes what comes after many returns for rare, and inlines nothing
    !> there.
    pure subroutine read_plainly(sizes, du, dt, props, statev, surface, point, plain)
        type(array_sizes), intent(in) :: sizes
        real(wp), intent(in) :: du(3), dt
        real(wp), intent(in) :: props(sizes%nprops), statev(sizes%nstatv)
        type(subloading_law), intent(inout) :: surface   !! out
        type(contact_point), intent(inout) :: point      !! out
        logical, intent(out) :: plain   !! false: the other two are undefined
        integer, parameter :: usual_size = 8     !! of `props`, without what has defaults
        integer, parameter :: first_choice = 10   !! how the law is to be taken, and options
        real(wp), parameter :: plain_law = law_subloading
        integer(int64) :: fits
        integer :: n_own, status

        plain = min(sizes%nprops, sizes%nstatv) >= usual_size
        if (plain) plain = same(props(prop_law), plain_law)
        if (plain .and. sizes%nprops >= first_choice) plain = &
            changes_nothing(sizes%nprops - first_choice + 1, props(first_choice:))
        if (.not. plain) return
        ! One by one: the caller has only just stored them one by one, and a processor that loads
        ! them in pairs has to wait.
        fits = iand(iand(excess(du(1)), excess(du(2))), iand(excess(du(3)), excess(dt)))
        plain = fits < 0 .and. all_usable(usual_size, props) .and. all_usable(statev_size, statev)
        if (plain .and. sizes%nprops > usual_size) plain = all_usable(sizes%nprops - usual_size, &
            props(usual_size + 1:))
        if (.not. plain) return

        call surface%read(min(sizes%nprops, first_choice - 1) - first_own_prop + 1, &
            props(first_own_prop:), n_own, status)
        surface%cohesion = 0.0_wp
        point%u_n = statev(statev_u_n)
        point%u_et(1) = statev(statev_u_et)
        point%u_et(2) = 0.0_wp
        if (sizes%ndir > 2) point%u_et(2) = statev(statev_u_et + 1)
        point%inner%mu = statev(statev_mu)
        point%inner%r = statev(statev_r)
        point%slip = statev(statev_slip)
        point%dissipation = statev(statev_dissipation)
        plain = status == friction_ok
        if (plain) plain = surface%admits(point%inner) &
            .and. props(prop_alpha_n) >= spring_constants(1)%lower &
            .and. props(prop_alpha_t) >= spring_constants(2)%lower &
            .and. (abs(statev(statev_status) - point_stick) <= 0.0_wp &
            .or. abs(statev(statev_status) - point_slip) <= 0.0_wp) .and. point%u_n <= 0.0_wp &
            .and. min(point%slip, point%dissipation, dt) >= 0.0_wp
    end subroutine read_plainly

    !> Choices and options that are there, but leave the subloading law as it is: all of them 0, a
    !> ratio of coefficients may be 1. By their bits, so that the question costs next to nothing
    !> where the answer is no.
    pure function changes_nothing(n, constants) result(plain)
        integer, intent(in) :: n               !! how many are given
        real(wp), intent(in) :: constants(n)   !! may be anything
        logical :: plain
        integer, parameter :: ratio = 4        !! place among them
        integer :: i

        plain = .false.
        do i = n, 1, -1   ! the last is the one that its user wants
            if (.not. (same(constants(i), 0.0_wp) .or. (i == ratio &
                .and. same(constants(i), 1.0_wp)))) return
        end do
        plain = .true.
    end function changes_nothing

    !> The same bits?
    pure function same(x, y)
        real(wp), intent(in) :: x, y
        logical :: same

        same = transfer(x, 0_int64) == transfer(y, 0_int64)
    end function same

    !> Validates the numbers, chooses the law, and updates.
    pure subroutine advance(motion, sizes, props, statev, traction, tangent, status)
        type(contact_motion), intent(in) :: motion
        type(array_sizes), intent(in) :: sizes
        real(wp), intent(in) :: props(sizes%nprops)
        real(wp), intent(inout) :: statev(sizes%nstatv)
        real(wp), intent(inout) :: traction(3), tangent(3, 3)
        integer, intent(out) :: status
        type(law_storage), target :: storage
        class(law), pointer :: chosen, surface
        type(surface_options) :: options
        type(contact_point) :: old, new

        status = friction_bad_size
        if (sizes%nprops < first_own_prop .or. sizes%nstatv < statev_size) return
        status = friction_bad_increment
        if (iand(iand(iand(excess(motion%du(1)), excess(motion%du(2))), iand(excess(motion%du(3)), &
            excess(motion%dt))), excess(motion%pressure)) >= 0) return
        if (motion%dt < 0.0_wp) return
        status = friction_bad_property
        if (.not. all_usable(sizes%nprops, props)) return
        call choose_law(sizes%nprops, props, storage, chosen, options, status)
        if (status < 0) return
        surface => chosen   ! part by part: a copy of the whole would wait as above
        call unpack_state(surface, sizes%ndir, statev, old, status)
        if (status < 0) return
        if (old%u_n < -motion%blur_start) storage%own%pressure_start = -props(prop_alpha_n) &
            * old%u_n
        if (motion%blur > 0.0_wp) storage%own%pressure_blur = props(prop_alpha_n) * motion%blur
        if (.not. motion%dt > 0.0_wp) then
            status = friction_zero_time_increment
            if (surface%needs_time() .and. sheared(options%cohesion, motion, old)) return
            if (options%damping > 0.0_wp .and. strained(options%cohesion, motion, old)) return
        end if
        call contact_update(surface, contact_constants(normal=props(prop_alpha_n), &
            tangential=props(prop_alpha_t), damping=options%damping, plane=options%plane), motion, &
            old, new, traction, tangent, status)
        if (status < 0) return
        call pack_state(new, statev)
    end subroutine advance

    !> The state of a point, which only an update under the same law can have written.
    pure subroutine unpack_state(surface, ndir, statev, point, status)
        class(law), intent(in) :: surface
        integer, intent(in) :: ndir              !! 2: the second tangential component is not used
        real(wp), intent(in) :: statev(statev_size)
        type(contact_point), intent(out) :: point
        integer, intent(out) :: status           !! ok or bad state

        status = friction_bad_state
        if (.not. all_usable(statev_size, statev)) return
        point%phase = int(min(max(statev(statev_status), -1.0_wp), 4.0_wp))
        if (abs(statev(statev_status) - point%phase) > 0.0_wp) return
        point%u_n = statev(statev_u_n)
        point%u_et(1) = statev(statev_u_et)
        point%u_et(2) = 0.0_wp
        if (ndir > 2) point%u_et(2) = statev(statev_u_et + 1)
        point%inner%mu = statev(statev_mu)
        point%inner%r = statev(statev_r)
        point%slip = statev(statev_slip)
        point%dissipation = statev(statev_dissipation)
        select case (point%phase)
        case (point_virgin)
            if (any(abs(statev) > 0.0_wp)) return
            point%inner = surface%virgin()
        case (point_stick, point_slip, point_open)
            if (point%slip < 0.0_wp .or. point%dissipation < 0.0_wp) return
            if (.not. surface%admits(point%inner)) return
        case default
            return
        end select
        status = friction_ok
    end subroutine unpack_state

    pure subroutine pack_state(point, statev)
        type(contact_point), intent(in) :: point
        real(wp), intent(inout) :: statev(statev_size)

        statev(statev_status) = point%phase
        statev(statev_u_n) = point%u_n
        statev(statev_u_et) = point%u_et(1)
        statev(statev_u_et + 1) = point%u_et(2)
        statev(statev_mu) = point%inner%mu
        statev(statev_r) = point%inner%r
        statev(statev_slip) = point%slip
        statev(statev_dissipation) = point%dissipation
    end subroutine pack_state

    ! The next three take the cohesion, not the law that it belongs to: with a polymorphic argument
    ! handed on from one to the other gfortran 12 at -O3, in the single files for Abaqus, where it
    ! sees all of them at once, leaves out the store of that argument's address (-fipa-modref takes
    ! it for unread; -fno-ipa-modref mends it), and an increment without time ends with a
    ! segmentation fault.

    !> Does the increment load a closed contact tangentially?
    pure function sheared(cohesion, motion, old)
        real(wp), intent(in) :: cohesion   !! [F/L^2]
        type(contact_motion), intent(in) :: motion
        type(contact_point), intent(in) :: old
        logical :: sheared

        sheared = sum(abs(old%u_et + motion%du(2:3))) > motion%blur .and. closed_after(cohesion, &
            motion, old)
    end function sheared

    !> Is a closed contact loaded tangentially on the way?
    pure function strained(cohesion, motion, old)
        real(wp), intent(in) :: cohesion   !! [F/L^2]
        type(contact_motion), intent(in) :: motion
        type(contact_point), intent(in) :: old
        logical :: strained

        strained = sum(abs(old%u_et)) + sum(abs(motion%du(2:3))) > motion%blur &
            .and. closed_after(cohesion, motion, old)
    end function strained

    !> Is the contact closed at the end of the increment?
    pure function closed_after(cohesion, motion, old) result(closed)
        real(wp), intent(in) :: cohesion   !! [F/L^2]
        type(contact_motion), intent(in) :: motion
        type(contact_point), intent(in) :: old
        logical :: closed
        real(wp) :: u_n

        u_n = old%u_n + motion%du(1)
        if (motion%pressure_given) u_n = -motion%pressure   ! its sign is what counts
        closed = u_n < 0.0_wp .or. touches(cohesion, motion%blur, u_n)
    end function closed_after

    pure module function are_usable(x) result(usable)
        real(wp), intent(in) :: x(:)
        logical :: usable

        usable = all_usable(size(x), x)
    end function are_usable

    !> Is every number finite and below 2**333 (1.7e100) in magnitude, so that products of three
    !> cannot overflow?
    pure function all_usable(n, x) result(usable)
        integer, intent(in) :: n        !! how many numbers
        real(wp), intent(in) :: x(n)
        logical :: usable
        integer(int64) :: seen
        integer :: i

        seen = -1
        do i = 1, n
            seen = iand(seen, excess(x(i)))
        end do
        usable = seen < 0
    end function all_usable

    !> A number that is negative unless another one is too large, infinite or NaN.
    !>
    !> Takes its bits, without the sign, for an integer: silent where NaN raises a floating-point
    !> exception, and right even where the compiler was told that there are no NaNs.
    pure function excess(x) result(difference)
        real(wp), intent(in) :: x
        integer(int64) :: difference
        integer(int64), parameter :: too_large = shiftl(1023_int64 + 333, 52)   !! 2**333

        difference = iand(transfer(x, difference), huge(difference)) - too_large
    end function excess

end submodule friction_advance
