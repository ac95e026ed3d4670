# Cost of a point update against the number of points: run by ./dev bench beside bench.csv.
set datafile separator ","
set datafile missing NaN
set terminal pngcairo size 1100,700 font "Sans,13" linewidth 1.5
set output "bench.png"
set logscale xy
set format x "10^{%T}"
set xlabel "points N"
set ylabel "time per point [ns]"
set xrange [700:1.4e7]
set yrange [0.5:*]
set grid xtics ytics mytics linecolor "gray80"
set key outside right top Left reverse

# Rows of the table, and NaN for all others.
row(routine, set, threads) = strcol("routine") eq routine && strcol("set") eq set \
    && column("threads") == threads ? column("ns_per_point") : NaN

# Where a routine was measured at one N only, its line goes all the way.
stats "bench.csv" using (row("scalar", "random", 1)) name "random" nooutput
stats "bench.csv" using (row("scalar", "wide", 1)) name "wide" nooutput

plot random_max with lines lc rgb "#d55e00" title "scalar, random", \
    wide_max with lines dt 2 lc rgb "#d55e00" title "scalar, wide", \
    "bench.csv" using "n":(row("batch", "random", 1)) with linespoints pt 7 lc rgb "#0072b2" \
        title "batch, random, 1 thread", \
    "" using "n":(row("batch", "wide", 1)) with linespoints dt 2 pt 6 lc rgb "#0072b2" \
        title "batch, wide, 1 thread", \
    "" using "n":(row("batch", "random", 2)) with linespoints pt 5 lc rgb "#009e73" \
        title "batch, random, 2 threads", \
    "" using "n":(row("batch", "wide", 2)) with linespoints dt 2 pt 4 lc rgb "#009e73" \
        title "batch, wide, 2 threads", \
    "" using "n":(row("memcpy", "-", 1)) with linespoints pt 2 lc rgb "gray40" \
        title "memcpy of the same bytes"
