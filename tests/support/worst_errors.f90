!> The worst of errors, for a test that compares it with a bound. gfortran's `max` and `maxval` pass
!> over a NaN, which then fails no test; these keep it, and no NaN is below a bound.
module worst_errors
    use, intrinsic :: ieee_arithmetic, only : ieee_is_nan
    use, intrinsic :: iso_fortran_env, only : dp => real64
    implicit none
    private

    public :: worse, worst_of

    interface worst_of
        module procedure worst_of_vector, worst_of_matrix, worst_of_block
    end interface worst_of

contains

    elemental function worse(worst, error)
        real(dp), intent(in) :: worst, error
        real(dp) :: worse

        if (ieee_is_nan(worst) .or. ieee_is_nan(error)) then   ! comparisons with it may be trapped
            worse = merge(worst, error, ieee_is_nan(worst))
        else
            worse = max(worst, error)
        end if
    end function worse

    pure function worst_of_vector(errors) result(worst)
        real(dp), intent(in) :: errors(:)
        real(dp) :: worst
        integer :: i

        worst = -huge(worst)
        do i = 1, size(errors)
            worst = worse(worst, errors(i))
        end do
    end function worst_of_vector

    pure function worst_of_matrix(errors) result(worst)
        real(dp), intent(in) :: errors(:, :)
        real(dp) :: worst

        worst = worst_of_vector([errors])
    end function worst_of_matrix

    pure function worst_of_block(errors) result(worst)
        real(dp), intent(in) :: errors(:, :, :)
        real(dp) :: worst

        worst = worst_of_vector([errors])
    end function worst_of_block

end module worst_errors
