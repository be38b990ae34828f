#!/usr/bin/env bash
# editor_shapes_test.sh PROGRAMS jet|statue
#
# Bends what is no scan in the window as a person would: real mouse and keys, with the validation layer on.
#   jet     a stream of particles that come and go: pulled aside, scrubbed, played, exported; the command line must come to
#           the same particles, and their number and ids stay
#   statue  a solid: its base fixed, a band above it painted rigid, its top turned by 120 degrees; exported; the command line
#           must come to the same points, and the volume nearly stays
# SHOTS=FOLDER keeps screenshots. Exit status 77: skipped, with the reason.
# shellcheck source=tests/apps/window.sh
source "$(dirname "$0")/window.sh"

jet() {
  "$programs/sinew-samples" "$work" jet 2>/dev/null
  rm -f "$work"/*.edit.json
  first_start 'jet.####.ply' "$work/jet.####.ply"
  shot open
  press Right Right Right Right Right Right Right Right Right Right
  click 640 676
  sleep 2
  drag 235 280 340 400
  press k
  sleep 2
  drag 540 420 900 620
  press h
  sleep 2
  shot marked
  press g z 0 period 4 Return
  sleep 2
  shot pulled
  drag 640 676 900 676 # along the timeline
  sleep 1
  shot scrubbed
  press space
  sleep 2
  press space
  shot played
  press ctrl+s
  name "$work/edit.json"
  until_done 30 test -s "$work/edit.json"
  press ctrl+e
  name "$work/window.####.ply"
  until_done 120 test -s "$work/window.0072.ply"
  until_done 30 title '^jet.####.ply - Sinew$'
  leave
  "$programs/sinew" deform "$work/jet.####.ply" --edit "$work/edit.json" -o "$work/line.####.ply" 2>"$work/log" ||
    fail "sinew deform"
  local frame apart moved
  for frame in 0001 0024 0048 0072; do
    apart=$(distance "$work/line.$frame.ply" "$work/window.$frame.ply")
    moved=$(distance "$work/jet.$frame.ply" "$work/window.$frame.ply")
    echo "frame $frame: moved $moved, window and command line apart $apart of the diagonal"
    within "$apart" 1e-6 || fail "the command line comes to other particles than the window"
    ! within "$moved" 0.05 || fail "the stream was not pulled"
  done
}

statue() {
  "$programs/sinew-samples" "$work" cactus 2>/dev/null
  rm -f "$work"/*.edit.json
  first_start 'cactus.obj' "$work/cactus.obj"
  press alt+z  # what stands behind, too
  drag 430 540 570 615
  press k
  sleep 1
  click 1180 145 # the method
  shot methods
  click 1180 181 # tet
  sleep 3
  drag 430 490 570 538
  press j
  sleep 1
  drag 430 90 570 190
  press h
  sleep 2
  shot marked
  press alt+a
  press r z 1 2 0 Return
  sleep 3
  shot bowed
  press ctrl+s
  name "$work/edit.json"
  until_done 30 test -s "$work/edit.json"
  press ctrl+e
  name "$work/window.obj"
  until_done 30 test -s "$work/window.obj"
  shot saved
  leave
  grep -q '"rigid"' "$work/edit.json" || fail "the edit has no rigid region"
  "$programs/sinew" deform "$work/cactus.obj" --edit "$work/edit.json" -o "$work/line.obj" --report "$work/report.json" \
    2>"$work/log" || fail "sinew deform"
  local apart moved
  apart=$(distance "$work/line.obj" "$work/window.obj")
  moved=$(distance "$work/cactus.obj" "$work/window.obj")
  echo "moved $moved, window and command line apart $apart of the diagonal"
  within "$apart" 1e-6 || fail "the command line comes to other points than the window"
  ! within "$moved" 0.03 || fail "the top was not turned"
}

start_screen
case $what in
  jet) jet ;;
  statue) statue ;;
  *) fail "expected jet or statue, found '$what'" ;;
esac
echo "passed"
