#!/usr/bin/env bash
# editor_test.sh PROGRAMS story|time|splats|motion|cancel|large|storm
#
# Uses the window as a person would: real mouse and keys on a screen of its own, with the validation layer on.
#   story  opens the sample scan, marks head and feet by lasso, drags, undoes, redoes, saves, exports; the command line must come
#          to the same points; the recorded events, played again, too; a broken file is a sentence and changes nothing
#   time   opens the walking foal, marks, goes to another frame and drags there, which sets a key; plays, undoes, redoes,
#          saves, exports all frames; the command line must come to the same frames
#   splats opens Gaussian splats, marks, drags, saves, exports; the command line must come to the same file, covariances
#          and colours included
#   motion opens a bar with markers that lean, scrubs, plays, exports; the command line must come to the same frames; then
#          opens the motion onto the bar alone, aligns it, saves; then a dance of 40 markers with a body, where there is
#          one (SINEW_SHARED, or ../shared beside the sources)
#   cancel stops the making of tets by the button Cancel
#   large  opens, marks and drags 1,000,000 points
#   storm  500 sizes of the window, then hidden and shown again: no message, no more memory than after the first 100
# Prints how long the pictures of a drag took after their mouse events. SHOTS=FOLDER keeps screenshots.
# Exit status 77: skipped, with the reason.
# shellcheck source=tests/apps/window.sh
source "$(dirname "$0")/window.sh"

story() {
  "$programs/sinew-samples" "$work" scan 2>/dev/null
  rm -f "$work/scan.edit.json"
  local scan=$work/scan.ply
  first_start 'scan.ply' --record "$work/events" --times "$work/times" "$scan"
  shot open
  did press q
  did lasso 530 105 600 95 665 150 660 215 600 225 545 200
  shot selected
  did press h
  sleep 2
  did lasso 370 490 570 490 570 600 370 600
  did press k
  sleep 2
  looks_like marked
  shot marked
  did follow 592 170 60
  sleep 2
  looks_like dragged
  ! within "$(unlike "$work/marked.png" "$work/dragged.png")" 0.02 || fail "pictures of two shapes are not told apart"
  shot dragged
  until_done 10 title '^scan.ply \* - Sinew$'
  did press ctrl+z
  sleep 1
  shot undone
  press ctrl+e # to see that nothing is left
  name "$work/undone.ply"
  until_done 30 test -s "$work/undone.ply"
  within "$(distance "$scan" "$work/undone.ply")" 0 || fail "undo left the shape bent"
  did press ctrl+shift+z
  sleep 1
  press ctrl+s # for the command line
  name "$work/edit.json"
  until_done 30 test -s "$work/edit.json"
  did press ctrl+e
  did name "$work/window.ply"
  until_done 30 test -s "$work/window.ply"
  echo "$actions clicks and keys from the open scan to the exported one"
  [ "$actions" -le 12 ] || fail "more than 12 clicks and keys"
  sleep 1
  shot saved
  latency "$work/times" "79,000 points"

  "$programs/sinew" deform "$scan" --edit "$work/edit.json" -o "$work/line.ply" 2>"$work/log" || fail "sinew deform"
  local apart moved
  apart=$(distance "$work/line.ply" "$work/window.ply")
  moved=$(distance "$scan" "$work/window.ply")
  echo "moved $moved, window and command line apart $apart of the diagonal"
  within "$apart" 1e-6 || fail "the command line comes to other points than the window"
  within "$moved" 0.01 && fail "the drag moved nothing"

  head -c 3000 "$scan" >"$work/broken.ply"
  press ctrl+o
  sleep 0.6
  xdotool type --delay 20 broken
  press Return
  sleep 1
  shot broken
  title '^scan.ply - Sinew$' >/dev/null || fail "a broken file changed what is open"
  head -c 300 "$work/edit.json" >"$work/cut.json"
  press ctrl+o
  sleep 0.6
  xdotool type --delay 20 cut.json
  press Return
  sleep 1
  shot cut
  title '^scan.ply - Sinew$' >/dev/null || fail "a broken edit changed what is open"
  leave
  replay "$scan" "$work/window.ply"
}

replay() {
  mv "$work/window.ply" "$work/first.ply"
  rm -f "$work/undone.ply" "$work/edit.json"
  rm -rf "$work/config"
  start_editor --play "$work/events" "$1"
  local status=0
  wait "$editor_pid" || status=$?
  editor_pid=
  [ "$status" -eq 0 ] || fail "the replay left with status $status"
  [ -s "$work/window.ply" ] || fail "the replay exported nothing"
  local apart
  apart=$(distance "$work/first.ply" "$work/window.ply")
  echo "replay and first time apart $apart of the diagonal"
  within "$apart" 1e-6 || fail "the replay comes to other points"
}

# The largest distance between coordinates of two PC2 files of the same points; no number where they differ in size.
apart_in_time() {
  cmp -s -n 32 "$1" "$2" && [ "$(stat -c %s "$1")" = "$(stat -c %s "$2")" ] || return 0
  paste <(od -An -v -tf4 -w4 -j32 "$1") <(od -An -v -tf4 -w4 -j32 "$2") | awk '
    { d = $1 > $2 ? $1 - $2 : $2 - $1; if (!(d <= most)) most = d } END { printf "%.3g\n", most }'
}

# The frames of the keys of an edit's layers, in order.
keys_of() { tr -d ' \n' <"$1" | grep -o '"keys":.*' | grep -o '"frame":[0-9]*' | cut -d: -f2 | xargs; }

animation() {
  "$programs/sinew-samples" "$work" walk 2>/dev/null
  rm -f "$work"/*.edit.json
  first_start 'walk.####.obj' "$work/walk.####.obj"
  shot open
  drag 615 120 755 295
  press h
  sleep 2
  drag 325 440 590 570
  press k
  sleep 2
  shot marked
  press Right Right Right Right Right Right
  sleep 1
  press g x 0 period 3 Return
  sleep 1
  shot first-key
  point 999 676
  xdotool click 1
  sleep 2
  press g y 0 period 2 Return
  sleep 2
  shot second-key
  press space
  sleep 1.5
  shot playing
  press space
  sleep 2
  until_done 10 title '^walk.####.obj \* - Sinew$'
  press ctrl+z
  sleep 1
  press ctrl+s
  name "$work/one.json"
  until_done 30 test -s "$work/one.json"
  [ "$(keys_of "$work/one.json")" = 7 ] || fail "undone, there is not one key at 7 but: $(keys_of "$work/one.json")"
  press ctrl+shift+z
  sleep 1
  press ctrl+shift+s
  name "$work/edit.json"
  until_done 30 test -s "$work/edit.json"
  [ "$(keys_of "$work/edit.json")" = "7 18" ] || fail "not keys at 7 and 18 but: $(keys_of "$work/edit.json")"
  press ctrl+e
  name "$work/window.pc2"
  until_done 60 test -s "$work/window.pc2"
  shot saved
  leave

  "$programs/sinew" deform "$work/walk.####.obj" --edit "$work/edit.json" -o "$work/line.pc2" 2>"$work/log" ||
    fail "sinew deform"
  "$programs/sinew" convert "$work/walk.####.obj" "$work/rest.pc2" 2>"$work/log" || fail "sinew convert"
  local apart moved
  apart=$(apart_in_time "$work/line.pc2" "$work/window.pc2")
  moved=$(apart_in_time "$work/rest.pc2" "$work/window.pc2")
  echo "moved $moved, window and command line apart $apart"
  within "$apart" 1e-6 || fail "the command line comes to other frames than the window"
  ! within "$moved" 0.1 || fail "the drags moved nothing"
}

splats() {
  "$programs/sinew-samples" "$work" splats 2>/dev/null
  rm -f "$work/splats.edit.json"
  first_start 'splats.ply' "$work/splats.ply"
  shot open
  drag 530 105 665 215
  press h
  sleep 2
  drag 370 490 570 600
  press k
  sleep 2
  shot marked
  follow 592 170 40
  sleep 2
  press alt+a
  shot dragged
  press ctrl+s
  name "$work/edit.json"
  until_done 30 test -s "$work/edit.json"
  press ctrl+e
  name "$work/window.ply"
  until_done 30 test -s "$work/window.ply"
  leave
  "$programs/sinew" deform "$work/splats.ply" --edit "$work/edit.json" -o "$work/line.ply" 2>"$work/log" ||
    fail "sinew deform"
  ! cmp -s "$work/splats.ply" "$work/window.ply" || fail "the drag bent nothing"
  cmp "$work/line.ply" "$work/window.ply" || fail "the command line comes to other splats than the window"
}

# A box along y of so many cells of so much (across, along, cell), closed, as OBJ.
box() {
  awk -v n="$1" -v m="$2" -v h="$3" '
    function v(i, j, k) {
      if (!((i, j, k) in at)) { at[i, j, k] = ++count; printf "v %.9g %.9g %.9g\n", (i - n / 2) * h, j * h, (k - n / 2) * h }
      return at[i, j, k]
    }
    function quad(a, b, c, d) { printf "f %d %d %d\nf %d %d %d\n", a, b, c, a, c, d }
    BEGIN {
      for (i = 0; i < n; ++i) for (k = 0; k < n; ++k) {
        quad(v(i, 0, k), v(i + 1, 0, k), v(i + 1, 0, k + 1), v(i, 0, k + 1))
        quad(v(i, m, k), v(i, m, k + 1), v(i + 1, m, k + 1), v(i + 1, m, k))
      }
      for (i = 0; i < n; ++i) for (j = 0; j < m; ++j) {
        quad(v(i, j, 0), v(i, j + 1, 0), v(i + 1, j + 1, 0), v(i + 1, j, 0))
        quad(v(i, j, n), v(i + 1, j, n), v(i + 1, j + 1, n), v(i, j + 1, n))
        quad(v(0, j, i), v(0, j, i + 1), v(0, j + 1, i + 1), v(0, j + 1, i))
        quad(v(n, j, i), v(n, j + 1, i), v(n, j + 1, i + 1), v(n, j, i + 1))
      }
    }'
}

# 24 frames of six markers in millimetres, z up: four at the foot of a bar of 0.2 x 1 x 0.2, one above its top and one in
# the middle of it, which lean over; the last is not seen in frames 9 to 12, the one before it from 20 on.
lean() {
  awk 'BEGIN {
    print "frame,time,A.x,A.y,A.z,B.x,B.y,B.z,C.x,C.y,C.z,D.x,D.y,D.z,E.x,E.y,E.z,F.x,F.y,F.z"
    for (f = 1; f <= 24; ++f) {
      a = 0.045 * (f - 1); s = sin(a); c = cos(a)
      printf "%d,%.4f,-100,100,0,100,100,0,100,-100,0,-100,-100,0", f, (f - 1) / 12
      if (f >= 20) printf ",,,"
      else printf ",%.3f,0,%.3f", 1050 * s * 0.6, 1050 * (0.4 + 0.6 * c)
      if (f >= 9 && f <= 12) print ",,,"
      else printf ",%.3f,-60,%.3f\n", 600 * s * 0.5, 600 * (0.5 + 0.5 * c)
    }
  }'
}

motion() {
  box 8 40 0.025 >"$work/bar.obj"
  lean >"$work/lean.csv"
  cat >"$work/lean.json" <<'EDIT'
{ "sinew": 1, "inputs": ["bar.obj"], "layers": [ { "method": "tet", "markers": { "file": "lean.csv", "matches": [
  { "name": "A", "place": [-0.1, 0, -0.1] }, { "name": "B", "place": [0.1, 0, -0.1] },
  { "name": "C", "place": [0.1, 0, 0.1] } ] } } ] }
EDIT
  start_editor "$work/lean.json"
  until_done 60 title '^bar.obj - Sinew$'
  sleep 3
  press Return # the standard navigation
  shot open
  press Right Right Right Right Right Right Right Right Right Right
  sleep 1
  shot bridged
  press space
  sleep 1
  shot playing
  press space
  press shift+Right
  sleep 1
  shot last
  press ctrl+e
  name "$work/window.pc2"
  until_done 60 test -s "$work/window.pc2"
  leave
  "$programs/sinew" deform "$work/bar.obj" --edit "$work/lean.json" -o "$work/line.pc2" 2>"$work/log" || fail "sinew deform"
  local apart bytes
  apart=$(apart_in_time "$work/line.pc2" "$work/window.pc2")
  bytes=$(stat -c %s "$work/window.pc2")
  echo "window and command line apart $apart in 24 frames of $bytes bytes"
  within "$apart" 1e-6 || fail "the command line comes to other frames than the window"
  [ "$(od -An -tu4 -j28 -N4 "$work/window.pc2" | tr -d ' ')" = 24 ] || fail "not 24 frames"
  drop_motion
  dance
}

# A new user's way: the shape, then the motion, then a number in the column.
drop_motion() {
  start_editor "$work/bar.obj"
  until_done 60 title '^bar.obj - Sinew$'
  sleep 1
  press ctrl+o
  sleep 0.6
  xdotool type --delay 20 lean.csv
  press Return
  until_done 30 title '^bar.obj \* - Sinew$'
  sleep 3
  shot dropped
  point 1180 308 # the field Scale
  xdotool click --repeat 2 --delay 60 1
  sleep 0.6
  xdotool key ctrl+a
  xdotool type --delay 20 0.001
  press Return
  sleep 1
  shot aligned
  press shift+Right
  sleep 1
  shot dropped-last
  press ctrl+s
  name "$work/dropped.json"
  until_done 30 test -s "$work/dropped.json"
  grep -q '"scale": 0.001\b' "$work/dropped.json" || fail "the saved edit has another scale than was typed"
  press ctrl+e
  name "$work/dropped.pc2"
  until_done 60 test -s "$work/dropped.pc2"
  leave
  "$programs/sinew" deform "$work/bar.obj" --edit "$work/dropped.json" -o "$work/dropped-line.pc2" 2>"$work/log" ||
    fail "sinew deform of the edit with the dropped motion"
  local apart
  apart=$(apart_in_time "$work/dropped-line.pc2" "$work/dropped.pc2")
  echo "dropped: window and command line apart $apart"
  within "$apart" 1e-6 || fail "the command line comes to other frames of the dropped motion"
}

# Matches of the armadillo and the dance, found by hand.
dance() {
  local data=${SINEW_SHARED:-$(dirname "$0")/../../../shared}/data
  if [ ! -e "$data/mocap/c3d/Dance.c3d" ] || [ ! -e "$data/meshes/armadillo.obj" ]; then
    echo "the dance is skipped: no $data/mocap/c3d/Dance.c3d or meshes/armadillo.obj"
    return
  fi
  data=$(realpath "$data")
  {
    echo "{ \"sinew\": 1, \"inputs\": [\"$data/meshes/armadillo.obj\"], \"layers\": [ { \"method\": \"tet\","
    echo "\"settings\": { \"vertices\": 1500 }, \"markers\": { \"file\": \"$data/mocap/c3d/Dance.c3d\", \"corresponding\": true,"
    echo '"matches": ['
    awk '{ name = $1; $1 = ""; printf "%s{ \"name\": \"Channel%s\", \"place\": [%s ] }", (NR > 1 ? ",\n" : ""), name, $0 }' <<'MATCHES'
101 0.03, 0.33, -0.12
103 -0.04, 0.33, 0.1
110 0, 0.15, 0.12
163 0, 0.12, -0.2
113 -0.08, -0.12, 0
159 0.05, -0.12, -0.19
117 -0.16, 0.23, -0.05
118 -0.29, 0.12, -0.05
125 -0.35, 0.22, 0.1
156 0.16, 0.23, -0.05
154 0.28, 0.12, 0
145 0.33, 0.22, 0.2
123 -0.2, -0.3, -0.02
129 -0.22, -0.55, 0.02
150 0.22, -0.3, -0.01
141 0.27, -0.55, 0.04
MATCHES
    echo '] } } ] }'
  } >"$work/dance.json"
  start_editor "$work/dance.json"
  until_done 60 title '^armadillo.obj - Sinew$'
  sleep 8
  shot dance-first
  press space
  sleep 3
  shot dance-playing
  press space
  sleep 4
  shot dance-stopped
  press shift+Right
  sleep 4
  shot dance-last
  press ctrl+e
  name "$work/last.obj"
  until_done 60 test -s "$work/last.obj"
  leave
  "$programs/sinew" deform "$data/meshes/armadillo.obj" --edit "$work/dance.json" --frames 499 -o "$work/line.####.obj" \
    2>"$work/log" || fail "sinew deform"
  local apart
  apart=$(distance "$work/line.0499.obj" "$work/last.obj")
  echo "the dance's last frame, window and command line apart $apart of the diagonal"
  within "$apart" 1e-6 || fail "the command line comes to another last frame than the window"
}

tets_run() { pgrep -P "$editor_pid" -x sinew-tets; }
no_tets_run() { ! tets_run; }

cancel() {
  command -v pgrep >/dev/null || { echo "skipped: pgrep is not installed"; exit 77; }
  box 60 240 0.01 >"$work/large.obj"
  echo '{ "sinew": 1, "inputs": ["large.obj"], "layers": [ { "method": "tet", "settings": { "vertices": 100000 } } ] }' >"$work/slow.json"
  start_editor "$work/slow.json"
  until_done 60 title '^large.obj - Sinew$'
  until_done 30 tets_run
  press Return
  sleep 1
  shot making
  tets_run >/dev/null || fail "the tets were there before they could be cancelled"
  local began=$SECONDS
  point 626 656
  xdotool click 1
  until_done 3 no_tets_run
  echo "cancelled within $((SECONDS - began + 1)) s"
  sleep 1
  shot cancelled
  no_tets_run || fail "the tets are made again by themselves"
  leave
}

large() {
  "$programs/sinew-samples" "$work" large --points 1000000 --normals 2>/dev/null
  start_editor --times "$work/times" "$work/large.ply"
  until_done 120 title '^large.ply - Sinew$'
  sleep 5
  press Return
  shot open
  drag 530 105 665 215
  press h
  sleep 3
  drag 370 490 570 600
  press k
  sleep 5
  shot marked
  follow 592 170 40
  sleep 5
  shot dragged
  until_done 20 title '^large.ply \* - Sinew$'
  latency "$work/times" "1,000,000 points"
  press ctrl+z ctrl+z ctrl+z
  until_done 20 title '^large.ply - Sinew$'
  leave
}

resize() {
  for ((i = 0; i < $2; ++i)); do
    xdotool windowsize "$1" $((500 + (i * 389) % 780)) $((330 + (i * 211) % 390))
    sleep 0.02
  done
  sleep 1
}
memory() { sed -n 's/^VmRSS:[[:space:]]*\([0-9]*\) kB/\1/p' "/proc/$editor_pid/status"; }

storm() {
  "$programs/sinew-samples" "$work" scan 2>/dev/null
  start_editor "$work/scan.ply"
  until_done 60 title '^scan.ply - Sinew$'
  local window first last
  window=$(title '^scan.ply - Sinew$' | head -n 1)
  resize "$window" 100
  first=$(memory)
  resize "$window" 400
  last=$(memory)
  echo "resident after 100 sizes ${first} kB, after 500 ${last} kB"
  [ "$last" -lt $((first + first / 5)) ] || fail "memory grew"
  xdotool windowunmap "$window"
  sleep 1
  xdotool windowmap "$window"
  xdotool windowsize "$window" 1280 720
  sleep 1
  shot after
  xdotool mousemove 600 300
  press Return
  leave
}

start_screen
case $what in
  time) animation ;; # a word of the shell
  *) "$what" ;;
esac
echo passed
