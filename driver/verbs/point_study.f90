!> The verb point: takes one contact point along its path, and reports.
module point_study
    use, intrinsic :: iso_fortran_env, only : dp => real64, error_unit
    use command_line, only : command
    use friction_mod, only : friction_message, statev_dissipation, statev_slip
    use law_facts, only : internal_variable
    use loading_path, only : point_run
    use material_point, only : contact_point, load_report, virgin_point
    use namelist_input, only : namelist_file
    use number_text, only : rounded_text
    use platform, only : interrupted, report, watch_for_interrupts
    use point_recorder, only : point_csv
    use point_reader, only : read_point_settings
    use progress_bar, only : progress
    use result_files, only : of_run, remove_results
    use run_pictures, only : draw_point
    use verb_common, only : directory_is_ready, exit_bad_input, has_faults, is_for, tell_failure
    implicit none
    private

    public :: run_point

    !> The largest value that a quantity takes, and when.
    type :: peak
        real(dp) :: value = 0.0_dp
        real(dp) :: time = 0.0_dp   !! [T]
    end type peak

    !> What a path has come to.
    type :: outcome
        character(len=:), allocatable :: failure   !! empty if the path was followed to its end
        integer :: increments = 0
        integer :: iterations = 0, most_iterations = 0
        integer :: cuts = 0                        !! parts of increments that were halved
        integer :: snap_backs = 0                  !! increments that had several equilibria
        real(dp) :: time = 0.0_dp                  !! reached [T]
        type(peak) :: pressure, shear              !! |t_n|, |t_t| [F/L^2]
    end type outcome

contains

    !> Reads, validates, follows the path and reports. What has been computed stays on disk.
    subroutine run_point(wanted, exit_status)
        type(command), intent(in) :: wanted
        integer, intent(out) :: exit_status
        type(point_run) :: run
        type(point_csv) :: records
        type(contact_point) :: point
        type(outcome) :: result
        type(namelist_file) :: file
        character(len=:), allocatable :: problem, base

        exit_status = exit_bad_input
        if (.not. is_for('point', wanted%input, file)) return
        call read_point_settings(file, run)
        if (has_faults(file)) return
        base = wanted%output // '/' // wanted%stem
        if (.not. directory_is_ready(wanted%output, wanted%stem, file)) return
        call remove_results(base, of_run)
        call records%start(base // '.csv', run%loading%ndir, internal_variable(run%props), &
            run%tangent)
        if (records%file%failed) then
            write (error_unit, '(3a)') 'stickslip: cannot write ', base, '.csv'
            return
        end if

        call watch_for_interrupts()
        call follow_path(run, records, .not. wanted%quiet, point, result)
        call records%file%finish()
        if (records%file%failed .and. len(result%failure) == 0) result%failure = &
            'at its end: cannot write the last rows (disk full?)'
        if (.not. wanted%quiet) call print_summary(point, result, base // '.csv')
        call tell_failure(wanted%input, result%failure, base, exit_status)
        if (.not. wanted%plot .or. interrupted()) return
        call draw_point(run, wanted%output, wanted%stem, problem)
        if (len(problem) > 0) write (error_unit, '(2a)') 'stickslip: ', problem
    end subroutine run_point

    !> Cycles of segments of increments, a row each. `failure` of the outcome says when and why, if
    !> the path ends early; the last row is then the last state that could be carried.
    subroutine follow_path(run, records, show_progress, point, result)
        type(point_run), intent(in) :: run
        type(point_csv), intent(inout) :: records
        logical, intent(in) :: show_progress
        type(contact_point), intent(out) :: point
        type(outcome), intent(out) :: result
        type(progress) :: bar
        real(dp), dimension(run%loading%ndir) :: start, from, to
        real(dp) :: time, total
        integer :: cycle_number, i, k, status

        result%failure = ''
        call virgin_point(run%props, run%loading%ndir, point, status)
        if (status < 0) result%failure = 'at the start: ' // friction_message(status)
        time = 0.0_dp
        total = run%loading%increments()
        call records%write_row(time, point, 0)
        call bar%begin(show_progress, 0.0_dp)
        associate (path => run%loading)
            do cycle_number = 1, path%cycles
                do i = 1, size(path%duration)
                    start = path%starting_values(i, result%increments == 0, point%u, point%traction)
                    to = start
                    do k = 1, path%steps(i)
                        if (len(result%failure) > 0) exit
                        from = to
                        to = start + (path%target(:, i) - start) * (real(k, dp) / path%steps(i))
                        if (k == path%steps(i)) to = path%target(:, i)
                        call take_increment(path%by_traction(:, i), &
                            path%duration(i) / path%steps(i), &
                            time + path%duration(i) * (real(k, dp) / path%steps(i)))
                    end do
                    time = time + path%duration(i)
                end do
                if (len(result%failure) > 0) exit
            end do
            call bar%clear()
        end associate

    contains

        subroutine take_increment(by_traction, dt, end_time)
            logical, intent(in) :: by_traction(:)
            real(dp), intent(in) :: dt, end_time   !! [T]
            type(load_report) :: report
            character(len=60) :: place

            call point%load(by_traction, from, to, dt, report)
            result%time = end_time - (1.0_dp - report%done) * dt
            result%iterations = result%iterations + report%iterations
            result%most_iterations = max(result%most_iterations, report%iterations)
            result%cuts = result%cuts + report%cuts
            if (report%snap_back) result%snap_backs = result%snap_backs + 1
            write (place, '(3a, i0, a)') 'at time ', rounded_text(result%time, 13, 6), &
                ', increment ', result%increments + 1, ': '
            if (len(report%failure) > 0) result%failure = trim(place) // ' ' // report%failure
            if (.not. report%done > 0.0_dp) return
            if (len(report%failure) == 0) result%increments = result%increments + 1
            call raise(result%pressure, abs(point%traction(1)), result%time)
            call raise(result%shear, norm2(point%traction(2:)), result%time)
            call records%write_row(result%time, point, report%iterations)
            if (records%file%failed) result%failure = trim(place) &
                // ' cannot write the rows (disk full?)'
            if (interrupted() .and. len(result%failure) == 0) result%failure = trim(place) &
                // ' interrupted'
            call bar%show(result%increments / total)
        end subroutine take_increment

    end subroutine follow_path

    pure subroutine raise(highest, value, time)
        type(peak), intent(inout) :: highest
        real(dp), intent(in) :: value, time

        if (value > highest%value) highest = peak(value, time)
    end subroutine raise

    subroutine print_summary(point, result, table)
        type(contact_point), intent(in) :: point
        type(outcome), intent(in) :: result
        character(len=*), intent(in) :: table   !! name of the file with the rows
        real(dp) :: dissipated

        dissipated = point%statev(statev_dissipation)
        write (report, '(a, i0, 3a)') 'increments         ', result%increments, &
            ' to time ', rounded_text(result%time, 12, 5), ' [T]'
        write (report, '(a, i0, a, i0)') 'Newton iterations  ', result%iterations, &
            ', most in an increment ', result%most_iterations
        if (result%cuts > 0) write (report, '(a, i0, a)') 'cuts               ', &
            result%cuts, ' increments or parts of increments were halved'
        if (result%snap_backs > 0) write (report, '(a, i0, a)') 'snap-back          ', &
            result%snap_backs, &
            ' increments had several equilibria: use more steps or a larger alpha_t'
        call print_peak('largest pressure   ', result%pressure)
        call print_peak('largest shear      ', result%shear)
        write (report, '(3a)') 'slip               ', &
            rounded_text(point%statev(statev_slip), 14, 6), ' [L]'
        write (report, '(3a)') 'work               ', rounded_text(point%work, 14, 6), ' [F/L] ='
        write (report, '(2a)') '  stored           ', rounded_text(point%stored(), 14, 6)
        write (report, '(2a)') '  dissipated       ', rounded_text(dissipated, 14, 6)
        write (report, '(2a)') '  unbalanced       ', &
            rounded_text(point%work - point%stored() - dissipated, 14, 6)
        write (report, '(2a)') 'table              ', table
    end subroutine print_summary

    subroutine print_peak(title, highest)
        character(len=*), intent(in) :: title
        type(peak), intent(in) :: highest

        write (report, '(4a)') title, rounded_text(highest%value, 14, 6), ' [F/L^2] at time ', &
            rounded_text(highest%time, 12, 5)
    end subroutine print_peak

end module point_study
