#!/usr/bin/env bash
# Holds the GLB files that terrane writes to the Khronos validator, without an
# error and without a warning: check_gltf.sh BUILD_DIR TERRANE WRITE_SCENES. Exit
# code 77 (skipped) as npm_packages.sh.
set -euo pipefail

here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
packages="$("${here}/npm_packages.sh" "$1")"
folder="$(mktemp -d)"
trap 'rm -rf "${folder}"' EXIT

for preset in surface/fig02 surface/fig10 surface/fig12; do
  "$2" surface --local --preset "${preset}" --out "${folder}/${preset#*/}.glb" >/dev/null
done
"$2" surface --local --preset surface/fig07 --size 300x200 --uvs --out "${folder}/uvs.glb" >/dev/null
"$3" "${folder}"
for preset in genetic oak spruce; do
  "$2" tree --local --preset "tree/${preset}" --depth 5 --lod 0,1 --out "${folder}/${preset}.glb" >/dev/null
done
"$2" tree --local --preset tree/acacia --depth 4 --instancing nodes --ends closed --out "${folder}/nodes_of_leaves.glb" >/dev/null
"$2" tree --local --preset tree/poplar --depth 4 --forest --count 4 --out "${folder}/forest.glb" >/dev/null
for instancing in extension nodes; do
  flower=("$2" flower --local --preset flower/rose --instancing "${instancing}")
  "${flower[@]}" --out "${folder}/rose_${instancing}.glb" >/dev/null
  "${flower[@]}" --out "${folder}/again.glb" >/dev/null
  cmp "${folder}/rose_${instancing}.glb" "${folder}/again.glb"
  "${flower[@]}" --plants 9 --out "${folder}/bed_${instancing}.glb" >/dev/null
done
"$2" flower --local --preset flower/pansy --method ifs --out "${folder}/pansy_ifs.glb" >/dev/null
NODE_PATH="${packages}/node_modules" node "${here}/validate_gltf.js" "${folder}"/*.glb
