# How far each eigenvector is a function of a lower one.
set terminal svg size 900,420 noenhanced font 'system-ui,sans-serif,12' rounded
set datafile separator ','
set border 3 lw 0.8 lc rgb '#555a60'
set tics nomirror out textcolor rgb '#333840'
set output 'vectors.svg'
set xrange [1.2:29.8]
set yrange [0:1.02]
set xtics 2,3,29
set xlabel 'eigenvector'
set ylabel 'share that is a function of one lower vector'
set grid ytics lw 0.5 lc rgb '#d8dbe0'
set key outside right top
beside(n) = 0.5*(0.618034*n - floor(0.618034*n) - 0.5)
set style fill transparent solid 0.3
plot 'vectors.csv' skip 1 using ($2 + beside($0)):($3 == 0 ? $4 : NaN) with points pt 7 ps 0.35 lc rgb '#c9a09d' title 'filtered out', \
     '' skip 1 using ($2 + beside($0)):($3 == 1 ? $4 : NaN) with points pt 7 ps 0.5 lc rgb '#1a7f4b' title 'passes', \
     'means.csv' skip 1 index 0 using 1:4 with lines lw 2 lc rgb '#b3261e' title 'mean, filtered out', \
     '' index 1 using 1:4 with lines lw 2 lc rgb '#1a7f4b' title 'mean, passes'
