!> The program's slider without files: input as a text, results as tables. C interface:
!> include/stickslip_program.h.
module run_in_memory
    use, intrinsic :: iso_c_binding, only : c_associated, c_char, c_double, c_f_pointer, &
        c_f_procpointer, c_funptr, c_int, c_int64_t, c_loc, c_null_char, c_null_ptr, c_ptr
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use c_library, only : c_strlen
    use csv_table, only : column_request, table, table_of_bytes
    use friction_mod, only : friction_null_pointer
    use input_kind, only : refuse_other_verb
    use linear_stability, only : undecided
    use memory_recorder, only : memory_table, memory_watch
    use namelist_input, only : namelist_file, read_namelist_text
    use namelist_json, only : write_json
    use piece_table, only : piece_columns, piece_rows
    use run_observer, only : observer, observer_slot, step_news
    use run_outcome, only : outcome
    use run_reader, only : read_settings
    use run_settings, only : settings
    use run_warnings, only : find_warnings, run_warning
    use simulation, only : simulate, simulation_run, start_run
    use slider_system, only : slider_state
    use stability_files, only : eigenvalue_columns, eigenvalue_row
    use steady_answers, only : answer_columns, find_answers, steady_answer
    use summary, only : summary_columns, summary_row
    use verb_common, only : exit_bad_input, exit_done, exit_failed
    use whole_file, only : plain_text
    implicit none
    private

    public :: c_columns, c_free, c_groups, c_report, c_run, c_stability, c_table

    !> What a run, or the analysis of steady sliding, leaves. Texts end with a null character.
    type :: run_result
        type(memory_watch) :: found
        type(memory_table) :: pieces, summary, steady, eigenvalues
        type(memory_table) :: columns   !! of a file
        character(len=:), allocatable :: faults, failure, warnings, reasons, text, groups
    end type run_result

    abstract interface
        !> Of include/stickslip_program.h.
        integer(c_int) function watch_function(part, context) result(stop_now) bind(C)
            import :: c_double, c_int, c_ptr
            implicit none
            real(c_double), value, intent(in) :: part
            type(c_ptr), value, intent(in) :: context
        end function watch_function
    end interface

    !> Tells the caller how far the run has come, and ends it if the caller wants so.
    type, extends(observer) :: caller_watch
        procedure(watch_function), pointer, nopass :: watch => null()
        type(c_ptr) :: context = c_null_ptr
        real(dp) :: t_end = 0.0_dp   !! [T]
    contains
        procedure :: see => tell_caller
    end type caller_watch

contains

    subroutine tell_caller(self, old, new, news)
        class(caller_watch), intent(inout) :: self
        type(slider_state), intent(in) :: old, new
        type(step_news), intent(inout) :: news
        integer, parameter :: steps_between = 4096

        if (.not. associated(self%watch)) return
        if (mod(news%steps, steps_between) /= 0) return
        if (self%watch(new%time / self%t_end, self%context) /= 0) call news%stop_run( &
            'ended by the caller')
    end subroutine tell_caller

    !> `stickslip_run` of include/stickslip_program.h.
    integer(c_int) function c_run(name, text, watch, context, result) result(status) &
        bind(C, name='stickslip_run')
        type(c_ptr), value, intent(in) :: name, text   !! C texts
        type(c_funptr), value, intent(in) :: watch
        type(c_ptr), value, intent(in) :: context
        type(c_ptr), value, intent(in) :: result       !! place of a pointer
        type(run_result), pointer :: this
        type(caller_watch), target :: caller
        procedure(watch_function), pointer :: watch_
        type(settings) :: run
        type(simulation_run) :: live
        type(observer_slot) :: observers(2)
        type(outcome) :: ended
        type(run_warning), allocatable :: warnings(:)
        real(dp), allocatable :: rows(:, :)
        integer :: i

        status = friction_null_pointer
        call make_result(name, text, result, this)
        if (.not. associated(this)) return
        if (c_associated(watch)) then
            call c_f_procpointer(watch, watch_)
            caller%watch => watch_
        end if
        caller%context = context
        call read_text(fortran_text(name), fortran_text(text), run, this)
        status = exit_bad_input
        if (len(this%faults) > 1) return

        call start_run(run, live)
        call this%found%prepare(run)
        caller%t_end = run%t_end
        observers(1)%it => this%found
        observers(2)%it => caller
        call simulate(live, observers, ended)
        call find_warnings(run, ended, warnings)
        do i = size(warnings), 1, -1
            this%warnings = trim(warnings(i)%text) // new_line('a') // this%warnings
        end do
        call this%pieces%start(piece_columns)
        rows = piece_rows(run, ended)
        do i = 1, size(rows, 2)
            call this%pieces%add(rows(:, i))
        end do
        call this%summary%start(summary_columns)
        call this%summary%add(summary_row(run, ended))
        status = exit_done
        if (len(ended%failure) == 0) return
        status = exit_failed
        this%failure = ended%failure // c_null_char
    end function c_run

    !> An empty result in the place that a caller has for it; none if a pointer is missing.
    subroutine make_result(name, text, result, this)
        type(c_ptr), intent(in) :: name, text   !! C texts
        type(c_ptr), intent(in) :: result       !! place of a pointer
        type(run_result), pointer, intent(out) :: this
        type(c_ptr), pointer :: place

        nullify (this)
        call forget(result)
        if (.not. (c_associated(result) .and. c_associated(name) .and. c_associated(text))) return
        allocate (this)
        call c_f_pointer(result, place)
        place = c_loc(this)
    end subroutine make_result

    !> There is no result, and what its place held is not to be freed as one.
    subroutine forget(result)
        type(c_ptr), intent(in) :: result   !! place of a pointer, or NULL
        type(c_ptr), pointer :: place

        if (.not. c_associated(result)) return
        call c_f_pointer(result, place)
        place = c_null_ptr
    end subroutine forget

    !> `stickslip_stability` of include/stickslip_program.h. Of the reasons there is a line a row.
    function c_stability(name, text, result) result(status) bind(C, name='stickslip_stability')
        type(c_ptr), value, intent(in) :: name, text   !! C texts
        type(c_ptr), value, intent(in) :: result       !! place of a pointer
        integer(c_int) :: status
        type(run_result), pointer :: this
        type(settings) :: run
        type(steady_answer), allocatable :: answers(:)
        integer :: i, k

        status = friction_null_pointer
        call make_result(name, text, result, this)
        if (.not. associated(this)) return
        call read_text(fortran_text(name), fortran_text(text), run, this)
        this%reasons = c_null_char
        status = exit_bad_input
        if (len(this%faults) > 1) return

        call find_answers(run, answers)
        call this%steady%start(answer_columns)
        call this%eigenvalues%start(eigenvalue_columns)
        status = exit_failed
        do i = 1, size(answers)
            call this%steady%add(answers(i)%numbers())
            associate (steady => answers(i)%result)
                if (steady%verdict /= undecided) status = exit_done
                do k = 1, size(steady%eigenvalues)
                    call this%eigenvalues%add([real(i, dp), eigenvalue_row(steady%eigenvalues(k))])
                end do
            end associate
        end do
        do i = size(answers), 1, -1
            this%reasons = answers(i)%result%problem // new_line('a') // this%reasons
        end do
    end function c_stability

    !> Reads the input of a run; its faults are left in the result.
    subroutine read_text(name, text, run, this)
        character(len=*), intent(in) :: name, text
        type(settings), intent(out) :: run
        type(run_result), intent(inout) :: this
        type(namelist_file) :: file
        character(len=:), allocatable :: problem
        logical :: refused

        this%failure = c_null_char
        this%warnings = c_null_char
        ! gfortran (12) keeps the lengths of some functions' results in static memory, and reading
        ! calls such functions: one thread at a time.
        !$omp critical (stickslip_reading)
        call read_namelist_text(name, text, file, problem)
        if (len(problem) > 0) then
            this%faults = name // ': ' // problem // new_line('a')
        else
            call refuse_other_verb('run', file, refused)
            if (.not. refused) call read_settings(file, run)
            this%faults = file%describe_faults()
        end if
        this%faults = this%faults // c_null_char
        !$omp end critical (stickslip_reading)
    end subroutine read_text

    !> `stickslip_groups` of include/stickslip_program.h.
    function c_groups(name, content, bytes, result) result(status) bind(C, name='stickslip_groups')
        type(c_ptr), value, intent(in) :: name, content
        integer(c_int64_t), value, intent(in) :: bytes   !! of the content
        type(c_ptr), value, intent(in) :: result         !! place of a pointer
        integer(c_int) :: status
        type(run_result), pointer :: this
        type(namelist_file) :: file
        character(len=:), allocatable :: problem

        status = friction_null_pointer
        call forget(result)
        if (bytes < 0) return
        call make_result(name, content, result, this)
        if (.not. associated(this)) return
        !$omp critical (stickslip_reading)
        call plain_text(letters_at(content, bytes), this%text, problem)
        call read_namelist_text(fortran_text(name), letters_at(content, bytes), file, problem)
        if (len(problem) > 0) call file%add_fault(0, problem)
        call write_json(file, this%groups)
        this%faults = file%describe_faults() // c_null_char
        !$omp end critical (stickslip_reading)
        this%text = this%text // c_null_char
        this%groups = this%groups // c_null_char
        status = merge(exit_bad_input, exit_done, len(this%faults) > 1)
    end function c_groups

    !> `stickslip_columns` of include/stickslip_program.h.
    integer(c_int) function c_columns(content, bytes, n, names, result) result(status) &
        bind(C, name='stickslip_columns')
        type(c_ptr), value, intent(in) :: content
        integer(c_int64_t), value, intent(in) :: bytes   !! of the content
        integer(c_int), value, intent(in) :: n           !! columns
        type(c_ptr), value, intent(in) :: names          !! of n C texts
        type(c_ptr), value, intent(in) :: result         !! place of a pointer
        type(run_result), pointer :: this
        type(c_ptr), pointer :: name(:)
        type(column_request), allocatable :: requests(:)
        type(table) :: read_in
        integer :: i

        status = friction_null_pointer
        call forget(result)
        if (n < 1 .or. bytes < 0) return
        if (c_associated(names)) then
            call c_f_pointer(names, name, [n])
            if (.not. all([(c_associated(name(i)), i = 1, n)])) return
        end if
        call make_result(content, names, result, this)
        if (.not. associated(this)) return
        allocate (requests(n))
        !$omp critical (stickslip_reading)
        do i = 1, n
            requests(i)%name = fortran_text(name(i))
            requests(i)%needed = .true.
        end do
        call table_of_bytes(letters_at(content, bytes), requests, read_in)
        this%faults = ''
        do i = 1, size(read_in%faults)
            this%faults = this%faults // read_in%faults(i)%text // new_line('a')
        end do
        !$omp end critical (stickslip_reading)
        this%columns%columns = c_null_char   ! the caller knows their names
        this%columns%rows = size(read_in%values, 2)
        call move_alloc(read_in%values, this%columns%values)
        this%faults = this%faults // c_null_char
        status = merge(exit_bad_input, exit_done, len(this%faults) > 1)
    end function c_columns

    !> A C text.
    function fortran_text(address) result(text)
        type(c_ptr), intent(in) :: address
        character(len=c_strlen(address)) :: text

        text = letters_at(address, int(len(text), c_int64_t))
    end function fortran_text

    function letters_at(address, number) result(text)
        type(c_ptr), intent(in) :: address
        integer(c_int64_t), intent(in) :: number
        character(len=number) :: text
        character(len=1, kind=c_char), pointer :: letters(:)
        integer(c_int64_t) :: i

        call c_f_pointer(address, letters, [number])
        do i = 1, number
            text(i:i) = letters(i)
        end do
    end function letters_at

    !> `stickslip_table` of include/stickslip_program.h.
    type(c_ptr) function c_table(result, table, rows, columns, names) result(values) &
        bind(C, name='stickslip_table')
        type(c_ptr), value, intent(in) :: result, table
        type(c_ptr), value, intent(in) :: rows, columns, names   !! places; NULL: nobody asks
        type(memory_table), pointer :: found
        integer(c_int64_t), pointer :: to_rows
        integer(c_int), pointer :: to_columns
        type(c_ptr), pointer :: to_names
        integer(c_int64_t) :: n_rows
        integer(c_int) :: n_columns
        type(c_ptr) :: its_names

        values = c_null_ptr
        its_names = c_null_ptr
        n_rows = 0
        n_columns = 0
        call find_table(result, table, found)
        if (associated(found)) then
            n_rows = found%rows
            if (allocated(found%values)) then   ! else nothing was run
                n_columns = size(found%values, 1)
                its_names = c_loc(found%columns)
                values = c_loc(found%values)
            end if
        end if
        if (c_associated(rows)) then
            call c_f_pointer(rows, to_rows)
            to_rows = n_rows
        end if
        if (c_associated(columns)) then
            call c_f_pointer(columns, to_columns)
            to_columns = n_columns
        end if
        if (c_associated(names)) then
            call c_f_pointer(names, to_names)
            to_names = its_names
        end if
    end function c_table

    subroutine find_table(result, name, found)
        type(c_ptr), intent(in) :: result, name
        type(memory_table), pointer, intent(out) :: found   !! null: there is none of that name
        type(run_result), pointer :: this

        nullify (found)
        if (.not. (c_associated(result) .and. c_associated(name))) return
        call c_f_pointer(result, this)
        select case (fortran_text(name))
        case ('series')
            found => this%found%series
        case ('events')
            found => this%found%events
        case ('catalogue')
            found => this%found%catalogue
        case ('pieces')
            found => this%pieces
        case ('summary')
            found => this%summary
        case ('stability')
            found => this%steady
        case ('eigenvalues')
            found => this%eigenvalues
        case ('columns')
            found => this%columns
        case default   ! none
        end select
    end subroutine find_table

    !> `stickslip_report` of include/stickslip_program.h.
    type(c_ptr) function c_report(result, report) result(text) bind(C, name='stickslip_report')
        type(c_ptr), value, intent(in) :: result, report
        type(run_result), pointer :: this

        text = c_null_ptr
        if (.not. (c_associated(result) .and. c_associated(report))) return
        call c_f_pointer(result, this)
        select case (fortran_text(report))
        case ('faults')
            text = c_loc(this%faults)
        case ('failure')
            if (allocated(this%failure)) text = c_loc(this%failure)
        case ('warnings')
            if (allocated(this%warnings)) text = c_loc(this%warnings)
        case ('reasons')
            if (allocated(this%reasons)) text = c_loc(this%reasons)
        case ('text')
            if (allocated(this%text)) text = c_loc(this%text)
        case ('groups')
            if (allocated(this%groups)) text = c_loc(this%groups)
        case default   ! none
        end select
    end function c_report

    !> `stickslip_free` of include/stickslip_program.h.
    subroutine c_free(result) bind(C, name='stickslip_free')
        type(c_ptr), value, intent(in) :: result
        type(run_result), pointer :: this

        if (.not. c_associated(result)) return
        call c_f_pointer(result, this)
        deallocate (this)
    end subroutine c_free

end module run_in_memory
