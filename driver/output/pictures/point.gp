# A contact point's path: the hysteresis loop, and friction over slip.
set datafile separator ","
set style line 1 linewidth 1.5 linecolor "#9400d3"
set style line 2 linewidth 1.5 linecolor "#0072b2"
set style line 3 linewidth 1.5 linecolor "#d55e00"
set style line 9 linewidth 1.0 linecolor "gray60"
set grid
set lmargin 13
set key outside top right horizontal
set xtics font ",9"
second(name) = directions == 3 ? column(name) : NaN
shear(x) = directions == 3 ? sqrt(column("t_t1")**2 + column("t_t2")**2) : abs(column("t_t1"))
pressing(n) = n < 0 ? -n : NaN
if (!exists("ending")) { ending = "png" }
set terminal pngcairo size 1300,600 font "Sans,12"
if (ending eq "svg") { set terminal svg size 1300,600 font "Sans,12" background "white" }
set output stem.".".ending
set multiplot layout 1,2 title stem noenhanced
set xlabel "relative displacement [".length_unit."]"
set ylabel "tangential traction [".stress_unit."]"
if (directions == 3) {
    plot file every step using "u_t1":"t_t1" with lines ls 1 title "t1", \
         file every step using "u_t2":"t_t2" with lines ls 3 title "t2"
} else {
    plot file every step using "u_t1":"t_t1" with lines ls 1 title "t1"
}
set xlabel "slip [".length_unit."]"
set ylabel "friction coefficient [-]"
plot file every step using "slip":(shear(0) / pressing(column("t_n"))) with lines ls 9 \
         title "|t_t| / |t_n|", \
     file every step using "slip":"mu" with lines ls 2 title "mu"
unset multiplot
set output
if (ending eq "png") { ending = "svg"; load stem.".gp" }
