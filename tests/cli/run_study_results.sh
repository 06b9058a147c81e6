#!/usr/bin/env bash
# A study keeps results only: what a full disk ended, and what somebody cut, edited or removed, is run again.
# usage: run_study_results.sh MPMFAST SOURCE_DIR
source "$(dirname "$0")/helpers.sh"

# What the table says of the variants; wall times aside.
table() { cut -d, -f1,2,3,7-14 study/study.csv; }

study() {
  run 0 study study.yaml --out study --progress plain "$@"
}

# again WORDS…: run `a` was spoilt; the same command runs it again, says why, and the table is what it was.
again() {
  study
  says out 'runs             1 now, 1 kept'
  says err "(again: $1"
  checks=$((checks + 1))
  [[ $(table) == "$whole" ]] || fail "another table after '$1': $(diff <(table) <(echo "$whole"))"
  cmp -s history.csv study/a/history.csv || fail "another history after '$1'"
}

check_spoilt_histories() {
  local lines
  study
  whole=$(table)
  cp study/a/history.csv history.csv
  lines=$(wc -l <history.csv)
  study
  says out 'runs             0 now, 2 kept'
  for lines in 0 1 2 $((lines - 1)); do
    head -n "$lines" history.csv >study/a/history.csv
    again 'its history is not the one that it wrote'
  done
  head -c -20 history.csv >study/a/history.csv
  again 'its history is not the one that it wrote'
  cat history.csv history.csv >study/a/history.csv
  again 'its history is not the one that it wrote'
  sed '3s/,[^,]*/,7/4' history.csv >study/a/history.csv
  again 'its history is not the one that it wrote'
  sed '1s/block/blick/' history.csv >study/a/history.csv
  again 'its history is not the one that it wrote'
  cp study/b/history.csv study/a/history.csv
  again 'its history is not the one that it wrote'
  rm study/a/history.csv
  again 'its history is gone'
  rm study/a/history.csv
  mkfifo study/a/history.csv
  again 'its history is gone'
  rm study/a/history.csv
  ln -s ../b/history.csv study/a/history.csv
  again 'its history is not the one that it wrote'
  checks=$((checks + 1))
  [[ ! -L study/a/history.csv ]] || fail 'a run wrote through a link'
  cmp -s study/b/history.csv <(tail -n +1 study/b/history.csv) || fail 'the other run was changed'
}

# What is no summary of this run does not end the study.
check_spoilt_summaries() {
  local text
  for text in '' '{' '[]' '{"status": 5}' '{"status": "finished", "version": 1, "history": []}' 'null'; do
    printf '%s' "$text" >study/a/run.json
    study
    says out 'runs             1 now, 1 kept'
    checks=$((checks + 1))
    [[ $(table) == "$whole" ]] || fail "another table after a summary '$text'"
  done
}

# No file may grow beyond so much: as a full disk, for a run that has begun.
check_full_disk() {
  local code blocks
  for blocks in 1 2 4 8; do
    rm -rf study
    (
      ulimit -f "$blocks"
      "$program" study study.yaml --out study --progress none >out 2>err
    )
    code=$?
    checks=$((checks + 1))
    [[ $code == 4 ]] || fail "a full disk of $blocks KiB: exit $code"
    study
    checks=$((checks + 1))
    grep -q ',failed,' study/study.csv && fail "a full disk of $blocks KiB is tabled as a failure"
    [[ $(table) == "$whole" ]] || fail "another table after a full disk of $blocks KiB"
  done
}

# A run that was stopped goes on only with its own history.
check_stopped() {
  local process
  sed 's/end: 1 us/end: 4 ms/; s/, -1 m.s/, 0/; s/history: 2/history: 1000/' scene.yaml >slow.yaml
  printf '%s\n' 'scene: slow.yaml' 'variants: [{name: a}]' 'quantities: {v: block.vy}' >slow_study.yaml
  "$program" study slow_study.yaml --out slow --progress none >out 2>err &
  process=$!
  for _ in $(seq 100); do
    [[ $(wc -l 2>/dev/null <slow/a/history.csv) -gt 5 ]] && break
    sleep 0.02
  done
  kill "$process"
  wait "$process"
  checks=$((checks + 1))
  grep -q '"stopped"' slow/a/run.json || fail 'the study was not stopped in time'
  cp -r slow other
  sed -i '4s/[1-9]/7/' slow/a/history.csv
  run 0 study slow_study.yaml --out slow --progress none
  grep -q '"resumes": 0' slow/a/run.json || fail 'a run went on with an edited history'
  run 0 study slow_study.yaml --out other --progress none
  grep -q '"resumes": 1' other/a/run.json || fail 'a run that was stopped did not go on'
  checks=$((checks + 1))
  cmp -s slow/a/history.csv other/a/history.csv || fail 'a study that went on has another history'
  rm -rf slow other
}

# Other programs: what leaves no row of the table is an error, each time.
check_programs() {
  local body
  for body in 'exit 0' 'exit 3' 'exit 7' 'mkdir -p "$4"; echo "{}" >"$4/run.json"' \
    'mkdir -p "$4"; echo "{\"status\": \"finished\", \"steps\": 2}" >"$4/run.json"' \
    'mkdir -p "$4"; echo "{\"status\": \"finished\", \"steps\": 2}" >"$4/run.json"; echo step >"$4/history.csv"' \
    'mkdir -p "$4"; echo "{\"status\": \"failed\"}" >"$4/run.json"; touch "$4/history.csv"; exit 4'; do
    printf '#!/bin/sh\n%s\n' "$body" >other
    chmod +x other
    printf '%s\n' 'scene: scene.yaml' 'variants: [{name: a}, {name: b, program: ./other}]' \
      'quantities: {v: block.vy}' >program_study.yaml
    rm -rf programs
    run 4 study program_study.yaml --out programs --progress none
    run 4 study program_study.yaml --out programs --progress none
  done
  # One that writes what a program of ours did before it told the hash of its history.
  cat >other <<PROGRAM
#!/bin/sh
"$program" "\$@" && /usr/bin/python3 -c 'import json, sys
file = sys.argv[1] + "/run.json"
summary = json.load(open(file))
del summary["history"]
json.dump(summary, open(file, "w"))' "\$4"
PROGRAM
  run 0 study program_study.yaml --out programs --progress none
  run 0 study program_study.yaml --out programs --progress none
  says out 'runs             0 now, 2 kept'
  checks=$((checks + 1))
  [[ $(wc -l <programs/study.csv) == 3 ]] || fail 'a program of before leaves no row'
  sed -i '$d' programs/b/history.csv
  run 0 study program_study.yaml --out programs --progress none
  says out 'runs             1 now, 1 kept'
}

write_good_scene
sed -i 's/history: 2/history: 6, picture: none/' scene.yaml
cat >study.yaml <<'STUDY'
scene: scene.yaml
variants: [{name: a}, {name: b, set: {time.cfl: 0.3}}]
error: {quantity: block.vy, compare: final, expected: -1, relative: no}
STUDY
check_spoilt_histories
check_spoilt_summaries
check_full_disk
check_stopped
check_programs
printf '%d checks, %d failures\n' "$checks" "$failures"
[[ $failures == 0 ]]
