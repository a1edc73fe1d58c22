#!/usr/bin/env bash
# Opens the files that the codec writes with assimp, a reader of its own, and
# counts what it finds in them: check_assimp.sh WRITE_SCENES TERRANE. Exit code 77
# (skipped) without assimp.
set -euo pipefail

command -v assimp >/dev/null || {
  echo "SKIPPED, NOTHING WAS CHECKED: there is no assimp on this machine." >&2
  exit 77
}
folder="$(mktemp -d)"
trap 'rm -rf "${folder}"' EXIT
"$1" "${folder}"

# expect FILE "WHAT: NUMBER"...: lines of assimp's report.
expect() {
  local report
  report="$(assimp info "${folder}/$1")"
  for line in "${@:2}"; do
    if ! grep -qE "^${line}\$" <<<"${report}"; then
      printf '%s: no line "%s" in\n%s\n' "$1" "${line}" "${report}" >&2
      exit 1
    fi
  done
  echo "$1: as it should be"
}

# The root and the one object.
expect plain.glb 'Nodes: +2' 'Meshes: +1' 'Vertices: +4' 'Faces: +2'
# The root, the wood, the leaves and 25 instances of theirs.
expect nodes.glb 'Nodes: +28' 'Meshes: +2' 'Vertices: +67681' 'Faces: +134290'
expect plant.obj 'Nodes: +3' 'Meshes: +2' 'Materials: +2' 'Vertices: +69625' 'Faces: +137362'
# A tree: the root, the wood, the leaves and each leaf.
leaves="$("$2" tree --local --preset tree/oak --depth 4 --instancing nodes --json --out "${folder}/oak.glb" |
  /usr/bin/python3 -c 'import json, sys; print(json.load(sys.stdin)["leaves"])')"
expect oak.glb "Nodes: +$((3 + leaves))" 'Meshes: +2' 'Materials: +2'
# A flower: the root, 11 of its 12 meshes (no sepal is closed) and each of their
# instances.
instances="$("$2" flower --local --preset flower/rose --instancing nodes --json --out "${folder}/rose.glb" |
  /usr/bin/python3 -c 'import json, sys; print(int(json.load(sys.stdin)["instances"]))')"
expect rose.glb "Nodes: +$((12 + instances))" 'Meshes: +11' 'Materials: +3'
