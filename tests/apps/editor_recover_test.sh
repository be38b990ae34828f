#!/usr/bin/env bash
# editor_recover_test.sh PROGRAMS recover
#
# Kills the window in the middle of a drag and right after one, as a crash would, and goes on from what it left: the same
# shape, the same steps to undo, and in the end the same points as the command line makes of the saved edit. A click on a
# step of the history goes there, and a drag in a field is one step. SHOTS=FOLDER keeps screenshots. Exit status 77: skipped, with the reason.
# shellcheck source=tests/apps/window.sh
source "$(dirname "$0")/window.sh"

kill_editor() {
  kill -9 "$editor_pid"
  wait "$editor_pid" 2>/dev/null || true
  editor_pid=
}
# save_as FILE: the edit under another name.
save_as() {
  press ctrl+shift+s
  name "$work/$1"
  until_done 30 test -s "$work/$1"
}
journals() { find "$XDG_STATE_HOME/sinew" -name '*.journal' 2>/dev/null | wc -l; }
export_to() {
  press ctrl+e
  name "$work/$1"
  until_done 30 test -s "$work/$1"
}
# Starts the program on nothing and takes what it offers.
recover_work() {
  start_editor
  until_done 60 title '^Sinew$'
  sleep 2
  shot "$1-offered"
  until_done 60 taken
  sleep 2
  shot "$1"
}
# Enter, and what it recovers is open.
taken() { press Return; title '^scan.ply \* - Sinew$'; }

recover() {
  "$programs/sinew-samples" "$work" scan 2>/dev/null
  rm -f "$work/scan.edit.json"
  local scan=$work/scan.ply
  first_start 'scan.ply' "$scan"
  drag 530 105 665 215
  press h
  sleep 2
  drag 370 490 570 600
  press k
  sleep 2
  follow 592 170 60
  sleep 2
  export_to before.ply
  point 712 230
  xdotool mousedown 1
  sleep 0.2
  for step in 1 2 3 4 5 6; do point $((712 - 10 * step)) 230; done
  echo "a journal of 3 steps on 79,000 points: $(cat "$XDG_STATE_HOME"/sinew/*.journal | wc -c) bytes"
  kill_editor # in the middle of a drag
  xdotool mouseup 1

  recover_work first
  export_to recovered.ply
  local apart
  apart=$(distance "$work/before.ply" "$work/recovered.ply")
  echo "killed in the middle of a drag: apart $apart of the diagonal from before that drag"
  within "$apart" 1e-6 || fail "the recovered shape is another"
  press ctrl+z
  sleep 1
  export_to undone.ply
  within "$(distance "$scan" "$work/undone.ply")" 0 || fail "undo after recovering left the shape bent"
  press ctrl+shift+z
  sleep 1

  point 712 230
  xdotool mousedown 1
  sleep 0.2
  for step in 1 2 3 4 5 6; do point $((712 - 10 * step)) $((230 - 5 * step)); done
  xdotool mouseup 1
  sleep 0.3
  kill_editor # right after a drag
  recover_work second
  [ "$(journals)" -eq 1 ] || fail "$(journals) journals in place of one"
  export_to again.ply
  ! within "$(distance "$work/before.ply" "$work/again.ply")" 0.005 || fail "the drag before the kill is lost"

  press ctrl+shift+h
  sleep 0.5
  shot history
  point 860 216 # the third row: with both marks, not dragged yet
  xdotool click 1
  sleep 2
  shot jumped
  export_to marked.ply
  within "$(distance "$scan" "$work/marked.ply")" 0 || fail "the history did not go back to the marks"
  point 860 240
  xdotool click 1
  sleep 2
  export_to jumped.ply
  within "$(distance "$work/before.ply" "$work/jumped.ply")" 1e-6 || fail "the history did not go to the first drag"
  press ctrl+shift+z
  sleep 2

  drag 1190 164 1230 164 # sideways in the field of the nodes
  sleep 2
  save_as nodes.json
  grep -q '"nodes"' "$work/nodes.json" || fail "the drag in the field changed no setting"
  press ctrl+z
  sleep 2
  save_as edit.json
  ! grep -q '"nodes"' "$work/edit.json" || fail "a drag in a field is more than one step"
  export_to window.ply
  leave
  [ "$(journals)" -eq 0 ] || fail "a journal is left after a clean end"
  "$programs/sinew" deform "$scan" --edit "$work/edit.json" -o "$work/line.ply" 2>"$work/log" || fail "sinew deform"
  [ ! -s "$work/log" ] || fail "sinew deform had something to say"
  apart=$(distance "$work/line.ply" "$work/window.ply")
  echo "recovered, gone on, saved: window and command line apart $apart of the diagonal"
  within "$apart" 1e-6 || fail "the command line comes to other points than the window"
}

start_screen
"$what"
echo passed
