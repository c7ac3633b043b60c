# Volume correction; bench_charts draws it.
load style
set terminal svg size 1400,460 font 'sans-serif,13' background rgb 'white'
set output data.'/volume_correction.svg'
set multiplot layout 1,4 title "What volume correction does to modes 2 to 6 and to the volume (dt = 1/4000 s)\n{/*0.75 ".stamp('volume_correction').'}' font ',15' \
  margins 0.05,0.84,0.13,0.78 spacing 0.055,0
corrections = 'none local global both own'
line(c) = c eq 'none' ? 3 : c eq 'local' ? 2 : c eq 'both' ? 4 : 1
point(c) = c eq 'none' ? 6 : c eq 'local' ? 8 : c eq 'both' ? 5 : 7
set xlabel 'mode n'
set xrange [1.7:6.3]
set xtics 1
unset key
set title 'amplitude kept a period'
set yrange [0:1.05]
plot for [l in level_names] for [c in corrections] rows('volume_correction', sprintf('$1=="%s" && $2=="%s"', l, c)) using 3:4 with linespoints lc rgb level_colour(l) dt line(c) lw 1.8 pt point(c) ps 0.7 title l.', '.c
set title 'frequency over Rayleigh''s'
plot for [l in level_names] for [c in corrections] rows('volume_correction', sprintf('$1=="%s" && $2=="%s"', l, c)) using 3:(1+$5) with linespoints lc rgb level_colour(l) dt line(c) lw 1.8 pt point(c) ps 0.7 title l.', '.c
set title 'processor seconds a period'
set yrange [0:*]
plot for [l in level_names] for [c in corrections] rows('volume_correction', sprintf('$1=="%s" && $2=="%s"', l, c)) using 3:7 with linespoints lc rgb level_colour(l) dt line(c) lw 1.8 pt point(c) ps 0.7 title l.', '.c
set title 'largest error of the volume'
set logscale y
set format y '10^{%L}'
set yrange [1e-16:10]
set key at screen 0.995,0.8 right top
plot for [l in level_names] for [c in corrections] rows('volume_correction', sprintf('$1=="%s" && $2=="%s"', l, c)) using 3:($6 > 1e-16 ? $6 : 1e-16) with linespoints lc rgb level_colour(l) dt line(c) lw 1.8 pt point(c) ps 0.7 title (any('volume_correction', sprintf('$1=="%s" && $2=="%s"', l, c)) ? l.', '.c : '')
unset multiplot
