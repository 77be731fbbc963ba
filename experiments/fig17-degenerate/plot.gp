# The graph of Figure 17 and vectors on it, a panel each.
set terminal svg size 900,430 noenhanced font 'system-ui,sans-serif,13' rounded
set datafile separator ','
set output 'graph.svg'
set multiplot layout 2,3 margins 0.02,0.98,0.03,0.9 spacing 0.04,0.13
unset border
unset tics
unset key
unset colorbox
set xrange [-2.6:2.6]
set yrange [-1.35:1.35]
set palette defined (-1 '#7ea2e8', 0 '#ffffff', 1 '#e58b7e')
set arrow 1 from 0,-1.3 to 0,1.3 nohead lw 1 dt 3 lc rgb '#9aa1a9' back
titles = "'the graph: n = 4' 'printed: v' 'L v, not a multiple of v' 'symmetric, eigenvalue -2' 'antisymmetric, eigenvalue -2' 'corrected: half their sum'"
do for [panel = 0:5] {
    set title word(titles, panel + 1) offset 0,-0.4 textcolor rgb '#333840'
    largest = panel == 2 ? 4.0 : 1.0
    set cbrange [-largest:largest]
    if (panel == 0) {
        plot 'edges.csv' skip 1 using ($1 == 0 ? $2 : NaN):3:4:5 with vectors nohead lw 2.2 lc rgb '#8a929c', \
             '' skip 1 using ($1 == 1 ? $2 : NaN):3:4:5 with vectors nohead lw 3.2 lc rgb '#168c46', \
             'nodes.csv' skip 1 using ($1 == 0 && $5 == 1 ? $3 : NaN):4 with points pt 7 ps 2.4 lc rgb '#265cc8', \
             '' skip 1 using ($1 == 0 && $5 == 2 ? $3 : NaN):4 with points pt 7 ps 2.4 lc rgb '#cd2d28', \
             '' skip 1 using ($1 == 0 ? $3 : NaN):4:(sprintf('%d', $2)) with labels textcolor rgb '#ffffff'
    } else {
        plot 'edges.csv' skip 1 using ($1 == 0 ? $2 : NaN):3:4:5 with vectors nohead lw 1.6 lc rgb '#b3b9c1', \
             '' skip 1 using ($1 == 1 ? $2 : NaN):3:4:5 with vectors nohead lw 2.2 lc rgb '#8cc5a3', \
             'nodes.csv' skip 1 using ($1 == panel ? $3 : NaN):4 with points pt 7 ps 2.9 lc rgb '#555a60', \
             '' skip 1 using ($1 == panel ? $3 : NaN):4:6 with points pt 7 ps 2.6 lc palette, \
             '' skip 1 using ($1 == panel ? $3 : NaN):4:(sprintf('%g', $6)) with labels font ',11' textcolor rgb '#15181c'
    }
}
unset multiplot
