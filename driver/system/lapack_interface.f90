!> The procedures of LAPACK that the program calls.
module lapack_interface
    use, intrinsic :: iso_fortran_env, only : dp => real64
    implicit none
    private

    public :: dgebal, dgeev, dgesv, dgetrf, dgtsv, dlasrt

    interface
        !> The units, as powers of two, in which the rows and columns of a matrix are most alike,
        !> and the matrix in these.
        pure subroutine dgebal(job, n, a, lda, ilo, ihi, scale, info)
            import :: dp
            implicit none
            character(len=1), intent(in) :: job
            integer, intent(in) :: n, lda
            real(dp), intent(inout) :: a(lda, n)
            real(dp), intent(out) :: scale(n)
            integer, intent(out) :: ilo, ihi, info
        end subroutine dgebal

        !> Eigenvalues of a general matrix.
        pure subroutine dgeev(jobvl, jobvr, n, a, lda, wr, wi, vl, ldvl, vr, ldvr, work, lwork, &
            info)
            import :: dp
            implicit none
            character(len=1), intent(in) :: jobvl, jobvr
            integer, intent(in) :: n, lda, ldvl, ldvr, lwork
            real(dp), intent(inout) :: a(lda, n)
            real(dp), intent(out) :: wr(n), wi(n), vl(ldvl, n), vr(ldvr, n), work(lwork)
            integer, intent(out) :: info
        end subroutine dgeev

        !> Linear system by Gaussian elimination with partial pivoting.
        pure subroutine dgesv(n, nrhs, a, lda, ipiv, b, ldb, info)
            import :: dp
            implicit none
            integer, intent(in) :: n, nrhs, lda, ldb
            real(dp), intent(inout) :: a(lda, *), b(ldb, *)
            integer, intent(out) :: ipiv(*), info
        end subroutine dgesv

        !> Factors of a matrix by Gaussian elimination with partial pivoting.
        pure subroutine dgetrf(m, n, a, lda, ipiv, info)
            import :: dp
            implicit none
            integer, intent(in) :: m, n, lda
            real(dp), intent(inout) :: a(lda, n)
            integer, intent(out) :: ipiv(n), info
        end subroutine dgetrf

        !> Tridiagonal system by Gaussian elimination with partial pivoting.
        pure subroutine dgtsv(n, nrhs, dl, d, du, b, ldb, info)
            import :: dp
            implicit none
            integer, intent(in) :: n, nrhs, ldb
            real(dp), intent(inout) :: dl(*), d(*), du(*), b(ldb, *)
            integer, intent(out) :: info
        end subroutine dgtsv

        !> Sorts numbers.
        pure subroutine dlasrt(id, n, d, info)
            import :: dp
            implicit none
            character(len=1), intent(in) :: id   !! 'I': they increase
            integer, intent(in) :: n
            real(dp), intent(inout) :: d(n)
            integer, intent(out) :: info
        end subroutine dlasrt
    end interface

end module lapack_interface
