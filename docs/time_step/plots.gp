# Plots of docs/time_step.md from runs.tsv; drawn by ./study.
#   gnuplot -e "runs='runs.tsv'; plots='DIR'" plots.gp
# Columns: snow n transfer acoustic_cfl flip_reference_dt seed, then a line of impact.
if (!exists("extension")) extension = "svg"
if (extension eq "svg") {
  set terminal svg size 960,400 font 'DejaVu Sans,13' background 'white'
} else {
  set terminal pngcairo size 960,400 font 'DejaVu Sans,11'
}
set datafile separator tab
set style line 1 lc rgb "#0072b2" lw 1.6 pt 7 ps 0.7
set style line 2 lc rgb "#d55e00" lw 1.6 pt 5 ps 0.7
set style line 3 lc rgb "#009e73" lw 1.6 pt 9 ps 0.8
set style line 4 lc rgb "#cc79a7" lw 1.6 pt 13 ps 0.9
set grid lc rgb "#dddddd" lw 0.6
set tics nomirror
set border 3
set key Left reverse samplen 2

# Column c of the runs of one series, sorted by acoustic_cfl (by = 4); seed 1 unless told.
series(snow, n, transfer, reference, seed) = sprintf( \
  "< awk -F '\\t' '$1 == \"%s\" && $2 == %d && $3 == \"%s\" && $5 == \"%s\" && $6 ~ /^(%s)$/' '%s' | sort -t '\t' -k4,4g", \
  snow, n, transfer, reference, seed, runs)
spread = 14
steps = 8

set output plots . "/acoustic_cfl." . extension
set multiplot layout 1,2
set logscale x
set xtics (0.1, 0.25, 0.5, 0.7, 1, 1.4)
set xlabel "acoustic\\_cfl"
set xrange [0.09:1.55]
set ylabel "spread of the snow at 0.125 s, m"
set yrange [0.09:0.21]
set key at graph 0.98,0.5 right font ",11"
plot series("dry", 5, "flip", "5e-4", "1|2|3") u 4:spread w p ls 1 t "dry, FLIP, R/5 (seeds 1, 2, 3)", \
     series("dry", 5, "flip", "5e-4", "1") u 4:spread w l ls 1 notitle, \
     series("dry", 8, "flip", "5e-4", "1|2") u 4:spread w p ls 2 t "dry, FLIP, R/8 (seeds 1, 2)", \
     series("dry", 8, "flip", "5e-4", "1") u 4:spread w l ls 2 notitle, \
     series("dry", 5, "mls", "5e-4", "1|2|3") u 4:spread w p ls 4 t "dry, MLS, R/5", \
     series("dry", 5, "mls", "5e-4", "1") u 4:spread w l ls 4 notitle, \
     series("paper", 5, "flip", "5e-4", "1|2|3") u 4:spread w p ls 3 t "paper's, FLIP, R/5 (seeds 1, 2, 3)", \
     series("paper", 5, "flip", "5e-4", "1") u 4:spread w l ls 3 notitle
set ylabel "steps to 0.125 s"
set yrange [500:7000]
set logscale y
set ytics (500, 1000, 2000, 4000)
set key at graph 0.98,0.98 right top font ",11"
plot series("dry", 5, "flip", "5e-4", "1") u 4:steps w lp ls 1 t "dry, FLIP, R/5", \
     series("dry", 8, "flip", "5e-4", "1") u 4:steps w lp ls 2 t "dry, FLIP, R/8", \
     series("dry", 5, "mls", "5e-4", "1") u 4:steps w lp ls 4 t "dry, MLS, R/5", \
     series("paper", 5, "flip", "5e-4", "1") u 4:steps w lp ls 3 t "paper's, FLIP, R/5"
unset multiplot

set output plots . "/flip_reference_dt." . extension
set multiplot layout 1,2
set xrange [0.2:1.2]
set xtics (0.25, 0.5, 1)
set xlabel "acoustic\\_cfl"
unset logscale y
set ytics auto
set ylabel "spread of the snow at 0.125 s, m"
set yrange [0.09:0.22]
set key default Left reverse above samplen 2
plot series("dry", 5, "flip", "1e-3", "1") u 4:spread w lp ls 4 t "1e-3", \
     series("dry", 5, "flip", "5e-4", "1") u 4:spread w lp ls 1 t "5e-4 (default)", \
     series("dry", 5, "flip", "2e-4", "1") u 4:spread w lp ls 2 t "2e-4", \
     series("dry", 5, "flip", "0", "1") u 4:spread w lp ls 3 t "0: per step"
set ylabel "kinetic energy at 0.125 s, J"
set yrange [1e-3:10]
set logscale y
set ytics (1e-3, 1e-2, 0.1, 1, 10)
set key default Left reverse above samplen 2
plot series("dry", 5, "flip", "1e-3", "1") u 4:21 w lp ls 4 t "1e-3", \
     series("dry", 5, "flip", "5e-4", "1") u 4:21 w lp ls 1 t "5e-4 (default)", \
     series("dry", 5, "flip", "2e-4", "1") u 4:21 w lp ls 2 t "2e-4", \
     series("dry", 5, "flip", "0", "1") u 4:21 w lp ls 3 t "0: per step"
unset multiplot
