# A sweep over two keys: regime, period and stress drop in cells, the first key to the right, the
# second one up. Cells without period and drop stay white.
set datafile separator ","
set datafile columnheaders
# before the ranges, beyond which stats sees nothing
log_1 = 0
log_2 = 0
if (found > 0) {
    stats file using "period" nooutput
    log_1 = STATS_max > 20 * STATS_min
    stats file using "stress_drop" nooutput
    log_2 = STATS_max > 20 * STATS_min
}
regime(name) = stringcolumn("regime") eq name
# a cell a row of the table; the second key changes fastest
right(i) = int(column(i)) / up_cells
up(i) = int(column(i)) % up_cells
set xrange [-0.5:right_cells - 0.5]
set yrange [-0.5:up_cells - 0.5]
eval "set xtics out nomirror rotate (".tics_1.")"
eval "set ytics out nomirror (".tics_2.")"
set bmargin 14   # labels, the name of the axis, and four lines of the key
set tmargin 4
set lmargin 16
set rmargin 14
set palette defined (0 "#fde725", 1 "#21918c", 2 "#440154")
if (!exists("ending")) { ending = "png" }
set terminal pngcairo size 1800,720 font "Sans,12"
if (ending eq "svg") { set terminal svg size 1800,720 font "Sans,12" background "white" }
set output stem.".".ending
set multiplot layout 1,3 title stem noenhanced
set xlabel key_1 noenhanced
set ylabel key_2 noenhanced
set key below
set title "regime"
plot file using (regime("stick-slip") ? right(0) : NaN):(up(0)):(0.5):(0.5) \
         with boxxyerror fillstyle solid noborder linecolor "#d55e00" title "stick-slip", \
     file using (regime("steady") ? right(0) : NaN):(up(0)):(0.5):(0.5) \
         with boxxyerror fillstyle solid noborder linecolor "#56b4e9" title "steady", \
     file using (regime("") ? right(0) : NaN):(up(0)):(0.5):(0.5) \
         with boxxyerror fillstyle solid noborder linecolor "gray60" title "failed", \
     file using (stringcolumn("stability") eq "unstable" ? right(0) : NaN):(up(0)) \
         with points pointtype 7 pointsize 0.5 linecolor "black" title "unstable steady sliding"
set key off
unset logscale cb
if (log_1) { set logscale cb }
set title "mean period [".time_unit."]"
plot file using (regime("stick-slip") ? right(0) : NaN):(up(0)):(0.5):(0.5):"period" \
         with boxxyerror fillstyle solid noborder linecolor palette
unset logscale cb
if (log_2) { set logscale cb }
set title "mean stress drop [".stress_unit."]"
plot file using (regime("stick-slip") ? right(0) : NaN):(up(0)):(0.5):(0.5):"stress_drop" \
         with boxxyerror fillstyle solid noborder linecolor palette
unset multiplot
set output
if (ending eq "png") { ending = "svg"; load stem.".gp" }
