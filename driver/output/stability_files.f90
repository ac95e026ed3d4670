!> What is told about the stability of steady sliding: tables, a screen of text, and the picture of
!> its boundary.
module stability_files
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use linear_stability, only : critical_value, stability, unstable, verdicts
    use number_text, only : full_row, quoted_field, rounded_text, whole_text
    use picture, only : picture_values
    use platform, only : report
    use stability_map, only : plane_map
    use steady_answers, only : answer_columns, critical_keys, criticals, n_numbers, steady_answer
    use steady_sliding, only : sliding_case
    use text_file, only : output_file, write_numbers
    use unit_names, only : units
    implicit none
    private

    public :: draw_boundary, eigenvalue_row, print_stability, stability_row, write_eigenvalues, &
        write_map

    character(len=*), parameter, public :: stability_columns = answer_columns // ',reason'
    character(len=*), parameter, public :: eigenvalue_columns = &
        'row,real_part,imaginary_part,frequency,damping_ratio'

contains

    !> A row of the table, all but the keys of a sweep.
    function stability_row(answer) result(row)
        type(steady_answer), intent(in) :: answer
        character(len=:), allocatable :: row
        real(dp) :: numbers(n_numbers)

        numbers = answer%numbers()
        row = whole_text(answer%piece) // ',' // full_row(numbers(2:4)) // ',' &
            // trim(verdicts(answer%result%verdict)) // ',' // full_row(numbers(6:)) // ','
        if (len(answer%result%problem) > 0) row = row // quoted_field(answer%result%problem)
    end function stability_row

    !> Rows of the table of eigenvalues.
    subroutine write_eigenvalues(file, row, result)
        type(output_file), intent(inout) :: file
        integer, intent(in) :: row   !! of the other table
        type(stability), intent(in) :: result
        integer :: i

        do i = 1, size(result%eigenvalues)
            call file%write_line(whole_text(row) // ',' &
                // full_row(eigenvalue_row(result%eigenvalues(i))))
        end do
    end subroutine write_eigenvalues

    !> Real and imaginary part, frequency and damping ratio.
    pure function eigenvalue_row(lambda) result(row)
        complex(dp), intent(in) :: lambda   !! [1/T]
        real(dp) :: row(4)

        row = [real(lambda, dp), aimag(lambda), abs(aimag(lambda)) / (8.0_dp * atan(1.0_dp)), &
            -real(lambda, dp) / max(abs(lambda), tiny(1.0_dp))]
    end function eigenvalue_row

    subroutine print_stability(answer, pieces)
        type(steady_answer), intent(in) :: answer
        integer, intent(in) :: pieces   !! that are told
        real(dp) :: numbers(n_numbers)
        integer :: i

        numbers = answer%numbers()
        if (pieces > 1) write (report, '(a, i0)') 'piece              ', answer%piece
        write (report, '(5a)') 'steady sliding     ', rounded_text(numbers(2), 14, 6), &
            ' [L/T] under ', rounded_text(numbers(3), 14, 6), ' [F/L^2]'
        associate (result => answer%result)
            if (len(result%problem) > 0) then
                write (report, '(2a)') 'stability          none: ', result%problem
                return
            end if
            write (report, '(2a)') 'friction           ', rounded_text(numbers(4), 14, 6)
            write (report, '(2a)') 'stability          ', trim(verdicts(result%verdict))
            write (report, '(5a)') 'fastest growth     ', rounded_text(result%growth, 14, 6), &
                ' [1/T] at ', rounded_text(result%frequency, 14, 6), ' [1/T]'
            do i = 1, size(result%eigenvalues)
                write (report, '(4a)') merge('eigenvalues        ', '                   ', &
                    i == 1), rounded_text(real(result%eigenvalues(i)), 23, 14), &
                    rounded_text(aimag(result%eigenvalues(i)), 23, 14), ' i'
            end do
        end associate
        do i = 1, criticals
            call print_critical(trim(critical_keys(i)), answer%critical(i)%range, &
                answer%critical(i)%found)
        end do
    end subroutine print_stability

    subroutine print_critical(key, range, found)
        character(len=*), intent(in) :: key
        real(dp), intent(in) :: range(2)
        type(critical_value), intent(in) :: found(:)
        character(len=19) :: title
        integer :: i

        title = 'critical ' // key(index(key, '%') + 1:)
        if (size(found) == 0) write (report, '(5a)') title, ' none from ', &
            rounded_text(range(1), 8, 1), ' to ', rounded_text(range(2), 8, 1)
        do i = 1, size(found)
            write (report, '(4a)') title, rounded_text(found(i)%value, 23, 15), ': ', &
                merge('stable above  ', 'unstable above', found(i)%stable_above)
            title = ''
        end do
    end subroutine print_critical

    !> BASE_map.csv, a row a place of the grid, and BASE_boundary.csv.
    subroutine write_map(base, map, problem)
        character(len=*), intent(in) :: base
        type(plane_map), intent(in) :: map
        character(len=:), allocatable, intent(out) :: problem
        type(output_file) :: grid
        character(len=:), allocatable :: keys
        logical :: written
        integer :: i, j

        keys = map%axes(1)%name // ',' // map%axes(2)%name
        call grid%create(base // '_map.csv')
        call grid%write_line(keys // ',stability,growth_rate,frequency')
        do i = 0, ubound(map%verdict, 1)
            do j = 0, ubound(map%verdict, 2)
                call grid%write_line(full_row([map%axes(1)%value_at(i), map%axes(2)%value_at(j)]) &
                    // ',' // trim(verdicts(map%verdict(i, j))) // ',' &
                    // full_row([map%growth(i, j), map%frequency(i, j)]))
            end do
        end do
        call grid%finish()
        call write_numbers(base // '_boundary.csv', keys // ',frequency', map%boundary, written)
        problem = ''
        if (grid%failed .or. .not. written) problem = 'cannot write ' // base &
            // '_map.csv and _boundary.csv (disk full?)'
    end subroutine write_map

    !> DIRECTORY/STEM.png of the files that `write_map` left there. `problem` says what went wrong.
    subroutine draw_boundary(map, this, marked, directory, stem, names, problem)
        type(plane_map), intent(in) :: map
        type(sliding_case), intent(in) :: this
        logical, intent(in) :: marked            !! show where that is
        character(len=*), intent(in) :: directory, stem
        type(units), intent(in) :: names
        character(len=:), allocatable, intent(out) :: problem
        type(picture_values) :: values
        character(len=1), parameter :: place(2) = ['1', '2']
        real(dp) :: half   ! of a cell, as a factor; 1 where there is only one
        integer :: i

        call values%begin(stem, stem // '_map.csv', names)
        call values%set('boundary', stem // '_boundary.csv')
        do i = 1, 2
            associate (axis => map%axes(i))
                call values%set('key_' // place(i), axis%name)
                call values%set('lowest_' // place(i), axis%range(1))
                call values%set('highest_' // place(i), axis%range(2))
                half = sqrt(axis%value_at(1) / axis%value_at(0))
                call values%set('half_' // place(i), merge(half, 1.1_dp, half > 1.0_dp))
                call values%set('here_' // place(i), abs(this%value_of(axis%name)))
            end associate
        end do
        call values%set('marked', merge(1, 0, marked))
        call values%set('found', size(map%boundary, 2))
        call values%set('swings', merge(1, 0, any(map%verdict == unstable .and. map%frequency &
            > 0.0_dp)))
        call values%draw('stability', directory, stem, problem)
    end subroutine draw_boundary

end module stability_files
