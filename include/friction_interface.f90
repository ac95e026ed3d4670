!> The functions of friction.h for Fortran, for whatever compiler: compile this file with your own,
!> and link libstickslip. The modules of the library itself (`use friction_mod`) can be read by the
!> compiler that made them alone.
!>
!> Every function is a function of its arguments alone. friction.h says what they mean.
module friction_interface
    use, intrinsic :: iso_c_binding, only : c_char, c_double, c_f_pointer, c_int, c_int64_t, c_ptr
    implicit none
    private

    public :: friction_update, friction_update_batch, &
        friction_update_batch_props, friction_update_points, friction_tangential, &
        friction_rates, friction_slip_rates, friction_message, friction_version, friction_text
    public :: friction_law_count, friction_get_law, friction_get_law_summary, &
        friction_get_constant, friction_get_default, friction_check, friction_law_facts, &
        friction_constant_facts

    integer(c_int), parameter, public :: friction_ok = 0
    integer(c_int), parameter, public :: friction_snap_back = 1
    integer(c_int), parameter, public :: friction_bad_size = -1
    integer(c_int), parameter, public :: friction_bad_law = -2
    integer(c_int), parameter, public :: friction_bad_property = -3
    integer(c_int), parameter, public :: friction_bad_increment = -4
    integer(c_int), parameter, public :: friction_bad_state = -5
    integer(c_int), parameter, public :: friction_no_convergence = -6
    integer(c_int), parameter, public :: friction_bad_normal = -7
    integer(c_int), parameter, public :: friction_null_pointer = -8
    integer(c_int), parameter, public :: friction_zero_time_increment = -9
    integer(c_int), parameter, public :: friction_bad_axis = -10
    integer(c_int), parameter, public :: friction_no_rate = -11

    !> What is to be known about a law; texts end with a null character.
    type, bind(C) :: friction_law_facts
        character(kind=c_char) :: name(24), internal(16), internal_unit(8)
        integer(c_int) :: has_internal, constants
    end type friction_law_facts

    !> What is to be known about a constant.
    type, bind(C) :: friction_constant_facts
        character(kind=c_char) :: name(24), unit(8), meaning(72), rule(104), default_text(24), &
            words(72)
        real(c_double) :: lower, upper
        integer(c_int) :: optional, choice
    end type friction_constant_facts

    interface
        !> One contact point.
        function friction_update(ndir, du, dtime, nprops, props, nstatv, statev, traction, &
            tangent) result(status) bind(C, name='friction_update')
            import :: c_double, c_int
            implicit none
            integer(c_int), value, intent(in) :: ndir     !! components, 2 or 3: normal, tangential
            real(c_double), intent(in) :: du(ndir)        !! relative-displacement increment [L]
            real(c_double), value, intent(in) :: dtime    !! >= 0 [T]
            integer(c_int), value, intent(in) :: nprops
            real(c_double), intent(in) :: props(nprops)   !! law, alpha_n, alpha_t, its own
            integer(c_int), value, intent(in) :: nstatv   !! 8 or more
            real(c_double), intent(inout) :: statev(nstatv)   !! start in, end out; zero = virgin
            real(c_double), intent(inout) :: traction(ndir)   !! at the end [F/L^2]
            real(c_double), intent(inout) :: tangent(ndir, ndir)   !! dT_i/d(du_j) [F/L^3]
            integer(c_int) :: status                      !! one of the codes above
        end function friction_update

        !> Many points with the same constants; the point is the first index.
        function friction_update_batch(n, ndir, du, dtime, nprops, props, nstatv, statev, &
            traction, tangent, point_status) result(status) bind(C, name='friction_update_batch')
            import :: c_double, c_int, c_int64_t
            implicit none
            integer(c_int64_t), value, intent(in) :: n    !! points
            integer(c_int), value, intent(in) :: ndir
            real(c_double), intent(in) :: du(n, ndir)
            real(c_double), value, intent(in) :: dtime
            integer(c_int), value, intent(in) :: nprops
            real(c_double), intent(in) :: props(nprops)
            integer(c_int), value, intent(in) :: nstatv
            real(c_double), intent(inout) :: statev(n, nstatv)
            real(c_double), intent(inout) :: traction(n, ndir)
            real(c_double), intent(inout) :: tangent(n, ndir, ndir)
            integer(c_int), intent(inout) :: point_status(n)
            integer(c_int) :: status                      !! the worst of all points
        end function friction_update_batch

        !> The same with constants of its own at each point.
        function friction_update_batch_props(n, ndir, du, dtime, nprops, props, nstatv, &
            statev, traction, tangent, point_status) result(status) &
            bind(C, name='friction_update_batch_props')
            import :: c_double, c_int, c_int64_t
            implicit none
            integer(c_int64_t), value, intent(in) :: n    !! points
            integer(c_int), value, intent(in) :: ndir
            real(c_double), intent(in) :: du(n, ndir)
            real(c_double), value, intent(in) :: dtime
            integer(c_int), value, intent(in) :: nprops
            real(c_double), intent(in) :: props(n, nprops)
            integer(c_int), value, intent(in) :: nstatv
            real(c_double), intent(inout) :: statev(n, nstatv)
            real(c_double), intent(inout) :: traction(n, ndir)
            real(c_double), intent(inout) :: tangent(n, ndir, ndir)
            integer(c_int), intent(inout) :: point_status(n)
            integer(c_int) :: status                      !! the worst of all points
        end function friction_update_batch_props

        !> Many points with the same constants; the point is the last index.
        function friction_update_points(n, ndir, du, dtime, nprops, props, nstatv, statev, &
            traction, tangent, point_status) result(status) bind(C, name='friction_update_points')
            import :: c_double, c_int, c_int64_t
            implicit none
            integer(c_int64_t), value, intent(in) :: n    !! points
            integer(c_int), value, intent(in) :: ndir
            real(c_double), intent(in) :: du(ndir, n)
            real(c_double), value, intent(in) :: dtime
            integer(c_int), value, intent(in) :: nprops
            real(c_double), intent(in) :: props(nprops)
            integer(c_int), value, intent(in) :: nstatv
            real(c_double), intent(inout) :: statev(nstatv, n)
            real(c_double), intent(inout) :: traction(ndir, n)
            real(c_double), intent(inout) :: tangent(ndir, ndir, n)   !! dT_j/d(du_i) at (i, j)
            integer(c_int), intent(inout) :: point_status(n)
            integer(c_int) :: status                      !! the worst of all points
        end function friction_update_points

        !> The tangential part, for a host that hands in the pressure.
        function friction_tangential(ndir, du, pressure, dtime, nprops, props, nstatv, statev, &
            tau, dtau_ddu, dtau_dp) result(status) bind(C, name='friction_tangential')
            import :: c_double, c_int
            implicit none
            integer(c_int), value, intent(in) :: ndir     !! tangential components, 1 or 2
            real(c_double), intent(in) :: du(ndir)
            real(c_double), value, intent(in) :: pressure   !! at the end of the increment [F/L^2]
            real(c_double), value, intent(in) :: dtime
            integer(c_int), value, intent(in) :: nprops
            real(c_double), intent(in) :: props(nprops)
            integer(c_int), value, intent(in) :: nstatv
            real(c_double), intent(inout) :: statev(nstatv)
            real(c_double), intent(inout) :: tau(ndir)
            real(c_double), intent(inout) :: dtau_ddu(ndir, ndir)
            real(c_double), intent(inout) :: dtau_dp(ndir)
            integer(c_int) :: status
        end function friction_tangential

        !> Continuous time: rates of the state for a relative velocity.
        function friction_rates(ndir, velocity, nprops, props, nstatv, statev, rates) &
            result(status) bind(C, name='friction_rates')
            import :: c_double, c_int
            implicit none
            integer(c_int), value, intent(in) :: ndir
            real(c_double), intent(in) :: velocity(ndir)      !! [L/T]
            integer(c_int), value, intent(in) :: nprops
            real(c_double), intent(in) :: props(nprops)
            integer(c_int), value, intent(in) :: nstatv
            real(c_double), intent(in) :: statev(nstatv)
            real(c_double), intent(inout) :: rates(8)         !! of statev(2:8); rates(1) = 0
            integer(c_int) :: status
        end function friction_rates

        !> No contact spring: slip rates of many points, and the rates of their internal variable.
        function friction_slip_rates(n, tau, pressure, damping, nprops, props, internal, rate, &
            internal_rate, point_status) result(status) bind(C, name='friction_slip_rates')
            import :: c_double, c_int, c_int64_t
            implicit none
            integer(c_int64_t), value, intent(in) :: n        !! points
            real(c_double), intent(in) :: tau(n), pressure(n)   !! [F/L^2]
            real(c_double), value, intent(in) :: damping      !! [F T/L^3]
            integer(c_int), value, intent(in) :: nprops
            real(c_double), intent(in) :: props(n, nprops)    !! of each point
            real(c_double), intent(in) :: internal(n)
            real(c_double), intent(inout) :: rate(n)          !! [L/T]
            real(c_double), intent(inout) :: internal_rate(n)
            integer(c_int), intent(inout) :: point_status(n)
            integer(c_int) :: status                          !! the worst of all points
        end function friction_slip_rates

        !> What a status says, as a C string; `friction_text` turns it into Fortran's.
        function friction_message(status) result(text) bind(C, name='friction_message')
            import :: c_int, c_ptr
            implicit none
            integer(c_int), value, intent(in) :: status
            type(c_ptr) :: text
        end function friction_message

        !> Laws are numbered from 1 to this.
        function friction_law_count() result(count) bind(C, name='friction_law_count')
            import :: c_int
            implicit none
            integer(c_int) :: count
        end function friction_law_count

        !> The facts of a law.
        function friction_get_law(law, facts) result(status) bind(C, name='friction_get_law')
            import :: c_int, friction_law_facts
            implicit none
            integer(c_int), value, intent(in) :: law
            type(friction_law_facts), intent(inout) :: facts
            integer(c_int) :: status
        end function friction_get_law

        !> What a law is, in words.
        function friction_get_law_summary(law, length, text) result(status) &
            bind(C, name='friction_get_law_summary')
            import :: c_char, c_int
            implicit none
            integer(c_int), value, intent(in) :: law
            integer(c_int), value, intent(in) :: length
            character(kind=c_char), intent(inout) :: text(*)
            integer(c_int) :: status
        end function friction_get_law_summary

        !> The facts of a constant.
        function friction_get_constant(law, place, facts) result(status) &
            bind(C, name='friction_get_constant')
            import :: c_int, friction_constant_facts
            implicit none
            integer(c_int), value, intent(in) :: law
            integer(c_int), value, intent(in) :: place   !! in props, counted from 0
            type(friction_constant_facts), intent(inout) :: facts
            integer(c_int) :: status
        end function friction_get_constant

        !> The default of a constant, by those before it.
        function friction_get_default(nprops, props, place, default) result(status) &
            bind(C, name='friction_get_default')
            import :: c_double, c_int
            implicit none
            integer(c_int), value, intent(in) :: nprops   !! how many are known
            real(c_double), intent(in) :: props(nprops)
            integer(c_int), value, intent(in) :: place    !! in props, counted from 0
            real(c_double), intent(inout) :: default
            integer(c_int) :: status
        end function friction_get_default

        !> Which constant breaks which rule.
        function friction_check(nprops, props, length, text) result(status) &
            bind(C, name='friction_check')
            import :: c_char, c_double, c_int
            implicit none
            integer(c_int), value, intent(in) :: nprops
            real(c_double), intent(in) :: props(nprops)
            integer(c_int), value, intent(in) :: length
            character(kind=c_char), intent(inout) :: text(length)   !! ended by a null character
            integer(c_int) :: status
        end function friction_check

        !> Version of the library, as a C string.
        function friction_version() result(text) bind(C, name='friction_version')
            import :: c_ptr
            implicit none
            type(c_ptr) :: text
        end function friction_version
    end interface

contains

    !> A C string that the library returned.
    function friction_text(string) result(text)
        type(c_ptr), intent(in) :: string
        character(len=:), allocatable :: text
        integer, parameter :: longest = 200
        character(kind=c_char), pointer :: characters(:)
        integer :: i

        text = ''
        call c_f_pointer(string, characters, [longest])
        do i = 1, longest
            if (iachar(characters(i)) == 0) exit
            text = text // characters(i)
        end do
    end function friction_text

end module friction_interface
