# The events of a chain's blocks: how many have a magnitude or more, and the b-value.
set datafile separator ","
# magnitude as in seismology, without the constant that depends on units: two thirds of log10 of the moment
magnitude(ended, moment) = ended > 0 && moment > 0 ? log10(moment)/1.5 : NaN
# smaller than minus its magnitude: greater than a magnitude
set table $larger
plot file using (-magnitude(column("ended"), column("moment"))):(1) smooth cumulative
unset table
# The catalogue is taken to be complete from the bin on that has most events (bins of 0.1); above it, by maximum
# likelihood (Aki 1965), b = log10(e)/(mean magnitude - least magnitude), with the standard error b/sqrt(number).
bin = 0.1
set table $bins
plot file using (bin*floor(magnitude(column("ended"), column("moment"))/bin)):(1) smooth frequency
unset table
set datafile separator whitespace
stats $bins using 1:2 nooutput
least = STATS_pos_max_y
# the table has one line a magnitude: events of the same magnitude are in the steps of the second column
before = 0.0
sum = 0.0
stats $larger using (-$1 >= least ? (sum = sum + (-$1)*($2 - before), before = $2, -$1) : NaN) nooutput
mean = before > 0 ? sum/before : NaN
set grid
set logscale y
set yrange [0.7:*]
set xlabel "magnitude, 2/3 log_{10} of the moment; moment = area x slip [".length_unit."^3]"
set ylabel "events of that magnitude or more"
if (!exists("ending")) { ending = "png" }
set terminal pngcairo size 1200,800 font "Sans,12"
if (ending eq "svg") { set terminal svg size 1200,800 font "Sans,12" background "white" }
set output stem.".".ending
set title stem noenhanced
if (before >= 10 && mean > least) {
    b = log10(exp(1))/(mean - least)
    told = sprintf("b = %.2f +- %.2f, from %d events of magnitude %.1f or more", b, b/sqrt(before), before, least)
    set key top right
    plot $larger using (-$1):2 with points pointtype 7 pointsize 0.7 linecolor "#9400d3" notitle, \
        [least:*] before*10**(-b*(x - least)) with lines linewidth 2 linecolor "#404040" title told
} else {
    plot $larger using (-$1):2 with points pointtype 7 pointsize 0.7 linecolor "#9400d3" notitle
}
set output
if (ending eq "png") { ending = "svg"; load stem.".gp" }
