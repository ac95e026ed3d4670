# The events of a chain's blocks: how many have a moment or more.
set datafile separator ","
# smaller than minus its logarithm: greater than a moment
set table $larger
plot file using (column("ended") > 0 ? -log10(column("moment")) : NaN):(1) smooth cumulative
unset table
set datafile separator whitespace
set grid
set logscale y
set yrange [0.7:*]
set xlabel "log10 of the moment, moment = area x slip [".length_unit."^3]"
set ylabel "events of that moment or more"
if (!exists("ending")) { ending = "png" }
set terminal pngcairo size 1200,800 font "Sans,12"
if (ending eq "svg") { set terminal svg size 1200,800 font "Sans,12" background "white" }
set output stem.".".ending
set title stem noenhanced
plot $larger using (-$1):2 with points pointtype 7 pointsize 0.7 linecolor "#9400d3" notitle
set output
if (ending eq "png") { ending = "svg"; load stem.".gp" }
