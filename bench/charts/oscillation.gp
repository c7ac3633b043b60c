# Error and damping of mode 2 against cost; bench_charts draws it.
load style
set terminal svg size 1180,560 font 'sans-serif,13' background rgb 'white'
set output data.'/oscillation.svg'
set logscale xy
set format x '10^{%L}'
set xlabel 'processor seconds a period'
set multiplot layout 1,2 title "Mode 2 of a drop of water (R = 0.2 cm): error against cost; along a line the time step shrinks from 1/240 to 1/7680 s\n{/*0.75 ".stamp('oscillation').'}' font ',15' \
  margins 0.085,0.80,0.12,0.80 spacing 0.085,0
meshes = '642 2562 10242'
set title 'frequency, against Rayleigh'
set ylabel 'relative error' offset 1,0
set yrange [1e-4:2]
unset key
plot for [l in level_names] for [k=1:3] rows('oscillation', sprintf('$1=="%s" && $2==%s', l, word(meshes,k))) using 6:(abs($4)) with linespoints lc rgb level_colour(l) lw 1.8 pt 4+2*k ps 0.7 title l.', '.word(meshes,k).' vertices', \
  rows('oscillation', '$1=="gerris axisymmetric"') using 6:(abs($4)) with points pt 3 ps 1.3 lw 2 lc rgb peer title 'gerris axisymmetric', \
  rows('oscillation', '$1=="gerris 3D"') using 6:(abs($4)) with points pt 2 ps 1.5 lw 3 lc rgb 'black' title 'gerris 3D'
set title 'amplitude lost (or gained) a period'
set ylabel 'share of the amplitude'
set yrange [5e-4:1.2]
set key at screen 0.995,0.8 right top
plot for [l in level_names] for [k=1:3] rows('oscillation', sprintf('$1=="%s" && $2==%s', l, word(meshes,k))) using 6:(abs(1-$5)) with linespoints lc rgb level_colour(l) lw 1.8 pt 4+2*k ps 0.7 title (any('oscillation', sprintf('$1=="%s"', l)) ? l.', '.word(meshes,k).' vertices' : ''), \
  rows('oscillation', '$1=="gerris axisymmetric"') using 6:(abs(1-$5)) with points pt 3 ps 1.3 lw 2 lc rgb peer title 'gerris axisymmetric', \
  rows('oscillation', '$1=="gerris 3D"') using 6:(abs(1-$5)) with points pt 2 ps 1.5 lw 3 lc rgb 'black' title 'gerris 3D (frequency only)'
unset multiplot
