!> Which mutant a test runs (tests/mutants.py), and notes of a run without one.
module mutant_switch_kernel
    use, intrinsic :: iso_c_binding, only : c_bool, c_int
    implicit none
    public
    private :: c_bool, c_int

    integer, parameter :: mutant_bool = c_bool
    integer, parameter :: mutant_double = selected_real_kind(15)
    integer, parameter :: mutant_quad = selected_real_kind(30)
    !> Its number; 0: none; -1: take notes.
    integer(c_int), bind(c, name='stickslip_mutant') :: mutant

    interface
        !> The statement of these mutants was reached.
        pure subroutine mutant_reached(first, last) bind(c)
            import :: c_int
            implicit none
            integer(c_int), value :: first, last
        end subroutine mutant_reached

        !> The mutant would have had another value.
        pure subroutine mutant_differs(number) bind(c)
            import :: c_int
            implicit none
            integer(c_int), value :: number
        end subroutine mutant_differs

        !> Whether the mutant's value may be asked for.
        pure function mutant_may(number) result(may) bind(c)
            import :: c_bool, c_int
            implicit none
            integer(c_int), value :: number
            logical(c_bool) :: may
        end function mutant_may

        !> As `mutant_reached`, within a condition; false.
        pure function mutant_seen(first, last) result(no) bind(c)
            import :: c_bool, c_int
            implicit none
            integer(c_int), value :: first, last
            logical(c_bool) :: no
        end function mutant_seen

        !> As `mutant_differs`, within a condition; false.
        pure function mutant_noted(number, differs) result(no) bind(c)
            import :: c_bool, c_int
            implicit none
            integer(c_int), value :: number
            logical(c_bool), value :: differs
            logical(c_bool) :: no
        end function mutant_noted
    end interface

    !> Whether two values differ; NaN differs from all.
    interface mutant_other
        module procedure other_double, other_doubles, other_quad, other_quads, other_integer, &
            other_logical
    end interface mutant_other

contains

    pure function other_double(a, b) result(other)
        real(mutant_double), intent(in) :: a, b
        logical :: other

        other = a /= b
    end function other_double

    pure function other_doubles(a, b) result(other)
        real(mutant_double), intent(in) :: a(:), b(:)
        logical :: other

        other = any(a /= b)
    end function other_doubles

    pure function other_quad(a, b) result(other)
        real(mutant_quad), intent(in) :: a, b
        logical :: other

        other = a /= b
    end function other_quad

    pure function other_quads(a, b) result(other)
        real(mutant_quad), intent(in) :: a(:), b(:)
        logical :: other

        other = any(a /= b)
    end function other_quads

    pure function other_integer(a, b) result(other)
        integer, intent(in) :: a, b
        logical :: other

        other = a /= b
    end function other_integer

    pure function other_logical(a, b) result(other)
        logical, intent(in) :: a, b
        logical :: other

        other = a .neqv. b
    end function other_logical

end module mutant_switch_kernel
