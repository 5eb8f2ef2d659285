# Plots of scaling.dat in `folder`: set 0 the chains, set 1 the humanoid; columns: joints, seconds, megabytes.
data = folder . "/scaling.dat"
seconds(n) = start + rise * n**exponent
start = 0.02
rise = 5e-4
exponent = 2.0
set fit quiet logfile "/dev/null"
set fit errorvariables
fit seconds(x) data index 0 using 1:2 via start, rise, exponent
set print "-"
print sprintf("\nchains: user time = %.3f s + %.2g s * joints^%.2f (exponent +- %.2f)", start, rise, exponent, exponent_err)

set key top left
set xlabel "joints"
set xrange [0:52]
set yrange [0:*]
set terminal dumb noenhanced 100 26
set ylabel "s"
plot data index 0 using 1:2 with points pt "o" title "chains, user time [s]", data index 1 using 1:2 with points pt "H" title "humanoid", \
    seconds(x) with dots title "fit"

set terminal svg noenhanced size 720, 720
set output folder . "/scaling.svg"
set multiplot layout 2, 1 title "Generation of all models"
set ylabel "user time [s]"
plot data index 0 using 1:2 with points pt 7 title "chains", data index 1 using 1:2 with points pt 9 title "humanoid", \
    seconds(x) title sprintf("%.3f + %.2g n^{%.2f}", start, rise, exponent)
set ylabel "resident memory [MB]"
plot data index 0 using 1:3 with linespoints pt 7 title "chains", data index 1 using 1:3 with points pt 9 title "humanoid"
unset multiplot
