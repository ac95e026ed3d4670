!> The keys of &output that name the units of an input.
module unit_reader
    use namelist_input, only : namelist_file
    use unit_names, only : units
    implicit none
    private

    public :: read_units

contains

    subroutine read_units(file, names)
        type(namelist_file), intent(inout) :: file
        type(units), intent(inout) :: names

        names%length = name_of('length_unit', names%length)
        names%force = name_of('force_unit', names%force)
        names%time = name_of('time_unit', names%time)

    contains

        function name_of(key, default) result(name)
            character(len=*), intent(in) :: key, default
            character(len=len(names%length)) :: name
            character(len=:), allocatable :: text

            call file%get_text('output', key, text)
            if (len(text) > len(name)) call file%reject('output', key, &
                'must not be longer than 16 characters')
            name = default
            if (len(text) > 0) name = text
        end function name_of

    end subroutine read_units

end module unit_reader
