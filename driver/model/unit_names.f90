!> Names of the units that an input is in: pictures show them.
module unit_names
    implicit none
    private

    public :: units

    type :: units
        character(len=16) :: length = 'L', force = 'F', time = 'T'
    contains
        procedure :: stress
    end type units

contains

    !> Of a traction: force over length squared, by its own name where there is one.
    pure function stress(self) result(name)
        class(units), intent(in) :: self
        character(len=40) :: name

        select case (trim(self%force) // '/' // trim(self%length))
        case ('N/m')
            name = 'Pa'
        case ('kN/m')
            name = 'kPa'
        case ('MN/m', 'N/mm')
            name = 'MPa'
        case ('kN/mm')
            name = 'GPa'
        case default
            name = trim(self%force) // '/' // trim(self%length) // '^2'
        end select
    end function stress

end module unit_names
