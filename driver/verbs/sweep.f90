!> The verb `sweep`: runs the input with every combination of the values of one or two keys, as many
!> at a time as wanted, and tabulates what each run has come to.
module sweep
    use, intrinsic :: iso_fortran_env, only : dp => real64, error_unit
    use child_process, only : child, wait_for_one
    use command_line, only : command
    use friction_mod, only : friction_version
    use namelist_input, only : namelist_file
    use number_text, only : whole_text
    use platform, only : cores, rename_file, report
    use progress_bar, only : progress
    use result_files, only : of_sweep, remove_results
    use run_observer, only : observer, observer_slot, step_news
    use run_outcome, only : outcome
    use run_pictures, only : draw_sweep
    use run_settings, only : settings
    use simulation, only : simulate, simulation_run, start_run
    use slider_system, only : slider_state
    use sweep_journal, only : journal, read_rows
    use sweep_reader, only : read_sweep
    use sweep_settings, only : sweep_plan
    use sweep_table, only : failure_text, late_from, point_text, result_text, table_header
    use text_file, only : output_file
    use verb_common, only : directory_is_ready, exit_bad_input, exit_done, exit_failed, &
        has_faults, is_for
    use whole_file, only : line_text
    implicit none
    private

    public :: sweep_input

    !> Ends a run whose sweep is no more: one that is killed takes no child along.
    type, extends(observer) :: parent_watch
        type(child) :: this
        integer :: steps_between = 1   !! looks
    contains
        procedure :: see => look_for_parent
    end type parent_watch

contains

    !> Reads, validates, runs what no earlier sweep has left in the journal, and reports.
    subroutine sweep_input(wanted, exit_status)
        type(command), intent(in) :: wanted
        integer, intent(out) :: exit_status
        type(namelist_file) :: file
        type(sweep_plan) :: plan
        type(journal) :: done
        type(line_text), allocatable :: rows(:)
        character(len=:), allocatable :: base, problem
        logical, allocatable :: mine(:)   !! the combinations of this part of the sweep
        integer :: found, failures

        exit_status = exit_bad_input
        if (.not. is_for('sweep', wanted%input, file)) return
        call read_plan(file, plan)
        if (has_faults(file)) return
        if (.not. directory_is_ready(wanted%output, wanted%stem, file)) return
        base = wanted%output // '/' // wanted%stem // '_sweep'
        call open_journal(wanted, base, plan, done, rows, problem)
        if (len(problem) > 0) then
            write (error_unit, '(2a)') 'stickslip: ', problem
            return
        end if
        if (wanted%parts == 1) call remove_results(wanted%output // '/' // wanted%stem, of_sweep)
        mine = is_mine(wanted, size(rows))
        found = count_rows(pack(rows, mine))
        call run_all(plan, wanted, mine, found, done, rows, problem)
        if (len(problem) == 0 .and. wanted%parts == 1) call write_table(base, plan, rows, problem)
        if (done%file%failed) problem = 'cannot write ' // journal_name(wanted, base) &
            // ' (disk full?)'
        call done%file%finish()
        failures = count_rows_with(plan, rows, 'failed,', mine)
        if (.not. wanted%quiet .and. len(problem) == 0) call print_summary(wanted, base, &
            count(mine), found, failures)
        exit_status = merge(exit_failed, exit_done, failures > 0 .or. len(problem) > 0)
        if (failures > 0) write (error_unit, '(3a, i0, a, i0, 2a)') 'stickslip: ', wanted%input, &
            ': ', failures, ' of ', count(mine), ' combinations failed; the reasons are in ', &
            results_name(wanted, base)
        if (len(problem) == 0 .and. wanted%plot .and. wanted%parts == 1) call draw_sweep(plan, &
            wanted%output, wanted%stem // '_sweep', &
            count_rows_with(plan, rows, 'ok,stick-slip,', mine), problem)
        if (len(problem) > 0) write (error_unit, '(2a)') 'stickslip: ', problem
    end subroutine sweep_input

    !> All combinations, as a sweep runs them; every fault is left in `file%faults`.
    subroutine read_plan(file, plan)
        type(namelist_file), intent(inout) :: file
        type(sweep_plan), intent(out) :: plan
        integer :: i

        call read_sweep(file, plan)
        if (size(file%faults) > 0) return
        do i = 1, size(plan%runs)
            call plan%runs(i)%drive%divide(late_from(plan%runs(i)))
            plan%runs(i)%interval = huge(plan%runs(i)%interval)   ! no series is kept
            plan%runs(i)%every = 0.0_dp
        end do
    end subroutine read_plan

    !> One of every n combinations, another one each time: the parts of a map take about the same
    !> time, as many as its columns, too.
    pure function is_mine(wanted, combinations) result(mine)
        type(command), intent(in) :: wanted
        integer, intent(in) :: combinations
        logical :: mine(combinations)
        integer :: i

        mine = [(modulo(i + i / wanted%parts, wanted%parts) == wanted%part - 1, &
            i = 0, combinations - 1)]
    end function is_mine

    !> Each part of a sweep keeps a journal of its own: files of a cluster cannot be shared.
    pure function journal_name(wanted, base) result(name)
        type(command), intent(in) :: wanted
        character(len=*), intent(in) :: base
        character(len=:), allocatable :: name

        name = base // '.journal'
        if (wanted%parts > 1) name = part_journal(base, wanted%part)
    end function journal_name

    pure function part_journal(base, part) result(name)
        character(len=*), intent(in) :: base
        integer, intent(in) :: part
        character(len=:), allocatable :: name

        name = base // '_part_' // whole_text(part) // '.journal'
    end function part_journal

    !> Where the rows are when all is done.
    pure function results_name(wanted, base) result(name)
        type(command), intent(in) :: wanted
        character(len=*), intent(in) :: base
        character(len=:), allocatable :: name

        name = base // '.csv'
        if (wanted%parts > 1) name = journal_name(wanted, base)
    end function results_name

    !> Finds the combinations whose rows are in the journals of an earlier sweep and of its parts.
    subroutine open_journal(wanted, base, plan, done, rows, problem)
        type(command), intent(in) :: wanted
        character(len=*), intent(in) :: base
        type(sweep_plan), intent(in) :: plan
        type(journal), intent(inout) :: done
        type(line_text), allocatable, intent(out) :: rows(:)  !! one a combination, empty if not run
        character(len=:), allocatable, intent(out) :: problem
        type(line_text), allocatable :: known(:)
        type(line_text) :: starts(size(plan%runs))   ! of the rows
        character(len=:), allocatable :: input
        integer :: i

        allocate (rows(size(plan%runs)))
        do i = 1, size(rows)
            rows(i)%text = ''
            starts(i)%text = point_text(plan%point(i))
        end do
        input = 'stickslip ' // friction_version // new_line('a') // table_header(plan%axes) &
            // new_line('a') // plan%input
        call read_rows(base // '.journal', input, known, problem)
        if (len(problem) > 0) return
        call take_rows(starts, known, rows)
        do i = 1, size(rows)   ! parts of a higher number have no combination
            call read_rows(part_journal(base, i), input, known, problem)
            if (len(problem) > 0) return
            call take_rows(starts, known, rows)
        end do
        call done%open(journal_name(wanted, base), input, known, problem)
    end subroutine open_journal

    !> Rows are about in the order of the combinations: the next one is looked for behind the last.
    subroutine take_rows(starts, known, rows)
        type(line_text), intent(in) :: starts(:)       !! which tell the combinations
        type(line_text), intent(in) :: known(:)
        type(line_text), intent(inout) :: rows(:)
        integer :: i, j, tried

        i = 0
        do j = 1, size(known)
            associate (row => known(j)%text)
                do tried = 1, size(rows)
                    i = 1 + modulo(i, size(rows))
                    if (row(:min(len(row), len(starts(i)%text))) == starts(i)%text) exit
                end do
                if (tried <= size(rows)) rows(i)%text = row
            end associate
        end do
    end subroutine take_rows

    !> Runs the combinations that have no row, each in a process of its own. A row does not depend
    !> on what runs beside it. Rows of runs that crashed stay out of the journal: they are tried
    !> again.
    subroutine run_all(plan, wanted, mine, found, done, rows, problem)
        type(sweep_plan), intent(in) :: plan
        type(command), intent(in) :: wanted
        logical, intent(in) :: mine(:)            !! the combinations to run
        integer, intent(in) :: found              !! of these, rows that are there
        type(journal), intent(inout) :: done
        type(line_text), intent(inout) :: rows(:)
        character(len=:), allocatable, intent(out) :: problem
        type(child), allocatable :: children(:)
        integer, allocatable :: combination(:)    !! that a child runs
        type(progress) :: bar
        integer :: i, next, finished

        problem = ''
        i = wanted%jobs
        if (wanted%jobs == 0) i = cores()
        allocate (children(i), combination(i))
        next = 1
        finished = found
        call bar%begin(.not. wanted%quiet, 0.0_dp)
        do
            do i = 1, size(children)
                if (.not. children(i)%running()) call give_work(i)
            end do
            if (.not. any(children%running())) exit
            call take_result()
            call bar%show(real(finished, dp) / count(mine))
        end do
        call bar%clear()

    contains

        subroutine give_work(k)
            integer, intent(in) :: k
            logical :: inside, started

            do while (next <= size(rows))
                if (mine(next) .and. len(rows(next)%text) == 0) exit
                next = next + 1
            end do
            if (next > size(rows)) return
            call children(k)%start(inside, started)
            if (inside) call children(k)%tell_and_end(run_one(plan%runs(next), children(k)))
            if (.not. started) then
                if (.not. any(children%running())) problem = 'no process can be started'
                return
            end if
            combination(k) = next
            next = next + 1
        end subroutine give_work

        subroutine take_result()
            character(len=:), allocatable :: text
            logical :: sound
            integer :: k

            call wait_for_one(children, k, text, sound)
            if (k == 0) return
            if (.not. sound) text = failure_text('the run crashed')
            associate (row => rows(combination(k)))
                row%text = point_text(plan%point(combination(k))) // text
                finished = finished + 1
                if (sound) call done%append(row%text)
            end associate
        end subroutine take_result

    end subroutine run_all

    !> What a run has come to, as text.
    function run_one(run, this) result(text)
        type(settings), intent(in) :: run
        type(child), intent(in) :: this   !! in which it runs
        character(len=:), allocatable :: text
        integer, parameter :: blocks_between = 256   !! looks, times steps
        type(simulation_run) :: live
        type(parent_watch), target :: watch
        type(observer_slot) :: observers(1)
        type(outcome) :: result

        watch = parent_watch(this, max(1, blocks_between / run%chain%n_blocks))
        observers(1)%it => watch
        call start_run(run, live)
        call simulate(live, observers, result)
        text = result_text(run, result)
    end function run_one

    subroutine look_for_parent(self, old, new, news)
        class(parent_watch), intent(inout) :: self
        type(slider_state), intent(in) :: old, new
        type(step_news), intent(inout) :: news

        if (mod(news%steps, self%steps_between) /= 0) return
        if (self%this%orphaned()) call news%stop_run('its sweep has ended')
    end subroutine look_for_parent

    !> The table replaces an older one whole or not at all.
    subroutine write_table(base, plan, rows, problem)
        character(len=*), intent(in) :: base
        type(sweep_plan), intent(in) :: plan
        type(line_text), intent(in) :: rows(:)
        character(len=:), allocatable, intent(out) :: problem
        type(output_file) :: table
        integer :: i

        call table%create(base // '.csv.new')
        call table%write_line(table_header(plan%axes))
        do i = 1, size(rows)
            call table%write_line(rows(i)%text)
        end do
        call table%finish()
        problem = ''
        if (.not. table%failed) then
            if (rename_file(base // '.csv.new', base // '.csv')) return
        end if
        problem = 'cannot write ' // base // '.csv (disk full?)'
    end subroutine write_table

    pure integer function count_rows(rows) result(n)
        type(line_text), intent(in) :: rows(:)
        integer :: i

        n = count([(len(rows(i)%text) > 0, i = 1, size(rows))])
    end function count_rows

    !> Combinations among `mine` whose results start with a text.
    pure integer function count_rows_with(plan, rows, start, mine) result(n)
        type(sweep_plan), intent(in) :: plan
        type(line_text), intent(in) :: rows(:)
        character(len=*), intent(in) :: start
        logical, intent(in) :: mine(:)
        integer :: i

        n = count([(mine(i) .and. index(rows(i)%text, point_text(plan%point(i)) // start) == 1, &
            i = 1, size(rows))])
    end function count_rows_with

    subroutine print_summary(wanted, base, combinations, found, failures)
        type(command), intent(in) :: wanted
        character(len=*), intent(in) :: base
        integer, intent(in) :: combinations, found, failures

        if (wanted%parts > 1) write (report, '(2(a, i0))') 'part               ', wanted%part, &
            ' of ', wanted%parts
        write (report, '(a, 3(i0, a))') 'combinations       ', combinations, ': ', &
            combinations - found, ' run now, ', found, ' taken from the journal'
        write (report, '(a, i0)') 'failed             ', failures
        write (report, '(2a)') merge('rows               ', 'table              ', &
            wanted%parts > 1), results_name(wanted, base)
    end subroutine print_summary

end module sweep
