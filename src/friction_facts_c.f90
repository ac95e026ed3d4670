!> C interface to what is to be known about the laws (module friction_law_facts): functions and
!> structures of include/friction.h.
module friction_facts_c
    use, intrinsic :: iso_c_binding, only : c_associated, c_char, c_double, c_f_pointer, c_int, &
        c_null_char, c_ptr
    use friction_kinds, only : largest
    use friction_law_texts, only : default_text, is_blank
    use friction_mod, only : friction_bad_law, friction_bad_property, friction_bad_size, &
        friction_check, friction_constants, friction_default, friction_internal_variable, &
        friction_law_count, friction_law_name, friction_law_of, friction_law_summary, &
        friction_null_pointer, friction_ok, constant_table, internal_variable, rule_text, &
        text_length
    implicit none
    private

    public :: c_check, c_constant_facts, c_default, c_law_count, c_law_facts, c_law_summary

    !> `friction_law_facts` of include/friction.h.
    type, bind(C) :: law_record
        character(kind=c_char) :: name(24), internal(16), internal_unit(8)
        integer(c_int) :: has_internal, constants
    end type law_record

    !> `friction_constant_facts` of include/friction.h.
    type, bind(C) :: constant_record
        character(kind=c_char) :: name(24), unit(8), meaning(72), rule(104), default_text(24), &
            words(72)
        real(c_double) :: lower, upper
        integer(c_int) :: optional, choice
    end type constant_record

contains

    !> `friction_law_count` of include/friction.h.
    pure function c_law_count() result(count) bind(C, name='friction_law_count')
        integer(c_int) :: count

        count = friction_law_count
    end function c_law_count

    !> `friction_get_law` of include/friction.h.
    function c_law_facts(law, facts) result(status) bind(C, name='friction_get_law')
        integer(c_int), value, intent(in) :: law   !! its number
        type(c_ptr), value, intent(in) :: facts    !! out
        integer(c_int) :: status
        type(law_record), pointer :: record
        type(internal_variable) :: internal
        type(constant_table) :: table

        status = friction_null_pointer
        if (.not. c_associated(facts)) return
        status = friction_bad_law
        if (law < 1 .or. law > friction_law_count) return
        call c_f_pointer(facts, record)
        internal = friction_internal_variable(law)
        call to_c(friction_law_name(law), record%name)
        call to_c(internal%name, record%internal)
        call to_c(internal%unit, record%internal_unit)
        record%has_internal = merge(1, 0, internal%exists)
        table = friction_constants(law)
        record%constants = table%n
        status = friction_ok
    end function c_law_facts

    !> `friction_get_law_summary` of include/friction.h.
    function c_law_summary(law, length, text) result(status) &
        bind(C, name='friction_get_law_summary')
        integer(c_int), value, intent(in) :: law      !! its number
        integer(c_int), value, intent(in) :: length   !! characters that `text` has room for
        type(c_ptr), value, intent(in) :: text        !! out
        integer(c_int) :: status
        character(kind=c_char), pointer :: text_(:)

        status = friction_null_pointer
        if (.not. c_associated(text)) return
        status = friction_bad_law
        if (law < 1 .or. law > friction_law_count) return
        status = friction_bad_size
        if (length < 1) return
        call c_f_pointer(text, text_, [length])
        call to_c(friction_law_summary(law), text_)
        status = friction_ok
    end function c_law_summary

    !> `friction_get_constant` of include/friction.h.
    function c_constant_facts(law, place, facts) result(status) &
        bind(C, name='friction_get_constant')
        integer(c_int), value, intent(in) :: law     !! number of the law
        integer(c_int), value, intent(in) :: place   !! in props, counted from 0
        type(c_ptr), value, intent(in) :: facts      !! out
        integer(c_int) :: status
        type(constant_record), pointer :: record
        type(constant_table) :: table

        status = friction_null_pointer
        if (.not. c_associated(facts)) return
        status = friction_bad_law
        if (law < 1 .or. law > friction_law_count) return
        table = friction_constants(law)
        status = friction_bad_size
        if (place < 0 .or. place >= table%n) return
        call c_f_pointer(facts, record)
        associate (this => table%of(place + 1))
            call to_c(this%name, record%name)
            call to_c(this%unit, record%unit)
            call to_c(this%meaning, record%meaning)
            call to_c(rule_text(table, place + 1), record%rule)
            call to_c(default_text(table, place + 1), record%default_text)
            call to_c(this%words, record%words)
            record%lower = this%lower
            record%upper = min(this%upper, largest)
            record%optional = merge(1, 0, this%optional)
            record%choice = merge(1, 0, this%whole)
        end associate
        status = friction_ok
    end function c_constant_facts

    !> `friction_get_default` of include/friction.h.
    function c_default(nprops, props, place, default) result(status) &
        bind(C, name='friction_get_default')
        integer(c_int), value, intent(in) :: nprops   !! how many constants are known
        type(c_ptr), value, intent(in) :: props       !! nprops numbers
        integer(c_int), value, intent(in) :: place    !! in props, counted from 0
        type(c_ptr), value, intent(in) :: default     !! a number, out
        integer(c_int) :: status
        real(c_double), pointer :: props_(:), default_
        type(constant_table) :: table

        status = friction_null_pointer
        if (.not. (c_associated(props) .and. c_associated(default))) return
        status = friction_bad_size
        if (nprops < 1) return
        call c_f_pointer(props, props_, [nprops])
        status = friction_bad_law
        table = friction_constants(friction_law_of(props_))
        if (table%n == 0) return
        status = friction_bad_size
        if (place < 0 .or. place >= table%n) return
        status = friction_bad_property
        if (.not. table%of(place + 1)%optional) return
        if (max(table%of(place + 1)%default_from, table%of(place + 1)%default_per) > nprops) return
        call c_f_pointer(default, default_)
        default_ = friction_default(props_, place + 1)
        status = friction_ok
    end function c_default

    !> `friction_check` of include/friction.h.
    function c_check(nprops, props, length, text) result(status) bind(C, name='friction_check')
        integer(c_int), value, intent(in) :: nprops   !! number of constants
        type(c_ptr), value, intent(in) :: props       !! nprops numbers
        integer(c_int), value, intent(in) :: length   !! characters that `text` has room for
        type(c_ptr), value, intent(in) :: text        !! out
        integer(c_int) :: status
        real(c_double), pointer :: props_(:)
        character(kind=c_char), pointer :: text_(:)
        character(len=text_length) :: broken
        integer :: place

        status = friction_null_pointer
        if (.not. (c_associated(props) .and. (c_associated(text) .or. length == 0))) return
        status = friction_bad_size
        if (min(nprops, length) < 0) return
        call c_f_pointer(props, props_, [nprops])
        call friction_check(props_, place, broken, status)
        if (length == 0) return
        call c_f_pointer(text, text_, [length])
        call to_c(broken, text_)
    end function c_check

    !> A text as C keeps it, without the blanks at its end, and cut where there is no more room.
    pure subroutine to_c(from, to)
        character(len=*), intent(in) :: from
        character(kind=c_char), intent(inout) :: to(:)
        integer :: i, length

        length = 0
        do i = 1, len(from)
            if (.not. is_blank(from(i:i))) length = i
        end do
        to = c_null_char
        do i = 1, min(length, size(to) - 1)
            to(i) = from(i:i)
        end do
    end subroutine to_c

end module friction_facts_c
