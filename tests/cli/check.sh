#!/usr/bin/env bash
# The program as a user meets it: verbs, exit codes, files whole or not there, the same bytes.
#   tests/cli/check.sh PATH/TO/seamlab
set -u
seamlab=$(cd "$(dirname "$1")" && pwd)/$(basename "$1")
by_hand=$(cd "$(dirname "$0")/../../reports/design" && pwd)/abf-by-hand.md
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch" || exit 1
bad=0

complain() {
    printf '%s\n' "$*"
    bad=1
}

# expect CODE COMMAND...: runs it, its output in out.txt and err.txt.
expect() {
    local code=$1 got
    shift
    "$@" >out.txt 2>err.txt </dev/null
    got=$?
    [ $got = "$code" ] || {
        complain "exit $got, not $code: $*"
        cat err.txt
    }
}

contains() {
    grep -q -- "$2" "$1" || complain "$1 does not say '$2': $(head -c 300 "$1")"
}

no_file() {
    for f in "$@"; do [ ! -e "$f" ] || complain "$f should not be there"; done
}

no_temporaries() {
    local left
    left=$(find . -name '*.tmp*' -o -name '.*.part*' | head -n 3)
    [ -z "$left" ] || complain "left behind: $left"
}

# json FILE: is it valid JSON?
json() {
    command -v python3 >/dev/null || return 0
    python3 -c 'import json, sys; json.load(open(sys.argv[1]))' "$1" || complain "$1 is no JSON"
}

# --- help and usage
expect 0 "$seamlab" --help
contains out.txt unwrap
expect 0 "$seamlab" --version
expect 2 "$seamlab"
expect 2 "$seamlab" sing
for verb in unwrap edit replay check measure pack compare overlap segment spectrum abf render theorem demo; do
    expect 0 "$seamlab" $verb --help
    contains out.txt 'Examples:'
    expect 2 "$seamlab" $verb --no-such-option
    contains err.txt 'unknown option'
done
expect 2 "$seamlab" unwrap
for verb in unwrap pack "edit log" "replay log" view abf; do
    expect 2 "$seamlab" ${verb% *} a.obj ${verb#"${verb% *}"} -o b.off
    contains err.txt 'cannot hold UVs'
    contains err.txt "try: seamlab ${verb% *} --help"
done
expect 2 "$seamlab" pack a.obj
contains err.txt 'OUT is missing'
expect 2 "$seamlab" unwrap a.obj -o b.obj --rule sideways
contains err.txt 'longest|length-lambda|lookahead'
expect 2 "$seamlab" unwrap a.obj -o b.obj --max-stretch 0.5
expect 2 "$seamlab" unwrap a.obj -o b.obj --seams x --labels y
expect 2 "$seamlab" demo --model elephant-and-castle

# --- the demo makes a mesh to go on with
expect 0 "$seamlab" demo -o demo --quiet
for f in hand.obj hand.atlas.json both.png model.png atlas.png; do [ -s demo/$f ] || complain "demo/$f is missing"; done
[ ! -s out.txt ] && [ ! -s err.txt ] || complain "--quiet was not"
head -c 8 demo/both.png | od -An -tx1 | grep -q '89 50 4e 47 0d 0a 1a 0a' || complain "both.png is no PNG"
mesh=demo/hand.obj

# --- pictures
is_jpeg() { head -c 3 "$1" | od -An -tx1 | grep -q 'ff d8 ff'; }
expect 0 "$seamlab" render $mesh -o atlas.png --size 160x80 --quiet
[ -s atlas.png ] || complain "render wrote no picture"
expect 0 "$seamlab" render $mesh -o atlas2.png --size 160x80 --quiet --threads 3
cmp -s atlas.png atlas2.png || complain "a picture depends on the number of threads"
expect 0 "$seamlab" render $mesh -o model.jpg --view 3d --camera front --size 120x90 --show seams,stretch --quiet
is_jpeg model.jpg || complain "model.jpg is no JPEG"
expect 0 "$seamlab" render $mesh -o uv.png --view uv --size 90x90 --show overlap,checker --quiet
expect 0 "$seamlab" render $mesh -o vector.png --view 3d --size 90x90 --show eigenvector=2 --quiet
expect 0 "$seamlab" render $mesh -o mirror.png --view 3d --size 90x90 --show symmetry --quiet
expect 0 "$seamlab" render $mesh -o cloth.png --size 120x60 --texture model.jpg --tiles 3 --quiet
printf 'v 0 0 0\nv 1 0 0.2\nv 1 1 0\nv 0 1 0\nv 0.3 2 0.4\nv 1.4 2 0\nvt 0 0\nvt .5 0\nvt .5 .5\nvt 0 .5\nvt .1 .1\nvt .4 .2\n' >thumbs.obj
printf 'f 1/1 2/2 3/3 4/4\nf 4/4 3/3 6/6 5/5\n' >>thumbs.obj
expect 0 "$seamlab" render thumbs.obj -o thumbs.png --size 80x40 --show overlap,seams
contains err.txt '4 of 4 triangles overlap'
printf '3 2\n' >lines.txt
expect 0 "$seamlab" render thumbs.obj -o lines.png --size 80x40 --constraints lines.txt --quiet
printf '0 4\n' >lines.txt
expect 3 "$seamlab" render thumbs.obj -o no.png --size 80x40 --constraints lines.txt --quiet
# Sizes and UVs out of the ordinary.
expect 0 "$seamlab" render $mesh -o point.png --size 1x1 --quiet
expect 0 "$seamlab" render $mesh -o wide.png --view 3d --size 16384x1 --samples 1 --no-shadows --quiet
expect 0 "$seamlab" render $mesh -o high.png --view uv --size 1x16384 --samples 1 --quiet
expect 0 "$seamlab" overlap $mesh --resolution 1
expect 0 "$seamlab" overlap $mesh --resolution 16384
expect 2 "$seamlab" overlap $mesh --resolution 16385
expect 2 "$seamlab" render $mesh -o no.png --size 16385x1
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 1\nvt %s 0\nvt 1 0\nvt 0 1\nvt 1 1\nf 1/1 2/2 3/3\nf 2/2 4/4 3/3\n' nan >nan.obj
sed 's/vt nan 0/vt 1e9 -1e12/' nan.obj >far.obj
grep -v '^f' nan.obj >points.obj
expect 3 "$seamlab" overlap nan.obj
expect 0 "$seamlab" render nan.obj -o nan.png --size 40x20
expect 0 "$seamlab" overlap far.obj --exact
expect 0 "$seamlab" render far.obj -o far.png --size 40x20
expect 3 "$seamlab" overlap points.obj
expect 3 "$seamlab" render points.obj -o no.png
expect 0 "$seamlab" segment $mesh --animate splits.png --quiet
grep -qa acTL splits.png && grep -qa fdAT splits.png || complain "splits.png is no animation"
expect 2 "$seamlab" segment $mesh --animate splits.gif
expect 0 "$seamlab" abf $mesh --animate solve.png --quiet
grep -qa acTL solve.png && grep -qa fdAT solve.png || complain "solve.png is no animation"
expect 2 "$seamlab" abf $mesh --animate solve.gif
expect 0 "$seamlab" render $mesh -o seen.png --view 3d --size 90x90 --show visibility --quiet
expect 0 "$seamlab" render $mesh -o cost.png --view 3d --size 90x90 --show seams,seamcost --quiet
cmp -s seen.png cost.png && complain "visibility and seamcost show the same"
expect 2 "$seamlab" render $mesh -o no.png --show visibility,seamcost
expect 2 "$seamlab" render $mesh
expect 2 "$seamlab" render $mesh -o no.gif
expect 2 "$seamlab" render $mesh -o no.png --size 0x9
expect 2 "$seamlab" render $mesh -o no.png --camera up
expect 2 "$seamlab" render $mesh -o no.png --show seams,glitter
contains err.txt glitter
expect 2 "$seamlab" render $mesh -o no.png --show stretch,charts
expect 2 "$seamlab" render $mesh -o no.png --show constraints
expect 3 "$seamlab" render $mesh -o no.png --texture no-such-picture.png
expect 3 "$seamlab" render no-such-mesh.obj -o no.png
expect 1 "$seamlab" render $mesh -o no/folder/no.png --size 20x10
no_file no.gif no.png

# --- unwrap: same bytes for any number of threads and over runs; sidecar beside it
for n in 1 2 5; do
    expect 0 "$seamlab" unwrap $mesh -o uv$n.obj --threads $n
done
expect 0 "$seamlab" unwrap $mesh -o again.obj --threads 2
for n in 2 5; do
    cmp -s uv1.obj uv$n.obj && cmp -s uv1.atlas.json uv$n.atlas.json || complain "other bytes with $n threads"
done
cmp -s uv2.obj again.obj && cmp -s uv2.atlas.json again.atlas.json || complain "other bytes on a second run"
contains uv1.atlas.json '"passed":true'
expect 0 "$seamlab" unwrap $mesh -o uv.ply --json
contains out.txt '"certified":true'
expect 0 "$seamlab" unwrap uv.ply -o back.ply --quiet
expect 0 "$seamlab" unwrap $mesh -o paper.obj --preset paper
contains paper.atlas.json '"rule":"longest"'
contains paper.atlas.json '"energy":"unweighted"'
expect 0 "$seamlab" unwrap $mesh -o best.obj --preset best --target-stretch 1.04 --target-angle 1.15 --threads 2
contains best.atlas.json '"passed":true'
contains best.atlas.json '"failed":0'
contains best.atlas.json '"missed":0'
contains best.atlas.json '"target_stretch":1.04'
expect 0 "$seamlab" unwrap $mesh -o length.obj --preset best --weights off --weight-crease 0.9
contains length.atlas.json '"weights":{"crease":0'
contains best.atlas.json '"weights":{"crease":0.6'
for part in crease concave hidden loops; do
    expect 2 "$seamlab" unwrap $mesh -o bad.obj --preset best --weight-$part 1.5
done
expect 2 "$seamlab" unwrap $mesh -o bad.obj --preset best --weights some
expect 0 "$seamlab" unwrap $mesh -o paper2.obj --preset paper --weights off
cmp -s paper.obj paper2.obj || complain "weights change the preset paper"
expect 0 "$seamlab" segment $mesh --preset best --protect first --json
contains out.txt '"invalid":0'
expect 0 "$seamlab" front $mesh --targets 1.3,1.1 -o front.svg --json
contains out.txt '"reached": true'
contains front.svg '</svg>'
expect 2 "$seamlab" front $mesh --targets 1.1,1.3
expect 2 "$seamlab" front $mesh --targets 0.5
expect 2 "$seamlab" front $mesh --targets 1.1 -o front.png
expect 3 "$seamlab" front no-such.obj
expect 2 "$seamlab" view $mesh -o out.off
expect 3 "$seamlab" view no-such.obj
expect 0 "$seamlab" unwrap $mesh -o override.obj --sew on --preset paper
contains override.atlas.json '"sew":true'
for rule in longest length-lambda lookahead; do
    expect 0 "$seamlab" unwrap $mesh -o rule.obj --rule $rule --sew off
done
expect 0 "$seamlab" unwrap $mesh -o preview.obj --preview pictures/
[ -s pictures/both.png ] || complain "no preview"
expect 0 "$seamlab" unwrap $mesh -o - --quiet
contains out.txt '^vt '

# --- abf: the worked example of reports/design/abf-by-hand.md, constraints, what cannot be, what is no disk
printf 'v 0 0 1\nv 2 0 0\nv 1 1 0\nv 0 2 0\nv -1 1 0\nv -2 0 0\nv -1 -1 0\nv 0 -2 0\nv 1 -1 0\n' >tent.obj
printf 'f 1 %d %d\n' 2 3 3 4 4 5 5 6 6 7 7 8 8 9 9 2 >>tent.obj
expect 0 "$seamlab" abf tent.obj --report tent.html --trace tent.json
contains out.txt 'converged after 1 iteration'
contains out.txt '0.02493134'
contains out.txt '2.074'
contains tent.html 'sl_abf_eval_g2'
contains tent.html 'data-name="iteration 1"'
contains tent.html 'largest change of an angle'
contains tent.html 'prefers-color-scheme:dark'
cat out.txt tent.html >by-hand.txt
json tent.json
expect 0 "$seamlab" abf tent.obj --json
cmp -s out.txt tent.json || complain "abf --json and --trace differ"
expect 0 "$seamlab" abf tent.obj --rectangle 1,3,5,7 --pin 1=0,0 --pin 3=1,0 --step
contains out.txt '0.10328194'
cat out.txt >>by-hand.txt
grep -o '[*][*][^*]*[*][*]' "$by_hand" | tr -d '*' >numbers.txt
[ "$(wc -l <numbers.txt)" -ge 12 ] || complain "abf-by-hand.md has lost its numbers"
while read -r number; do
    contains by-hand.txt "$number"
done <numbers.txt
expect 0 "$seamlab" abf tent.obj --angle 1=90 --straight 1,2,3 --right-angle 8 --wheel ratio --newton exact
expect 0 "$seamlab" abf tent.obj --wheel product --energy unweighted --quiet
[ ! -s out.txt ] || complain "abf --quiet was not"
expect 4 "$seamlab" abf tent.obj --angle 1=400
contains err.txt 'vertex 1'
expect 4 "$seamlab" abf tent.obj --angle 1=100 --iterations 0
expect 4 "$seamlab" abf tent.obj --angle 1=340 --trace short.json # within its triangles, but not within reach
contains out.txt 'stopped short of the targets'
contains out.txt 'degrees are left at the worst vertex'
contains out.txt 'back to the last valid state'
contains short.json '"reached":0.8'
contains short.json '"borderCrossings":0'
json short.json
expect 4 "$seamlab" abf tent.obj --angle 1=340 --iterations 30
contains out.txt 'stalled'
expect 4 "$seamlab" abf tent.obj --angle 1=350 --angle 2=350
contains err.txt 'together'
contains err.txt 'vertices 1, 2'
expect 0 "$seamlab" abf tent.obj --straight 1,5 -o flat.obj
contains err.txt 'the shortest way has 3 vertices, 1,0,5'
expect 0 "$seamlab" measure flat.obj --json
contains out.txt '"flip":0'
expect 0 "$seamlab" abf tent.obj --pin 1=3,4 --pin 5=3,6 -o pinned.ply --quiet
expect 2 "$seamlab" abf tent.obj --straight 1,2 # an edge is straight as it is
expect 2 "$seamlab" abf tent.obj -o flat.off
awk 'BEGIN { for (i = 0; i <= 60; i++) for (r = 1; r <= 1.5; r += 0.25) { a = 8.17 * i / 60
    printf "v %.9f %.9f %.9f\n", r * cos(a), r * sin(a), 0.05 * a }
    for (i = 0; i < 60; i++) for (k = 1; k <= 2; k++) { c = 3 * i + k; print "f", c, c + 1, c + 4, c + 3 } }' >ramp.obj
expect 0 "$seamlab" abf ramp.obj # more than a turn, unrolled
contains out.txt 'overlaps itself'
if command -v script >/dev/null; then # a terminal, and the end of input that quits before it converges
    expect 0 script -qec "$seamlab abf tent.obj --angle 1=100 --step" /dev/null
    expect 4 script -qec "$seamlab abf tent.obj --angle 1=100 --step --strict" /dev/null
fi
expect 3 "$seamlab" abf tent.obj --angle 77=90
contains err.txt 'no vertex 77'
expect 2 "$seamlab" abf tent.obj --angle 1
expect 2 "$seamlab" abf tent.obj --rectangle 1,3,5
expect 2 "$seamlab" abf tent.obj --pin 1=0,0 --pin 2=1,0 --pin 3=1,1
expect 0 "$seamlab" abf $mesh --quiet --trace hand.json -o hand-part.obj
contains hand-part.obj '^vt '
json hand.json
expect 0 "$seamlab" abf $mesh --chart 1
contains err.txt 'is no disk'
expect 3 "$seamlab" abf $mesh --chart 100000
contains err.txt 'there is no chart'

# --- warnings, --strict, and a cap that leaves nothing to deliver
expect 0 "$seamlab" demo sphere -o ball --quiet
few='--max-charts 2 --max-stretch 1.01 --preset fast --sew off --minimise off --symmetry off'
expect 0 "$seamlab" unwrap ball/sphere.obj -o capped.obj $few
contains err.txt 'warning: chart'
contains capped.atlas.json 'above the bound'
expect 4 "$seamlab" unwrap ball/sphere.obj -o capped.obj $few --strict
expect 6 "$seamlab" unwrap ball/sphere.obj -o never.obj --max-charts 1
contains err.txt 'max-charts'
no_file never.obj never.atlas.json

# --- symmetry: shared where exact, by default; declared in the sidecar, and only there no overlap
expect 0 "$seamlab" demo --model body -o body --quiet
for n in 1 2; do
    expect 0 "$seamlab" unwrap body/body.obj -o shared$n.obj --threads $n
    contains err.txt 'shares\? \(its\|their\) texture: 50 %'
done
cmp -s shared1.obj shared2.obj && cmp -s shared1.atlas.json shared2.atlas.json || complain "sharing: other bytes with 2 threads"
contains shared1.atlas.json '"schema": 2'
contains shared1.atlas.json '"mirrored":true,"kind":"exact"'
contains shared1.atlas.json '"texture_memory_saved":0.5'
json shared1.atlas.json
expect 0 "$seamlab" measure shared1.obj
contains out.txt 'flipped 0 .*overlap inside 0.00000, across 0.00000'
contains out.txt '[1-9][0-9]* chart\( is a copy\|s are copies\)'
expect 0 "$seamlab" check shared1.obj
contains out.txt 'by its sidecar .* [1-9][0-9]* of them \(a copy\|copies\)'
cp shared1.obj orphan.obj
expect 0 "$seamlab" measure orphan.obj --json
contains out.txt '"copies":0'
! grep -q '"ovIn":0.0,' out.txt || complain "without its sidecar a shared atlas measures as free of overlap"
cp uv1.atlas.json orphan.atlas.json
expect 0 "$seamlab" measure orphan.obj
contains err.txt 'another number of facets'
for options in '--symmetry off' '--unshare'; do
    expect 0 "$seamlab" unwrap body/body.obj -o apart.obj $options --json
    contains out.txt '"copies":0'
    rm apart.atlas.json
    expect 0 "$seamlab" measure apart.obj
    contains out.txt 'flipped 0 .*overlap inside 0.00000, across 0.00000'
done
expect 0 "$seamlab" unwrap body/body.obj -o halves.obj --preset paper --json
contains halves.atlas.json '"symmetry":"halves"'
expect 0 "$seamlab" unwrap $mesh -o lone.obj --symmetry exact
contains err.txt 'no exact symmetry'
expect 4 "$seamlab" unwrap $mesh -o lone.obj --symmetry exact --strict
expect 2 "$seamlab" unwrap $mesh -o lone.obj --symmetry perfect
contains err.txt 'auto|off|exact|near'

# --- overlap
expect 0 "$seamlab" overlap uv1.obj --exact --png counts.png --json
json out.txt
contains out.txt '"overlap":false'
head -c 8 counts.png | od -An -tx1 | grep -q '89 50 4e 47 0d 0a 1a 0a' || complain "counts.png is no PNG"
expect 0 "$seamlab" overlap shared1.obj --exact
contains out.txt 'by intent'
expect 5 "$seamlab" overlap orphan.obj --exact
expect 5 "$seamlab" overlap orphan.obj --resolution 512 --json
contains out.txt '"overlap":true'
cat >crossing.obj <<'EOF'
v 0 0 0
v 1 0 0
v 1 1 0
v 2 0 1
v 3 0 1
v 3 1 1
vt 0.1 0.1
vt 0.5 0.1
vt 0.50001 0.50002
vt 0.5 0.5
vt 0.9 0.4
vt 0.8 0.9
f 1/1 2/2 3/3
f 4/4 5/5 6/6
EOF
expect 0 "$seamlab" overlap crossing.obj --resolution 256
expect 5 "$seamlab" overlap crossing.obj --resolution 256 --exact
contains out.txt 'facets 1 and 2'
sed 's/vt 0.9 0.4/vt nan 0.4/' crossing.obj >nan.obj
expect 3 "$seamlab" overlap nan.obj
sed 's/vt 0.9 0.4/vt 1e308 -1e308/' crossing.obj >far.obj
expect 0 "$seamlab" overlap far.obj --resolution 64 --json
json out.txt
expect 3 "$seamlab" overlap $mesh.no
expect 3 "$seamlab" overlap demo/no-such-file.obj
expect 2 "$seamlab" overlap crossing.obj --resolution 0
expect 1 "$seamlab" overlap crossing.obj --png no/folder/counts.png

# a ramp of 1.6 turns as one chart: with ABF++ alone it covers itself
awk 'BEGIN {
    for (s = 0; s <= 80; s++) for (k = 0; k < 3; k++) {
        t = s * 0.12566; r = 1 + 0.2 * k + 0.01 * sin(7 * s + k)
        printf "v %.9f %.9f %.9f\n", r * cos(t), r * sin(t), 0.06 * t
    }
    for (s = 0; s < 80; s++) for (k = 1; k < 3; k++) printf "f %d %d %d %d\n", 3*s+k, 3*s+k+1, 3*s+k+4, 3*s+k+3
}' >ramp.obj
awk 'BEGIN { for (f = 0; f < 160; f++) print 7 }' >ramp.txt
expect 0 "$seamlab" unwrap ramp.obj -o simple.obj --labels ramp.txt
expect 0 "$seamlab" overlap simple.obj --exact
expect 5 "$seamlab" unwrap ramp.obj -o twice.obj --labels ramp.txt --tutte off --minimise off
no_file twice.obj twice.atlas.json
expect 0 "$seamlab" unwrap ramp.obj -o twice.obj --labels ramp.txt --tutte off --minimise off --allow-overlap
contains err.txt uncertified
contains twice.atlas.json '"passed":false'
expect 5 "$seamlab" overlap twice.obj

# --- measure
expect 0 "$seamlab" measure uv1.obj
contains out.txt 'flipped 0'
expect 0 "$seamlab" measure uv1.obj uv.ply --json
[ "$(wc -l <out.txt)" = 2 ] || complain "measure --json: not a line a file"
sed -n 1p out.txt | sed 's/uv1.obj//' >one.txt
sed -n 2p out.txt | sed 's/uv.ply//' >two.txt
cmp -s one.txt two.txt || complain "OBJ and PLY of one atlas measure differently"
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >bare.obj
expect 3 "$seamlab" measure bare.obj
contains err.txt 'no UVs'

# --- pack: the same bytes for any number of threads, what is shared stays shared, tiles, refusals
for t in 1 5; do
    expect 0 "$seamlab" pack uv1.obj -o packed$t.obj --effort 6 --threads $t --resolution 256
done
contains err.txt 'proven 4 apart'
cmp -s packed1.obj packed5.obj || complain "pack depends on the number of threads"
json packed1.atlas.json
expect 0 "$seamlab" overlap packed1.obj --exact
expect 0 "$seamlab" pack shared1.obj -o packed.obj --effort 0 --json
contains out.txt '"certified":true'
copies=$(sed 's/.*"copies":\([0-9]*\).*/\1/' out.txt)
[ "$copies" -gt 0 ] || complain "pack parts charts that share a place"
expect 0 "$seamlab" measure packed.obj --json
contains out.txt "\"copies\":$copies,"
expect 0 "$seamlab" pack packed.obj -o tiles.obj --effort 0 --density 3 --resolution 64 --margin 1 --pages 90 --json
contains out.txt '"texelsAUnit":3.0'
expect 4 "$seamlab" pack packed.obj -o none.obj --density 1e9
contains err.txt 'at that density'
expect 3 "$seamlab" pack bare.obj -o none.obj
contains err.txt 'no UVs to pack'
expect 2 "$seamlab" pack uv1.obj
expect 2 "$seamlab" pack uv1.obj -o none.off
expect 2 "$seamlab" pack uv1.obj -o none.obj --rotations left

# --- front: an axis is a seam, though both its sides have the same UVs
expect 0 "$seamlab" front ball/sphere.obj --targets 1.1
! grep -q ' 0\.000 ' out.txt || complain "front does not count the axis as a seam: $(cat out.txt)"

# --- unwrap onto pages: the density asked for, copies where their sources are, every page checked
expect 0 "$seamlab" unwrap body/body.obj -o unwrapped.obj --preset fast --density 14 --resolution 256 --margin 1 --pages 9 --json
contains out.txt '"certified":true.*"pages":1,"texelsAUnit":14.0,"copies":3'
expect 0 "$seamlab" measure unwrapped.obj --json
contains out.txt '"ovIn":0.0,"ovX":0.0,"copies":3,'
expect 0 "$seamlab" unwrap ball/sphere.obj -o unwrapped.obj --preset fast --symmetry off --max-stretch 1.02 --density 100 --resolution 256 --margin 1 --pages 9
contains err.txt 'on 4 pages, 100 texels a unit'
contains unwrapped.atlas.json '"page":3,'
json unwrapped.atlas.json
expect 0 "$seamlab" overlap unwrapped.obj --exact
expect 4 "$seamlab" unwrap body/body.obj -o none.obj --density 1e9 --pages 2
contains err.txt '2 pages of 2048 x 2048 texels at that density'
expect 2 "$seamlab" unwrap body/body.obj -o none.obj --pages 0
expect 2 "$seamlab" unwrap body/body.obj -o none.obj --density -1
no_file none.obj none.off none.atlas.json

# --- seams of one's own: segment writes what unwrap reads
expect 0 "$seamlab" segment $mesh --labels labels.csv --seams seams.csv -o charts.ply
contains labels.csv '^facet,chart$'
expect 0 "$seamlab" unwrap $mesh -o l.obj --labels labels.csv
expect 0 "$seamlab" unwrap $mesh -o s.obj --seams seams.csv
expect 0 "$seamlab" unwrap uv1.obj -o k.obj --keep-seams
for f in l.obj s.obj k.obj; do
    "$seamlab" measure $f --json | grep -o '"charts":[0-9]*' >charts.txt
    "$seamlab" measure uv1.obj --json | grep -o '"charts":[0-9]*' | cmp -s - charts.txt || complain "$f has other charts"
done
expect 3 "$seamlab" unwrap $mesh -o x.obj --labels /dev/null
expect 3 "$seamlab" unwrap $mesh -o x.obj --labels bare.obj
contains err.txt 'bare.obj:2'
expect 3 "$seamlab" unwrap $mesh -o x.obj --seams missing.csv
expect 3 "$seamlab" unwrap bare.obj -o x.obj --keep-seams
printf '0 1\n' >one-edge.csv
expect 0 "$seamlab" demo --model torus -o ring --quiet
expect 4 "$seamlab" unwrap ring/torus.obj -o x.obj --seams one-edge.csv
contains err.txt 'genus 1'
no_file x.obj x.atlas.json

# --- segment and spectrum
expect 0 "$seamlab" segment $mesh
contains out.txt '^0,'
expect 0 "$seamlab" segment $mesh --json --preset paper
contains out.txt '"invalid":0'
for method in pca fiedler 'random --seed 7' isocharts 'embedding --clusters 5' vsa 'vsa --vsa-regions 6' 'vsa --vsa-error 0.5'; do
    # shellcheck disable=SC2086
    expect 0 "$seamlab" segment $mesh --json --method $method
    contains out.txt '"invalid":0'
done
expect 2 "$seamlab" segment $mesh --method voronoi
contains err.txt 'spectral|pca|vsa|fiedler|random|isocharts|embedding'
expect 2 "$seamlab" segment $mesh --method vsa --vsa-error -1
expect 0 "$seamlab" unwrap $mesh -o vsa.obj --method vsa --vsa-regions 5
expect 0 "$seamlab" spectrum $mesh --vectors 8 -o v.csv
contains out.txt passes
contains v.csv '^facet,v0,v1'
expect 0 "$seamlab" spectrum $mesh --vectors 8 -o v.ply --json
contains out.txt '"converged":true'

# Bands give what one run gives; each pair is certified and held to the tolerance asked for.
expect 0 "$seamlab" spectrum $mesh --vectors 120 --tolerance 1e-10
cut -c 1-20 out.txt >one-run.txt
contains err.txt 'certified complete'
expect 0 "$seamlab" spectrum $mesh --vectors 120 --tolerance 1e-10 --bands
cut -c 1-20 out.txt | cmp -s - one-run.txt || complain 'bands and a single run give different eigenvalues'
expect 0 "$seamlab" spectrum $mesh --vectors 120 --bands --json
contains out.txt '"certified":true'
contains out.txt '"bands":'
json out.txt
expect 0 "$seamlab" spectrum $mesh --signs --json
contains out.txt '"certified":true'
contains out.txt '"memory_estimate":[1-9]'
contains out.txt '"solves":[1-9]'
expect 0 "$seamlab" spectrum $mesh --memory-limit 2G
expect 6 "$seamlab" spectrum $mesh --memory-limit 100k -o limited.csv
contains err.txt 'memory-limit'
no_file limited.csv
expect 6 "$seamlab" unwrap $mesh -o limited.obj --symmetry off --memory-limit 100k
contains err.txt 'memory-limit'
no_file limited.obj limited.atlas.json
expect 2 "$seamlab" spectrum $mesh --signs --bands
for option in '--tolerance 1e-15' '--tolerance 1' '--memory-limit 2X' '--memory-limit G' '--memory-limit -1G' '--memory-limit nan' '--bands=on'; do
    expect 2 "$seamlab" spectrum $mesh $option
done

# --- theorem: holds, is seen to fail, replays, refuses
expect 0 "$seamlab" theorem --graphs 240
contains out.txt 'every statement holds'
expect 0 "$seamlab" theorem --graphs 240 --threads 1 --tap
contains out.txt '^TAP version 13$'
contains out.txt '^ok .*figure-17'
[ "$(grep -c '^ok ' out.txt)" = "$(sed -n 's/^1\.\.//p' out.txt)" ] || complain "the TAP plan is not what was printed"
mv out.txt one.txt
expect 0 "$seamlab" theorem --graphs 240 --threads 3 --tap
cmp -s one.txt out.txt || complain "theorem: other bytes with 3 threads"
expect 0 "$seamlab" theorem --graphs 240 --json
json out.txt
contains out.txt '"schema":1'
contains out.txt '"violated":false'
for what in graph vector sign; do
    rm -f theorem-7-0.graph
    expect 5 "$seamlab" theorem --graphs 24 --seed 7 --break $what --tap
    contains out.txt '^not ok '
    [ -s theorem-7-0.graph ] || complain "no replay file after --break $what"
    [ $what = graph ] && cp theorem-7-0.graph broken.graph
done
expect 5 "$seamlab" theorem --graph broken.graph
contains out.txt VIOLATED
expect 0 "$seamlab" theorem --graph theorem-7-0.graph
sed 's/^edges .*/edges 9999/' broken.graph >short.graph
expect 3 "$seamlab" theorem --graph short.graph
contains err.txt 'short.graph:[0-9]'
expect 3 "$seamlab" theorem --graph no-such.graph
expect 3 "$seamlab" theorem --mesh no-such.obj
expect 2 "$seamlab" theorem --mesh
expect 2 "$seamlab" theorem --tap --json
expect 0 "$seamlab" theorem --mesh ball/sphere.obj ring/torus.obj --json
json out.txt
contains out.txt '"name":"basis","verdict":"holds"'
printf 'v 0 0 0\nv 2 0 0\nv 0 1 0\nv 3 3 1\nv 5 1 0\nv 6 4 1\nf 1 2 3\nf 2 4 3\nf 2 5 6 4\n' >odd.obj
expect 0 "$seamlab" theorem --mesh odd.obj --tap
contains out.txt '# SKIP no mirror'

# --- check
expect 0 "$seamlab" check $mesh --strict
contains out.txt 'nothing to repair'
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 -1 0\nf 1 2 3\nf 1 2 4\nf 2 1 5\nf 3 3 1\nf 2 3 1\n' >dirty.obj
expect 0 "$seamlab" check dirty.obj
contains out.txt 'non-manifold edges'
expect 4 "$seamlab" check dirty.obj --strict
expect 0 "$seamlab" check dirty.obj --json
contains out.txt '"duplicate_facets":\[4\]'
expect 0 "$seamlab" unwrap dirty.obj -o dirty-uv.obj

# --- hostile input: exit 3, a line that names the place, no output
hostile() {
    printf "$2" >"$1"
    expect 3 "$seamlab" unwrap "$1" -o hostile-out.obj
    contains err.txt "$3"
    no_file hostile-out.obj hostile-out.atlas.json
}
hostile empty.obj '' 'empty.obj'
hostile range.obj 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 7\n' 'range.obj:4'
hostile nan.obj 'v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' 'nan.obj:1'
hostile short.obj 'v 0 0 0\nv 1 0 0\nf 1 2\n' 'short.obj:3'
hostile lies.ply 'ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n' 'lies.ply'
hostile lies.off 'OFF\n2000000000 2000000000 0\n0 0 0\n' 'lies.off'
head -c 4096 /dev/urandom >noise.ply
expect 3 "$seamlab" check noise.ply
expect 3 "$seamlab" check no-such-file.obj
expect 3 "$seamlab" check .
contains err.txt '.'

# --- magnitudes: 1e-30 to 1e30
for scale in 1e-30 1e30; do
    awk -v s=$scale '$1 == "v" { printf "v %.17g %.17g %.17g\n", $2 * s, $3 * s, $4 * s; next } { print }' ball/sphere.obj >scaled.obj
    expect 0 "$seamlab" unwrap scaled.obj -o scaled-uv.obj
done

# --- hostile options: what cannot be is said, nothing is written under a wrong name
expect 4 "$seamlab" unwrap bare.obj -o wide.obj --margin 1024 --resolution 64
contains err.txt 'do not fit'
no_file wide.obj wide.atlas.json
expect 2 "$seamlab" segment $mesh -o charts.obj
contains err.txt '.ply'
expect 2 "$seamlab" spectrum $mesh -o vectors.gif
no_file charts.obj vectors.gif
for option in '--vectors 1' '--margin nan' '--max-stretch inf' '--smooth -1' '--threads 1.5' '--quiet=1' '--join=maybe'; do
    expect 2 "$seamlab" unwrap $mesh -o x.obj $option
done
expect 0 "$seamlab" unwrap bare.obj -o small.obj --vectors 200 --threads 64 --resolution 16 --margin 0
expect 3 "$seamlab" measure small.obj bare.obj
contains err.txt 'bare.obj'

# --- meshes without extent, of one facet, bent, repeated
printf 'v 1 2 3\nv 1 2 3\nv 1 2 3\nf 1 2 3\nf 3 2 1\n' >point.obj
expect 0 "$seamlab" unwrap point.obj -o point-uv.obj --json
! grep -qi nan out.txt point-uv.atlas.json || complain "a mesh of one point has nan in its figures"
json out.txt
json point-uv.atlas.json
printf 'v 0 0 0\nv 2 0.9 0\nv 0 2 0.1\nv 0.7 1 0\nv 3 1 1\nf 2 3 4 1\nf 1 2 5\nf 1 2 5\n' >chevron.obj
expect 0 "$seamlab" unwrap chevron.obj -o chevron-uv.obj
expect 0 "$seamlab" measure chevron-uv.obj
contains out.txt 'flipped 0'

# --- in and out through pipes, over itself, through a link; names and materials stay
"$seamlab" unwrap - -o - --quiet <bare.obj | grep -q '^vt ' || complain "no atlas through a pipe"
cp chevron.obj self.obj
expect 0 "$seamlab" unwrap self.obj -o self.obj
cmp -s self.obj chevron-uv.obj || complain "another result when the output is the input"
printf '# kept\nmtllib a.mtl\no Thing\nv 0 0 0\nv 1 0 0\nv 1 1 0.2\nv 0 1 0\nvn 0 0 1\ng one two\nusemtl red\ns 1\nf 1//1 2//1 3//1 4//1\n' >named.obj
expect 0 "$seamlab" unwrap named.obj -o named-uv.obj
grep -v '^vt' named-uv.obj | sed -E 's|/[0-9]+/|//|g' | cmp -s - named.obj || complain "names or materials were lost"
printf 'v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt -3 -2\nvt 998 -2\nvt 998 7\nvt -3 7\nf 1/1 2/2 3/3 4/4\n' >pages.obj
expect 0 "$seamlab" measure pages.obj
expect 0 "$seamlab" unwrap pages.obj -o pages-uv.obj --keep-seams

# --- a full disk and an unwritable folder leave nothing behind
if [ -w /dev/full ]; then
    for words in "segment bare.obj" "--help" "unwrap --help" "demo --list" "check bare.obj" "unwrap bare.obj -o - --quiet"; do
        "$seamlab" $words >/dev/full 2>err.txt
        [ $? = 1 ] || complain "a full disk is not exit 1: $words"
    done
fi
expect 1 "$seamlab" unwrap $mesh -o no-such-folder/x.obj
no_file no-such-folder

# --- Ctrl-C: exit 130, the old output stands, nothing half written
cp uv1.obj kept.obj
cp kept.obj before.obj
if [ "$(id -u)" -ge 0 ]; then
    "$seamlab" unwrap $mesh -o kept.obj --max-stretch 1.0001 --sew off >/dev/null 2>&1 &
    pid=$!
    sleep 0.05
    kill -INT $pid 2>/dev/null
    wait $pid
    code=$?
    case $code in
    130) cmp -s kept.obj before.obj || complain "an interrupted run changed its output" ;;
    0) ;; # it was done before the signal came
    *) complain "exit $code after Ctrl-C" ;;
    esac
fi
# the pictures come before the files: an interruption there leaves the old ones too
for delay in 0.1 0.3 0.5; do
    "$seamlab" unwrap bare.obj -o kept.obj --preview pictures2 --quiet 2>/dev/null &
    pid=$!
    sleep $delay
    kill -TERM $pid 2>/dev/null
    wait $pid
    code=$?
    case $code in
    130) cmp -s kept.obj before.obj || complain "a run interrupted while drawing changed its output" ;;
    0) cp before.obj kept.obj ;;
    *) complain "exit $code after SIGTERM" ;;
    esac
done
# --- editing by a script
printf '{"seamlab":"session","version":1}\n{"do":"cut-chart","facet":3}\n{"do":"pack"}\n' >edit.jsonl
expect 0 "$seamlab" edit $mesh edit.jsonl -o edited.obj --log done.jsonl --quiet
expect 0 "$seamlab" replay $mesh done.jsonl -o again.obj --quiet
contains out.txt '"do":"cut-chart"'
cmp -s edited.obj again.obj && cmp -s edited.atlas.json again.atlas.json || complain "a session replayed gives other bytes"
expect 0 "$seamlab" edit $mesh edit.jsonl -o one.obj --threads 1 --json --quiet
json out.txt
cmp -s edited.obj one.obj || complain "edit with another number of threads gives other bytes"
printf '{"seamlab":"session","version":1}\n' >nothing.jsonl
expect 0 "$seamlab" edit $mesh nothing.jsonl -o plain.obj --quiet
expect 0 "$seamlab" unwrap $mesh -o unwrapped.obj --preset fast --quiet
cmp -s plain.obj unwrapped.obj || complain "a session without actions gives other bytes than unwrap"
printf '{"seamlab":"session","version":1}\n{"do":"pack"}\n\n{"do":"cut-chart"}\n' >broken.jsonl
expect 3 "$seamlab" edit $mesh broken.jsonl -o broken.obj
contains err.txt 'broken.jsonl:4'
printf '{"seamlab":"session","version":1}\n{"do":"drop","constraint":1}\n' >bad.jsonl
expect 3 "$seamlab" edit $mesh bad.jsonl -o broken.obj
contains err.txt 'bad.jsonl:2'
printf '{"seamlab":"session","version":1}\n{"do":"undo"}\n' >infeasible.jsonl
expect 4 "$seamlab" edit $mesh infeasible.jsonl -o broken.obj
printf '{"seamlab":"session","version":1}\n{"do":"cut-chart","facet":3}\n{"do":"scale","facet":3,"factor":3}\n' >red.jsonl
expect 5 "$seamlab" edit $mesh red.jsonl -o broken.obj
no_file broken.obj broken.atlas.json
expect 0 "$seamlab" edit $mesh red.jsonl -o red.obj --allow-overlap --quiet
expect 0 "$seamlab" edit $mesh red.jsonl -o packed.obj --pack --quiet
expect 2 "$seamlab" edit $mesh edit.jsonl
expect 2 "$seamlab" edit $mesh edit.jsonl -o edited.off
expect 3 "$seamlab" edit $mesh no-such.jsonl -o broken.obj
head -c $(($(wc -c <done.jsonl) - 4)) done.jsonl >cut.jsonl # as after kill -9
expect 0 "$seamlab" replay $mesh cut.jsonl
contains err.txt 'has no end'
expect 0 "$seamlab" replay $mesh done.jsonl --to 1 --step-pictures steps --quiet
for f in steps/step-00000.png steps/step-00001.png; do [ -s $f ] || complain "$f is missing"; done
no_file steps/step-00002.png
no_temporaries
exit $bad
