!> Ends the program of a host that cannot be told of an error otherwise.
module friction_host_end
    use, intrinsic :: iso_c_binding, only : c_char, c_int, c_null_char
    use friction_host, only : used_length
    implicit none
    private

    public :: end_host

    integer(c_int), parameter, public :: to_output = 1, to_errors = 2   !! streams

    interface
        !> See friction_host_end.c.
        subroutine c_end_host(text, stream, exit_status) bind(C, name='stickslip_end_host')
            import :: c_char, c_int
            implicit none
            character(kind=c_char), intent(in) :: text(*)
            integer(c_int), value, intent(in) :: stream, exit_status
        end subroutine c_end_host
    end interface

contains

    subroutine end_host(text, stream, exit_status)
        character(len=*), intent(in) :: text           !! trailing blanks do not count
        integer(c_int), intent(in) :: stream           !! where the text goes
        integer(c_int), intent(in) :: exit_status      !! of the program
        character(kind=c_char) :: line(len(text) + 1)
        integer :: i, length

        length = used_length(text)
        do i = 1, length
            line(i) = text(i:i)
        end do
        line(length + 1) = c_null_char
        call c_end_host(line, stream, exit_status)
    end subroutine end_host

end module friction_host_end
