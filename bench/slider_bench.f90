!> What a run of the driver costs and how exact it is, beside an explicit Runge-Kutta method of
!> order 5(4): slider_bench DIRECTORY (docs/performance.md).
program slider_bench
    use, intrinsic :: iso_fortran_env, only : dp => real64, output_unit
    use explicit_slider, only : explicit_run, solve_explicitly
    use loading_programme, only : programme
    use reference_problem, only : last_peak, problem
    use run_observer, only : observer_slot
    use run_outcome, only : outcome
    use run_settings, only : settings
    use simulation, only : simulate, simulation_run, start_run
    use stopwatch, only : timer
    use worst_errors, only : worst_of
    !$ use omp_lib, only : omp_get_num_procs, omp_set_num_threads
    implicit none

    integer, parameter :: repetitions = 3
    real(dp), parameter :: smallest_drop = 0.04_dp   !! the driver's: 1 % of static friction [F]
    type(explicit_run) :: truth
    character(len=4096) :: directory
    character(len=120) :: line
    integer :: text, places(2)

    call get_command_argument(1, directory)
    open (newunit=text, file=trim(directory) // '/slider.txt', status='replace', action='write')
    places = [output_unit, text]
    !$ call omp_set_num_threads(1)
    call show_rate_and_state()
    call compare(0.01_dp)
    call compare(0.0_dp)
    call show_orders()
    call show_chains()
    call show_threads()
    close (text)

contains

    !> 100 cycles of the reference problem, by both.
    subroutine compare(damping)
        real(dp), intent(in) :: damping             !! [F T/L]
        real(dp), parameter :: t_end = 320.0_dp
        real(dp), parameter :: error_bar = 3.0e-4_dp   !! of event times [T]
        real(dp), parameter :: rtols(8) = [1.0e-5_dp, 1.0e-6_dp, 3.0e-7_dp, 1.0e-7_dp, 1.0e-8_dp, &
            3.0e-9_dp, 1.0e-9_dp, 1.0e-10_dp]
        real(dp) :: fastest(2)   ! with an error within the bar: the explicit method's, the driver's
        integer :: i, scheme
        character(len=40) :: name

        call solve_explicitly(problem(damping, t_end), 1.0e-12_dp, smallest_drop, truth)
        write (line, '(a, f5.2, a, f6.1, a, i0, a)') 'damping ', damping, ', ', t_end, ' s, ', &
            size(truth%onsets), ' events'
        call say('')
        call say(trim(line))
        call say('method' // repeat(' ', 38) // 'steps    CPU s   event error s')
        fastest = huge(fastest)
        do i = 1, size(rtols)
            write (name, '(a, es7.1)') 'explicit 5(4), rtol ', rtols(i)
            call measure_explicitly(damping, t_end, rtols(i), trim(name), error_bar, fastest(1))
        end do
        do i = 1, size(rtols)
            write (name, '(a, es7.1)') 'adaptive, rtol ', rtols(i)
            call measure(problem(damping, t_end, rtol=rtols(i)), trim(name), error_bar, fastest(2))
        end do
        do scheme = 1, 0, -1
            call measure(problem(damping, t_end, scheme=scheme, dt=1.0e-3_dp), &
                trim(scheme_name(scheme)) // ', dt 1e-3', error_bar, fastest(2))
        end do
        write (line, '(a, f6.3, 2x, a)') 'bar: CPU time over the explicit method''s, both at an ' &
            // 'error <= 3e-4 s    <= 1   ', fastest(2) / fastest(1), &
            verdict(fastest(2) <= fastest(1))
        call say(trim(line))
    end subroutine compare

    subroutine measure_explicitly(damping, t_end, rtol, name, allowed, fastest)
        real(dp), intent(in) :: damping, t_end, rtol
        character(len=*), intent(in) :: name
        real(dp), intent(in) :: allowed        !! error of event times [T]
        real(dp), intent(inout) :: fastest     !! of those within it [s]
        type(explicit_run) :: explicit
        real(dp) :: seconds, error
        integer :: i

        seconds = huge(seconds)
        do i = 1, repetitions
            call solve_explicitly(problem(damping, t_end), rtol, smallest_drop, explicit)
            seconds = min(seconds, explicit%seconds)
            if (seconds > 0.5_dp) exit
        end do
        error = event_error(explicit%onsets)
        call row(name, explicit%steps, seconds, error)
        if (error <= allowed) fastest = min(fastest, seconds)
    end subroutine measure_explicitly

    !> Earthquake cycles: without inertia but with radiation damping, and with inertia. The last
    !> periods of Rodas4 at rtol 1e-10, which a Radau method confirms (docs/validation.md).
    subroutine show_rate_and_state()
        type(settings) :: quasi_dynamic, inertial

        allocate (quasi_dynamic%props(10), source=[4.0_dp, 1.0e6_dp, 1.0e6_dp, 0.01_dp, 0.014_dp, &
            1.0e-3_dp, 1.0e-6_dp, 0.6_dp, 0.0_dp, 1.0e6_dp])
        quasi_dynamic%stiffness = 41.23_dp
        quasi_dynamic%damping = 5.0_dp
        quasi_dynamic%drive = steady_drive(1.0e-9_dp, 100.0_dp)
        quasi_dynamic%t_end = 3.15e9_dp
        allocate (inertial%props(8), source=[4.0_dp, 1.0e10_dp, 1.0e10_dp, 0.0144_dp, 0.02312_dp, &
            0.09_dp, 1.0e-3_dp, 0.64395_dp])
        inertial%mass = 60.0e6_dp
        inertial%stiffness = 1.0e6_dp
        inertial%drive = steady_drive(1.0e-3_dp, 20.0e6_dp)
        inertial%t_end = 4.0e4_dp
        call say('')
        call say('rate-and-state cycles' // repeat(' ', 23) // 'steps    CPU s   relative error ' &
            // 'of the last period')
        call show_cycles('without inertia, rtol 3e-6', quasi_dynamic, 3.0e-6_dp, 2.8426183e8_dp, &
            5000, 1.7e-6_dp)
        call show_cycles('inertia, rtol 1e-5', inertial, 1.0e-5_dp, 3778.6234_dp, 15000, &
            0.05_dp / 3778.6_dp)
    end subroutine show_rate_and_state

    subroutine show_cycles(name, problem, rtol, period, most_steps, largest_error)
        character(len=*), intent(in) :: name
        type(settings), intent(in) :: problem
        real(dp), intent(in) :: rtol, period   !! the latter exact [T]
        integer, intent(in) :: most_steps      !! the bars
        real(dp), intent(in) :: largest_error
        type(settings) :: run
        type(simulation_run) :: live
        type(observer_slot) :: nobody(0)
        type(outcome) :: result
        real(dp) :: begun, ended, error
        integer :: n

        run = problem
        run%initial%any_given = .true.
        run%initial%has_r = .false.
        run%initial%mu = 0.6_dp
        run%initial%r = 1.0_dp
        run%adaptive = .true.
        run%rtol = rtol
        run%dt = 1.0e-6_dp * run%t_end
        run%dt_max = run%t_end
        call cpu_time(begun)
        call start_run(run, live)
        call simulate(live, nobody, result)
        call cpu_time(ended)
        n = size(result%onsets)
        error = huge(error)
        if (n > 2) error = abs((result%onsets(n) - result%onsets(n - 1)) / period - 1.0_dp)
        call row(name, result%steps, ended - begun, error)
        write (line, '(a, i6, a, es8.1, 2x, a)') 'bar: steps <= ', most_steps, ' at an error <= ', &
            largest_error, verdict(result%steps <= most_steps .and. error <= largest_error)
        call say(trim(line))
    end subroutine show_cycles

    pure function steady_drive(velocity, normal) result(drive)
        real(dp), intent(in) :: velocity, normal   !! [L/T], [F/L^2]
        type(programme) :: drive

        drive = programme(start=[0.0_dp], travel=[0.0_dp], velocity=[velocity], &
            acceleration=[0.0_dp], normal=[normal], normal_rate=[0.0_dp])
    end function steady_drive

    !> CPU time of a block and step in chains of growing length: the difference of a long and a
    !> short run, so that the start does not count.
    subroutine show_chains()
        integer, parameter :: few = 10, many = 40
        integer :: n, i
        real(dp) :: cost, first

        call say('')
        call say('chain of blocks   Newton iterations a step   CPU ns a block and step')
        first = 0.0_dp
        do i = 3, 6
            n = 10**i
            cost = cost_of_chain(n, few, many)
            if (i == 3) first = cost
        end do
        write (line, '(a, f6.2, 2x, a)') &
            'bar: 1e6 blocks over 1e3 blocks, cost of a block and step   <= 1.2   ', cost / first, &
            verdict(cost <= 1.2_dp * first)
        call say(trim(line))
        write (line, '(a, f6.0, 2x, a)') &
            'bar: 1e6 blocks, ns a block and step                        <= 250   ', cost, &
            verdict(cost <= 250.0_dp)
        call say(trim(line))
    end subroutine show_chains

    !> Time by the clock of a long chain in two threads and in one, in turn.
    subroutine show_threads()
        integer, parameter :: blocks = 100000, steps = 40, turns = 5
        type(timer) :: times(2)
        real(dp) :: cpu, iterations
        integer :: threads, i

        cpu = 0.0_dp
        threads = 1
        !$ threads = omp_get_num_procs()
        if (threads < 2) return
        do i = 1, turns
            do threads = 1, 2
                !$ call omp_set_num_threads(threads)
                call times(threads)%start()
                call time_chain(blocks, steps, cpu, iterations)
                call times(threads)%stop()
            end do
        end do
        !$ call omp_set_num_threads(1)
        write (line, '(a, f6.2)') '1e5 blocks, two threads, times faster by the clock than one: ', &
            times(1)%median() / times(2)%median()
        call say(trim(line))
    end subroutine show_threads

    !> Median of several runs; short chains, whose runs are short, are run more often.
    function cost_of_chain(n, few, many) result(cost)
        integer, intent(in) :: n           !! blocks
        integer, intent(in) :: few, many   !! steps
        real(dp) :: cost                   !! [ns]
        real(dp) :: seconds(2), costs(5), iterations
        integer :: k, j, again, repeats

        repeats = max(1, 100000 / n)
        do k = 1, size(costs)
            seconds = 0.0_dp
            do again = 1, repeats
                do j = 1, 2
                    call time_chain(n, merge(few, many, j == 1), seconds(j), iterations)
                end do
            end do
            costs(k) = 1.0e9_dp * (seconds(2) - seconds(1)) / (real(n, dp) * (many - few) * repeats)
        end do
        cost = middle(costs)
        write (line, '(i15, f28.2, f26.0)') n, iterations, cost
        call say(trim(line))
    end function cost_of_chain

    subroutine time_chain(n, steps, seconds, iterations)
        integer, intent(in) :: n, steps
        real(dp), intent(inout) :: seconds      !! CPU time is added [s]
        real(dp), intent(out) :: iterations     !! of Newton's method a step
        real(dp), parameter :: dt = 1.0e-3_dp
        type(settings) :: run
        type(simulation_run) :: live
        type(observer_slot) :: nobody(0)
        type(outcome) :: result
        real(dp) :: begun, ended

        run = problem(0.01_dp, steps * dt, dt=dt)
        run%chain%n_blocks = n
        run%chain%coupling = 10.0_dp
        run%chain%scatter = 0.1_dp
        run%chain%slip_rate = 1.0_dp
        run%initial%any_given = .true.
        run%initial%mu = 0.4_dp
        run%initial%r = 0.9_dp
        call cpu_time(begun)
        call start_run(run, live)
        call simulate(live, nobody, result)
        call cpu_time(ended)
        seconds = seconds + (ended - begun)
        iterations = real(result%iterations, dp) / max(1, steps)
    end subroutine time_chain

    pure function middle(values) result(median)
        real(dp), intent(in) :: values(:)   !! an odd number of them
        real(dp) :: median
        integer :: i

        median = 0.0_dp
        do i = 1, size(values)
            if (count(values < values(i)) > size(values) / 2) cycle
            if (count(values > values(i)) > size(values) / 2) cycle
            median = values(i)
        end do
    end function middle

    !> A row of the table.
    subroutine measure(run, name, allowed, fastest)
        type(settings), intent(in) :: run
        character(len=*), intent(in) :: name
        real(dp), intent(in) :: allowed        !! error of event times [T]
        real(dp), intent(inout) :: fastest     !! of those within it [s]
        type(simulation_run) :: live
        type(observer_slot) :: nobody(0)
        type(outcome) :: result
        real(dp) :: begun, ended, seconds, error
        integer :: i

        seconds = huge(seconds)
        do i = 1, repetitions
            call cpu_time(begun)
            call start_run(run, live)
            call simulate(live, nobody, result)
            call cpu_time(ended)
            seconds = min(seconds, ended - begun)
            if (seconds > 0.5_dp) exit
        end do
        error = event_error(result%onsets)
        call row(name, result%steps, seconds, error)
        if (len(result%failure) > 0) call say('  ' // result%failure)
        if (error <= allowed) fastest = min(fastest, seconds)
    end subroutine measure

    !> Largest difference from the reference; huge if the numbers of events differ.
    function event_error(onsets) result(error)
        real(dp), intent(in) :: onsets(:)   !! [T]
        real(dp) :: error                   !! [T]

        error = huge(error)
        if (size(onsets) == size(truth%onsets)) error = worst_of(abs(onsets - truth%onsets))
    end function event_error

    !> Fixed steps: first event, before which nothing rings, and third event, with the ringing
    !> resolved.
    subroutine show_orders()
        call say('')
        call say('fixed steps, damping 0.01: errors and observed orders')
        call say('scheme          event      dt s   event time s  order    peak force  order')
        call show_order(scheme=1, event=1, t_end=5.0_dp, longest=2.0e-3_dp)
        call show_order(scheme=0, event=1, t_end=5.0_dp, longest=2.0e-3_dp)
        call show_order(scheme=1, event=3, t_end=12.0_dp, longest=2.0e-4_dp)
        call show_order(scheme=0, event=3, t_end=12.0_dp, longest=2.0e-4_dp)
    end subroutine show_orders

    subroutine show_order(scheme, event, t_end, longest)
        integer, intent(in) :: scheme, event
        real(dp), intent(in) :: t_end      !! [T]
        real(dp), intent(in) :: longest    !! step [T]
        integer, parameter :: halvings = 3
        real(dp) :: dt, onset, peak, error(2), before(2), order(2), first(2)
        integer :: i

        call solve_explicitly(problem(0.01_dp, t_end), 1.0e-12_dp, smallest_drop, truth)
        before = 0.0_dp
        do i = 0, halvings
            dt = longest / 2**i
            call last_peak(problem(0.01_dp, t_end, scheme=scheme, dt=dt), event, onset, peak)
            error = abs([onset - truth%onsets(event), (peak - truth%peak_force) / truth%peak_force])
            order = log(before / error) / log(2.0_dp)
            write (line, '(a14, i7, es11.2, 2(es14.2, f7.2))') scheme_name(scheme), event, dt, &
                error(1), order(1), error(2), order(2)
            if (i == 0) first = error
            if (i == 0) line(47:53) = ''
            if (i == 0) line(68:) = ''
            call say(trim(line))
            before = error
        end do
        if (scheme == 0) return
        order = log(first / error) / log(2.0_dp) / halvings
        write (line, '(a, 2f7.2, 2x, a)') 'bar: orders over this range >= 1.9', order, &
            verdict(all(order >= 1.9_dp))
        call say(trim(line))
    end subroutine show_order

    pure function scheme_name(scheme) result(name)
        integer, intent(in) :: scheme
        character(len=14) :: name

        name = merge('exact_rate    ', 'backward_euler', scheme == 1)
    end function scheme_name

    subroutine row(name, steps, seconds, error)
        character(len=*), intent(in) :: name
        integer, intent(in) :: steps
        real(dp), intent(in) :: seconds, error

        write (line, '(a38, i11, f9.3, es16.1)') name // repeat(' ', 38), steps, seconds, error
        call say(trim(line))
    end subroutine row

    pure function verdict(met) result(word)
        logical, intent(in) :: met
        character(len=6) :: word

        word = merge('met   ', 'MISSED', met)
    end function verdict

    subroutine say(what)
        character(len=*), intent(in) :: what
        integer :: i

        do i = 1, 2
            write (places(i), '(a)') what
            flush (places(i))
        end do
    end subroutine say

end program slider_bench
