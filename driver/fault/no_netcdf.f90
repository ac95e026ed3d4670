!> Where the build has no NetCDF: its files are refused. Module `netcdf_table` of netcdf_table.f90
!> reads them.
module netcdf_table
    use csv_table, only : column_request, table
    implicit none
    private

    public :: read_netcdf_table

contains

    subroutine read_netcdf_table(path, requests, read_in)
        character(len=*), intent(in) :: path
        type(column_request), intent(in) :: requests(:)
        type(table), intent(out) :: read_in

        allocate (read_in%names(0), read_in%values(size(requests), 0), read_in%lines(0), &
            read_in%faults(0))
        call read_in%add_fault(0, path // ': this fault engine was built without NetCDF ' &
            // '(Debian: libnetcdf-dev, then build again)')
    end subroutine read_netcdf_table

end module netcdf_table
