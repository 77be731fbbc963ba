# Numbers of the other methods over those of spectral cuts, and on how many models which is better.
set datafile separator ','
set border 3 lw 0.8 lc rgb '#555a60'
set tics nomirror out textcolor rgb '#333840'
methods = 8
names = "Fiedler PCA 'VSA 2' VSA Iso-charts GPS random best"
colors = "#1a7f8c #b3261e #2f6fb5 #8a5fb5 #b5762f #4c8c2b #777d84 #111418"
settings = "as-cut fast"
rows = "'as cut' 'preset fast'"
row_methods(row) = row == 1 ? methods - 1 : methods # the search stands beside what it starts from

set style fill transparent solid 0.12 border
set style boxplot nooutliers range 0 # the box: middle half of the models and their median
set boxwidth 0.7
beside(m, n) = m + 0.5*(0.618034*n - floor(0.618034*n) - 0.5) # dots side by side
array outputs[3] = ['ratios.svg', 'distortion.svg', 'timings.svg']
array files[3] = ['ratios.csv', 'ratios.csv', 'timings.csv']
array metric_lists[3] = ['charts seam turning', 'l2 angle area', 'seconds']
array title_lists[3] = ["'charts' 'seam length' 'turning'", "'L2 stretch' 'angle s1/s2' 'area ratio'", "'CPU time'"]
do for [figure = 1:3] {
    metrics = metric_lists[figure]
    file = files[figure]
    columns = words(metrics)
    set terminal svg size (columns == 1 ? 480 : 1000),680 noenhanced font 'system-ui,sans-serif,12' rounded
    set output outputs[figure]
    set multiplot layout 2,columns margins (columns == 1 ? 0.15 : 0.075),0.99,0.13,0.94 spacing 0.05,0.06
    set xrange [0.4:methods + 0.6]
    set offsets 0, 0, 0.12, 0.12
    unset key
    set grid ytics lw 0.5 lc rgb '#d8dbe0'
    do for [row = 1:2] {
        do for [column = 1:columns] {
            metric = word(metrics, column)
            set title (row == 1 ? word(title_lists[figure], column) : '') offset 0,-0.4 textcolor rgb '#333840'
            set ylabel (column == 1 ? word(rows, row).': over spectral' : '') offset 1.2,0 textcolor rgb '#333840'
            unset xtics
            if (row == 2) {
                set xtics scale 0 rotate by 50 right
                do for [m = 1:methods] { set xtics add (word(names, m) m) }
            }
            unset ytics
            if (figure == 2) {
                set ytics nomirror out ('0.5' -1, '0.7' log(0.7)/log(2), '0.8' log(0.8)/log(2), \
                    '0.9' log(0.9)/log(2), '1' 0, '1.1' log(1.1)/log(2), '1.2' log(1.2)/log(2), \
                    '1.3' log(1.3)/log(2), '1.5' log(1.5)/log(2), '2' 1, '3' log(3)/log(2))
            } else {
                set ytics nomirror out ('1/64' -6, '1/32' -5, '1/16' -4, '1/8' -3, '1/4' -2, '1/2' -1, '1' 0, '2' 1, \
                    '4' 2, '8' 3, '16' 4, '32' 5, '64' 6, '128' 7, '256' 8)
            }
            if (metric eq 'seam') { set ytics add ('0.7' log(0.7)/log(2), '1.4' log(1.4)/log(2), '2.8' 1.4854) }
            set arrow 1 from 0.4,0 to methods + 0.6,0 nohead lw 1.4 lc rgb '#1a7f4b' back
            n = row_methods(row)
            plot for [m = 1:n] file skip 1 \
                    using (m):(strcol(1) eq word(settings, row) && strcol(2) eq metric && $3 == m ? $5 : NaN) \
                    with boxplot lw 1.2 lc rgb word(colors, m), \
                 for [m = 1:n] file skip 1 \
                    using (beside(m, $0)):(strcol(1) eq word(settings, row) && strcol(2) eq metric && $3 == m ? $5 : NaN) \
                    with points pt 7 ps 0.22 lc rgb word(colors, m)
        }
    }
    unset multiplot
    unset arrow 1
    set offsets 0, 0, 0, 0
}

# Rows of wins.csv: setting, metric, method, three counts.
set terminal svg size 1000,900 noenhanced font 'system-ui,sans-serif,11' rounded
set output 'wins.svg'
set multiplot layout 1,2 margins 0.15,0.985,0.06,0.96 spacing 0.03,0.1
unset grid
unset ylabel
set border 1
set style fill solid 1.0 noborder
shown = "charts seam l2 angle area turning"
shown_titles = "'charts' 'seam' 'stretch' 'angle' 'area' 'turning'"
kinds = words(shown)
gap = 0.6
place(k, m) = (k - 1)*(methods + gap) + m - 1
last = place(kinds, methods)
set yrange [last + 0.6:-0.6]
set xrange [0:*]
set xtics auto scale 0.5 norotate center
set xlabel 'models' textcolor rgb '#333840'
row_of(name) = name eq 'fiedler' ? 1 : name eq 'pca' ? 2 : name eq 'vsa2' ? 3 : name eq 'vsa' ? 4 : \
    name eq 'isocharts' ? 5 : name eq 'embedding' ? 6 : name eq 'random' ? 7 : 8
metric_of(name) = name eq 'charts' ? 1 : name eq 'seam' ? 2 : name eq 'l2' ? 3 : name eq 'angle' ? 4 : \
    name eq 'area' ? 5 : name eq 'turning' ? 6 : NaN
y(s, metric, method, setting) = s eq setting ? place(metric_of(metric), row_of(method)) : NaN
do for [row = 1:2] {
    setting = word(settings, row)
    set title word(rows, row) offset 0,-0.5 textcolor rgb '#333840'
    unset ytics
    if (row == 1) {
        set ytics nomirror scale 0
        do for [k = 1:kinds] {
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
