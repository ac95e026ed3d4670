!> Reads what the point mode is told to do: the groups &friction and &point, their defaults and
!> rules.
module point_reader
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use csv_table, only : csv => table, name_length, read_table
    use law_input, only : read_friction
    use loading_path, only : path
    use namelist_input, only : any_number, at_least, between, namelist_file
    use point_settings, only : point_run
    implicit none
    private

    public :: group, read_point_settings

    character(len=*), parameter :: group = 'point'
    character(len=2), parameter :: directions(3) = ['n ', 't1', 't2']
    character(len=10), parameter :: segment_keys(8) = [character(len=10) :: 'duration', 'steps', &
        'control_n', 'control_t1', 'control_t2', 'target_n', 'target_t1', 'target_t2']
    character(len=12), parameter :: controls(2) = ['displacement', 'traction    ']
    integer, parameter :: by_displacement = 1   !! place in `controls`

contains

    !> Takes the settings from a file; every fault is left in `file%faults`.
    subroutine read_point_settings(file, run)
        type(namelist_file), intent(inout) :: file
        type(point_run), intent(out) :: run

        if (.not. file%has_group('friction')) call file%add_fault(0, 'group &friction is missing')
        if (.not. file%has_group(group)) call file%add_fault(0, 'group &point is missing')
        call read_friction(file, run%props)
        call file%get_logical(group, 'tangent', run%tangent, default=.false.)
        call file%get_integer(group, 'ndir', run%loading%ndir, between(2.0_dp, 3.0_dp), default=3)
        run%loading%ndir = min(3, max(2, run%loading%ndir))
        call file%get_integer(group, 'cycles', run%loading%cycles, at_least(1.0_dp), default=1)
        call read_segments(file, run%loading)
        call read_file(file, run%loading)
        call file%refuse_unknown()
        if (size(file%faults) > 0) return
        if (run%loading%increments() > real(huge(1) - 1, dp)) call file%reject(group, 'cycles', &
            'makes more increments than can be counted')
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
        if (any(abs(steps - anint(steps)) > 0.0_dp .or. steps > real(huge(1), dp))) then
            call file%reject(group, 'steps', 'must be whole numbers that can be counted to')
        end if
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
                call refuse(file, 'control_' // name, 'needs ndir = 3')
                call refuse(file, 'target_' // name, 'needs ndir = 3')
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
        character(len=80) :: text

        if (n == 0 .or. length <= 1 .or. length == n) return
        write (text, '(a, i0, a)') 'must have one value or ', n, ', as many as duration'
        call file%reject(group, key, trim(text))
    end subroutine check_length

    pure function spread_out(values, n) result(list)
        real(dp), intent(in) :: values(:)   !! one, or `n`
        integer, intent(in) :: n
        real(dp) :: list(n)

        list = values(1)
        if (size(values) == n) list = values
    end function spread_out

    subroutine refuse(file, key, why)
        type(namelist_file), intent(inout) :: file
        character(len=*), intent(in) :: key, why

        if (file%given(group, key)) call file%reject(group, key, why)
    end subroutine refuse

    !> The path as a CSV file, named from the directory of the namelist.
    subroutine read_file(file, loading)
        type(namelist_file), intent(inout) :: file
        type(path), intent(inout) :: loading
        character(len=:), allocatable :: name
        type(csv) :: table
        integer :: substeps, i

        call file%get_text(group, 'file', name)
        call file%get_integer(group, 'substeps', substeps, at_least(1.0_dp), default=1)
        if (.not. file%given(group, 'file')) then
            call refuse(file, 'substeps', 'needs a file')
            return
        end if
        do i = 1, size(segment_keys)
            call refuse(file, trim(segment_keys(i)), 'must not be given beside file')
        end do
        if (len(name) == 0) return
        if (name(1:1) /= '/') name = file%name(:index(file%name, '/', back=.true.)) // name
        call read_table(name, table)
        if (size(table%faults) == 0) call take_table(table, substeps, loading)
        do i = 1, size(table%faults)
            call file%reject(group, 'file', table%faults(i)%text)
        end do
    end subroutine read_file

    !> Each row is a segment: the columns `u_n` or `t_n`, and so on, tell what is controlled.
    subroutine take_table(table, substeps, loading)
        type(csv), intent(inout) :: table
        integer, intent(in) :: substeps   !! increments to a row
        type(path), intent(inout) :: loading
        integer :: time, places(loading%ndir), first, n, i
        logical :: tractions(loading%ndir)

        if (size(table%lines) == 0) call table%add_fault(0, &
            'must hold rows of numbers below the names')
        call find_columns(table, loading%ndir, time, places, tractions)
        if (size(table%faults) > 0) return
        if (table%values(time, 1) < 0.0_dp) call table%add_fault(table%lines(1), &
            'time must be >= 0')
        do i = 2, size(table%lines)
            if (table%values(time, i) < table%values(time, i - 1)) call table%add_fault( &
                table%lines(i), 'time must not go back')
        end do
        if (size(table%faults) > 0) return

        first = 1   ! a row of zeros is where every path starts
        if (.not. any(abs(table%values([time, places], 1)) > 0.0_dp)) first = 2
        n = size(table%lines) - first + 1
        if (n == 0) call table%add_fault(table%lines(1), 'there is nothing but the starting point')
        loading%duration = table%values(time, first:size(table%lines))   ! the start is at time 0
        loading%duration(2:) = loading%duration(2:) - loading%duration(:n - 1)
        loading%steps = [(substeps, i = 1, n)]
        loading%by_traction = spread(tractions, 2, n)
        loading%target = table%values(places, first:size(table%lines))
    end subroutine take_table

    subroutine find_columns(table, ndir, time, places, tractions)
        type(csv), intent(inout) :: table
        integer, intent(in) :: ndir
        integer, intent(out) :: time            !! its column
        integer, intent(out) :: places(ndir)    !! columns of the directions
        logical, intent(out) :: tractions(ndir) !! they hold tractions
        character(len=name_length) :: known(2 * ndir + 1)
        integer :: i, u, t

        known(1) = 'time'
        time = table%column('time')
        if (time == 0) call table%add_fault(0, "must have a column 'time'")
        do i = 1, ndir
            known(2 * i) = 'u_' // directions(i)
            known(2 * i + 1) = 't_' // directions(i)
            u = table%column(trim(known(2 * i)))
            t = table%column(trim(known(2 * i + 1)))
            places(i) = max(u, t)
            tractions(i) = t > 0
            if ((u > 0) .neqv. (t > 0)) cycle
            call table%add_fault(0, "must have a column '" // trim(known(2 * i)) // "' or '" &
                // trim(known(2 * i + 1)) // "', and not both")
        end do
        do i = 1, size(table%names)
            if (any(known == table%names(i))) cycle
            call table%add_fault(0, "unknown column '" // trim(table%names(i)) // "'")
        end do
    end subroutine find_columns

end module point_reader
