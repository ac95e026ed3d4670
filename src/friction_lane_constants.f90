!> Which vector lanes a law and its options have, and what these need to know of `props`
!> (module friction_batch_kernel).
module friction_lane_constants
    use, intrinsic :: iso_c_binding, only : c_int
    use friction_coulomb_law, only : coulomb_law
    use friction_kinds, only : wp
    use friction_lane_block, only : c_alpha_n, c_alpha_t, c_cap, c_mu_0, c_own, c_r_0, c_squeeze, &
        constants_source, lane_ageing, lane_cotangent, lane_coulomb, lane_exact_rate, &
        lane_flash_heating, lane_healing, lane_none, lane_pressed_ageing, lane_pressed_slip_law, &
        lane_reciprocal, lane_slip_law, lane_slip_weakening, lane_static_kinetic, &
        lane_subloading, lanes, n_constants, n_own, no_cap, with_cap, &
        with_two_coefficients
    use friction_law, only : law_state, named_law
    use friction_law_choice, only : choose_law, choose_own_law, first_own_prop, law_descriptions, &
        law_storage, prop_alpha_n, prop_alpha_t, prop_law, surface_options
    use friction_law, only : law
    use friction_law_constants, only : constant_table, positive
    use friction_flash_heating_law, only : flash_heating_law
    use friction_linker_dieterich_law, only : linker_dieterich_law
    use friction_rate_state_law, only : rate_state_law, slipping
    use friction_slip_weakening_healing_law, only : slip_weakening_healing_law
    use friction_slip_weakening_law, only : slip_weakening_law
    use friction_static_kinetic_law, only : static_kinetic_law
    use friction_subloading_exact_law, only : subloading_exact_law
    use friction_subloading_general_law, only : subloading_general_law
    use friction_subloading_law, only : subloading_law, u_cotangent
    implicit none
    private

    public :: lane_plan, plan_lanes, spread_constants

    !> The lanes of a law and its options, and how its constants become theirs.
    type :: lane_plan
        integer(c_int) :: kind = lane_none   !! see module friction_lane_block
        integer(c_int) :: options = 0   !! sum of those that the point of the plan has
        logical :: needs_time = .false. !! no increment without time
        real(wp) :: cohesion = 0.0_wp   !! of all points that lanes take [F/L^2]
        real(wp) :: damping = 0.0_wp    !! likewise [F T/L^3]
        type(constants_source) :: source   !! its values are those of the point that the plan was
                                           !! made for
    end type lane_plan

    !> Of constants that lanes take: no product of some of them overflows.
    real(wp), parameter :: most = 1.0e20_wp

contains

    !> The lanes of one point's law and options: `lane_none` if it has none.
    pure subroutine plan_lanes(nprops, props, plan)
        integer, intent(in) :: nprops             !! size
        real(wp), intent(in) :: props(nprops)     !! finite
        type(lane_plan), intent(out) :: plan
        type(law_storage), target :: storage
        class(named_law), pointer :: own
        class(law), pointer :: surface
        type(surface_options) :: options
        type(law_state) :: virgin
        integer :: status, option

        nullify (own, surface)
        call choose_law(nprops, props, storage, surface, options, status)
        if (status < 0 .or. options%plane%associated) return
        call choose_own_law(nprops, props, storage, own, option, status)
        call plan_own(own, law_descriptions(nint(props(prop_law)))%constants, nprops, props, plan)
        if (plan%kind == lane_none) return
        plan%needs_time = own%needs_time() .or. options%damping > 0.0_wp
        plan%cohesion = options%cohesion
        plan%damping = options%damping
        virgin = own%virgin()
        plan%source%value(c_mu_0) = virgin%mu
        plan%source%value(c_r_0) = virgin%r
        plan%source%value(c_cap) = no_cap
        if (surface%tau_max < most) plan%source%value(c_cap) = surface%tau_max
        plan%source%value(c_squeeze) = options%plane%squeeze
        if (surface%tau_max < most) plan%options = with_cap
        if (abs(options%plane%squeeze - 1.0_wp) > 0.0_wp) plan%options = plan%options &
            + with_two_coefficients
        if (option <= nprops) plan%source%place(c_cap) = option
        if (option + 1 <= nprops) plan%source%place(c_squeeze) = option + 1
        if (option + 1 <= nprops .and. iand(plan%options, with_two_coefficients) == 0) then
            ! the first coefficients that differ may bring the direction with them that has no lanes
            plan%source%lower(c_squeeze) = props(option + 1)
            plan%source%upper(c_squeeze) = props(option + 1)
        end if
        if (option + 2 <= nprops) call must_stay(option + 2, props(option + 2), plan)
        if (option + 3 <= nprops) call must_stay(option + 3, props(option + 3), plan)
        if (option + 4 <= nprops) call must_stay(option + 4, props(option + 4), plan)
        if (any([options%tau_max, options%cohesion, options%damping, plan%source%value(:c_r_0), &
            plan%source%value(c_own:)] >= most)) plan%kind = lane_none
    end subroutine plan_lanes

    !> The part of the law itself.
    pure subroutine plan_own(own, table, nprops, props, plan)
        class(named_law), intent(in) :: own
        type(constant_table), intent(in) :: table   !! of the law
        integer, intent(in) :: nprops
        real(wp), intent(in) :: props(nprops)
        type(lane_plan), intent(inout) :: plan
        integer :: k, place, column_of(size(table%of))

        plan%kind = kind_of(own)
        if (plan%kind == lane_none) return
        plan%source%place(c_alpha_n) = prop_alpha_n
        plan%source%place(c_alpha_t) = prop_alpha_t
        call must_stay(prop_law, props(prop_law), plan)
        column_of = 0
        do k = 1, table%n
            place = first_own_prop + k - 1
            if (place > nprops .and. (table%of(k)%whole .or. table%of(k)%default_from > 0)) exit
            if (table%of(k)%whole) then
                call must_stay(place, props(place), plan)
                cycle
            end if
            if (plan%source%n_own == n_own) then
                plan%kind = lane_none
                return
            end if
            column_of(k) = c_own + plan%source%n_own
            plan%source%n_own = plan%source%n_own + 1_c_int
            if (place <= nprops) plan%source%place(column_of(k)) = place
            plan%source%value(column_of(k)) = table%of(k)%default
            plan%source%lower(column_of(k)) = table%of(k)%lower
            plan%source%upper(column_of(k)) = table%of(k)%upper
        end do
        do k = 1, table%n
            if (column_of(k) == 0) cycle
            if (table%of(k)%not_below > 0) plan%source%not_below(column_of(k)) = &
                column_of(table%of(k)%not_below)
            if (table%of(k)%not_above > 0) plan%source%not_above(column_of(k)) = &
                column_of(table%of(k)%not_above)
        end do
        do k = 1, n_constants
            if (plan%source%place(k) > 0) plan%source%value(k) = props(plan%source%place(k))
        end do
        plan%source%lower([c_alpha_n, c_alpha_t]) = positive
    end subroutine plan_own

    pure subroutine must_stay(place, value, plan)
        integer, intent(in) :: place
        real(wp), intent(in) :: value
        type(lane_plan), intent(inout) :: plan

        associate (n => plan%source%n_choices)
            if (n == size(plan%source%choice)) then
                plan%kind = lane_none
                return
            end if
            n = n + 1_c_int
            plan%source%choice(n:) = int(place, c_int)   ! those without one repeat the last
            plan%source%chosen(n:) = value
        end associate
    end subroutine must_stay

    !> Laws that have lanes.
    pure function kind_of(own) result(kind)
        class(named_law), intent(in) :: own
        integer(c_int) :: kind

        kind = lane_none
        select type (own)
        type is (subloading_law); kind = lane_subloading
        type is (subloading_exact_law); kind = lane_exact_rate
        type is (subloading_general_law)
            kind = merge(lane_cotangent, lane_reciprocal, own%u_of_r == u_cotangent)
        type is (coulomb_law); kind = lane_coulomb
        type is (static_kinetic_law); kind = lane_static_kinetic
        type is (rate_state_law)
            kind = merge(lane_slip_law, lane_ageing, own%evolution == slipping)
        type is (linker_dieterich_law)
            kind = merge(lane_pressed_slip_law, lane_pressed_ageing, own%evolution == slipping)
        type is (flash_heating_law); kind = lane_flash_heating
        type is (slip_weakening_law); kind = lane_slip_weakening
        type is (slip_weakening_healing_law); kind = lane_healing
        end select
    end function kind_of

    !> The same constants for all lanes.
    pure subroutine spread_constants(plan, constants)
        type(lane_plan), intent(in) :: plan
        real(wp), intent(out) :: constants(lanes, n_constants)
        integer :: k

        do k = 1, n_constants
            constants(:, k) = plan%source%value(k)
        end do
    end subroutine spread_constants

end module friction_lane_constants
