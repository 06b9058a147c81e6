#!/usr/bin/env bash
# Checks bench/run with a benchmark program that says what it is told, bench/compare with tiny sets of figures, and that the
# tables of bench/results/beside.md and bench/README.md are those of their CSV files.
# usage: run_bench.sh SOURCE_DIR
command -v python3 >/dev/null || { echo 'python3 is not installed'; exit 77; }
root=$(realpath "$1")
source "$root/tests/cli/helpers.sh" "$root/bench/run" "$root"

# run EXPECTED_CODE PROGRAM WORDS…
run() {
  local expected=$1 code
  shift
  checks=$((checks + 1))
  "$source_dir/bench/$1" "${@:2}" >out 2>err
  code=$?
  [[ $code == "$expected" ]] || fail "bench/$*: exit $code, expected $expected"
}

# A memory bound of 10 GB/s and an arithmetic one of 20 Gflop/s; the pass does 50 million particles a second with 100 bytes
# each: half of what the memory allows. A triad in the caches and an aggregate must not count.
write_fake_build() {
  mkdir -p "$1/bench"
  cat >"$1/bench/benchmarks" <<'PROGRAM'
#!/bin/sh
cat <<'JSON'
{"context": {"lanes": "4", "git": "abc"}, "benchmarks": [
 {"name": "machine/triad/threads:1/KiB:4096/real_time", "run_type": "iteration", "B/s": 9e10},
 {"name": "machine/triad/threads:1/KiB:131072/min_time:0.005/repeats:2/real_time", "run_type": "iteration", "B/s": 1e10},
 {"name": "machine/triad/threads:1/KiB:131072/min_time:0.005/repeats:2/real_time", "run_type": "iteration", "B/s": 8e9},
 {"name": "machine/multiply_add/threads:1/real_time", "run_type": "iteration", "flop/s": 2e10},
 {"name": "project/ugimp/2d/threads:1/real_time", "run_type": "iteration", "items_per_second": 5e7, "B/particle": 100, "flop/particle": 60},
 {"name": "project/ugimp/2d/threads:1/real_time_mean", "run_type": "aggregate", "items_per_second": 1},
 {"name": "scene/disks/2d/threads:1/real_time", "run_type": "iteration", "items_per_second": 9.7e6, "contact_nodes": 105}
]}
JSON
PROGRAM
  chmod +x "$1/bench/benchmarks"
}

check_run() {
  write_fake_build old
  write_fake_build new
  sed -i 's/5e7/4e7/' new/bench/benchmarks
  run 0 run old --out figures --repetitions 2
  says out 'Bounds of 1 thread: 10 GB/s, 20 Gflop/s.'
  says out '| project/ugimp/2d | 100, 60 | 50.0 | 50 % |  |'
  says out '| scene/disks/2d |  | 9.7 |  | 105 |'
  cmp -s <(grep '^|' out) <(grep '^|' figures/figures.md) || fail 'the table on the screen is not that of the file'
  says figures/bounds.svg '50 % (50)</text>'
  python3 -c 'import sys, xml.dom.minidom; xml.dom.minidom.parse(sys.argv[1])' figures/bounds.svg ||
    fail 'bounds.svg is not XML'
  run 0 run old new --out both --repetitions 5
  run 1 compare both/old both/new
  says out 'SLOWER  -20.0 %  project/ugimp/2d, 1 thread'
  says out '2 compared: 1 changed beyond noise, 1 slower by more than 5 %.'
  cp -r "$source_dir/bench" recorded
  checks=$((checks + 1))
  python3 recorded/run old --out figures --repetitions 1 --readme >out 2>err || fail 'bench/run --readme ends with an error'
  says recorded/README.md '| project/ugimp/2d | 100, 60 | 50.0 | 50 % |  |'
  says recorded/results/tables/bounds.csv ',1,10,20'
  run 1 run nowhere --out none
  says err 'nowhere/bench/benchmarks: No such file or directory'
}

# figures FILE RATES: one benchmark with these rates.
figures() {
  printf '{"format": "mpmfast benchmarks 1", "processor": "p", "bounds": {}, "benchmarks": [
    {"name": "pass", "threads": 1, "rates": [%s]}, {"name": "other", "threads": 2, "rates": [5, 5, 5, 5, 5]}]}' "$2" >"$1"
}

check_compare() {
  figures a.json '100, 101, 102, 103, 104'
  figures slow.json '80, 81, 82, 83, 84'
  figures noisy.json '80, 81, 82, 83, 100.5'
  figures few.json '80, 81, 82, 83'
  run 1 compare a.json slow.json
  says out 'SLOWER  -19.6 %  pass, 1 thread'
  run 0 compare a.json slow.json --slower 0.25
  says out 'slower  -19.6 %  pass, 1 thread'
  run 0 compare slow.json a.json
  says out 'faster  +24.4 %  pass, 1 thread'
  run 0 compare a.json a.json
  says out '2 compared: 0 changed beyond noise'
  # One repetition of five is as fast as before: not yet beyond noise.
  run 0 compare a.json noisy.json
  says out '2 compared: 0 changed beyond noise'
  run 0 compare a.json few.json
  says out '1 with too few repetitions to tell'
  sed 's/"pass"/"a"/; s/"other"/"b"/' a.json >others.json
  run 2 compare a.json others.json
  says err 'no benchmark is in both'
  echo '{' >broken.json
  run 2 compare a.json broken.json
  says err 'broken.json: not JSON'
  run 2 compare a.json nowhere.json
  echo '{}' >empty.json
  run 2 compare a.json empty.json
  says err 'empty.json: not the figures of bench/run'
}

check_beside() {
  mkdir copy
  cp -r "$source_dir/bench" copy/bench
  checks=$((checks + 1))
  python3 copy/bench/beside --tables >out 2>err || fail 'bench/beside --tables ends with an error'
  cmp -s copy/bench/results/beside.md "$source_dir/bench/results/beside.md" ||
    fail 'bench/results/beside.md is not that of its CSV files: bench/beside makes it'
  if command -v gnuplot >/dev/null; then
    rm copy/bench/results/beside.svg
    python3 copy/bench/beside >out 2>err || fail 'bench/beside ends with an error'
    python3 -c 'import sys, xml.dom.minidom; xml.dom.minidom.parse(sys.argv[1])' copy/bench/results/beside.svg ||
      fail 'beside.svg is not XML'
  fi
  sed -i 's/^2,[0-9.]*/2,0.5/' copy/bench/results/beside/ratios.csv
  python3 copy/bench/beside --tables >out 2>err || fail 'bench/beside --tables ends with an error'
  says copy/bench/results/beside.md '| bare loop | 2-D, 10^5 | double | uGIMP, 9 nodes; FLIP | neo-Hookean | 49 [44 to 58] | 95 [76 to 110] | 0.5 |'
}

check_tables() {
  run 0 tables --check
  mkdir -p other
  cp -r "$source_dir/bench" other
  local results=other/bench/results
  printf '2026-11-29,abc,"Xeon E, 2 cores","ellipses, whole",2,13.1,0.162\n' >>$results/speed_history.csv
  checks=$((checks + 1))
  python3 other/bench/tables --check 2>err && fail 'a newer measurement is not missed in the tables'
  python3 other/bench/tables --write || fail 'bench/tables --write ends with an error'
  python3 other/bench/tables --check || fail 'bench/tables --check refuses what --write wrote'
  says other/bench/README.md '| ellipses, whole | Xeon E, 2 cores |  | 13.1 |  | 0.162 |'
  printf 'benchmark,figure\none,2\n' >$results/tables/benchmarks.csv
  python3 other/bench/tables --write || fail 'bench/tables --write ends with an error'
  says other/bench/README.md '| benchmark | figure |'
  cp $results/tables/benchmarks.csv $results/tables/nowhere.csv
  python3 other/bench/tables --check 2>err && fail 'a CSV file that no table shows is accepted'
  says err 'no place for nowhere'
  rm $results/tables/nowhere.csv
  printf 'one,2,3\n' >>$results/tables/benchmarks.csv
  python3 other/bench/tables --check 2>err && fail 'rows of different lengths are accepted'
  says err 'its rows differ in length'
  rm $results/tables/benchmarks.csv
  python3 other/bench/tables --check 2>err && fail 'a table without its CSV file is accepted'
  says err 'no such file'
}

check_run
check_compare
check_beside
check_tables
printf '%d checks, %d failures\n' "$checks" "$failures"
[[ $failures == 0 ]]
