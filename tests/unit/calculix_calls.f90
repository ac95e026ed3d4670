!> Calls of UMAT as CalculiX 2.20 makes them.
module calculix_calls
    use, intrinsic :: iso_fortran_env, only : dp => real64
    implicit none
    private

    public :: call_umat

    external :: umat

contains

    !> STRESS and STATEV are those of the start of the increment, PNEWDT comes in as -1, SSE, PREDEF
    !> and CELENT are not set.
    subroutine call_umat(props, time, dtime, stran, dstran, statev, stress, ddsdde, pnewdt, &
        nlgeom, perturbation)
        real(dp), intent(in) :: props(:), time, dtime, stran(6), dstran(6)
        real(dp), intent(inout) :: statev(8), stress(6)
        real(dp), intent(out) :: ddsdde(6, 6), pnewdt
        logical, intent(in), optional :: nlgeom, perturbation
        real(dp) :: zero(9), junk(9)
        integer :: step(4)
        character(len=80) :: name

        zero = 0.0_dp
        junk = -7.0e33_dp
        step = [1, 1, 0, 0]
        if (present(nlgeom)) step(3) = merge(1, 0, nlgeom)
        if (present(perturbation)) step(4) = merge(1, 0, perturbation)
        name = '@ABAQUS_STICKSLIP'
        pnewdt = -1.0_dp
        call umat(stress, statev, ddsdde, junk(1), junk(2), junk(3), junk(4), junk, junk, junk(5), &
            stran, dstran, [time, time + 5.0_dp], dtime, 0.0_dp, 0.0_dp, junk, junk, name, 3, 3, &
            6, 8, props, size(props), zero, zero, pnewdt, junk(6), zero, zero, 1, 1, 1, 1, step, 1)
    end subroutine call_umat

end module calculix_calls
