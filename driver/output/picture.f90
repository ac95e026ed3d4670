!> The picture of a run, drawn by gnuplot from the CSV file; its script stays beside it.
module picture
    use platform, only : have_command, run_in_directory, shell_word
    use text_file, only : output_file
    implicit none
    private

    public :: draw_picture, escaped, finish_picture, put_line_styles, quoted

contains

    !> Writes DIRECTORY/STEM.gp and draws DIRECTORY/STEM.png with it. `problem` says what went
    !> wrong.
    subroutine draw_picture(directory, stem, problem)
        character(len=*), intent(in) :: directory, stem
        character(len=:), allocatable, intent(out) :: problem

        type(output_file) :: script

        call script%create(directory // '/' // stem // '.gp')
        call write_script(script, stem)
        call finish_picture(script, directory, stem, problem)
    end subroutine draw_picture

    !> Ends the script DIRECTORY/STEM.gp and draws its picture. `problem` says what went wrong.
    subroutine finish_picture(script, directory, stem, problem)
        type(output_file), intent(inout) :: script
        character(len=*), intent(in) :: directory, stem
        character(len=:), allocatable, intent(out) :: problem

        call script%finish()
        if (script%failed) then
            problem = 'cannot write ' // directory // '/' // stem // '.gp'
        else
            call run_gnuplot(directory, stem, problem)
        end if
    end subroutine finish_picture

    !> Draws DIRECTORY/STEM.png with the script DIRECTORY/STEM.gp. `problem` says what went wrong.
    subroutine run_gnuplot(directory, stem, problem)
        character(len=*), intent(in) :: directory, stem
        character(len=:), allocatable, intent(out) :: problem

        problem = ''
        if (.not. have_command('gnuplot')) then
            problem = 'no picture is drawn: gnuplot is not installed (Debian: package ' &
                // 'gnuplot-nox); with it, run gnuplot ' // stem // '.gp in ' // directory
        else if (.not. run_in_directory(directory, 'gnuplot ' // shell_word(stem // '.gp'))) then
            problem = 'gnuplot failed on ' // stem // '.gp: no picture is drawn'
        end if
    end subroutine run_gnuplot

    !> Lines of force, of friction, of slip, and what they are seen against.
    subroutine put_line_styles(script)
        type(output_file), intent(inout) :: script

        call script%write_line('set style line 1 linewidth 1.5 linecolor "#9400d3"')
        call script%write_line('set style line 2 linewidth 1.5 linecolor "#0072b2"')
        call script%write_line('set style line 3 linewidth 1.5 linecolor "#d55e00"')
        call script%write_line('set style line 9 linewidth 1 linecolor "gray60"')
    end subroutine put_line_styles

    subroutine write_script(script, stem)
        type(output_file), intent(inout) :: script
        character(len=*), intent(in) :: stem

        call put('# Picture of a stickslip run: gnuplot ' // stem // '.gp')
        call put('file = ' // quoted(stem // '.csv'))
        call put('set terminal pngcairo size 1200,1000 font "Sans,12"')
        call put('set output ' // quoted(stem // '.png'))
        call put('set datafile separator ","')
        call put_line_styles(script)
        call put('set multiplot layout 3,1 title ' // quoted(escaped(stem)))
        call put('set grid')
        call put('set lmargin 12')
        call put('set rmargin 4')
        call put('set key outside top right horizontal')
        call put('set ylabel "force [F]"')
        call put('plot file using "time":"friction_force" with lines ls 9 title "friction", \')
        call put('     file using "time":"spring_force" with lines ls 1 title "spring"')
        call put('set ylabel "friction coefficient [-]"')
        call put('plot file using "time":"mu" with lines ls 2 title "mu"')
        call put('set ylabel "displacement [L]"')
        call put('set xlabel "time [T]"')
        call put('plot file using "time":"drive" with lines ls 9 title "drive", \')
        call put('     file using "time":"slip" with lines ls 3 title "slip"')
        call put('unset multiplot')

    contains

        subroutine put(line)
            character(len=*), intent(in) :: line

            call script%write_line(line)
        end subroutine put

    end subroutine write_script

    !> A text between gnuplot's single quotes.
    pure function quoted(text) result(inner)
        character(len=*), intent(in) :: text
        character(len=:), allocatable :: inner
        integer :: i

        inner = "'"
        do i = 1, len(text)
            inner = inner // text(i:i)
            if (text(i:i) == "'") inner = inner // "'"
        end do
        inner = inner // "'"
    end function quoted

    !> A text whose signs gnuplot would take for markup are shown as they are.
    pure function escaped(text) result(plain)
        character(len=*), intent(in) :: text
        character(len=:), allocatable :: plain
        integer :: i

        plain = ''
        do i = 1, len(text)
            if (index('_^@{}~&\', text(i:i)) > 0) plain = plain // '\'
            plain = plain // text(i:i)
        end do
    end function escaped

end module picture
