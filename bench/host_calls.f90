!> UMAT as CalculiX calls it.
module host_calls
    use, intrinsic :: iso_fortran_env, only : dp => real64
    implicit none
    private

    public :: call_host

    external :: umat

contains

    subroutine call_host(props, dtime, dstran, statev, stress, ddsdde)
        real(dp), intent(in) :: props(10), dtime, dstran(6)
        real(dp), intent(inout) :: statev(8), stress(6), ddsdde(6, 6)
        real(dp), parameter :: zero(9) = 0.0_dp
        character(len=80), parameter :: name = '@ABAQUS_STICKSLIP'
        integer, parameter :: step(4) = [1, 1, 0, 0]
        real(dp) :: other(6), pnewdt

        pnewdt = -1.0_dp
        call umat(stress, statev, ddsdde, other(1), other(2), other(3), other(4), other, other, &
            other(5), zero, dstran, zero, dtime, 0.0_dp, 0.0_dp, zero, zero, name, 3, 3, 6, 8, &
            props, 10, zero, zero, pnewdt, 1.0_dp, zero, zero, 1, 1, 1, 1, step, 1)
    end subroutine call_host

end module host_calls
