# Processor time of a frame against triangles, from the CSV of tests/bench/raster/frame:
#   gnuplot -e "csv='bench-raster-frame.csv'; out='bench-raster-frame'" frame.gp      writes bench-raster-frame.svg
if (!exists("csv")) csv = "bench-raster-frame.csv"
if (!exists("out")) out = "bench-raster-frame"
set datafile separator ","
rows(culled) = sprintf("< awk -F, '$2 == %d' %s", culled, csv)
grey = "#606060"
set terminal svg size 900,420 dynamic background rgb "white" font "sans-serif,14"
set output out . ".svg"
set multiplot layout 1,2
set border 3 lc rgb grey
set tics textcolor rgb grey nomirror
set key top left reverse Left textcolor rgb grey samplen 2
set grid lc rgb grey lw 0.3
set logscale xy
set xrange [14000:1.4e6]
set xtics ("17k" 17298, "69k" 69192, "278k" 278258, "1.1M" 1110050)
set yrange [3:400]
set ytics (3, 5, 10, 20, 33, 50, 100, 200, 400)
set xlabel "triangles" textcolor rgb grey
set ylabel "processor time [ms]" textcolor rgb grey
do for [culled = 0:1] {
    set title (culled == 1 ? "backs culled" : "both sides drawn") textcolor rgb grey
    plot rows(culled) using 1:4 with linespoints lc rgb "#e8702a" lw 2.5 pt 7 ps 0.6 title "ours", \
         rows(culled) using 1:($4 + $8) with linespoints lc rgb "#e8702a" lw 1.2 dt 3 pt 6 ps 0.6 title "ours and JPEG", \
         rows(culled) using 1:5 with linespoints lc rgb "#4aa564" lw 2 pt 7 ps 0.6 title "ours without AVX2", \
         rows(culled) using 1:3 with linespoints lc rgb "#3f8fd2" lw 2 dt 2 pt 7 ps 0.6 title "llvmpipe"
}
unset multiplot
