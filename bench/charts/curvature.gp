# Curvature and flow; bench_charts draws it.
load style
set terminal svg size 1180,820 font 'sans-serif,13' background rgb 'white'
set output data.'/curvature.svg'
set logscale xy
set format y '10^{%L}'
set format x '%g'
set multiplot layout 2,3 title "Curvature K and implicit flow against exact values\n{/*0.75 ".stamp('curvature').'}' font ',15' \
  margins 0.07,0.98,0.08,0.87 spacing 0.07,0.14
variants = '"mixed" "barycentric" "jitter 0.1" "jitter 0.3"'
colours = '#1b6ca8 #d95f02 #1b9e50 #7a4fa3'
set ylabel 'error of K, root mean square'
set yrange [1e-8:1]
set xrange [2:25]
set xtics (2.5, 5, 10, 20)
do for [shape in 'sphere ellipsoid torus'] {
  set title shape
  set xlabel 'edges in 0.1 cm'
  if (shape eq 'ellipsoid') { set key bottom left } else { unset key }
  plot for [k=1:4] rows('curvature', sprintf('$1=="%s" && $2=="%s"', shape, word(variants,k))) using 3:4 with linespoints lc rgb word(colours,k) lw 2 pt 7 ps 0.7 title word(variants,k)
  set ylabel ''
}
set title 'worst vertex of the sphere'
set ylabel 'error of K, largest'
unset key
plot for [k=1:4] rows('curvature', sprintf('$1=="sphere" && $2=="%s"', word(variants,k))) using 3:5 with linespoints lc rgb word(colours,k) lw 2 pt 7 ps 0.7 title word(variants,k)
set title 'a ball flows to 3/4 of its radius'
set xlabel 'implicit steps'
set xrange [0.8:200]
set xtics (1, 2, 4, 8, 16, 32, 64, 128)
set ylabel 'error of the radius'
set yrange [1e-4:1]
set key top right
meshes = '"642 vertices" "2562 vertices" "10242 vertices"'
plot for [k=1:3] rows('curvature', sprintf('$1=="flow" && $2=="%s"', word(meshes,k))) using 3:4 with linespoints lc rgb word(colours,k) lw 5-1.5*k pt 4+2*k ps 1.9-0.5*k title word(meshes,k)
set title 'the same, 32 steps: what the solver leaves'
set xlabel '1 / tolerance'
set format x '10^{%L}'
set xrange [*:*]
set xtics auto
set yrange [*:*]
unset key
plot rows('curvature', '$1=="tolerance"') using 3:4 with linespoints lc rgb word(colours,1) lw 2 pt 7 ps 0.7
unset multiplot
