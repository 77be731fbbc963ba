# Time and memory over size; where the time goes.
set terminal svg size 1000,380 noenhanced font 'system-ui,sans-serif,12' rounded
set datafile separator ','
set border 3 lw 0.8 lc rgb '#555a60'
set tics nomirror out textcolor rgb '#333840'
set output 'timing.svg'
models = "hand body tree"
colors = "#1a7f4b #b3261e #2f6fb5"
set multiplot layout 1,3 margins 0.06,0.87,0.14,0.9 spacing 0.07,0.1
set grid lw 0.5 lc rgb '#d8dbe0'
set logscale xy 10
set format x '10^{%T}'
set xlabel 'facets'
set format x '%.0s%c'
set title 'CPU seconds'
set key top left reverse Left samplen 2
set yrange [0.05:20000]
plot for [m = 1:3] 'timings.csv' skip 1 using 2:(strcol(1) eq word(models, m) ? $4 : 1/0) with linespoints lw 2 pt 7 ps 0.5 \
    lc rgb word(colors, m) title word(models, m), 270 with lines lw 1.2 dt 2 lc rgb '#555a60' title "the paper's 4 min 30"
set title 'peak memory [MB]'
set yrange [10:*]
plot for [m = 1:3] 'timings.csv' skip 1 using 2:(strcol(1) eq word(models, m) ? $5 : 1/0) with linespoints lw 2 pt 7 ps 0.5 \
    lc rgb word(colors, m) notitle
unset logscale
set format x
set title 'share of the time'
unset xlabel
set yrange [0:1]
set xrange [0.4:3.6]
set xtics ("hand" 1, "body" 2, "tree" 3) scale 0
set key outside right center vertical maxrows 6
unset grid
set style fill solid 0.85 noborder
set boxwidth 0.6
stages = "eigenvectors symmetry flattening sewing packing rest"
shades = "#1a7f4b #8a5fb5 #2f6fb5 #e0a030 #b3261e #9aa3ad"
plot for [s = 1:6] 'timing-shares.csv' skip 1 using ($1 + 1):(0.5*(column(2*s) + column(2*s + 1))):($1 + 0.7):($1 + 1.3):(column(2*s)):(column(2*s + 1)) \
    with boxxyerror lc rgb word(shades, s) title word(stages, s)
unset multiplot
