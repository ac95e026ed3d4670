!> What the machine can do at best: copy bytes, and take one logarithm and one square root a point.
module peers
    use, intrinsic :: iso_c_binding, only : c_double, c_loc, c_ptr, c_size_t
    use, intrinsic :: iso_fortran_env, only : dp => real64
    implicit none
    private

    public :: copy_bytes, log_and_sqrt

    interface
        function c_memcpy(to, from, bytes) result(place) bind(C, name='memcpy')
            import :: c_ptr, c_size_t
            implicit none
            type(c_ptr), value, intent(in) :: to, from
            integer(c_size_t), value, intent(in) :: bytes
            type(c_ptr) :: place
        end function c_memcpy

        !> Called by this name the compiler cannot put two logarithms into one vector.
        pure function c_log(x) result(y) bind(C, name='log')
            import :: c_double
            implicit none
            real(c_double), value, intent(in) :: x
            real(c_double) :: y
        end function c_log
    end interface

contains

    !> The C library's memcpy.
    subroutine copy_bytes(bytes, from, to)
        integer(c_size_t), intent(in) :: bytes                  !! not more than the arrays hold
        real(dp), intent(in), contiguous, target :: from(:)
        real(dp), intent(inout), contiguous, target :: to(:)
        type(c_ptr) :: place

        place = c_memcpy(c_loc(to), c_loc(from), bytes)
    end subroutine copy_bytes

    !> The mathematical library's log and a square root over the data of a set, one after the other.
    pure function log_and_sqrt(statev) result(total)
        real(dp), intent(in), contiguous :: statev(:, :)   !! (8, n)
        real(dp) :: total
        integer :: k

        total = 0.0_dp
        do k = 1, size(statev, 2)
            total = total + (c_log(statev(6, k)) + sqrt(-statev(2, k)))
        end do
    end function log_and_sqrt

end module peers
