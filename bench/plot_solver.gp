# docs/charts/solver.svg from docs/charts/solver.csv, which `bench_flow_step --csv docs/charts/solver.csv` writes.
# Run from the root of the project: gnuplot bench/plot_solver.gp
csv = 'docs/charts/solver.csv'
set encoding utf8
set terminal svg size 1100,720 font 'sans-serif,13' background rgb 'white'
set output 'docs/charts/solver.svg'
set datafile separator ','
set logscale xy
set grid xtics ytics lc rgb '#dddddd' lt 1
set border 3
set tics nomirror
set format y '%g'
set xtics ('1K' 1280, '5K' 5120, '20K' 20480, '100K' 100820)
set xrange [1000:130000]
set yrange [0.008:600]

# mesh, step, method, pattern -> the selected times, else nothing
rows(mesh, step, method, pattern) = \
  sprintf('< awk -F, ''$4=="%s" && $6==%g && $7=="%s" && $8=="%s" {print $5","$9}'' %s', mesh, step, method, pattern, csv)

set multiplot layout 2,2 title 'One implicit flow step: solve for three columns from zero to 10^{-6}, one core (CPU ms; * with assembly)' font ',15' \
  margins 0.065,0.79,0.08,0.90 spacing 0.07,0.11
do for [row = 1:2] {
  do for [column = 1:2] {
    mesh = column == 1 ? 'smooth' : 'irregular'
    step = row == 1 ? 1 : 100
    set title sprintf('%s sphere, γ dt = %s', mesh, step == 1 ? 'h^2' : '100 h^2') font ',13'
    set xlabel (row == 2 ? 'triangles' : '')
    set ylabel (column == 1 ? 'ms' : '')
    if (row == 2 && column == 1) { set key at screen 0.995,0.55 vertical right top samplen 2 spacing 1.5
    } else { unset key }
    plot rows(mesh, step, 'eigen_cholmod_decomposition', 'changed') using 1:2 with linespoints lc rgb '#999999' lw 1.5 dt 2 pt 8 title 'Eigen CHOLMOD *', \
         rows(mesh, step, 'eigen_cg_incomplete_cholesky', 'changed') using 1:2 with linespoints lc rgb '#999999' lw 1.5 pt 6 title 'Eigen IC-CG *', \
         rows(mesh, step, 'cholesky', 'kept') using 1:2 with linespoints lc rgb '#b2182b' lw 2 pt 9 title 'CHOLMOD', \
         rows(mesh, step, 'incomplete_cholesky', 'kept') using 1:2 with linespoints lc rgb '#e08214' lw 2 pt 7 ps 0.7 title 'CG with IC(0)', \
         rows(mesh, step, 'jacobi', 'kept') using 1:2 with linespoints lc rgb '#2166ac' lw 2 pt 5 ps 0.6 title 'CG with diagonal', \
         rows(mesh, step, 'automatic', 'kept') using 1:2 with points lc rgb 'black' lw 1.5 pt 6 ps 1.4 title 'automatic', \
         rows(mesh, step, 'assembly', 'kept') using 1:2 with linespoints lc rgb '#1b7837' lw 1.5 dt 3 pt 2 ps 0.6 title 'assembly'
  }
}
unset multiplot
