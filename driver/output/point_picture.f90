!> The picture of a point's path: the hysteresis loop, and friction over slip. Drawn by gnuplot from
!> the CSV file; its script stays beside it.
module point_picture
    use picture, only : escaped, finish_picture, put_line_styles, quoted
    use text_file, only : output_file
    implicit none
    private

    public :: draw_point_picture

contains

    !> Writes DIRECTORY/STEM.gp and draws DIRECTORY/STEM.png with it. `problem` says what went
    !> wrong.
    subroutine draw_point_picture(directory, stem, ndir, problem)
        character(len=*), intent(in) :: directory, stem
        integer, intent(in) :: ndir   !! directions, 2 or 3
        character(len=:), allocatable, intent(out) :: problem
        type(output_file) :: script
        character(len=:), allocatable :: shear   !! |t_t|

        call script%create(directory // '/' // stem // '.gp')
        call put('# Picture of a contact point''s path: gnuplot ' // stem // '.gp')
        call put('file = ' // quoted(stem // '.csv'))
        call put('set terminal pngcairo size 1200,600 font "Sans,12"')
        call put('set output ' // quoted(stem // '.png'))
        call put('set datafile separator ","')
        call put_line_styles(script)
        call put('set multiplot layout 1,2 title ' // quoted(escaped(stem)))
        call put('set grid')
        call put('set xtics font ",9"')
        call put('set key outside top right horizontal')
        call put('set xlabel "relative displacement [L]"')
        call put('set ylabel "tangential traction [F/L^2]"')
        shear = 'abs(column("t_t1"))'
        if (ndir == 2) then
            call put('plot file using "u_t1":"t_t1" with lines ls 1 title "t1"')
        else
            call put('plot file using "u_t1":"t_t1" with lines ls 1 title "t1", \')
            call put('     file using "u_t2":"t_t2" with lines ls 3 title "t2"')
            shear = 'sqrt(column("t_t1")**2 + column("t_t2")**2)'
        end if
        call put('set xlabel "slip [L]"')
        call put('set ylabel "friction coefficient [-]"')
        call put('plot file using "slip":(' // shear // ' / abs(column("t_n"))) \')
        call put('         with lines ls 9 title "|t_t| / |t_n|", \')
        call put('     file using "slip":"mu" with lines ls 2 title "mu"')
        call put('unset multiplot')
        call finish_picture(script, directory, stem, problem)

    contains

        subroutine put(line)
            character(len=*), intent(in) :: line

            call script%write_line(line)
        end subroutine put

    end subroutine draw_point_picture

end module point_picture
