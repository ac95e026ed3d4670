!> The group &drive of the input file: the loading programme, from lists or from a file.
module drive_reader
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use column_keys, only : check_factors, read_column_keys, refuse_column_keys, refuse_table
    use csv_table, only : column_request, read_table, table
    use loading_programme, only : programme
    use namelist_input, only : any_number, at_least, above, namelist_file
    use number_reader, only : largest
    use number_text, only : whole_text
    implicit none
    private

    public :: read_drive

    character(len=*), parameter :: group = 'drive'
    character(len=12), parameter :: columns(4) = [character(len=12) :: 'time', 'velocity', &
        'displacement', 'normal']

contains

    !> Takes the programme from &drive; every fault is left in `file%faults`.
    subroutine read_drive(file, normal_traction, drive)
        type(namelist_file), intent(inout) :: file
        real(dp), intent(in) :: normal_traction   !! where &drive gives none [F/L^2]
        type(programme), intent(out) :: drive
        character(len=:), allocatable :: path

        call file%get_text(group, 'file', path)
        if (file%given(group, 'file')) then
            call read_drive_file(file, path, normal_traction, drive)
        else
            call read_drive_lists(file, normal_traction, drive)
            call refuse_column_keys(file, group, columns)
        end if
        call read_oscillation(file, drive)
    end subroutine read_drive

    subroutine read_oscillation(file, drive)
        type(namelist_file), intent(inout) :: file
        type(programme), intent(inout) :: drive

        call file%get_real(group, 'normal_amplitude', drive%amplitude, at_least(0.0_dp), &
            default=0.0_dp)
        call file%get_real(group, 'normal_phase', drive%phase, any_number(), default=0.0_dp)
        if (drive%amplitude > 0.0_dp) call file%require(group, 'normal_frequency')
        call file%get_real(group, 'normal_frequency', drive%frequency, above(0.0_dp), &
            default=1.0_dp)
        if (file%given(group, 'normal_amplitude')) return
        call file%refuse(group, 'normal_frequency', 'needs a normal_amplitude')
        call file%refuse(group, 'normal_phase', 'needs a normal_amplitude')
    end subroutine read_oscillation

    ! ---- lists -------------------------------------------------------------------------------

    !> Velocity and normal traction over time. One value stands for all pieces.
    subroutine read_drive_lists(file, normal_traction, drive)
        type(namelist_file), intent(inout) :: file
        real(dp), intent(in) :: normal_traction   !! where &drive gives none [F/L^2]
        type(programme), intent(out) :: drive
        real(dp), allocatable :: velocity(:), normal(:), duration(:)
        character(len=:), allocatable :: change
        integer :: faults_before, n, i

        faults_before = size(file%faults)
        call file%require(group, 'velocity')
        call file%get_reals(group, 'velocity', velocity, any_number())
        call file%get_reals(group, 'duration', duration, above(0.0_dp))
        call file%get_reals(group, 'normal', normal, at_least(0.0_dp))
        call file%get_choice(group, 'normal_change', change, ['step', 'ramp'], default='step')
        if (size(file%faults) > faults_before .or. size(velocity) == 0) return
        if (size(normal) == 0) normal = [normal_traction]
        n = max(size(velocity), size(normal), size(duration))
        call check_length('velocity', size(velocity))
        call check_length('normal', size(normal))
        if (size(duration) /= n .and. n > 1) call file%reject(group, 'duration', 'must have ' &
            // counted(n) // ', one for each piece')
        if (change == 'ramp' .and. size(duration) == 0) call file%reject(group, 'normal_change', &
            "needs the key duration with 'ramp'")
        if (size(file%faults) > faults_before) return

        if (size(velocity) < n) velocity = [(velocity(1), i = 1, n)]
        if (size(normal) < n) normal = [(normal(1), i = 1, n)]
        drive%listed = n
        allocate (drive%start(n))
        drive%start(1) = 0.0_dp
        do i = 2, n
            drive%start(i) = drive%start(i - 1) + duration(i - 1)
        end do
        drive%velocity = velocity
        drive%normal = normal
        drive%normal_rate = 0.0_dp * normal
        if (change == 'ramp') call make_ramps(merge(normal_traction, normal(1), &
            file%given('slider', 'normal_traction')), duration, drive)
        drive%acceleration = 0.0_dp * drive%velocity
        call drive%add_up_travel()

    contains

        subroutine check_length(key, length)
            character(len=*), intent(in) :: key
            integer, intent(in) :: length

            if (length == n .or. length == 1) return
            call file%reject(group, key, 'must have one value or ' // counted(n) &
                // ', as many as the other lists')
        end subroutine check_length

    end subroutine read_drive_lists

    !> Each piece starts at the normal traction of the one before, and ends at its own; another one
    !> then holds the last.
    subroutine make_ramps(first, duration, drive)
        real(dp), intent(in) :: first            !! normal traction at time 0 [F/L^2]
        real(dp), intent(in) :: duration(:)      !! [T]
        type(programme), intent(inout) :: drive
        real(dp) :: target(size(duration))
        integer :: n

        n = size(duration)
        target = drive%normal
        drive%normal = [first, target(:n - 1)]
        drive%normal_rate = (target - drive%normal) / duration
        drive%start = [drive%start, drive%start(n) + duration(n)]
        drive%velocity = [drive%velocity, drive%velocity(n)]
        drive%normal = [drive%normal, target(n)]
        drive%normal_rate = [drive%normal_rate, 0.0_dp]
    end subroutine make_ramps

    ! ---- file --------------------------------------------------------------------------------

    !> Columns time, velocity or displacement, and normal if you like, linear between the rows.
    subroutine read_drive_file(file, path, normal_traction, drive)
        type(namelist_file), intent(inout) :: file
        character(len=*), intent(in) :: path      !! as in the input file, relative to it
        real(dp), intent(in) :: normal_traction   !! where the file gives none [F/L^2]
        type(programme), intent(out) :: drive
        character(len=13), parameter :: lists(4) = [character(len=13) :: 'velocity', 'duration', &
            'normal', 'normal_change']
        type(column_request), allocatable :: requests(:)
        type(table) :: rows
        integer :: faults_before, i

        faults_before = size(file%faults)
        do i = 1, size(lists)
            call file%refuse(group, trim(lists(i)), 'cannot be given together with file')
        end do
        call read_column_keys(file, group, columns, requests)
        if (len(path) == 0) return
        if (file%given(group, 'velocity_column')) then
            call file%refuse(group, 'displacement_column', 'cannot be given together with &
                &velocity_column')
            requests = requests([1, 2, 4])
        else if (file%given(group, 'displacement_column')) then
            requests = requests([1, 3, 4])
        end if
        call read_table(file%beside(path), requests, rows)
        if (size(rows%faults) == 0) call check_columns(file, rows)
        if (size(rows%faults) == 0) call check_rows(rows)
        call refuse_table(file, group, 'file', rows)
        if (size(file%faults) == faults_before) call take_rows(rows, normal_traction, drive)
    end subroutine read_drive_file

    subroutine check_columns(file, rows)
        type(namelist_file), intent(inout) :: file
        type(table), intent(inout) :: rows

        if (rows%column('time') == 0) call rows%add_fault(rows%header_line, &
            "column 'time' is missing: there are " // rows%titles)
        if (rows%column('velocity') == 0 .and. rows%column('displacement') == 0) then
            call rows%add_fault(rows%header_line, "needs one of the columns 'velocity' and " &
                // "'displacement': there are " // rows%titles)
        else if (rows%column('velocity') > 0 .and. rows%column('displacement') > 0) then
            call rows%add_fault(rows%header_line, "takes one of the columns 'velocity' and " &
                // "'displacement': choose by velocity_column or displacement_column")
        end if
        call check_factors(file, group, columns, rows)
        if (size(rows%faults) == 0 .and. size(rows%lines) < 2) call rows%add_fault(0, &
            'has fewer than two rows of numbers')
    end subroutine check_columns

    subroutine check_rows(rows)
        type(table), intent(inout) :: rows
        integer :: i, normal, time

        time = rows%column('time')
        normal = rows%column('normal')
        do i = 2, size(rows%lines)
            if (.not. rows%values(time, i) > rows%values(time, i - 1)) then
                call rows%add_fault(rows%lines(i), 'time must be larger than in the row before')
            else if (any(abs(rows%values(:, i) - rows%values(:, i - 1)) > largest &
                * (rows%values(time, i) - rows%values(time, i - 1)))) then
                call rows%add_fault(rows%lines(i), 'changes faster than by 1e100 in unit time')
            end if
        end do
        if (normal == 0) return
        do i = 1, size(rows%lines)
            if (rows%values(normal, i) < 0.0_dp) call rows%add_fault(rows%lines(i), &
                'normal must be >= 0')
        end do
    end subroutine check_rows

    !> Time counts from the first row. After the last row its velocity and its normal traction go
    !> on; after a last displacement the drive stands still.
    subroutine take_rows(rows, normal_traction, drive)
        type(table), intent(in) :: rows
        real(dp), intent(in) :: normal_traction
        type(programme), intent(inout) :: drive
        integer :: n

        n = size(rows%lines)
        drive%start = rows%numbers('time')
        drive%start = drive%start - drive%start(1)
        drive%measured_until = drive%start(n)
        if (rows%column('velocity') > 0) then
            drive%velocity = rows%numbers('velocity')
            drive%acceleration = rate_of(drive%velocity)
        else
            drive%velocity = rate_of(rows%numbers('displacement'))
            drive%acceleration = 0.0_dp * drive%velocity
        end if
        if (rows%column('normal') > 0) then
            drive%normal = rows%numbers('normal')
        else
            drive%normal = 0.0_dp * drive%velocity + normal_traction
        end if
        drive%normal_rate = rate_of(drive%normal)
        call drive%add_up_travel()

    contains

        pure function rate_of(values) result(rate)
            real(dp), intent(in) :: values(:)
            real(dp) :: rate(size(values))

            rate(:n - 1) = (values(2:) - values(:n - 1)) / (drive%start(2:) - drive%start(:n - 1))
            rate(n) = 0.0_dp
        end function rate_of

    end subroutine take_rows

    pure function counted(n) result(text)
        integer, intent(in) :: n
        character(len=:), allocatable :: text

        text = whole_text(n) // ' value'
        if (n /= 1) text = text // 's'
    end function counted

end module drive_reader
