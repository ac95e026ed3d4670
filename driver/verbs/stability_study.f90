!> The verb stability: is steady sliding of the input's slider stable, and where does that change?
module stability_study
    use, intrinsic :: iso_fortran_env, only : dp => real64, error_unit
    use command_line, only : command
    use input_kind, only : verb_of
    use linear_stability, only : undecided
    use namelist_input, only : namelist_file
    use platform, only : report
    use result_files, only : of_stability, remove_results
    use run_reader, only : read_settings
    use run_settings, only : settings
    use stability_files, only : draw_boundary, eigenvalue_columns, print_stability, &
        stability_columns, stability_row, write_eigenvalues, write_map
    use stability_map, only : map_axis, map_stability, plane_map
    use steady_answers, only : find_answers, steady_answer
    use steady_sliding, only : sliding_case, take_piece
    use sweep_reader, only : read_sweep
    use sweep_settings, only : sweep_plan
    use sweep_table, only : key_names, point_text
    use text_file, only : output_file
    use verb_common, only : directory_is_ready, exit_bad_input, exit_done, exit_failed, &
        has_faults, is_for
    implicit none
    private

    public :: stability_of_input

    !> Files that grow row by row.
    type :: tables
        type(output_file) :: rows, eigenvalues
        integer :: written = 0   !! rows
        integer :: sliding = 0   !! of them, with steady sliding
    end type tables

contains

    !> Reads and validates; a row for each combination of a sweep and each piece of the programme in
    !> which the drive moves; a picture for the first of them.
    subroutine stability_of_input(wanted, exit_status)
        type(command), intent(in) :: wanted
        integer, intent(out) :: exit_status
        type(namelist_file) :: file
        type(sweep_plan) :: plan
        type(tables) :: into
        character(len=:), allocatable :: base
        integer :: i

        exit_status = exit_bad_input
        if (.not. is_for('stability', wanted%input, file)) return
        call read_runs(file, plan)
        if (has_faults(file)) return
        if (.not. directory_is_ready(wanted%output, wanted%stem, file)) return
        base = wanted%output // '/' // wanted%stem // '_stability'
        call remove_results(wanted%output // '/' // wanted%stem, of_stability)
        call into%rows%create(base // '.csv')
        call into%rows%write_line(key_names(plan%axes) // stability_columns)
        call into%eigenvalues%create(wanted%output // '/' // wanted%stem // '_eigenvalues.csv')
        call into%eigenvalues%write_line(eigenvalue_columns)
        do i = 1, size(plan%runs)
            call tell_run(plan%runs(i), point_text(plan%point(i)), size(plan%runs) == 1 &
                .and. .not. wanted%quiet, into)
        end do
        call into%rows%finish()
        call into%eigenvalues%finish()
        exit_status = merge(exit_done, exit_failed, into%sliding > 0)
        if (size(plan%runs) > 1 .and. .not. wanted%quiet) write (report, '(a, i0, a, i0)') &
            'combinations       ', size(plan%runs), ', rows with steady sliding ', into%sliding
        if (.not. wanted%quiet) write (report, '(3a)') 'table              ', base, '.csv'
        if (into%sliding == 0) write (error_unit, '(5a)') 'stickslip: ', wanted%input, &
            ': nothing slides steadily; the reasons are in ', base, '.csv'
        if (into%rows%failed .or. into%eigenvalues%failed) then
            write (error_unit, '(3a)') 'stickslip: cannot write ', base, '.csv (disk full?)'
            exit_status = exit_failed
        else if (into%sliding > 0) then
            call show_boundary(wanted, plan, base)
        end if
    end subroutine stability_of_input

    !> One run, or those of a sweep; every fault is left in `file%faults`.
    subroutine read_runs(file, plan)
        type(namelist_file), intent(inout) :: file
        type(sweep_plan), intent(out) :: plan
        type(settings) :: run

        if (verb_of(file) == 'sweep') then
            call read_sweep(file, plan)
            return
        end if
        allocate (plan%axes(0), plan%runs(1))
        call read_settings(file, run)
        plan%runs(1) = run
    end subroutine read_runs

    subroutine tell_run(run, keys, aloud, into)
        type(settings), intent(in) :: run
        character(len=*), intent(in) :: keys   !! values of the keys of a sweep
        logical, intent(in) :: aloud
        type(tables), intent(inout) :: into
        type(steady_answer), allocatable :: answers(:)
        integer :: i

        call find_answers(run, answers)
        do i = 1, size(answers)
            into%written = into%written + 1
            if (answers(i)%result%verdict /= undecided) into%sliding = into%sliding + 1
            call into%rows%write_line(keys // stability_row(answers(i)))
            call write_eigenvalues(into%eigenvalues, into%written, answers(i)%result)
            if (aloud) call print_stability(answers(i), size(answers))
        end do
    end subroutine tell_run

    !> The boundary over the keys of the sweep or, without, over velocity and stiffness.
    subroutine show_boundary(wanted, plan, base)
        type(command), intent(in) :: wanted
        type(sweep_plan), intent(in) :: plan
        character(len=*), intent(in) :: base   !! of the names of the files
        character(len=16), parameter :: usual(2) = [character(len=16) :: 'drive%velocity', &
            'slider%stiffness']
        type(sliding_case) :: this
        type(map_axis) :: axes(2)
        type(plane_map) :: map
        character(len=:), allocatable :: problem
        integer :: i, n

        do i = size(plan%runs(1)%drive%velocity), 1, -1
            call take_piece(this, plan%runs(1), i)
            if (abs(this%velocity) > 0.0_dp) exit
        end do
        problem = this%problem
        n = size(plan%axes)
        do i = 1, n
            axes(i)%name = plan%axes(i)%name
            axes(i)%range = [minval(plan%axes(i)%values), maxval(plan%axes(i)%values)]
            if (.not. this%knows(axes(i)%name)) problem = 'steady sliding does not depend on ' &
                // axes(i)%name
            if (.not. axes(i)%range(1) > 0.0_dp) problem = axes(i)%name // ' has values of 0 or ' &
                // 'less, which logarithmic axes do not show'
        end do
        do i = n + 1, 2
            axes(i)%name = trim(usual(i))
            if (i == 2) then
                if (axes(1)%name == usual(2)) axes(2)%name = trim(usual(1))
            end if
            axes(i)%range = abs(this%value_of(axes(i)%name)) * [1.0e-2_dp, 1.0e2_dp]
        end do
        if (len(problem) == 0) then
            call map_stability(this, axes, map)
            call write_map(base, map, problem)
        else
            problem = 'no map is made: ' // problem
        end if
        if (len(problem) == 0 .and. wanted%plot) call draw_boundary(map, this, n == 0, &
            wanted%output, wanted%stem // '_stability', plan%runs(1)%units, problem)
        if (len(problem) > 0) write (error_unit, '(2a)') 'stickslip: ', problem
    end subroutine show_boundary

end module stability_study
