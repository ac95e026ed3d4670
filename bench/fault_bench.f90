!> What a step of the fault costs a cell and evaluation (of six an explicit step), beside a padded
!> Fourier transform of the same size by FFTW, there and back, and a copy of as many numbers as an
!> evaluation reads and writes: fault_bench INPUT [NX NZ]... (docs/scaling.md). Lowest times of
!> repetitions; with mpirun those of the first process, which waits for the others.
program fault_bench
    use, intrinsic :: iso_c_binding, only : c_double_complex, c_int, c_ptr
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use fault_elasticity, only : good_length
    use fault_explicit, only : explicit_steps
    use fault_problem, only : fault, fault_state
    use fault_reader, only : read_fault_plan
    use fault_settings, only : fault_plan
    use fftw, only : fftw_destroy_plan, fftw_estimate, fftw_execute_dft_c2r, &
        fftw_execute_dft_r2c, fftw_plan_dft_c2r_2d, fftw_plan_dft_r2c_2d
    use namelist_input, only : namelist_file, read_namelist_file
    use omp_lib, only : omp_set_num_threads
    use processes, only : team
    use stopwatch, only : timer
    implicit none

    integer, parameter :: evaluations = 6      !! of a step
    integer, parameter :: numbers_moved = 25   !! a cell and evaluation, read or written
    integer, parameter :: steps = 60           !! of which each is timed
    type(team) :: together
    type(fault_plan) :: plan
    type(namelist_file) :: file
    character(len=:), allocatable :: problem
    integer :: i

    call omp_set_num_threads(1)
    call together%start()
    call read_namelist_file(argument(1), file, problem)
    if (len(problem) > 0) error stop 'fault_bench: no input'
    call read_fault_plan(file, plan)
    problem = file%describe_faults()
    if (len(problem) > 0) error stop 'fault_bench: bad input'
    plan%t_end = huge(1.0_dp)
    if (together%rank == 0) then
        print '(a, i0)', 'ns a cell and evaluation; processes: ', together%members
        print '(2a)', '  nx x nz           step  elasticity    transform        copy   ', &
            'step/transform'
    end if
    if (command_argument_count() < 2) call measure(plan%nx, plan%nz)
    do i = 2, command_argument_count() - 1, 2
        call measure(whole_number(argument(i)), whole_number(argument(i + 1)))
    end do
    call together%end()

contains

    subroutine measure(nx, nz)
        integer, intent(in) :: nx, nz
        type(fault) :: here
        type(fault_state) :: state
        type(explicit_steps) :: stepper
        type(timer) :: stepping, applying
        real(dp) :: ns(4)
        logical :: sound
        integer :: step

        plan%nx = nx
        plan%nz = nz
        call here%create(plan, together)
        call stepper%start(here, together, state, problem)
        call stepper%begin(here, together, state, sound)
        do step = 1, steps
            call together%wait()
            call stepping%start()
            call stepper%step(here, together, state, sound)
            call stepping%stop()
            if (.not. sound) error stop 'fault_bench: no step'
            call together%wait()
            call applying%start()
            call here%surroundings%apply(together, state%slip, state%traction)
            call applying%stop()
        end do
        call here%surroundings%free()
        ns = [stepping%lowest() / evaluations, applying%lowest(), transform(nx, nz), &
            copy(nx * nz)] / (real(nx, dp) * nz) * 1.0e9_dp
        if (together%rank == 0) print '(i6, " x", i6, 4f12.2, f17.2)', nx, nz, ns, ns(1) / ns(3)
    end subroutine measure

    !> A real transform in two dimensions and its inverse, by one process [s].
    function transform(nx, nz) result(time)
        integer, intent(in) :: nx, nz
        real(dp) :: time
        real(dp), allocatable :: field(:, :)
        complex(c_double_complex), allocatable :: waves(:, :)
        type(c_ptr) :: forth, back
        type(timer) :: watch
        integer :: lx, lz, repetition

        lx = good_length(2 * nx)
        lz = good_length(2 * nz)
        allocate (field(lx, lz), waves(lx / 2 + 1, lz))
        forth = fftw_plan_dft_r2c_2d(int(lz, c_int), int(lx, c_int), field, waves, fftw_estimate)
        back = fftw_plan_dft_c2r_2d(int(lz, c_int), int(lx, c_int), waves, field, fftw_estimate)
        field = 0.0_dp
        do repetition = 1, steps
            call watch%start()
            call fftw_execute_dft_r2c(forth, field, waves)
            call fftw_execute_dft_c2r(back, waves, field)
            call watch%stop()
        end do
        call fftw_destroy_plan(forth)
        call fftw_destroy_plan(back)
        time = watch%lowest()
    end function transform

    !> [s]
    function copy(cells) result(time)
        integer, intent(in) :: cells
        real(dp) :: time
        real(dp), allocatable :: from(:, :), to(:, :)
        type(timer) :: watch
        integer :: repetition

        allocate (from(cells, numbers_moved / 2), to(cells, numbers_moved / 2))
        from = 1.0_dp
        to = 0.0_dp
        do repetition = 1, steps
            from(1, 1) = to(cells, 1) + 1.0_dp
            call watch%start()
            to = from
            call watch%stop()
        end do
        time = watch%lowest()
    end function copy

    function argument(i) result(word)
        integer, intent(in) :: i
        character(len=:), allocatable :: word
        character(len=1000) :: buffer

        call get_command_argument(i, buffer)
        word = trim(buffer)
    end function argument

    function whole_number(word) result(number)
        character(len=*), intent(in) :: word
        integer :: number

        read (word, *) number
    end function whole_number

end program fault_bench
