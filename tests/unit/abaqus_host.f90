!> What Abaqus provides for its user subroutines: here only its routine for error messages.
module abaqus_host
    implicit none
    private

    integer, public :: errors_heard = 0                !! messages that end the job
    integer, public :: warnings_heard = 0
    character(len=500), public :: last_error = ''
    character(len=8), public :: last_name = ''         !! of what the message is about

end module abaqus_host

subroutine stdb_abqerr(lop, text, intv, realv, charv)
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use abaqus_host, only : errors_heard, last_error, last_name, warnings_heard
    implicit none
    integer, intent(in) :: lop, intv(*)
    character(len=500), intent(in) :: text
    real(dp), intent(in) :: realv(*)
    character(len=8), intent(in) :: charv(*)

    if (lop == -3) errors_heard = errors_heard + 1
    if (lop == -1) warnings_heard = warnings_heard + 1
    last_error = text
    last_name = charv(1)
end subroutine stdb_abqerr

subroutine xplb_abqerr(lop, text, intv, realv, charv)
    use, intrinsic :: iso_fortran_env, only : dp => real64
    implicit none
    integer, intent(in) :: lop, intv(*)
    character(len=500), intent(in) :: text
    real(dp), intent(in) :: realv(*)
    character(len=8), intent(in) :: charv(*)
    external :: stdb_abqerr

    call stdb_abqerr(lop, text, intv, realv, charv)
end subroutine xplb_abqerr
