#!/usr/bin/env bash
# Studies whose runs a launcher starts: a made-up one, which notes what it is asked to start and loses runs on purpose.
# usage: run_launcher.sh MPMFAST SOURCE_DIR
source "$(dirname "$0")/helpers.sh"
write_good_scene

# lose THREADS NAME COMMAND…: what the file NAME.once says happens to the first start of a run.
cat >lose <<'LAUNCHER'
#!/bin/sh
threads=$1 name=$2
shift 2
echo "$threads $name $2" >>started
how=$(cat "$name.once" 2>/dev/null)
rm -f "$name.once"
case $how in
  refused) echo 'no node is free' >&2; exit 1 ;;
  killed)  # as a machine that is lost: a checkpoint, and no end
    "$@" >/dev/null &
    while ! [ -s "$out/$name/checkpoint.h5" ]; do sleep 0.02; done
    kill -9 $!
    kill -9 $$ ;;
  stopped)  # as by the scheduler, at a limit of time
    "$@" &
    while ! [ -s "$out/$name/history.csv" ]; do sleep 0.02; done
    kill $!
    wait $!
    exit ;;
esac
exec "$@"
LAUNCHER
chmod +x lose

write_study() {
  cat >scene_study.yaml <<'STUDY'
scene: scene.yaml
set: {time.end: 20 us, output.picture: none}
variants:
  - {name: quiet}
  - {name: refused, set: {time.cfl: 0.2}}
  - {name: killed, set: {time.end: 4 ms, "bodies.0.velocity": [0, 0], output.checkpoint.steps: 1000}}
  - {name: stopped, set: {time.end: 4 ms, "bodies.0.velocity": [0, 0]}}
  - {name: fallen, set: {"bodies.0.velocity": [0, -20 km/s]}}
quantities: {fall: block.vy, kinetic: {quantity: kinetic_J, over: max}}
STUDY
}

# The columns of study.csv that are no wall times; of run.json what the particles came to.
physics() {
  /usr/bin/python3 - "$1" <<'PYTHON'
import csv, json, pathlib, sys
folder = pathlib.Path(sys.argv[1])
for row in csv.DictReader(open(folder / "study.csv")):
    print(*(f"{key}={value}" for key, value in row.items() if key not in ("wall_s", "particle_steps_per_s", "pareto")))
for run in sorted(folder.glob("*/run.json")):
    print(run.parent.name, json.loads(run.read_text())["checksum"])
PYTHON
}

check_restarts() {
  local name
  write_study
  run 0 study scene_study.yaml --out here
  for name in refused killed stopped; do echo "$name" >"$name.once"; done
  out=there run 0 study scene_study.yaml --out there --jobs 3 --threads 3 --launcher './lose {threads} "{name}"'
  says err 'refused: exit status 1: no node is free; started again, 1 of 2'
  says err 'killed: exit status 137 (signal 9); started again from its checkpoint, 1 of 2'
  says err 'stopped: somebody stopped it; started again from its checkpoint, 1 of 2'
  says err '0 under way, 4 done, 1 failed, 0 to come'
  [[ $(sort started) == "3 fallen run
3 killed resume
3 killed run
3 quiet run
3 refused run
3 refused run
3 stopped resume
3 stopped run" ]] || fail "what was started: $(cat started)"
  checks=$((checks + 7))
  [[ $(physics here) == "$(physics there)" ]] || fail "a launcher changes results: $(diff <(physics here) <(physics there))"
  for name in quiet refused killed stopped; do
    cmp -s "here/$name/history.csv" "there/$name/history.csv" || fail "$name has another history with a launcher"
    cmp -s "here/$name/scene.yaml" "there/$name/scene.yaml" || fail "$name has another scene with a launcher"
  done
  says there/refused.log 'no node is free'
  rm started
  out=there run 0 study scene_study.yaml --out there --launcher './lose {threads} {name}'
  says out 'runs             0 now, 5 kept'
  [[ ! -e started ]] || fail 'what has ended is started again'
  rm -rf here there
}

# What is lost as often as it is started does not hold up the others, and is tried again by the same command.
check_lost() {
  write_study
  echo refused >refused.once
  out=there run 4 study scene_study.yaml --out there --restarts 0 --launcher './lose {threads} {name}'
  says err '    lost: exit status 1: no node is free'
  says out 'lost             1 of 5 runs'
  [[ $(grep -c ',finished,' there/study.csv) == 3 && $(grep -c ',failed,' there/study.csv) == 1 ]] ||
    fail 'a run that is lost takes others with it'
  run 0 study scene_study.yaml --out there --launcher "sh -c 'exec \"\$@\"' \"two\"\\ three"
  says out 'runs             1 now, 4 kept'
  says there/refused.log '$ sh -c exec "$@" two three /'
  rm -rf there started
}

# A signal to the study stops its runs, which go on when it is started again. What was there before a run began
# does not count, should it never begin.
check_stop() {
  local process code
  write_study
  sed -i -e '/fallen\|killed\|refused/d' -e 's/4 ms/1 s/' scene_study.yaml
  for _ in 1 2; do
    "$program" study scene_study.yaml --out there --jobs 2 --launcher './lose {threads} {name}' >out 2>err &
    process=$!
    for _ in $(seq 200); do
      [[ $(wc -l 2>/dev/null <there/stopped/history.csv) -gt 1 && -f there/quiet/run.json ]] && break
      sleep 0.05
    done
    sleep 0.2
    kill "$process"
    wait "$process"
    code=$?
    checks=$((checks + 1))
    [[ $code == 143 ]] || fail "a study that is stopped: exit $code"
    grep -q '"status": "stopped"' there/stopped/run.json || fail 'a signal to the study does not stop its runs'
  done
  [[ $(cat started) == *"1 stopped run"*"1 stopped resume" ]] || fail "a stopped run does not go on: $(cat started)"
  run 4 study scene_study.yaml --out there --force --restarts 1 --launcher false
  says out 'lost             2 of 2 runs'
  says err 'quiet: exit status 1; started again, 1 of 1'
  rm -rf there started
}

check_restarts
check_lost
check_stop
printf '%d checks, %d failures\n' "$checks" "$failures"
[[ $failures == 0 ]]
