!> What is told about the stability of steady sliding: tables, a screen of text, and the picture of
!> its boundary.
module stability_files
    use, intrinsic :: ieee_arithmetic, only : ieee_quiet_nan, ieee_value
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use linear_stability, only : critical_value, stability, undecided, unstable, verdicts
    use number_text, only : full_row, quoted_field, short_text, whole_text
    use picture, only : picture_values
    use platform, only : report
    use stability_map, only : map_axis, plane_map
    use steady_sliding, only : sliding_case
    use text_file, only : output_file
    use unit_names, only : units
    implicit none
    private

    public :: critical_list, draw_boundary, print_stability, stability_cells, stability_row, &
        write_eigenvalues, write_map

    integer, parameter, public :: criticals = 4
    character(len=*), parameter, public :: critical_keys(criticals) = [character(len=16) :: &
        'slider%stiffness', 'drive%velocity', 'slider%damping', 'slider%mass']

    character(len=*), parameter, public :: stability_columns = 'piece,velocity,normal_traction,' &
        // 'friction,stability,growth_rate,frequency,critical_stiffness,critical_velocity,' &
        // 'critical_damping,critical_mass,reason'
    character(len=*), parameter, public :: eigenvalue_columns = &
        'row,real_part,imaginary_part,frequency,damping_ratio'

    !> What was found for one of the critical keys.
    type :: critical_list
        real(dp) :: range(2) = 0.0_dp   !! that was searched
        type(critical_value), allocatable :: found(:)
    contains
        procedure :: closest_to
    end type critical_list

    real(dp), parameter :: two_pi = 8.0_dp * atan(1.0_dp)

contains

    !> The critical value nearest to another one, as a ratio; NaN if there is none.
    function closest_to(self, value) result(closest)
        class(critical_list), intent(in) :: self
        real(dp), intent(in) :: value   !! where 0 or less, the least one counts as nearest
        real(dp) :: closest

        closest = ieee_value(closest, ieee_quiet_nan)
        if (size(self%found) == 0) return
        closest = self%found(1)%value
        if (value > 0.0_dp) closest = self%found(minloc(abs(log(self%found%value / value)), &
            1))%value
    end function closest_to

    !> A row of the table, all but the keys of a sweep.
    function stability_row(this, piece, result, critical) result(row)
        type(sliding_case), intent(in) :: this
        integer, intent(in) :: piece
        type(stability), intent(in) :: result
        type(critical_list), intent(in) :: critical(criticals)
        character(len=:), allocatable :: row
        integer :: i

        row = whole_text(piece) // ',' // full_row([this%velocity, pressure(this, result), &
            friction(result)]) // ',' // stability_cells(result)
        do i = 1, criticals
            row = row // ',' // full_row([critical(i)%closest_to(abs(this%value_of( &
                trim(critical_keys(i)))))])
        end do
        row = row // ','
        if (len(result%problem) > 0) row = row // quoted_field(result%problem)
    end function stability_row

    !> Its columns stability, growth_rate and frequency.
    function stability_cells(result) result(text)
        type(stability), intent(in) :: result
        character(len=:), allocatable :: text

        text = trim(verdicts(result%verdict)) // ',NaN,NaN'
        if (result%verdict /= undecided) text = trim(verdicts(result%verdict)) // ',' &
            // full_row([result%growth, result%frequency])
    end function stability_cells

    !> Pressure in steady sliding; what is applied, where there is none.
    pure function pressure(this, result)
        type(sliding_case), intent(in) :: this
        type(stability), intent(in) :: result
        real(dp) :: pressure   !! [F/L^2]

        pressure = this%normal
        if (result%contact%pressure > 0.0_dp) pressure = result%contact%pressure
    end function pressure

    !> Traction over pressure in steady sliding.
    function friction(result) result(ratio)
        type(stability), intent(in) :: result
        real(dp) :: ratio   !! [-]

        ratio = ieee_value(ratio, ieee_quiet_nan)
        if (result%contact%pressure > 0.0_dp) ratio = result%contact%traction &
            / result%contact%pressure
    end function friction

    !> Rows of the table of eigenvalues.
    subroutine write_eigenvalues(file, row, result)
        type(output_file), intent(inout) :: file
        integer, intent(in) :: row   !! of the other table
        type(stability), intent(in) :: result
        real(dp) :: size_of
        integer :: i

        do i = 1, size(result%eigenvalues)
            associate (e => result%eigenvalues(i))
                size_of = max(abs(e), tiny(size_of))
                call file%write_line(whole_text(row) // ',' // full_row([real(e, dp), aimag(e), &
                    abs(aimag(e)) / two_pi, -real(e, dp) / size_of]))
            end associate
        end do
    end subroutine write_eigenvalues

    subroutine print_stability(this, piece, pieces, result, critical)
        type(sliding_case), intent(in) :: this
        integer, intent(in) :: piece, pieces
        type(stability), intent(in) :: result
        type(critical_list), intent(in) :: critical(criticals)
        integer :: i

        if (pieces > 1) write (report, '(a, i0)') 'piece              ', piece
        write (report, '(2(a, es14.6), a)') 'steady sliding     ', this%velocity, &
            ' [L/T] under ', pressure(this, result), ' [F/L^2]'
        if (len(result%problem) > 0) then
            write (report, '(2a)') 'stability          none: ', result%problem
            return
        end if
        write (report, '(a, es14.6)') 'friction           ', friction(result)
        write (report, '(2a)') 'stability          ', trim(verdicts(result%verdict))
        write (report, '(2(a, es14.6), a)') 'fastest growth     ', result%growth, &
            ' [1/T] at ', result%frequency, ' [1/T]'
        do i = 1, size(result%eigenvalues)
            write (report, '(a, 2es23.14, a)') merge('eigenvalues        ', &
                '                   ', i == 1), result%eigenvalues(i), ' i'
        end do
        do i = 1, criticals
            call print_critical(trim(critical_keys(i)), critical(i))
        end do
    end subroutine print_stability

    subroutine print_critical(key, list)
        character(len=*), intent(in) :: key
        type(critical_list), intent(in) :: list
        character(len=19) :: title
        integer :: i

        title = 'critical ' // key(index(key, '%') + 1:)
        if (size(list%found) == 0) write (report, '(2a, 2(es8.1, a))') title, ' none from ', &
            list%range(1), ' to ', list%range(2)
        do i = 1, size(list%found)
            write (report, '(a, es23.15, 2a)') title, list%found(i)%value, ': ', &
                merge('stable above  ', 'unstable above', list%found(i)%stable_above)
            title = ''
        end do
    end subroutine print_critical

    !> BASE_map.csv, a row a place of the grid, and BASE_boundary.csv.
    subroutine write_map(base, map, problem)
        character(len=*), intent(in) :: base
        type(plane_map), intent(in) :: map
        character(len=:), allocatable, intent(out) :: problem
        type(output_file) :: grid, boundary
        character(len=:), allocatable :: keys
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
        call boundary%create(base // '_boundary.csv')
        call boundary%write_line(keys // ',frequency')
        do i = 1, size(map%boundary, 2)
            call boundary%write_line(full_row(map%boundary(:, i)))
        end do
        call boundary%finish()
        problem = ''
        if (grid%failed .or. boundary%failed) problem = 'cannot write ' // base &
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
        integer :: i

        call values%begin(stem, stem // '_map.csv', names)
        call values%set('boundary', stem // '_boundary.csv')
        do i = 1, 2
            associate (axis => map%axes(i))
                call values%set('key_' // place(i), axis%name)
                call values%set('lowest_' // place(i), axis%range(1))
                call values%set('highest_' // place(i), axis%range(2))
                call values%set('half_' // place(i), sqrt(axis%value_at(1) / axis%value_at(0)))
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
