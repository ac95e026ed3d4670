# A sweep over one key: period and stress drop. Combinations that have none show at the bottom.
set datafile separator ","
set datafile columnheaders
regime(name) = stringcolumn("regime") eq name
set grid
set lmargin 15
set rmargin 5
set offsets graph 0.03, graph 0.03, 0, 0
set autoscale xfix
# keys over decades; of a few decades, with labels at 2 and 5 in between
if (over_decades) {
    set logscale x
    set format x "10^{%T}"
    if (highest < 1e4 * lowest) {
        set format x "%g"
        set for [k = floor(log10(lowest)):ceil(log10(highest))] xtics add \
            (sprintf("%g", 2 * 10.0**k) 2 * 10.0**k, sprintf("%g", 5 * 10.0**k) 5 * 10.0**k)
    }
}
# over decades the vertical axes are logarithmic, too
bottom_1 = 0
bottom_2 = 0
if (found > 0) {
    stats file using "period" nooutput
    if (STATS_max > 20 * STATS_min) { bottom_1 = STATS_min / 2 }
    stats file using "stress_drop" nooutput
    if (STATS_max > 20 * STATS_min) { bottom_2 = STATS_min / 2 }
}
if (!exists("ending")) { ending = "png" }
set terminal pngcairo size 1000,900 font "Sans,12"
if (ending eq "svg") { set terminal svg size 1000,900 font "Sans,12" background "white" }
set output stem.".".ending
set multiplot layout 2,1 title stem noenhanced
unset xlabel
unset logscale y
set yrange [*<0:*]
if (bottom_1 > 0) { set logscale y; set yrange [bottom_1 / 2:*] }
set ylabel "mean period [".time_unit."]"
plot file using 1:"period" smooth unique with linespoints pointtype 7 linewidth 1.5 \
         linecolor "#0072b2" notitle, \
     file using 1:(regime("steady") ? bottom_1 : NaN) with points pointtype 6 \
         pointsize 1.5 linecolor "gray40" title "steady", \
     file using 1:(regime("") ? bottom_1 : NaN) with points pointtype 2 pointsize 1.5 \
         linecolor "gray40" title "failed"
unset logscale y
set yrange [*<0:*]
if (bottom_2 > 0) { set logscale y; set yrange [bottom_2 / 2:*] }
set xlabel key_1 noenhanced
set ylabel "mean stress drop [".stress_unit."]"
plot file using 1:"stress_drop" smooth unique with linespoints pointtype 7 linewidth 1.5 \
         linecolor "#d55e00" notitle, \
     file using 1:(regime("steady") ? bottom_2 : NaN) with points pointtype 6 \
         pointsize 1.5 linecolor "gray40" title "steady", \
     file using 1:(regime("") ? bottom_2 : NaN) with points pointtype 2 pointsize 1.5 \
         linecolor "gray40" title "failed"
unset multiplot
set output
if (ending eq "png") { ending = "svg"; load stem.".gp" }
