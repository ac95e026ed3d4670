!> Reads a surface from the constants of its law: the only procedure of the library that allocates,
!> and so the only one that needs the run-time library of Fortran.
submodule(friction_surface) friction_surface_reading
    use friction_cohesion, only : cohesive_law
    use friction_law_choice, only : choose_law, first_own_prop, law_storage, surface_options
    use friction_shear_cap, only : capped_law
    use friction_status, only : friction_bad_size
    implicit none

contains

    module procedure read_surface
        type(law_storage), target :: storage
        class(law), pointer :: chosen, uncapped
        type(surface_options) :: options

        status = friction_bad_size
        if (size(props) < first_own_prop) return
        call choose_law(size(props), props, storage, chosen, options, status)
        if (status < 0) return
        uncapped => chosen
        select type (chosen)
        type is (capped_law)
            surface%tau_max = chosen%tau_max
            uncapped => chosen%inner
        end select
        select type (uncapped)
        type is (cohesive_law)
            surface%cohesion = uncapped%cohesion
            allocate (surface%law, source=uncapped%inner)
        class default
            allocate (surface%law, source=uncapped)
        end select
        surface%traits = surface%law%traits()
    end procedure read_surface

end submodule friction_surface_reading
