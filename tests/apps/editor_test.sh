#!/usr/bin/env bash
# editor_test.sh PROGRAMS story|time|splats|large|storm
#
# Uses the window as a person would: real mouse and keys on a screen of its own, with the validation layer on.
#   story  opens the sample scan, marks head and feet, drags, undoes, redoes, saves, exports; the command line must come
#          to the same points; the recorded events, played again, too; a broken file is a sentence and changes nothing
#   time   opens the walking foal, marks, goes to another frame and drags there, which sets a key; plays, undoes, redoes,
#          saves, exports all frames; the command line must come to the same frames
#   splats opens Gaussian splats, marks, drags, saves, exports; the command line must come to the same file, covariances
#          and colours included
#   large  opens, marks and drags 1,000,000 points
#   storm  500 sizes of the window, then hidden and shown again: no message, no more memory than after the first 100
# Prints how long the pictures of a drag took after their mouse events. SHOTS=FOLDER keeps screenshots.
# Exit status 77: skipped, with the reason.
set -euo pipefail
programs=$1 what=$2
for tool in Xvfb xdotool; do
  command -v "$tool" >/dev/null || { echo "skipped: $tool is not installed"; exit 77; }
done

work=$(mktemp -d)
screen_pid='' editor_pid=''
finish() {
  [ -z "$editor_pid" ] || kill "$editor_pid" 2>/dev/null || true
  [ -z "$screen_pid" ] || kill "$screen_pid" 2>/dev/null || true
  rm -rf "$work"
}
trap finish EXIT
export HOME=$work/home XDG_CONFIG_HOME=$work/config SINEW_VALIDATION=${SINEW_VALIDATION:-1}
mkdir -p "$HOME"

fail() {
  echo "failed: $*"
  [ ! -s "$work/log" ] || sed 's/^/  /' "$work/log"
  exit 1
}

# until_done SECONDS COMMAND...: waits until the command succeeds.
until_done() {
  local end=$((SECONDS + $1))
  shift
  until "$@" >/dev/null 2>&1; do
    [ $SECONDS -lt $end ] || fail "waited too long for: $*"
    sleep 0.2
  done
}

# -noreset: else the server starts anew whenever its last client leaves, and is away for a moment.
start_screen() {
  exec 5>"$work/display"
  Xvfb -displayfd 5 -screen 0 1280x720x24 -noreset >/dev/null 2>&1 &
  screen_pid=$!
  until_done 20 test -s "$work/display"
  DISPLAY=:$(cat "$work/display")
  export DISPLAY
  until_done 20 xdotool getmouselocation
}

start_editor() {
  "$programs/sinew-editor" "$@" >"$work/log" 2>&1 &
  editor_pid=$!
}

title() { xdotool search --name "$1"; }
shot() { if [ -n "${SHOTS:-}" ] && command -v import >/dev/null; then sleep 1; import -window root "$SHOTS/$what-$1.png"; fi; }
press() { xdotool key "$@"; sleep 0.6; }
point() { xdotool mousemove "$1" "$2"; sleep 0.15; }

# drag X Y X Y: with the left button, in a few steps.
drag() {
  point "$1" "$2"
  xdotool mousedown 1
  sleep 0.2
  for part in 1 2 3; do point $(($1 + ($3 - $1) * part / 3)) $(($2 + ($4 - $2) * part / 3)); done
  sleep 0.2
  xdotool mouseup 1
  sleep 0.6
}

# follow X Y STEPS: the handle at X Y, 2 pixels right and 1 down a step.
follow() {
  point "$1" "$2"
  xdotool mousedown 1
  sleep 0.2
  for ((step = 1; step <= $3; ++step)); do
    xdotool mousemove $(($1 + 2 * step)) $(($2 + step))
    sleep 0.03
  done
  sleep 0.5
  shot drag
  xdotool mouseup 1
  sleep 0.6
}

# In a dialog that asks for a name: this path, Enter.
name() {
  sleep 0.6
  xdotool key ctrl+a
  xdotool type --delay 20 "$1"
  press Return
}

# The program must leave with status 0: no message of the validation layer, no error.
leave() {
  press ctrl+q
  local status=0
  wait "$editor_pid" || status=$?
  editor_pid=
  [ "$status" -eq 0 ] || fail "the editor left with status $status"
}

latency() {
  [ -s "$1" ] || fail "no picture of the drag was timed"
  sort -n "$1" | awk -v name="$2" '
    { t[NR] = $1 * 1000; points += $2 }
    END { printf "%s: %d pictures of the drag, event to picture p50 %.1f ms, p95 %.1f ms, %d points each\n", name, NR,
          t[int((NR + 1) / 2)], t[int(NR * 0.95 + 0.5)], points / NR }'
}

# largest distance of points, in units of the diagonal
distance() {
  "$programs/sinew" diff "$1" "$2" | sed -n 's/^distance .*(\([^ ]*\) and.*/\1/p'
}
within() { awk -v d="$1" -v limit="$2" 'BEGIN { exit !(d != "" && d + 0 <= limit) }'; }

story() {
  "$programs/sinew-samples" "$work" scan 2>/dev/null
  rm -f "$work/scan.edit.json"
  local scan=$work/scan.ply
  start_editor --record "$work/events" --times "$work/times" "$scan"
  until_done 60 title '^scan.ply - Sinew$'
  sleep 2
  press Return # the standard navigation
  shot open
  drag 530 105 665 215
  shot selected
  press h
  sleep 2
  drag 370 490 570 600
  press k
  sleep 2
  shot marked
  follow 592 170 60
  sleep 2
  shot dragged
  until_done 10 title '^scan.ply \* - Sinew$'
  press ctrl+z
  sleep 1
  shot undone
  press ctrl+e
  name "$work/undone.ply"
  until_done 30 test -s "$work/undone.ply"
  within "$(distance "$scan" "$work/undone.ply")" 0 || fail "undo left the shape bent"
  press ctrl+shift+z
  sleep 1
  press ctrl+s
  name "$work/edit.json"
  until_done 30 test -s "$work/edit.json"
  press ctrl+e
  name "$work/window.ply"
  until_done 30 test -s "$work/window.ply"
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
  start_editor "$work/walk.####.obj"
  until_done 60 title '^walk.####.obj - Sinew$'
  sleep 2
  press Return # the standard navigation
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
  start_editor "$work/splats.ply"
  until_done 60 title '^splats.ply - Sinew$'
  sleep 2
  press Return
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
