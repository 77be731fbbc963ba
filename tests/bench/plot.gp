# Time and memory against the number of facets, from the CSV of tests/bench/eigen or tests/bench/cholesky:
#   gnuplot -e "csv='eigen.csv'; out='eigen'" plot.gp      writes eigen-time.svg and eigen-memory.svg
# Several meshes of nearly the same size stand side by side: -e "mesh='generated'" takes one. Colours and greys of
# middling lightness on no background: readable on light and dark pages.
if (!exists("csv")) csv = "eigen.csv"
if (!exists("out")) out = "bench"
if (!exists("mesh")) mesh = ""
set datafile separator ","

header = system("head -n 1 " . csv)
column_of(name) = int(system(sprintf("head -n 1 %s | tr ',' '\\n' | grep -nx %s | cut -d: -f1", csv, name)))
solver = column_of("solver")
is_eigen = strstrt(header, ",cpu,") > 0
time = column_of(is_eigen ? "cpu" : "work")
least = column_of(is_eigen ? "cpu_min" : "work_min")
most = column_of(is_eigen ? "cpu_max" : "work_max")
peak = column_of("peak")
mode_filter = is_eigen ? "&& $4 == \"tolerance\"" : ""
rows(name) = sprintf("< awk -F, 'NR > 1 && $%d == \"%s\" %s && (\"%s\" == \"\" || $1 == \"%s\")' %s | sort -t, -g -k2", \
                     solver, name, mode_filter, mesh, mesh, csv)
names = system(sprintf("awk -F, 'NR > 1 && !seen[$%d]++ { print $%d }' %s", solver, solver, csv))

set terminal svg size 900,480 dynamic font "sans-serif,14"
grey = "#808080"
set border 3 lc rgb grey
set tics textcolor rgb grey nomirror
set key outside right top Left reverse textcolor rgb grey
set grid lc rgb grey lw 0.3
set logscale xy
set xlabel "facets" textcolor rgb grey
set format x "%.0s%c"
array colours[8] = ["#e8702a", "#3f8fd2", "#4aa564", "#a06cd5", "#c9a227", "#d6558c", "#2fa7a0", "#9a7b5f"]
colour(i) = i == 1 ? colours[1] : colours[2 + (i - 2) % 7]
width(name) = strstrt(name, "ours") == 1 ? 3 : 1.2

set output out . "-time.svg"
set ylabel (is_eigen ? "CPU time [s]" : "factor and 64 right-hand sides, CPU time [s]") textcolor rgb grey
plot for [i = 1:words(names)] rows(word(names, i)) using 2:time:least:most with yerrorlines \
    lc rgb colour(i) lw width(word(names, i)) pt 6 + (i % 4) ps 0.5 title word(names, i) noenhanced

set output out . "-memory.svg"
set ylabel "peak memory [MB]" textcolor rgb grey
plot for [i = 1:words(names)] rows(word(names, i)) using 2:(column(peak) / 1e6) with linespoints \
    lc rgb colour(i) lw width(word(names, i)) pt 6 + (i % 4) ps 0.5 title word(names, i) noenhanced
