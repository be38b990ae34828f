#!/usr/bin/env bash
# splat_transform.sh PROGRAMS
#
# A program of others reads what Sinew bends: splat-transform (the npm package @playcanvas/splat-transform), which
# converts and edits files of Gaussian splats.
#   1. A bent file, converted by it: every name in its order and every value as we wrote it, also when it reads its own
#      copy. Its count and bounds are those of sinew info.
#   2. It turns and moves all splats itself: the same places, covariances and spherical harmonics as by sinew apply.
# Files: the sample of splats, and a trained one where there is shared data. Each comparison is shown planted defects
# first. Exit status 77: skipped, with the reason.
set -euo pipefail
programs=$1
here=$(dirname "${BASH_SOURCE[0]}")
shared=${SINEW_SHARED:-$here/../../../shared}
for tool in node splat-transform; do
  command -v "$tool" >/dev/null || { echo "skipped: $tool is not on the PATH"; exit 77; }
done

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "failed: $*"; exit 1; }
figures() { node "$here/splat_figures.mjs" "$@"; }

# must_fail NAME COMMAND...: the command, with a defect planted in the column NAME, must not succeed.
must_fail() {
  local column=$1
  shift
  if PLANT=$column "$@" >"$work/planted"; then fail "a change of $column is not seen by: $*"; fi
}

# bends FILE EDIT: bent by the edit, then read and written by the client.
bends() {
  "$programs/sinew" deform "$1" --edit "$2" -o "$work/bent.ply" --force
  "$programs/sinew" diff "$1" "$work/bent.ply"
  splat-transform -q -w "$work/bent.ply" "$work/client.csv"
  splat-transform -q -w "$work/bent.ply" "$work/client.ply"
  splat-transform -q -w "$work/client.ply" "$work/again.csv"
  for column in x f_dc_1 f_rest_44 opacity scale_2 rot_3; do
    must_fail "$column" figures same "$work/bent.ply" "$work/client.csv"
  done
  figures same "$work/bent.ply" "$work/client.csv"
  figures same "$work/bent.ply" "$work/again.csv"
  "$programs/sinew" info "$work/bent.ply" --json >"$work/info.json"
  figures bounds "$work/info.json" "$work/client.csv"
}

# turns FILE: all of it, once by each.
turns() {
  figures pose 20,40,60 1,2,3 >"$work/pose.json"
  "$programs/sinew" apply "$work/pose.json" "$1" -o "$work/turned.ply" --force
  splat-transform -q -w "$1" -r 20,40,60 -t 1,2,3 "$work/client.ply"
  for column in x f_rest_0 f_rest_24 f_rest_44 scale_1 rot_2; do
    must_fail "$column" figures rigid "$work/turned.ply" "$work/client.ply"
  done
  if figures rigid "$1" "$work/client.ply" >/dev/null; then fail "splats that did not turn pass"; fi
  figures rigid "$work/turned.ply" "$work/client.ply"
}

splat-transform --version
"$programs/sinew-samples" "$work" splats 2>/dev/null
bends "$work/splats.ply" "$work/splats.edit.json"
turns "$work/splats.ply"

trained=$shared/data/splats/inria_format/point_cloud.ply
if [ -f "$trained" ]; then
  cat >"$work/trained.edit.json" <<'EDIT'
{ "sinew": 1, "layers": [ { "method": "graph", "settings": { "nodes": 200 },
  "fixed": [ { "box": [[-1000, -1000, -1000], [1000, -100, 2000]] } ],
  "handles": [ { "points": { "box": [[-1000, 100, -1000], [1000, 1000, 2000]] },
                 "rotate": { "axis": [0, 1, 0], "degrees": 60, "about": [0, 0, 400] }, "move": [0, 50, 0] } ] } ] }
EDIT
  bends "$trained" "$work/trained.edit.json"
  turns "$trained"
else
  echo "no shared data: $trained"
fi
