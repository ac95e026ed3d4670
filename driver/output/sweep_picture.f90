!> The picture of a sweep, drawn by gnuplot from the table: curves over one key, maps over two.
module sweep_picture
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use picture, only : escaped, finish_picture, quoted
    use sweep_settings, only : sweep_axis
    use sweep_table, only : number_text
    use text_file, only : output_file
    implicit none
    private

    public :: draw_sweep

contains

    !> Writes DIRECTORY/STEM.gp and draws DIRECTORY/STEM.png with it. `problem` says what went
    !> wrong.
    subroutine draw_sweep(directory, stem, axes, problem)
        character(len=*), intent(in) :: directory, stem
        type(sweep_axis), intent(in) :: axes(:)   !! one or two
        character(len=:), allocatable, intent(out) :: problem
        type(output_file) :: script

        call script%create(directory // '/' // stem // '.gp')
        call script%write_line('# Picture of a stickslip sweep: gnuplot ' // stem // '.gp')
        call script%write_line('file = ' // quoted(stem // '.csv'))
        call script%write_line('set datafile separator ","')
        call script%write_line('set datafile columnheaders')
        call script%write_line('regime(name) = stringcolumn("regime") eq name')
        if (size(axes) == 1) then
            call put_curves(script, stem, axes(1))
        else
            call put_maps(script, stem, axes)
        end if
        call finish_picture(script, directory, stem, problem)
    end subroutine draw_sweep

    !> Period and stress drop against the values. A combination that has none shows at zero.
    subroutine put_curves(script, stem, axis)
        type(output_file), intent(inout) :: script
        character(len=*), intent(in) :: stem
        type(sweep_axis), intent(in) :: axis

        call script%write_line('set terminal pngcairo size 1000,900 font "Sans,12"')
        call script%write_line('set output ' // quoted(stem // '.png'))
        call script%write_line('set multiplot layout 2,1 title ' // quoted(escaped(stem)))
        call script%write_line('set grid')
        call script%write_line('set lmargin 12')
        call script%write_line('set rmargin 4')
        call script%write_line('set autoscale xfix')
        call script%write_line('set offsets graph 0.03, graph 0.03, graph 0.05, graph 0.05')
        if (spread_over_decades(axis%values)) then
            call script%write_line('set logscale x')
            call script%write_line(log_tics(axis%values))
        end if
        call script%write_line('set yrange [0:*]')
        call script%write_line('set ylabel "mean period [T]"')
        call script%write_line('plot file using 1:"period" smooth unique with linespoints ' &
            // 'pointtype 7 linewidth 1.5 linecolor "#0072b2" notitle, \')
        call put_the_rest()
        call script%write_line('set ylabel "mean stress drop [F/L^2]"')
        call script%write_line('set xlabel ' // quoted(escaped(axis%name)))
        call script%write_line('plot file using 1:"stress_drop" smooth unique with linespoints ' &
            // 'pointtype 7 linewidth 1.5 linecolor "#d55e00" notitle, \')
        call put_the_rest()
        call script%write_line('unset multiplot')

    contains

        subroutine put_the_rest()
            call script%write_line('     file using 1:(regime("steady") ? 0 : NaN) with points ' &
                // 'pointtype 6 pointsize 1.5 linecolor "gray40" title "steady", \')
            call script%write_line('     file using 1:(regime("") ? 0 : NaN) with points ' &
                // 'pointtype 2 pointsize 1.5 linecolor "gray40" title "failed"')
        end subroutine put_the_rest

    end subroutine put_curves

    !> Regime, period and stress drop in cells, the first key to the right, the second one up. Cells
    !> without period and drop stay white.
    subroutine put_maps(script, stem, axes)
        type(output_file), intent(inout) :: script
        character(len=*), intent(in) :: stem
        type(sweep_axis), intent(in) :: axes(2)
        character(len=*), parameter :: cell = ' ? right(0) : NaN):(up(0)):(0.5):(0.5)'
        character(len=*), &
            parameter :: filled = ' with boxxyerror fillstyle solid noborder linecolor '
        character(len=12) :: rows

        write (rows, '(i0)') size(axes(2)%values)
        call script%write_line('set terminal pngcairo size 1600,600 font "Sans,12"')
        call script%write_line('set output ' // quoted(stem // '.png'))
        call script%write_line('set multiplot layout 1,3 title ' // quoted(escaped(stem)))
        call script%write_line('# a cell a row of the table; the second key changes fastest')
        call script%write_line('right(i) = int(column(i)) / ' // trim(rows))
        call script%write_line('up(i) = int(column(i)) % ' // trim(rows))
        call script%write_line('set xtics out nomirror rotate (' // tics(axes(1)%values) // ')')
        call script%write_line('set ytics out nomirror (' // tics(axes(2)%values) // ')')
        call script%write_line('set xrange [-0.5:' // number_text(size(axes(1)%values) - 0.5_dp) &
            // ']')
        call script%write_line('set yrange [-0.5:' // number_text(size(axes(2)%values) - 0.5_dp) &
            // ']')
        call script%write_line('set xlabel ' // quoted(escaped(axes(1)%name)))
        call script%write_line('set ylabel ' // quoted(escaped(axes(2)%name)))
        call script%write_line('set bmargin 8')
        call script%write_line('set tmargin 4')
        call script%write_line('set key below')
        call script%write_line('set title "regime"')
        call script%write_line('plot file using (regime("stick-slip")' // cell // filled &
            // '"#d55e00" title "stick-slip", \')
        call script%write_line('     file using (regime("steady")' // cell // filled &
            // '"#56b4e9" title "steady", \')
        call script%write_line('     file using (regime("")' // cell // filled &
            // '"gray60" title "failed"')
        call script%write_line('set key off')
        call script%write_line('set palette defined (0 "#fde725", 1 "#21918c", 2 "#440154")')
        call script%write_line('set title "mean period [T]"')
        call script%write_line('plot file using (regime("stick-slip")' // cell &
            // ':"period"' // filled // 'palette')
        call script%write_line('set title "mean stress drop [F/L^2]"')
        call script%write_line('plot file using (regime("stick-slip")' // cell &
            // ':"stress_drop"' // filled // 'palette')
        call script%write_line('unset multiplot')
    end subroutine put_maps

    !> Labels of the places of the values; of many values every so many, so that they can be read.
    pure function tics(values) result(text)
        real(dp), intent(in) :: values(:)
        character(len=:), allocatable :: text
        integer, parameter :: most = 16
        character(len=12) :: place
        integer :: i

        text = ''
        do i = 1, size(values), 1 + (size(values) - 1) / most
            write (place, '(i0)') i - 1
            if (i > 1) text = text // ', '
            text = text // '"' // number_text(values(i)) // '" ' // trim(place)
        end do
    end function tics

    !> Labels at 1, 2 and 5 of a few decades; of many, those that gnuplot chooses.
    pure function log_tics(values) result(text)
        real(dp), intent(in) :: values(:)   !! > 0
        character(len=:), allocatable :: text
        integer, parameter :: most_decades = 4
        character(len=12) :: power
        integer :: lowest, highest, k

        text = 'set xtics autofreq'
        lowest = floor(log10(minval(values)))
        highest = floor(log10(maxval(values)))
        if (highest - lowest >= most_decades) return
        text = 'set xtics ('
        do k = lowest, highest
            write (power, '(a, i0)') 'e', k
            if (k > lowest) text = text // ', '
            text = text // '1' // trim(power) // ', 2' // trim(power) // ', 5' // trim(power)
        end do
        text = text // ')'
    end function log_tics

    pure function spread_over_decades(values) result(wide)
        real(dp), intent(in) :: values(:)
        logical :: wide

        wide = minval(values) > 0.0_dp
        if (wide) wide = maxval(values) >= 10.0_dp * minval(values)
    end function spread_over_decades

end module sweep_picture
