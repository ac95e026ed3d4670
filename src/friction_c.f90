!> C interface: the functions of include/friction.h over `friction_mod`, but for those that take one
!> point (module friction_c_point). Pointers are checked and shaped here, and nothing else.
module friction_c
    use, intrinsic :: iso_c_binding, only : c_associated, c_char, c_double, c_f_pointer, c_int, &
        c_int64_t, c_loc, c_null_char, c_ptr
    use friction_mod, only : array_sizes, friction_bad_size, friction_null_pointer, friction_ok, &
        friction_version, slip_rates_of_arrays, update_arrays_batch, update_arrays_points
    use friction_status, only : first_message, last_message, message_length, message_place, messages
    implicit none
    private

    public :: c_message, c_slip_rates, c_update_batch, c_update_batch_props, c_update_points, &
        c_version

    ! C is handed the address of a text, so the constants need a place in memory. Nothing ever
    ! writes to them.
    character(len=message_length, kind=c_char), target :: &
        c_messages(first_message:last_message) = messages
    character(len=len(friction_version) + 1, kind=c_char), target :: &
        c_version_text = friction_version // c_null_char

    !> Arrays of a batch, from C.
    type :: batch_pointers
        type(c_ptr) :: du, props, statev, traction, tangent, point_status
    end type batch_pointers

contains

    !> `friction_update_batch` of include/friction.h. The function's value is the worst status of
    !> all points.
    function c_update_batch(n, ndir, du, dtime, nprops, props, nstatv, statev, traction, tangent, &
        point_status) result(status) bind(C, name='friction_update_batch')
        integer(c_int64_t), value, intent(in) :: n     !! points
        integer(c_int), value, intent(in) :: ndir      !! components of du: 2 or 3
        type(c_ptr), value, intent(in) :: du           !! n x ndir numbers, points first [L]
        real(c_double), value, intent(in) :: dtime     !! [T]
        integer(c_int), value, intent(in) :: nprops    !! number of material constants
        type(c_ptr), value, intent(in) :: props        !! nprops numbers
        integer(c_int), value, intent(in) :: nstatv    !! number of state variables
        type(c_ptr), value, intent(in) :: statev       !! n x nstatv numbers, in and out
        type(c_ptr), value, intent(in) :: traction     !! n x ndir numbers, out [F/L^2]
        type(c_ptr), value, intent(in) :: tangent      !! n x ndir x ndir numbers, out [F/L^3]
        type(c_ptr), value, intent(in) :: point_status   !! n numbers, out
        integer(c_int) :: status

        status = friction_bad_size
        if (n < 0 .or. min(ndir, nprops, nstatv) < 0) return
        call update_rows(array_sizes(n, ndir, nprops, nstatv), 1_c_int64_t, &
            batch_pointers(du, props, statev, traction, tangent, point_status), dtime, status)
    end function c_update_batch

    !> `friction_update_batch_props` of include/friction.h. The function's value is the worst
    !> status of
    !> all points.
    function c_update_batch_props(n, ndir, du, dtime, nprops, props, nstatv, statev, traction, &
        tangent, &
        point_status) result(status) bind(C, name='friction_update_batch_props')
        integer(c_int64_t), value, intent(in) :: n     !! points
        integer(c_int), value, intent(in) :: ndir      !! components of du: 2 or 3
        type(c_ptr), value, intent(in) :: du           !! n x ndir numbers, points first [L]
        real(c_double), value, intent(in) :: dtime     !! [T]
        integer(c_int), value, intent(in) :: nprops    !! number of material constants
        type(c_ptr), value, intent(in) :: props        !! n x nprops numbers, points first
        integer(c_int), value, intent(in) :: nstatv    !! number of state variables
        type(c_ptr), value, intent(in) :: statev       !! n x nstatv numbers, in and out
        type(c_ptr), value, intent(in) :: traction     !! n x ndir numbers, out [F/L^2]
        type(c_ptr), value, intent(in) :: tangent      !! n x ndir x ndir numbers, out [F/L^3]
        type(c_ptr), value, intent(in) :: point_status   !! n numbers, out
        integer(c_int) :: status

        status = friction_bad_size
        if (n < 0 .or. min(ndir, nprops, nstatv) < 0) return
        call update_rows(array_sizes(n, ndir, nprops, nstatv), n, &
            batch_pointers(du, props, statev, traction, tangent, point_status), dtime, status)
    end function c_update_batch_props

    !> A batch of points that share their constants (`rows` = 1) or have their own (`rows` =
    !> points).
    subroutine update_rows(sizes, rows, at, dtime, status)
        type(array_sizes), intent(in) :: sizes       !! none negative
        integer(c_int64_t), intent(in) :: rows
        type(batch_pointers), intent(in) :: at
        real(c_double), intent(in) :: dtime
        integer(c_int), intent(inout) :: status      !! in: bad size
        real(c_double), pointer, contiguous :: du(:), props(:), statev(:), traction(:), tangent(:)
        integer(c_int), pointer, contiguous :: point_status(:)

        status = friction_null_pointer
        if (.not. (c_associated(at%du) .and. c_associated(at%props) .and. c_associated(at%statev) &
            .and. c_associated(at%traction) .and. c_associated(at%tangent) &
            .and. c_associated(at%point_status))) return
        call c_f_pointer(at%du, du, [sizes%points * sizes%ndir])
        call c_f_pointer(at%props, props, [rows * sizes%nprops])
        call c_f_pointer(at%statev, statev, [sizes%points * sizes%nstatv])
        call c_f_pointer(at%traction, traction, [sizes%points * sizes%ndir])
        call c_f_pointer(at%tangent, tangent, [sizes%points * sizes%ndir**2])
        call c_f_pointer(at%point_status, point_status, [sizes%points])
        call update_arrays_batch(sizes, du, dtime, rows, props, statev, traction, tangent, &
            point_status)
        status = worst(point_status)
    end subroutine update_rows

    !> `friction_update_points` of include/friction.h. The function's value is the worst status of
    !> all points.
    function c_update_points(n, ndir, du, dtime, nprops, props, nstatv, statev, traction, tangent, &
        point_status) result(status) bind(C, name='friction_update_points')
        integer(c_int64_t), value, intent(in) :: n     !! points
        integer(c_int), value, intent(in) :: ndir      !! components of du: 2 or 3
        type(c_ptr), value, intent(in) :: du           !! ndir numbers a point [L]
        real(c_double), value, intent(in) :: dtime     !! [T]
        integer(c_int), value, intent(in) :: nprops    !! number of material constants
        type(c_ptr), value, intent(in) :: props        !! nprops numbers
        integer(c_int), value, intent(in) :: nstatv    !! number of state variables
        type(c_ptr), value, intent(in) :: statev       !! nstatv numbers a point, in and out
        type(c_ptr), value, intent(in) :: traction     !! ndir numbers a point, out [F/L^2]
        type(c_ptr), value, intent(in) :: tangent   !! ndir x ndir numbers a point, row after row,
                                                    !! out [F/L^3]
        type(c_ptr), value, intent(in) :: point_status   !! n numbers, out
        integer(c_int) :: status
        real(c_double), pointer, contiguous :: du_(:), props_(:), statev_(:), traction_(:), &
            tangent_(:)
        integer(c_int), pointer, contiguous :: point_status_(:)

        status = friction_bad_size
        if (n < 0 .or. min(ndir, nprops, nstatv) < 0) return
        status = friction_null_pointer
        if (.not. (c_associated(du) .and. c_associated(props) .and. c_associated(statev) &
            .and. c_associated(traction) .and. c_associated(tangent) &
            .and. c_associated(point_status))) return
        call c_f_pointer(du, du_, [n * ndir])
        call c_f_pointer(props, props_, [nprops])
        call c_f_pointer(statev, statev_, [n * nstatv])
        call c_f_pointer(traction, traction_, [n * ndir])
        call c_f_pointer(tangent, tangent_, [n * ndir * ndir])
        call c_f_pointer(point_status, point_status_, [n])
        call update_arrays_points(array_sizes(n, ndir, nprops, nstatv), du_, dtime, props_, &
            statev_, traction_, tangent_, point_status_)
        status = worst(point_status_)
    end function c_update_points

    !> `friction_slip_rates` of include/friction.h. The function's value is the worst status of all
    !> points.
    function c_slip_rates(n, tau, pressure, damping, nprops, props, internal, rate, internal_rate, &
        point_status) result(status) bind(C, name='friction_slip_rates')
        integer(c_int64_t), value, intent(in) :: n      !! points
        type(c_ptr), value, intent(in) :: tau           !! n numbers [F/L^2]
        type(c_ptr), value, intent(in) :: pressure      !! n numbers [F/L^2]
        real(c_double), value, intent(in) :: damping    !! [F T/L^3]
        integer(c_int), value, intent(in) :: nprops     !! material constants of a point
        type(c_ptr), value, intent(in) :: props         !! n x nprops numbers, points first
        type(c_ptr), value, intent(in) :: internal      !! n numbers [T]
        type(c_ptr), value, intent(in) :: rate          !! n numbers, out [L/T]
        type(c_ptr), value, intent(in) :: internal_rate   !! n numbers, out [-]
        type(c_ptr), value, intent(in) :: point_status    !! n numbers, out
        integer(c_int) :: status
        real(c_double), pointer, contiguous :: tau_(:), pressure_(:), props_(:), internal_(:), &
            rate_(:), internal_rate_(:)
        integer(c_int), pointer, contiguous :: point_status_(:)

        status = friction_bad_size
        if (n < 0 .or. nprops < 0) return
        status = friction_null_pointer
        if (.not. (c_associated(tau) .and. c_associated(pressure) .and. c_associated(props) &
            .and. c_associated(internal) .and. c_associated(rate) &
            .and. c_associated(internal_rate) .and. c_associated(point_status))) return
        call c_f_pointer(tau, tau_, [n])
        call c_f_pointer(pressure, pressure_, [n])
        call c_f_pointer(props, props_, [n * nprops])
        call c_f_pointer(internal, internal_, [n])
        call c_f_pointer(rate, rate_, [n])
        call c_f_pointer(internal_rate, internal_rate_, [n])
        call c_f_pointer(point_status, point_status_, [n])
        call slip_rates_of_arrays(n, tau_, pressure_, damping, nprops, props_, internal_, rate_, &
            internal_rate_, point_status_)
        status = worst(point_status_)
    end function c_slip_rates

    !> The lowest negative status, else the highest.
    pure function worst(point_status) result(status)
        integer(c_int), intent(in) :: point_status(:)
        integer(c_int) :: status

        status = friction_ok
        if (iany(point_status) == 0) return
        status = minval(point_status)
        if (status == friction_ok) status = maxval(point_status)
    end function worst

    !> `friction_message` of include/friction.h.
    function c_message(status) result(text) bind(C, name='friction_message')
        integer(c_int), value, intent(in) :: status
        type(c_ptr) :: text

        text = c_loc(c_messages(message_place(int(status))))
    end function c_message

    !> `friction_version` of include/friction.h.
    function c_version() result(text) bind(C, name='friction_version')
        type(c_ptr) :: text

        text = c_loc(c_version_text)
    end function c_version

end module friction_c
