!> Every law with constants for tests: tests/law_constants.csv.
module law_examples
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use friction_mod, only : friction_law_name, friction_place, law_flash_heating, &
        law_linker_dieterich, law_rate_state
    implicit none
    private

    public :: creeps, example_constants

contains

    !> Does its coefficient follow the slip rate? Such a surface slides on under what it carries,
    !> also at rest, and `mu` of its state is for the reader.
    pure function creeps(law)
        integer, intent(in) :: law   !! its number
        logical :: creeps

        creeps = any(law == [law_rate_state, law_flash_heating, law_linker_dieterich])
    end function creeps

    !> All constants of a law, those of options included, in the order of `props`. Tests run in
    !> tests/unit.
    function example_constants(law) result(props)
        integer, intent(in) :: law   !! its number
        real(dp), allocatable :: props(:)
        character(len=32) :: name, constant
        real(dp) :: value
        integer :: unit, place, status

        allocate (props(friction_place(law, 'eta_t')))   ! which is the last
        props = -1.0_dp
        props(1) = law
        open (newunit=unit, file='../law_constants.csv', action='read', status='old')
        read (unit, *)
        do
            read (unit, *, iostat=status) name, constant, value
            if (status /= 0) exit
            if (name /= 'every' .and. name /= friction_law_name(law)) cycle
            place = friction_place(law, trim(constant))
            if (place > 0) props(place) = value
        end do
        close (unit)
    end function example_constants

end module law_examples
