# A run of a block that moves along and across the interface: forces, normal traction, velocities.
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
if (!exists("ending")) { ending = "png" }
set terminal pngcairo size 1200,1000 font "Sans,12"
if (ending eq "svg") { set terminal svg size 1200,1000 font "Sans,12" background "white" }
set output stem.".".ending
set multiplot layout 3,1 title stem noenhanced
unset xlabel
set ylabel "force [".force_unit."]"
plot file using "time":"friction_force" with lines ls 9 title "friction", \
     file using "time":"spring_force" with lines ls 1 title "spring"
set ylabel "normal traction [".stress_unit."]"
plot file using "time":"normal_traction" with lines ls 2 title "of the contact"
set ylabel "velocity [".length_unit."/".time_unit."]"
set xlabel "time [".time_unit."]"
plot file using "time":"normal_velocity" with lines ls 9 title "across", \
     file using "time":"velocity" with lines ls 3 title "along the interface"
unset multiplot
set output
if (ending eq "png") { ending = "svg"; load stem.".gp" }
