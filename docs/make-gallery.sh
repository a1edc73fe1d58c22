#!/usr/bin/env bash
# Draws every picture of the gallery and writes its pages around them:
#   docs/make-gallery.sh [--section ground|trees|flowers] [TERRANE]
# ground is docs/gallery.md (terrain and surfaces), trees docs/gallery-trees.md,
# flowers docs/gallery-flowers.md; all without --section. TERRANE is the program to draw with,
# build/release/bin/terrane by default. It generates in its own process (--local),
# so no server is needed. Intermediate height files go to out/gallery. Run it again
# after a preset or the renderer has changed, and look at what it drew.
set -euo pipefail
cd "$(dirname "$0")/.."

section=all
if [[ ${1:-} == --section ]]; then
  section=$2
  shift 2
fi
terrane=${1:-build/release/bin/terrane}
pictures=docs/gallery
work=out/gallery
model=tests/data/jacksboro-3arcsec-4326.tif
mkdir -p "$pictures" "$work"

draws() { [[ $section == all || $section == "$1" ]]; }

# Removes what the page showed.
forget_pictures() {
  [[ ! -f $page ]] || grep -oE 'gallery/[a-z0-9-]+\.(png|svg)' "$page" | sort -u | sed 's|^|docs/|' | xargs -r rm -f
}

say() { printf '%s\n' "$@" >>"$page"; }

# Commands run since the last picture, as a reader would type them.
commands=()
run() {
  commands+=("terrane $*")
  "$terrane" "$@" >/dev/null 2>"$work/log" || { cat "$work/log" >&2; exit 1; }
}

# picture FILE ALT TEXT: a picture that was drawn, its caption, its commands.
picture() {
  echo "$pictures/$1.png"
  say "![$2](gallery/$1.png)" "" "$3" "" '```sh' "${commands[@]}" '```' ""
  commands=()
}

# preset NAME LOOK [OPTION...]: a preset as its own view has it.
preset() {
  local name=$1 look=$2 file=${1#*/}
  shift 2
  local about title description
  about=$("$terrane" presets "$name" --local)
  title=$(sed -n '1s/^[^:]*: //p' <<<"$about")
  description=$(sed -n 3p <<<"$about")
  run render --local --preset "$name" "$@" --out "$pictures/$file.png"
  say "### $title" ""
  picture "$file" "$title" "$description

*What to see.* $look"
}

# tree NAME LOOK [OPTION...]: a preset of a tree.
tree() {
  local name=$1 look=$2 file=tree-${1#*/}
  shift 2
  local about title description
  about=$("$terrane" presets "$name" --local)
  title=$(sed -n '1s/^[^:]*: //p' <<<"$about")
  description=$(sed -n 3p <<<"$about")
  run tree --local --preset "$name" --size 600 "$@" --out "$pictures/$file.png"
  say "### $title" ""
  picture "$file" "$title" "$description

*What to see.* $look"
}

# flower NAME LOOK [OPTION...]: a preset of a flower, ray traced.
flower() {
  local name=$1 look=$2 file=flower-${1#*/}
  shift 2
  local about title description
  about=$("$terrane" presets "$name" --local)
  title=$(sed -n '1s/^[^:]*: //p' <<<"$about")
  description=$(sed -n 3p <<<"$about")
  run render --local --preset "$name" --width 520 --height 520 --passes 32 "$@" --out "$pictures/$file.png"
  say "### $title" ""
  picture "$file" "$title" "$description

*What to see.* $look"
}

# row FILE TEXT: pictures beside each other, FILE-0.png and on, as many as there are
# commands since the last picture, with one caption.
row() {
  local file=$1 images="" number=0
  for ((number = 0; number < ${#commands[@]}; ++number)); do
    echo "$pictures/$file-$number.png"
    images+="![$file $number](gallery/$file-$number.png) "
  done
  say "${images% }" "" "$2" "" '```sh' "${commands[@]}" '```' ""
  commands=()
}

# sweep FILE FIELD VALUE... -- OPTION...: a row of trees, one a value of a field.
sweep() {
  local file=$1 field=$2 number=0
  shift 2
  local values=()
  while [[ $1 != -- ]]; do
    values+=("$1")
    shift
  done
  shift
  for value in "${values[@]}"; do
    run tree --local "$@" --set "$field=$value" --size 220 --out "$pictures/$file-$number.png"
    number=$((number + 1))
  done
}

# surface NAME LOOK [OPTION...]: a preset of a surface.
surface() {
  local name=$1 look=$2 file=surface-${1#*/}
  shift 2
  local about title description
  about=$("$terrane" presets "$name" --local)
  title=$(sed -n '1s/^[^:]*: //p' <<<"$about")
  description=$(sed -n 3p <<<"$about")
  run render --local --preset "$name" --width 700 "$@" --out "$pictures/$file.png"
  say "### Surface, ${title,}" ""
  picture "$file" "$title" "$description

*What to see.* $look"
}

draw_ground() {
page=docs/gallery.md
forget_pictures
cat >"$page" <<'TEXT'
# Gallery

Drawn by [make-gallery.sh](make-gallery.sh), which also wrote this page. Every picture
stands above the commands that draw it again, bit for bit on any machine; run them in the
root of the tree with `build/release/bin` in the path.

- [A real elevation model, refined](#a-real-elevation-model-refined)
- [Spot heights](#spot-heights)
- [Ground to start from](#ground-to-start-from)
- [Sources and mappings](#sources-and-mappings)
- [The paper's figures](#the-papers-figures)
- [Other readings of D](#other-readings-of-d)
- [Free-form surfaces](#free-form-surfaces)

[Trees](gallery-trees.md) and [flowers](gallery-flowers.md) have pages of their own. How it all works is in [terrain.md](terrain.md) and [surface.md](surface.md).

## A real elevation model, refined

Jacksboro, Tennessee, from the United States Geological Survey: a post about every 90 m.

TEXT

refine=(terrain --local --dem "$model")
run "${refine[@]}" --level 3 --out "$work/refined.tif"
run render --side-by-side "$model" "$work/refined.tif" --width 480 --out "$pictures/jacksboro.png"
picture jacksboro "The model and its refinement" \
  "The model on the left and refined eightfold on the right, at the same ground scale; below,
the framed part of each.

*What to see.* Every ridge stands where it stood, for every post of the model keeps its height
to the bit. Where the model has only blocks, the refinement has slopes, and no trace of the
posts shows through. Plains stay plain and mountains gain texture, because the amplitude of
the detail follows the model's own local roughness."

mountains=(--window "1360,1130,600,600")
run "${refine[@]}" --level 3 "${mountains[@]}" --fidelity 0 --out "$work/interpolated.tif"
run "${refine[@]}" --level 3 "${mountains[@]}" --out "$work/fractal.tif"
run render --side-by-side "$work/interpolated.tif" "$work/fractal.tif" --width 480 --out "$pictures/jacksboro-detail.png"
picture jacksboro-detail "Interpolation against fractal detail" \
  "A close-up of 75 by 75 posts, without detail (T = 0: the model interpolated) and with it.

*What to see.* What interpolation leaves smooth, the fractal continues at the model's own
roughness, strong on the slopes and faint on the valley floor."

run render "$work/refined.tif" --style perspective --width 960 --out "$pictures/jacksboro-block.png"
picture jacksboro-block "The refined model as a block" \
  "The refined model as a whole, looked at from the south.

*What to see.* Two long straight walls that meet, rugged mountains in the west and the low
country in the east, down to slopes of a few samples."

say "## Spot heights" "" "Heights that are met exactly, see [terrain.md](terrain.md#spot-heights)." ""
docs/spot-comparison.py "$terrane" >"$work/comparison.md"
commands+=("docs/spot-comparison.py")
run render --side-by-side out/spots/{original,spot-heights,inverse-distance,thin-plate}.tif --width 403 --out "$pictures/spots-jacksboro.png"
picture spots-jacksboro "One post in a hundred, and the rest made again" \
  "The model on the left. Then three maps that know one post in a hundred of it, picked at random
and met exactly by each: spot heights over a flat macro shape, inverse distance, and a thin-plate
spline. Below, the framed part of each.

*What to see.* The terrain is as rough as the model over four posts and more, and rougher from
post to post; it is calm where the model is calm, and nothing shows where its 1,386 spots are.
Inverse distance has a pimple at each, and the spline a blister. No map has the model's valleys and
straight walls: one post in a hundred does not tell of them. [Variograms and errors](terrain.md#compared-with-interpolation)."

preset demo/spots "Mountains where the five heights ask for them, as rough as the ground around, and a
river valley from the upper left to the lower right. No height shows as a spike, a cone or a disc."
run render --local --preset demo/spots --show-spots --out "$pictures/spots-marked.png"
picture spots-marked "The heights that were given" \
  "The same map with the five points and the river drawn on it."

say "## Ground to start from" "" "Presets with SUBDIVISION and LINEAR, the defaults, in metres and without a border." ""
preset demo/hills "No grid, no creases and no direction that stands out."
preset demo/alps "The valley floor is even, and the change to rough slopes is gradual: continuous constraints with a smooth edge."
preset demo/islands "The hills give the islands their places, the fractal gives them their coasts."
preset demo/canyon "The plateau is calm and the walls are rough, and the rivers lie where their polylines say."

say "## Sources and mappings" "" "The same hills three times, under the same grey light." ""
shade=(render --local --preset demo/hills --style hillshade --window "0,0,480,480" --exaggeration 2)
run "${shade[@]}" --out "$pictures/source-subdivision.png"
picture source-subdivision "SUBDIVISION and LINEAR" "SUBDIVISION and LINEAR, the defaults. *What to see.* Even ground, the same in every direction."
run "${shade[@]}" --source midpoint --out "$pictures/source-midpoint.png"
picture source-midpoint "MIDPOINT and LINEAR" "MIDPOINT, the paper's source. *What to see.* Creases along the axes and the diagonals, in stars around
lattice points: the known fault of midpoint displacement; and rougher ground than its H should give."
run "${shade[@]}" --mapping boltzmann --out "$pictures/mapping-boltzmann.png"
picture mapping-boltzmann "SUBDIVISION and BOLTZMANN" "BOLTZMANN, the paper's mapping. *What to see.* A cliff wherever the detail changes sign,
because the mapping's slope is infinite there."

say "## The paper's figures" "" "Tan and Chen, Journal of Software 14(3), 2003, section 5, with the paper's source (MIDPOINT) and
mapping (BOLTZMANN). The paper prints few numbers; each caption says which were chosen here." ""
wide=(--width 900)
preset fbm/fig04a "A polyline of ten pieces." "${wide[@]}"
preset fbm/fig04b "The profile is rough at every scale and keeps to the polyline, drawn in grey." "${wide[@]}"
preset fbm/fig04c "At each of the eight verticals the profile meets the polyline, and it is as rough beside them as elsewhere." "${wide[@]}"
preset fbm/fig04d "Another large shape with the same small ones: compare the jags with those of figure 4b." "${wide[@]}"
preset fbm/fig04e "The same bends as figure 4d, with far fewer jags." "${wide[@]}"
preset fbm/fig05a "The polyline of the four pictures that follow." "${wide[@]}"
preset fbm/fig05b "Between the verticals a smooth curve that stays away from the polyline; jags elsewhere." "${wide[@]}"
preset fbm/fig05c "The same in another region." "${wide[@]}"
preset fbm/fig05d "Between the verticals the profile hugs the polyline and is still rough; elsewhere it wanders." "${wide[@]}"
preset fbm/fig05e "The same in another region." "${wide[@]}"
preset fbm/fig06a "Two mountains and two basins, without detail." "${wide[@]}"
preset fbm/fig06b "The same mountains and basins with rough ground on them. The crooked steps are BOLTZMANN's cliffs." "${wide[@]}"
preset fbm/fig06c "A lake in each basin, with an irregular shore." "${wide[@]}"
preset fbm/fig06d "The same ground with the water higher: larger lakes, and the low ground at the border is flooded too." "${wide[@]}"
preset fbm/fig07a "A peak among four lower hills." "${wide[@]}"
preset fbm/fig07b "The peak is nearly that of figure 7a, smooth and in its place; the ground around it is rough and has moved." "${wide[@]}"
preset fbm/fig07c "The top is smooth. Its gentle tilt is the deviation that T allows everywhere." "${wide[@]}"
preset fbm/fig07d "A sunken patch with ragged rims and small pits on the same top; the flanks and the ground are those of figure 7c." "${wide[@]}"

say "## Other readings of D" ""
preset fbm/cloud "Banks and wisps at every scale, longer than they are high." --width 768
preset fbm/waves "Long crests of the swell, with smaller waves that run along and across them." --width 960
preset fbm/corrosion "Four pitted spots with soft borders on a plate that is otherwise even, but for hair lines where BOLTZMANN changes sign."

# The surfaces' part.
say "## Free-form surfaces" "" "Mo, Tan and Zhang, Journal of Software 12, 2001: thirteen figures on one Bézier net of 4 x 4
points. The paper prints neither the net nor the learning rate mu and the steps K. The net is
chosen here; all networks are trained to convergence, where mu and K do not matter, but for
figure 1, which is not trained (K = 0)." ""
surface surface/fig01 "The patch hangs from the four corners of its polyhedron, under the inner points."
surface surface/fig02 "The arch of figure 1, rough everywhere; its four corners stay where they were."
surface surface/fig03 "The shoulder on the right, towards the control point of w21, is higher and steeper than in figure 2; the rest is as it was."
surface surface/fig04 "A peak near the control point of w11, in front; the slopes that face the viewer are almost smooth."
surface surface/fig05 "The same peak with jags all over it: only the response has changed."
surface surface/fig06 "No randomness and no jags: a smooth surface, sunk and raised by the training."
surface surface/fig07 "The trend of figure 6 under jags of even strength."
surface surface/fig08 "The arch, jagged where w10 counts, in the middle and in front, and smooth elsewhere; faint furrows run along t, the direction of the carry-over."
surface surface/fig09 "Figure 8 with longer jags."
surface surface/fig10 "Fractal in one part, level in the others. Heights are drawn a quarter as high: weights of -12 and 25 multiply." --exaggeration 0.25
surface surface/fig11 "A high mountain with smooth flanks, and a lower, rough one behind it."
surface surface/fig12 "A high dune behind and a lower one in front, sand between them, and a ragged hole in each hollow at the sides."
surface surface/fig13 "Two ridges, one behind the other, with a valley between them; all of it is rough."
}

draw_trees() {
page=docs/gallery-trees.md
forget_pictures
cat >"$page" <<'TEXT'
# Gallery: trees

Drawn by [make-gallery.sh](make-gallery.sh), as [the ground's](gallery.md): every picture stands
above the commands that draw it again.

- [The paper's trees](#the-papers-trees)
- [Species](#species)
- [A tree, generation by generation](#a-tree-generation-by-generation)
- [What a parameter does](#what-a-parameter-does)
- [Many trees and levels of detail](#many-trees-and-levels-of-detail)

How it works is in [tree.md](tree.md).

TEXT
say "## The paper's trees" "" "Wu and Zhou, Journal of Image and Graphics 13(8), 2008. The paper prints few numbers; radii are
an addition of this project." ""
tree tree/plain "Every fork is the same fork, only smaller: the tree has the symmetry of its maps."
tree tree/genetic "Forks resemble each other, and none is like another. The trunk ends as a stub, for the paper's monopodial axis is not carried on."
tree tree/all-monopodial "Branches leave the sides of straight axes that go on beyond them."
tree tree/all-sympodial "No axis goes on: each ends in a fork."
tree tree/all-left "The crown leans to the left."
tree tree/all-right "The tree before, in a mirror."
tree tree/sparse "Some sixty branches, and most of the picture is empty."
tree tree/dense "Ten times as many branches in the same room."
tree tree/cantor "Each line leaves out the middle thirds of the one above."
tree tree/cantor-statistical "Gaps of all sizes, and no two halves alike."

say "## Species" "" "In three dimensions, with radii, bending and leaves, all by the same operators; a parallel
projection. Lengths are metres." ""
tree tree/oak "A crown as round as it is high on a short trunk; limbs as thick as small trees."
tree tree/birch "The white trunk can be followed to the top, and the twigs hang."
tree tree/spruce "A narrow cone; the lowest tier is the widest."
tree tree/poplar "Nothing sticks out: every branch turns upwards beside its axis."
tree tree/willow "Limbs arch, twigs fall straight down, and the trunk stands upright."
tree tree/pine "Half of the trunk is bare; the needles stand in clouds with air between."
tree tree/acacia "Wider than high, with the leaves at the rim."

say "## A tree, generation by generation" "" "The rows of a lower depth are the first rows of a higher one, so each picture holds the one before." ""
for depth in 0 1 2 3 4 5 6 7; do
  run tree --local --preset tree/genetic --depth "$depth" --size 220 --out "$pictures/tree-growth-$depth.png"
done
row tree-growth "The tree of figure 3b from its trunk to its eighth generation. The scale follows the tree."
for depth in 0 1 2 3 4 5 6 7 8; do
  run tree --local --preset tree/oak --depth "$depth" --size 220 --out "$pictures/tree-oak-growth-$depth.png"
done
row tree-oak-growth "The oak: leaves sit on the last two generations, whichever those are."

say "## What a parameter does" ""
sweep tree-monopodial genetic.monopodial_share 0 0.25 0.5 0.75 1 -- --preset tree/genetic
row tree-monopodial "monopodial_share 0, 0.25, 0.5, 0.75, 1: from forks alone to axes alone."
sweep tree-left genetic.left_share 0 0.25 0.5 0.75 1 -- --preset tree/genetic
row tree-left "left_share 0, 0.25, 0.5, 0.75, 1: the crown moves from right to left."
sweep tree-density genetic.density WANTED_LOW WANTED_ANY WANTED_HIGH -- --preset tree/genetic --set length_mode=LENGTH_MODE_RELATIVE --set genetic.population=64
row tree-density "density LOW, ANY, HIGH, with relative lengths and populations of 64: long branches wide apart; no wish; short ones in tufts."
sweep tree-angle genetic.angle_max_deg 35 50 65 80 95 -- --preset tree/oak
row tree-angle "angle_max_deg 35, 50, 65, 80, 95: the oak opens."
sweep tree-lateral genetic.lateral_share 0.3 0.45 0.6 0.8 -- --preset tree/spruce --depth 8 --set genetic.least_length=0.15
row tree-lateral "lateral_share 0.3, 0.45, 0.6, 0.8: the axis rules less and less."
sweep tree-gravity bending.gravity 0 0.4 0.8 1.2 1.6 -- --preset tree/willow --depth 6
row tree-gravity "gravity 0, 0.4, 0.8, 1.2, 1.6: a willow begins to weep."
sweep tree-pipes pipe_exponent 1.5 1.8 2 2.3 3 -- --preset tree/genetic
row tree-pipes "pipe_exponent 1.5, 1.8, 2, 2.3, 3: twigs of the same lengths get thicker."

say "## Many trees and levels of detail" ""
for number in 0 1 2 3 4 5 6 7; do
  run tree --local --preset tree/oak --seed "$((number + 1))" --size 220 --out "$pictures/tree-seeds-$number.png"
done
row tree-seeds "Eight oaks, seeds 1 to 8: one kind, eight trees."
for number in 0 1 2 3; do
  run tree --local --preset tree/oak --lod "$number" --size 300 --out "$pictures/tree-lod-$number.png"
done
row tree-lod "Levels of detail 0 to 3 of the oak: fewer generations, fewer faces, fewer and larger leaves, the same silhouette."
}

draw_flowers() {
page=docs/gallery-flowers.md
forget_pictures
cat >"$page" <<'TEXT'
# Gallery: flowers

Drawn by [make-gallery.sh](make-gallery.sh), as [the ground's](gallery.md): every picture stands
above the commands that draw it again, to the last digits on any machine. All are ray traced by
the paper's own shading ([rendering.md](rendering.md)).

- [The paper's figures](#the-papers-figures)
- [Ours](#ours)
- [How light falls](#how-light-falls)
- [Beds](#beds)

How it works is in [flower.md](flower.md).

## The paper's figures

Wang, Zhang and Yang, Journal of Shenzhen University Science and Engineering 36(4), 2019. Its
tables are lost; what it prints of numbers is kept, the rest is chosen here.

TEXT
docs/flower-sketches.py "$pictures/flower-sketches.svg" "$terrane"
say "### Figure 2: sketches" "" "![Sketches](gallery/flower-sketches.svg)" "" \
  "Half outlines of two or three points (red) and their mirror images (hollow), through base and tip by Catmull-Rom; petals have two sketches to choose from." \
  "" '```sh' "docs/flower-sketches.py $pictures/flower-sketches.svg" '```' ""
flower flower/rose "An open rose: a spiral of upright petals in the middle, the outer ones curled back over the sepals." --tilt 38
for stage in 0 0.33 0.67 1; do
  run render --local --preset flower/rose --stage "$stage" --width 300 --height 400 --passes 32 --tilt 16 --out "$pictures/flower-rose-stage-${#commands[@]}.png"
done
row flower-rose-stage "Figure 11, a rose from bud to bloom: stages 0, 0.33, 0.67 and 1."
flower flower/pansy "A face: dark blotches that run out in rays, a yellow eye, two darker petals behind." --tilt 10 --turn 0
flower flower/water-lily "Petals that lie open around golden stamens, above their pads." --tilt 30
flower flower/sunflower-head "Spirals that run both ways, and no floret in another's place." --tilt 80
for name in flat wavy curled; do
  run render --local --preset "flower/leaf-$name" --width 300 --height 300 --passes 32 --tilt 50 --out "$pictures/flower-leaf-${#commands[@]}.png"
done
row flower-leaf "Figure 4, leaves of one outline: more Nd, Nsx and Nsy, more relief."
for name in flat wavy ruffled; do
  run render --local --preset "flower/petal-$name" --width 300 --height 300 --passes 32 --tilt 50 --out "$pictures/flower-petal-${#commands[@]}.png"
done
row flower-petal "Figure 5, petals: the halves mirror each other."
for method in ifs bezier perlin; do
  run render --local --preset flower/rose --petal-method "$method" --width 320 --height 400 --passes 32 --tilt 30 --out "$pictures/flower-method-${#commands[@]}.png"
done
row flower-method "Figure 12, three methods: an iterated function system's flat ragged petals, Bezier patches without ruffles, and the paper's."

say "## Ours" ""
flower flower/sunflower "The head nods a little; its florets stand in spirals." --tilt 12 --turn 0
flower flower/daisy "A yellow dome in a ring of white." --tilt 35
flower flower/tulip "A cup that is still closing at its rim." --tilt 15
flower flower/lily "Six petals that roll back, stamens that reach out." --tilt 12
flower flower/chrysanthemum "Petals rolled into quills, denser towards the middle." --tilt 40

say "## How light falls" "" "Figure 8: the paper's model beside the empirical ones that it replaces." ""
for shading in lambert blinn-phong literal conserving; do
  run render --local --preset flower/rose --shading "$shading" --width 300 --height 300 --passes 32 --tilt 38 --out "$pictures/flower-shading-${#commands[@]}.png"
done
row flower-shading "Lambert, Blinn-Phong, the paper's model as printed, and the one that conserves energy."

say "## Beds" "" "One set of prototypes, a row for each petal of each plant: no two plants are alike." ""
run render --local --preset flower/rose --plants 25 --width 700 --height 420 --passes 32 --tilt 22 --out "$pictures/flower-bed.png"
picture flower-bed "Twenty-five roses" "Twenty-five roses on a grid that chance has moved."
}

if draws ground; then draw_ground; fi
if draws trees; then draw_trees; fi
if draws flowers; then draw_flowers; fi
