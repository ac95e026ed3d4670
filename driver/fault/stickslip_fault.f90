!> stickslip-fault: the fault engine, which `stickslip fault` runs. A program of its own, so that
!> nothing else depends on FFTW, MPI or NetCDF.
program stickslip_fault
    use, intrinsic :: iso_fortran_env, only : error_unit, int64
    use fault_picture, only : draw_fault
    use fault_reader, only : read_fault_plan
    use fault_run, only : run_fault
    use fault_settings, only : fault_plan
    use launcher, only : is_companion
    use namelist_input, only : namelist_file, read_namelist_file
    use netcdf_table, only : read_netcdf_table
    use platform, only : exit_program, hold_output, report, watch_for_interrupts
    use processes, only : lacks_mpi, team
    use result_files, only : prepare_output
    !$ use omp_lib, only : omp_set_num_threads
    implicit none
    integer, parameter :: exit_done = 0, exit_failed = 1, exit_bad_input = 2   ! of verb_common
    type(team) :: together
    type(fault_plan) :: plan
    type(namelist_file) :: file
    character(len=:), allocatable :: input, directory, stem, problem
    logical :: resume, quiet, plot
    integer(int64) :: first   !! of the processes that have a problem

    !$ call omp_set_num_threads(1)   ! processes share the work, not threads
    call hold_output()
    input = argument(1)
    directory = argument(2)
    stem = argument(3)
    resume = index(argument(4), 'resume') > 0
    quiet = index(argument(4), 'quiet') > 0
    plot = index(argument(4), 'no-plot') == 0
    if (lacks_mpi()) then
        if (is_companion()) call exit_program(exit_done)   ! the first process tells it, and fails
        write (error_unit, '(a)') 'stickslip: this fault engine was built without MPI, and runs ' &
            // 'on one process (Debian: libopenmpi-dev libfftw3-mpi-dev, then build again)'
        call exit_program(exit_failed)
    end if
    call watch_for_interrupts()
    call together%start()
    call read_namelist_file(input, file, problem)
    if (len(problem) > 0) then
        problem = 'stickslip: ' // input // ': ' // problem // new_line('a')
    else
        call read_fault_plan(file, plan, read_netcdf_table)
        problem = file%describe_faults()
    end if
    if (len(problem) == 0 .and. argument(4) == 'check') then
        write (report, '(2a, i0, a, i0, a)') input, ': valid, ', plan%nx, ' x ', plan%nz, &
            ' cells, for stickslip fault'
        call finish(exit_done)
    end if
    if (len(problem) == 0) then
        call prepare_output(file, directory, stem, problem)
        if (len(problem) > 0) problem = problem // new_line('a')
    end if
    if (together%any_of(len(problem) > 0)) then
        first = together%lowest(merge(int(together%rank, int64), huge(first), len(problem) > 0))
        if (together%rank == first) write (error_unit, '(a)', advance='no') problem
        call finish(exit_bad_input)
    end if
    call together%wait()
    call run_fault(plan, together, directory // '/' // stem, resume, quiet, problem)
    if (len(problem) > 0) then
        if (together%rank == 0) write (error_unit, '(4a)') 'stickslip: ', input, ': ', problem
        call finish(exit_failed)
    end if
    if (plot .and. together%rank == 0) then
        call draw_fault(plan, directory, stem, problem)
        if (len(problem) > 0) write (error_unit, '(2a)') 'stickslip: ', problem
    end if
    call finish(exit_done)

contains

    subroutine finish(status)
        integer, intent(in) :: status

        call together%end()
        call exit_program(status)
    end subroutine finish

    function argument(i) result(word)
        integer, intent(in) :: i
        character(len=:), allocatable :: word
        integer :: length

        call get_command_argument(i, length=length)
        allocate (character(len=length) :: word)
        if (length > 0) call get_command_argument(i, word)
    end function argument

end program stickslip_fault
