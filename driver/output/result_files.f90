!> The names of the files that a verb writes: STEM and what comes behind it.
module result_files
    use namelist_input, only : namelist_file
    use number_text, only : whole_text
    use platform, only : make_directory, plain_path, remove_file
    implicit none
    private

    public :: prepare_output, remove_results

    integer, parameter, public :: of_run = 1         !! results of the verbs run, point and fault
    integer, parameter, public :: of_sweep = 2, of_stability = 3

    !> Tables that may have a picture, by the verb that leaves them, and such that have none.
    character(len=*), parameter :: drawn(6) = [character(len=10) :: '', '_events', '_blocks', &
        '_fields', '_sweep', '_stability']
    integer, parameter :: drawn_by(6) = [of_run, of_run, of_run, of_run, of_sweep, of_stability]
    character(len=*), parameter :: listed(7) = [character(len=19) :: '_pieces', '_picture', &
        '_global', '_contours', '_stability_map', '_stability_boundary', '_eigenvalues']
    integer, parameter :: listed_by(7) = [of_run, of_run, of_run, of_run, of_stability, &
        of_stability, of_stability]
    character(len=*), parameter :: kinds(4) = [character(len=4) :: '.csv', '.gp', '.png', '.svg']
    character(len=*), parameter :: others(4) = [character(len=12) :: '.checkpoint', '_fields.h5', &
        '_fields.xdmf', '_fields.dat']
    !> Files of these begin so, and go on with numbers or other words.
    character(len=*), parameter :: beginnings(5) = [character(len=12) :: '_fields', '_station_', &
        '_sweep', '_stability', '_eigenvalues']

contains

    !> Makes the directory of the output. `problem` is empty, or says why results cannot go there.
    subroutine prepare_output(file, directory, stem, problem)
        type(namelist_file), intent(in) :: file
        character(len=*), intent(in) :: directory, stem
        character(len=:), allocatable, intent(out) :: problem
        integer :: i

        problem = ''
        if (.not. make_directory(directory)) then
            problem = "stickslip: cannot write to the directory '" // directory // "'"
            return
        end if
        do i = 1, size(file%files)
            associate (input => file%files(i)%text)
                ! also where the file is a link, or a link leads to it
                if (.not. (is_result(input, directory, stem) &
                    .or. is_result(plain_path(input), directory, stem))) cycle
                problem = 'stickslip: ' // file%name // ': the results would overwrite the ' &
                    // "input '" // input // "': choose another --output"
                return
            end associate
        end do
    end subroutine prepare_output

    logical function is_result(path, directory, stem) result(yes)
        character(len=*), intent(in) :: path, directory, stem
        integer :: slash, i, k

        slash = index(path, '/', back=.true.)
        yes = index(path(slash + 1:), stem) == 1
        if (.not. yes) return
        associate (ending => path(slash + 1 + len(stem):))
            yes = any([(any(ending == [(trim(drawn(i)) // kinds(k), k = 1, size(kinds))]), i = 1, &
                size(drawn))]) .or. any([(ending == trim(listed(i)) // kinds(1), i = 1, &
                size(listed))]) .or. any(ending == others) &
                .or. any([(index(ending, trim(beginnings(i))) == 1, i = 1, size(beginnings))])
        end associate
        if (.not. yes) return
        if (slash == 0) yes = plain_path('.') == plain_path(directory)
        if (slash > 0) yes = plain_path(path(:slash)) == plain_path(directory)
    end function is_result

    !> Removes what an earlier run of the same name has left, and the checkpoint with it, so that
    !> nothing old stands beside the results of a new one. It leaves the journals of a sweep, links,
    !> and tables and pictures of an input that has the name of one of them for its own.
    subroutine remove_results(output, verb)
        character(len=*), intent(in) :: output   !! directory and stem
        integer, intent(in) :: verb   !! of_run, of_sweep or of_stability
        character(len=:), allocatable :: base
        integer :: i, k

        i = index(output, '/', back=.true.)
        base = plain_path(output(:i)) // output(i:)
        do i = 1, size(drawn)
            if (drawn_by(i) /= verb .or. is_name_of_input(base, trim(drawn(i)), .true.)) cycle
            do k = 1, size(kinds)
                call remove_own(base // trim(drawn(i)) // trim(kinds(k)))
            end do
        end do
        do i = 1, size(listed)
            if (listed_by(i) /= verb .or. is_name_of_input(base, trim(listed(i)), .false.)) cycle
            call remove_own(base // trim(listed(i)) // kinds(1))
        end do
        if (verb /= of_run) return
        do i = 1, size(others)
            call remove_own(base // trim(others(i)))
        end do
        call remove_numbered(base // '_station_', kinds(1), 0)
        call remove_numbered(base // '_fields_', '.h5', 6)
        call remove_numbered(base // '_fields_', '.bin', 6)
    end subroutine remove_results

    !> Does another input have this name? A run of its own leaves events beside its table, or a
    !> picture, and its table is one over time.
    logical function is_name_of_input(base, ending, has_picture) result(yes)
        character(len=*), intent(in) :: base     !! directory and stem
        character(len=*), intent(in) :: ending   !! of tables
        logical, intent(in) :: has_picture       !! have ours one?
        character(len=5) :: first
        integer :: unit, status

        yes = .false.
        if (len(ending) == 0) return
        inquire (file=base // ending // '_events.csv', exist=yes)
        if (.not. (yes .or. has_picture)) inquire (file=base // ending // '.gp', exist=yes)
        if (yes .or. .not. has_picture) return
        open (newunit=unit, file=base // ending // '.csv', action='read', status='old', &
            iostat=status)
        if (status /= 0) return
        first = ''
        read (unit, '(a)', iostat=status) first
        yes = status == 0 .and. first == 'time,'
        close (unit)
    end function is_name_of_input

    !> BASE1.csv, BASE2.csv and so on, up to the first that is missing.
    subroutine remove_numbered(base, kind, digits)
        character(len=*), intent(in) :: base, kind
        integer, intent(in) :: digits   !! of the number at least
        character(len=:), allocatable :: number
        logical :: there
        integer :: i

        i = 0
        there = .true.
        do while (there)
            i = i + 1
            number = whole_text(i)
            number = repeat('0', max(0, digits - len(number))) // number
            inquire (file=base // number // kind, exist=there)
            if (there) call remove_own(base // number // kind)
        end do
    end subroutine remove_numbered

    !> Removes a file, if there is one and it is no link.
    subroutine remove_own(path)
        character(len=*), intent(in) :: path   !! its directory from the root on, without links

        if (plain_path(path) == path) call remove_file(path)
    end subroutine remove_own

end module result_files
