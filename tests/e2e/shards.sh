# shellcheck shell=bash
# What the tests of exports under other programs share; read by them with `source`.

skip() {
  echo "SKIPPED, NOTHING WAS CHECKED: $1" >&2
  exit 77
}

# The commands of those given that this machine does not have.
missing_commands() {
  local command
  for command in "$@"; do
    command -v "${command}" >/dev/null || echo "${command}"
  done
}

# What is exported, by 4 shards into FOLDER/parts/tile.tif.
# shellcheck disable=SC2034 # read by those who source this
choice=(--preset fbm/fig06b --level 7 --tile-size 33 "--tiles=0,0,5,4" --local --threads 1)

# Whether the shards wrote what one process writes: check_parts TERRANE FOLDER.
check_parts() {
  "$1" export --verify --out "$2/parts/tile.tif" --shards 4
  "$1" export "${choice[@]}" --out "$2/whole/tile.tif"
  rm "$2"/parts/*.json "$2"/whole/*.json
  diff --recursive "$2/parts" "$2/whole"
}
