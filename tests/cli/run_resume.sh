#!/usr/bin/env bash
# Checks how a run ends before its time, and goes on: signals, resume, a full disk, a folder that is removed.
# usage: run_resume.sh MPMFAST SOURCE_DIR
source "$(dirname "$0")/helpers.sh"

check_signals() {
  local signal code
  for signal in INT TERM HUP QUIT USR1 USR2 ALRM XCPU; do
    "$program" run scene.yaml --set 'time.end=1 s' --set 'bodies.0.velocity=[0, 0]' \
      --out "stopped_$signal" --progress none >out 2>err &
    local process=$!
    for _ in $(seq 100); do  # the folder appears once the run has begun
      [[ -d stopped_$signal ]] && break
      sleep 0.1
    done
    sleep 0.3
    kill -s "$signal" "$process"
    wait "$process"
    code=$?
    checks=$((checks + 1))
    [[ $code == $((128 + $(kill -l "$signal"))) ]] || fail "SIG$signal: exit $code"
    grep -q '"stopped"' "stopped_$signal/run.json" || fail "SIG$signal: run.json does not say stopped"
    says out "mpmfast resume stopped_$signal"
    "$program" resume "stopped_$signal" --progress none >out 2>err &
    process=$!
    sleep 0.5
    run 4 resume "stopped_$signal"
    says err "stopped_$signal belongs to a run that goes on now"
    kill -s "$signal" "$process"
    wait "$process"
    code=$?
    [[ $code == $((128 + $(kill -l "$signal"))) ]] || fail "SIG$signal after resume: exit $code"
    grep -q '"resumes": 1' "stopped_$signal/run.json" || fail "SIG$signal: no run that was resumed once"
    rm -rf "stopped_$signal"
  done
}

# Nobody reads the progress any more: the run goes on all the same.
check_closed_pipe() {
  { "$program" run scene.yaml --set 'time.end=100 us' --set 'bodies.0.velocity=[0, 0]' --out piped --progress plain 2>&1
    echo "$?" >piped.code; } | true
  for _ in $(seq 100); do
    [[ -s piped.code ]] && break
    sleep 0.1
  done
  checks=$((checks + 1))
  grep -q '"finished"' piped/run.json || fail 'a run whose output nobody reads does not finish'
  [[ $(<piped.code) == 4 || $(<piped.code) == 0 ]] || fail "a run whose output nobody reads: exit $(<piped.code)"
  rm -rf piped piped.code
}

# The last frame and pictures of so many particles take longer than the second signal.
check_second_interrupt() {
  "$program" run scene.yaml --set 'time.end=1 s' --set 'bodies.0.velocity=[0, 0]' --set 'grid.cell=0.01 mm' \
    --out interrupted --progress none >out 2>err &
  local process=$! code
  for _ in $(seq 100); do
    [[ -f interrupted/picture_first_pressure.png ]] && break
    sleep 0.1
  done
  kill -s INT "$process"
  sleep 0.05
  kill -s INT "$process"
  wait "$process"
  code=$?
  checks=$((checks + 1))
  [[ $code == 130 && ! -f interrupted/run.json ]] || fail "two interrupts: exit $code, or the run ended in order"
  rm -rf interrupted
}

check_resume() {
  local whole
  run 0 run scene.yaml --out whole --progress none
  whole=$(grep '"checksum"' whole/run.json)
  run 0 run scene.yaml --out parts --until '0.3 us' --progress none
  run 0 resume parts --until '0.6 us' --progress none
  cp parts/run.json run_before.json
  run 0 resume parts --until '0.5 us'
  says out 'the run in parts has come so far already'
  cmp -s parts/run.json run_before.json || fail 'a resume with nothing to do wrote run.json'
  run 0 resume parts --threads 2 --progress none
  says out 'finished at 1 us'
  run 0 resume parts
  run 0 run scene.yaml --out stepped --steps 2 --progress none
  run 0 resume stepped --progress none
  [[ $(grep '"checksum"' stepped/run.json) == "$whole" ]] || fail 'a resumed run has another checksum'
  cmp -s whole/history.csv stepped/history.csv || fail 'a resumed run has another history'
  local grid='--set output.grid=true --set output.frames=3 --progress none'
  run 0 run scene.yaml --out whole_grid $grid
  run 0 run scene.yaml --out stepped_grid --steps 2 $grid
  checks=$((checks + 1))
  [[ $(ls stepped_grid/grid) != $(ls whole_grid/grid) ]] || fail 'two steps wrote every frame of the nodes'
  run 0 resume stepped_grid --progress none
  checks=$((checks + 1))
  diff -r whole_grid/grid stepped_grid/grid >out && cmp whole_grid/grid.pvd stepped_grid/grid.pvd >>out ||
    fail 'a resumed run has other files of the nodes'
  run 4 resume nowhere
  says err 'nowhere: there is no such folder'
  run 0 run scene.yaml --out spoilt --steps 2 --progress none
  cp spoilt/scene.yaml scene_before.yaml
  sed -i 's/cfl: 0.5/cfl: 0.4/' spoilt/scene.yaml
  run 4 resume spoilt
  says err 'spoilt/scene.yaml was altered'
  cp scene_before.yaml spoilt/scene.yaml
  cp spoilt/checkpoint.h5 checkpoint_before.h5
  truncate -s -1 spoilt/checkpoint.h5
  run 4 resume spoilt
  says err 'spoilt/checkpoint.h5 is truncated'
  cp checkpoint_before.h5 spoilt/checkpoint.h5
  printf x | dd of=spoilt/checkpoint.h5 bs=1 seek=3000 conv=notrunc status=none
  run 4 resume spoilt
  says err 'spoilt/checkpoint.h5 was altered'
  rm -rf whole parts stepped spoilt run_before.json scene_before.yaml checkpoint_before.h5
}

# A history of the same scene and steps, but of another run, or one that somebody edited, is no part of the run.
check_foreign_history() {
  local row
  run 0 run scene.yaml --out one --steps 3 --progress none --set output.history=100
  run 0 run scene.yaml --out two --steps 3 --progress none --set output.history=100 --set 'bodies.0.velocity=[0, -2 m/s]'
  cp one/history.csv history_before.csv
  cp one/run.json run_before.json
  for row in 1 2 3; do
    sed "${row}s/time/tame/;${row}s/0,/0.0,/" history_before.csv >one/history.csv
    run 4 resume one
    says err 'one/history.csv is not that of the checkpoint'
  done
  cp two/history.csv one/history.csv
  run 4 resume one
  says err 'one/history.csv is not that of the checkpoint'
  cmp -s one/history.csv two/history.csv && cmp -s one/run.json run_before.json || fail 'a refused resume wrote a file'
  { cat history_before.csv; echo 'what a kill left'; } >one/history.csv
  run 0 resume one --progress none
  run 0 run scene.yaml --out two --force --progress none --set output.history=100
  cmp -s one/history.csv two/history.csv || fail 'a resumed run has another history'
  rm -rf one two history_before.csv run_before.json
}

# limit FOLDER TIME STEPS: where the run ended.
limit() {
  checks=$((checks + 1))
  /usr/bin/python3 - "$@" <<'PYTHON' || fail "$1 did not end at $2 us or $3 steps: $(grep -E '"(time_s|steps|reason)"' "$1/run.json")"
import json, sys
run = json.load(open(sys.argv[1] + "/run.json"))
time, steps = sys.argv[2:]
good = run["status"] == "finished"
good = good and (time == "-" or abs(run["time_s"] - 1e-6 * float(time)) < 1e-15)
sys.exit(not (good and (steps == "-" or run["steps"] == int(steps))))
PYTHON
}

# The limits of a run hold until it has ended there, whatever stops it before; and those that a resume was told.
check_limits() {
  local often='--set output.checkpoint.steps=1 --progress none'
  run 0 run scene.yaml --out limits --until '0.5 us' $often
  limit limits 0.5 -
  rm limits/run.json  # as a kill does after the last checkpoint
  run 0 resume limits --progress none
  limit limits 0.5 -
  run 0 resume limits --progress none
  limit limits 1 -
  run 0 run scene.yaml --out limits --force --steps 3 $often
  rm limits/run.json
  run 0 resume limits --progress none
  limit limits - 3
  run 0 resume limits --progress none
  limit limits 1 -
  # What a resume was told holds too, though it was killed before the next checkpoint.
  run 0 run scene.yaml --out limits --force --until '0.3 us' --set 'bodies.0.velocity=[0, 0]' --progress none
  local words process
  for words in '--until 1s' ''; do
    # shellcheck disable=SC2086
    "$program" resume limits $words --progress none >out 2>err &
    process=$!
    sleep 0.7
    checks=$((checks + 1))
    kill -0 "$process" 2>/dev/null || fail 'a run that a resume had told to go on to 1 s ended before'
    kill -KILL "$process" 2>/dev/null
    wait "$process" 2>/dev/null
  done
  # A number of steps gives way to a time that is told.
  run 0 run scene.yaml --out limits --force --steps 3 $often
  rm limits/run.json
  run 0 resume limits --until '0.9 us' --progress none
  limit limits 0.9 -
  rm -rf limits
}

# No file may grow beyond 40 KiB: the checkpoint does, after history and frames.
check_full_disk() {
  checks=$((checks + 1))
  (
    ulimit -f 40
    "$program" run scene.yaml --out full --progress none --set grid.cell='0.1 mm' --set output.picture=body >out 2>err
  )
  local code=$?
  [[ $code == 4 ]] || fail "a full disk: exit $code"
  says err 'cannot write full/'
  says err 'File too large'
  [[ -z $(find full -name '*.tmp') && ! -e full/checkpoint.h5 ]] || fail 'a full disk leaves half a file'
  [[ -z $(tail -c 1 full/history.csv) ]] || fail 'a full disk leaves half a row'
  rm -rf full
  # What was good before the disk was full goes on when it is not.
  run 0 run scene.yaml --out whole --progress none
  run 0 run scene.yaml --out filled --steps 2 --progress none
  (
    ulimit -f 16
    "$program" resume filled --progress none >out 2>err
  )
  code=$?
  [[ $code == 4 ]] || fail "a full disk after resume: exit $code"
  run 0 resume filled --progress none
  cmp -s whole/history.csv filled/history.csv || fail 'a run resumed after a full disk has another history'
  rm -rf whole filled
}

check_removed_folder() {
  "$program" run scene.yaml --set 'time.end=1 s' --set 'bodies.0.velocity=[0, 0]' --set output.history=100000 \
    --set output.frames=0 --out removed --progress none >out 2>err &
  local process=$! code
  for _ in $(seq 100); do
    [[ -f removed/picture_first_pressure.png ]] && break
    sleep 0.1
  done
  rm -rf removed
  wait "$process"
  code=$?
  checks=$((checks + 1))
  [[ $code == 4 && ! -e removed ]] || fail "a removed folder: exit $code"
  says err 'removed/history.csv was removed while the run went on'
}

write_good_scene
check_signals
check_closed_pipe
check_second_interrupt
check_resume
check_foreign_history
check_limits
check_full_disk
check_removed_folder
printf '%d checks, %d failures\n' "$checks" "$failures"
[[ $failures == 0 ]]
