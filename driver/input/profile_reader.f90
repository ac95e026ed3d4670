!> Quantities that differ from place to place: where the input has '@file.csv' in place of a number,
!> the file has it at nodes, in a column of the key's name beside the columns of the coordinates.
!> '@file.nc' is a NetCDF file, with variables in place of columns; only who has that library reads
!> it.
module profile_reader
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use column_keys, only : refuse_table
    use csv_table, only : column_request, csv => table, read_table, table_reader
    use grid_map, only : map_on_grid, nodes_up_to
    use lapack_interface, only : dlasrt
    use namelist_input, only : namelist_file
    use number_text, only : full_row
    use printable_text, only : lower
    implicit none
    private

    public :: joined, names_netcdf, names_profile, profile, put_number, read_map, take_profiles

    !> A quantity that a file gives at nodes.
    type :: profile
        character(len=:), allocatable :: group, key   !! where the input names the file
        type(map_on_grid) :: map                      !! of one quantity
    end type profile

contains

    !> Reads the files that keys of &friction name, and that the normal traction in another group
    !> does. Every fault is left in `file%faults`.
    subroutine take_profiles(file, group, axes, profiles, read_netcdf)
        type(namelist_file), intent(inout) :: file
        character(len=*), intent(in) :: group     !! that has the key normal_traction
        character(len=*), intent(in) :: axes(2)   !! see `read_map`
        type(profile), allocatable, intent(out) :: profiles(:)
        procedure(table_reader), optional :: read_netcdf
        type(profile) :: this
        integer :: i
        logical :: sound

        allocate (profiles(0))
        do i = 1, size(file%entries)
            if (.not. names_profile(file, i, group)) cycle
            this%group = file%entries(i)%group
            this%key = file%entries(i)%key
            call read_map(file, this%group, this%key, axes, [this%key], this%map, sound, &
                read_netcdf)
            if (sound) profiles = [profiles, this]
            file%entries(i)%faulty = .not. sound
        end do
    end subroutine take_profiles

    !> Is an entry of the input one that may name a file, and does?
    pure logical function names_profile(file, i, group) result(yes)
        type(namelist_file), intent(in) :: file
        integer, intent(in) :: i                !! entry
        character(len=*), intent(in) :: group   !! that has the key normal_traction

        yes = .false.
        associate (entry => file%entries(i))
            if (size(entry%values) /= 1) return
            if (entry%group == 'friction' .or. (entry%group == group .and. entry%key &
                == 'normal_traction')) yes = entry%values(1)%quoted .and. &
                index(entry%values(1)%text, '@') == 1 .and. len(entry%values(1)%text) > 1
        end associate
    end function names_profile

    !> Does the input name a NetCDF file anywhere?
    pure logical function names_netcdf(file) result(yes)
        type(namelist_file), intent(in) :: file
        integer :: i

        yes = .false.
        do i = 1, size(file%entries)
            if (size(file%entries(i)%values) == 1) yes = yes .or. &
                file%entries(i)%values(1)%quoted .and. is_netcdf(file%entries(i)%values(1)%text)
        end do
    end function names_netcdf

    pure logical function is_netcdf(name) result(yes)
        character(len=*), intent(in) :: name

        yes = lower(name(max(1, len(name) - 2):)) == '.nc'
    end function is_netcdf

    !> A number takes the place of the name of a file.
    subroutine put_number(file, group, key, number)
        type(namelist_file), intent(inout) :: file
        character(len=*), intent(in) :: group, key
        real(dp), intent(in) :: number
        integer :: i

        do i = 1, size(file%entries)
            if (file%entries(i)%group /= group .or. file%entries(i)%key /= key) cycle
            file%entries(i)%values(1)%text = full_row([number])
            file%entries(i)%values(1)%quoted = .false.
        end do
    end subroutine put_number

    !> Two lists as one that increases, each number once.
    pure function joined(a, b) result(both)
        real(dp), intent(in) :: a(:), b(:)
        real(dp), allocatable :: both(:)
        integer :: n, info

        both = [a, b]
        n = size(both)
        call dlasrt('I', n, both, info)
        if (n > 1) both = pack(both, [.true., both(2:) > both(:n - 1)])
    end function joined

    !> Reads the file that a key names: columns of the axes, in full grid, and `names`.
    subroutine read_map(file, group, key, axes, names, map, sound, read_netcdf)
        type(namelist_file), intent(inout) :: file
        character(len=*), intent(in) :: group, key
        character(len=*), intent(in) :: axes(2)    !! columns of the coordinates: one that may be
                                                   !! left out, or '', and one that must be there
        character(len=*), intent(in) :: names(:)
        type(map_on_grid), intent(out) :: map
        logical, intent(out) :: sound
        procedure(table_reader), optional :: read_netcdf
        type(csv) :: read_in
        integer :: faults_before, j

        faults_before = size(file%faults)
        call read_columns(file, group, key, axes, names, read_in, read_netcdf)
        sound = size(file%faults) == faults_before .and. allocated(read_in%values)
        if (.not. sound) return
        map%x = nodes_in(read_in, axes(1))
        map%z = nodes_in(read_in, axes(2))
        if (read_in%column(trim(axes(2))) == 0) then
            call file%reject(group, key, "its file has no column '" // trim(axes(2)) // "'")
        else if (size(map%x) * size(map%z) /= size(read_in%values, 2)) then
            call refuse_nodes(file, group, key, axes)
        end if
        do j = 1, size(names)
            if (read_in%column(trim(names(j))) == 0) call file%reject(group, key, &
                "its file has no column '" // trim(names(j)) // "'")
        end do
        sound = size(file%faults) == faults_before
        if (.not. sound) return
        call fill_map(read_in, axes, names, map, sound)
        if (.not. sound) call refuse_nodes(file, group, key, axes)
    end subroutine read_map

    subroutine refuse_nodes(file, group, key, axes)
        type(namelist_file), intent(inout) :: file
        character(len=*), intent(in) :: group, key, axes(2)

        if (axes(1) == '') then
            call file%reject(group, key, 'its file must have each ' // trim(axes(2)) // ' once')
        else
            call file%reject(group, key, 'its file must have each node of a grid once: one row ' &
                // 'for each ' // trim(axes(2)) // ', or for each pair of an ' // trim(axes(1)) &
                // ' and a ' // trim(axes(2)))
        end if
    end subroutine refuse_nodes

    subroutine read_columns(file, group, key, axes, names, read_in, read_netcdf)
        type(namelist_file), intent(inout) :: file
        character(len=*), intent(in) :: group, key, axes(2), names(:)
        type(csv), intent(out) :: read_in
        procedure(table_reader), optional :: read_netcdf
        type(column_request) :: requests(size(names) + 2)
        character(len=:), allocatable :: name
        integer :: first, i

        call file%get_text(group, key, name)
        if (len(name) == 0) return
        if (name(1:1) == '@') name = name(2:)
        if (len(name) == 0) then
            call file%reject(group, key, 'must name a file')
            return
        end if
        requests(1)%name = trim(axes(1))
        requests(2)%name = trim(axes(2))
        do i = 1, size(names)
            requests(2 + i)%name = trim(names(i))
        end do
        first = merge(2, 1, axes(1) == '')
        if (.not. is_netcdf(name)) then
            call read_table(file%beside(name), requests(first:), read_in)
        else if (present(read_netcdf)) then
            call read_netcdf(file%beside(name), requests(first:), read_in)
        else
            call file%reject(group, key, 'is a NetCDF file, which the fault engine alone reads')
            return
        end if
        call refuse_table(file, group, key, read_in)
    end subroutine read_columns

    !> Places along an axis that a file has; 0 if it does not have the axis.
    pure function nodes_in(read_in, axis) result(nodes)
        type(csv), intent(in) :: read_in
        character(len=*), intent(in) :: axis
        real(dp), allocatable :: nodes(:)

        nodes = [0.0_dp]
        if (read_in%column(trim(axis)) > 0) nodes = joined([real(dp) ::], &
            read_in%numbers(trim(axis)))
    end function nodes_in

    subroutine fill_map(read_in, axes, names, map, whole)
        type(csv), intent(in) :: read_in
        character(len=*), intent(in) :: axes(2), names(:)
        type(map_on_grid), intent(inout) :: map
        logical, intent(out) :: whole   !! no node is missing because another stands twice
        integer :: columns(size(names)), along(2), i, j, k, row

        columns = [(read_in%column(trim(names(j))), j = 1, size(names))]
        along = [(read_in%column(trim(axes(j))), j = 1, 2)]
        allocate (map%values(size(names), size(map%x), size(map%z)), source=huge(1.0_dp))
        i = 1
        do row = 1, size(read_in%values, 2)
            if (along(1) > 0) i = nodes_up_to(map%x, read_in%values(along(1), row))
            k = nodes_up_to(map%z, read_in%values(along(2), row))
            map%values(:, i, k) = read_in%values(columns, row)
        end do
        whole = all(map%values < huge(1.0_dp))
    end subroutine fill_map

end module profile_reader
