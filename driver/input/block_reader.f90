!> What differs from block to block of a chain: constants of friction and the normal traction, by a
!> profile in a file, key = '@file.csv' with columns `block` and the key's name, and by scatter,
!> &chain KEY_scatter.
module block_reader
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use chain_settings, only : chain, load_factors, scatter_of_constant
    use friction_mod, only : constant_table, facts => law_facts, friction_check, &
        friction_constants, friction_default, friction_facts, friction_law_of, prop_law, text_length
    use law_facts, only : has_r
    use law_input, only : range_of, read_friction, read_law
    use namelist_input, only : above, between, namelist_file, rule
    use number_text, only : short_text, whole_text
    use profile_reader, only : names_profile, profile, put_number, take_profiles
    use run_settings, only : settings
    implicit none
    private

    public :: check_blocks_at_start, read_block_friction

    character(len=*), parameter :: group = 'chain', group_of_load = 'slider'
    integer, parameter :: most_shown = 10   !! blocks that are refused one by one

contains

    !> Constants of friction, their means in `props`, and loads of the blocks, checked block by
    !> block; every fault is left in `file%faults`. A mean takes the place of each profile in the
    !> input.
    subroutine read_block_friction(file, run)
        type(namelist_file), intent(inout) :: file
        type(settings), intent(inout) :: run
        type(profile), allocatable :: profiles(:)
        type(constant_table) :: table
        real(dp), allocatable :: scatter(:)
        integer, allocatable :: differing(:)   ! places of constants that are given block by block
        integer :: faults_before, law, place

        faults_before = size(file%faults)
        call read_profiles(file, run%chain, profiles)
        call read_law(file, law)
        table = friction_constants(law)
        call check_profiles(file, profiles, table, run%chain)
        call read_scatters(file, run%chain%n_blocks, table, scatter)
        differing = pack([(place, place = 1, table%n)], scatter > 0.0_dp &
            .or. [(profile_of(profiles, 'friction', table%of(place)%name) > 0, place = 1, table%n)])
        call read_friction(file, run%props, law, means=size(differing) > 0)
        if (size(differing) == 0 .or. size(file%faults) > faults_before) return
        call fill_constants(file, profiles, table, scatter, run)
        call check_constants(file, table, scatter, differing, run%chain)
        if (size(file%faults) > faults_before) return
        if (all_alike(run%chain%constants)) then
            deallocate (run%chain%constants)   ! the same bytes as without profiles
        else
            call drop_defaults(run%chain%constants)
        end if
    end subroutine read_block_friction

    subroutine read_profiles(file, blocks, profiles)
        type(namelist_file), intent(inout) :: file
        type(chain), intent(in) :: blocks
        type(profile), allocatable, intent(out) :: profiles(:)
        character(len=5), parameter :: axes(2) = ['     ', 'block']
        integer :: i

        if (blocks%n_blocks > 1) then
            call take_profiles(file, group_of_load, axes, profiles)
            return
        end if
        allocate (profiles(0))
        do i = 1, size(file%entries)
            if (.not. names_profile(file, i, group_of_load)) cycle
            call file%reject(file%entries(i)%group, file%entries(i)%key, &
                'is a profile of the blocks of a chain, and needs two or more (&chain n_blocks)')
            file%entries(i)%faulty = .true.
        end do
    end subroutine read_profiles

    !> Each by its own rule; those that obey it are replaced by their means.
    subroutine check_profiles(file, profiles, table, blocks)
        type(namelist_file), intent(inout) :: file
        type(profile), intent(in) :: profiles(:)
        type(constant_table), intent(in) :: table
        type(chain), intent(inout) :: blocks
        type(rule) :: allowed
        real(dp) :: values(blocks%n_blocks)
        integer, allocatable :: mine(:)   ! entries
        integer :: faults, place, i, k

        do k = 1, size(profiles)
            associate (this => profiles(k))
                values = on_blocks(this, blocks%n_blocks)
                allowed = above(0.0_dp)
                do place = 1, table%n
                    if (table%of(place)%name == this%key) allowed = range_of(table%of(place))
                end do
                faults = 0
                do i = 1, size(values)
                    if (allowed%holds(values(i))) cycle
                    faults = faults + 1
                    if (faults <= most_shown) call file%reject(this%group, this%key, 'block ' &
                        // whole_text(i) // ': must be ' // allowed%text // ', and is ' &
                        // short_text(values(i)))
                end do
                call tell_more(file, faults)
                if (faults > 0) then
                    call file%find(this%group, this%key, mine)
                    file%entries(mine)%faulty = .true.
                else
                    call put_number(file, this%group, this%key, mean(values))
                end if
                if (this%group == group_of_load .and. faults == 0) blocks%load = values &
                    / mean(values)
            end associate
        end do
    end subroutine check_profiles

    !> Of equal numbers, that number.
    pure real(dp) function mean(values)
        real(dp), intent(in) :: values(:)   !! one or more

        mean = values(1) + sum(values - values(1)) / size(values)
    end function mean

    pure function on_blocks(this, n) result(values)
        type(profile), intent(in) :: this
        integer, intent(in) :: n
        real(dp) :: values(n)
        real(dp) :: value(1)
        integer :: i

        do i = 1, n
            value = this%map%at(0.0_dp, real(i, dp))
            values(i) = value(1)
        end do
    end function on_blocks

    pure logical function all_alike(constants) result(yes)
        real(dp), intent(in) :: constants(:, :)   !! one row a block

        yes = .not. any(abs(constants - spread(constants(1, :), 1, size(constants, 1))) > 0.0_dp)
    end function all_alike

    !> Which profile is a key's? 0: none.
    pure integer function profile_of(profiles, group_of_key, key) result(i)
        type(profile), intent(in) :: profiles(:)
        character(len=*), intent(in) :: group_of_key, key

        do i = size(profiles), 1, -1
            if (profiles(i)%group == group_of_key .and. profiles(i)%key == key) return
        end do
    end function profile_of

    subroutine read_scatters(file, n_blocks, table, scatter)
        type(namelist_file), intent(inout) :: file
        integer, intent(in) :: n_blocks
        type(constant_table), intent(in) :: table
        real(dp), allocatable, intent(out) :: scatter(:)   !! of each constant, relative [-]
        character(len=:), allocatable :: key
        integer :: place

        allocate (scatter(table%n), source=0.0_dp)
        do place = prop_law + 1, table%n
            if (table%of(place)%whole) cycle
            key = trim(table%of(place)%name) // '_scatter'
            call file%get_real(group, key, scatter(place), between(0.0_dp, 0.99_dp), default=0.0_dp)
            if (scatter(place) > 0.0_dp .and. n_blocks == 1) call file%reject(group, key, &
                'needs two or more blocks')
        end do
    end subroutine read_scatters

    subroutine tell_more(file, faults)
        type(namelist_file), intent(inout) :: file
        integer, intent(in) :: faults

        if (faults > most_shown) call file%add_fault(file%line_of_group(group), '&' // group &
            // ': ' // whole_text(faults - most_shown) // ' more blocks are refused')
    end subroutine tell_more

    !> Constants that are left out have their defaults block by block.
    subroutine fill_constants(file, profiles, table, scatter, run)
        type(namelist_file), intent(inout) :: file
        type(profile), intent(in) :: profiles(:)
        type(constant_table), intent(in) :: table
        real(dp), intent(in) :: scatter(:)
        type(settings), intent(inout) :: run
        character(len=:), allocatable :: name
        integer :: n, place, i

        n = run%chain%n_blocks
        allocate (run%chain%constants(n, table%n), source=0.0_dp)
        do place = 1, table%n
            associate (column => run%chain%constants(:, place), this => table%of(place))
                name = trim(this%name)
                column = run%props(place)
                i = profile_of(profiles, 'friction', name)
                if (i > 0) then
                    column = on_blocks(profiles(i), n)
                else if (max(this%default_from, this%default_per) > 0 .and. .not. file%given( &
                    'friction', name)) then
                    do i = 1, n
                        column(i) = friction_default(run%chain%constants(i, :), place)
                    end do
                end if
                if (scatter(place) > 0.0_dp) column = column * scatter_of_constant(run%chain, &
                    name, scatter(place))
            end associate
        end do
    end subroutine fill_constants

    !> The rules of the law, block by block.
    subroutine check_constants(file, table, scatter, differing, blocks)
        type(namelist_file), intent(inout) :: file
        type(constant_table), intent(in) :: table
        real(dp), intent(in) :: scatter(:)
        integer, intent(in) :: differing(:)
        type(chain), intent(in) :: blocks
        character(len=text_length) :: text
        character(len=:), allocatable :: why
        integer :: i, place, culprit, status, faults

        faults = 0
        do i = 1, blocks%n_blocks
            call friction_check(blocks%constants(i, :), place, text, status)
            if (status >= 0) cycle
            faults = faults + 1
            if (faults > most_shown) cycle
            culprit = given_cause(table, place, differing)
            why = 'block ' // whole_text(i) // ': ' // trim(text) // ', where ' // values_of(place)
            if (scatter(culprit) > 0.0_dp) then
                call file%reject(group, trim(table%of(culprit)%name) // '_scatter', why)
            else
                call file%reject('friction', trim(table%of(culprit)%name), why)
            end if
        end do
        call tell_more(file, faults)

    contains

        !> The constants that a rule is about, with their values.
        function values_of(at) result(list)
            integer, intent(in) :: at   !! the first of them
            character(len=:), allocatable :: list
            integer :: others(4), k

            others = [at, table%of(at)%not_below, table%of(at)%not_above, table%of(at)%not_beside]
            list = ''
            do k = 1, size(others)
                if (others(k) == 0) cycle
                if (len(list) > 0) list = list // ', '
                list = list // trim(table%of(others(k))%name) // ' = ' &
                    // short_text(blocks%constants(i, others(k)))
            end do
        end function values_of

    end subroutine check_constants

    !> The constant by which a rule was broken: one that was given block by block.
    pure integer function given_cause(table, place, differing) result(cause)
        type(constant_table), intent(in) :: table
        integer, intent(in) :: place          !! of the constant whose rule is broken
        integer, intent(in) :: differing(:)
        integer :: others(4), k

        cause = differing(1)
        others = [table%of(place)%not_beside, table%of(place)%not_above, &
            table%of(place)%not_below, place]
        do k = 1, size(others)
            if (any(differing == others(k))) cause = others(k)
        end do
    end function given_cause

    !> Leaves out the last constants as long as all blocks have their defaults: options that nobody
    !> asked for cost time.
    pure subroutine drop_defaults(constants)
        real(dp), allocatable, intent(inout) :: constants(:, :)
        type(constant_table) :: table
        integer :: n, i

        table = friction_constants(friction_law_of(constants(1, :)))
        do n = size(constants, 2), 2, -1
            if (.not. table%of(n)%optional .or. max(table%of(n)%default_from, &
                table%of(n)%default_per) > 0) exit
            if (any([(abs(constants(i, n) - table%of(n)%default) > 0.0_dp, i = 1, &
                size(constants, 1))])) exit
        end do
        constants = constants(:, :n)
    end subroutine drop_defaults

    !> What &initial asks of all blocks, each must be able to have.
    subroutine check_blocks_at_start(file, run)
        type(namelist_file), intent(inout) :: file
        type(settings), intent(in) :: run
        real(dp), allocatable :: load(:)
        type(facts) :: law
        real(dp) :: mu, pressure
        integer :: faults, i

        if (.not. run%initial%any_given .or. size(file%faults) > 0) return
        if (.not. (allocated(run%chain%constants) .or. run%chain%loads_differ())) return
        load = load_factors(run%chain)
        law = friction_facts(run%props)
        faults = 0
        do i = 1, run%chain%n_blocks
            if (allocated(run%chain%constants)) law = friction_facts(run%chain%constants(i, :))
            pressure = load(i) * run%drive%normal_traction(0.0_dp, 1)
            mu = run%initial%mu
            if (has_r(run%props) .and. .not. run%initial%mu_given) mu = law%virgin_mu
            if (mu > law%largest_coefficient) then
                call refuse('mu', 'exceeds its static friction coefficient, ' &
                    // short_text(law%largest_coefficient))
            else if (has_r(run%props) .and. mu < law%kinetic_coefficient) then
                call refuse('mu', 'is below its mu_k')
            else if (run%initial%r * (mu * pressure + merge(law%cohesion, 0.0_dp, &
                has_r(run%props))) > law%shear_cap) then
                call refuse(merge('r ', 'mu', has_r(run%props)), &
                    'makes a tangential traction above its tau_max = ' &
                    // short_text(law%shear_cap))
            end if
        end do
        call tell_more(file, faults)

    contains

        subroutine refuse(key, why)
            character(len=*), intent(in) :: key, why

            faults = faults + 1
            if (faults <= most_shown) call file%reject('initial', trim(key), 'block ' &
                // whole_text(i) // ': ' // why)
        end subroutine refuse

    end subroutine check_blocks_at_start

end module block_reader
