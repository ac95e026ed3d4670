# A fault: its largest slip rate in time, the slip rate in depth, and contours of slip.
set datafile separator ","
if (!exists("ending")) { ending = "png" }
panels = strlen(contours[1:1]) > 0 && contours[1:1] ne " " ? 3 : 1
if (panels > 1) { stats contours using (column(-1)) skip 1 nooutput }
if (panels > 1 && !exists("STATS_max")) { panels = 1 }   # no contour yet
set terminal pngcairo size 1200,400*panels font "Sans,12"
if (ending eq "svg") { set terminal svg size 1200,400*panels font "Sans,12" background "white" }
set output stem.".".ending
set multiplot layout panels,1 title stem."\n" noenhanced   # a line more, clear of the key
set lmargin at screen 0.08
set rmargin at screen (panels > 1 ? 0.86 : 0.96)
set key outside top right horizontal
year = 365.0 * 86400
stats file using 1 skip 1 nooutput
in_years = time_unit eq "s" && STATS_max > 3 * year
shown_time = in_years ? year : 1.0
shown_unit = in_years ? "years" : time_unit
set xlabel "time [".shown_unit."]"
set ylabel "largest slip rate [".length_unit."/".time_unit."]"
set logscale y
set yrange [seismic_rate*1e-12 < * : *]   # a fault at rest has no logarithm
set autoscale xfix
set format y "10^{%T}"
plot file using ($1 / shown_time):(10**$2) skip 1 with lines linewidth 1.5 linecolor "#0072b2" \
         title "largest slip rate", \
     seismic_rate with lines dashtype 2 linecolor "gray50" title "events are faster"
unset logscale y
set yrange [*:*]
set format y "%g"
set format x "%g"
if (panels > 1) {
    stats contours using 3 skip 1 nooutput
    in_km = length_unit eq "m" && STATS_max > 1e3
    shown_depth = in_km ? 1e3 : 1.0
    half = STATS_min / shown_depth   # of a cell: the first one begins at the surface
    set yrange [STATS_max / shown_depth + half:0]
    set ylabel "depth [".(in_km ? "km" : length_unit)."]"
    set xlabel "number of the contour, one every ".gprintf("%g", between / shown_time)." ".shown_unit \
        .", during events every ".gprintf("%g", during)." ".time_unit
    set cblabel "slip rate [".length_unit."/".time_unit."]"
    set format cb "10^{%g}"
    set palette defined (-12 "#ffffff", -9 "#a6bddb", -6 "#0072b2", -3 "#f0c040", 1 "#a02020")
    set cbrange [log10(seismic_rate) - 9:log10(seismic_rate) + 4]
    # each box reaches below the next ones, or seams would show between them
    plot contours using (column(-1)):($3 / shown_depth):(column(-1) - 0.5):(column(-1) + 1.5): \
        ($3 / shown_depth - half):($3 / shown_depth + 3 * half):5 skip 1 \
        with boxxyerror fillstyle solid linecolor palette notitle
    set xlabel "slip [".length_unit."]"
    plot contours using ($2 > 0 ? NaN : $4):($3 / shown_depth) skip 1 \
            with lines linecolor "#0072b2" title "between events", \
        contours using ($2 > 0 ? $4 : NaN):($3 / shown_depth) skip 1 \
            with lines linecolor "#d55e00" title "during events"
}
unset multiplot
set output
if (ending eq "png") { ending = "svg"; load stem.".gp" }
