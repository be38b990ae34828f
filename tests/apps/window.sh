# shellcheck shell=bash
# What the tests of the window share: a screen of its own, real mouse and keys, screenshots, distances. To be sourced with
# the folder of the programs and the name of the story as arguments.
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
export HOME=$work/home XDG_CONFIG_HOME=$work/config XDG_STATE_HOME=$work/state XDG_CACHE_HOME=$work/home/.cache
export SINEW_VALIDATION=${SINEW_VALIDATION:-1}
export DBUS_SESSION_BUS_ADDRESS=unix:path=$work/no-bus # the program's own file dialogs
mkdir -p "$HOME"

fail() {
  echo "failed: $*"
  shot failed
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

# first_start TITLE ARGUMENT...: the editor's first start with these files, and the standard navigation.
first_start() {
  local title=$1
  shift
  start_editor "$@"
  until_done 60 title "^$title - Sinew\$"
  sleep 2
  press Return
}

# did COMMAND...: what a person would count as one click or key.
actions=0
did() {
  actions=$((actions + 1))
  "$@"
}

title() { xdotool search --name "$1"; }
shot() { if [ -n "${SHOTS:-}" ] && command -v import >/dev/null; then sleep 1; import -window root "$SHOTS/$what-$1.png"; fi; }

# small FILE: what is on the screen, an eighth of its size.
small() { import -window root -resize 160x90 -strip "$1"; }
# How far two pictures are apart: root mean square of their colours, 0 to 1.
unlike() { { compare -metric RMSE "$1" "$2" null: 2>&1 || true; } | sed 's/.*(\(.*\))/\1/'; }

# looks_like NAME: the window is as in tests/apps/looks/NAME.png but for times and counts in its text. With
# SINEW_NEW_PICTURES=1 that is made anew.
looks_like() {
  local wanted
  wanted=$(dirname "${BASH_SOURCE[0]}")/looks/$1.png
  sleep 1
  small "$work/$1.png"
  if [ -n "${SINEW_NEW_PICTURES:-}" ]; then
    mkdir -p "$(dirname "$wanted")"
    cp "$work/$1.png" "$wanted"
  fi
  local apart
  apart=$(unlike "$wanted" "$work/$1.png")
  echo "the window and its picture $1 are $apart apart"
  within "$apart" 0.02 || fail "the window does not look like tests/apps/looks/$1.png"
}

press() { xdotool key "$@"; sleep 0.6; }
point() { xdotool mousemove "$1" "$2"; sleep 0.15; }

click() {
  point "$1" "$2"
  xdotool click 1
  sleep 0.8
}

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

# lasso X Y X Y ...: around these corners, with the left button.
lasso() {
  point "$1" "$2"
  xdotool mousedown 1
  sleep 0.2
  while [ $# -ge 2 ]; do
    point "$1" "$2"
    shift 2
  done
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
    END {
      printf "%s: %d pictures of the drag, event to picture p50 %.1f ms, p95 %.1f ms", name, NR, t[int((NR + 1) / 2)],
             t[int(NR * 0.95 + 0.5)]
      print (points > 0 ? sprintf(", %d points each", points / NR) : "")
    }'
}

# largest distance of points, in units of the diagonal
distance() {
  "$programs/sinew" diff "$1" "$2" | sed -n 's/^distance .*(\([^ ]*\) and.*/\1/p'
}
within() { awk -v d="$1" -v limit="$2" 'BEGIN { exit !(d != "" && d + 0 <= limit) }'; }
