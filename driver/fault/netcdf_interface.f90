!> Procedures of the NetCDF library, as C has them.
module netcdf_interface
    use, intrinsic :: iso_c_binding, only : c_char, c_double, c_int, c_ptr, c_size_t
    implicit none
    private

    public :: nc_close, nc_get_att_double, nc_get_var_double, nc_inq_attlen, nc_inq_dimlen, &
        nc_inq_vardimid, nc_inq_varid, nc_inq_varndims, nc_inq_vartype, nc_open, nc_strerror

    integer(c_int), parameter, public :: nc_nowrite = 0, nc_char = 2, nc_string = 12
    real(c_double), parameter, public :: nc_fill_double = 9.9692099683868690e+36_c_double

    interface
        integer(c_int) function nc_open(path, mode, file) bind(C, name='nc_open')
            import :: c_char, c_int
            implicit none
            character(kind=c_char), intent(in) :: path(*)
            integer(c_int), value, intent(in) :: mode
            integer(c_int), intent(out) :: file
        end function nc_open

        integer(c_int) function nc_close(file) bind(C, name='nc_close')
            import :: c_int
            implicit none
            integer(c_int), value, intent(in) :: file
        end function nc_close

        type(c_ptr) function nc_strerror(code) bind(C, name='nc_strerror')
            import :: c_int, c_ptr
            implicit none
            integer(c_int), value, intent(in) :: code
        end function nc_strerror

        integer(c_int) function nc_inq_varid(file, name, variable) bind(C, name='nc_inq_varid')
            import :: c_char, c_int
            implicit none
            integer(c_int), value, intent(in) :: file
            character(kind=c_char), intent(in) :: name(*)
            integer(c_int), intent(out) :: variable
        end function nc_inq_varid

        integer(c_int) function nc_inq_vartype(file, variable, type) bind(C, name='nc_inq_vartype')
            import :: c_int
            implicit none
            integer(c_int), value, intent(in) :: file, variable
            integer(c_int), intent(out) :: type
        end function nc_inq_vartype

        integer(c_int) function nc_inq_varndims(file, variable, n) bind(C, name='nc_inq_varndims')
            import :: c_int
            implicit none
            integer(c_int), value, intent(in) :: file, variable
            integer(c_int), intent(out) :: n
        end function nc_inq_varndims

        integer(c_int) function nc_inq_vardimid(file, variable, dimensions) &
            bind(C, name='nc_inq_vardimid')
            import :: c_int
            implicit none
            integer(c_int), value, intent(in) :: file, variable
            integer(c_int), intent(out) :: dimensions(*)
        end function nc_inq_vardimid

        integer(c_int) function nc_inq_dimlen(file, dimension, length) bind(C, name='nc_inq_dimlen')
            import :: c_int, c_size_t
            implicit none
            integer(c_int), value, intent(in) :: file, dimension
            integer(c_size_t), intent(out) :: length
        end function nc_inq_dimlen

        integer(c_int) function nc_get_var_double(file, variable, values) &
            bind(C, name='nc_get_var_double')
            import :: c_double, c_int
            implicit none
            integer(c_int), value, intent(in) :: file, variable
            real(c_double), intent(out) :: values(*)
        end function nc_get_var_double

        integer(c_int) function nc_inq_attlen(file, variable, name, length) &
            bind(C, name='nc_inq_attlen')
            import :: c_char, c_int, c_size_t
            implicit none
            integer(c_int), value, intent(in) :: file, variable
            character(kind=c_char), intent(in) :: name(*)
            integer(c_size_t), intent(out) :: length
        end function nc_inq_attlen

        integer(c_int) function nc_get_att_double(file, variable, name, values) &
            bind(C, name='nc_get_att_double')
            import :: c_char, c_double, c_int
            implicit none
            integer(c_int), value, intent(in) :: file, variable
            character(kind=c_char), intent(in) :: name(*)
            real(c_double), intent(out) :: values(*)
        end function nc_get_att_double
    end interface

end module netcdf_interface
