# How each method's first cut and its charts change as a straight shape is rolled up.
set terminal svg size 1000,520 noenhanced font 'system-ui,sans-serif,12' rounded
set datafile separator ','
set border 3 lw 0.8 lc rgb '#555a60'
set tics nomirror out textcolor rgb '#333840'
set output 'bending.svg'
models = "lens hand body"
methods = "spectral pca vsa"
names = "spectral PCA VSA"
colors = "#1a7f4b #b3261e #2f6fb5"
set multiplot layout 2,3 margins 0.07,0.99,0.1,0.92 spacing 0.06,0.12
set xrange [0:330]
set xtics 0,90,330
set grid ytics lw 0.5 lc rgb '#d8dbe0'
set key bottom left reverse Left samplen 2
do for [m = 1:3] {
    set title word(models, m)
    set yrange [0.48:1.02]
    set ylabel (m == 1 ? 'front from back' : '')
    plot for [k = 1:3] 'bending.csv' skip 1 using 3:(strcol(1) eq word(models, m) && strcol(2) eq word(methods, k) ? $5 : 1/0) \
        with linespoints lw 2 pt 7 ps 0.4 lc rgb word(colors, k) title (m == 1 ? word(names, k) : '')
}
unset title
set logscale y 2
set xlabel 'rolled up by [degrees]'
do for [m = 1:3] {
    set yrange [1:*]
    set ylabel (m == 1 ? 'charts' : '')
    plot for [k = 1:3] 'bending.csv' skip 1 using 3:(strcol(1) eq word(models, m) && strcol(2) eq word(methods, k) ? $4 : 1/0) \
        with linespoints lw 2 pt 7 ps 0.4 lc rgb word(colors, k) notitle
}
unset multiplot
