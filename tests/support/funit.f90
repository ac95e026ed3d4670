!> Stand-in for pFUnit's module `funit`, for machines where pFUnit is not installed: only what the
!> tests use.
module funit
    use, intrinsic :: iso_fortran_env, only : error_unit, output_unit, real64
    implicit none
    private

    public :: anyExceptions, assertEqual, assertFalse, assertGreaterThan, &
        assertGreaterThanOrEqual, assertLessThan, assertLessThanOrEqual, assertTrue, at, begin, &
        finish, report

    interface assertEqual
        module procedure equal_integer, equal_real, equal_real_vector, equal_real_matrix, &
            equal_string
    end interface assertEqual

    interface assertLessThan
        module procedure less_real, less_integer
    end interface assertLessThan

    interface assertLessThanOrEqual
        module procedure less_or_equal_real, less_or_equal_integer
    end interface assertLessThanOrEqual

    interface assertGreaterThan
        module procedure greater_real, greater_integer
    end interface assertGreaterThan

    interface assertGreaterThanOrEqual
        module procedure greater_or_equal_real
    end interface assertGreaterThanOrEqual

    character(len=:), allocatable :: current   !! name of the running test
    integer :: line = 0                        !! line of the assertion in the .pf file
    integer :: run = 0, failed = 0
    logical :: failing = .false.               !! the running test has failed

contains

    subroutine begin(name)
        character(len=*), intent(in) :: name

        current = name
        failing = .false.
        run = run + 1
    end subroutine begin

    subroutine finish()
        if (failing) failed = failed + 1
        write (output_unit, '(2a)') merge('FAILED  ', 'ok      ', failing), current
        flush (output_unit)
    end subroutine finish

    subroutine report(module_name)
        character(len=*), intent(in) :: module_name

        write (output_unit, '(2a, i0, a, i0, a)') module_name, ' (stand-in): ', run, ' tests, ', &
            failed, ' failed'
        flush (output_unit)
        if (failed > 0) stop 1
    end subroutine report

    subroutine at(number)
        integer, intent(in) :: number

        line = number
    end subroutine at

    function anyExceptions() result(any_failure)
        logical :: any_failure

        any_failure = failing
    end function anyExceptions

    subroutine check(holds, what, message)
        logical, intent(in) :: holds
        character(len=*), intent(in) :: what
        character(len=*), intent(in), optional :: message

        if (holds) return
        failing = .true.
        write (error_unit, '(3a, i0, 2a)') '  in ', current, ', line ', line, ': ', what
        if (present(message)) write (error_unit, '(2a)') '    ', message
    end subroutine check

    subroutine assertTrue(condition, message)
        logical, intent(in) :: condition
        character(len=*), intent(in), optional :: message

        call check(condition, 'expected true', message)
    end subroutine assertTrue

    subroutine assertFalse(condition, message)
        logical, intent(in) :: condition
        character(len=*), intent(in), optional :: message

        call check(.not. condition, 'expected false', message)
    end subroutine assertFalse

    subroutine equal_integer(expected, found, message)
        integer, intent(in) :: expected, found
        character(len=*), intent(in), optional :: message

        call check(expected == found, 'expected ' // text_i(expected) // ', found ' &
            // text_i(found), message)
    end subroutine equal_integer

    subroutine equal_string(expected, found, message)
        character(len=*), intent(in) :: expected, found
        character(len=*), intent(in), optional :: message

        call check(expected == found, "expected '" // expected // "', found '" // found // "'", &
            message)
    end subroutine equal_string

    subroutine equal_real(expected, found, tolerance, message)
        real(real64), intent(in) :: expected, found
        real(real64), intent(in), optional :: tolerance
        character(len=*), intent(in), optional :: message

        call check(close_to(expected, found, tolerance), &
            'expected ' // text_r(expected) // ', found ' // text_r(found), message)
    end subroutine equal_real

    subroutine equal_real_vector(expected, found, tolerance, message)
        real(real64), intent(in) :: expected(:), found(:)
        real(real64), intent(in), optional :: tolerance
        character(len=*), intent(in), optional :: message
        integer :: i

        call check(size(expected) == size(found), 'sizes differ', message)
        if (failing) return
        do i = 1, size(expected)
            call check(close_to(expected(i), found(i), tolerance), &
                'element ' // text_i(i) // ': expected ' // text_r(expected(i)) // ', found ' &
                // text_r(found(i)), message)
        end do
    end subroutine equal_real_vector

    subroutine equal_real_matrix(expected, found, tolerance, message)
        real(real64), intent(in) :: expected(:, :), found(:, :)
        real(real64), intent(in), optional :: tolerance
        character(len=*), intent(in), optional :: message

        call check(all(shape(expected) == shape(found)), 'shapes differ', message)
        if (failing) return
        call equal_real_vector(reshape(expected, [size(expected)]), reshape(found, [size(found)]), &
            tolerance, message)
    end subroutine equal_real_matrix

    subroutine less_real(a, b, message)
        real(real64), intent(in) :: a, b
        character(len=*), intent(in), optional :: message

        call check(a < b, text_r(a) // ' is not less than ' // text_r(b), message)
    end subroutine less_real

    subroutine less_integer(a, b, message)
        integer, intent(in) :: a, b
        character(len=*), intent(in), optional :: message

        call check(a < b, text_i(a) // ' is not less than ' // text_i(b), message)
    end subroutine less_integer

    subroutine less_or_equal_real(a, b, message)
        real(real64), intent(in) :: a, b
        character(len=*), intent(in), optional :: message

        call check(a <= b, text_r(a) // ' is greater than ' // text_r(b), message)
    end subroutine less_or_equal_real

    subroutine less_or_equal_integer(a, b, message)
        integer, intent(in) :: a, b
        character(len=*), intent(in), optional :: message

        call check(a <= b, text_i(a) // ' is greater than ' // text_i(b), message)
    end subroutine less_or_equal_integer

    subroutine greater_real(a, b, message)
        real(real64), intent(in) :: a, b
        character(len=*), intent(in), optional :: message

        call check(a > b, text_r(a) // ' is not greater than ' // text_r(b), message)
    end subroutine greater_real

    subroutine greater_integer(a, b, message)
        integer, intent(in) :: a, b
        character(len=*), intent(in), optional :: message

        call check(a > b, text_i(a) // ' is not greater than ' // text_i(b), message)
    end subroutine greater_integer

    subroutine greater_or_equal_real(a, b, message)
        real(real64), intent(in) :: a, b
        character(len=*), intent(in), optional :: message

        call check(a >= b, text_r(a) // ' is less than ' // text_r(b), message)
    end subroutine greater_or_equal_real

    !> False for NaN, on either side.
    function close_to(expected, found, tolerance) result(near)
        real(real64), intent(in) :: expected, found
        real(real64), intent(in), optional :: tolerance
        logical :: near
        real(real64) :: allowed

        allowed = 0.0_real64
        if (present(tolerance)) allowed = tolerance
        near = abs(expected - found) <= allowed
    end function close_to

    function text_i(number) result(text)
        integer, intent(in) :: number
        character(len=:), allocatable :: text
        character(len=20) :: buffer

        write (buffer, '(i0)') number
        text = trim(buffer)
    end function text_i

    function text_r(number) result(text)
        real(real64), intent(in) :: number
        character(len=:), allocatable :: text
        character(len=30) :: buffer

        write (buffer, '(es24.16e3)') number
        text = trim(adjustl(buffer))
    end function text_r

end module funit
