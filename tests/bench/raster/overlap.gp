# Processor time of overlap counts against texels a side, from the CSV of tests/bench/raster/overlap:
#   gnuplot -e "csv='raster-overlap.csv'; out='raster-overlap'" overlap.gp      writes raster-overlap.svg
# Colours and greys of middling lightness on no background: readable on light and dark pages.
if (!exists("csv")) csv = "raster-overlap.csv"
if (!exists("out")) out = "raster-overlap"
set datafile separator ","
rows(kind, n) = sprintf("< awk -F, '$1 == \"%s\" && $2 >= 0.9 * %s && $2 < 1.1 * %s' %s", kind, n, n, csv)
array sizes[3] = ["10000", "100000", "1000000"]
array names[3] = ["10k", "100k", "1M"]
array colours[3] = ["#e8702a", "#3f8fd2", "#4aa564"]
grey = "#808080"
set terminal svg size 900,420 dynamic font "sans-serif,14"
set output out . ".svg"
set multiplot layout 1,2
set border 3 lc rgb grey
set tics textcolor rgb grey nomirror
set key top left reverse Left textcolor rgb grey samplen 2
set grid lc rgb grey lw 0.3
set logscale xy
set xrange [850:9000]
set xtics (1024, 2048, 4096)
set yrange [0.1:3000]
set xlabel "texels a side" textcolor rgb grey
set ylabel "processor time [ms]" textcolor rgb grey
do for [kind in "mesh soup"] {
    set title (kind eq "mesh" ? "one chart" : "triangles that share nothing") textcolor rgb grey
    plot for [k = 1:3] rows(kind, sizes[k]) using 3:4 with linespoints lc rgb colours[k] lw 2.5 pt 7 ps 0.6 \
             title names[k] . " ours", \
         for [k = 1:3] rows(kind, sizes[k]) using 3:6 with linespoints lc rgb colours[k] lw 1.2 dt 2 pt 6 ps 0.6 \
             title names[k] . " llvmpipe"
}
unset multiplot
