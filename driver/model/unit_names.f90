!> Names of the units that an input is in: pictures show them.
module unit_names
    implicit none
    private

    public :: units

    type :: units
        character(len=16) :: length = 'L', force = 'F', time = 'T'
    contains
        procedure :: stress, named
    end type units

contains

    !> Of a traction: force over length squared, by its own name where there is one.
    pure character(len=40) function stress(self) result(name)
        class(units), intent(in) :: self

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

    !> A unit in which F, L and T stand for force, length and time, with the names of these.
    pure function named(self, unit) result(name)
        class(units), intent(in) :: self
        character(len=*), intent(in) :: unit   !! such as 'F/L^2'
        character(len=:), allocatable :: name
        integer :: i

        name = ''
        do i = 1, len_trim(unit)
            select case (unit(i:i))
            case ('F')
                name = name // trim(self%force)
            case ('L')
                name = name // trim(self%length)
            case ('T')
                name = name // trim(self%time)
            case default
                name = name // unit(i:i)
            end select
        end do
        if (unit == 'F/L^2') name = trim(self%stress())
    end function named

end module unit_names
