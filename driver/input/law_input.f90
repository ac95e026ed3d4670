!> The group &friction of the input file: which law, and its constants in the order of `props`
!> (docs/laws.md).
module law_input
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use friction_mod, only : direction_associated, direction_radial, friction_message, &
        friction_update, largest_mu_ratio, law_coulomb, law_rate_state, law_slip_weakening, &
        law_static_kinetic, law_subloading, scheme_backward_euler, scheme_exact_rate, &
        statev_size, u_cotangent, u_logarithm, u_reciprocal
    use namelist_input, only : above, at_least, between, namelist_file
    implicit none
    private

    public :: read_friction

    character(len=*), parameter :: group = 'friction'

contains

    !> Constants of the friction law; every fault is left in `file%faults`.
    subroutine read_friction(file, props)
        type(namelist_file), intent(inout) :: file
        real(dp), allocatable, intent(out) :: props(:)
        character(len=*), parameter :: names(5) = ['subloading    ', 'coulomb       ', &
            'static_kinetic', 'rate_and_state', 'slip_weakening']
        character(len=:), allocatable :: law
        real(dp) :: alpha_n, alpha_t
        real(dp), allocatable :: own(:), options(:)
        integer :: faults_before, number

        faults_before = size(file%faults)
        call file%get_choice(group, 'law', law, names, default=trim(names(1)))
        call file%get_real(group, 'alpha_n', alpha_n, above(0.0_dp))
        call file%get_real(group, 'alpha_t', alpha_t, above(0.0_dp))
        select case (law)
        case ('coulomb')
            number = law_coulomb
            call read_coulomb(file, own)
        case ('static_kinetic')
            number = law_static_kinetic
            call read_static_kinetic(file, own)
        case ('rate_and_state')
            number = law_rate_state
            call read_rate_and_state(file, own)
        case ('slip_weakening')
            number = law_slip_weakening
            call read_slip_weakening(file, own)
        case default
            number = law_subloading
            call read_subloading(file, own)
        end select
        call read_options(file, options)
        props = [real(number, dp), alpha_n, alpha_t, own, options]
        if (size(file%faults) == faults_before .and. file%has_group(group)) call try_props(file, &
            props)
    end subroutine read_friction

    !> Options that every law has: shear cap, orthotropy.
    subroutine read_options(file, options)
        type(namelist_file), intent(inout) :: file
        real(dp), allocatable, intent(out) :: options(:)
        character(len=:), allocatable :: direction
        real(dp) :: tau_max, mu_ratio
        integer :: number

        call file%get_real(group, 'tau_max', tau_max, at_least(0.0_dp), default=0.0_dp)
        call file%get_real(group, 'mu_ratio', mu_ratio, between(1.0_dp / largest_mu_ratio, &
            largest_mu_ratio), default=1.0_dp)
        call file%get_choice(group, 'direction', direction, ['associated', 'radial    '], &
            default='associated')
        number = direction_associated
        if (direction == 'radial') number = direction_radial
        options = [tau_max, mu_ratio, real(number, dp)]
    end subroutine read_options

    subroutine read_subloading(file, own)
        type(namelist_file), intent(inout) :: file
        real(dp), allocatable, intent(out) :: own(:)
        character(len=:), allocatable :: scheme, u_of_r
        real(dp) :: mu_s, mu_k, kappa, xi, m, mu_0
        integer :: faults_before, number, evolution

        faults_before = size(file%faults)
        call read_coefficients(file, mu_s, mu_k)
        call file%get_real(group, 'kappa', kappa, at_least(0.0_dp))
        call file%get_real(group, 'xi', xi, at_least(0.0_dp))
        call file%get_real(group, 'm', m, above(0.0_dp))
        call file%get_real(group, 'mu_0', mu_0, at_least(0.0_dp), default=mu_s)
        call file%get_choice(group, 'scheme', scheme, ['backward_euler', 'exact_rate    '], &
            default='backward_euler')
        number = scheme_backward_euler
        if (scheme == 'exact_rate') number = scheme_exact_rate
        call file%get_choice(group, 'u_of_r', u_of_r, ['logarithm ', 'cotangent ', 'reciprocal'], &
            default='logarithm')
        evolution = u_logarithm
        if (u_of_r == 'cotangent') evolution = u_cotangent
        if (u_of_r == 'reciprocal') evolution = u_reciprocal
        own = [mu_s, mu_k, kappa, xi, m, mu_0, real(number, dp), real(evolution, dp)]
        if (size(file%faults) > faults_before) return
        if (number == scheme_exact_rate .and. evolution /= u_logarithm) call file%reject(group, &
            'u_of_r', "must be 'logarithm' with scheme = 'exact_rate'")
        if (mu_0 < mu_k .or. mu_0 > mu_s) call file%reject(group, 'mu_0', &
            'must be from mu_k to mu_s')
    end subroutine read_subloading

    subroutine read_coulomb(file, own)
        type(namelist_file), intent(inout) :: file
        real(dp), allocatable, intent(out) :: own(:)
        real(dp) :: mu

        call file%get_real(group, 'mu', mu, at_least(0.0_dp))
        own = [mu]
    end subroutine read_coulomb

    subroutine read_static_kinetic(file, own)
        type(namelist_file), intent(inout) :: file
        real(dp), allocatable, intent(out) :: own(:)
        real(dp) :: mu_s, mu_k, d_c

        call read_coefficients(file, mu_s, mu_k)
        call file%get_real(group, 'd_c', d_c, at_least(0.0_dp))
        own = [mu_s, mu_k, d_c]
    end subroutine read_static_kinetic

    subroutine read_rate_and_state(file, own)
        type(namelist_file), intent(inout) :: file
        real(dp), allocatable, intent(out) :: own(:)
        character(len=*), parameter :: evolutions(0:1) = ['ageing', 'slip  ']
        character(len=:), allocatable :: evolution
        real(dp) :: a, b, d_c, v0, f0, theta_0, steady

        call file%get_real(group, 'a', a, above(0.0_dp))
        call file%get_real(group, 'b', b, at_least(0.0_dp))
        call file%get_real(group, 'd_c', d_c, above(0.0_dp))
        call file%get_real(group, 'v0', v0, above(0.0_dp))
        call file%get_real(group, 'f0', f0, at_least(0.0_dp))
        call file%get_choice(group, 'evolution', evolution, evolutions, &
            default=trim(evolutions(0)))
        steady = 0.0_dp
        if (v0 > 0.0_dp) steady = d_c / v0   ! of sliding at v0
        call file%get_real(group, 'theta_0', theta_0, above(0.0_dp), default=steady)
        own = [a, b, d_c, v0, f0, merge(1.0_dp, 0.0_dp, evolution == evolutions(1)), theta_0]
    end subroutine read_rate_and_state

    subroutine read_slip_weakening(file, own)
        type(namelist_file), intent(inout) :: file
        real(dp), allocatable, intent(out) :: own(:)
        real(dp) :: mu_s, mu_k, d_c

        call read_coefficients(file, mu_s, mu_k)
        call file%get_real(group, 'd_c', d_c, above(0.0_dp))
        own = [mu_s, mu_k, d_c]
    end subroutine read_slip_weakening

    !> Static and kinetic friction coefficient, of which the static one is the larger.
    subroutine read_coefficients(file, mu_s, mu_k)
        type(namelist_file), intent(inout) :: file
        real(dp), intent(out) :: mu_s, mu_k
        integer :: faults_before

        faults_before = size(file%faults)
        call file%get_real(group, 'mu_s', mu_s, at_least(0.0_dp))
        call file%get_real(group, 'mu_k', mu_k, at_least(0.0_dp))
        if (size(file%faults) > faults_before) return
        if (mu_s < mu_k) call file%reject(group, 'mu_s', 'must be >= mu_k')
    end subroutine read_coefficients

    !> The routine itself decides whether it takes the constants.
    subroutine try_props(file, props)
        type(namelist_file), intent(inout) :: file
        real(dp), intent(in) :: props(:)
        real(dp) :: statev(statev_size), traction(2), tangent(2, 2)
        integer :: status

        statev = 0.0_dp
        call friction_update([0.0_dp, 0.0_dp], 0.0_dp, props, statev, traction, tangent, status)
        if (status < 0) call file%add_fault(0, '&friction: ' // friction_message(status))
    end subroutine try_props

end module law_input
