# Growth of waves on a thread; bench_charts draws it.
load style
set terminal svg size 980,520 font 'sans-serif,13' background rgb 'white'
set output data.'/thread.svg'
set title "Waves on a thread of liquid: growth against Rayleigh's\n{/*0.75 ".stamp('thread').'}' font ',15'
set xlabel 'k r'
set ylabel 'growth rate / sqrt(σ/(ρ r^3))'
set xrange [0:1.05]
set yrange [0:*]
set samples 400
set key outside right top
exact(x) = x <= 0 || x >= 1 ? 0 : sqrt(x*(1-x*x)*besi1(x)/besi0(x))
plot exact(x) with lines lc rgb 'black' lw 2 title 'exact (Rayleigh)', \
  for [l in level_names] rows('thread', sprintf('$1=="%s"', l)) using 2:3 with linespoints lc rgb level_colour(l) lw 2 pt (l eq 'calibrated' ? 6 : 7) ps (l eq 'calibrated' ? 1.8 : 0.8) title (any('thread', sprintf('$1=="%s"', l)) ? l : ''), \
  for [l in level_names] rows('thread', sprintf('$1=="%s (local)" && $3!="nan"', l)) using 2:3 with linespoints lc rgb level_colour(l) lw 2 dt 2 pt 6 title (any('thread', sprintf('$1=="%s (local)" && $3!="nan"', l)) ? l.', local volume correction' : '')
