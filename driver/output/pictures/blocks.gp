# What differs from block to block of a chain, a panel each.
set datafile separator ","
stats file using 1 every ::1 nooutput
set xrange [0.5:STATS_max + 0.5]
if (STATS_max <= 20) { set xtics 1 }
set offsets 0, 0, graph 0.05, graph 0.05
set grid
set xlabel "block"
set lmargin 14
if (!exists("ending")) { ending = "png" }
height = 120 + 260*panels
set terminal pngcairo size 1200,height font "Sans,12"
if (ending eq "svg") { set terminal svg size 1200,height font "Sans,12" background "white" }
set output stem.".".ending
set multiplot layout panels,1 title stem noenhanced
do for [i=1:panels] {
    set ylabel value(sprintf("label_%d", i)) noenhanced
    plot file using 1:(column(i + 1)) every step::1 with points pointtype 7 pointsize (STATS_max <= 100 ? 1 : 0.5) \
             linecolor "#0072b2" notitle
}
unset multiplot
set output
if (ending eq "png") { ending = "svg"; load stem.".gp" }
