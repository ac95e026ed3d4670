# Slip rate of a chain's blocks in space and time, the largest of each cell.
set datafile separator whitespace
set view map
# a cell has the value with which it begins
set pm3d corners2color c1
set xlabel "time [".time_unit."]"
set ylabel "block"
set cblabel "slip rate [".length_unit."/".time_unit."]" offset 2
set rmargin at screen 0.85
set lmargin at screen 0.09
set tmargin at screen 0.93
set bmargin at screen 0.1
set autoscale xfix
set autoscale yfix
set tics out nomirror
set logscale cb
set format cb "10^{%T}"
set cbrange [least:*]
set palette defined (0 "white", 4 "#a6bddb", 6 "#0072b2", 8 "#d55e00", 10 "#400000")
above(rate) = rate > least ? rate : least
if (!exists("ending")) { ending = "png" }
set terminal pngcairo size 1200,800 font "Sans,12"
if (ending eq "svg") { set terminal svg size 1200,800 font "Sans,12" background "white" }
set output stem.".".ending
set title stem noenhanced
splot file using 1:2:(above($3)) with pm3d notitle
set output
if (ending eq "png") { ending = "svg"; load stem.".gp" }
