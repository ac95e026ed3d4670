!> The laws that the shared suite (test_law_suite.pf) examines, one line each, and random points
!> under them.
module law_suite
    use, intrinsic :: iso_fortran_env, only : dp => real64, real128
    use draws, only : draw
    use friction_mod, only : friction_place, friction_update, law_coulomb, law_flash_heating, &
        law_linker_dieterich, law_rate_state, law_slip_weakening, law_slip_weakening_healing, &
        law_static_kinetic, law_subloading
    use quad_friction_mod, only : quad_update => friction_update
    implicit none
    private

    public :: exact_tangent, has_damper, law_case, law_point, laws, random_law_point

    integer, parameter :: qp = real128
    integer, parameter :: most_own = 14

    type :: law_case
        character(len=27) :: name
        integer :: number            !! props(1)
        integer :: n_own             !! number of own constants, all with their optional ones
        real(dp) :: own(most_own)    !! for N, mm, s
        character(len=most_own) :: spread   !! how a draw varies each: d over decades, m all by one
                                            !! factor up to 1 (friction coefficients), o over
                                            !! fewer decades (mu_2/mu_1), - not at all
        logical :: needs_time        !! refuses a tangential load without time
    end type law_case

    ! Typical constants, some of which several cases share.
    real(dp), parameter :: mu = 0.4_dp, theta_0 = 1.0e-2_dp, tau_max = 1.0_dp
    real(dp), parameter :: subloading(6) = [mu, 0.2_dp, 10.0_dp, 1.0_dp, 100.0_dp, 0.3_dp]
    real(dp), parameter :: static_kinetic(3) = [mu, 0.2_dp, 0.1_dp]
    real(dp), parameter :: rate_state(5) = [0.01_dp, 0.015_dp, 1.0e-2_dp, 1.0_dp, mu]
    real(dp), parameter :: slip_weakening(3) = [mu, 0.2_dp, 1.0e-2_dp]
    real(dp), parameter :: healing(4) = [slip_weakening, 1.0e2_dp]
    real(dp), parameter :: flash_heating(9) = [rate_state, 0.1_dp, 10.0_dp, 8.0_dp, theta_0]
    real(dp), parameter :: linker_dieterich(6) = [rate_state, 0.05_dp]
    real(dp), parameter :: unused(most_own) = 0.0_dp
    real(dp), parameter :: associated(2) = [0.6_dp, 0.0_dp], radial(2) = [0.6_dp, 1.0_dp]
    real(dp), parameter :: c = 0.5_dp, eta = 1.0_dp, bare(3) = 0.0_dp   ! no option before these

    type(law_case), parameter :: laws(56) = [ &
        law_case('subloading', law_subloading, 6, [subloading, unused(7:)], 'mmdddm', .false.), &
        law_case('subloading, exact rate', law_subloading, 7, &
        [subloading, 1.0_dp, unused(8:)], 'mmdddm-', .false.), &
        law_case('Coulomb', law_coulomb, 1, [mu, unused(2:)], 'm', .false.), &
        law_case('static-kinetic', law_static_kinetic, 3, &
        [static_kinetic, unused(4:)], 'mmd', .true.), &
        law_case('rate-and-state, ageing', law_rate_state, 7, &
        [rate_state, 0.0_dp, theta_0, unused(8:)], 'mmddm-d', .true.), &
        law_case('rate-and-state, slip', law_rate_state, 7, &
        [rate_state, 1.0_dp, theta_0, unused(8:)], 'mmddm-d', .true.), &
        law_case('slip-weakening', law_slip_weakening, 3, &
        [slip_weakening, unused(4:)], 'mmd', .false.), &
        law_case('subloading, cotangent', law_subloading, 8, &
        [subloading, 0.0_dp, 1.0_dp, unused(9:)], 'mmdddm--', .false.), &
        law_case('subloading, reciprocal', law_subloading, 8, &
        [subloading, 0.0_dp, 2.0_dp, unused(9:)], 'mmdddm--', .false.), &
        law_case('subloading, capped', law_subloading, 9, &
        [subloading, 0.0_dp, 0.0_dp, tau_max, unused(10:)], 'mmdddm--d', .false.), &
        law_case('subloading, exact, capped', law_subloading, 9, &
        [subloading, 1.0_dp, 0.0_dp, tau_max, unused(10:)], 'mmdddm--d', .false.), &
        law_case('Coulomb, capped', law_coulomb, 2, [mu, tau_max, unused(3:)], 'md', .false.), &
        law_case('static-kinetic, capped', law_static_kinetic, 4, &
        [static_kinetic, tau_max, unused(5:)], 'mmdd', .true.), &
        law_case('rate-and-state, capped', law_rate_state, 8, &
        [rate_state, 0.0_dp, theta_0, tau_max, unused(9:)], 'mmddm-dd', .true.), &
        law_case('slip-weakening, capped', law_slip_weakening, 4, &
        [slip_weakening, tau_max, unused(5:)], 'mmdd', .false.), &
        law_case('Coulomb, associated', law_coulomb, 4, [mu, 0.0_dp, associated, unused(5:)], &
        'm-o-', .false.), &
        law_case('Coulomb, radial', law_coulomb, 4, [mu, 0.0_dp, radial, unused(5:)], 'm-o-', &
        .false.), &
        law_case('subloading, associated', law_subloading, 11, [subloading, 0.0_dp, 0.0_dp, &
        0.0_dp, associated, unused(12:)], 'mmdddm---o-', .false.), &
        law_case('subloading, radial', law_subloading, 11, [subloading, 0.0_dp, 0.0_dp, 0.0_dp, &
        radial, unused(12:)], 'mmdddm---o-', .false.), &
        law_case('exact rate, associated', law_subloading, 11, [subloading, 1.0_dp, 0.0_dp, &
        0.0_dp, associated, unused(12:)], 'mmdddm---o-', .false.), &
        law_case('exact rate, radial', law_subloading, 11, [subloading, 1.0_dp, 0.0_dp, 0.0_dp, &
        radial, unused(12:)], 'mmdddm---o-', .false.), &
        law_case('associated, capped', law_subloading, 11, [subloading, 0.0_dp, 0.0_dp, tau_max, &
        associated, unused(12:)], 'mmdddm--do-', .false.), &
        law_case('static-kinetic, associated', law_static_kinetic, 6, [static_kinetic, 0.0_dp, &
        associated, unused(7:)], 'mmd-o-', .true.), &
        law_case('rate-and-state, associated', law_rate_state, 10, [rate_state, 0.0_dp, theta_0, &
        0.0_dp, associated, unused(11:)], 'mmddm-d-o-', .true.), &
        law_case('slip-weakening, associated', law_slip_weakening, 6, [slip_weakening, 0.0_dp, &
        associated, unused(7:)], 'mmd-o-', .false.), &
        law_case('healing', law_slip_weakening_healing, 4, [healing, unused(5:)], 'mmdd', &
        .false.), &
        law_case('healing, capped', law_slip_weakening_healing, 5, [healing, tau_max, &
        unused(6:)], 'mmddd', .false.), &
        law_case('healing, associated', law_slip_weakening_healing, 7, [healing, 0.0_dp, &
        associated, unused(8:)], 'mmdd-o-', .false.), &
        law_case('flash heating', law_flash_heating, 9, [flash_heating, unused(10:)], &
        'mmddmmd-d', .true.), &
        law_case('flash heating, capped', law_flash_heating, 10, [flash_heating, tau_max, &
        unused(11:)], 'mmddmmd-dd', .true.), &
        law_case('flash heating, associated', law_flash_heating, 12, [flash_heating, 0.0_dp, &
        associated, unused(13:)], 'mmddmmd-d-o-', .true.), &
        law_case('Linker-Dieterich, ageing', law_linker_dieterich, 8, [linker_dieterich, 0.0_dp, &
        theta_0, unused(9:)], 'mmddmm-d', .true.), &
        law_case('Linker-Dieterich, slip', law_linker_dieterich, 8, [linker_dieterich, 1.0_dp, &
        theta_0, unused(9:)], 'mmddmm-d', .true.), &
        law_case('Linker-Dieterich, capped', law_linker_dieterich, 9, [linker_dieterich, 0.0_dp, &
        theta_0, tau_max, unused(10:)], 'mmddmm-dd', .true.), &
        law_case('Linker-Dieterich, assoc.', law_linker_dieterich, 11, [linker_dieterich, 1.0_dp, &
        theta_0, 0.0_dp, associated, unused(12:)], 'mmddmm-d-o-', .true.), &
        law_case('subloading, cohesive', law_subloading, 12, [subloading, 0.0_dp, 0.0_dp, bare, &
        c, 0.0_dp, unused(14:)], 'mmdddm-----d', .false.), &
        law_case('exact rate, cohesive', law_subloading, 12, [subloading, 1.0_dp, 0.0_dp, bare, &
        c, 0.0_dp, unused(14:)], 'mmdddm-----d', .false.), &
        law_case('cotangent, cohesive', law_subloading, 12, [subloading, 0.0_dp, 1.0_dp, bare, &
        c, 0.0_dp, unused(14:)], 'mmdddm-----d', .false.), &
        law_case('Coulomb, cohesive', law_coulomb, 5, [mu, bare, c, unused(6:)], 'm---d', &
        .false.), &
        law_case('static-kinetic, cohesive', law_static_kinetic, 7, [static_kinetic, bare, c, &
        unused(8:)], 'mmd---d', .true.), &
        law_case('rate-and-state, cohesive', law_rate_state, 11, [rate_state, 0.0_dp, theta_0, &
        bare, c, unused(12:)], 'mmddm-d---d', .true.), &
        law_case('slip-weakening, cohesive', law_slip_weakening, 7, [slip_weakening, bare, c, &
        unused(8:)], 'mmd---d', .false.), &
        law_case('cohesive and capped', law_subloading, 12, [subloading, 0.0_dp, 0.0_dp, &
        2.0_dp * tau_max, 0.0_dp, 0.0_dp, c, 0.0_dp, unused(14:)], 'mmdddm--d--d', .false.), &
        law_case('Coulomb, with all options', law_coulomb, 5, [mu, 2.0_dp * tau_max, associated, &
        c, unused(6:)], 'mdo-d', .false.), &
        law_case('exact, associated, cohesive', law_subloading, 12, [subloading, 1.0_dp, 0.0_dp, &
        0.0_dp, associated, c, 0.0_dp, unused(14:)], 'mmdddm---o-d', .false.), &
        law_case('slip law, radial, cohesive', law_rate_state, 11, [rate_state, 1.0_dp, theta_0, &
        0.0_dp, radial, c, unused(12:)], 'mmddm-d-o-d', .true.), &
        law_case('subloading, damped', law_subloading, 13, [subloading, 0.0_dp, 0.0_dp, bare, &
        0.0_dp, eta, unused(14:)], 'mmdddm------d', .true.), &
        law_case('exact rate, damped', law_subloading, 13, [subloading, 1.0_dp, 0.0_dp, bare, &
        0.0_dp, eta, unused(14:)], 'mmdddm------d', .true.), &
        law_case('Coulomb, damped', law_coulomb, 6, [mu, bare, 0.0_dp, eta, unused(7:)], &
        'm----d', .true.), &
        law_case('static-kinetic, damped', law_static_kinetic, 8, [static_kinetic, bare, 0.0_dp, &
        eta, unused(9:)], 'mmd----d', .true.), &
        law_case('rate-and-state, damped', law_rate_state, 12, [rate_state, 0.0_dp, theta_0, &
        bare, 0.0_dp, eta, unused(13:)], 'mmddm-d----d', .true.), &
        law_case('slip-weakening, damped', law_slip_weakening, 8, [slip_weakening, bare, 0.0_dp, &
        eta, unused(9:)], 'mmd----d', .true.), &
        law_case('associated, damped', law_coulomb, 6, [mu, 0.0_dp, associated, 0.0_dp, eta, &
        unused(7:)], 'm-o--d', .true.), &
        law_case('subloading, all options', law_subloading, 13, [subloading, 0.0_dp, 2.0_dp, &
        2.0_dp * tau_max, radial, c, eta, unused(14:)], 'mmdddm--do-dd', .true.), &
        law_case('healing, cohesive, damped', law_slip_weakening_healing, 9, [healing, bare, c, &
        eta, unused(10:)], 'mmdd---dd', .true.), &
        law_case('flash, cohesive, damped', law_flash_heating, 14, [flash_heating, bare, c, &
        eta], 'mmddmmd-d---dd', .true.)]

    !> Constants, state and increment of a contact point.
    type :: law_point
        real(dp), allocatable :: props(:)
        real(dp) :: statev(8), du(3), dt
        real(dp) :: ratio = 1.0_dp   !! mu_2/mu_1
        real(dp) :: cohesion = 0.0_dp, damping = 0.0_dp
        real(dp) :: reach   !! slips and elastic displacements are of this size [L]
    end type law_point

contains

    !> A point with a history of some increments, whose constants span `decades` each.
    function random_law_point(this, decades) result(p)
        type(law_case), intent(in) :: this
        real(dp), intent(in) :: decades
        type(law_point) :: p
        real(dp) :: half, factor, pressure, traction(3), tangent(3, 3)
        integer :: i, k, status

        half = 0.5_dp * decades
        factor = draw(0.1_dp, 1.0_dp)
        allocate (p%props(3 + this%n_own))
        p%props(1) = this%number
        p%props(2) = 1.0e3_dp * 10.0_dp**draw(-half, half)
        p%props(3) = 1.0e3_dp * 10.0_dp**draw(-half, half)
        do i = 1, this%n_own
            p%props(3 + i) = this%own(i)
            if (this%spread(i:i) == 'm') p%props(3 + i) = factor * this%own(i)
            if (this%spread(i:i) == 'd') p%props(3 + i) = this%own(i) * 10.0_dp**draw(-half, half)
            if (this%spread(i:i) == 'o') then
                p%ratio = this%own(i) * 10.0_dp**(0.7_dp * draw(-half, half))
                p%props(3 + i) = p%ratio
            end if
        end do
        i = friction_place(this%number, 'cohesion')
        if (size(p%props) >= i) p%cohesion = p%props(i)
        if (size(p%props) > i) p%damping = p%props(i + 1)
        pressure = 10.0_dp * 10.0_dp**draw(-half, half)
        p%reach = 0.4_dp * pressure / p%props(3)
        p%dt = 1.0e-3_dp * 10.0_dp**draw(-half, half)
        p%statev = 0.0_dp
        p%du = [-pressure / p%props(2), 0.0_dp, 0.0_dp]
        do k = 0, int(draw(0.0_dp, 4.0_dp))
            call friction_update(p%du, p%dt, p%props, p%statev, traction, tangent, status)
            if (status < 0) exit   ! the test meets it again
            factor = p%reach * 10.0_dp**draw(-half, half)
            p%du = [draw(-0.3_dp, 0.3_dp) * pressure / p%props(2), &
                draw(-1.0_dp, 1.0_dp) * factor, draw(-1.0_dp, 1.0_dp) * factor]
        end do
    end function random_law_point

    !> Has the contact a damper, whose force its state does not tell?
    pure function has_damper(this)
        type(law_case), intent(in) :: this
        logical :: has_damper

        has_damper = friction_place(this%number, 'eta_t') == 3 + this%n_own
    end function has_damper

    !> Traction and d(traction)/d(du) by the quadruple copy of the library, the latter by central
    !> differences: error about 1e-15 of the stiffness.
    subroutine exact_tangent(p, traction, tangent, status)
        type(law_point), intent(in) :: p
        real(dp), intent(out) :: traction(3), tangent(3, 3)
        integer, intent(out) :: status   !! of the update in quadruple precision
        real(qp) :: h, plus(3), minus(3), middle(3)
        integer :: j

        h = 1.0e-13_qp * (norm2(p%du) + norm2(p%statev(2:4)))
        call move(0, 0.0_qp, middle)
        if (status < 0) return
        traction = real(middle, dp)
        do j = 1, 3
            call move(j, h, plus)
            call move(j, -h, minus)
            tangent(:, j) = real((plus - minus) / (2.0_qp * h), dp)
        end do

    contains

        subroutine move(direction, by, f)
            integer, intent(in) :: direction   !! 0: none
            real(qp), intent(in) :: by
            real(qp), intent(out) :: f(3)
            real(qp) :: du(3), statev(8), unused(3, 3)

            du = p%du
            if (direction > 0) du(direction) = du(direction) + by
            statev = p%statev
            f = 0.0_qp
            call quad_update(du, real(p%dt, qp), real(p%props, qp), statev, f, unused, status)
        end subroutine move

    end subroutine exact_tangent

end module law_suite
