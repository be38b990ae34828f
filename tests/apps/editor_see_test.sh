#!/usr/bin/env bash
# editor_see_test.sh PROGRAMS see|portal
#
# Uses the window as a person would, as editor_test.sh does:
#   see    opens one of two numbered scans, which are offered as a sequence; goes on with the scan and edits it; colours it
#          by what the edit does and drags the range at the legend; the copied command line, run by a shell, must come to
#          the points that the window exports; a turntable is written while the window goes on, another is cancelled; the
#          next start shows the scan among the recent files
#   portal a desktop is there, whose own file dialog is asked: to open, and to export to a format that loses something,
#          which the window then tells before it writes
# SHOTS=FOLDER keeps screenshots. Exit status 77: skipped, with the reason.
# shellcheck source=tests/apps/window.sh
source "$(dirname "$0")/window.sh"

for tool in xclip import convert; do
  command -v "$tool" >/dev/null || { echo "skipped: $tool is not installed"; exit 77; }
done

portal_pid='' bus_pid=''
trap '[ -z "$portal_pid" ] || kill "$portal_pid" "$bus_pid" 2>/dev/null || true; finish' EXIT

# The command that these words find.
palette() {
  press ctrl+p
  xdotool type --delay 20 "$1"
  sleep 0.3
  press Return
}

# part_of LEFT TOP WIDTH HEIGHT EXPRESSION: of a part of the screen, the share of pixels where the expression of r, g and
# b holds.
part_of() {
  import -window root -crop "$3x$4+$1+$2" +repage -depth 8 "$work/part.png"
  convert "$work/part.png" -fx "$5" -format '%[fx:mean]' info:
}
more_than() { awk -v a="$1" -v b="$2" 'BEGIN { exit !(a > b) }'; }

# The legend's bar of colours, and where the shape is.
bar=(907 160 10 140)
shape=(370 110 400 470)
yellow='g>b+0.25&&r>0.35' violet='b>g+0.12&&g<0.3'

see() {
  PATH=$(cd "$programs" && pwd):$PATH # what is copied begins with the program's name alone
  "$programs/sinew-samples" "$work" scan 2>/dev/null
  local folder="$work/it's a folder"
  mkdir "$folder"
  local scan="$folder/scan.0001.ply"
  cp "$work/scan.ply" "$scan"
  cp "$work/scan.ply" "$folder/scan.0002.ply"
  first_start 'scan.0001.ply' --times "$work/times" "$scan"
  shot offered
  drag 530 105 665 215
  press h
  sleep 2
  drag 370 490 570 600
  press k
  sleep 2
  press alt+a
  heat
  command_line "$folder" "$scan"
  turntables "$folder"
  leave
  recent "$scan"
  sequence "$scan"
}

# The displacement as colours, and their range.
heat() {
  point 1190 533 # Colour by
  xdotool click 1
  sleep 0.6
  shot choices
  point 1190 429 # Displacement
  xdotool click 1
  sleep 1
  follow 592 170 60
  sleep 2
  latency "$work/times" "79,000 points coloured by displacement"
  shot heat
  local before after
  before=$(part_of "${shape[@]}" "$yellow")
  more_than "$before" 0.005 || fail "the head went far and is not yellow"
  more_than "$(part_of "${shape[@]}" "$violet")" 0.005 || fail "the feet stayed and are not violet"
  more_than "$(part_of "${bar[@]}" "$yellow")" 0.03 || fail "no legend, or without yellow"
  drag 911 "$high_end" 911 232
  shot range
  after=$(part_of "${shape[@]}" "$yellow")
  more_than "$after" "$(awk -v b="$before" 'BEGIN { print 1.5 * b }')" || fail "half the range, but no more yellow"
  xdotool mousemove 911 230 click --repeat 2 --delay 60 1
  sleep 1
  more_than "$(awk -v b="$before" 'BEGIN { print 1.2 * b }')" "$(part_of "${shape[@]}" "$yellow")" ||
    fail "a double click did not set the range back"
}
high_end=160

clipboard() { timeout 5 xclip -selection clipboard -o 2>/dev/null || true; }
copied() { clipboard | grep -q '^sinew deform '; }

command_line() {
  press ctrl+shift+c
  sleep 0.6
  shot not-saved
  ! copied || fail "copied a command line for an edit that has no file"
  # The question is answered by its button.
  point "${save_and_copy[@]}"
  xdotool click 1
  sleep 0.6
  name "$1/an edit.json"
  until_done 30 test -s "$1/an edit.json"
  until_done 10 copied
  sleep 0.6
  shot copied
  local line
  line=$(clipboard)
  echo "copied: $line"
  press ctrl+e
  name "$work/window.ply"
  until_done 30 test -s "$work/window.ply"
  (cd / && eval "$line") 2>"$work/log" || fail "the copied command line"
  local apart
  apart=$(distance "$1/scan.0001-bent.ply" "$work/window.ply")
  echo "copied command line and window apart $apart of the diagonal"
  within "$apart" 1e-6 || fail "the copied command line comes to other points"
  within "$(distance "$2" "$work/window.ply")" 0.01 && fail "the drag moved nothing"
  # Changed since: it says so.
  press g y 0 period 0 5 Return
  sleep 2
  xclip -selection clipboard </dev/null
  press ctrl+shift+c
  shot changed
  ! copied || fail "copied a command line for an edit that has changed"
  press Escape
  press ctrl+z
  sleep 1
}
save_and_copy=(664 332)

turntables() {
  palette turntable
  shot turntable
  press Return
  name "$1/turn.####.png"
  sleep 0.5
  shot drawing
  point 592 400
  # While it draws, the view turns.
  local before after
  before=$(import -window root -crop 900x600+60+60 +repage rgba:- | cksum)
  press KP_4
  sleep 1
  after=$(import -window root -crop 900x600+60+60 +repage rgba:- | cksum)
  [ "$before" != "$after" ] || fail "the window stands still while a turntable is drawn"
  [ ! -e "$1/turn.0060.png" ] || echo "the turntable was done before the view had turned"
  until_done 120 test -s "$1/turn.0060.png"
  sleep 1
  [ "$(find "$1" -name 'turn.*.png' | wc -l)" = 60 ] || fail "not 60 pictures"
  [ "$(identify -format '%wx%h' "$1/turn.0031.png")" = 1280x720 ] || fail "pictures of another size"
  ! cmp -s "$1/turn.0001.png" "$1/turn.0031.png" || fail "the turntable does not turn"
  if [ -n "${SHOTS:-}" ]; then cp "$1/turn.0031.png" "$SHOTS/see-turn-31.png"; fi

  palette turntable
  press Return
  name "$1/half.####.png"
  until_done 30 test -s "$1/half.0002.png"
  point "${cancel[@]}"
  xdotool click 1
  sleep 2
  shot cancelled
  local drawn
  drawn=$(find "$1" -name 'half.*.png' | wc -l)
  sleep 2
  [ "$(find "$1" -name 'half.*.png' | wc -l)" = "$drawn" ] || fail "a cancelled turntable went on"
  [ "$drawn" -lt 60 ] || fail "the turntable was done before it was cancelled"
}
cancel=(646 656)

recent() {
  start_editor
  until_done 60 title '^Sinew$'
  sleep 2
  shot recent
  # The picture of the scan stands on its card.
  more_than "$(part_of 406 300 144 96 'r>0.45&&r>b+0.08')" 0.01 || fail "no picture of the recent scan"
  xdotool mousemove 478 348 click 1
  until_done 60 title '^scan.0001.ply - Sinew$'
  leave
}

sequence() {
  start_editor "$1"
  until_done 60 title '^scan.0001.ply - Sinew$'
  sleep 1
  point 676 662 # the offer's button
  xdotool click 1
  until_done 60 title '^scan.####.ply - Sinew$'
  sleep 1
  shot sequence
  leave
}

portal() {
  command -v dbus-daemon >/dev/null || { echo "skipped: dbus-daemon is not installed"; exit 77; }
  "$programs/sinew-samples" "$work" scan 2>/dev/null
  mv "$work/scan.ply" "$work/my scan.ply"
  dbus-daemon --session --nofork --print-address >"$work/bus" 2>/dev/null &
  bus_pid=$!
  until_done 10 test -s "$work/bus"
  DBUS_SESSION_BUS_ADDRESS=$(head -n 1 "$work/bus")
  "$programs/sinew-fake-portal" "$work/my scan.ply" "$work/bent.off" >"$work/ready" &
  portal_pid=$!
  until_done 10 grep -q ready "$work/ready"
  start_editor
  until_done 60 title '^Sinew$'
  sleep 1
  press Return # the standard navigation
  press ctrl+o
  until_done 60 title '^my scan.ply - Sinew$'
  sleep 1
  shot open
  press ctrl+e
  sleep 1
  shot told
  [ ! -e "$work/bent.off" ] || fail "exported before it was told what is lost"
  point "${export[@]}"
  xdotool click 1
  until_done 30 test -s "$work/bent.off"
  # The desktop leaves: the program's own dialog comes.
  kill "$portal_pid" "$bus_pid"
  sleep 1
  press ctrl+o
  sleep 1
  shot plain
  press Escape
  leave
}
export=(670 332)

start_screen
"$what"
echo passed
