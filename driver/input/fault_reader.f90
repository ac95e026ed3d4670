!> Reads what a run of the fault is told to do: the groups &fault, &friction, &time and &output,
!> their defaults and rules (docs/fault.md).
!>
!> A constant of friction, the normal traction or the initial state may be given as '@file.csv':
!> columns z, or x and z, and one of the key's name. The constants of each node are read by the
!> reader of &friction, as if they stood in the input, so that each has its law's rules.
module fault_reader
    use, intrinsic :: iso_fortran_env, only : dp => real64, int64
    use archive_file, only : mix
    use csv_table, only : table_reader
    use fault_settings, only : fault_plan
    use friction_mod, only : friction_facts, onset_drops
    use grid_map, only : map_on_grid
    use input_fingerprint, only : listing_fingerprint
    use input_kind, only : refuse_other_verb
    use law_input, only : read_friction, refuse_orthotropy
    use namelist_input, only : above, any_number, at_least, between, namelist_file, rule
    use number_text, only : full_row, rounded_text, six_digits
    use profile_reader, only : joined, profile, put_number, read_map, take_profiles
    use text_file, only : gigabyte
    use unit_reader, only : read_units
    implicit none
    private

    public :: read_fault_plan

    character(len=*), parameter :: group = 'fault'
    character(len=1), parameter :: axes(2) = ['x', 'z']
    character(len=*), parameter :: along_strike = "belongs to geometry = 'half' or 'whole'"

contains

    !> Takes the plan from a file; every fault is left in `file%faults`.
    subroutine read_fault_plan(file, plan, read_netcdf)
        type(namelist_file), intent(inout) :: file
        type(fault_plan), intent(out) :: plan
        procedure(table_reader), optional :: read_netcdf   !! what reads NetCDF files, if anything
        logical :: refused

        call refuse_other_verb('fault', file, refused)
        if (refused) return
        call file%require_groups(['fault   ', 'friction', 'time    '])
        call read_surroundings(file, plan)
        call read_constants(file, plan, read_netcdf)
        call read_initial(file, plan, read_netcdf)
        call read_times(file, plan)
        call read_output(file, plan)
        call refuse_orthotropy(file, 'faults')
        call read_units(file, plan%units)
        plan%fingerprint = fingerprint_of(file%listing(without=''), plan)
        call file%refuse_unknown()
    end subroutine read_fault_plan

    !> Geometry and elasticity.
    subroutine read_surroundings(file, plan)
        type(namelist_file), intent(inout) :: file
        type(fault_plan), intent(inout) :: plan
        real(dp), parameter :: most_cells = 2.0e9_dp

        call file%get_choice(group, 'geometry', plan%geometry, ['antiplane_half', &
            'half          ', 'whole         '], default='antiplane_half')
        call file%get_integer(group, 'nz', plan%nz, between(2.0_dp, 1.0e8_dp), default=0)
        call file%require(group, 'nz')
        call file%get_real(group, 'width', plan%width, above(0.0_dp))
        call file%get_real(group, 'shear_modulus', plan%shear_modulus, above(0.0_dp))
        call file%get_real(group, 'wave_speed', plan%wave_speed, above(0.0_dp))
        if (plan%geometry == 'antiplane_half') then
            call file%belongs_elsewhere(group, 'nx', along_strike)
            call file%belongs_elsewhere(group, 'length', along_strike)
            call file%belongs_elsewhere(group, 'poisson', along_strike)
        else
            call file%get_integer(group, 'nx', plan%nx, between(2.0_dp, 1.0e8_dp), default=0)
            call file%require(group, 'nx')
            call file%get_real(group, 'length', plan%length, above(0.0_dp))
            call file%get_real(group, 'poisson', plan%poisson, between(0.0_dp, 0.5_dp), &
                default=0.25_dp)
            if (real(plan%nx, dp) * plan%nz > most_cells) call file%reject(group, 'nx', &
                'times nz gives more than 2e9 cells')
        end if
    end subroutine read_surroundings

    ! ---- friction ----------------------------------------------------------------------------

    !> Constants of friction and normal traction, at all nodes that any of them has.
    subroutine read_constants(file, plan, read_netcdf)
        type(namelist_file), intent(inout) :: file
        type(fault_plan), intent(inout) :: plan
        procedure(table_reader), optional :: read_netcdf
        type(profile), allocatable :: profiles(:)
        real(dp), allocatable :: x(:), z(:), props(:)
        real(dp) :: normal, value(1)
        integer :: faults_before, i, j, k
        logical :: drops

        call take_profiles(file, group, axes, profiles, read_netcdf)
        drops = .false.
        faults_before = size(file%faults)
        call add_springs(file, plan)
        call join_nodes(profiles, x, z)
        do k = 1, size(z)
            do i = 1, size(x)
                do j = 1, size(profiles)   ! the names of files
                    value = profiles(j)%map%at(x(i), z(k))
                    call put_number(file, profiles(j)%group, profiles(j)%key, value(1))
                end do
                call read_friction(file, props)
                call file%get_real(group, 'normal_traction', normal, above(0.0_dp))
                if (size(file%faults) > faults_before) then
                    call tell_node(file, faults_before, profiles, x(i), z(k))
                    return
                end if
                if (.not. allocated(plan%constants%values)) allocate ( &
                    plan%constants%values(size(props) + 1, size(x), size(z)))
                plan%constants%values(:, i, k) = [props, normal]
                associate (known => friction_facts(props))
                    plan%rate_state = known%traits%logarithmic
                    drops = drops .or. known%traits%onset == onset_drops
                end associate
            end do
        end do
        if (plan%rate_state) call file%refuse('friction', 'theta_0', &
            'has no effect on a fault, whose states follow from slip rates and tractions')
        call file%refuse('friction', 'eta_t', &
            'has no effect on a fault, whose slip does not depend on its contact springs')
        plan%constants%x = x
        plan%constants%z = z
        if (drops) call file%reject('friction', 'law', 'has friction that falls with the slip ' &
            // 'rate alone: ruptures have no length scale, and no cells are small enough')
        plan%explicit = plan%rate_state
    end subroutine read_constants

    !> The fault's contact springs: any stiff ones do, since slip is told from elastic displacement.
    subroutine add_springs(file, plan)
        type(namelist_file), intent(inout) :: file
        type(fault_plan), intent(in) :: plan
        real(dp), parameter :: stiffer = 1.0e3_dp   !! than the surroundings of a cell
        real(dp) :: stiffness   !! [F/L^3]

        stiffness = 1.0_dp
        if (min(plan%width, plan%shear_modulus, real(plan%nz, dp)) > 0.0_dp) stiffness = stiffer &
            * plan%shear_modulus / plan%dz()   ! else no fault that follows from another
        call file%assume('friction', 'alpha_n', full_row([stiffness]))
        call file%assume('friction', 'alpha_t', full_row([stiffness]))
    end subroutine add_springs

    !> Where it is that constants of a profile are refused.
    subroutine tell_node(file, faults_before, profiles, x, z)
        type(namelist_file), intent(inout) :: file
        integer, intent(in) :: faults_before   !! those behind are of this node
        type(profile), intent(in) :: profiles(:)
        real(dp), intent(in) :: x, z
        logical :: of_profile
        integer :: i, j

        of_profile = .false.
        do i = faults_before + 1, size(file%faults)
            do j = 1, size(profiles)
                of_profile = of_profile .or. index(file%faults(i)%text, '&' // profiles(j)%group &
                    // ' ' // profiles(j)%key // ' ') == 1
            end do
        end do
        if (.not. of_profile) return
        call file%add_fault(0, 'the constants of friction at x = ' // six_digits(x) // ', z = ' &
            // six_digits(z) // ' are refused')
    end subroutine tell_node

    !> All nodes of all profiles.
    pure subroutine join_nodes(profiles, x, z)
        type(profile), intent(in) :: profiles(:)
        real(dp), allocatable, intent(out) :: x(:), z(:)
        integer :: i

        x = [real(dp) ::]
        z = [real(dp) ::]
        do i = 1, size(profiles)
            x = joined(x, profiles(i)%map%x)
            z = joined(z, profiles(i)%map%z)
        end do
        if (size(x) == 0) x = [0.0_dp]
        if (size(z) == 0) z = [0.0_dp]
    end subroutine join_nodes

    ! ---- the rest ----------------------------------------------------------------------------

    subroutine read_initial(file, plan, read_netcdf)
        type(namelist_file), intent(inout) :: file
        type(fault_plan), intent(inout) :: plan
        procedure(table_reader), optional :: read_netcdf
        character(len=9), parameter :: columns(2) = ['traction ', 'slip_rate']
        character(len=:), allocatable :: how
        type(rule) :: moving
        logical :: sound, by_rate

        call file%get_choice(group, 'initial', how, ['steady', 'file  '], default='steady')
        plan%steady = how == 'steady'
        if (plan%steady) then
            moving = above(0.0_dp)
            moving%text = moving%text // " with initial = 'steady'"
            call file%get_real(group, 'plate_rate', plan%plate_rate, moving)
            call file%belongs_elsewhere(group, 'initial_file', "needs initial = 'file'")
            return
        end if
        call file%get_real(group, 'plate_rate', plan%plate_rate, at_least(0.0_dp))
        call file%require(group, 'initial_file')
        by_rate = plan%rate_state .and. allocated(plan%constants%z)   ! else the law is not known
        call read_map(file, group, 'initial_file', axes, columns(:merge(2, 1, by_rate)), &
            plan%initial, sound, read_netcdf)
        if (.not. sound) return
        if (by_rate) then
            if (any(plan%initial%values(1, :, :) <= 0.0_dp)) call file%reject(group, &
                'initial_file', 'its column traction must be > 0: it drives the slip rate')
            if (any(plan%initial%values(2, :, :) <= 0.0_dp)) call file%reject(group, &
                'initial_file', 'its column slip_rate must be > 0')
        else if (any(plan%initial%values(1, :, :) < 0.0_dp)) then
            call file%reject(group, 'initial_file', 'its column traction must be >= 0')
        end if
    end subroutine read_initial

    subroutine read_times(file, plan)
        type(namelist_file), intent(inout) :: file
        type(fault_plan), intent(inout) :: plan
        character(len=:), allocatable :: scheme

        call file%get_real('time', 't_end', plan%t_end, above(0.0_dp))
        call file%get_real('time', 'rtol', plan%rtol, between(1.0e-10_dp, 1.0e-1_dp), &
            default=1.0e-4_dp)
        call file%get_choice('time', 'scheme', scheme, ['auto    ', 'explicit', 'implicit'], &
            default='auto')
        if (scheme == 'explicit' .and. .not. plan%explicit .and. allocated(plan%constants%z)) then
            call file%reject('time', 'scheme', &
                "needs a law that gives the slip rate: law = 'rate_and_state', " &
                // "'flash_heating', 'linker_dieterich'")
        end if
        if (scheme == 'implicit' .or. (scheme == 'auto' .and. file%given('friction', &
            'tau_max'))) plan%explicit = .false.   ! what slides under a cap is stiff
    end subroutine read_times

    subroutine read_output(file, plan)
        type(namelist_file), intent(inout) :: file
        type(fault_plan), intent(inout) :: plan

        call file%get_reals('output', 'stations', plan%station_z, at_least(0.0_dp))
        if (plan%width > 0.0_dp .and. any(plan%station_z > plan%width)) call file%reject( &
            'output', 'stations', 'must be from 0 to width')
        if (plan%geometry == 'antiplane_half') then
            call file%belongs_elsewhere('output', 'stations_x', along_strike)
            plan%station_x = 0.0_dp * plan%station_z
        else
            call file%get_reals('output', 'stations_x', plan%station_x, any_number())
            if (size(plan%station_x) == 0) plan%station_x = 0.0_dp * plan%station_z
            if (size(plan%station_x) /= size(plan%station_z)) call file%reject('output', &
                'stations_x', 'must have as many values as stations')
            if (plan%length > 0.0_dp .and. any(abs(plan%station_x) > 0.5_dp * plan%length)) call &
                file%reject('output', 'stations_x', 'must be within length/2 of the middle')
        end if
        call file%get_real('output', 'seismic_rate', plan%seismic_rate, above(0.0_dp), &
            default=1.0e-3_dp)
        call file%get_real('output', 'table_limit', plan%table_limit, above(0.0_dp), &
            default=10.0_dp)
        call read_contours(file, plan)
        call file%get_integer('output', 'interval', plan%interval, at_least(1.0_dp), default=1)
        call file%get_integer('output', 'fields', plan%fields, at_least(0.0_dp), default=0)
        call file%get_real('output', 'checkpoint', plan%checkpoint, at_least(0.0_dp), &
            default=60.0_dp)
    end subroutine read_output

    subroutine read_contours(file, plan)
        type(namelist_file), intent(inout) :: file
        type(fault_plan), intent(inout) :: plan
        real(dp), parameter :: least_part = 1.0e-12_dp   !! of t_end: times differ in their digits
        real(dp), allocatable :: contours(:)

        if (plan%geometry /= 'antiplane_half') then
            call file%belongs_elsewhere('output', 'slip_contours', &
                "belongs to geometry = 'antiplane_half'")
            return
        end if
        call file%get_reals('output', 'slip_contours', contours, above(0.0_dp))
        if (size(contours) == 0) return
        if (size(contours) /= 2) then
            call file%reject('output', 'slip_contours', &
                'takes two values: time between contours, and that during events')
        else if (any(contours < least_part * plan%t_end)) then
            call file%reject('output', 'slip_contours', 'must be at least 1e-12 of t_end')
        else
            plan%contours = contours
            call check_contours(file, plan)
        end if
    end subroutine read_contours

    !> Those between events alone may be more than the files may hold.
    subroutine check_contours(file, plan)
        type(namelist_file), intent(inout) :: file
        type(fault_plan), intent(in) :: plan
        real(dp), parameter :: row_bytes = 120.0_dp   !! five numbers
        real(dp) :: rows

        if (plan%nz < 2) return   ! refused before
        rows = plan%t_end / plan%contours(1) * (plan%nz / plan%contour_stride())
        if (rows * row_bytes <= gigabyte * plan%table_limit) return
        call file%reject('output', 'slip_contours', 'makes a table of' // rounded_text(rows &
            * row_bytes / gigabyte, 9, 2) // ' GB, more than table_limit,' &
            // rounded_text(plan%table_limit, 9, 2))
    end subroutine check_contours

    !> Another number for any input with other results.
    pure integer(int64) function fingerprint_of(listing, plan) result(number)
        character(len=*), intent(in) :: listing   !! of the input
        type(fault_plan), intent(in) :: plan

        number = listing_fingerprint(listing)
        call mix_map(plan%constants, number)
        call mix_map(plan%initial, number)
    end function fingerprint_of

    !> Nodes and values.
    pure subroutine mix_map(map, number)
        type(map_on_grid), intent(in) :: map
        integer(int64), intent(inout) :: number

        if (.not. (allocated(map%z) .and. allocated(map%values))) return
        call mix(transfer(map%x, [number]), number)
        call mix(transfer(map%z, [number]), number)
        call mix(transfer(map%values, [number]), number)
    end subroutine mix_map

end module fault_reader
