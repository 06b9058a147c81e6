# What the checks of the command line share: an empty folder to work in, and ways to run and to judge the program.
# source helpers.sh, with MPMFAST and SOURCE_DIR as the arguments of the script.
set -u
program=$(realpath "$1")
source_dir=$(realpath "$2")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
failures=0
checks=0

fail() {
  failures=$((failures + 1))
  printf 'FAILED: %s\n' "$1"
  sed 's/^/    /' out err
}

# run EXPECTED_CODE WORDS…: runs the program; its streams are in the files out and err.
run() {
  local expected=$1
  shift
  checks=$((checks + 1))
  "$program" "$@" >out 2>err
  local code=$?
  [[ $code == "$expected" ]] || fail "mpmfast $*: exit $code, expected $expected"
}

# says FILE TEXT: the stream holds the text.
says() {
  checks=$((checks + 1))
  grep -qF -- "$2" "$1" || fail "'$2' is missing from $1"
}

write_good_scene() {
  cat >scene.yaml <<'SCENE'
title: a falling block
space: plane_strain
grid: {size: [10 mm, 10 mm], cell: 1 mm}
time: {end: 1 us}
materials: {steel: {model: linear_elastic, density: 7.85 g/cm^3, young: 210 GPa, poisson: 0.3}}
bodies:
  - {name: block, box: {from: [1 mm, 1 mm], to: [4 mm, 3 mm]}, material: steel, velocity: [0, -1 m/s]}
output: {frames: 1, history: 2}
SCENE
}
