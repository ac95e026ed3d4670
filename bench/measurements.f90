!> The measurements: each times one routine over one set of points and returns a row of the table.
module measurements
    use, intrinsic :: iso_c_binding, only : c_size_t
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use agreement, only : batch_results, compare_batch, compare_point, deviation, point_results
    use contact_sets, only : contact_set, draw_set, draw_times, props, time_step
    use cost_table, only : cost_row
    use four_unknowns, only : four_unknown_update
    use friction_mod, only : friction_no_convergence, friction_ok, friction_update, &
        friction_update_batch, statev_slip
    use omp_lib, only : omp_set_num_threads
    use peers, only : copy_bytes, log_and_sqrt
    use stopwatch, only : repetitions_for, timer
    implicit none
    private

    public :: check_batch, measure_batch, measure_copy, measure_four_unknowns, &
        measure_log_and_sqrt, measure_scalar

    integer, parameter :: seed = 41
    integer, parameter :: slowness = 10   !! of the four unknowns, to repeat them less often

contains

    !> memcpy of as many bytes as the batch routine reads and writes. Of a point it reads du (24)
    !> and statev (64) and writes statev (64), traction (24), tangent (72) and status (4): 252
    !> bytes, which is what a copy of 126 bytes touches.
    subroutine measure_copy(set, row)
        type(contact_set), intent(in) :: set
        type(cost_row), intent(out) :: row
        integer(c_size_t), parameter :: bytes_per_point = 126
        real(dp), allocatable :: from(:), to(:)
        integer(c_size_t) :: bytes
        type(timer) :: watch
        integer :: n, i

        n = size(set%du, 1)
        bytes = bytes_per_point * n
        allocate (from(bytes / 8 + 1), to(bytes / 8 + 1))
        from = 1.0_dp
        to = 0.0_dp
        do i = 1, repetitions_for(n / 10)   ! a copy is short
            call watch%start()
            call copy_bytes(bytes, from, to)
            call watch%stop()
        end do
        call describe(row, 'memcpy', set, 1, watch)
        row%set = '-'
    end subroutine measure_copy

    !> The batch routine over `set`, and its results beside the scalar routine's.
    subroutine measure_batch(set, threads, row)
        type(contact_set), intent(in) :: set
        integer, intent(in) :: threads
        type(cost_row), intent(out) :: row
        type(batch_results) :: batch
        type(timer) :: watch, warming
        integer :: n, i

        n = size(set%du, 1)
        call omp_set_num_threads(threads)
        call reserve(n, batch)
        call run_batch(set, time_step, batch, warming)
        do i = 1, repetitions_for(n * set%increments)
            call run_batch(set, time_step, batch, watch)
        end do
        call describe(row, 'batch', set, threads, watch)
        row%compared = .true.
        call compare_batch(set, time_step, batch, row%apart)
    end subroutine measure_batch

    !> One repetition from the state at the start, whose restoration is not timed.
    subroutine run_batch(set, dt, batch, watch)
        type(contact_set), intent(in) :: set
        real(dp), intent(in) :: dt                    !! [T]
        type(batch_results), intent(inout) :: batch
        type(timer), intent(inout) :: watch
        integer :: i

        batch%statev = set%statev
        call watch%start()
        do i = 1, set%increments
            call friction_update_batch(set%du, dt, props, batch%statev, batch%traction, &
                batch%tangent, batch%status)
        end do
        call watch%stop()
    end subroutine run_batch

    !> The batch routine against the scalar one, untimed, over chunks of points that differ in dt.
    subroutine check_batch(n, apart)
        integer, intent(in) :: n                !! points in all
        type(deviation), intent(out) :: apart
        integer, parameter :: chunk = 10000
        character(len=6), parameter :: names(0:1) = ['random', 'wide  ']
        real(dp) :: dt(n / chunk)
        type(batch_results) :: batch
        type(contact_set) :: set
        type(timer) :: watch
        integer :: i

        call omp_set_num_threads(2)
        call reserve(chunk, batch)
        call draw_times(seed, dt)
        do i = 1, size(dt)
            call draw_set(trim(names(mod(i, 2))), chunk, seed + i, set)
            call run_batch(set, dt(i), batch, watch)
            call compare_batch(set, dt(i), batch, apart)
        end do
    end subroutine check_batch

    !> The scalar routine, point by point.
    subroutine measure_scalar(set, row)
        type(contact_set), intent(in) :: set
        type(cost_row), intent(out) :: row
        real(dp), allocatable :: du(:, :), statev(:, :), dt(:)
        real(dp) :: traction(3), tangent(3, 3)
        type(timer) :: watch
        integer :: n, i, k, increment, status

        n = size(set%du, 1)
        du = transpose(set%du)
        dt = times_of(set)
        do i = 1, repetitions_for(n * set%increments)
            statev = transpose(set%statev)
            call watch%start()
            do increment = 1, set%increments
                do k = 1, n
                    call friction_update(du(:, k), dt(k), props, statev(:, k), traction, tangent, &
                        status)
                    if (status < 0) row%apart%failures = row%apart%failures + 1
                end do
            end do
            call watch%stop()
            row%apart%backward = row%apart%backward + count(statev(statev_slip, :) < 0.0_dp)
        end do
        call describe(row, 'scalar', set, 1, watch)
        row%compared = .true.
    end subroutine measure_scalar

    !> One logarithm and one square root a point, over the same data.
    subroutine measure_log_and_sqrt(set, row)
        type(contact_set), intent(in) :: set
        type(cost_row), intent(out) :: row
        real(dp), allocatable :: statev(:, :)
        real(dp), volatile :: total   ! keeps the loop alive
        type(timer) :: watch
        integer :: i

        statev = transpose(set%statev)
        do i = 1, repetitions_for(size(set%du, 1))
            call watch%start()
            total = log_and_sqrt(statev)
            call watch%stop()
        end do
        call describe(row, 'log + sqrt', set, 1, watch)
    end subroutine measure_log_and_sqrt

    !> The paper's Newton method on four unknowns, and its results beside the scalar routine's.
    subroutine measure_four_unknowns(set, row, iterations, slipping)
        type(contact_set), intent(in) :: set
        type(cost_row), intent(out) :: row
        real(dp), intent(out) :: iterations(2)   !! of the points that slip: mean, largest
        real(dp), intent(out) :: slipping        !! share of the updates that slip
        real(dp), allocatable :: du(:, :), statev(:, :), dt(:)
        type(point_results) :: one, other
        type(timer) :: watch
        integer :: n, i, k, increment, taken, slips
        logical :: converged

        n = size(set%du, 1)
        du = transpose(set%du)
        dt = times_of(set)
        do i = 1, repetitions_for(n * set%increments * slowness)
            statev = transpose(set%statev)
            call watch%start()
            do increment = 1, set%increments
                do k = 1, n
                    call four_unknown_update(du(:, k), dt(k), props, statev(:, k), other%traction, &
                        other%tangent, taken, converged)
                end do
            end do
            call watch%stop()
        end do
        call describe(row, 'four unknowns', set, 1, watch)

        ! Once more for the figures, which have no place in the timed loop.
        row%compared = .true.
        iterations = 0.0_dp
        slips = 0
        do k = 1, n
            one%statev = set%statev(k, :)
            other%statev = one%statev
            other%status = friction_ok
            do increment = 1, set%increments
                call friction_update(du(:, k), dt(k), props, one%statev, one%traction, &
                    one%tangent, one%status)
                call four_unknown_update(du(:, k), dt(k), props, other%statev, other%traction, &
                    other%tangent, taken, converged)
                if (taken > 0) slips = slips + 1
                if (.not. converged) other%status = friction_no_convergence
                iterations = [iterations(1) + taken, max(iterations(2), real(taken, dp))]
            end do
            call compare_point(set%statev(k, :), set%increments * norm2(du(:, k)), one, other, &
                row%apart)
        end do
        iterations(1) = iterations(1) / max(slips, 1)
        slipping = real(slips, dp) / (n * set%increments)
    end subroutine measure_four_unknowns

    !> Increments of time of a set's points where each may have its own.
    function times_of(set) result(dt)
        type(contact_set), intent(in) :: set
        real(dp) :: dt(size(set%du, 1))   !! [T]

        dt = time_step
        if (set%increments == 1) call draw_times(seed, dt)
    end function times_of

    subroutine reserve(n, batch)
        integer, intent(in) :: n
        type(batch_results), intent(out) :: batch

        allocate (batch%statev(n, 8), batch%traction(n, 3), batch%tangent(n, 3, 3), &
            batch%status(n))
    end subroutine reserve

    !> What a row says of what was measured and for how long.
    subroutine describe(row, routine, set, threads, watch)
        type(cost_row), intent(inout) :: row
        character(len=*), intent(in) :: routine
        type(contact_set), intent(in) :: set
        integer, intent(in) :: threads
        type(timer), intent(in) :: watch
        real(dp) :: updates

        row%routine = routine
        row%set = set%name
        row%n = size(set%du, 1)
        row%threads = threads
        updates = real(row%n, dp) * set%increments
        row%median = 1.0e9_dp * watch%median() / updates
        row%lowest = 1.0e9_dp * watch%lowest() / updates
    end subroutine describe

end module measurements
