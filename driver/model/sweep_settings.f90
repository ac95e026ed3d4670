!> What a sweep is told to do: the keys and the values that they take, and the settings of every
!> combination.
module sweep_settings
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use run_settings, only : settings
    implicit none
    private

    public :: sweep_axis, sweep_plan

    !> A key of the input, and the values that it takes one after the other.
    type :: sweep_axis
        character(len=:), allocatable :: name         !! group%key
        character(len=:), allocatable :: group, key
        character(len=:), allocatable :: source       !! the key of &sweep with the values
        real(dp), allocatable :: values(:)
    end type sweep_axis

    !> All combinations of the values of one or two keys. The values of the last key change fastest.
    type :: sweep_plan
        type(sweep_axis), allocatable :: axes(:)      !! one or two
        type(settings), allocatable :: runs(:)        !! one a combination
        character(len=:), allocatable :: input        !! what all combinations have in common
    contains
        procedure :: place, point
    end type sweep_plan

contains

    !> Which value of each key belongs to a combination?
    pure function place(self, combination) result(places)
        class(sweep_plan), intent(in) :: self
        integer, intent(in) :: combination            !! from 1
        integer, allocatable :: places(:)
        integer :: rest, i

        allocate (places(size(self%axes)))
        rest = combination - 1
        do i = size(self%axes), 1, -1
            places(i) = 1 + mod(rest, size(self%axes(i)%values))
            rest = rest / size(self%axes(i)%values)
        end do
    end function place

    !> The values of the keys in a combination.
    pure function point(self, combination) result(values)
        class(sweep_plan), intent(in) :: self
        integer, intent(in) :: combination            !! from 1
        real(dp), allocatable :: values(:)
        integer :: places(size(self%axes)), i

        places = self%place(combination)
        values = [(self%axes(i)%values(places(i)), i = 1, size(self%axes))]
    end function point

end module sweep_settings
