# Eigenvalues of the hand's facet graph, those whose cuts pass the connectivity filter marked.
set terminal svg size 760,340 font 'system-ui,sans-serif,13' rounded
set datafile separator ','
set key left top Left reverse samplen 1.5
set border 3 lw 0.8 lc rgb '#555a60'
set tics nomirror out textcolor rgb '#333840'
set grid ytics lw 0.5 lc rgb '#d8dbe0'
set xlabel 'eigenvector' textcolor rgb '#333840'
set ylabel 'eigenvalue of D - A' textcolor rgb '#333840'
set xrange [-0.5:29.5]
set yrange [0:*]
do for [name in "hand hand-curled hand-fist corpus-hand"] {
    if (system(sprintf("test -s %s.csv && echo 1 || echo 0", name)) eq '1') {
        set output name.'.svg'
        plot name.'.csv' skip 1 using 1:2 with impulses lw 1 lc rgb '#c5cad1' notitle, \
             '' skip 1 using 1:(stringcolumn(5) eq '0' ? $2 : NaN) with points pt 7 ps 0.7 lc rgb '#8a929c' title 'does not pass', \
             '' skip 1 using 1:(stringcolumn(5) eq '1' ? $2 : NaN) with points pt 7 ps 0.9 lc rgb '#1a7f4b' title 'both sides connected: passes'
    }
}
