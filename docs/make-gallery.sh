#!/usr/bin/env bash
# Draws every picture of the gallery and writes docs/gallery.md around them:
#   docs/make-gallery.sh [TERRANE]
# TERRANE is the program to draw with, build/release/bin/terrane by default. It
# generates in its own process (--local), so no server is needed. Intermediate
# height files go to out/gallery. Run it again after a preset or the renderer has
# changed, and look at what it drew.
set -euo pipefail
cd "$(dirname "$0")/.."

terrane=${1:-build/release/bin/terrane}
page=docs/gallery.md
pictures=docs/gallery
work=out/gallery
model=tests/data/jacksboro-3arcsec-4326.tif
mkdir -p "$pictures" "$work"
rm -f "$pictures"/*.png

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

How it all works is in [terrain.md](terrain.md) and [surface.md](surface.md).

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
