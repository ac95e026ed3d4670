!> What a friction update costs: stickslip_bench DIRECTORY [LARGEST_N] (docs/performance.md).
program stickslip_bench
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use agreement, only : deviation
    use bars, only : write_bars
    use contact_sets, only : contact_set, draw_set
    use cost_table, only : cost_row, table
    use measurements, only : check_batch, measure_batch, measure_copy, measure_four_unknowns, &
        measure_log_and_sqrt, measure_scalar
    implicit none

    character(len=9), parameter :: names(3) = ['random   ', 'wide     ', 'monotonic']
    integer, parameter :: scalar_points = 100000, few_points = 10000, seed = 2007
    type(table) :: costs
    type(cost_row) :: row
    type(deviation) :: checked
    character(len=4096) :: argument, directory
    character(len=100) :: line
    integer :: largest, n, decade
    logical :: right

    call get_command_argument(1, directory)
    largest = 10000000
    call get_command_argument(2, argument)
    if (len_trim(argument) > 0) read (argument, *) largest

    call costs%create(trim(directory))
    do decade = 3, 7
        n = 10**decade
        if (n > max(largest, scalar_points)) exit
        call measure_sets(n)
    end do
    call measure_reference()
    call check_batch(largest, checked)
    write (line, '(a, i0, a, 3es9.1, i8, " (", i0, ")")') 'batch, random and wide, ', largest, &
        ' points, dt 1e-6 to 1e-2', checked%traction, checked%state, checked%tangent, &
        checked%failures, checked%backward
    call costs%say(trim(line))
    call write_bars(costs, checked, right)
    if (.not. right) call costs%say('results are WRONG: see the rows above')
    call costs%finish()
    if (.not. right) stop 1

contains

    !> All routines of the library, and memcpy, over sets of `n` points.
    subroutine measure_sets(n)
        integer, intent(in) :: n
        type(contact_set) :: set
        integer :: i, threads

        do i = 1, size(names)
            if (trim(names(i)) == 'monotonic' .and. n /= scalar_points) cycle
            call draw_set(trim(names(i)), n, seed + i, set)
            if (i == 1) then
                call measure_copy(set, row)
                call costs%add(row)
            end if
            if (i == 1 .and. n == scalar_points) then
                call measure_log_and_sqrt(set, row)
                call costs%add(row)
            end if
            if (n == scalar_points) then
                call measure_scalar(set, row)
                call costs%add(row)
            end if
            do threads = 1, 2
                call measure_batch(set, threads, row)
                call costs%add(row)
            end do
        end do
    end subroutine measure_sets

    !> The paper's four unknowns; they cost too much for many points.
    subroutine measure_reference()
        type(contact_set) :: set
        real(dp) :: iterations(2, size(names)), slipping(size(names))
        integer :: i

        do i = 1, size(names)
            call draw_set(trim(names(i)), few_points, seed + i, set)
            call measure_four_unknowns(set, row, iterations(:, i), slipping(i))
            call costs%add(row)
        end do
        call costs%say('')
        do i = 1, size(names)
            write (line, '(3a, f5.1, a, f5.2, a, i0)') 'set ', names(i), ':', &
                100.0_dp * slipping(i), ' % of the updates slip; four unknowns: iterations mean', &
                iterations(1, i), ', largest ', nint(iterations(2, i))
            call costs%say(trim(line))
        end do
    end subroutine measure_reference

end program stickslip_bench
