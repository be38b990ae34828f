#!/usr/bin/env bash
# editor_poses_test.sh PROGRAMS poses|horse
#
# Uses the window with example poses as a person would: real mouse and keys, with the validation layer on.
#   poses  opens a cylinder, then the folder of its poses; drags a bar, pins, frees, undoes; holds one end, pulls the other
#          and sees the bars follow; saves, exports; the command line must come to the same points; a file that is no
#          pose is a sentence; then the folder and the cylinder from the command line, at scale 2
#   horse  opens a folder of poses of a horse alone, blends by a bar, pulls a hoof, where there are some (SINEW_SHARED, or
#          ../shared beside the sources); prints how long the pictures of both took after their mouse events
# SHOTS=FOLDER keeps screenshots. Exit status 77: skipped, with the reason.
# shellcheck source=tests/apps/window.sh
source "$(dirname "$0")/window.sh"

# cylinder BEND TO TWIST RINGS: along y, of 24 points a ring, its ends closed, as OBJ; bent to x or z.
cylinder() {
  awk -v bend="$1" -v to="$2" -v twist="$3" -v rings="$4" '
    function put(x, y, z,    a, u, v, r) {
      a = twist * y / 1.2; u = x * cos(a) + z * sin(a); v = z * cos(a) - x * sin(a)
      if (bend == 0) { printf "v %.9g %.9g %.9g\n", u, y, v; return }
      r = 1.2 / bend; a = y / r
      if (to == "x") printf "v %.9g %.9g %.9g\n", r - (r - u) * cos(a), (r - u) * sin(a), v
      else printf "v %.9g %.9g %.9g\n", u, (r - v) * sin(a), r - (r - v) * cos(a)
    }
    BEGIN {
      n = 24; pi = atan2(0, -1)
      for (i = 0; i <= rings; ++i) for (k = 0; k < n; ++k)
        put(0.12 * cos(2 * pi * k / n), 1.2 * i / rings, 0.12 * sin(2 * pi * k / n))
      put(0, 0, 0); put(0, 1.2, 0)
      for (i = 0; i < rings; ++i) for (k = 0; k < n; ++k) {
        a = i * n + k + 1; b = i * n + (k + 1) % n + 1
        printf "f %d %d %d\nf %d %d %d\n", a, a + n, b + n, a, b + n, b
      }
      c = (rings + 1) * n + 1
      for (k = 0; k < n; ++k) {
        printf "f %d %d %d\n", c, k + 1, (k + 1) % n + 1
        printf "f %d %d %d\n", c + 1, rings * n + (k + 1) % n + 1, rings * n + k + 1
      }
    }'
}

# same_points FILE EDIT: what was exported and what the command line makes of the saved edit.
same_points() {
  "$programs/sinew" deform "$1" --edit "$2" -o "$work/line.obj" --force 2>"$work/log" || fail "sinew deform"
  local apart moved
  apart=$(distance "$work/line.obj" "$work/window.obj")
  moved=$(distance "$1" "$work/window.obj")
  echo "moved $moved, window and command line apart $apart of the diagonal"
  within "$apart" 1e-6 || fail "the command line comes to other points than the window"
  ! within "$moved" 0.05 || fail "nothing moved"
}

# The weights of an edit, as "0.8 null".
weights_of() { tr -d '\n' <"$1" | sed -n 's/.*"example_weights": *\[\([^]]*\)\].*/\1/p' | tr -s ', ' ' ' | sed 's/^ //; s/ $//'; }

poses() {
  mkdir -p "$work/poses"
  cylinder 0 x 0 40 >"$work/rest.obj"
  cylinder 1.4 x 0 40 >"$work/poses/bent to the right.obj"
  cylinder 1.4 z 0 40 >"$work/poses/bent to the front, which has a long name.obj"
  cylinder 0 x 1.5 40 >"$work/poses/twisted.obj"
  cylinder 0 x 0 30 >"$work/other.obj"
  first_start 'rest.obj' "$work/rest.obj"
  press ctrl+o
  click 600 251 # the folder
  shot dialog
  click 342 585 # Open this folder
  until_done 30 title '^rest.obj \* - Sinew$'
  sleep 1
  shot added
  drag 1170 384 1200 384 # the bar of "twisted"
  shot bar
  press ctrl+s
  name "$work/blend.json"
  until_done 30 test -s "$work/blend.json"
  weights=$(weights_of "$work/blend.json")
  [[ $weights =~ ^null\ null\ 1\.[12] ]] || fail "the bar of the third pose gave the weights: $weights"
  press ctrl+e
  name "$work/window.obj"
  until_done 30 test -s "$work/window.obj"
  same_points "$work/rest.obj" "$work/blend.json"
  press ctrl+z
  click 1226 336 # pin the first
  click 1221 408 # Rest: all at 0
  shot rest
  click 1139 408 # Free all
  handles
  no_pose
  leave
  dropped
  from_the_command_line
}

# Two files at once, then their folder, which adds the third; Ctrl+S, Enter.
dropped() {
  printf '1 drop %s\t%s\n3 drop %s\n5 key 83 1 2\n5.1 key 83 0 2\n6 key 257 1 0\n6.1 key 257 0 0\n8 move 300 300\n' \
    "$work/poses/twisted.obj" "$work/poses/bent to the right.obj" "$work/poses" >"$work/drops"
  start_editor --play "$work/drops" "$work/rest.obj"
  until_done 60 test -s "$work/rest.edit.json"
  shot dropped
  local status=0
  wait "$editor_pid" || status=$?
  editor_pid=
  [ "$status" -eq 0 ] || fail "the drops ended with status $status"
  [ "$(grep -o 'poses/[^"]*' "$work/rest.edit.json" | cut -d/ -f2 | cut -c1-11 | paste -sd,)" = "bent to the,twisted.obj,bent to the" ] ||
    fail "dropped, these are the examples: $(grep -o 'poses/[^"]*' "$work/rest.edit.json")"
}

# One end held, the other pulled: the bars follow.
handles() {
  drag 470 97 540 112 # the front of the upper end
  press h
  sleep 1
  drag 430 570 580 640
  press k
  sleep 2
  follow 504 106 70
  sleep 2
  press alt+a
  shot pulled
  press ctrl+shift+s
  name "$work/pulled.json"
  until_done 30 test -s "$work/pulled.json"
  [ -z "$(weights_of "$work/pulled.json")" ] || fail "the weights are not free: $(weights_of "$work/pulled.json")"
  rm -f "$work/window.obj"
  press ctrl+e
  name "$work/window.obj"
  until_done 30 test -s "$work/window.obj"
  same_points "$work/rest.obj" "$work/pulled.json"
  click 1226 360 # pin the second where it is
  press ctrl+s
  sleep 1
  weights=$(weights_of "$work/pulled.json")
  [[ $weights =~ ^null\ [-.0-9e]+$ ]] || fail "the pin of the second pose gave the weights: $weights"
  shot pinned
}

# Another shape is told apart, and opened only if the user says so.
no_pose() {
  press u
  drag 1170 384 1180 384
  press ctrl+o
  sleep 0.6
  xdotool type --delay 20 other
  press Return
  sleep 1
  shot other
  press Escape
  title '^rest.obj' >/dev/null || fail "a shape that is no pose took the place of what was open"
  press ctrl+z
}

# Shape and folder together, the window at twice the size.
from_the_command_line() {
  sed -i '0,/{/s//{ "scale": 2,/' "$XDG_CONFIG_HOME"/sinew/*.json
  start_editor "$work/rest.obj" "$work/poses"
  until_done 60 title '^rest.obj \* - Sinew$'
  sleep 2
  point 960 500
  xdotool click --repeat 3 --delay 60 5
  point 400 300
  sleep 1
  shot large
  press ctrl+s
  name "$work/large.json"
  until_done 30 test -s "$work/large.json"
  [ "$(grep -c '\.obj"' "$work/large.json")" -ge 1 ] || fail "the edit names no poses"
  leave
}

# Five poses of a horse: a fore hoof is pulled, the hind ones held.
horse() {
  local data=${SINEW_SHARED:-$(dirname "$0")/../../../shared}/data/poses/sumner_horse
  [ -e "$data/1.obj" ] || { echo "skipped: no $data/1.obj"; exit 77; }
  mkdir -p "$work/horse"
  cp "$data"/[0-9]*.obj "$work/horse"
  start_editor --times "$work/times" "$work/horse"
  until_done 60 title '^1.obj \* - Sinew$'
  sleep 8
  press Return
  shot added
  drag 1147 384 1190 384 # the bar of the third pose, to about 1
  sleep 2
  shot blended
  latency "$work/times" "the bar, 8,431 points"
  cp "$work/times" "$work/times of the bar"
  press ctrl+z
  sleep 2
  drag 318 555 352 585 # a fore hoof
  press h
  drag 612 428 645 452 # the hind hooves
  press k
  drag 455 452 480 482
  press k
  sleep 3
  press alt+a
  follow 335 568 40
  sleep 4
  shot pulled
  click 1132 680 # Structure
  sleep 1
  shot structure
  press ctrl+s
  name "$work/hoof.json"
  until_done 30 test -s "$work/hoof.json"
  press ctrl+e
  name "$work/window.obj"
  until_done 30 test -s "$work/window.obj"
  leave
  tail -n +$(($(wc -l <"$work/times of the bar") + 1)) "$work/times" >"$work/times of the hoof"
  latency "$work/times of the hoof" "the hoof, 8,431 points"
  same_points "$work/horse/1.obj" "$work/hoof.json"
}

start_screen
"$what"
echo passed
