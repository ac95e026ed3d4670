!> Pictures of a chain, drawn by gnuplot: how many events there are of each size, and slip rate in
!> space and time.
module chain_picture
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use picture, only : escaped, finish_picture, quoted
    use text_file, only : output_file
    implicit none
    private

    public :: draw_catalogue, draw_fields

contains

    !> DIRECTORY/STEM_events.png, from the catalogue. `problem` says what went wrong.
    subroutine draw_catalogue(directory, stem, problem)
        character(len=*), intent(in) :: directory, stem
        character(len=:), allocatable, intent(out) :: problem
        type(output_file) :: script

        call begin(script, directory, stem // '_events', stem)
        call script%write_line('# smaller than minus its logarithm: greater than a moment')
        call script%write_line('set table $larger')
        call script%write_line('plot file using (column("ended") > 0 ? ' &
            // '-log10(column("moment")) : NaN):(1) smooth cumulative')
        call script%write_line('unset table')
        call script%write_line('set datafile separator whitespace')
        call script%write_line('set logscale y')
        call script%write_line('set yrange [0.7:*]')
        call script%write_line('set xlabel "log10 of the moment, moment = area x slip [L^3]"')
        call script%write_line('set ylabel "events of that moment or more"')
        call script%write_line('plot $larger using (-$1):2 with points pointtype 7 pointsize 0.7 ' &
            // 'linecolor "#9400d3" notitle')
        call finish_picture(script, directory, stem // '_events', problem)
    end subroutine draw_catalogue

    !> DIRECTORY/STEM_fields.png, from the fields.
    subroutine draw_fields(directory, stem, slip_rate, problem)
        character(len=*), intent(in) :: directory, stem
        real(dp), intent(in) :: slip_rate   !! from which on slip belongs to an event [L/T]
        character(len=:), allocatable, intent(out) :: problem
        type(output_file) :: script
        character(len=40) :: line

        call begin(script, directory, stem // '_fields', stem)
        write (line, '(a, es10.3, a)') 'least = ', 0.01_dp * slip_rate, '   # shown'
        call script%write_line(trim(line))
        call script%write_line('set view map')
        call script%write_line('set xlabel "time [T]"')
        call script%write_line('set ylabel "block"')
        call script%write_line('set cblabel "slip rate [L/T]" offset 1')
        call script%write_line('set rmargin at screen 0.86')
        call script%write_line('set lmargin at screen 0.08')
        call script%write_line('set tmargin at screen 0.93')
        call script%write_line('set bmargin at screen 0.1')
        call script%write_line('set logscale cb')
        call script%write_line('set cbrange [least:*]')
        call script%write_line('set palette defined (0 "white", 4 "#a6bddb", 6 "#0072b2", ' &
            // '8 "#d55e00", 10 "#400000")')
        call script%write_line('set autoscale xfix')
        call script%write_line('set autoscale yfix')
        call script%write_line('above(rate) = rate > least ? rate : least')
        call script%write_line('splot file using "time":"block":(above(column("slip_rate"))) ' &
            // 'with pm3d notitle')
        call finish_picture(script, directory, stem // '_fields', problem)
    end subroutine draw_fields

    !> Starts the script NAME.gp for NAME.csv.
    subroutine begin(script, directory, name, title)
        type(output_file), intent(out) :: script
        character(len=*), intent(in) :: directory, name, title

        call script%create(directory // '/' // name // '.gp')
        call script%write_line('file = ' // quoted(name // '.csv'))
        call script%write_line('set terminal pngcairo size 1200,800 font "Sans,12"')
        call script%write_line('set output ' // quoted(name // '.png'))
        call script%write_line('set datafile separator ","')
        call script%write_line('set title ' // quoted(escaped(title)))
        call script%write_line('set grid')
    end subroutine begin

end module chain_picture
