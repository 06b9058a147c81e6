#!/usr/bin/env bash
# Checks checksums.py on two small scenes: a program beside itself, beside one that damps, and beside one that
# refuses them.
# usage: run_checksums.sh MPMFAST SOURCE_DIR
root=$(realpath "$2")
source "$root/tests/cli/helpers.sh" "$1" "$root"

# compare EXPECTED_CODE NEW WORDS…: the program beside another one.
compare() {
  local expected=$1 code
  shift
  checks=$((checks + 1))
  python3 "$source_dir/tests/cli/checksums.py" "$program" "$@" --steps 20 --only '^(gap|squares)\.yaml' >out 2>err
  code=$?
  [[ $code == "$expected" ]] || fail "checksums.py $*: exit $code, expected $expected"
}

write_program() {
  printf '#!/bin/sh\nexec "%s" "$@" %s\n' "$program" "$2" >"$1"
  chmod +x "$1"
}

compare 0 "$program" --keep kept
says out '| gap.yaml | 20 |'
says out '2 scenes, 0 different'
[[ -f kept/new/squares/run.json ]] || fail '--keep keeps no output'
write_program damped '--set method.update=pic'
compare 1 ./damped
says out '2 scenes, 2 different'
grep -q '^| squares.yaml | 20 |.*| [0-9.]*e[-+][0-9]* [a-z_A-Z.]* |$' out || fail 'it does not say which column differs'
write_program refusing '--set time.cfll=0.4'
compare 2 ./refusing
says err "Did you mean 'cfl'?"
python3 "$source_dir/tests/cli/checksums.py" "$program" "$program" --only nowhere 2>err && fail 'no scene at all is accepted'
says err 'no scene matches nowhere'
printf '%d checks, %d failures\n' "$checks" "$failures"
[[ $failures == 0 ]]
