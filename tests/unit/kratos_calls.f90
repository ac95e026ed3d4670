!> Calls of UMAT as Kratos 10.4 makes them: from C++, with NULL for much of the argument list.
module kratos_calls
    use, intrinsic :: iso_c_binding, only : c_char, c_double, c_int, c_null_ptr, c_ptr
    use, intrinsic :: iso_fortran_env, only : dp => real64
    implicit none
    private

    public :: call_umat

    interface
        !> As Kratos declares it: 37 pointers, and no hidden length of the name.
        subroutine umat(stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, &
            dstran, time, dtime, temp, dtemp, predef, dpred, cmname, ndi, nshr, ntens, nstatv, &
            props, nprops, coords, drot, pnewdt, celent, dfgrd0, dfgrd1, noel, npt, layer, kspt, &
            jstep, kinc) bind(C, name='umat_')
            import :: c_char, c_double, c_int, c_ptr
            implicit none
            integer(c_int), intent(in) :: ndi, nshr, ntens, nstatv, nprops, noel, npt, jstep, kinc
            real(c_double), intent(inout) :: stress(6), statev(8), ddsdde(6, 6), sse, spd, scd
            real(c_double), intent(in) :: stran(6), dstran(6), time, dtime, props(nprops)
            type(c_ptr), value, intent(in) :: rpl, ddsddt, drplde, drpldt, temp, dtemp, predef, &
                dpred, coords, drot, pnewdt, celent, dfgrd0, dfgrd1, layer, kspt
            character(kind=c_char), intent(in) :: cmname
        end subroutine umat
    end interface

contains

    subroutine call_umat(props, dtime, stran, dstran, statev, stress, ddsdde)
        real(dp), intent(in) :: props(:), dtime, stran(6), dstran(6)
        real(dp), intent(inout) :: statev(8), stress(6)
        real(dp), intent(out) :: ddsdde(6, 6)
        real(dp) :: energy(3)

        energy = 0.0_dp
        call umat(stress, statev, ddsdde, energy(1), energy(2), energy(3), c_null_ptr, &
            c_null_ptr, c_null_ptr, c_null_ptr, stran, dstran, 0.0_dp, dtime, c_null_ptr, &
            c_null_ptr, c_null_ptr, c_null_ptr, 'x', 3, 3, 6, 8, props, size(props), c_null_ptr, &
            c_null_ptr, c_null_ptr, c_null_ptr, c_null_ptr, c_null_ptr, 0, 0, c_null_ptr, &
            c_null_ptr, 1, 1)
    end subroutine call_umat

end module kratos_calls
