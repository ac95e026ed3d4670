!> Fields of a chain in a NetCDF file: dimensions `time` (unlimited) and `block`. Built in place of
!> driver/field_file.f90 where the NetCDF library for Fortran is found.
module field_file
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use netcdf, only : nf90_64bit_offset, nf90_clobber, nf90_close, nf90_create, nf90_def_dim, &
        nf90_def_var, nf90_double, nf90_enddef, nf90_inq_varid, &
        nf90_noerr, nf90_open, nf90_put_att, nf90_put_var, nf90_sync, nf90_unlimited, nf90_write
    implicit none
    private

    public :: netcdf_fields

    logical, parameter, public :: netcdf_available = .true.
    character(len=9), parameter :: names(4) = ['time     ', 'slip_rate', 'slip     ', 'mu       ']
    character(len=3), parameter :: units(4) = ['T  ', 'L/T', 'L  ', '-  ']

    type :: netcdf_fields
        integer :: file = -1           !! of the library; negative: none
        integer :: variables(4) = 0
        integer :: rows = 0            !! written
        logical :: failed = .false.
    contains
        procedure :: create, go_on, write_row, finish
        procedure, private :: check
    end type netcdf_fields

contains

    subroutine create(self, name, n_blocks)
        class(netcdf_fields), intent(inout) :: self
        character(len=*), intent(in) :: name
        integer, intent(in) :: n_blocks
        integer :: dimensions(2), i

        call self%check(nf90_create(name, ior(nf90_clobber, nf90_64bit_offset), self%file))
        call self%check(nf90_def_dim(self%file, 'block', n_blocks, dimensions(1)))
        call self%check(nf90_def_dim(self%file, 'time', nf90_unlimited, dimensions(2)))
        do i = 1, size(names)
            if (i == 1) then
                call self%check(nf90_def_var(self%file, trim(names(i)), nf90_double, &
                    dimensions(2:), self%variables(i)))
            else
                call self%check(nf90_def_var(self%file, trim(names(i)), nf90_double, dimensions, &
                    self%variables(i)))
            end if
            call self%check(nf90_put_att(self%file, self%variables(i), 'units', trim(units(i))))
        end do
        call self%check(nf90_enddef(self%file))
    end subroutine create

    !> Goes on in the file of an interrupted run, behind its first rows.
    subroutine go_on(self, name, rows)
        class(netcdf_fields), intent(inout) :: self
        character(len=*), intent(in) :: name
        integer, intent(in) :: rows
        integer :: i

        call self%check(nf90_open(name, nf90_write, self%file))
        do i = 1, size(names)
            call self%check(nf90_inq_varid(self%file, trim(names(i)), self%variables(i)))
        end do
        self%rows = rows
    end subroutine go_on

    !> One time; afterwards the file is whole on disk.
    subroutine write_row(self, time, slip_rate, slip, mu)
        class(netcdf_fields), intent(inout) :: self
        real(dp), intent(in) :: time                            !! [T]
        real(dp), intent(in) :: slip_rate(:), slip(:), mu(:)    !! of the blocks [L/T], [L], [-]
        integer :: start(2), extent(2)

        if (self%file < 0) return
        self%rows = self%rows + 1
        start = [1, self%rows]
        extent = [size(slip), 1]
        call self%check(nf90_put_var(self%file, self%variables(1), time, start=start(2:)))
        call self%check(nf90_put_var(self%file, self%variables(2), slip_rate, start, extent))
        call self%check(nf90_put_var(self%file, self%variables(3), slip, start, extent))
        call self%check(nf90_put_var(self%file, self%variables(4), mu, start, extent))
        call self%check(nf90_sync(self%file))
    end subroutine write_row

    subroutine finish(self)
        class(netcdf_fields), intent(inout) :: self

        if (self%file >= 0) call self%check(nf90_close(self%file))
        self%file = -1
    end subroutine finish

    subroutine check(self, status)
        class(netcdf_fields), intent(inout) :: self
        integer, intent(in) :: status   !! of the library

        if (status /= nf90_noerr) self%failed = .true.
    end subroutine check

end module field_file
