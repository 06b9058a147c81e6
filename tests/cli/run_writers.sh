#!/usr/bin/env bash
# One writer a folder: of six that begin at once one runs, or one after another, and what is left is that of one.
# usage: run_writers.sh MPMFAST SOURCE_DIR [ROUNDS]
source "$(dirname "$0")/helpers.sh"
rounds=${3:-20}

# six EXIT_CODES WORDS…: all six end in one of the codes, and one of them at least in 0.
six() {
  local codes=$1 k process
  local -a processes=() ended=()
  shift
  for k in 1 2 3 4 5 6; do
    "$program" "$@" --threads 1 --progress none >"out$k" 2>"err$k" &
    processes+=($!)
  done
  for process in "${processes[@]}"; do
    wait "$process"
    ended+=($?)
  done
  cat err? >err
  checks=$((checks + 1))
  [[ " ${ended[*]} " == *' 0 '* ]] || fail "mpmfast $*: nobody ran: ${ended[*]}"
  for k in "${ended[@]}"; do
    [[ " $codes " == *" $k "* ]] || fail "mpmfast $*: exits ${ended[*]}"
  done
  refused=$((refused + $(grep -c 'that goes on now' err)))
}

same_history() {
  checks=$((checks + 1))
  cmp -s "$1/history.csv" "$2/history.csv" || fail "$2 has not the history of one run"
  grep -q '"finished"' "$2/run.json" || fail "$2 has no summary"
  [[ -z $(find "$2" -name '*.tmp') ]] || fail "$2 holds half a file"
  diff -r "$1/particles" "$2/particles" >out || fail "$2 has not the particles of one run"
}

check_runs() {
  local round
  "$program" run scene.yaml --out whole --threads 1 --progress none >out 2>err || fail 'the scene does not run'
  refused=0
  for ((round = 0; round < rounds; ++round)); do
    six '0 4' run scene.yaml --out taken --force
    same_history whole taken
  done
  [[ $refused -gt $((rounds / 5)) ]] || fail "only $refused of six times $rounds runs met another"
  # Without --force, one alone can begin.
  for ((round = 0; round < rounds / 10; ++round)); do
    rm -rf fresh
    six '0 2 4' run scene.yaml --out fresh
    same_history whole fresh
  done
  # By other names of the folder.
  ln -s taken link
  "$program" run long.yaml --out taken --force --progress none >out 2>err &
  local process=$!
  for ((round = 0; round < 100; ++round)); do
    [[ -s taken/picture_first_body.png ]] && break
    sleep 0.1
  done
  cp taken/history.csv history_before.csv
  for name in taken link ./taken/ ../"$(basename "$work")"/link; do
    run 4 run scene.yaml --out "$name" --force
    says err 'belongs to a run that goes on now'
    run 4 resume "$name"
  done
  # Nor does it help to take its files away.
  rm taken/scene.yaml
  run 4 run scene.yaml --out taken --force
  says err 'belongs to a run that goes on now'
  checks=$((checks + 1))
  cmp -s history_before.csv <(head -c "$(stat -c %s history_before.csv)" taken/history.csv) ||
    fail 'a refused run changed the history'
  kill -KILL "$process"
  wait "$process" 2>/dev/null
  run 0 run scene.yaml --out taken --force  # the lock of one that was killed is none
  same_history whole taken
}

check_studies() {
  local round
  "$program" study study.yaml --out studied --progress none --threads 1 >out 2>err || fail 'the study does not run'
  refused=0
  for ((round = 0; round < rounds; ++round)); do
    six '0 4' study study.yaml --out both --force
    same_history studied/a both/a
    same_history studied/b both/b
    checks=$((checks + 1))
    [[ $(cut -d, -f1,2,3 both/study.csv) == "$(cut -d, -f1,2,3 studied/study.csv)" ]] || fail 'both has another table'
  done
  grep -q 'belongs to a study that goes on now' err?
  [[ $refused -gt $((rounds / 5)) ]] || fail "only $refused of six times $rounds studies met another"
}

cat >scene.yaml <<'SCENE'
title: one particle in each of four cells
space: plane_strain
grid: {size: [4 mm, 4 mm], cell: 1 mm}
time: {end: 2 us}
materials: {steel: {model: linear_elastic, density: 7.85 g/cm^3, young: 210 GPa, poisson: 0.3}}
bodies:
  - {name: block, box: {from: [1 mm, 1 mm], to: [3 mm, 3 mm]}, material: steel, velocity: [0, -1 m/s], particles_per_cell: 1}
output: {frames: 1, history: 4, checkpoint: none, picture: none}
SCENE
sed 's/end: 2 us/end: 10 s/; s/, -1 m.s/, 0/; s/checkpoint: none, picture: none/picture: body/' scene.yaml >long.yaml
cat >study.yaml <<'STUDY'
scene: scene.yaml
variants: [{name: a}, {name: b, set: {time.cfl: 0.3}}]
quantities: {v: block.vy}
STUDY
check_runs
check_studies
printf '%d checks, %d failures\n' "$checks" "$failures"
[[ $failures == 0 ]]
