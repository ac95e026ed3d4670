!> Reads variables of a NetCDF file, classic or netCDF-4, as the columns of a table: a row for each
!> combination of the places along all dimensions that they have. So a(z, x) with the coordinates
!> z(z) and x(x), in any order, has a row for each node of the grid, as has a list of nodes,
!> x(node), z(node) and a(node). Dimensions of one place do not count.
module netcdf_table
    use, intrinsic :: ieee_arithmetic, only : ieee_is_finite
    use, intrinsic :: iso_c_binding, only : c_char, c_f_pointer, c_int, c_null_char, c_ptr, c_size_t
    use, intrinsic :: iso_fortran_env, only : dp => real64, int64
    use csv_table, only : column_request, line_text, table
    use number_reader, only : largest
    use netcdf_interface, only : nc_char, nc_close, nc_fill_double, nc_get_att_double, &
        nc_get_var_double, nc_inq_attlen, nc_inq_dimlen, nc_inq_vardimid, nc_inq_varid, &
        nc_inq_varndims, nc_inq_vartype, nc_nowrite, nc_open, nc_strerror, nc_string
    use number_text, only : whole_text
    implicit none
    private

    public :: read_netcdf_table

    integer, parameter :: most_dimensions = 2
    integer(int64), parameter :: most_rows = 100000000_int64

    !> A variable, and where it lies in the table.
    type :: variable
        character(len=:), allocatable :: name
        integer(c_int) :: id = 0
        integer(c_int), allocatable :: dimensions(:)   !! of the file, the slowest first
        integer(int64), allocatable :: lengths(:)
    end type variable

contains

    !> As `read_table` of csv_table: what is wrong is left in `read_in%faults`, and variables that
    !> are not there are not in `read_in%names`.
    subroutine read_netcdf_table(path, requests, read_in)
        character(len=*), intent(in) :: path
        type(column_request), intent(in) :: requests(:)
        type(table), intent(out) :: read_in
        type(variable), allocatable :: variables(:)
        integer(c_int) :: file, ignored, code
        integer :: i
        logical :: there

        allocate (read_in%names(0), read_in%values(0, 0), read_in%lines(0), read_in%faults(0))
        inquire (file=path, exist=there)   ! the library takes other names for addresses
        if (.not. there) then
            call read_in%add_fault(0, 'cannot be opened: there is no such file')
            return
        end if
        code = nc_open(path // c_null_char, nc_nowrite, file)
        if (code /= 0) then
            call read_in%add_fault(0, 'cannot be read as NetCDF: ' // reason(code))
            return
        end if
        allocate (variables(0))
        do i = 1, size(requests)
            call find_variable(file, requests(i)%name, variables, read_in)
        end do
        if (size(read_in%faults) == 0) call fill(file, variables, read_in)
        ignored = nc_close(file)
    end subroutine read_netcdf_table

    !> Adds a variable to the list if the file has it.
    subroutine find_variable(file, name, variables, read_in)
        integer(c_int), intent(in) :: file
        character(len=*), intent(in) :: name
        type(variable), allocatable, intent(inout) :: variables(:)
        type(table), intent(inout) :: read_in
        type(variable) :: found
        integer(c_int) :: n, kind
        integer(c_int), allocatable :: dimensions(:)
        integer(c_size_t) :: length
        integer :: i

        if (nc_inq_varid(file, name // c_null_char, found%id) /= 0) return
        found%name = name
        kind = nc_char
        n = 0
        if (nc_inq_vartype(file, found%id, kind) /= 0 .or. nc_inq_varndims(file, found%id, n) /= 0 &
            .or. kind == nc_char .or. kind >= nc_string) then
            call read_in%add_fault(0, "variable '" // name // "' holds no numbers")
            return
        end if
        allocate (dimensions(n))
        if (nc_inq_vardimid(file, found%id, dimensions) /= 0) dimensions = 0
        allocate (found%dimensions(0), found%lengths(0))
        do i = 1, n
            length = 0
            if (nc_inq_dimlen(file, dimensions(i), length) /= 0) length = 0
            if (length == 1) cycle
            found%dimensions = [found%dimensions, dimensions(i)]
            found%lengths = [found%lengths, int(length, int64)]
        end do
        variables = [variables, found]
    end subroutine find_variable

    !> The table of all variables.
    subroutine fill(file, variables, read_in)
        integer(c_int), intent(in) :: file
        type(variable), intent(in) :: variables(:)
        type(table), intent(inout) :: read_in
        integer(c_int), allocatable :: dimensions(:)
        integer(int64), allocatable :: lengths(:)
        real(dp), allocatable :: values(:)
        type(line_text) :: name
        integer :: i, k

        allocate (dimensions(0), lengths(0))
        do i = 1, size(variables)
            do k = 1, size(variables(i)%dimensions)
                if (any(dimensions == variables(i)%dimensions(k))) cycle
                dimensions = [dimensions, variables(i)%dimensions(k)]
                lengths = [lengths, variables(i)%lengths(k)]
            end do
        end do
        if (size(dimensions) > most_dimensions .or. product(real(lengths, dp)) > most_rows) then
            call read_in%add_fault(0, 'its variables have ' // whole_text(size(dimensions)) &
                // ' dimensions with more than one value, or too many values')
            return
        end if
        deallocate (read_in%values, read_in%lines)
        allocate (read_in%values(size(variables), product(lengths)))
        read_in%lines = spread(0, 1, size(read_in%values, 2))
        do i = 1, size(variables)
            name%text = variables(i)%name
            read_in%names = [read_in%names, name]
            call read_values(file, variables(i), values, read_in)
            if (size(read_in%faults) == 0) read_in%values(i, :) = spread_over(values, &
                variables(i), dimensions, lengths)
        end do
    end subroutine fill

    !> The numbers of a variable, as `scale_factor` and `add_offset` have them.
    subroutine read_values(file, this, values, read_in)
        integer(c_int), intent(in) :: file
        type(variable), intent(in) :: this
        real(dp), allocatable, intent(out) :: values(:)
        type(table), intent(inout) :: read_in
        integer(c_int) :: code
        logical, allocatable :: bad(:)

        allocate (values(product(this%lengths)))
        code = 0
        if (size(values) > 0) code = nc_get_var_double(file, this%id, values)
        if (code /= 0) then
            call read_in%add_fault(0, "variable '" // this%name // "' cannot be read: " &
                // reason(code))
            return
        end if
        bad = .not. ieee_is_finite(values)
        call mark_equal(values, attribute(file, this%id, '_FillValue', nc_fill_double), bad)
        call mark_equal(values, attribute(file, this%id, 'missing_value', nc_fill_double), bad)
        where (.not. bad) values = attribute(file, this%id, 'add_offset', 0.0_dp) &
            + attribute(file, this%id, 'scale_factor', 1.0_dp) * values
        if (any(bad)) then
            call read_in%add_fault(0, "variable '" // this%name // "' has no number at " &
                // whole_text(count(bad)) // ' of its places, first at number ' &
                // whole_text(findloc(bad, .true., 1)))
        else if (any(abs(values) > largest)) then
            call read_in%add_fault(0, "variable '" // this%name // "' has numbers beyond 1e100")
        end if
    end subroutine read_values

    !> Marks the values that equal a number. Those that are marked, NaN among them, are not
    !> compared.
    pure subroutine mark_equal(values, number, marked)
        real(dp), intent(in) :: values(:), number
        logical, intent(inout) :: marked(:)

        if (.not. ieee_is_finite(number)) return
        where (.not. marked) marked = abs(values - number) <= 0.0_dp
    end subroutine mark_equal

    !> A number that an attribute of a variable is, or what it is if there is none.
    function attribute(file, id, name, otherwise) result(number)
        integer(c_int), intent(in) :: file, id
        character(len=*), intent(in) :: name
        real(dp), intent(in) :: otherwise
        real(dp) :: number, found(1)
        integer(c_size_t) :: length

        number = otherwise
        length = 0
        if (nc_inq_attlen(file, id, name // c_null_char, length) /= 0 .or. length /= 1) return
        if (nc_get_att_double(file, id, name // c_null_char, found) == 0) number = found(1)
    end function attribute

    !> The values of a variable at all rows: the last dimension of the table is the fastest.
    pure function spread_over(values, this, dimensions, lengths) result(column)
        real(dp), intent(in) :: values(:)
        type(variable), intent(in) :: this
        integer(c_int), intent(in) :: dimensions(:)   !! of the table
        integer(int64), intent(in) :: lengths(:)
        real(dp) :: column(product(lengths))
        integer(int64) :: row, place, rest, index_there(size(dimensions))
        integer :: k, along(size(this%dimensions))

        along = [(findloc(dimensions, this%dimensions(k), 1), k = 1, size(along))]
        do row = 1, size(column)
            rest = row - 1
            do k = size(dimensions), 1, -1
                index_there(k) = mod(rest, lengths(k))
                rest = rest / lengths(k)
            end do
            place = 0
            do k = 1, size(along)
                place = place * this%lengths(k) + index_there(along(k))
            end do
            column(row) = values(place + 1)
        end do
    end function spread_over

    !> NetCDF's words for a code.
    function reason(code) result(text)
        integer(c_int), intent(in) :: code
        character(len=:), allocatable :: text
        character(kind=c_char), pointer :: letters(:)
        type(c_ptr) :: words
        integer, parameter :: longest = 200
        integer :: i

        words = nc_strerror(code)
        call c_f_pointer(words, letters, [longest])
        text = ''
        do i = 1, longest
            if (letters(i) == c_null_char) exit
            text = text // letters(i)
        end do
    end function reason

end module netcdf_table
