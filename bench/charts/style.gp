# What every chart shares. `data` is the directory of the CSV files; bench_charts and bench_stability set it.
set encoding utf8
set datafile separator ','
set border 3 lc rgb '#444444'
set tics nomirror
set grid lc rgb '#dddddd' lt 1
set key samplen 2 spacing 1.25
# Colours by level, dark on white, apart for the colour blind too.
paper = '#d95f02'; calibrated = '#1b6ca8'; pressure = '#1b9e50'; peer = '#777777'
level_names = 'paper calibrated pressure'
level_colour(name) = name eq 'paper' ? paper : name eq 'calibrated' ? calibrated : pressure
# Rows of a table for which an awk condition holds.
rows(table, condition) = sprintf("< awk -F, '!/^#/ && %s' %s/%s.csv", condition, data, table)
# Whether there are any.
any(table, condition) = int(system(sprintf("awk -F, '!/^#/ && %s {n++} END {print n+0}' %s/%s.csv", condition, data, table))) > 0
# Who measured where and when: the second comment line.
stamp(table) = system(sprintf("sed -n '2s/^# //p' %s/%s.csv", data, table))
