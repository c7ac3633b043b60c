# What merging and remeshing bring in; bench_charts draws it.
load style
set terminal svg size 1180,480 font 'sans-serif,13' background rgb 'white'
set output data.'/merge_remesh.svg'
set logscale xy
set multiplot layout 1,3 title "Two balls of R = 0.2 cm become one drop: what merging and remeshing bring in\n{/*0.75 ".stamp('merge_remesh').'}' font ',15' \
  margins 0.07,0.98,0.14,0.78 spacing 0.08,0
set xlabel 'edge length, cm'
set format y '10^{%L}'
set xtics (0.005, 0.01, 0.02, 0.04)
set yrange [1e-6:1]
set xrange [0.004:0.08]
merged = '#1b6ca8'; remeshed = '#d95f02'
set key top left
set title 'volume'
plot rows('merge_remesh', '$1=="merged"') using 2:(abs($4)) with linespoints lc rgb merged lw 2 pt 7 ps 0.7 title 'merged, beside two balls', \
  rows('merge_remesh', '$1=="remeshed"') using 2:(abs($5)) with linespoints lc rgb remeshed lw 2 pt 7 ps 0.7 title 'change by remeshing'
set title 'area'
plot rows('merge_remesh', '$1=="merged"') using 2:(abs($6)) with linespoints lc rgb merged lw 2 pt 7 ps 0.7 title 'merged, beside two balls', \
  rows('merge_remesh', '$1=="remeshed"') using 2:(abs($7)) with linespoints lc rgb remeshed lw 2 pt 7 ps 0.7 title 'change by remeshing'
set yrange [1e-8:1e-2]
set title 'curvature away from the seam, r.m.s.'
plot rows('merge_remesh', '$1=="merged"') using 2:8 with linespoints lc rgb merged lw 4 pt 6 ps 1.5 title 'merged', \
  rows('merge_remesh', '$1=="remeshed"') using 2:8 with linespoints lc rgb remeshed lw 2 pt 7 ps 0.7 title 'remeshed'
unset multiplot
