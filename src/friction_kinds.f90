!> The one working precision of the library, and which of its numbers can be worked with.
module friction_kinds
    use, intrinsic :: iso_fortran_env, only : int64, real64
    implicit none
    private

    public :: all_usable

    integer, parameter, public :: wp = real64   !! working precision

contains

    !> Is every number finite and below 2**333 (1.7e100) in magnitude, so that products of three
    !> cannot overflow?
    !>
    !> Reads the exponents as integers: silent where NaN raises a floating-point exception, and
    !> right even where the compiler was told that there are no NaNs.
    pure function all_usable(x) result(usable)
        real(wp), intent(in) :: x(:)
        logical :: usable
        integer(int64), parameter :: exponent_mask = int(z'7FF0000000000000', int64)
        integer(int64), parameter :: limit = shiftl(1023_int64 + 333_int64, 52)
        integer :: i

        usable = .true.
        do i = 1, size(x)
            usable = usable .and. iand(transfer(x(i), 0_int64), exponent_mask) < limit
        end do
    end function all_usable

end module friction_kinds
