# Numbers of the other methods over those of spectral cuts, and on how many models which is better.
set terminal svg size 1000,680 noenhanced font 'system-ui,sans-serif,12' rounded
set datafile separator ','
set border 3 lw 0.8 lc rgb '#555a60'
set tics nomirror out textcolor rgb '#333840'
methods = 7
names = "Fiedler PCA 'VSA 2' VSA Iso-charts GPS random"
colors = "#1a7f8c #b3261e #2f6fb5 #8a5fb5 #b5762f #4c8c2b #777d84"
metrics = "charts seam l2 turning seconds"
titles = "'charts' 'seam length' 'L2 stretch' 'turning' 'CPU time'"
settings = "as-cut default"
rows = "'as cut' 'default settings'"

set output 'ratios.svg'
set multiplot layout 2,5 margins 0.075,0.99,0.13,0.94 spacing 0.05,0.06
set style fill transparent solid 0.12 border
set style boxplot nooutliers range 0 # the box: middle half of the models and their median
set boxwidth 0.7
set xrange [0.4:methods + 0.6]
set offsets 0, 0, 0.12, 0.12
unset key
set grid ytics lw 0.5 lc rgb '#d8dbe0'
beside(m, n) = m + 0.5*(0.618034*n - floor(0.618034*n) - 0.5) # dots side by side
do for [row = 1:2] {
    do for [column = 1:5] {
        metric = word(metrics, column)
        file = metric eq 'seconds' ? 'timings.csv' : 'ratios.csv'
        set title (row == 1 ? word(titles, column) : '') offset 0,-0.4 textcolor rgb '#333840'
        set ylabel (column == 1 ? word(rows, row).': over spectral' : '') offset 1.2,0 textcolor rgb '#333840'
        unset xtics
        if (row == 2) {
            set xtics scale 0 rotate by 50 right
            do for [m = 1:methods] { set xtics add (word(names, m) m) }
        }
        unset ytics
        if (metric eq 'l2') {
            set ytics nomirror out ('0.7' log(0.7)/log(2), '0.8' log(0.8)/log(2), '0.9' log(0.9)/log(2), '1' 0, \
                '1.1' log(1.1)/log(2), '1.2' log(1.2)/log(2), '1.3' log(1.3)/log(2), '1.5' log(1.5)/log(2))
        } else {
            set ytics nomirror out ('1/64' -6, '1/32' -5, '1/16' -4, '1/8' -3, '1/4' -2, '1/2' -1, '1' 0, '2' 1, '4' 2, \
                '8' 3, '16' 4, '32' 5, '64' 6, '128' 7)
        }
        set arrow 1 from 0.4,0 to methods + 0.6,0 nohead lw 1.4 lc rgb '#1a7f4b' back
        plot for [m = 1:methods] file skip 1 \
                using (m):(strcol(1) eq word(settings, row) && strcol(2) eq metric && $3 == m ? $5 : NaN) \
                with boxplot lw 1.2 lc rgb word(colors, m), \
             for [m = 1:methods] file skip 1 \
                using (beside(m, $0)):(strcol(1) eq word(settings, row) && strcol(2) eq metric && $3 == m ? $5 : NaN) \
                with points pt 7 ps 0.22 lc rgb word(colors, m)
    }
}
unset multiplot
unset arrow 1
set offsets 0, 0, 0, 0

# Rows of wins.csv: setting, then six numbers, then the methods.
set terminal svg size 1000,620 noenhanced font 'system-ui,sans-serif,11' rounded
set output 'wins.svg'
set multiplot layout 1,2 margins 0.15,0.985,0.08,0.95 spacing 0.03,0.1
unset grid
unset ylabel
set border 1
set style fill solid 1.0 noborder
shown = "charts seam l2 turning"
shown_titles = "'charts' 'seam' 'stretch' 'turning'"
gap = 0.6
place(k, m) = (k - 1)*(methods + gap) + m - 1
last = place(4, methods)
set yrange [last + 0.6:-0.6]
set xrange [0:*]
set xtics auto scale 0.5 norotate center
set xlabel 'models' textcolor rgb '#333840'
row_of(name) = name eq 'fiedler' ? 1 : name eq 'pca' ? 2 : name eq 'vsa2' ? 3 : name eq 'vsa' ? 4 : \
    name eq 'isocharts' ? 5 : name eq 'embedding' ? 6 : 7
metric_of(name) = name eq 'charts' ? 1 : name eq 'seam' ? 2 : name eq 'l2' ? 3 : name eq 'turning' ? 4 : NaN
y(s, metric, method, setting) = s eq setting ? place(metric_of(metric), row_of(method)) : NaN
do for [row = 1:2] {
    setting = word(settings, row)
    set title word(rows, row) offset 0,-0.5 textcolor rgb '#333840'
    unset ytics
    if (row == 1) {
        set ytics nomirror scale 0
        do for [k = 1:4] {
            do for [m = 1:methods] {
                set ytics add ((m == 1 ? word(shown_titles, k).': ' : '').word(names, m) place(k, m))
            }
        }
    }
    at(n) = y(strcol(1), strcol(2), strcol(3), setting)
    plot 'wins.csv' skip 1 using (0):(at(0)):(0):6:(at(0) - 0.4):(at(0) + 0.4) with boxxyerror lc rgb '#1a7f4b', \
         '' skip 1 using (0):(at(0)):6:($6 + $5):(at(0) - 0.4):(at(0) + 0.4) with boxxyerror lc rgb '#c5cad1', \
         '' skip 1 using (0):(at(0)):($6 + $5):($6 + $5 + $4):(at(0) - 0.4):(at(0) + 0.4) with boxxyerror lc rgb '#d98a2b'
}
unset multiplot
