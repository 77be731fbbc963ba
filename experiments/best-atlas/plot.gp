# Seams against stretch; where the time goes.
set terminal svg size 760,420 noenhanced font 'system-ui,sans-serif,12' rounded
set datafile separator ','
set border 3 lw 0.8 lc rgb '#555a60'
set tics nomirror out textcolor rgb '#333840'
set grid lw 0.5 lc rgb '#d8dbe0'
models = "mug fork hand"
colors = "#1a7f4b #b3261e #2f6fb5"
set output 'front.svg'
set logscale x 10
set xlabel 'L2 - 1' textcolor rgb '#333840'
set ylabel 'seams over the root of the area' textcolor rgb '#333840'
set yrange [0:*]
set offsets graph 0.06, graph 0.06, graph 0.1, 0
set key top right samplen 2
plot for [m = 1:3] 'front.csv' skip 1 using ($6 - 1):(strcol(1) eq word(models, m) ? $5 : 1/0) with linespoints lw 2 pt 7 ps 0.6 \
    lc rgb word(colors, m) title word(models, m), \
    '' skip 1 using ($6 - 1):5:3 with labels offset 0,0.9 font ',11' textcolor rgb '#333840' notitle
set output 'timings.svg'
unset logscale
unset xlabel
unset offsets
set ylabel 'CPU seconds' textcolor rgb '#333840'
set key top left reverse Left samplen 1.5
set style data histograms
set style histogram rowstacked
set style fill solid 0.85 noborder
set boxwidth 0.65
set xtics rotate by 40 right
set key outside right center vertical invert
shades = "#d9b8e8 #8a5fb5 #9fd0b4 #1a7f4b #2f6fb5 #86b4e0 #7a4a1e #c98a5a #e0a030 #b3261e #9aa3ad"
stages = "coarsen start guesses cuts balance sewing straighten carry packing check rest"
plot for [s = 4:14] 'timings.csv' skip 1 every 5::2 using s:xtic(1) lc rgb word(shades, s - 3) title word(stages, s - 3)
