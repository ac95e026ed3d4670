!> C interface: the functions of include/friction.h that take one point. Apart from the others, so
!> that a compiler can inline an update into them (src/CMakeLists.txt).
module friction_c_point
    use, intrinsic :: iso_c_binding, only : c_associated, c_double, c_f_pointer, c_int, c_ptr
    use friction_mod, only : array_sizes, friction_bad_size, friction_null_pointer, &
        friction_rates, friction_tangential, statev_size, update_arrays
    implicit none
    private

    public :: c_rates, c_tangential, c_update

contains

    !> `friction_update` of include/friction.h.
    function c_update(ndir, du, dtime, nprops, props, nstatv, statev, traction, tangent) &
        result(status) bind(C, name='friction_update')
        integer(c_int), value, intent(in) :: ndir      !! components of du: 2 or 3
        type(c_ptr), value, intent(in) :: du           !! ndir numbers [L]
        real(c_double), value, intent(in) :: dtime     !! [T]
        integer(c_int), value, intent(in) :: nprops    !! number of material constants
        type(c_ptr), value, intent(in) :: props        !! nprops numbers
        integer(c_int), value, intent(in) :: nstatv    !! number of state variables
        type(c_ptr), value, intent(in) :: statev       !! nstatv numbers, in and out
        type(c_ptr), value, intent(in) :: traction     !! ndir numbers, out [F/L^2]
        type(c_ptr), value, intent(in) :: tangent  !! ndir x ndir numbers, column-major, out [F/L^3]
        integer(c_int) :: status
        real(c_double), pointer, contiguous :: du_(:), props_(:), statev_(:), traction_(:), &
            tangent_(:, :)

        status = friction_bad_size
        if (min(ndir, nprops, nstatv) < 0) return
        status = friction_null_pointer
        if (.not. (c_associated(du) .and. c_associated(props) .and. c_associated(statev) &
            .and. c_associated(traction) .and. c_associated(tangent))) return
        call c_f_pointer(du, du_, [ndir])
        call c_f_pointer(props, props_, [nprops])
        call c_f_pointer(statev, statev_, [nstatv])
        call c_f_pointer(traction, traction_, [ndir])
        call c_f_pointer(tangent, tangent_, [ndir, ndir])
        call update_arrays(array_sizes(1, ndir, nprops, nstatv), du_, dtime, props_, statev_, &
            traction_, tangent_, status)
    end function c_update

    !> `friction_tangential` of include/friction.h.
    function c_tangential(ndir, du, pressure, dtime, nprops, props, nstatv, statev, tau, dtau_ddu, &
        dtau_dp) result(status) bind(C, name='friction_tangential')
        integer(c_int), value, intent(in) :: ndir      !! tangential components: 1 or 2
        type(c_ptr), value, intent(in) :: du           !! ndir numbers [L]
        real(c_double), value, intent(in) :: pressure  !! at the end of the increment [F/L^2]
        real(c_double), value, intent(in) :: dtime     !! [T]
        integer(c_int), value, intent(in) :: nprops    !! number of material constants
        type(c_ptr), value, intent(in) :: props        !! nprops numbers
        integer(c_int), value, intent(in) :: nstatv    !! number of state variables
        type(c_ptr), value, intent(in) :: statev       !! nstatv numbers, in and out
        type(c_ptr), value, intent(in) :: tau          !! ndir numbers, out [F/L^2]
        type(c_ptr), value, intent(in) :: dtau_ddu   !! ndir x ndir numbers, column-major, out
                                                     !! [F/L^3]
        type(c_ptr), value, intent(in) :: dtau_dp      !! ndir numbers, out [-]
        integer(c_int) :: status
        real(c_double), pointer, contiguous :: du_(:), props_(:), statev_(:), tau_(:), &
            dtau_ddu_(:, :), dtau_dp_(:)

        status = friction_bad_size
        if (min(ndir, nprops, nstatv) < 0) return
        status = friction_null_pointer
        if (.not. (c_associated(du) .and. c_associated(props) .and. c_associated(statev) &
            .and. c_associated(tau) .and. c_associated(dtau_ddu) &
            .and. c_associated(dtau_dp))) return
        call c_f_pointer(du, du_, [ndir])
        call c_f_pointer(props, props_, [nprops])
        call c_f_pointer(statev, statev_, [nstatv])
        call c_f_pointer(tau, tau_, [ndir])
        call c_f_pointer(dtau_ddu, dtau_ddu_, [ndir, ndir])
        call c_f_pointer(dtau_dp, dtau_dp_, [ndir])
        call friction_tangential(du_, pressure, dtime, props_, statev_, tau_, dtau_ddu_, dtau_dp_, &
            status)
    end function c_tangential

    !> `friction_rates` of include/friction.h.
    function c_rates(ndir, velocity, nprops, props, nstatv, statev, rates) result(status) &
        bind(C, name='friction_rates')
        integer(c_int), value, intent(in) :: ndir      !! components of velocity: 2 or 3
        type(c_ptr), value, intent(in) :: velocity     !! ndir numbers [L/T]
        integer(c_int), value, intent(in) :: nprops    !! number of material constants
        type(c_ptr), value, intent(in) :: props        !! nprops numbers
        integer(c_int), value, intent(in) :: nstatv    !! number of state variables
        type(c_ptr), value, intent(in) :: statev       !! nstatv numbers
        type(c_ptr), value, intent(in) :: rates        !! statev_size numbers, out
        integer(c_int) :: status
        real(c_double), pointer, contiguous :: velocity_(:), props_(:), statev_(:), rates_(:)

        status = friction_bad_size
        if (min(ndir, nprops, nstatv) < 0) return
        status = friction_null_pointer
        if (.not. (c_associated(velocity) .and. c_associated(props) .and. c_associated(statev) &
            .and. c_associated(rates))) return
        call c_f_pointer(velocity, velocity_, [ndir])
        call c_f_pointer(props, props_, [nprops])
        call c_f_pointer(statev, statev_, [nstatv])
        call c_f_pointer(rates, rates_, [statev_size])
        call friction_rates(velocity_, props_, statev_, rates_, status)
    end function c_rates

end module friction_c_point
