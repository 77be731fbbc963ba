# Charts and seams of each change over those of the base, preset fast.
set terminal svg size 900,560 noenhanced font 'system-ui,sans-serif,12' rounded
set datafile separator ','
set border 1 lw 0.8 lc rgb '#555a60'
set tics nomirror out textcolor rgb '#333840'
set output 'ablations.svg'
set logscale x 2
set xrange [0.45:*]
set yrange [16.8:0.2]
set lmargin 44
set xlabel 'over preset fast'
set grid xtics lw 0.5 lc rgb '#d8dbe0'
set key bottom right
set arrow from 1,graph 0 to 1,graph 1 nohead lw 1.4 lc rgb '#1a7f4b' back
plot 'ratios.csv' skip 1 using 3:1:ytic(2) with points pt 7 ps 0.9 lc rgb '#b3261e' title 'charts, mean', \
     '' skip 1 using 4:1 with points pt 5 ps 0.7 lc rgb '#2f6fb5' title 'seam length, median'
