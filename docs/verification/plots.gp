# Plots of docs/verification.md, from the curves that the tests leave in `results`; drawn by ./make.
#   gnuplot -e "results='DIR'; plots='DIR'" plots.gp
# With extension='png' they become pixels, for looking at.
if (!exists("extension")) extension = "svg"
open(w, h) = extension eq "svg" \
  ? sprintf("set terminal svg size %d,%d font 'DejaVu Sans,13' background 'white'", w, h) \
  : sprintf("set terminal pngcairo size %d,%d font 'DejaVu Sans,11'", w, h)
curve(name) = results . "/" . name . ".dat"
plot_file(name) = plots . "/" . name . "." . extension

set style line 1 lc rgb "#0072b2" lw 1.6 pt 7 ps 0.8
set style line 2 lc rgb "#d55e00" lw 1.6 pt 5 ps 0.8
set style line 3 lc rgb "#009e73" lw 1.6 pt 9 ps 1.0
set style line 4 lc rgb "#777777" lw 1.2 dt 2
set style line 5 lc rgb "#cc79a7" lw 1.6 pt 13 ps 1.0
set grid lt 1 lc rgb "#d8d8d8" lw 0.8
set tics nomirror
set border 3
set key Left reverse samplen 2
transfers = "flip apic mls"

# Dispersion.
eval open(960, 420)
set output plot_file("dispersion")
set multiplot layout 1,2
set xlabel "cell size / wavelength"
set ylabel "ω / (c k), 1 in the continuum"
set xrange [0:0.26]
set yrange [0.4:1.02]
set key bottom left
sinc(x) = x == 0 ? 1 : sin(x) / x
do for [kernel in "cubic quadratic"] {
  power = kernel eq "cubic" ? 8 : 6
  set title kernel . " B-spline, longitudinal waves"
  plot for [s=1:3] curve("dispersion_theory_".word(transfers, s)."_".kernel) using 1:2 \
         with lines ls s notitle, \
       for [s in "3 2 1"] curve("dispersion_".word(transfers, s+0)."_".kernel) using 1:2 \
         with points ls s+0 title word("FLIP APIC MLS", s+0), \
       sinc(pi*x)**power with lines ls 4 title sprintf("sinc(kh/2)^%d", power)
}
unset multiplot

# Damping.
set output plot_file("damping")
set multiplot layout 1,2
set ylabel "decay of the amplitude / (c k)"
set logscale y
set yrange [1e-5:1]
set format y "10^{%T}"
set key bottom right
labels = "'FLIP 1.0, c dt/h = 0.1' 'APIC, c dt/h = 0.2' 'MLS, c dt/h = 0.2'"
do for [kernel in "cubic quadratic"] {
  set title kernel . " B-spline; filled: longitudinal, open: shear"
  plot for [s=1:3] for [c=4:5] curve("dispersion_theory_".word(transfers, s)."_".kernel) \
         using 1:c with lines ls s dt 2*c-7 notitle, \
       for [s=1:3] curve("dispersion_".word(transfers, s)."_".kernel) \
         using 1:5 with points ls s pt 2*s+(s==1 ? 4 : s==2 ? 0 : 2) notitle, \
       for [s=1:3] curve("dispersion_".word(transfers, s)."_".kernel) \
         using 1:4 with points ls s title word(labels, s)
}
unset multiplot

# Convergence.
set output plot_file("convergence")
set multiplot layout 1,2
set logscale x
set format y "10^{%T}"
set xrange [0.012:0.16]
set xtics ("1/64" 1./64, "1/32" 1./32, "1/16" 1./16, "1/8" 1./8)
set xlabel "cell size h (m), wavelength 1 m"
set ylabel "rms error of the displacement / A"
set yrange [2e-4:3]
set key top left
set title "cubic, moved by the grid, strains to 31 %"
plot curve("manufactured_flip") with linespoints ls 1 title "FLIP 1.0", \
     curve("manufactured_apic") with linespoints ls 2 title "APIC", \
     curve("manufactured_mls") with linespoints ls 3 title "MLS", \
     12 * x**2 with lines ls 4 title "order 2"
set title "limits of schemes"
set yrange [5e-4:300]
plot curve("manufactured_flip_particle") with linespoints ls 1 \
       title "FLIP 1.0 moved by v_p, 31 %" noenhanced, \
     curve("manufactured_flip_particle_small") with linespoints ls 1 dt 3 pt 6 title "the same, 6 %", \
     curve("manufactured_paper_small") with linespoints ls 5 \
       title "FLIP 0.95 moved by v_p, 6 %" noenhanced, \
     curve("manufactured_apic_quadratic") with linespoints ls 2 title "APIC quadratic, 31 %", \
     curve("manufactured_mls_quadratic") with linespoints ls 3 title "MLS quadratic, 31 %", \
     12 * x**2 with lines ls 4 title "order 2"
unset multiplot

# Bars.
set output plot_file("bars")
set multiplot layout 1,2
set xrange [0.02:0.13]
set xtics ("1/40" 1./40, "1/20" 1./20, "1/10" 1./10)
set yrange [1e-3:0.2]
set xlabel "cell size h (m), length 1 m"
set ylabel "period / exact - 1"
set title "free bar, exact: 2 L/c"
plot curve("bar_free") using 1:($2-1) with points ls 1 title "FLIP 1.0, cubic", \
     curve("bar_free") using 1:($3-1) with lines ls 1 title "dispersion of a wave of 2 L", \
     3.2 * x**2 with lines ls 4 title "order 2"
set title "bar held at one end, exact: 4 L/c"
plot curve("bar_held") using 1:($2-1) with linespoints ls 1 title "FLIP 1.0, cubic", \
     0.46 * x with lines ls 4 title "order 1"
unset multiplot
unset logscale
set format y "%h"
set xtics auto

# Compression.
set output plot_file("compression")
set multiplot layout 1,2
set logscale y
set xrange [1:0.48]
set yrange [1e3:1.2e6]
set format y "10^{%T}"
set xlabel "stretch (of the column: in its middle)"
set ylabel "axial compressive stress (Pa)"
set title "paper snow, uniaxial strain"
plot curve("uniaxial_double") using 1:(-$4) with lines ls 4 dt 1 title "formula", \
     curve("uniaxial_double") every 8 using 1:(-$3) with points ls 1 title "material, double", \
     curve("uniaxial_float") every 8::4 using 1:(-$3) with points ls 3 title "material, float", \
     curve("uniaxial_column") using 2:(-$3) with points ls 2 title "middle of a column"
unset logscale y
set format y "%h"
set xrange [1:0.68]
set yrange [0.68:1.005]
set xlabel "stretch of the whole column"
set ylabel "stretch of its middle"
set title "contact layers give way first"
set key bottom left
plot curve("uniaxial_column") using 1:2 with linespoints ls 2 title "column, 16 cells", \
     x with lines ls 4 title "even strain"
unset multiplot

# Balls.
eval open(960, 640)
set output plot_file("balls")
set multiplot layout 2,2
set xrange [0:0.6]
set yrange [0:1.05]
set xlabel "time (s)"
set ylabel "energy / start"
set key center right
balls = "flip_0.95_cubic flip_1.0_cubic apic_cubic mls_quadratic"
titles = "'FLIP 0.95, cubic' 'FLIP 1.0, cubic' 'APIC, cubic' 'MLS, quadratic'"
do for [s=1:4] {
  set title word(titles, s)
  if (s == 2) { unset key }
  plot curve("balls_".word(balls, s)) using 1:4 with lines ls 4 dt 1 title "total", \
       '' using 1:2 with lines ls 1 title "kinetic", '' using 1:3 with lines ls 2 title "elastic"
}
unset multiplot
