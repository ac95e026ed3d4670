!> Reads what the point mode is told to do: the groups &friction and &point, their defaults and
!> rules.
module point_reader
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use column_keys, only : check_factors, read_column_keys, refuse_column_keys, refuse_table
    use csv_table, only : column_request, csv => table, read_table
    use law_input, only : read_friction
    use loading_path, only : path, point_run
    use namelist_input, only : any_number, at_least, between, namelist_file
    use number_text, only : whole_text
    use unit_reader, only : read_units
    implicit none
    private

    public :: group, read_point_settings

    character(len=*), parameter :: group = 'point'
    character(len=2), parameter :: directions(3) = ['n ', 't1', 't2']
    character(len=10), parameter :: segment_keys(8) = [character(len=10) :: 'duration', 'steps', &
        'control_n', 'control_t1', 'control_t2', 'target_n', 'target_t1', 'target_t2']
    character(len=4), parameter :: columns(7) = ['time', 'u_n ', 't_n ', 'u_t1', 't_t1', 'u_t2', &
        't_t2']
    character(len=12), parameter :: controls(2) = ['displacement', 'traction    ']
    integer, parameter :: by_displacement = 1   !! place in `controls`

contains

    !> Takes the settings from a file; every fault is left in `file%faults`.
    subroutine read_point_settings(file, run)
        type(namelist_file), intent(inout) :: file
        type(point_run), intent(out) :: run

        call file%require_groups(['friction', 'point   '])
        call read_friction(file, run%props)
        call file%get_logical(group, 'tangent', run%tangent, default=.false.)
        call file%get_integer(group, 'ndir', run%loading%ndir, between(2.0_dp, 3.0_dp), default=3)
        run%loading%ndir = min(3, max(2, run%loading%ndir))
        call file%get_integer(group, 'cycles', run%loading%cycles, at_least(1.0_dp), default=1)
        call read_segments(file, run%loading)
        call read_file(file, run%loading)
        call read_units(file, run%units)
        call file%refuse_unknown()
        if (size(file%faults) > 0) return
        if (run%loading%increments() > real(huge(1) - 1, dp)) call file%reject(group, 'cycles', &
            'gives more than 2147483647 increments')
    end subroutine read_point_settings

    !> The path as lists of the namelist. One value stands for all segments.
    subroutine read_segments(file, loading)
        type(namelist_file), intent(inout) :: file
        type(path), intent(inout) :: loading
        real(dp), allocatable :: duration(:), steps(:), target(:)
        integer, allocatable :: control(:)
        character(len=:), allocatable :: name
        integer :: faults_before, n, i

        faults_before = size(file%faults)
        call file%get_reals(group, 'duration', duration, at_least(0.0_dp))
        call file%get_reals(group, 'steps', steps, at_least(1.0_dp))
        if (any(abs(steps - anint(steps)) > 0.0_dp .or. steps > real(huge(1), dp))) call &
            file%reject(group, 'steps', 'must be whole numbers up to 2147483647')
        n = size(duration)
        if (.not. file%given(group, 'file')) then
            call file%require(group, 'duration')
            call file%require(group, 'steps')
            call file%require(group, 'target_n')
            call file%require(group, 'target_t1')
        end if
        call check_length(file, 'steps', size(steps), n)
        allocate (loading%by_traction(loading%ndir, n), loading%target(loading%ndir, n))
        do i = 1, size(directions)
            name = trim(directions(i))
            call file%get_choices(group, 'control_' // name, control, controls)
            call file%get_reals(group, 'target_' // name, target, any_number())
            call check_length(file, 'control_' // name, size(control), n)
            call check_length(file, 'target_' // name, size(target), n)
            if (i > loading%ndir) then
                call file%refuse(group, 'control_' // name, 'needs ndir = 3')
                call file%refuse(group, 'target_' // name, 'needs ndir = 3')
            else if (size(file%faults) == faults_before .and. n > 0) then
                if (size(control) == 0) control = [by_displacement]
                if (size(target) == 0) target = [0.0_dp]
                loading%by_traction(i, :) = nint(spread_out(real(control, dp), n)) &
                    /= by_displacement
                loading%target(i, :) = spread_out(target, n)
            end if
        end do
        if (size(file%faults) > faults_before .or. n == 0) return
        loading%duration = duration
        loading%steps = nint(spread_out(steps, n))
    end subroutine read_segments

    !> One value or as many as there are segments; a list that is left out or faulty passes.
    subroutine check_length(file, key, length, n)
        type(namelist_file), intent(inout) :: file
        character(len=*), intent(in) :: key
        integer, intent(in) :: length   !! of the list
        integer, intent(in) :: n        !! segments; 0 where that is unknown

        if (n == 0 .or. length <= 1 .or. length == n) return
        call file%reject(group, key, 'must have one value or ' // whole_text(n) &
            // ', as many as duration')
    end subroutine check_length

    pure function spread_out(values, n) result(list)
        real(dp), intent(in) :: values(:)   !! one, or `n`
        integer, intent(in) :: n
        real(dp) :: list(n)

        list = values(1)
        if (size(values) == n) list = values
    end function spread_out

    !> The path as a CSV file, named from the directory of the namelist.
    subroutine read_file(file, loading)
        type(namelist_file), intent(inout) :: file
        type(path), intent(inout) :: loading
        character(len=:), allocatable :: name
        type(column_request), allocatable :: requests(:)
        type(csv) :: table
        integer :: faults_before, substeps, i

        faults_before = size(file%faults)
        call file%get_text(group, 'file', name)
        call file%get_integer(group, 'substeps', substeps, at_least(1.0_dp), default=1)
        if (.not. file%given(group, 'file')) then
            call file%refuse(group, 'substeps', 'needs a file')
            call refuse_column_keys(file, group, columns)
            return
        end if
        do i = 1, size(segment_keys)
            call file%refuse(group, trim(segment_keys(i)), 'cannot be given together with file')
        end do
        call read_column_keys(file, group, columns(:2 * loading%ndir + 1), requests)
        do i = 2, size(requests), 2
            if (file%given(group, trim(columns(i)) // '_column')) call file%refuse(group, &
                trim(columns(i + 1)) // '_column', 'cannot be given together with ' &
                // trim(columns(i)) // '_column')
        end do
        if (len(name) == 0) return
        requests = pack(requests, [(wanted(i), i = 1, size(requests))])
        call read_table(file%beside(name), requests, table)
        if (size(table%faults) == 0) call check_columns(file, loading%ndir, table)
        if (size(table%faults) == 0) call check_times(table)
        call refuse_table(file, group, 'file', table)
        if (size(file%faults) == faults_before) call take_table(table, substeps, loading)

    contains

        !> A column that is named is taken in place of its partner, `u_n` and `t_n` and so on.
        logical function wanted(i)
            integer, intent(in) :: i
            integer :: partner

            partner = i + 1 - 2 * mod(i, 2)
            wanted = i == 1
            if (.not. wanted) wanted = .not. file%given(group, trim(columns(partner)) // '_column')
        end function wanted

    end subroutine read_file

    subroutine check_columns(file, ndir, table)
        type(namelist_file), intent(inout) :: file
        integer, intent(in) :: ndir
        type(csv), intent(inout) :: table
        character(len=:), allocatable :: pair
        integer :: i, u, t

        if (table%column('time') == 0) call table%add_fault(table%header_line, &
            "must have a column 'time'")
        do i = 1, ndir
            u = table%column('u_' // trim(directions(i)))
            t = table%column('t_' // trim(directions(i)))
            pair = "'u_" // trim(directions(i)) // "' or 't_" // trim(directions(i)) // "'"
            if (u == 0 .and. t == 0) call table%add_fault(table%header_line, &
                'must have a column ' // pair)
            if (u > 0 .and. t > 0) call table%add_fault(table%header_line, 'must have a column ' &
                // pair // ', and not both: choose one by its key, u_' // trim(directions(i)) &
                // '_column or t_' // trim(directions(i)) // '_column')
        end do
        call check_factors(file, group, columns(:2 * ndir + 1), table)
        if (size(table%faults) == 0 .and. size(table%lines) == 0) call table%add_fault(0, &
            'must hold rows of numbers below the names')
    end subroutine check_columns

    subroutine check_times(table)
        type(csv), intent(inout) :: table
        integer :: time, i

        time = table%column('time')
        if (starts_at_rest(table)) then
            if (size(table%lines) == 1) call table%add_fault(table%lines(1), &
                'there is nothing but the starting point')
        else if (table%values(time, 1) < 0.0_dp) then
            call table%add_fault(table%lines(1), 'time must be >= 0')
        end if
        do i = 2, size(table%lines)
            if (table%values(time, i) < table%values(time, i - 1)) call table%add_fault( &
                table%lines(i), 'time must not go back')
        end do
    end subroutine check_times

    !> Is the first row, of zeros but for its time, where every path starts?
    pure logical function starts_at_rest(table) result(yes)
        type(csv), intent(in) :: table
        integer :: i

        yes = .true.
        do i = 1, size(table%names)
            if (i /= table%column('time')) yes = yes .and. .not. abs(table%values(i, 1)) > 0.0_dp
        end do
    end function starts_at_rest

    !> Each row is a segment: the columns `u_n` or `t_n`, and so on, tell what is controlled. Time
    !> counts from the starting point if the table has it, else from 0.
    subroutine take_table(table, substeps, loading)
        type(csv), intent(in) :: table
        integer, intent(in) :: substeps   !! increments to a row
        type(path), intent(inout) :: loading
        integer :: places(loading%ndir), first, n, i
        logical :: tractions(loading%ndir)
        real(dp), allocatable :: time(:)

        do i = 1, loading%ndir
            places(i) = table%column('t_' // trim(directions(i)))
            tractions(i) = places(i) > 0
            if (places(i) == 0) places(i) = table%column('u_' // trim(directions(i)))
        end do
        time = table%numbers('time')
        first = 1
        if (starts_at_rest(table)) then
            first = 2
            time = time - time(1)
        end if
        n = size(table%lines) - first + 1
        loading%duration = time(first:)
        loading%duration(2:) = loading%duration(2:) - loading%duration(:n - 1)
        loading%steps = [(substeps, i = 1, n)]
        loading%by_traction = spread(tractions, 2, n)
        loading%target = table%values(places, first:)
    end subroutine take_table

end module point_reader
