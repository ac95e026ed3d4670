!> Writes the rows of a point's path as CSV. What is written stays written, whatever comes.
module point_recorder
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use friction_mod, only : statev_dissipation, statev_mu, statev_r, statev_slip, statev_status
    use material_point, only : contact_point
    use number_text, only : full_row, whole_text
    use text_file, only : output_file
    implicit none
    private

    public :: point_csv

    type :: point_csv
        type(output_file) :: file
        logical :: tangent = .false.   !! has columns for it
    contains
        procedure :: start, write_row
    end type point_csv

contains

    subroutine start(self, name, ndir, internal, tangent)
        class(point_csv), intent(inout) :: self
        character(len=*), intent(in) :: name
        integer, intent(in) :: ndir       !! directions
        character(len=*), intent(in) :: internal   !! name of the law's internal variable
        logical, intent(in) :: tangent    !! columns for it, in column-major order
        character(len=:), allocatable :: header
        character(len=6) :: entry
        integer :: i, j

        header = 'time,u_n,u_t1,u_t2,t_n,t_t1,t_t2'
        if (ndir == 2) header = 'time,u_n,u_t1,t_n,t_t1'
        header = header // ',status,mu,' // trim(internal) // ',slip,dissipation,iterations'
        self%tangent = tangent
        if (tangent) then
            do j = 1, ndir
                do i = 1, ndir
                    write (entry, '(a, 2i1)') ',d', i, j
                    header = header // trim(entry)
                end do
            end do
        end if
        call self%file%create(name)
        call self%file%write_line(header)
        call self%file%flush_lines()
    end subroutine start

    subroutine write_row(self, time, point, iterations)
        class(point_csv), intent(inout) :: self
        real(dp), intent(in) :: time             !! [T]
        type(contact_point), intent(in) :: point
        integer, intent(in) :: iterations        !! that the increment took
        character(len=:), allocatable :: line
        integer :: j

        line = full_row([time])
        call add(point%u)
        call add(point%traction)
        line = line // ',' // whole_text(nint(point%statev(statev_status)))
        call add(point%statev([statev_mu, statev_r, statev_slip, statev_dissipation]))
        line = line // ',' // whole_text(iterations)
        if (self%tangent) then
            do j = 1, size(point%u)
                call add(point%tangent(:, j))
            end do
        end if
        call self%file%write_line(line)

    contains

        subroutine add(numbers)
            real(dp), intent(in) :: numbers(:)

            line = line // ',' // full_row(numbers)
        end subroutine add

    end subroutine write_row

end module point_recorder
