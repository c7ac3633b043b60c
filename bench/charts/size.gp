# Cost against size; bench_charts draws it.
load style
set terminal svg size 1100,480 font 'sans-serif,13' background rgb 'white'
set output data.'/size.svg'
set logscale xy
set multiplot layout 1,2 title "Processor time of a step on one thread, in the air, remeshing on\n{/*0.75 ".stamp('size').'}' font ',15' \
  margins 0.08,0.98,0.13,0.78 spacing 0.1,0
slope(l) = system(sprintf("awk -F, '$1==\"%s\" {printf \"%%.2f\", $7; exit}' %s/size.csv", l, data))
set title 'one drop'
set xlabel 'triangles'
set xrange [600:400000]
set yrange [5e-5:2]
set ylabel 'seconds a step'
set format x '%g'
set format y '10^{%L}'
set xtics ('1K' 1000, '5K' 5000, '20K' 20000, '50K' 50000, '200K' 200000)
set key top left
plot for [l in level_names] rows('size', sprintf('$1=="%s" && $2=="one drop"', l)) using 4:5 with linespoints lc rgb level_colour(l) lw 2 pt 7 ps 0.7 title (any('size', sprintf('$1=="%s"', l)) ? l.': triangles^{'.slope(l).'}' : '')
set title '50K triangles in all'
set xlabel 'drops'
set xrange [0.7:1500]
set yrange [*:*]
set xtics ('1' 1, '10' 10, '100' 100, '1,000' 1000)
set ylabel 'ns a triangle and step'
unset logscale y
set format y '%g'
set yrange [0:*]
unset key
plot for [l in level_names] rows('size', sprintf('$1=="%s" && $2=="many drops"', l)) using 3:6 with linespoints lc rgb level_colour(l) lw 2 pt 7 ps 0.7 title l
unset multiplot
