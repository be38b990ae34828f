#!/usr/bin/env bash
# editor_select_test.sh PROGRAMS select|control
#
# Selects in the window as a person would: real mouse and keys, with the validation layer on.
#   select   the scan's head by a polygon with a corner taken back, feet by the sphere brush, a box in space moved and given
#            up, a range of an attribute, points hidden and shown; the head scaled by S and a typed number; undone, redone,
#            saved, exported; the command line must come to the same points
#   control  control points dropped by their file onto a strip that drifted, their residuals, the worst one framed; saved,
#            exported; the command line must come to the same points and residuals; at scale 2
# SHOTS=FOLDER keeps screenshots. Exit status 77: skipped, with the reason.
# shellcheck source=tests/apps/window.sh
source "$(dirname "$0")/window.sh"

# by_name WORDS: a command, by the palette.
by_name() {
  press ctrl+p
  xdotool type --delay 20 "$1"
  press Return
}

# same_points FILE EDIT: what was exported and what the command line makes of the saved edit.
same_points() {
  "$programs/sinew" deform "$1" --edit "$2" -o "$work/line.ply" --report "$work/report.json" --force 2>"$work/log" ||
    fail "sinew deform"
  local apart moved
  apart=$(distance "$work/line.ply" "$work/window.ply")
  moved=$(distance "$1" "$work/window.ply")
  echo "moved $moved, window and command line apart $apart of the diagonal"
  within "$apart" 1e-6 || fail "the command line comes to other points than the window"
  ! within "$moved" 0.005 || fail "nothing moved"
}

save_and_export() {
  press ctrl+shift+s
  name "$work/edit.json"
  until_done 30 test -s "$work/edit.json"
  press ctrl+e
  name "$work/window.ply"
  until_done 30 test -s "$work/window.ply"
}

# The members of an edit without blanks.
plain() { tr -d ' \n' <"$1"; }

# How many points an edit fixes.
fixed_points() { plain "$1" | sed -n 's/.*"fixed":\[{"indices":\[\([^]]*\)\].*/\1/p' | tr ',' '\n' | wc -l; }

pick() {
  "$programs/sinew-samples" "$work" scan 2>/dev/null
  rm -f "$work/scan.edit.json"
  first_start 'scan.ply' "$work/scan.ply"
  press p
  click 530 105
  click 665 105
  click 690 300 # too far
  press BackSpace
  click 665 215
  point 530 215
  shot polygon
  click 530 215
  click 533 107 # the first corner
  shot polygon-closed
  press h
  sleep 2
  press o
  press bracketright
  press bracketright
  press bracketright
  drag 420 540 520 560
  point 440 370
  shot ball
  press k
  sleep 2
  press ctrl+s
  name "$work/feet.json"
  until_done 30 test -s "$work/feet.json"
  # The tail as well: a double click closes what Shift adds to the feet.
  press p
  xdotool keydown shift
  click 360 340
  click 392 340
  click 392 445
  point 360 445
  xdotool click --repeat 2 --delay 60 1
  xdotool keyup shift
  sleep 0.5
  shot tail
  press k
  sleep 2
  shot marked

  press alt+a
  press shift+o
  click 450 370 # the back
  shot volume
  press g x 0 period 2 Return
  shot volume-moved
  press Escape
  press v
  by_name "by attribute"
  sleep 0.5
  shot attribute
  drag 738 195 850 195 # the lower end of the histogram
  shot attribute-range
  press Return
  press ctrl+h
  sleep 0.5
  shot hidden
  press alt+h
  sleep 0.5

  click 32 156 # the tool that scales
  click 592 170 # the head's handle
  drag 592 92 592 85
  shot scale-gizmo
  press ctrl+z
  press s 1 period 4
  shot scaling
  press Return
  sleep 2
  shot scaled
  until_done 10 title '^scan.ply \* - Sinew$'
  press ctrl+z
  sleep 1
  press ctrl+shift+z
  sleep 1
  save_and_export
  plain "$work/edit.json" | grep -q '"matrix":\[\[1.4,0,0,' || fail "the saved edit has no scale"
  local feet fixed
  feet=$(fixed_points "$work/feet.json") fixed=$(fixed_points "$work/edit.json")
  echo "fixed: $feet points of the feet, $fixed with the tail"
  [ "$feet" -gt 500 ] || fail "the sphere brush fixed few points"
  [ "$fixed" -gt $((feet + 100)) ] || fail "the polygon added no tail"
  leave
  same_points "$work/scan.ply" "$work/edit.json"
}

# A strip of 40 x 4 m with waves, along x, at UTM coordinates, as PLY of doubles in text.
strip() {
  awk 'BEGIN {
    print "ply\nformat ascii 1.0\nelement vertex 4221\nproperty double x\nproperty double y\nproperty double z\nend_header"
    for (i = 0; i <= 200; ++i) for (j = 0; j <= 20; ++j)
      printf "%.4f %.4f %.6f\n", 5400000 + 0.2 * i, 600000 + 0.2 * j, 100 + 0.3 * sin(0.5 * i)
  }'
}

# 18 control points of it, each 5 m on both sides, where they belong after a drift; one is wrong.
survey() {
  awk 'BEGIN {
    print "name,x,y,z,tx,ty,tz"
    for (i = 0; i <= 200; i += 25) for (j = 1; j <= 19; j += 18) {
      x = 5400000 + 0.2 * i; y = 600000 + 0.2 * j; z = 100 + 0.3 * sin(0.5 * i); d = 0.2 * i
      wrong = i == 100 && j == 1
      printf "%s%d-%d,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f\n", wrong ? "wrong " : "P", i, j, x, y, z,
             x, y + 0.002 * d * d, z - 0.0004 * d * d + (wrong ? 0.8 : 0)
    }
  }'
}

control() {
  strip >"$work/strip.ply"
  survey >"$work/survey.csv"
  first_start 'strip.ply' "$work/strip.ply"
  press ctrl+o
  sleep 0.6
  xdotool type --delay 20 survey
  press Return
  until_done 30 title '^strip.ply \* - Sinew$'
  sleep 3
  shot residuals
  click 160 130 # the first row
  sleep 1
  shot worst
  save_and_export
  leave
  same_points "$work/strip.ply" "$work/edit.json"
  plain "$work/edit.json" | grep -q '"name":"wrong100-1"' || fail "the control points have lost their names"
  sed -i '0,/{/s//{ "scale": 2,/' "$XDG_CONFIG_HOME"/sinew/*.json
  start_editor "$work/edit.json"
  until_done 60 title '^strip.ply - Sinew$'
  sleep 2
  by_name residuals
  sleep 1
  shot residuals-scale-2
  by_name "by attribute"
  sleep 1
  shot attribute-scale-2
  press Escape
  leave
  [ "$(plain "$work/report.json" | grep -o '"name":"[^"]*"' | wc -l)" = 18 ] || fail "not 18 residuals in the report"
}

start_screen
case $what in
  select) pick ;; # a word of the shell
  *) "$what" ;;
esac
echo passed
