!> The C interface of what lays files of fields out, HDF5 or plain numbers: field_layout.h.
module field_layouts
    use, intrinsic :: iso_c_binding, only : c_char, c_double, c_int, c_int64_t
    implicit none
    private

    public :: field_layout, fields_are_hdf5, find_fields, get_numbers, join_fields, &
        lay_out_fields, put_numbers

    integer, parameter, public :: word = 8          !! bytes of a number
    integer, parameter, public :: name_length = 16, most_fields = 8

    !> Fields on cells in rows and columns, as C knows them.
    type, bind(C) :: field_layout
        integer(c_int64_t) :: records = 0
        integer(c_int64_t) :: rows = 1, columns = 1
        integer(c_int64_t) :: fields = 0
        character(kind=c_char) :: names(name_length, most_fields)
        character(kind=c_char) :: axes(name_length, 2)
    end type field_layout

    interface
        integer(c_int) function fields_are_hdf5() bind(C, name='stickslip_fields_are_hdf5')
            import :: c_int
            implicit none
        end function fields_are_hdf5

        integer(c_int) function lay_out_fields(path, layout, places) &
            bind(C, name='stickslip_lay_out_fields')
            import :: c_char, c_int, c_int64_t, field_layout
            implicit none
            character(kind=c_char), intent(in) :: path(*)
            type(field_layout), intent(in) :: layout
            integer(c_int64_t), intent(out) :: places(*)
        end function lay_out_fields

        integer(c_int) function find_fields(path, layout, places) &
            bind(C, name='stickslip_find_fields')
            import :: c_char, c_int, c_int64_t, field_layout
            implicit none
            character(kind=c_char), intent(in) :: path(*)
            type(field_layout), intent(inout) :: layout
            integer(c_int64_t), intent(out) :: places(*)
        end function find_fields

        integer(c_int) function join_fields(path, layout, parts, length, per_part, axes) &
            bind(C, name='stickslip_join_fields')
            import :: c_char, c_double, c_int, c_int64_t, field_layout
            implicit none
            character(kind=c_char), intent(in) :: path(*)
            type(field_layout), intent(in) :: layout
            character(kind=c_char), intent(in) :: parts(*)
            integer(c_int64_t), value, intent(in) :: length, per_part
            real(c_double), intent(in) :: axes(*)
        end function join_fields

        integer(c_int) function put_numbers(path, place, stride, blocks, length, numbers) &
            bind(C, name='stickslip_put_numbers')
            import :: c_char, c_double, c_int, c_int64_t
            implicit none
            character(kind=c_char), intent(in) :: path(*)
            integer(c_int64_t), value, intent(in) :: place, stride, blocks, length
            real(c_double), intent(in) :: numbers(*)
        end function put_numbers

        integer(c_int) function get_numbers(path, place, stride, blocks, length, numbers) &
            bind(C, name='stickslip_get_numbers')
            import :: c_char, c_double, c_int, c_int64_t
            implicit none
            character(kind=c_char), intent(in) :: path(*)
            integer(c_int64_t), value, intent(in) :: place, stride, blocks, length
            real(c_double), intent(out) :: numbers(*)
        end function get_numbers
    end interface

end module field_layouts
