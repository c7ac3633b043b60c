# The map of failure; bench_stability draws it. A cell is one method and time step on one kind of mesh: the share of
# the edge lengths and tensions at which it survived, and what failed first most often.
load style
set terminal svg size 1300,1000 font 'sans-serif,12' background rgb 'white'
set output data.'/stability.svg'
summary = sprintf("< awk -F, '!/^#/ && $1!=\"method\" {if(!($1 in m)){m[$1]=++n; name[n]=$1} if(!($5 in d)){d[$5]=++k} c=m[$1] SUBSEP d[$5] SUBSEP $2; t[c]++; if($6==\"none\")s[c]++; else f[c SUBSEP $6]++} END{for(c in t){split(c,p,SUBSEP); best=\"\"; b=0; for(w in f){split(w,q,SUBSEP); if(q[1]==p[1]&&q[2]==p[2]&&q[3]==p[3]&&f[w]>b){b=f[w];best=q[4]}} u=substr(best,1,1); if(best==\"error\")u=\"x\"; if(best==\"not finite\")u=\"N\"; print p[2]\",\"(n+1-p[1])\",\"(s[c]+0)/t[c]\",\"u\",\"p[3]}}' %s/stability.csv", data)
method(k) = system(sprintf("awk -F, '!/^#/ && $1!=\"method\" && !($1 in m){m[$1]=1; name[++n]=$1} END{k=%d; print (k>0 ? name[n+1-k] : n)}' %s/stability.csv", k, data))
quality(which) = summary." | awk -F, '$5==\"".which."\"'"
n = int(method(0))
set palette defined (0 '#c0392b', 0.5 '#f0b27a', 0.999 '#f7dc6f', 1 '#58b368')
set cbrange [0:1]
unset colorbox
unset key
unset grid
set xrange [0.5:9.5]
set yrange [0.5:n+0.5]
set xtics ('1/15' 1, '1/30' 2, '1/60' 3, '1/120' 4, '1/240' 5, '1/480' 6, '1/960' 7, '1/1920' 8, '1/4800' 9) rotate by 45 right scale 0
unset ytics
set multiplot layout 2,3 title "Where methods fail: spheroids of R = 0.2 cm, on planes at 30 cm/s; a cell is 3 tensions × 3 edge lengths (levels in air 2, on a plane 1); green: all survived, red: none\n{/*0.9 first failure: a area grew, e energy grew, f faces turned over, N not finite, s solver, u unsound, v volume lost, x gave up with an error}\n{/*0.8 ".stamp('stability').'}' font ',13' \
  margins 0.12,0.99,0.08,0.87 spacing 0.015,0.13
do for [k = 1:6] {
  which = word('good jittered obtuse slivers needle 1:1000', k)
  set title which
  if (k == 1 || k == 4) { set ytics scale 0; do for [m = 1:n] { set ytics add (method(m) m) } } else { unset ytics }
  set xlabel (k > 3 ? 'time step, s' : '')
  plot quality(which) using 1:2:($1-0.5):($1+0.5):($2-0.5):($2+0.5):3 with boxxyerror fs solid noborder lc palette, '' using 1:2:(stringcolumn(4)) with labels font ',10' tc rgb '#333333'
}
unset multiplot
