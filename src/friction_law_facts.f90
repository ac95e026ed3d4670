!> What is to be known about the laws and their constants: for readers of input, and for those who
!> choose steps, tolerances and first values. Reached through module friction_mod.
!>
!> About a law, by its number (an update is not needed, nor are values):
!>
!>     friction_law_count                    laws are numbered from 1 to this
!>     friction_law_name(law)                'subloading', ...; '' if there is none
!>     friction_law_summary(law)             what the law is, in words
!>     friction_law_number(name)             0 if there is none
!>     friction_constants(law)               table of all its constants, by their places in `props`
!>     friction_place(law, name)             place of a constant in `props`, 0 if there is none
!>     friction_internal_variable(law)       name, unit, and whether there is one
!>
!> About values, in the order of `props`:
!>
!>     friction_law_of(props)                number of the law, 0 if there is none
!>     friction_default(props, place)        the default of a constant, by those before it
!>     friction_check(props, ...)            which constant breaks which rule
!>     friction_facts(props)                 coefficients, stiffnesses, cap, time, order of accuracy
!>     friction_healing_rate(props, statev)         growth of the coefficient at rest
!>     friction_coefficient_change(traits, ...)     what a changed state means to friction later
module friction_law_facts
    use friction_kinds, only : largest, wp
    use friction_law, only : internal_variable, law_state, law_traits, named_law, &
        no_internal_variable, summary_length
    use friction_law_choice, only : choose_own_law, law_count, law_descriptions, law_storage, &
        option_constants, options_of, prop_alpha_n, prop_alpha_t, prop_law, &
        spring_constants, surface_options, whole_number
    use friction_law_constants, only : constant_table, default_value, law_constant, name_length
    use friction_law_texts, only : broken_rule, is_blank, put, put_word, rule_text, same_text, &
        text_length, text_line, word_of
    use friction_status, only : friction_bad_law, friction_bad_property, friction_bad_size, &
        friction_ok
    implicit none
    private

    public :: friction_check, friction_coefficient_change, friction_constants, friction_default, &
        friction_facts, friction_healing_rate, friction_internal_variable, friction_law_name, &
        friction_law_number, friction_law_of, friction_law_summary, friction_place, &
        broken_rule, constant_table, internal_variable, law_constant, law_facts, rule_text, &
        text_length, word_of

    integer, parameter, public :: friction_law_count = law_count

    !> What a law with its constants says about friction.
    type :: law_facts
        integer :: law = 0                       !! its number; 0: these constants are refused
        real(wp) :: alpha_n = 0.0_wp             !! normal contact stiffness [F/L^3]
        real(wp) :: alpha_t = 0.0_wp             !! tangential contact stiffness [F/L^3]
        real(wp) :: shear_cap = huge(1.0_wp)     !! largest tangential traction; huge: none [F/L^2]
        real(wp) :: cohesion = 0.0_wp            !! tangential traction that is carried without
                                                 !! pressure [F/L^2]
        real(wp) :: typical_coefficient = 0.0_wp !! that stands for the strength of the contact: the
                                                 !! static one, or that of steady sliding at the
                                                 !! reference rate [-]
        real(wp) :: largest_coefficient = 0.0_wp !! the most that friction can be while the surface
                                                 !! rests; huge where there is no such bound [-]
        real(wp) :: kinetic_coefficient = 0.0_wp !! that is left when the surface has slid far,
                                                 !! where it is a constant; else the typical
                                                 !! one [-]
        real(wp) :: rate_weakening = 0.0_wp      !! how fast the coefficient falls with the slip
                                                 !! rate when slip begins; 0 where it does not
                                                 !! depend on it then [T/L]
        real(wp) :: virgin_mu = 0.0_wp           !! statev(5) of a virgin point [-]
        real(wp) :: virgin_internal = 0.0_wp     !! statev(6) of a virgin point
        real(wp) :: damping = 0.0_wp             !! tangential contact damping [F T/L^3]
        logical :: needs_time = .false.          !! the traction depends on a rate: an increment
                                                 !! that shears a closed contact needs dtime > 0
        logical :: is_orthotropic = .false.      !! it depends on the direction of sliding
        integer :: order = 1                     !! of accuracy, in the length of an increment
        type(law_traits) :: traits               !! what it remembers, and how slip starts
    end type law_facts

contains

    !> The name of a law, as in the program's input: '' if there is none.
    pure function friction_law_name(law) result(name)
        integer, intent(in) :: law               !! its number
        character(len=name_length) :: name

        name = ' '
        if (law >= 1 .and. law <= law_count) name = law_descriptions(law)%name
    end function friction_law_name

    !> What a law is, in words: '' if there is none.
    pure function friction_law_summary(law) result(summary)
        integer, intent(in) :: law                   !! its number
        character(len=summary_length) :: summary

        summary = ' '
        if (law >= 1 .and. law <= law_count) summary = law_descriptions(law)%summary
    end function friction_law_summary

    !> The number of a law: 0 if there is none of that name.
    pure function friction_law_number(name) result(law)
        character(len=*), intent(in) :: name
        integer :: law

        do law = law_count, 1, -1
            if (same_text(friction_law_name(law), name)) return
        end do
    end function friction_law_number

    !> The number of the law that constants belong to: 0 if there is none.
    pure function friction_law_of(props) result(law)
        real(wp), intent(in) :: props(:)   !! constants of the friction routine, finite
        integer :: law

        law = 0
        if (size(props) > 0) law = max(0, whole_number(props(prop_law)))
        if (law > law_count) law = 0
    end function friction_law_of

    !> All constants of a law by their places in `props`, the number of the law first and its
    !> options last; none, if there is no such law. References to other constants are such places.
    pure function friction_constants(law) result(table)
        integer, intent(in) :: law                      !! its number
        type(constant_table) :: table

        if (law < 1 .or. law > law_count) return
        table%n = prop_law
        table%of(prop_law) = law_constant('law', '-', 'number of the law', lower=1.0_wp, &
            upper=real(law_count, wp))
        call append(table, spring_constants)
        associate (own => law_descriptions(law)%constants)
            call append(table, own%of(:own%n))
        end associate
        call append(table, option_constants)
    end function friction_constants

    !> Adds constants whose references to each other count from their own first one.
    pure subroutine append(table, more)
        type(constant_table), intent(inout) :: table
        type(law_constant), intent(in) :: more(:)
        integer :: i, by

        by = table%n
        do i = 1, size(more)
            table%n = table%n + 1
            associate (this => table%of(table%n))
                this = more(i)
                call move(this%not_below, by)
                call move(this%not_above, by)
                call move(this%not_beside, by)
                call move(this%default_from, by)
                call move(this%default_per, by)
            end associate
        end do
    end subroutine append

    pure subroutine move(place, by)
        integer, intent(inout) :: place   !! of another constant; 0: none
        integer, intent(in) :: by

        if (place > 0) place = place + by
    end subroutine move

    !> The place of a constant in `props`: 0 if the law has none of that name.
    pure function friction_place(law, name) result(place)
        integer, intent(in) :: law                !! number of the law
        character(len=*), intent(in) :: name      !! of the constant
        integer :: place
        type(constant_table) :: table

        table = friction_constants(law)
        do place = table%n, 1, -1
            if (same_text(table%of(place)%name, name)) return
        end do
    end function friction_place

    !> The internal variable of a law, which is kept in statev(6).
    pure function friction_internal_variable(law) result(variable)
        integer, intent(in) :: law                !! number of the law
        type(internal_variable) :: variable       !! 'R', and none, if there is no such law

        variable = no_internal_variable
        if (law >= 1 .and. law <= law_count) variable = law_descriptions(law)%internal
    end function friction_internal_variable

    !> The value of a constant that is left out; 0 if it has no default.
    pure function friction_default(props, place) result(value)
        real(wp), intent(in) :: props(:)   !! constants up to that place at least; those that the
                                           !! default depends on count
        integer, intent(in) :: place
        real(wp) :: value
        type(constant_table) :: table

        value = 0.0_wp
        table = friction_constants(friction_law_of(props))
        if (place < 1 .or. place > table%n) return
        if (max(table%of(place)%default_from, table%of(place)%default_per) > size(props)) return
        value = default_value(table%of(place), props)
    end function friction_default

    !> Do the constants obey the rules of their law? If not, the first that does not. Whatever
    !> passes here is not refused by an update either.
    pure subroutine friction_check(props, place, text, status)
        real(wp), intent(in) :: props(:)
        integer, intent(out) :: place                      !! of the constant; 0 where no single one
                                                           !! is at fault
        character(len=text_length), intent(out) :: text    !! 'm must be > 0', ...; blank if ok
        integer, intent(out) :: status   !! ok, bad size, bad law, or bad property
        type(constant_table) :: table
        type(law_storage), target :: storage
        class(named_law), pointer :: own
        real(wp) :: full(size(table%of))
        type(text_line) :: line

        status = friction_bad_property
        text = 'the constants must be finite numbers, up to 1.7e100'
        do place = 1, size(props)
            if (.not. usable(props(place))) return
        end do
        place = 0
        status = friction_bad_law
        text = 'the first constant must be the number of a law'
        table = friction_constants(friction_law_of(props))
        if (table%n == 0) return
        full = 0.0_wp
        do place = 1, table%n
            if (place <= size(props)) then
                full(place) = props(place)
            else if (table%of(place)%optional) then
                full(place) = default_value(table%of(place), full)
            else
                status = friction_bad_size
                call put_word(line, table%of(place)%name)
                call put(line, ' is missing')
                text = line%text
                return
            end if
        end do
        status = friction_bad_property
        do place = 1, table%n
            text = broken_rule(table, place, full)
            if (is_blank(text(1:1))) cycle
            call put_word(line, table%of(place)%name)
            call put(line, ' ')
            call put(line, text)
            text = line%text
            return
        end do
        call choose_own_law(size(props), props, storage, own, place, status)
        place = 0
        text = ' '
        if (status < 0) text = 'the constants are too far apart in size for the arithmetic'
    end subroutine friction_check

    !> Is a number finite and not too large? Silent where a comparison with NaN raises a
    !> floating-point exception.
    pure function usable(x)
        real(wp), intent(in) :: x
        logical :: usable

        usable = exponent(x) <= exponent(largest)
    end function usable

    !> What the law says about friction.
    pure function friction_facts(props) result(known)
        real(wp), intent(in) :: props(:)   !! constants in the order of the friction routine, finite
        type(law_facts) :: known
        type(law_storage), target :: storage
        class(named_law), pointer :: own
        type(law_state) :: virgin
        type(surface_options) :: options
        integer :: place, status
        character(len=text_length) :: text

        call friction_check(props, place, text, status)
        if (status < 0) return
        call choose_own_law(size(props), props, storage, own, place, status)
        known%law = friction_law_of(props)
        known%alpha_n = props(prop_alpha_n)
        known%alpha_t = props(prop_alpha_t)
        if (size(props) >= place) then
            call options_of(size(props) - place + 1, props(place:), options, status)
            if (options%tau_max > 0.0_wp) known%shear_cap = options%tau_max
            known%is_orthotropic = abs(options%plane%squeeze - 1.0_wp) > 0.0_wp
            known%cohesion = options%cohesion
            known%damping = options%damping
        end if
        known%typical_coefficient = own%typical_coefficient()
        known%largest_coefficient = own%largest_coefficient()
        known%kinetic_coefficient = own%kinetic_coefficient()
        known%rate_weakening = own%rate_weakening()
        virgin = own%virgin()
        known%virgin_mu = virgin%mu
        known%virgin_internal = virgin%r
        known%needs_time = own%needs_time() .or. known%damping > 0.0_wp
        known%order = own%order()
        known%traits = own%traits()
        if (known%shear_cap < huge(1.0_wp)) known%order = 1   ! dissipation is booked in first order
        if (known%damping > 0.0_wp) known%order = 1   ! the damper by backward Euler
    end function friction_facts

    !> How fast the friction coefficient in the state of a point grows while the surface rests.
    pure function friction_healing_rate(props, statev) result(rate)
        real(wp), intent(in) :: props(:)    !! constants of the friction routine, finite
        real(wp), intent(in) :: statev(:)   !! state of the point; size 8
        real(wp) :: rate                    !! 0 for constants that are refused [1/T]
        type(law_storage), target :: storage
        class(named_law), pointer :: own
        integer :: place, status

        rate = 0.0_wp
        call choose_own_law(size(props), props, storage, own, place, status)
        if (status == friction_ok) rate = own%healing_rate(law_state(mu=statev(5), r=statev(6)))
    end function friction_healing_rate

    !> What a change of the state of a point means to its friction coefficient later, in first
    !> order. The coefficient itself may jump, where slip or a shear cap begins to rule it; what the
    !> law remembers does not.
    elemental function friction_coefficient_change(traits, internal, mu_change, internal_change) &
        result(difference)
        type(law_traits), intent(in) :: traits
        real(wp), intent(in) :: internal          !! statev(6) of the point
        real(wp), intent(in) :: mu_change         !! of statev(5) [-]
        real(wp), intent(in) :: internal_change   !! of statev(6)
        real(wp) :: difference                    !! >= 0 [-]

        difference = 0.0_wp
        if (traits%memory == 1) difference = traits%weight * abs(mu_change)
        if (traits%memory /= 2 .or. internal >= traits%kink) return
        difference = traits%weight * abs(internal_change)
        if (traits%logarithmic) difference = difference / internal
    end function friction_coefficient_change

end module friction_law_facts
