!> Pictures, drawn by gnuplot. Each has a script of its own (in output/pictures); beside the data
!> the program leaves that script with the names, units and numbers of the case before it, so that
!> it can be changed and run again.
module picture
    use, intrinsic :: iso_fortran_env, only : dp => real64, int64
    use child_process, only : run_command
    use embedded_texts, only : get_text
    use number_text, only : short_text, whole_text
    use platform, only : have_command, remove_file, shell_word
    use printable_text, only : replaced
    use text_file, only : end_of_file, output_file
    use unit_names, only : units
    implicit none
    private

    public :: picture_values

    real(dp), parameter :: time_limit = 60.0_dp   !! of gnuplot [s]

    !> What a script is told: assignments, one a line.
    type :: picture_values
        private
        character(len=:), allocatable :: text
    contains
        procedure :: begin
        procedure, private :: set_text, set_number, set_integer
        generic :: set => set_text, set_number, set_integer
        procedure :: draw
    end type picture_values

contains

    !> For the picture STEM.png of the data in FILE.
    subroutine begin(self, stem, file, names)
        class(picture_values), intent(inout) :: self
        character(len=*), intent(in) :: stem, file
        type(units), intent(in) :: names

        self%text = ''
        call self%set('stem', stem)
        call self%set('file', file)
        call self%set('length_unit', trim(names%length))
        call self%set('force_unit', trim(names%force))
        call self%set('time_unit', trim(names%time))
        call self%set('stress_unit', trim(names%stress()))
    end subroutine begin

    subroutine set_text(self, name, value)
        class(picture_values), intent(inout) :: self
        character(len=*), intent(in) :: name, value

        self%text = self%text // name // " = '" // replaced(value, "'", "''") // "'" &
            // new_line('a')
    end subroutine set_text

    subroutine set_number(self, name, value)
        class(picture_values), intent(inout) :: self
        character(len=*), intent(in) :: name
        real(dp), intent(in) :: value

        self%text = self%text // name // ' = 1.0 * ' // short_text(value) // new_line('a')
    end subroutine set_number

    subroutine set_integer(self, name, value)
        class(picture_values), intent(inout) :: self
        character(len=*), intent(in) :: name
        integer, intent(in) :: value

        self%text = self%text // name // ' = ' // whole_text(value) // new_line('a')
    end subroutine set_integer

    !> Writes DIRECTORY/STEM.gp and draws DIRECTORY/STEM.png and .svg with it. `problem` says what
    !> went wrong: then there is no picture, not half of one either.
    subroutine draw(self, script, directory, stem, problem)
        class(picture_values), intent(in) :: self
        character(len=*), intent(in) :: script   !! name of one in output/pictures
        character(len=*), intent(in) :: directory, stem
        character(len=:), allocatable, intent(out) :: problem
        character(len=128), allocatable :: lines(:)
        character(len=:), allocatable :: tail
        type(output_file) :: file
        integer(int64) :: bytes
        logical :: succeeded, in_time
        integer :: i

        problem = ''
        call get_text(script, lines)
        call file%create(directory // '/' // stem // '.gp')
        call file%write_line('# gnuplot ' // stem // '.gp')
        call file%write_line('reset')   ! the script loads itself again, for the SVG
        call file%write_line(self%text)
        do i = 1, size(lines)
            call file%write_line(trim(lines(i)))
        end do
        call file%finish()
        if (file%failed) then
            problem = 'cannot write ' // directory // '/' // stem // '.gp'
        else if (.not. have_command('gnuplot')) then
            problem = 'no picture is drawn: gnuplot is not installed (Debian: package ' &
                // 'gnuplot-nox); with it, run gnuplot ' // stem // '.gp in ' // directory
        else
            call run_command('cd ' // shell_word(directory) // ' && exec gnuplot ' &
                // shell_word(stem // '.gp') // ' >/dev/null 2>&1', time_limit, succeeded, in_time)
            call end_of_file(directory // '/' // stem // '.svg', 16, tail, bytes)   ! drawn last
            if (.not. in_time) then
                problem = 'gnuplot was stopped on ' // stem // '.gp, after a minute or by a signal'
            else if (.not. succeeded) then
                problem = 'gnuplot failed on ' // stem // '.gp: no picture is drawn'
            else if (index(tail, '</svg>') == 0) then   ! gnuplot takes a full disk for success
                problem = 'gnuplot could not write the whole picture of ' // stem &
                    // '.gp (disk full?)'
            end if
            if (len(problem) > 0) then
                call remove_file(directory // '/' // stem // '.png')
                call remove_file(directory // '/' // stem // '.svg')
            end if
        end if
    end subroutine draw

end module picture
