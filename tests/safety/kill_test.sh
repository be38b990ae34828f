#!/usr/bin/env bash
# kill_test.sh PROGRAMS
#
# Ends a save before each of its system calls, and lets each of them fail with EIO and ENOSPC. After it the file must hold
# the old bytes or the new ones, whole; where the save says that it failed, in one line, nothing may be left beside the
# file. The same with a journal: what was said to be in it must be there. A careless save must be caught by the same.
# Exit status 77: skipped, with the reason.
set -euo pipefail
saver=$1/sinew-saver
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
command -v strace >/dev/null || { echo "skipped: strace is not installed"; exit 77; }
export ASAN_OPTIONS=${ASAN_OPTIONS:-}:detect_leaks=0 # leaks can't be looked for in what is traced
strace -o /dev/null true 2>/dev/null || { echo "skipped: strace may not trace programs here"; exit 77; }

# All calls that a save or a journal could change the disk by; those that a machine does not have are left out.
calls=()
for call in openat write pwrite64 fsync fdatasync rename renameat renameat2 close ftruncate fchmod fchown flock mkdir unlink; do
  if strace -e trace="$call" -o /dev/null true 2>/dev/null; then calls+=("$call"); fi
done
all=$(IFS=,; echo "${calls[*]}")
runs=0

seq 1 3000 >"$work/old"
seq 2 2 9000 >"$work/new"
reset() {
  rm -rf "$work/place"
  mkdir "$work/place"
  cp "$work/old" "$work/place/file"
}
# old, new or broken
state() {
  if cmp -s "$work/old" "$work/place/file"; then echo old
  elif cmp -s "$work/new" "$work/place/file"; then echo new
  else echo broken; fi
}
# inject CALL FAULT N ARGUMENTS...: the exit status of the program, whose output is in out and err
inject() {
  local call=$1 fault=$2 n=$3 status=0
  shift 3
  runs=$((runs + 1))
  { strace -f -qq -o /dev/null -e trace="$call" -e inject="$call:$fault:when=$n" "$saver" "$@" \
    >"$work/out" 2>"$work/err"; } 2>/dev/null || status=$?
  echo "$status" >"$work/status"
}
status() { cat "$work/status"; }

# kills MODE: counts what was left, by state.
kills() {
  declare -gA left=([old]=0 [new]=0 [broken]=0)
  local call n
  for call in "${calls[@]}"; do
    for ((n = 1; ; ++n)); do
      reset
      inject "$call" signal=KILL "$n" "$1" "$work/place/file" "$work/new"
      [ "$(status)" -eq 137 ] || break
      local now
      now=$(state)
      left[$now]=$((left[$now] + 1))
      if [ "$now" = broken ]; then broken_at="$call number $n"; fi
    done
    [ "$(status)" -eq 0 ] || { echo "failed: $1 left with status $(status) where nothing was done to it"; exit 1; }
  done
}

# errors MODE: every call after the start of the program fails once; the same counts.
errors() {
  declare -gA left=([old]=0 [new]=0 [broken]=0)
  local call n first last error
  for call in "${calls[@]}"; do
    reset
    strace -qq -o "$work/log" -e trace="$all" "$saver" "$1" "$work/place/file" "$work/new"
    first=$(sed '/sinew-begins/q' "$work/log" | grep -c "^$call(" || true)
    last=$(grep -c "^$call(" "$work/log" || true)
    for ((n = first + 1; n <= last; ++n)); do
      for error in EIO ENOSPC; do
        reset
        inject "$call" "error=$error" "$n" "$1" "$work/place/file" "$work/new"
        local now
        now=$(state)
        left[$now]=$((left[$now] + 1))
        if [ "$now" = broken ]; then
          broken_at="$error of $call number $n"
        elif [ "$(status)" -ne 0 ]; then
          [ "$(wc -l <"$work/err")" -eq 1 ] || { echo "failed: not one line:"; cat "$work/err"; exit 1; }
          [ "$(find "$work/place" -type f | wc -l)" -eq 1 ] || { echo "failed: left over after $error of $call"; exit 1; }
        elif [ "$now" != new ]; then
          echo "failed: $error of $call number $n was not told"
          exit 1
        fi
      done
    done
  done
}

broken_at=
kills save
echo "save: killed $((left[old] + left[new])) times, the file was old ${left[old]} times and new ${left[new]} times"
[ "${left[broken]}" -eq 0 ] || { echo "failed: a broken file after a kill at $broken_at"; exit 1; }
(( left[old] > 0 && left[new] > 0 )) || { echo "failed: kills that prove nothing"; exit 1; }
errors save
echo "save: $((left[old] + left[new])) errors, the file was old ${left[old]} times and new ${left[new]} times"
[ "${left[broken]}" -eq 0 ] || { echo "failed: a broken file after $broken_at"; exit 1; }
[ "${left[old]}" -gt 0 ] || { echo "failed: errors that prove nothing"; exit 1; }

kills careless
[ "${left[broken]}" -gt 0 ] || { echo "failed: a careless save was not caught by kills"; exit 1; }
errors careless
[ "${left[broken]}" -gt 0 ] || { echo "failed: a careless save was not caught by errors"; exit 1; }
echo "a careless save was caught: $broken_at"

# journal_holds: the last step of the journal in place is the last one that was noted, or the one after it.
journal_holds() {
  local noted found
  noted=$(sed -n 's/^noted //p' "$work/out" | tail -n 1)
  found=$("$saver" journals "$work/place")
  if [ "${found:-0}" -lt "${noted:-0}" ] || [ "${found:-0}" -gt $((${noted:-0} + 1)) ]; then
    echo "failed: $1: step ${noted:-0} was noted, and the journal ends at ${found:-none}"
    exit 1
  fi
}
killed=0
for call in "${calls[@]}"; do
  for ((n = 1; ; ++n)); do
    rm -rf "$work/place"
    inject "$call" signal=KILL "$n" journal "$work/place" 4
    [ "$(status)" -eq 137 ] || break
    killed=$((killed + 1))
    journal_holds "a kill at $call number $n"
  done
done
[ "$killed" -gt 20 ] || { echo "failed: only $killed kills"; exit 1; }
failed=0
for call in pwrite64 fdatasync; do
  for n in 1 2 4; do
    for error in EIO ENOSPC; do
      for times in "$n" "$n+"; do
        rm -rf "$work/place"
        inject "$call" "error=$error" "$times" journal "$work/place" 4
        failed=$((failed + 1))
        [ "$(status)" -eq 0 ] || { echo "failed: $error of $call ended the program"; exit 1; }
        [ "$(grep -c '^problem' "$work/out")" -le 1 ] || { echo "failed: told more than once"; cat "$work/out"; exit 1; }
        found=$("$saver" journals "$work/place")
        case $call:$times in
          *+) [ "${found:-0}" -le 4 ] ;;
          *) [ "$found" = 4 ] ;;
        esac || { echo "failed: $error of $call $times: the journal ends at ${found:-none}"; exit 1; }
      done
    done
  done
done
echo "journal: killed $killed times, $failed errors, nothing that was noted is missing"
echo "passed: $runs runs in $SECONDS s"
