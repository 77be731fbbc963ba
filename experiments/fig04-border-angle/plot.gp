# The gradient of the Lagrangian after each drag of 5 degrees and two iterations, and after a release there.
set terminal svg size 760,300 font 'system-ui,sans-serif,13' rounded
set datafile separator ','
set key right top samplen 1.5
set border 3 lw 0.8 lc rgb '#555a60'
set tics nomirror out textcolor rgb '#333840'
set grid ytics lw 0.5 lc rgb '#d8dbe0'
set xlabel 'angle asked [degrees]' textcolor rgb '#333840'
set ylabel '|grad L|' textcolor rgb '#333840'
set logscale y
set format y '1e%T'
set xrange [390:210]
set output 'drags.svg'
plot 'snowflake.csv' skip 2 using 2:3 with linespoints pt 7 ps 0.4 lw 1.6 lc rgb '#2456c8' title 'snowflake', \
     'starfish.csv' skip 2 using 2:3 with linespoints pt 7 ps 0.4 lw 1.6 lc rgb '#1a7f4b' title 'starfish', \
     'hand.csv' skip 2 using 2:3 with linespoints pt 7 ps 0.4 lw 1.6 lc rgb '#c62830' title 'hand', \
     1e-6 lw 1 dt 2 lc rgb '#555a60' title '1e-6', \
     'snowflake.csv' skip 2 using 2:8 with points pt 6 ps 0.4 lc rgb '#2456c8' title 'released', \
     'starfish.csv' skip 2 using 2:8 with points pt 6 ps 0.4 lc rgb '#1a7f4b' notitle, \
     'hand.csv' skip 2 using 2:8 with points pt 6 ps 0.4 lc rgb '#c62830' notitle
