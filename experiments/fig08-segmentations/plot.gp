# Charts and seams a mesh needs: preset fast, the paper's settings, the search.
set terminal svg size 1000,620 noenhanced font 'system-ui,sans-serif,12' rounded
set output 'charts.svg'
set datafile separator ','
set border 3 lw 0.8 lc rgb '#555a60'
set tics nomirror out textcolor rgb '#333840'
set grid ytics xtics lw 0.5 lc rgb '#d8dbe0'
set logscale y
set autoscale xfix
set offsets 0.5, 0.5, 0, 0
number(preset, n) = strcol(4) eq '1' && strcol(3) eq preset ? column(n) : NaN # of rows that were made
set multiplot layout 2,1 margins 0.07,0.99,0.17,0.94 spacing 0,0.04
set key at graph 0,1.16 left top horizontal samplen 1
set xtics 1 format ''
set ylabel 'charts' textcolor rgb '#333840'
set yrange [0.8:*]
plot 'segmentations.csv' skip 1 using 1:(number('paper', 6)) with points pt 7 ps 0.7 lc rgb '#8a929c' title 'as the paper', \
     '' skip 1 using 1:(number('fast', 6)) with points pt 7 ps 0.8 lc rgb '#1a7f4b' title 'fast', \
     '' skip 1 using 1:(number('best', 6)) with points pt 5 ps 0.6 lc rgb '#2f6fb5' title 'best'
unset key
set xtics format '%g' rotate by 50 right
set ylabel 'seams / diagonal'
set yrange [0.5:*]
plot 'segmentations.csv' skip 1 using 1:(number('paper', 10)):xtic(2) with points pt 7 ps 0.7 lc rgb '#8a929c', \
     '' skip 1 using 1:(number('fast', 10)) with points pt 7 ps 0.8 lc rgb '#1a7f4b', \
     '' skip 1 using 1:(number('best', 10)) with points pt 5 ps 0.6 lc rgb '#2f6fb5'
unset multiplot
