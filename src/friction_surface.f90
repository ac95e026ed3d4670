!> A friction law with its options, read once and asked often: for programs that integrate the rates
!> of a contact themselves (docs/theory.md, section 10).
module friction_surface
    use friction_anisotropy, only : orthotropy
    use friction_kinds, only : wp
    use friction_law, only : law, law_state, law_traits, load_rates, onset_drops, onset_gradual, &
        onset_yields
    use friction_law_choice, only : choose_law, first_own_prop, law_storage
    use friction_shear_cap, only : capped_law
    use friction_status, only : friction_bad_size
    implicit none
    private

    public :: law_state, law_traits, load_rates, read_surface, sliding_surface
    public :: onset_drops, onset_gradual, onset_yields

    !> Friction along tangential axis 1.
    type :: sliding_surface
        class(law), allocatable :: law              !! without its shear cap
        real(wp) :: tau_max = huge(1.0_wp)          !! the cap [F/L^2]
        type(law_traits) :: traits                  !! what the law remembers
    end type sliding_surface

contains

    !> The only procedure here that allocates. Not pure: a polymorphic component may not come out of
    !> a pure procedure.
    subroutine read_surface(props, surface, status)
        real(wp), intent(in) :: props(:)                !! material constants, as in
                                                        !! `friction_update`, valid
        type(sliding_surface), intent(out) :: surface   !! if the status is ok
        integer, intent(out) :: status   !! ok, bad size, bad law, or bad property
        type(law_storage), target :: storage
        class(law), pointer :: chosen
        type(orthotropy) :: plane

        status = friction_bad_size
        if (size(props) < first_own_prop) return
        call choose_law(size(props), props, storage, chosen, plane, status)
        if (status < 0) return
        select type (chosen)
        type is (capped_law)
            surface%tau_max = chosen%tau_max
            allocate (surface%law, source=chosen%inner)
        class default
            allocate (surface%law, source=chosen)
        end select
        surface%traits = surface%law%traits()
    end subroutine read_surface

end module friction_surface
