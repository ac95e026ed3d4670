# What differs from block to block of a chain, a panel each.
set datafile separator ","
set grid
set xlabel "block"
set autoscale xfix
set lmargin 14
if (!exists("ending")) { ending = "png" }
height = 120 + 260*panels
set terminal pngcairo size 1200,height font "Sans,12"
if (ending eq "svg") { set terminal svg size 1200,height font "Sans,12" background "white" }
set output stem.".".ending
set multiplot layout panels,1 title stem noenhanced
do for [i=1:panels] {
    set ylabel value(sprintf("label_%d", i)) noenhanced
    plot file using 1:(column(i + 1)) every step::1 with points pointtype 7 pointsize 0.5 linecolor "#0072b2" notitle
}
unset multiplot
set output
if (ending eq "png") { ending = "svg"; load stem.".gp" }
