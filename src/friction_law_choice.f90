!> Which law, from the constants in `props`: the one place where laws are chosen.
module friction_law_choice
    use friction_anisotropy, only : isotropic, orthotropy, read_orthotropy
    use friction_coulomb_law, only : coulomb_law, read_coulomb_law
    use friction_kinds, only : wp
    use friction_law, only : law
    use friction_rate_state_law, only : rate_state_law, read_rate_state_law
    use friction_shear_cap, only : capped_law
    use friction_slip_weakening_law, only : read_slip_weakening_law, slip_weakening_law
    use friction_static_kinetic_law, only : read_static_kinetic_law, static_kinetic_law
    use friction_status, only : friction_bad_law, friction_bad_property
    use friction_subloading_exact_law, only : subloading_exact_law
    use friction_subloading_general_law, only : subloading_general_law, u_cotangent, u_logarithm, &
        u_reciprocal
    use friction_subloading_law, only : read_subloading_law, subloading_law
    implicit none
    private

    public :: choose_law, law_storage, orthotropy_place, whole_number

    !> Laws: values of props(1).
    integer, parameter, public :: law_subloading = 1
    integer, parameter, public :: law_coulomb = 2
    integer, parameter, public :: law_static_kinetic = 3
    integer, parameter, public :: law_rate_state = 4
    integer, parameter, public :: law_slip_weakening = 5

    !> Time integration of the subloading law: values of props(10).
    integer, parameter, public :: scheme_backward_euler = 0   !! as the law's authors chose
    integer, parameter, public :: scheme_exact_rate = 1       !! exact for a constant slip rate

    !> Evolution of R in the subloading law: values of props(11).
    public :: u_logarithm, u_cotangent, u_reciprocal

    !> Material constants: places in `props` that all laws share.
    integer, parameter, public :: prop_law = 1, prop_alpha_n = 2, prop_alpha_t = 3
    integer, parameter, public :: first_own_prop = 4   !! of each law
    integer, parameter, public :: prop_scheme = 10   !! of the subloading law; may be left out
    integer, parameter, public :: prop_u_of_r = 11   !! likewise

    !> Place of the shear cap, after the own constants of each law; may be left out, 0 means none.
    integer, parameter, public :: prop_tau_max(5) = [12, 5, 7, 11, 7]

    !> The places after it, which may be left out, are for orthotropic friction: mu_2/mu_1, and the
    !> direction of sliding.
    integer, parameter :: ratio_after_tau_max = 1

    !> Room for a law of whichever kind, of which one is in use.
    type :: law_storage
        type(subloading_law) :: subloading
        type(subloading_exact_law) :: exact
        type(subloading_general_law) :: general
        type(coulomb_law) :: coulomb
        type(static_kinetic_law) :: static_kinetic
        type(rate_state_law) :: rate_state
        type(slip_weakening_law) :: slip_weakening
        type(capped_law) :: capped
    end type law_storage

contains

    !> The law and its options from the constants.
    pure subroutine choose_law(nprops, props, storage, surface, plane, status)
        integer, intent(in) :: nprops                        !! size, 4 or more
        real(wp), intent(in) :: props(nprops)                !! finite
        type(law_storage), intent(inout), target :: storage  !! where the law is kept
        class(law), pointer, intent(inout) :: surface        !! out: the law, if the status is ok
        type(orthotropy), intent(out) :: plane               !! how it depends on the direction
        integer, intent(out) :: status   !! ok, bad law, bad size, or bad property
        integer :: number, n, scheme, place

        number = whole_number(props(prop_law))
        n = nprops - first_own_prop + 1
        scheme = scheme_backward_euler
        select case (number)
        case (law_subloading)
            call choose_subloading(nprops, props, storage, surface, scheme, status)
        case (law_coulomb)
            call read_coulomb_law(n, props(first_own_prop), storage%coulomb, status)
            surface => storage%coulomb
        case (law_static_kinetic)
            call read_static_kinetic_law(n, props(first_own_prop), storage%static_kinetic, status)
            surface => storage%static_kinetic
        case (law_rate_state)
            call read_rate_state_law(n, props(first_own_prop), storage%rate_state, status)
            surface => storage%rate_state
        case (law_slip_weakening)
            call read_slip_weakening_law(n, props(first_own_prop), storage%slip_weakening, status)
            surface => storage%slip_weakening
        case default
            status = friction_bad_law
        end select
        if (status < 0) return
        surface%follows_path = scheme == scheme_exact_rate
        surface%tau_max = huge(surface%tau_max)
        if (nprops >= prop_tau_max(number)) then
            call cap_law(props(prop_tau_max(number)), storage%capped, surface, status)
            if (status < 0) return
        end if
        plane = isotropic
        place = orthotropy_place(number)
        if (nprops >= place) call read_orthotropy(nprops - place + 1, props(place), plane, status)
    end subroutine choose_law

    !> The subloading law in one of its forms.
    pure subroutine choose_subloading(nprops, props, storage, surface, scheme, status)
        integer, intent(in) :: nprops
        real(wp), intent(in) :: props(nprops)
        type(law_storage), intent(inout), target :: storage
        class(law), pointer, intent(inout) :: surface
        integer, intent(out) :: scheme   !! of time integration
        integer, intent(out) :: status   !! ok, bad size, or bad property
        integer :: u_of_r

        call read_subloading_law(nprops - first_own_prop + 1, props(first_own_prop), &
            storage%subloading, status)
        surface => storage%subloading
        scheme = scheme_backward_euler
        if (nprops < prop_scheme) return
        scheme = whole_number(props(prop_scheme))
        u_of_r = u_logarithm
        if (nprops >= prop_u_of_r) u_of_r = whole_number(props(prop_u_of_r))
        if (u_of_r /= u_logarithm) then
            storage%general%subloading_law = storage%subloading
            storage%general%u_of_r = u_of_r
            surface => storage%general
            if (scheme /= scheme_backward_euler .or. (u_of_r /= u_cotangent &
                .and. u_of_r /= u_reciprocal)) status = friction_bad_property
        else if (scheme == scheme_exact_rate) then
            storage%exact%subloading_law = storage%subloading
            surface => storage%exact
        else if (scheme /= scheme_backward_euler) then
            status = friction_bad_property
        end if
    end subroutine choose_subloading

    !> Puts a shear cap on a law; 0 means none.
    pure subroutine cap_law(tau_max, capped, surface, status)
        real(wp), intent(in) :: tau_max
        type(capped_law), intent(inout), target :: capped
        class(law), pointer, intent(inout) :: surface
        integer, intent(inout) :: status   !! bad property, or as it was

        if (tau_max < 0.0_wp) status = friction_bad_property
        if (.not. tau_max > 0.0_wp) return
        capped%tau_max = tau_max
        capped%inner => surface
        capped%follows_path = .false.   ! its strength is not proportional to the pressure
        surface => capped
    end subroutine cap_law

    !> Place of mu_2/mu_1 in the constants of a law; the direction of sliding follows it.
    pure function orthotropy_place(number) result(place)
        integer, intent(in) :: number   !! of the law
        integer :: place                !! huge for a law that does not exist

        place = huge(place)
        if (number >= 1 .and. number <= size(prop_tau_max)) place = prop_tau_max(number) &
            + ratio_after_tau_max
    end function orthotropy_place

    !> A number that counts something; -1, which counts nothing, for all but a small whole number.
    pure function whole_number(x) result(number)
        real(wp), intent(in) :: x
        integer :: number

        number = int(min(max(x, -1.0_wp), 1000.0_wp))
        if (abs(x - number) > 0.0_wp) number = -1
    end function whole_number

end module friction_law_choice
