# Charts a mesh needs: default settings against the paper's.
set terminal svg size 900,360 noenhanced font 'system-ui,sans-serif,12' rounded
set output 'charts.svg'
set datafile separator ','
set key left top Left reverse samplen 1.5
set border 3 lw 0.8 lc rgb '#555a60'
set tics nomirror out textcolor rgb '#333840'
set grid ytics lw 0.5 lc rgb '#d8dbe0'
set ylabel 'charts' textcolor rgb '#333840'
set logscale y
set yrange [0.8:*]
set xtics rotate by 40 right
set offsets 0.5, 0.5, 0, 0
# rows alternate: default, paper
plot 'segmentations.csv' skip 1 every 2::1 using (int($0)):4:xtic(1) with points pt 7 ps 0.8 lc rgb '#8a929c' title 'as the paper', \
     '' skip 1 every 2 using (int($0)):4 with points pt 7 ps 0.9 lc rgb '#1a7f4b' title 'default'
