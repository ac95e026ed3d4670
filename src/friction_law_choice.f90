!> Which law, from the constants in `props`: the one place where laws are chosen, and the one table
!> of where constants stand.
module friction_law_choice
    use friction_anisotropy, only : isotropic, orthotropy, orthotropy_constants, read_orthotropy
    use friction_cohesion, only : cohesion_constants, cohesive_law
    use friction_coulomb_law, only : coulomb_description, coulomb_law
    use friction_flash_heating_law, only : flash_heating_description, flash_heating_law
    use friction_kinds, only : wp
    use friction_law, only : law, law_description, named_law
    use friction_linker_dieterich_law, only : linker_dieterich_description, linker_dieterich_law
    use friction_law_constants, only : law_constant, positive
    use friction_rate_state_law, only : rate_state_description, rate_state_law
    use friction_shear_cap, only : cap_constants, capped_law
    use friction_slip_weakening_healing_law, only : healing_description, &
        slip_weakening_healing_law
    use friction_slip_weakening_law, only : slip_weakening_description, slip_weakening_law
    use friction_static_kinetic_law, only : static_kinetic_description, static_kinetic_law
    use friction_status, only : friction_bad_law, friction_bad_property, friction_ok
    use friction_subloading_exact_law, only : subloading_exact_law
    use friction_subloading_general_law, only : subloading_general_law
    use friction_subloading_law, only : scheme_exact_rate, subloading_description, &
        subloading_law, u_logarithm
    implicit none
    private

    public :: choose_law, choose_own_law, find_rate_law, law_storage, options_of, &
        surface_options, whole_number

    !> Laws: values of props(1).
    integer, parameter, public :: law_subloading = 1
    integer, parameter, public :: law_coulomb = 2
    integer, parameter, public :: law_static_kinetic = 3
    integer, parameter, public :: law_rate_state = 4
    integer, parameter, public :: law_slip_weakening = 5
    integer, parameter, public :: law_slip_weakening_healing = 6
    integer, parameter, public :: law_flash_heating = 7
    integer, parameter, public :: law_linker_dieterich = 8

    !> In the order of their numbers.
    type(law_description), parameter, public :: law_descriptions(*) = [ &
        subloading_description, coulomb_description, static_kinetic_description, &
        rate_state_description, slip_weakening_description, healing_description, &
        flash_heating_description, linker_dieterich_description]
    integer, parameter, public :: law_count = size(law_descriptions)   !! numbered from 1 to this

    !> Material constants: places in `props`. The law's own ones follow, then those of the options
    !> (`option_constants`).
    integer, parameter, public :: prop_law = 1, prop_alpha_n = 2, prop_alpha_t = 3
    integer, parameter, public :: first_own_prop = 4

    !> Of the springs of the contact, which stand before the law's own.
    type(law_constant), parameter, public :: spring_constants(2) = [ &
        law_constant('alpha_n', 'F/L^3', 'normal contact stiffness', 'NormalStiffness', &
        lower=positive), &
        law_constant('alpha_t', 'F/L^3', 'tangential contact stiffness', 'TangentialStiffness', &
        lower=positive)]

    !> Of the damper beside the tangential spring, which comes last.
    type(law_constant), parameter :: damper_constants(1) = [ &
        law_constant('eta_t', 'F T/L^3', 'tangential contact damping', 'TangentialDamping', &
        lower=0.0_wp, optional=.true.)]

    !> The options of every law, from the place behind its own constants on.
    integer, parameter :: option_cap = 1
    integer, parameter, public :: option_orthotropy = option_cap + size(cap_constants)
    integer, parameter :: option_cohesion = option_orthotropy + size(orthotropy_constants)
    integer, parameter :: option_damping = option_cohesion + size(cohesion_constants)
    integer, parameter :: option_count = option_damping + size(damper_constants) - 1
    type(law_constant), parameter, public :: option_constants(option_count) = [cap_constants, &
        orthotropy_constants, cohesion_constants, damper_constants]

    !> What the options say.
    type :: surface_options
        real(wp) :: tau_max        !! shear cap; 0: none [F/L^2]
        type(orthotropy) :: plane  !! how friction depends on the direction
        real(wp) :: cohesion       !! [F/L^2]
        real(wp) :: damping        !! of the damper beside the tangential spring [F T/L^3]
    end type surface_options

    !> Room for a law of whichever kind, of which one is in use.
    type :: law_storage
        class(named_law), pointer :: own   !! that one, without options
        type(subloading_law) :: subloading
        type(subloading_exact_law) :: exact
        type(subloading_general_law) :: general
        type(coulomb_law) :: coulomb
        type(static_kinetic_law) :: static_kinetic
        type(rate_state_law) :: rate_state
        type(slip_weakening_law) :: slip_weakening
        type(slip_weakening_healing_law) :: slip_weakening_healing
        type(flash_heating_law) :: flash_heating
        type(linker_dieterich_law) :: linker_dieterich
        type(cohesive_law) :: cohesive
        type(capped_law) :: capped
    end type law_storage

contains

    !> A law by its number, without constants as yet; null if there is none.
    pure subroutine find_law(number, storage, found)
        integer, intent(in) :: number
        type(law_storage), intent(inout), target :: storage
        class(named_law), pointer, intent(inout) :: found

        select case (number)
        case (law_subloading); found => storage%subloading
        case (law_coulomb); found => storage%coulomb
        case (law_static_kinetic); found => storage%static_kinetic
        case (law_rate_state); found => storage%rate_state
        case (law_slip_weakening); found => storage%slip_weakening
        case (law_slip_weakening_healing); found => storage%slip_weakening_healing
        case (law_flash_heating); found => storage%flash_heating
        case (law_linker_dieterich); found => storage%linker_dieterich
        case default; found => null()
        end select
    end subroutine find_law

    !> The same of the laws that tell a slip rate from the traction alone: rate-and-state friction.
    pure subroutine find_rate_law(number, storage, found)
        integer, intent(in) :: number
        type(law_storage), intent(inout), target :: storage
        class(rate_state_law), pointer, intent(inout) :: found

        select case (number)
        case (law_rate_state); found => storage%rate_state
        case (law_flash_heating); found => storage%flash_heating
        case (law_linker_dieterich); found => storage%linker_dieterich
        case default; found => null()
        end select
    end subroutine find_rate_law

    !> The law and its options from the constants.
    pure subroutine choose_law(nprops, props, storage, surface, options, status)
        integer, intent(in) :: nprops                        !! size
        real(wp), intent(in) :: props(nprops)                !! finite
        type(law_storage), intent(inout), target :: storage  !! where the law is kept
        class(law), pointer, intent(inout) :: surface        !! out: the law, if the status is ok
        type(surface_options), intent(out) :: options        !! of which those of the contact are to
                                                             !! be heeded by the caller
        integer, intent(out) :: status   !! ok, bad law, bad size, or bad property
        class(named_law), pointer :: own
        integer :: place

        call choose_own_law(nprops, props, storage, own, place, status)
        if (status < 0) return
        surface => own
        options%tau_max = 0.0_wp   ! one by one, as they are read
        options%plane%squeeze = 1.0_wp
        options%plane%associated = .false.
        options%cohesion = 0.0_wp
        options%damping = 0.0_wp
        if (nprops < place) return
        call options_of(nprops - place + 1, props(place:), options, status)
        if (status /= friction_ok) return
        if (max(options%tau_max, options%cohesion, options%damping) > 0.0_wp) then
            call take_options(options, storage, surface)
        end if
    end subroutine choose_law

    !> The law under a shear cap, with cohesion, on a contact with a damper.
    pure subroutine take_options(options, storage, surface)
        type(surface_options), intent(in) :: options
        type(law_storage), intent(inout), target :: storage   !! with the law without options
        class(law), pointer, intent(inout) :: surface         !! in: that, out: with options
        class(named_law), pointer :: own

        own => storage%own
        if (options%damping > 0.0_wp) own%follows_path = .false.   ! where it starts is not known
        if (options%cohesion > 0.0_wp) then
            own%cohesion = options%cohesion
            if (.not. own%mobilises_cohesion()) then
                storage%cohesive%cohesion = options%cohesion
                storage%cohesive%inner => own
                storage%cohesive%follows_path = .false.
                storage%cohesive%tau_max = own%tau_max
                own%cohesion = 0.0_wp
                surface => storage%cohesive
            end if
        end if
        if (options%tau_max > 0.0_wp) then
            storage%capped%tau_max = options%tau_max
            storage%capped%inner => surface
            storage%capped%follows_path = .false.   ! not proportional to the pressure
            storage%capped%cohesion = options%cohesion
            surface => storage%capped
        end if
    end subroutine take_options

    !> Reads the options.
    pure subroutine options_of(n, constants, options, status)
        integer, intent(in) :: n                        !! how many are given, 1 or more
        real(wp), intent(in) :: constants(n)            !! finite
        type(surface_options), intent(out) :: options   !! if the status is ok
        integer, intent(out) :: status                  !! ok or bad property

        status = friction_bad_property
        options%tau_max = constants(option_cap)
        if (options%tau_max < cap_constants(1)%lower) return
        options%cohesion = 0.0_wp
        if (n >= option_cohesion) options%cohesion = constants(option_cohesion)
        if (options%cohesion < cohesion_constants(1)%lower) return
        options%damping = 0.0_wp
        if (n >= option_damping) options%damping = constants(option_damping)
        if (options%damping < damper_constants(1)%lower) return
        options%plane = isotropic
        status = friction_ok
        if (n >= option_orthotropy) call read_orthotropy(n - option_orthotropy + 1, &
            constants(option_orthotropy:), options%plane, status)
    end subroutine options_of

    !> The law as it is without options.
    pure subroutine choose_own_law(nprops, props, storage, own, place, status)
        integer, intent(in) :: nprops                        !! size
        real(wp), intent(in) :: props(nprops)                !! finite
        type(law_storage), intent(inout), target :: storage  !! where the law is kept
        class(named_law), pointer, intent(inout) :: own      !! out: the law, if the status is ok
        integer, intent(out) :: place    !! of the first option in `props`
        integer, intent(out) :: status   !! ok, bad law, bad size, or bad property
        integer :: number, n_own

        status = friction_bad_property
        if (props(prop_alpha_n) < spring_constants(1)%lower) return
        if (props(prop_alpha_t) < spring_constants(2)%lower) return
        number = whole_number(props(prop_law))
        call find_law(number, storage, own)
        status = friction_bad_law
        if (.not. associated(own)) return
        call own%read(nprops - first_own_prop + 1, props(first_own_prop:), n_own, status)
        if (status /= friction_ok) return
        place = first_own_prop + n_own
        own%follows_path = .false.
        own%tau_max = huge(own%tau_max)
        own%cohesion = 0.0_wp
        own%pressure_start = 0.0_wp
        own%pressure_blur = 0.0_wp
        if (number == law_subloading) call choose_form(storage, own)
        storage%own => own
    end subroutine choose_own_law

    !> The subloading law in one of its forms.
    pure subroutine choose_form(storage, own)
        type(law_storage), intent(inout), target :: storage
        class(named_law), pointer, intent(inout) :: own

        if (storage%subloading%scheme == scheme_exact_rate) then
            storage%exact%subloading_law = storage%subloading
            storage%exact%follows_path = .true.
            own => storage%exact
        else if (storage%subloading%u_of_r /= u_logarithm) then
            storage%general%subloading_law = storage%subloading
            own => storage%general
        end if
    end subroutine choose_form

    !> A number that counts something; -1, which counts nothing, for all but a small whole number.
    pure function whole_number(x) result(number)
        real(wp), intent(in) :: x
        integer :: number

        number = int(min(max(x, -1.0_wp), 1000.0_wp))
        if (abs(x - number) > 0.0_wp) number = -1
    end function whole_number

end module friction_law_choice
