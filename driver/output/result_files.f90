!> The names of the files that a verb writes: STEM and what comes behind it.
module result_files
    use namelist_input, only : namelist_file
    use platform, only : make_directory, plain_path
    implicit none
    private

    public :: prepare_output

    character(len=16), parameter :: endings(17) = [character(len=16) :: '.csv', '.gp', '.png', &
        '.svg', '.checkpoint', '_events.csv', '_events.gp', '_events.png', '_events.svg', &
        '_blocks.csv', '_blocks.gp', '_blocks.png', '_blocks.svg', '_pieces.csv', &
        '_picture.csv', '_global.csv', '_contours.csv']
    character(len=12), parameter :: beginnings(5) = [character(len=12) :: '_fields', '_station_', &
        '_sweep', '_stability', '_eigenvalues']

contains

    !> Makes the directory of the output. `problem` is empty, or says why results cannot go there.
    subroutine prepare_output(file, directory, stem, problem)
        type(namelist_file), intent(in) :: file
        character(len=*), intent(in) :: directory, stem
        character(len=:), allocatable, intent(out) :: problem
        character(len=:), allocatable :: input

        problem = ''
        if (.not. make_directory(directory)) then
            problem = "stickslip: cannot write to the directory '" // directory // "'"
        else
            input = overwritten_input(file, directory, stem)
            if (len(input) > 0) problem = 'stickslip: ' // file%name // ': the results would ' &
                // "overwrite the input '" // input // "': choose another --output"
        end if
    end subroutine prepare_output

    !> An input that the results of STEM in a directory would overwrite; empty if there is none.
    function overwritten_input(file, directory, stem) result(path)
        type(namelist_file), intent(in) :: file   !! with the names of all files that it reads
        character(len=*), intent(in) :: directory, stem
        character(len=:), allocatable :: path
        integer :: i

        path = ''
        do i = 1, size(file%files)
            associate (input => file%files(i)%text)
                ! also where the file is a link, or a link leads to it
                if (.not. (is_result(input, directory, stem) &
                    .or. is_result(plain_path(input), directory, stem))) cycle
                path = input
                return
            end associate
        end do
    end function overwritten_input

    function is_result(path, directory, stem) result(yes)
        character(len=*), intent(in) :: path, directory, stem
        logical :: yes
        integer :: slash, i

        slash = index(path, '/', back=.true.)
        yes = index(path(slash + 1:), stem) == 1
        if (.not. yes) return
        associate (ending => path(slash + 1 + len(stem):))
            yes = any(ending == endings) .or. any([(index(ending, trim(beginnings(i))) == 1, &
                i = 1, size(beginnings))])
        end associate
        if (.not. yes) return
        if (slash == 0) yes = plain_path('.') == plain_path(directory)
        if (slash > 0) yes = plain_path(path(:slash)) == plain_path(directory)
    end function is_result

end module result_files
