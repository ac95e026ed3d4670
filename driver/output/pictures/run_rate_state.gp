# A run with rate-and-state friction: as any run, with slip rate and state on logarithmic axes, and
# friction against slip rate.
set datafile separator ","
set style line 1 linewidth 1.5 linecolor "#9400d3"
set style line 2 linewidth 1.5 linecolor "#0072b2"
set style line 3 linewidth 1.5 linecolor "#d55e00"
set style line 9 linewidth 1.0 linecolor "gray60"
set grid
set lmargin 15
set rmargin 5
set key outside top right horizontal
set autoscale xfix
pressing(n) = n > 0 ? n : NaN
positive(x) = x > 0 ? x : NaN
noticed(x) = x > slowest ? x : NaN
# the mean slip rate since the row before; of thinned rows the block's velocity
rate(t, s, v) = (r = thinned ? abs(v) : column(0) > 0 ? (s - last_s) / (t - last_t) : NaN, \
    last_t = t, last_s = s, noticed(r))
slips = 0
stats file using (slips = slips || rate(column("time"), column("slip"), column("velocity")) > 0, \
    column("time")) nooutput
if (!exists("ending")) { ending = "png" }
set terminal pngcairo size 1700,1100 font "Sans,12"
if (ending eq "svg") { set terminal svg size 1700,1100 font "Sans,12" background "white" }
set output stem.".".ending
set multiplot layout 3,2 title stem noenhanced
unset logscale
unset xlabel
set ylabel "force [".force_unit."]"
plot file using "time":"friction_force" with lines ls 9 title "friction", \
     file using "time":"spring_force" with lines ls 1 title "spring"
set ylabel "slip rate [".length_unit."/".time_unit."]"
if (slips) {
    set logscale y
    set format y "10^{%T}"
    plot file using "time":(rate(column("time"), column("slip"), column("velocity"))) \
             with lines ls 3 title "slip rate"
} else {
    plot file using "time":(0) with lines ls 3 title "slip rate: too small to show"
}
unset logscale
set format y "% h"
set ylabel "friction / normal force [-]"
plot file using "time":(column("friction_force") / (area * pressing(column("normal_traction")))) \
         with lines ls 9 title "friction force / normal force", \
     file using "time":"mu" with lines ls 2 title "mu"
set ylabel internal." [".time_unit."]"
set logscale y
set format y "10^{%T}"
plot file using "time":(positive(column(internal))) with lines ls 1 title "state"
unset logscale
set format y "% h"
set ylabel "displacement [".length_unit."]"
set xlabel "time [".time_unit."]"
plot file using "time":"drive" with lines ls 9 title "drive", \
     file using "time":"displacement" with lines ls 3 title "block"
set ylabel "mu [-]"
set xlabel "slip rate [".length_unit."/".time_unit."]"
set logscale x
set format x "10^{%T}"
if (slips) {
    plot file using (rate(column("time"), column("slip"), column("velocity"))):"mu" \
             with lines ls 2 title "mu at this slip rate"
}
set format x "% h"
unset multiplot
set output
if (ending eq "png") { ending = "svg"; load stem.".gp" }
