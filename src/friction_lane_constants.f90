!> Which vector lanes a law and its options have, and what these need to know of `props`
!> (module friction_batch_kernel).
module friction_lane_constants
    use, intrinsic :: iso_c_binding, only : c_int
    use, intrinsic :: iso_fortran_env, only : int64
    use friction_anisotropy, only : orthotropy
    use friction_coulomb_law, only : coulomb_law
    use friction_kinds, only : wp
    use friction_lane_block, only : c_alpha_n, c_alpha_t, c_cap, c_mu_0, c_own, c_r_0, c_squeeze, &
        lane_ageing, lane_cotangent, lane_coulomb, lane_exact_rate, lane_none, lane_reciprocal, &
        lane_slip_law, lane_slip_weakening, lane_static_kinetic, lane_subloading, lanes, &
        n_constants, n_own, no_cap
    use friction_law, only : law_state, named_law
    use friction_law_choice, only : choose_law, choose_own_law, first_own_prop, law_storage, &
        prop_alpha_n, prop_alpha_t, prop_law
    use friction_law, only : law
    use friction_law_constants, only : constant_table, law_constant
    use friction_rate_state_law, only : rate_state_law, slipping
    use friction_slip_weakening_law, only : slip_weakening_law
    use friction_static_kinetic_law, only : static_kinetic_law
    use friction_subloading_exact_law, only : subloading_exact_law
    use friction_subloading_general_law, only : subloading_general_law
    use friction_subloading_law, only : subloading_law, u_cotangent
    implicit none
    private

    public :: copy_constants, lane_plan, plan_lanes, spread_constants

    !> How a law's constants become those of lanes.
    type :: lane_plan
        integer(c_int) :: kind = lane_none   !! see module friction_lane_block
        logical :: options = .false.    !! a shear cap or two coefficients, at any point
        logical :: needs_time = .false. !! no increment without time
        integer :: place(n_constants) = 0     !! in `props`; 0: none, the value below instead
        real(wp) :: value(n_constants) = 0.0_wp   !! of the point that the plan was made for
        integer :: n_choices = 0              !! constants that have to be what they are there
        integer :: choice(4) = 0              !! their places
        real(wp) :: chosen(4) = 0.0_wp        !! and values
        integer :: n_rules = 0                !! rules of the law's own constants
        type(law_constant) :: rule(n_own)
    end type lane_plan

    !> Constants that are not zero are of ordinary size, or lanes do not take them.
    real(wp), parameter :: least = 1.0e-20_wp, most = 1.0e20_wp

contains

    !> The lanes of one point's law and options: `lane_none` if it has none.
    pure subroutine plan_lanes(nprops, props, varied, plan)
        integer, intent(in) :: nprops             !! size
        real(wp), intent(in) :: props(nprops)     !! finite
        logical, intent(in) :: varied             !! other points have other constants
        type(lane_plan), intent(out) :: plan
        type(law_storage), target :: storage
        class(named_law), pointer :: own
        class(law), pointer :: surface
        type(orthotropy) :: plane
        type(law_state) :: virgin
        integer :: status, option

        nullify (own, surface)
        call choose_law(nprops, props, storage, surface, plane, status)
        if (status < 0 .or. plane%associated) return
        call choose_own_law(nprops, props, storage, own, option, status)
        call plan_own(own, nprops, props, plan)
        if (plan%kind == lane_none) return
        plan%needs_time = own%needs_time()
        virgin = own%virgin()
        plan%value(c_mu_0) = virgin%mu
        plan%value(c_r_0) = virgin%r
        plan%value(c_cap) = no_cap
        if (surface%tau_max < most) plan%value(c_cap) = surface%tau_max
        plan%value(c_squeeze) = plane%squeeze
        plan%options = surface%tau_max < most .or. abs(plane%squeeze - 1.0_wp) > 0.0_wp
        if (varied .and. option <= nprops) plan%options = .true.
        if (option <= nprops) plan%place(c_cap) = option
        if (option + 1 <= nprops) plan%place(c_squeeze) = option + 1
        if (option + 2 <= nprops) call must_stay(option + 2, props(option + 2), plan)
        if (.not. ordinary(plan%value(:c_mu_0 - 1))) plan%kind = lane_none
        if (.not. ordinary(plan%value(c_mu_0:c_r_0))) plan%kind = lane_none
    end subroutine plan_lanes

    !> The part of the law itself.
    pure subroutine plan_own(own, nprops, props, plan)
        class(named_law), intent(in) :: own
        integer, intent(in) :: nprops
        real(wp), intent(in) :: props(nprops)
        type(lane_plan), intent(inout) :: plan
        type(constant_table) :: table
        integer :: k, place

        plan%kind = kind_of(own)
        if (plan%kind == lane_none) return
        plan%place(c_alpha_n) = prop_alpha_n
        plan%place(c_alpha_t) = prop_alpha_t
        call must_stay(prop_law, props(prop_law), plan)
        table = own%constants()
        do k = 1, table%n
            place = first_own_prop + k - 1
            if (place > nprops) exit
            if (table%of(k)%whole) then
                call must_stay(place, props(place), plan)
            else if (.not. table%of(k)%optional) then
                plan%n_rules = k
                plan%rule(k) = table%of(k)
                plan%place(c_own + k - 1) = place
            end if
        end do
        do k = 1, c_own + n_own - 1
            if (plan%place(k) > 0) plan%value(k) = props(plan%place(k))
        end do
    end subroutine plan_own

    pure subroutine must_stay(place, value, plan)
        integer, intent(in) :: place
        real(wp), intent(in) :: value
        type(lane_plan), intent(inout) :: plan

        plan%n_choices = plan%n_choices + 1
        plan%choice(plan%n_choices) = place
        plan%chosen(plan%n_choices) = value
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
        type is (slip_weakening_law); kind = lane_slip_weakening
        end select
    end function kind_of

    pure function ordinary(values)
        real(wp), intent(in) :: values(:)
        logical :: ordinary

        ordinary = all(values < most .and. (values > least .or. .not. abs(values) > 0.0_wp))
    end function ordinary

    !> The same constants for all lanes.
    pure subroutine spread_constants(plan, constants)
        type(lane_plan), intent(in) :: plan
        real(wp), intent(out) :: constants(lanes, n_constants)
        integer :: k

        do k = 1, n_constants
            constants(:, k) = plan%value(k)
        end do
    end subroutine spread_constants

    !> Each lane's own constants, and the lanes that are left: by their constants, which the routine
    !> for one point then judges. Virgin points are left, too.
    pure subroutine copy_constants(plan, points, props, first, count, constants, left)
        type(lane_plan), intent(in) :: plan
        integer(int64), intent(in) :: points
        real(wp), intent(in) :: props(points, *)
        integer(int64), intent(in) :: first    !! point of the first lane
        integer, intent(in) :: count           !! lanes in use
        real(wp), intent(out) :: constants(lanes, n_constants)
        integer(c_int), intent(out) :: left(lanes)
        integer :: j, k

        left = 0
        call spread_constants(plan, constants)
        constants(:, c_mu_0) = -1.0_wp   ! a coefficient that no law admits
        do k = 1, plan%n_choices
            do j = 1, count
                if (bits(props(first + j - 1, plan%choice(k))) /= bits(plan%chosen(k))) left(j) = 1
            end do
        end do
        do k = 1, n_constants
            if (plan%place(k) == 0) cycle
            call copy_ordinary(count, props(first, plan%place(k)), constants(:, k), left)
        end do
        call follow_rules(plan, count, constants, left)
        if (plan%place(c_cap) > 0) then
            do j = 1, count
                if (constants(j, c_cap) <= 0.0_wp) constants(j, c_cap) = no_cap
            end do
        end if
        if (plan%place(c_squeeze) > 0) then
            do j = 1, count
                if (constants(j, c_squeeze) > 0.0_wp) then
                    constants(j, c_squeeze) = 1.0_wp / constants(j, c_squeeze)
                else
                    constants(j, c_squeeze) = 1.0_wp
                end if
            end do
        end if
    end subroutine copy_constants

    !> One constant of all lanes; where it is not of ordinary size the lane keeps what it has.
    pure subroutine copy_ordinary(count, from, to, left)
        integer, intent(in) :: count
        real(wp), intent(in) :: from(count)
        real(wp), intent(inout) :: to(lanes)
        integer(c_int), intent(inout) :: left(lanes)
        integer(int64) :: number
        integer :: j

        do j = 1, count
            number = bits(from(j))
            if (number == 0 .or. (number > bits(least) .and. number < bits(most))) then
                to(j) = from(j)
            else
                left(j) = 1
            end if
        end do
    end subroutine copy_ordinary

    !> A number as an integer, which orders those above zero as they are: silent where a comparison
    !> with NaN raises an exception.
    elemental function bits(x)
        real(wp), intent(in) :: x
        integer(int64) :: bits

        bits = transfer(x, bits)
    end function bits

    !> Lanes whose constants break a rule of the law are left.
    pure subroutine follow_rules(plan, count, constants, left)
        type(lane_plan), intent(in) :: plan
        integer, intent(in) :: count
        real(wp), intent(in) :: constants(lanes, n_constants)
        integer(c_int), intent(inout) :: left(lanes)
        integer :: j, k, other

        do j = 1, count
            if (min(constants(j, c_alpha_n), constants(j, c_alpha_t)) <= 0.0_wp) left(j) = 1
        end do
        do k = 1, plan%n_rules
            do j = 1, count
                if (constants(j, c_own + k - 1) < plan%rule(k)%lower) left(j) = 1
            end do
            other = plan%rule(k)%not_below
            if (other == 0) cycle
            do j = 1, count
                if (constants(j, c_own + k - 1) < constants(j, c_own + other - 1)) left(j) = 1
            end do
        end do
    end subroutine follow_rules

end module friction_lane_constants
