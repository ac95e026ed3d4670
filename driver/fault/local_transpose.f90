!> Transposes a matrix of complex numbers, tile by tile: a tile stays in cache.
module local_transpose
    use, intrinsic :: iso_fortran_env, only : dp => real64
    implicit none
    private

    public :: transpose_here

contains

    pure subroutine transpose_here(n, m, from, to)
        integer, intent(in) :: n, m
        complex(dp), intent(in) :: from(n, m)
        complex(dp), intent(inout) :: to(m, n)
        integer, parameter :: tile = 16
        integer :: i, j, i0, j0

        do j0 = 1, m, tile
            do i0 = 1, n, tile
                do i = i0, min(i0 + tile - 1, n)
                    do j = j0, min(j0 + tile - 1, m)
                        to(j, i) = from(i, j)
                    end do
                end do
            end do
        end do
    end subroutine transpose_here

end module local_transpose
