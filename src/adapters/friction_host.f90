!> What several adapters need between a host and `friction_mod`. No physics.
module friction_host
    use, intrinsic :: iso_fortran_env, only : int64
    use friction_contact, only : point_open
    use friction_kinds, only : wp
    use friction_mod, only : array_sizes, broken_rule, constant_table, friction_bad_increment, &
        friction_check, friction_constants, friction_law_of, friction_message, &
        friction_no_convergence, friction_ok, friction_snap_back, friction_tangential, &
        friction_zero_time_increment, prop_alpha_n, prop_alpha_t, statev_size, statev_status, &
        statev_u_et, statev_u_n, text_length, update_arrays
    implicit none
    private

    public :: append, append_number, cut_factor, elastic_energy, error_text, forget_elastic, &
        hold_touching, hold_without_pressure, host_tangential, host_update, interface_update, &
        rotate_tangential, severity, usable, used_length

    integer, parameter, public :: error_length = 500   !! what Abaqus wants

    public :: stdb_abqerr, xplb_abqerr

    !> Too short for anything to happen in it [T].
    real(wp), parameter :: instant = 1.0e-200_wp

    interface
        !> Abaqus/Standard's utility for messages; lop = -3 ends the job.
        subroutine stdb_abqerr(lop, text, intv, realv, charv)
            import :: wp
            implicit none
            integer, intent(in) :: lop              !! kind of the message
            character(len=500), intent(in) :: text  !! the message
            integer, intent(in) :: intv(*)          !! numbers and words that the text may quote
            real(wp), intent(in) :: realv(*)
            character(len=8), intent(in) :: charv(*)
        end subroutine stdb_abqerr

        !> The same of Abaqus/Explicit.
        subroutine xplb_abqerr(lop, text, intv, realv, charv)
            import :: wp
            implicit none
            integer, intent(in) :: lop              !! kind of the message
            character(len=500), intent(in) :: text  !! the message
            integer, intent(in) :: intv(*)          !! numbers and words that the text may quote
            real(wp), intent(in) :: realv(*)
            character(len=8), intent(in) :: charv(*)
        end subroutine xplb_abqerr
    end interface

contains

    !> `friction_update`, also for a host that asks for the forces as they stand, with neither time
    !> nor motion. Laws of the slip rate and dampers cannot do without time; an instant leaves all
    !> as it is, and the contact is elastic (a damper would be next to rigid in it). Sizes are
    !> explicit: what has none is copied in and out.
    pure subroutine host_update(ndir, du, dtime, nprops, props, statev, traction, tangent, status)
        integer, intent(in) :: ndir                     !! 2 or 3
        real(wp), intent(in) :: du(ndir)           !! as in `friction_update`, and so on [L]
        real(wp), intent(in) :: dtime              !! [T]
        integer, intent(in) :: nprops
        real(wp), intent(in) :: props(nprops)
        real(wp), intent(inout) :: statev(statev_size)
        real(wp), intent(inout) :: traction(ndir)       !! [F/L^2]
        real(wp), intent(inout) :: tangent(ndir, ndir)  !! [F/L^3]
        integer, intent(out) :: status

        call update_arrays(array_sizes(1, ndir, nprops, statev_size), du, dtime, props, statev, &
            traction, tangent, status)
        if (status /= friction_zero_time_increment) return   ! what is no number is not compared
        if (any(abs(du) > 0.0_wp)) return
        call update_arrays(array_sizes(1, ndir, nprops, statev_size), du, instant, props, statev, &
            traction, tangent, status)
        if (status < 0) return
        status = friction_ok   ! where nothing moves, no other equilibrium is within reach
        call put_springs(ndir, props, tangent)
    end subroutine host_update

    !> The same of `friction_tangential`.
    pure subroutine host_tangential(du, pressure, dtime, props, statev, tau, by_du, by_p, status)
        real(wp), intent(in), contiguous :: du(:)   !! as in `friction_tangential`, and so on [L]
        real(wp), intent(in) :: pressure         !! [F/L^2]
        real(wp), intent(in) :: dtime            !! [T]
        real(wp), intent(in), contiguous :: props(:)
        real(wp), intent(inout), contiguous :: statev(:)
        real(wp), intent(inout), contiguous :: tau(:)        !! [F/L^2]
        real(wp), intent(inout), contiguous :: by_du(:, :)   !! [F/L^3]
        real(wp), intent(inout), contiguous :: by_p(:)       !! [-]
        integer, intent(out) :: status

        call friction_tangential(du, pressure, dtime, props, statev, tau, by_du, by_p, status)
        if (status /= friction_zero_time_increment) return   ! what is no number is not compared
        if (any(abs(du) > 0.0_wp)) return
        call friction_tangential(du, pressure, instant, props, statev, tau, by_du, by_p, status)
        if (status < 0) return
        status = friction_ok   ! as above
        by_p = 0.0_wp
        call put_shear_springs(props, by_du)
    end subroutine host_tangential

    !> What `hold_touching` does, where the host has a normal contact of its own: closed, with no
    !> pressure yet.
    pure subroutine hold_without_pressure(du, pressure, props, statev, by_du)
        real(wp), intent(in), contiguous :: du(:)   !! as in `host_tangential`, after which it is
                                                    !! called, and so on
        real(wp), intent(in) :: pressure
        real(wp), intent(in), contiguous :: props(:)
        real(wp), intent(in) :: statev(statev_size)          !! at the end of the increment
        real(wp), intent(inout), contiguous :: by_du(:, :)

        if (nint(statev(statev_status)) == point_open .and. all(abs(du) <= 0.0_wp) &
            .and. abs(pressure) <= 0.0_wp) call put_shear_springs(props, by_du)
    end subroutine hold_without_pressure

    pure subroutine put_shear_springs(props, by_du)
        real(wp), intent(in), contiguous :: props(:)         !! constants of the friction routine
        real(wp), intent(inout), contiguous :: by_du(:, :)   !! out [F/L^3]
        integer :: i

        by_du = 0.0_wp
        do i = 1, size(by_du, 1)
            by_du(i, i) = props(prop_alpha_t)
        end do
    end subroutine put_shear_springs

    !> The contact may be all that holds a body. Where two just touch, and nothing moves yet, the
    !> stiffness is that of the springs: with that of a gap, which is none, a host could not press
    !> them by a force.
    pure subroutine hold_touching(ndir, du, reach, props, statev, tangent)
        integer, intent(in) :: ndir                       !! as in `host_update`, after which it is
                                                          !! called, and so on
        real(wp), intent(in) :: du(ndir)   !! beside nothing, anything
        real(wp), intent(in) :: reach      !! the widest gap that is none, or 0 [L]
        real(wp), intent(in) :: props(prop_alpha_t)
        real(wp), intent(in) :: statev(statev_size)       !! at the end of the increment
        real(wp), intent(inout) :: tangent(ndir, ndir)

        if (nint(statev(statev_status)) /= point_open .or. statev(statev_u_n) > reach) return
        if (all(abs(du) <= 0.0_wp)) call put_springs(ndir, props, tangent)
    end subroutine hold_touching

    pure subroutine put_springs(ndir, props, tangent)
        integer, intent(in) :: ndir
        real(wp), intent(in) :: props(prop_alpha_t)       !! constants of the friction routine
        real(wp), intent(inout) :: tangent(ndir, ndir)    !! out [F/L^3]
        integer :: i

        tangent = 0.0_wp
        tangent(1, 1) = props(prop_alpha_n)
        do i = 2, ndir
            tangent(i, i) = props(prop_alpha_t)
        end do
    end subroutine put_springs

    !> Turns the elastic tangential displacement with the host's surface axes: u <- DROT u. What is
    !> no number in the state stays, for the update to refuse.
    pure subroutine rotate_tangential(drot, statev, status)
        real(wp), intent(in) :: drot(2, 2)       !! rotation of the axes in this increment [-]
        real(wp), intent(inout) :: statev(statev_size)   !! state at the start of the increment
        integer, intent(out) :: status                   !! ok, or bad increment
        real(wp) :: u(2)

        status = friction_bad_increment
        if (.not. all(usable(drot))) return
        status = friction_ok
        u(1) = statev(statev_u_et)
        u(2) = statev(statev_u_et + 1)
        if (.not. all(usable(u))) return
        statev(statev_u_et) = drot(1, 1) * u(1) + drot(1, 2) * u(2)
        statev(statev_u_et + 1) = drot(2, 1) * u(1) + drot(2, 2) * u(2)
    end subroutine rotate_tangential

    !> The contact was open since the last call: what was stored elastically is gone. How the law
    !> takes that is its own affair.
    pure subroutine forget_elastic(props, statev, status)
        real(wp), intent(in), contiguous :: props(:)       !! constants of the friction routine
        real(wp), intent(inout), contiguous :: statev(:)   !! state at the start of the increment
        integer, intent(out) :: status                     !! of the friction routine
        real(wp) :: tau(2), by_du(2, 2), by_p(2)

        call friction_tangential([0.0_wp, 0.0_wp], -1.0_wp, 0.0_wp, props, statev, tau, by_du, &
            by_p, status)
    end subroutine forget_elastic

    !> One point of an interface whose host counts compression and penetration positive (Abaqus).
    !>
    !> Such a host knows the gap; the state variables follow it, so that an initial gap or
    !> overclosure, and what the host corrects on its own, arrive here.
    pure subroutine interface_update(ndir, position, increment, dtime, props, statev, stress, &
        stiffness, status)
        integer, intent(in) :: ndir                 !! components, 2 or 3
        real(wp), intent(in) :: position(ndir)      !! at the end: penetration, tangential [L]
        real(wp), intent(in) :: increment(ndir)     !! of the position [L]
        real(wp), intent(in) :: dtime               !! [T]
        real(wp), intent(in), contiguous :: props(:)        !! constants of the friction routine
        real(wp), intent(inout) :: statev(statev_size)      !! state of the friction routine
        real(wp), intent(inout) :: stress(ndir)             !! pressure, tangential traction [F/L^2]
        real(wp), intent(inout) :: stiffness(ndir, ndir)    !! d(stress)/d(position) [F/L^3]
        integer, intent(out) :: status              !! of the friction routine
        real(wp), parameter :: no_master = 1.0e30_wp   !! a gap as wide as this is to nothing
        real(wp) :: du(3), u_n
        integer :: i
        logical :: beside_nothing

        status = friction_bad_increment
        if (.not. usable(position(1))) return
        beside_nothing = -position(1) > no_master
        if (.not. (beside_nothing .or. all(usable(position) .and. usable(increment)))) return
        u_n = -(position(1) - increment(1))
        du(1) = -increment(1)
        do i = 2, ndir
            du(i) = increment(i)
        end do
        if (beside_nothing) then   ! open, whatever the rest says
            u_n = no_master
            du = 0.0_wp
        else if (u_n > no_master) then       ! just found: take it as touching at the end
            u_n = 0.0_wp
            du = 0.0_wp
            du(1) = -position(1)
        end if
        call place_point(u_n, props, statev, status)
        if (status < 0) return
        call host_update(ndir, du, dtime, size(props), props, statev, stress, stiffness, status)
        if (status < 0) return
        stress(1) = -stress(1)
        do i = 2, ndir
            stiffness(i, 1) = -stiffness(i, 1)
        end do
    end subroutine interface_update

    !> Puts a point where it starts the increment.
    pure subroutine place_point(u_n, props, statev, status)
        real(wp), intent(in) :: u_n            !! normal displacement at the start, > 0 open [L]
        real(wp), intent(in), contiguous :: props(:)     !! constants of the friction routine
        real(wp), intent(inout) :: statev(statev_size)   !! state at the start of the increment
        integer, intent(out) :: status         !! of the friction routine
        real(wp) :: traction(2), tangent(2, 2)
        logical :: virgin

        status = friction_ok
        virgin = usable(statev(statev_status))   ! the update refuses what is no number
        if (virgin) virgin = .not. abs(statev(statev_status)) > 0.0_wp
        if (virgin) then
            call host_update(2, [u_n, 0.0_wp], 0.0_wp, size(props), props, statev, traction, &
                tangent, status)
        else
            statev(statev_u_n) = u_n
        end if
    end subroutine place_point

    !> Is a number finite and below 2**333, as the routine's own have to be? Read from the bits of
    !> its exponent, so that a NaN raises no exception in the host.
    elemental function usable(x)
        real(wp), intent(in) :: x
        logical :: usable
        integer(int64), parameter :: exponent_bits = 2047, too_large = 1023 + 333

        usable = iand(shiftr(transfer(x, exponent_bits), 52), exponent_bits) < too_large
    end function usable

    !> Elastic energy per area held by the contact springs.
    pure function elastic_energy(props, u_n, u_et1, u_et2) result(energy)
        real(wp), intent(in) :: props(prop_alpha_t)   !! constants of the friction routine
        real(wp), intent(in) :: u_n  !! normal displacement; 0 where the host has its own spring [L]
        real(wp), intent(in) :: u_et1, u_et2       !! elastic tangential displacement [L]
        real(wp) :: energy                 !! [F/L]

        energy = 0.5_wp * (props(prop_alpha_n) * min(u_n, 0.0_wp)**2 &
            + props(prop_alpha_t) * (u_et1**2 + u_et2**2))
    end function elastic_energy

    !> The factor on the time increment that a status asks for: below 1 where the host should cut.
    !> An increment out of range is what iterations that diverged leave.
    pure function cut_factor(status) result(factor)
        integer, intent(in) :: status   !! of the friction routine
        real(wp) :: factor

        factor = 1.0_wp
        if (status == friction_snap_back) factor = 0.5_wp
        if (any(status == [friction_no_convergence, friction_bad_increment])) factor = 0.25_wp
    end function cut_factor

    !> The kind of Abaqus's message for an error: a warning where a shorter step may help, else -3,
    !> which ends the job.
    pure function severity(status)
        integer, intent(in) :: status   !! of the friction routine, below 0
        integer :: severity

        severity = merge(-1, -3, cut_factor(status) < 1.0_wp)
    end function severity

    !> What to tell the user of a host about an error. Of constants all that break a rule, as far as
    !> there is room.
    pure function error_text(adapter, status, props) result(text)
        character(len=*), intent(in) :: adapter    !! name of the adapter
        integer, intent(in) :: status              !! of the friction routine
        real(wp), intent(in), contiguous :: props(:)   !! constants of the friction routine
        character(len=error_length) :: text
        integer :: length

        length = 0
        call append(text, length, 'stickslip, ')
        call append(text, length, adapter)
        call append(text, length, ', code ')
        call append_number(text, length, status)
        call append(text, length, ': ')
        call append(text, length, friction_message(status))
        call append_faults(text, length, props)
    end function error_text

    !> Writes which constants break which rules; of those with numbers that are none, that alone.
    pure subroutine append_faults(text, length, props)
        character(len=error_length), intent(inout) :: text
        integer, intent(inout) :: length
        real(wp), intent(in), contiguous :: props(:)
        integer, parameter :: room = error_length - 100   ! the rest is the host's
        type(constant_table) :: table
        character(len=text_length) :: cause
        real(wp) :: full(size(table%of))
        integer :: place, i, status, n

        call friction_check(props, place, cause, status)
        if (status >= 0) return
        call append(text, length, ': ')
        call append(text, length, cause(:used_length(cause)))
        if (place == 0 .or. .not. all(usable(props))) return
        table = friction_constants(friction_law_of(props))
        n = min(table%n, size(props))
        full = 0.0_wp   ! what is left out
        full(:n) = props(:n)
        do i = place + 1, n
            cause = broken_rule(table, i, full)
            if (used_length(cause) == 0) cycle
            if (length + text_length > room) return
            call append(text, length, ', ')
            call append(text, length, table%of(i)%name(:used_length(table%of(i)%name)))
            call append(text, length, ' ')
            call append(text, length, cause(:used_length(cause)))
        end do
    end subroutine append_faults

    !> Writes behind the first `length` characters and blanks all that follows. Fortran's own ways
    !> to put texts together need a run-time library that a host may not have.
    pure subroutine append(text, length, part)
        character(len=error_length), intent(inout) :: text
        integer, intent(inout) :: length         !! characters written so far
        character(len=*), intent(in) :: part

        text(length + 1:) = part
        length = min(length + len(part), len(text))
    end subroutine append

    !> Characters of a text without trailing blanks.
    pure function used_length(text) result(length)
        character(len=*), intent(in) :: text
        integer :: length

        length = len(text)
        do while (length > 0)
            if (iachar(text(length:length)) /= iachar(' ')) exit   ! what is no call of a library
            length = length - 1
        end do
    end function used_length

    !> As `append`, a whole number.
    pure subroutine append_number(text, length, number)
        character(len=error_length), intent(inout) :: text
        integer, intent(inout) :: length
        integer, intent(in) :: number
        character(len=20) :: digits
        integer :: rest, first

        rest = abs(number)
        first = len(digits) + 1
        do
            first = first - 1
            digits(first:first) = achar(iachar('0') + modulo(rest, 10))
            rest = rest / 10
            if (rest == 0) exit
        end do
        if (number < 0) call append(text, length, '-')
        call append(text, length, digits(first:))
    end subroutine append_number

end module friction_host
