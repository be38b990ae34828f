#!/usr/bin/env bash
# blender.sh PROGRAMS
#
# A program of others reads what Sinew writes: Blender. A run of OBJ files is written as PC2, MDD and glTF; its modifier
# Mesh Cache and its importer must show each vertex of each frame where the OBJ files have it.
# Files: a waving sheet, and a galloping horse where there is shared data. One changed coordinate in each kind of file
# must be seen first. Exit status 77: skipped, with the reason.
set -euo pipefail
sinew=$(realpath "$1")/sinew
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
gallop=${SINEW_SHARED:-$here/../../../shared}/data/anim/horse_gallop_obj
command -v blender >/dev/null || { echo "skipped: blender is not on the PATH"; exit 77; }

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# compare RUN FRAMES FILE...: a line for each file, and errors
compare() {
  blender -b --factory-startup --python-exit-code 1 -P "$here/blender.py" -- "$@" >"$folder/log" 2>&1 || true
  grep -E '^(equal|DIFFERENT)|Error' "$folder/log" || true
}

# A sheet of quads that waves, 12 frames.
make_sheet() {
  local frame
  for frame in $(seq 12); do
    awk -v t="$frame" 'BEGIN {
      for (y = 0; y < 20; ++y) for (x = 0; x < 30; ++x)
        printf "v %.7g %.7g %.7g\n", x / 7, y / 7 + 0.1 * sin(t + x), 0.3 * sin(x / 3 + t / 2) * cos(y / 5)
      for (y = 0; y < 19; ++y) for (x = 1; x < 30; ++x) {
        a = 30 * y + x
        print "f", a, a + 1, a + 31, a + 30
      }
    }' >"$folder/sheet/$(printf %04d "$frame").obj"
  done
}

# convert RUN NAME: the run as NAME.pc2, NAME.mdd, NAME.glb, NAME.gltf
convert() {
  local kind
  for kind in pc2 mdd glb gltf; do "$sinew" convert "$1" "$folder/$2.$kind" 2>/dev/null; done
}

# change FILE BYTE: another number there
change() { printf '\x47' | dd of="$1" bs=1 seek="$2" conv=notrunc status=none; }

mkdir "$folder/sheet"
make_sheet
convert "$folder/sheet/####.obj" sheet

# Frame 7 of PC2 and MDD, the high byte of a coordinate; in glTF the last position of the last target, before the
# indices and the animation.
points=600
mkdir "$folder/planted"
cp "$folder"/sheet.{pc2,mdd,glb} "$folder/planted"
change "$folder/planted/sheet.pc2" $((32 + 6 * points * 12 + 1203 * 4 + 3))
change "$folder/planted/sheet.mdd" $((8 + 12 * 4 + 6 * points * 12 + 1203 * 4))
behind=$((19 * 29 * 2 * 3 * 4 + 12 * 4 + 12 * 11 * 4))
change "$folder/planted/sheet.glb" $(($(stat -c %s "$folder/planted/sheet.glb") - behind - 1))
for kind in pc2 mdd glb; do
  if ! compare "$folder/sheet/%04d.obj" 12 "$folder/planted/sheet.$kind" | grep -q '^DIFFERENT'; then
    echo "failed: a changed coordinate in .$kind is not seen"
    exit 1
  fi
done

status=0
# verify NAME RUN FRAMES: all four files are equal
verify() {
  local out
  out=$(compare "$2" "$3" "$folder/$1".{pc2,mdd,glb,gltf})
  printf '%s\n' "$out"
  [ "$(grep -c '^equal' <<<"$out")" = 4 ] || status=1
}
verify sheet "$folder/sheet/%04d.obj" 12
if [ -d "$gallop" ]; then
  convert "$gallop/####.obj" gallop
  verify gallop "$gallop/%04d.obj" "$(find "$gallop" -name '[0-9][0-9][0-9][0-9].obj' | wc -l)"
fi
exit "$status"
