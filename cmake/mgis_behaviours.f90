!> Writes the behaviours of mgis.c, two a law, from the library's tables of constants:
!>
!>     BEHAVIOURS(StickSlipCoulomb, , 2, 1, "Friction")
!>     BEHAVIOURS(StickSlipCoulomb, WithOptions, 2, 6, "Friction", "ShearCap", ...)
!>
!> name, rest of the name, number of the law, how many constants follow the stiffnesses, their
!> names. A host has to give every material property of a behaviour: the first takes the constants
!> that have no default, the second all of them.
program mgis_behaviours
    use friction_mod, only : constant_table, friction_constants, friction_law_count, &
        friction_law_name, prop_alpha_t
    implicit none

    type(constant_table) :: table
    integer :: law, needed

    do law = 1, friction_law_count
        table = friction_constants(law)
        needed = count(.not. table%of(:table%n)%optional)
        call write_behaviours(law, '', needed)
        call write_behaviours(law, 'WithOptions', table%n)
    end do

contains

    !> The behaviours of a law that take the first constants of its table.
    subroutine write_behaviours(law, ending, n)
        integer, intent(in) :: law               !! its number
        character(len=*), intent(in) :: ending   !! of their names
        integer, intent(in) :: n                 !! how many numbers `props` has
        integer :: place

        write (*, '(5a, i0, a, i0)', advance='no') 'BEHAVIOURS(StickSlip', &
            without_underscores(friction_law_name(law)), ', ', ending, ', ', law, ', ', &
            n - prop_alpha_t
        do place = prop_alpha_t + 1, n
            write (*, '(3a)', advance='no') ', "', trim(table%of(place)%long_name), '"'
        end do
        print '(a)', ')'
    end subroutine write_behaviours

    !> 'RateAndState' for 'rate_and_state'.
    pure function without_underscores(name) result(text)
        character(len=*), intent(in) :: name
        character(len=:), allocatable :: text
        integer :: i

        text = ''
        do i = 1, len_trim(name)
            if (name(i:i) == '_') cycle
            if (i == 1) then
                text = text // achar(iachar(name(i:i)) - 32)
            else if (name(i - 1:i - 1) == '_') then
                text = text // achar(iachar(name(i:i)) - 32)
            else
                text = text // name(i:i)
            end if
        end do
    end function without_underscores

end program mgis_behaviours
