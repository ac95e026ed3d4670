!> Reads what a run is told to do: the groups and keys of the input file, their defaults and rules.
module run_reader
    use, intrinsic :: iso_fortran_env, only : dp => real64, int64
    use archive_file, only : mix
    use block_reader, only : check_blocks_at_start, read_block_friction
    use chain_reader, only : read_chain
    use drive_reader, only : read_drive
    use friction_mod, only : facts => law_facts, friction_facts, onset_gradual
    use input_fingerprint, only : listing_fingerprint
    use law_facts, only : has_r, largest_pressure_effect, pressure_effect, typical_strength
    use law_input, only : refuse_orthotropy
    use namelist_input, only : above, any_number, at_least, between, namelist_file
    use number_text, only : short_text
    use run_settings, only : settings
    use unit_reader, only : read_units
    implicit none
    private

    public :: read_settings

contains

    !> Takes the settings from a file; every fault is left in `file%faults`.
    subroutine read_settings(file, run)
        type(namelist_file), intent(inout) :: file
        type(settings), intent(out) :: run
        real(dp) :: normal

        call file%require_groups(['friction', 'slider  ', 'drive   ', 'time    '])
        call file%get_real('slider', 'mass', run%mass, at_least(0.0_dp))
        call read_chain(file, run%mass, run%chain)
        call read_contact(file, run)
        call read_block_friction(file, run)
        call refuse_orthotropy(file, 'blocks')
        call file%get_real('slider', 'stiffness', run%stiffness, above(0.0_dp))
        call file%get_real('slider', 'damping', run%damping, at_least(0.0_dp), default=0.0_dp)
        call file%get_real('slider', 'area', run%area, above(0.0_dp), default=1.0_dp)
        call read_normal_motion(file, run)
        if (file%given('drive', 'normal') .or. file%given('drive', 'file')) then
            call file%get_real('slider', 'normal_traction', normal, at_least(0.0_dp), &
                default=0.0_dp)
        else
            call file%get_real('slider', 'normal_traction', normal, above(0.0_dp))
        end if
        call read_drive(file, normal, run%drive)
        call read_initial(file, run)
        call read_time(file, run)
        if (run%adaptive .and. size(file%faults) == 0) then   ! a part of nothing cannot be met
            if (.not. typical_strength(run%props, run%drive%largest_normal()) > 0.0_dp) call &
                file%reject('time', 'rtol', 'is relative to the static friction force, which ' &
                // 'is 0 here')
        end if
        if (run%across%free() .and. run%chain%n_blocks > 1) call file%reject('slider', &
            'normal_mass', 'is for one block')
        call check_contact(file, run)
        if (run%adaptive .and. allocated(run%drive%normal)) then
            call check_damper(file, run)
            call check_massless(file, run)
            call check_pressing(file, run)
        end if
        call derive_slip_rate(file, run)
        call file%get_real('events', 'drop', run%event_drop, above(0.0_dp), default=1.0e-3_dp)
        if (file%given('events', 'slip_rate')) call file%get_real('events', 'slip_rate', &
            run%event_slip_rate, above(0.0_dp))
        call file%get_real('output', 'table_limit', run%table_limit, above(0.0_dp), default=10.0_dp)
        call read_units(file, run%units)
        call read_rows(file, run)
        call file%get_real('output', 'checkpoint', run%checkpoint, at_least(0.0_dp), &
            default=60.0_dp)
        call file%get_integer('output', 'fields', run%fields, at_least(0.0_dp), default=0)
        if (run%fields > 0 .and. run%chain%n_blocks == 1) call file%reject('output', 'fields', &
            'needs a chain of two or more blocks')
        call file%refuse_unknown()
        run%fingerprint = fingerprint_of(file%listing(without='sweep'), run)
    end subroutine read_settings

    !> Mass, spring and damper across the interface. The springs of both directions are one: its
    !> energy must not be negative, whichever way the block goes.
    subroutine read_normal_motion(file, run)
        type(namelist_file), intent(inout) :: file
        type(settings), intent(inout) :: run
        character(len=*), parameter :: group = 'slider'
        character(len=16), parameter :: others(3) = [character(len=16) :: 'normal_stiffness', &
            'normal_damping', 'tilt_stiffness']
        integer :: i

        if (file%given(group, 'normal_mass')) then
            call file%get_real(group, 'normal_mass', run%across%mass, above(0.0_dp))
            if (.not. run%mass > 0.0_dp) call file%reject(group, 'normal_mass', 'needs a mass > 0')
        else
            do i = 1, size(others)
                call file%refuse(group, trim(others(i)), 'needs a normal_mass')
            end do
        end if
        call file%get_real(group, 'normal_stiffness', run%across%stiffness, at_least(0.0_dp), &
            default=0.0_dp)
        call file%get_real(group, 'normal_damping', run%across%damping, at_least(0.0_dp), &
            default=0.0_dp)
        call file%get_real(group, 'tilt_stiffness', run%across%tilt, any_number(), default=0.0_dp)
        if (run%across%tilt**2 > run%stiffness * run%across%stiffness) call file%reject(group, &
            'tilt_stiffness', 'must not exceed sqrt(stiffness normal_stiffness) in magnitude')
    end subroutine read_normal_motion

    !> A number that is another one for any other input, but for keys that change no results.
    pure integer(int64) function fingerprint_of(listing, run) result(number)
        character(len=*), intent(in) :: listing   !! of the namelists, a line a key
        type(settings), intent(in) :: run         !! files that they name included

        number = listing_fingerprint(listing)
        if (allocated(run%chain%load)) call mix(transfer(run%chain%load, [number]), number)
        if (allocated(run%chain%constants)) call mix(transfer(run%chain%constants, [number]), &
            number)
        associate (drive => run%drive)
            if (allocated(drive%start)) call mix(transfer([drive%start, drive%velocity, &
                drive%acceleration, drive%normal, drive%normal_rate], [number]), number)
        end associate
    end function fingerprint_of

    !> When rows of the time series are due.
    subroutine read_rows(file, run)
        type(namelist_file), intent(inout) :: file
        type(settings), intent(inout) :: run
        character(len=*), parameter :: group = 'output'
        real(dp), parameter :: most_rows = 1.0e9_dp

        call file%get_integer(group, 'interval', run%interval, at_least(1.0_dp), default=1)
        if (.not. file%given(group, 'every')) return
        call file%get_real(group, 'every', run%every, above(0.0_dp))
        if (.not. run%adaptive) call file%reject(group, 'every', 'needs &time rtol')
        if (file%given(group, 'interval')) call file%reject(group, 'every', &
            'give it or interval, not both')
        if (run%every > 0.0_dp .and. run%every * most_rows < run%t_end) call file%reject(group, &
            'every', 'gives more than 1e9 rows')
        run%interval = huge(run%interval)
    end subroutine read_rows

    !> Slip of a chain's block counts as an event's from a part of the velocity on that a block
    !> reaches when friction falls from static to kinetic. Where no such fall is known, as under
    !> rate-and-state friction, it is a multiple of the drive's largest velocity.
    subroutine derive_slip_rate(file, run)
        type(namelist_file), intent(inout) :: file
        type(settings), intent(inout) :: run
        real(dp), parameter :: part = 0.05_dp, multiple = 10.0_dp
        type(facts) :: law

        if (run%chain%n_blocks == 1 .or. run%chain%slip_rate > 0.0_dp) return
        if (size(file%faults) > 0) return
        law = friction_facts(run%props)
        run%chain%slip_rate = part * run%area * (law%typical_coefficient &
            - law%kinetic_coefficient) * run%drive%largest_normal() &
            / sqrt(run%stiffness * run%mass)
        if (run%chain%slip_rate > 0.0_dp) return
        run%chain%slip_rate = multiple * maxval(abs(run%drive%velocity))
        if (run%chain%slip_rate <= 0.0_dp) call file%add_fault(file%line_of_group('chain'), &
            '&chain slip_rate: is missing: give the slip rate above which a block belongs to ' &
            // 'an event. It has no default if friction does not fall from static to ' &
            // 'kinetic and the drive never moves')
    end subroutine derive_slip_rate

    !> How the block starts.
    subroutine read_initial(file, run)
        type(namelist_file), intent(inout) :: file
        type(settings), intent(inout) :: run
        character(len=*), parameter :: group = 'initial'

        run%initial%any_given = file%has_group(group)
        if (.not. run%initial%any_given) return
        call read_initial_friction(file, run)
        associate (start => run%initial)
            call file%get_real(group, 'displacement', start%displacement, any_number(), &
                default=0.0_dp)
            call file%get_real(group, 'velocity', start%velocity, any_number(), default=0.0_dp)
            call file%get_real(group, 'spring_force', start%spring_force, any_number(), &
                default=0.0_dp)
            start%spring_given = file%given(group, 'spring_force')
            call check_blocks_at_start(file, run)
            if (run%mass <= 0.0_dp) then
                call file%refuse(group, 'spring_force', &
                    'needs a mass > 0: without, it is the friction force')
                call file%refuse(group, 'velocity', 'needs a mass > 0')
            end if
        end associate
    end subroutine read_initial

    !> A law without R starts from the friction that `mu` mobilises, its own variable as virgin.
    subroutine read_initial_friction(file, run)
        type(namelist_file), intent(inout) :: file
        type(settings), intent(inout) :: run
        character(len=*), parameter :: group = 'initial'
        character(len=:), allocatable :: key
        type(facts) :: law
        logical :: alike   ! or what they can have is asked block by block

        law = friction_facts(run%props)
        alike = .not. (allocated(run%chain%constants) .or. run%chain%loads_differ())
        associate (start => run%initial)
            start%has_r = has_r(run%props)
            start%mu_given = file%given(group, 'mu')
            call file%get_real(group, 'r', start%r, between(0.0_dp, 1.0_dp), default=0.0_dp)
            if (start%has_r) then
                key = 'r'
                call file%get_real(group, 'mu', start%mu, at_least(0.0_dp), default=law%virgin_mu)
                if (alike .and. (start%mu < law%kinetic_coefficient .or. start%mu &
                    > law%largest_coefficient)) call file%reject(group, 'mu', &
                    'must be from mu_k to mu_s')
            else
                key = 'mu'
                call file%get_real(group, 'mu', start%mu, at_least(0.0_dp), default=0.0_dp)
                start%r = merge(1.0_dp, 0.0_dp, start%mu > 0.0_dp)
                if (alike .and. start%mu > law%largest_coefficient) call file%reject(group, 'mu', &
                    'must not exceed the static friction coefficient, ' &
                    // short_text(law%largest_coefficient))
                call file%refuse(group, 'r', 'belongs to the law subloading')
            end if
            if (.not. allocated(run%drive%normal)) return
            if (start%r > 0.0_dp .and. run%drive%normal_traction(0.0_dp, 1) <= 0.0_dp) call &
                file%reject(group, key, 'must be 0 where the normal traction starts at 0')
            if (.not. alike) return
            if (start%r * (start%mu * run%drive%normal_traction(0.0_dp, 1) + merge(law%cohesion, &
                0.0_dp, start%has_r)) > law%shear_cap) then
                call file%reject(group, key, 'makes a tangential traction above tau_max = ' &
                    // short_text(law%shear_cap))
            end if
        end associate
    end subroutine read_initial_friction

    subroutine read_time(file, run)
        type(namelist_file), intent(inout) :: file
        type(settings), intent(inout) :: run
        character(len=*), parameter :: group = 'time'
        real(dp) :: steps
        integer :: faults_before

        faults_before = size(file%faults)
        call file%get_real(group, 't_end', run%t_end, above(0.0_dp))
        run%adaptive = file%given(group, 'rtol')
        call read_method(file, run)
        if (run%adaptive) then
            call read_adaptive(file, run)
        else
            call file%get_real(group, 'dt', run%dt, above(0.0_dp))
            call file%refuse(group, 'dt_min', 'needs rtol')
            call file%refuse(group, 'dt_max', 'needs rtol')
        end if
        run%n_steps = 0
        if (size(file%faults) > faults_before .or. .not. min(run%dt, run%t_end) > 0.0_dp) return
        if (run%dt > run%t_end) call file%reject(group, 'dt', 'must not exceed t_end')
        if (run%adaptive) return
        if (run%t_end > run%dt * real(huge(run%n_steps) - 1, dp)) call file%reject(group, 'dt', &
            'gives more than 2147483647 steps up to t_end')
        if (size(file%faults) > faults_before) return
        steps = run%t_end / run%dt
        run%n_steps = nint(steps)
        if (abs(steps - run%n_steps) > 1.0e-9_dp * steps) run%n_steps = ceiling(steps)   ! last is
                                                                                         ! short
    end subroutine read_time

    !> Newmark's or the generalised-alpha method, and Newton's.
    subroutine read_method(file, run)
        type(namelist_file), intent(inout) :: file
        type(settings), intent(inout) :: run
        character(len=*), parameter :: group = 'time'

        call file%get_real(group, 'beta', run%beta, between(0.01_dp, 1.0_dp), default=0.25_dp)
        call file%get_real(group, 'gamma', run%gamma, between(0.5_dp, 1.0_dp), &
            default=merge(0.5_dp, 1.0_dp, run%mass > 0.0_dp))
        run%rho_infinity = -1.0_dp
        if (file%given(group, 'rho_infinity')) then
            call file%get_real(group, 'rho_infinity', run%rho_infinity, between(0.0_dp, 1.0_dp))
            call file%refuse(group, 'beta', 'follows from rho_infinity: give one of them')
            call file%refuse(group, 'gamma', 'follows from rho_infinity: give one of them')
            if (run%mass <= 0.0_dp) call file%reject(group, 'rho_infinity', 'needs a mass > 0')
        end if
        call file%get_real(group, 'tolerance', run%tolerance, above(0.0_dp), default=1.0e-10_dp)
        call file%get_integer(group, 'max_iterations', run%max_iterations, &
            between(1.0_dp, 1.0e6_dp), default=25)
    end subroutine read_method

    !> Steps that the error chooses.
    subroutine read_adaptive(file, run)
        type(namelist_file), intent(inout) :: file
        type(settings), intent(inout) :: run
        character(len=*), parameter :: group = 'time'
        type(facts) :: law

        call file%get_real(group, 'rtol', run%rtol, between(1.0e-12_dp, 0.1_dp))
        call file%get_real(group, 'dt_max', run%dt_max, above(0.0_dp), default=run%t_end)
        call file%get_real(group, 'dt_min', run%dt_min, above(0.0_dp), default=0.0_dp)
        call file%get_real(group, 'dt', run%dt, above(0.0_dp), &
            default=min(run%dt_max, max(run%dt_min, 1.0e-6_dp * run%t_end)))
        if (run%dt_min > run%dt_max) call file%reject(group, 'dt_min', 'must not exceed dt_max')
        law = friction_facts(run%props)
        run%order = max(1, law%order)
        run%newmark = any([file%given(group, 'beta'), file%given(group, 'gamma'), &
            file%given(group, 'rho_infinity')])
    end subroutine read_adaptive

    !> A damper beside the contact spring, with adaptive steps.
    subroutine check_damper(file, run)
        type(namelist_file), intent(inout) :: file
        type(settings), intent(in) :: run
        character(len=*), parameter :: group = 'friction', key = 'eta_t'
        type(facts) :: law

        law = friction_facts(run%props)
        if (.not. law%damping > 0.0_dp) return
        if (.not. run%one_by_itself()) then
            call file%reject(group, key, 'needs fixed steps (&time dt) in a chain')
        else if (run%newmark) then
            call file%reject(group, key, 'needs fixed steps (&time dt) beside beta, gamma and ' &
                // 'rho_infinity')
        else if (law%damping <= law%rate_weakening * run%drive%largest_normal()) then
            call file%reject(group, key, 'must exceed d_c (mu_s - mu_k) normal_traction with ' &
                // 'adaptive steps (&time rtol), or the contact sticks and slips without end')
        else if (.not. (run%mass > 0.0_dp .or. run%damping > 0.0_dp .or. law%traits%stiff)) then
            call file%reject(group, key, 'needs a mass or a damping of the slider with adaptive ' &
                // 'steps (&time rtol)')
        end if
    end subroutine check_damper

    !> A block without mass in continuous time: does its velocity follow from the balance of forces?
    subroutine check_massless(file, run)
        type(namelist_file), intent(inout) :: file
        type(settings), intent(in) :: run
        character(len=*), parameter :: group = 'slider', key = 'damping'
        type(facts) :: law
        real(dp) :: falls

        law = friction_facts(run%props)
        if (run%mass > 0.0_dp .or. run%newmark .or. law%damping > 0.0_dp) return
        falls = run%area * law%rate_weakening * run%drive%largest_normal()
        if (falls > 0.0_dp .and. run%damping <= falls) then
            call file%reject(group, key, 'must exceed area d_c (mu_s - mu_k) normal_traction ' &
                // 'without mass and with adaptive steps (&time rtol): otherwise no velocity ' &
                // 'balances the forces')
        else if (run%rigid_contact .and. .not. run%damping > 0.0_dp .and. law%traits%onset &
            /= onset_gradual) then
            call file%reject(group, key, 'or mass must be > 0 with contact = ''rigid'': ' &
                // 'otherwise the velocity of the block is undetermined under this law')
        end if
    end subroutine check_massless

    !> A state that grows as the normal traction vanishes, in adaptive steps that are not in
    !> continuous time: where it would leave the range of numbers the contact counts as open
    !> (`adaptive_steps`), which must not be far from the truth.
    subroutine check_pressing(file, run)
        type(namelist_file), intent(inout) :: file
        type(settings), intent(in) :: run

        if (run%one_by_itself() .and. .not. run%newmark .or. .not. run%load_vanishes()) return
        if (pressure_effect(run%props, run%chain%constants) <= largest_pressure_effect) return
        call file%reject('friction', 'alpha', 'must not exceed 28 b with a normal traction that ' &
            // 'vanishes in adaptive steps (&time rtol) of chains, or with beta, gamma or ' &
            // 'rho_infinity: the state would leave the range of numbers')
    end subroutine check_pressing

    !> Where continuous time does without the spring of the contact, its stiffness may be left out.
    subroutine read_contact(file, run)
        type(namelist_file), intent(inout) :: file
        type(settings), intent(inout) :: run
        character(len=*), parameter :: group = 'friction'
        character(len=:), allocatable :: contact

        call file%get_choice(group, 'contact', contact, ['elastic', 'rigid  '], default='elastic')
        run%rigid_contact = contact == 'rigid'
        if (run%rigid_contact) call file%assume(group, 'alpha_t', '1')
    end subroutine read_contact

    !> What a contact without spring needs.
    subroutine check_contact(file, run)
        type(namelist_file), intent(inout) :: file
        type(settings), intent(in) :: run
        character(len=*), parameter :: group = 'friction', key = 'contact'
        type(facts) :: law

        if (.not. run%rigid_contact) return
        if (.not. run%adaptive .or. run%newmark .or. .not. run%one_by_itself()) call file%reject( &
            group, key, 'needs adaptive steps (&time rtol) of one block, without beta, gamma and ' &
            // 'rho_infinity')
        if (has_r(run%props)) call file%reject(group, key, &
            'is not possible for the law subloading, whose R needs the contact spring')
        law = friction_facts(run%props)
        if (law%damping > 0.0_dp) call file%reject(group, key, &
            'has no contact spring, and so no damper (eta_t) either')
        if (run%across%free() .and. pressure_effect(run%props) > 0.0_dp) call file%reject(group, &
            key, 'is not possible for a state that depends on the pressure (alpha) with a ' &
            // 'normal_mass')
        if (law%traits%onset == onset_gradual .and. law%cohesion > 0.0_dp) call file%reject(group, &
            key, 'cannot have cohesion under rate-and-state friction')
    end subroutine check_contact

end module run_reader
