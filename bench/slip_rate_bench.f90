!> What `friction_slip_rates` costs a point in one thread, beside a copy of the bytes that it moves
!> and beside a logarithm of the C library: slip_rate_bench (docs/performance.md).
program slip_rate_bench
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use friction_mod, only : friction_slip_rates
    use omp_lib, only : omp_set_num_threads
    use stopwatch, only : repetitions_for, timer
    implicit none

    integer, parameter :: sizes(3) = [1000, 10000, 100000]
    real(dp), parameter :: damping = 4.62e6_dp   !! of crustal rock [Pa s/m]
    real(dp), parameter :: d_c = 0.008_dp, v0 = 1.0e-6_dp, b = 0.015_dp, f0 = 0.6_dp
    integer :: i

    call omp_set_num_threads(1)
    print '(a)', 'friction_slip_rates, 1 thread: ns a point, median of repetitions (lowest)'
    print '(a)', '      points   1e-12..1e-6 m/s     1e-30..1e3 m/s      copy     log'
    do i = 1, size(sizes)
        call measure(sizes(i))
    end do

contains

    !> One row: slip rates of a fault between earthquakes, over all that there are, and the peers.
    subroutine measure(n)
        integer, intent(in) :: n
        real(dp) :: slow(2), all(2)

        slow = cost(n, -12.0_dp, -6.0_dp)
        all = cost(n, -30.0_dp, 3.0_dp)
        print '(i12, 2(f10.2, " (", f6.2, ")"), 2f9.2)', n, slow, all, peers(n)
    end subroutine measure

    !> Median and lowest [ns].
    function cost(n, lowest, highest) result(ns)
        integer, intent(in) :: n
        real(dp), intent(in) :: lowest, highest   !! log10 of the slip rates
        real(dp) :: ns(2)
        real(dp), dimension(n) :: tau, pressure, theta, rate, theta_rate, v, drawn
        real(dp) :: props(n, 8)
        integer :: status(n), repetition
        type(timer) :: watch

        props(:, 1:3) = spread([4.0_dp, 1.0_dp, 1.0_dp], 1, n)
        call random_number(drawn)
        props(:, 4) = 0.005_dp + 0.02_dp * drawn
        props(:, 5:8) = spread([b, d_c, v0, f0], 1, n)
        pressure = 50.0e6_dp
        call random_number(drawn)
        theta = d_c / v0 * exp(40.0_dp * (drawn - 0.5_dp))
        call random_number(drawn)
        v = 10.0_dp**(lowest + (highest - lowest) * drawn)
        tau = props(:, 4) * pressure * asinh(v / (2.0_dp * v0) * exp((f0 + b * log(v0 * theta &
            / d_c)) / props(:, 4))) + damping * v
        do repetition = 1, repetitions_for(n)
            call watch%start()
            call friction_slip_rates(tau, pressure, damping, props, theta, rate, theta_rate, status)
            call watch%stop()
        end do
        if (any(status /= 0) .or. .not. all(abs(rate / v - 1.0_dp) <= 1.0e-9_dp)) error stop 'wrong'
        ns = [watch%median(), watch%lowest()] / n * 1.0e9_dp
    end function cost

    !> A copy of half the bytes that a point moves, and a logarithm [ns].
    function peers(n) result(ns)
        integer, intent(in) :: n
        real(dp) :: ns(2)
        integer, parameter :: numbers = 6   !! 9 read, 2.5 written: half of that
        real(dp) :: from(n, numbers), to(n, numbers)
        type(timer) :: copying, taking
        integer :: repetition, i

        call random_number(from)
        do repetition = 1, repetitions_for(n)
            call copying%start()
            to = from
            call copying%stop()
            from(1, 1) = 0.5_dp * to(n, numbers)
            call taking%start()
            do i = 1, n
                to(i, 1) = log(from(i, 2))
            end do
            call taking%stop()
            from(1, 2) = from(1, 2) + 1.0e-3_dp * to(n, 1)**2
        end do
        ns = [copying%median(), taking%median()] / n * 1.0e9_dp
    end function peers

end program slip_rate_bench
