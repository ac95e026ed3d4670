!> Fields of a chain in a NetCDF file: what there is where the NetCDF library for Fortran was not
!> found when the program was built. optional/field_file.f90 takes its place where it was.
module field_file
    use, intrinsic :: iso_fortran_env, only : dp => real64
    implicit none
    private

    public :: netcdf_fields

    logical, parameter, public :: netcdf_available = .false.

    type :: netcdf_fields
        integer :: rows = 0
        logical :: failed = .false.
    contains
        procedure :: create, go_on, write_row, finish
    end type netcdf_fields

contains

    subroutine create(self, name, n_blocks)
        class(netcdf_fields), intent(inout) :: self
        character(len=*), intent(in) :: name
        integer, intent(in) :: n_blocks

        self%failed = .true.
    end subroutine create

    subroutine go_on(self, name, rows)
        class(netcdf_fields), intent(inout) :: self
        character(len=*), intent(in) :: name
        integer, intent(in) :: rows

        self%failed = .true.
    end subroutine go_on

    subroutine write_row(self, time, slip_rate, slip, mu)
        class(netcdf_fields), intent(inout) :: self
        real(dp), intent(in) :: time, slip_rate(:), slip(:), mu(:)

        self%failed = self%failed .or. self%rows > 0
    end subroutine write_row

    subroutine finish(self)
        class(netcdf_fields), intent(inout) :: self

        self%rows = 0
    end subroutine finish

end module field_file
