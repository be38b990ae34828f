#!/usr/bin/env bash
# farm.sh PROGRAMS scan [POINTS]
# farm.sh PROGRAMS gallop
# farm.sh PROGRAMS command TASKS COMMAND...
#
# Runs one command of sinew alone, then as tasks through a real Slurm (controller, daemon and munge of its own on this
# machine, as root, without systemd) and through GNU parallel. In both one task is killed by SIGKILL while it runs; submit has
# to name it and to leave with 5, and --resume has to run that task, and no other, again. The outputs have to have the same bytes.
#   scan      bends the sample scan with POINTS (50,000,000) points: sinew apply in 8 tasks
#   gallop    turns the head of the galloping horse of the shared data over 48 frames: sinew deform in 6 tasks
#   command   any command that has --task; {} in it stands for the folder of its outputs, all of which are compared:
#             farm.sh build/bin command 6 deform walk.####.obj --edit walk.json -o {}/bent.####.obj --force
# Prints how long each took. Leaves nothing behind. Exit status 77: skipped, with the reason.
set -euo pipefail
programs=$(realpath "$1") what=$2
shift 2
sinew=$programs/sinew
[ "$(id -u)" -eq 0 ] || { echo "farm.sh: expected root, which Slurm's daemons run as, found another user"; exit 1; }

work=$(mktemp -d)
daemons=()
finish() {
  for daemon in "${daemons[@]}"; do
    [ ! -s "$work/$daemon.pid" ] || kill "$(cat "$work/$daemon.pid")" 2>/dev/null || true
  done
  for daemon in "${daemons[@]}"; do
    for ((i = 0; i < 50; ++i)); do
      [ -s "$work/$daemon.pid" ] || break
      kill -0 "$(cat "$work/$daemon.pid")" 2>/dev/null || break
      sleep 0.1
    done
  done
  rm -rf "$work"
}
trap finish EXIT
trap 'exit 130' INT TERM

fail() {
  echo "failed: $*"
  for log in "$work"/*.log "$work"/submit/*.log; do
    [ ! -s "$log" ] || { echo "-- ${log##*/}"; tail -n 20 "$log" | sed 's/^/  /'; }
  done
  exit 1
}

# until_done SECONDS COMMAND...: waits until the command succeeds.
until_done() {
  local end=$((SECONDS + $1))
  shift
  until "$@" >/dev/null 2>&1; do
    [ $SECONDS -lt $end ] || fail "waited too long for: $*"
    sleep 0.1
  done
}

# timed NAME COMMAND...
timed() {
  local name=$1 begin=$EPOCHREALTIME status=0
  shift
  "$@" || status=$?
  printf '%-34s %7.1f s\n' "$name" "$(awk "BEGIN { print $EPOCHREALTIME - $begin }")"
  return "$status"
}

# A port on which nobody answers.
free_port() {
  local port
  while port=$((20000 + RANDOM % 10000)) && (: <>"/dev/tcp/127.0.0.1/$port") 2>/dev/null; do :; done
  echo "$port"
}

start_slurm() {
  local host controller=$1 daemon=$2
  host=$(hostname -s)
  mkdir -p "$work/state" "$work/spool"
  dd if=/dev/urandom of="$work/munge.key" bs=1024 count=1 status=none
  chmod 600 "$work/munge.key"
  cat >"$work/slurm.conf" <<END
ClusterName=farm
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$controller
SlurmdPort=$daemon
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$work/munge.socket
CredType=cred/munge
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
SlurmctldLogFile=$work/slurmctld.log
SlurmdLogFile=$work/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
SwitchType=switch/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
ReturnToService=2
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=farm Nodes=$host Default=YES MaxTime=INFINITE State=UP
END
  export SLURM_CONF=$work/slurm.conf
  daemons=(slurmd slurmctld munged)
  # --force: its files lie in a temporary folder and are owned by root.
  munged --force --key-file="$work/munge.key" --socket="$work/munge.socket" --pid-file="$work/munged.pid" \
    --log-file="$work/munged.log" --seed-file="$work/munged.seed" 2>>"$work/munged.log"
  until_done 20 test -S "$work/munge.socket"
  slurmctld -f "$SLURM_CONF"
  until_done 30 scontrol ping
  slurmd -f "$SLURM_CONF"
  until_done 60 bash -c 'sinfo --noheader --format=%T | grep -qx idle'
}

# The command with the folder of its outputs.
command_to() { local folder=$1 word; shift; for word; do printf '%s\0' "${word//\{\}/$folder}"; done; }

# Finds the sinew, not its shell, that runs this task of this test, waits until it has written something, and kills it.
kill_task() {
  local end=$((SECONDS + 300)) process arguments written
  while [ $SECONDS -lt $end ]; do
    for process in /proc/[0-9]*; do
      { mapfile -d '' -t arguments <"$process/cmdline"; } 2>/dev/null || continue
      [[ ${arguments[0]:-} == "$sinew" && "${arguments[*]}" == *" --task $1" && "${arguments[*]}" == *"$work"* ]] || continue
      while { read -r _ && read -r _ written; } 2>/dev/null <"$process/io" && [ "${written:-0}" -eq 0 ]; do :; done
      kill -KILL "${process#/proc/}" 2>/dev/null && return
    done
    sleep 0.01
  done
  fail "task $1 has not been seen while it ran"
}

# Whether a folder has the outputs of the single run; a file that a killed task had not finished is none.
same() { diff -r --exclude='.sinew-*.part' "$work/single" "$1" >/dev/null 2>&1; }

# through ENGINE TASKS: as tasks with one killed, that one again, compared with the single run.
through() {
  local engine=$1 tasks=$2 out=$work/$1 victim=$((($2 + 1) / 2)) status=0 command
  shift 2
  mkdir -p "$out"
  mapfile -d '' -t command < <(command_to "$out" "$@")
  local submit=("$sinew" submit --engine "$engine" --tasks "$tasks" --log "$work/submit")
  timed "$engine, $tasks tasks, one killed" "${submit[@]}" -- "${command[@]}" 2>"$work/messages.log" &
  local job=$!
  kill_task "$victim/$tasks"
  wait "$job" || status=$?
  [ "$status" -eq 5 ] || fail "$engine: expected status 5 after a task was killed, found $status"
  grep -qF "1 of $tasks tasks failed, $victim;" "$work/messages.log" || fail "$engine: the killed task is not named"
  ! same "$out" || fail "$engine: the killed task left nothing undone"
  local others="$work/others" again="$work/again"
  stat -c '%n %y' "$work"/submit/*.status | grep -v "/$victim.status" >"$others"
  timed "$engine, that task again" "${submit[@]}" --resume -- "${command[@]}" 2>"$work/messages.log" ||
    fail "$engine: --resume left with status $?"
  stat -c '%n %y' "$work"/submit/*.status | grep -v "/$victim.status" >"$again"
  cmp -s "$others" "$again" || fail "$engine: --resume ran more than the task that was killed"
  same "$out" || fail "$engine: the outputs have other bytes than the single run"
  rm -rf "$out" "$work/submit"
}

# farm TASKS COMMAND...
farm() {
  local tasks=$1 command
  shift
  mkdir "$work/single"
  mapfile -d '' -t command < <(command_to "$work/single" "$@")
  timed "alone" "$sinew" "${command[@]}" || fail "the command itself"
  start_slurm "$(free_port)" "$(free_port)"
  through slurm "$tasks" "$@"
  through parallel "$tasks" "$@"
}

case $what in
  scan)
    points=${1:-50000000}
    echo "a scan of $points points, sinew apply"
    "$programs/sinew-samples" "$work" scan large --points "$points" 2>/dev/null
    "$sinew" deform "$work/scan.ply" --edit "$work/scan.edit.json" -o "$work/bent.ply" --pose "$work/look back.pose"
    farm 8 apply "$work/look back.pose" "$work/large.ply" -o "{}/bent.ply"
    ;;
  gallop)
    frames=${SINEW_SHARED:-$(dirname "$0")/../../../shared}/data/anim/horse_gallop_obj
    [ -d "$frames" ] || { echo "skipped: no shared data: $frames"; exit 77; }
    echo "the horse's gallop, sinew deform"
    cat >"$work/head.json" <<END
{ "sinew": 1, "layers": [ { "method": "graph", "settings": { "nodes": 200 },
  "fixed": [ { "box": [[-1, -1, -2], [1, 0.7, 2]] } ],
  "handles": [ { "points": { "box": [[-1, 1.15, 0.5], [1, 2, 2]] }, "move": [0, 0, 0] } ],
  "keys": [ { "frame": 1, "handles": [ { "move": [0, 0, 0] } ] }, { "frame": 24, "handles": [ { "move": [0.2, 0.1, 0] } ] } ] } ] }
END
    farm 6 deform "$(realpath "$frames")/####.obj" --edit "$work/head.json" -o "{}/bent.####.obj" --force
    ;;
  command) farm "$@" ;;
  *) echo "farm.sh: expected scan, gallop or command, found '$what'"; exit 2 ;;
esac
echo passed
