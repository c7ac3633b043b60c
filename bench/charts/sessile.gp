# Shape at rest against cost; bench_charts draws it.
load style
set terminal svg size 1380,860 font 'sans-serif,13' background rgb 'white'
set output data.'/sessile.svg'
set logscale xy
set format x '10^{%L}'
set format y '10^{%L}'
set multiplot layout 2,3 title "Water at rest on a plane (R = 0.2 cm), against Young-Laplace; along a line the mesh gets finer\n{/*0.75 ".stamp('sessile').'}' font ',15' \
  margins 0.08,0.81,0.09,0.87 spacing 0.055,0.12
set yrange [1e-6:1]
set xrange [0.001:10]
do for [row = 1:2] {
  do for [angle in '60 90 120'] {
    set title sprintf('%s degrees', angle)
    set xlabel (row == 2 ? 'processor seconds to rest' : '')
    set ylabel (angle eq '60' ? (row == 1 ? 'height, relative error' : 'contact radius, relative error') : '')
    column = row == 1 ? 6 : 7
    if (row == 1 && angle eq '120') { set key at screen 0.995,0.85 right top } else { unset key }
    plot for [l in level_names] rows('sessile', sprintf('$1=="%s" && $2==0.2 && $3==%s', l, angle)) using 9:(abs(column(column))) with linespoints lc rgb level_colour(l) lw 2 pt 7 ps 0.7 title (any('sessile', sprintf('$1=="%s"', l)) ? l : ''), \
      rows('sessile', sprintf('$1=="evolver linear" && $2==0.2 && $3==%s', angle)) using 9:(abs(column(column))) with linespoints lc rgb peer lw 1.5 dt 2 pt 6 title 'Surface Evolver, linear', \
      rows('sessile', sprintf('$1=="evolver quadratic" && $2==0.2 && $3==%s', angle)) using 9:(abs(column(column))) with linespoints lc rgb 'black' lw 1.5 dt 3 pt 8 title 'Surface Evolver, quadratic'
  }
}
unset multiplot
