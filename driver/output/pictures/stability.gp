# Where steady sliding is stable, over two keys on logarithmic axes: blue where small disturbances
# die away; elsewhere the colour is the frequency at which they grow, grey where they do not swing.
set datafile separator ","
set datafile columnheaders
is(name) = stringcolumn("stability") eq name
# before the ranges, beyond which stats sees nothing
if (swings) { stats file using (is("unstable") && column("frequency") > 0 ? column("frequency") : NaN) nooutput }
set logscale xy
set xrange [lowest_1 / half_1:highest_1 * half_1]
set yrange [lowest_2 / half_2:highest_2 * half_2]
# over few decades with labels at 2 and 5 in between, over less than one at all digits
digits(ratio) = ratio < 10 ? "2 3 4 5 6 7 8 9" : "2 5"
set format xy "10^{%T}"
if (highest_1 < 1e3 * lowest_1) {
    set format x "%g"
    set for [k = floor(log10(lowest_1)):ceil(log10(highest_1))] for [m in digits(highest_1 / lowest_1)] \
        xtics add (sprintf("%g", m * 10.0**k) m * 10.0**k)
}
if (highest_2 < 1e3 * lowest_2) {
    set format y "%g"
    set for [k = floor(log10(lowest_2)):ceil(log10(highest_2))] for [m in digits(highest_2 / lowest_2)] \
        ytics add (sprintf("%g", m * 10.0**k) m * 10.0**k)
}
set xlabel key_1 noenhanced
set ylabel key_2 noenhanced
set key outside below
set bmargin 9
set tics out nomirror
set palette defined (0 "#fde0a0", 1 "#d55e00", 2 "#5a1a00")
set cblabel "frequency of the growing disturbance [1/".time_unit."]" offset 2
if (swings) {
    set logscale cb
    if (STATS_max < 1e2 * STATS_min) {
        set for [k = floor(log10(STATS_min)):ceil(log10(STATS_max))] \
            for [m in digits(STATS_max / STATS_min)] \
            cbtics add (sprintf("%g", m * 10.0**k) m * 10.0**k)
    }
} else { unset colorbox }
if (!exists("ending")) { ending = "png" }
set terminal pngcairo size 900,760 font "Sans,12"
if (ending eq "svg") { set terminal svg size 900,760 font "Sans,12" background "white" }
set output stem.".".ending
set title stem noenhanced
x1(i) = column(i) / half_1
x2(i) = column(i) * half_1
y1(i) = column(i) / half_2
y2(i) = column(i) * half_2
plot file using (is("stable") ? column(1) : NaN):2:(x1(1)):(x2(1)):(y1(2)):(y2(2)) \
         with boxxyerror fillstyle solid noborder linecolor "#cfe6f5" title "stable", \
     file using (is("neutral") ? column(1) : NaN):2:(x1(1)):(x2(1)):(y1(2)):(y2(2)) \
         with boxxyerror fillstyle solid noborder linecolor "#e8f3d6" title "neutral", \
     file using (is("unstable") && column("frequency") <= 0 ? column(1) : NaN):2 \
         :(x1(1)):(x2(1)):(y1(2)):(y2(2)) with boxxyerror fillstyle solid noborder \
         linecolor "gray70" title "unstable, without swinging", \
     file using (is("unstable") && column("frequency") > 0 ? column(1) : NaN):2 \
         :(x1(1)):(x2(1)):(y1(2)):(y2(2)):"frequency" with boxxyerror fillstyle solid noborder \
         linecolor palette title "unstable", \
     boundary using (found ? column(1) : NaN):2 with points pointtype 7 pointsize 0.6 \
         linecolor "black" title "boundary", \
     file using (marked && $0 == 0 ? here_1 : NaN):(here_2) with points pointtype 2 pointsize 2 linewidth 2 \
         linecolor "black" title (marked ? "the input" : "")
set output
if (ending eq "png") { ending = "svg"; load stem.".gp" }
