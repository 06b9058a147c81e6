#!/usr/bin/env bash
# What is installed works where it lies: program, man page, completion, library with its examples, Python module, package.
# usage: install.sh MPMFAST SOURCE_DIR BUILD_DIR
build=$(realpath "$3")
source "$(dirname "$0")/helpers.sh"

# expect WHAT COMMAND…: the command succeeds; its streams are in out and err.
expect() {
  local what=$1
  shift
  checks=$((checks + 1))
  "$@" >out 2>err || fail "$what"
}

# completes EXPECTED WORD…: what the shell would offer for the last of the words.
completes() {
  local expected=$1
  shift
  expect "completion of '$*'" bash -c '
    source "$0"
    COMP_WORDS=("$@")
    COMP_CWORD=$(($# - 1))
    _mpmfast
    printf "%s\n" "${COMPREPLY[@]}"' "$prefix/share/bash-completion/completions/mpmfast" "$@"
  says out "$expected"
}

prefix=$work/prefix
expect "install" cmake --install "$build" --prefix "$prefix"
program=$prefix/bin/mpmfast

cp "$prefix/share/mpmfast/configs/thick_ring.yaml" scene.yaml
run 0 run scene.yaml --steps 3 --progress none --out installed

page=$prefix/share/man/man1/mpmfast.1
for word in $("$program" --help | sed -n 's/^  \([a-z]\+\)  .*/\1/p'); do
  expect "the man page has $word" grep -q "^\.SS mpmfast $word" "$page"
  "$program" "$word" --help | grep -o '^  --[a-z]\+' | while read -r option; do
    [[ $option == --help ]] || grep -qF -- "$(sed 's/-/\\-/g' <<<"$option")" "$page" || echo "$word $option"
  done >missing
  expect "the man page has every option: $(cat missing)" test ! -s missing
done
if command -v groff >/dev/null; then
  expect "the man page is sound" groff -man -Tutf8 -ww -z "$page"
  expect "the man page makes no warnings: $(head -3 err)" test ! -s err
fi
completes resume mpmfast res
completes --until mpmfast run --u
completes plain mpmfast run --progress p
completes bases mpmfast list ba
completes von_mises mpmfast plot runs --field v
completes time.cfl= mpmfast run --set time.c
completes contact.friction= mpmfast check --set contact.f
completes gravity.ramp= mpmfast check --set grav

# Its pages point to what is there.
expect "links of the pages" /usr/bin/python3 "$source_dir/tests/cli/documents.py" --links "$prefix/share"
expect "the manual" test -f "$prefix/share/doc/mpmfast/tools/manual/output.md"

# A program and a script of somebody else's.
expect "the examples find the library" cmake -S "$source_dir/tools/examples" -B examples -G Ninja \
  -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_BUILD_TYPE=Release
expect "the examples build" cmake --build examples
write_good_scene
sed -i 's/^time.*/time: {end: 100 us}/' scene.yaml
expect "the example runs" examples/drag scene.yaml 2000
cp out drag.csv
env -u OMP_WAIT_POLICY OMP_DISPLAY_ENV=verbose examples/drag scene.yaml 2000 >out 2>err
says err "GOMP_SPINCOUNT = '1000'"
expect "energies of the example" /usr/bin/python3 - drag.csv <<'PYTHON'
import csv, math, sys
rows = [[float(x) for x in row.values()] for row in csv.DictReader(open(sys.argv[1]))]
# A free block under drag: its velocity falls as exp(-rate t), and drag takes what it loses.
for time, kinetic, stored, work in rows:
    expected = rows[0][1] * math.exp(-2 * 2000 * time)
    assert abs(kinetic - expected) < 2e-3 * rows[0][1], (time, kinetic, expected)
    assert abs(kinetic + stored - rows[0][1] - work) < 1e-6 * rows[0][1], (time, kinetic, stored, work)
assert len(rows) == 11 and rows[-1][0] > 0.99e-4
PYTHON

# The program that the manual shows.
mkdir shown
sed -n '/^#include <mpmfast/,/^```/p' "$prefix/share/doc/mpmfast/tools/manual/output.md" | grep -v '^```' >shown/main.cpp
cat >shown/CMakeLists.txt <<'CMAKE'
cmake_minimum_required(VERSION 3.25)
project(shown LANGUAGES CXX)
find_package(mpmfast REQUIRED)
add_executable(shown main.cpp)
target_link_libraries(shown mpmfast::mpmfast)
CMAKE
expect "the manual's program finds the library" cmake -S shown -B shown/build -G Ninja -DCMAKE_PREFIX_PATH="$prefix"
expect "the manual's program builds" cmake --build shown/build
expect "the manual's program runs" shown/build/shown
checks=$((checks + 1))
[[ $(grep -c '^time_s = ' out) == 10 ]] || fail "the manual's program does not take ten parts"

sed 's/1 mm, 1 mm/1 mm, -1 mm/' scene.yaml >broken.yaml
checks=$((checks + 1))
examples/drag broken.yaml >out 2>err
[[ $? == 2 ]] || fail "a broken scene is no 2"
says err "lies 0.001 m outside the grid"

module=$(ls "$prefix"/lib/python3/dist-packages/mpmfast/_engine*.so 2>/dev/null)
if [[ -n $module ]]; then
  export PYTHONPATH=$prefix/lib/python3/dist-packages
  for file in __init__.pyi py.typed; do
    expect "$file" test -f "$PYTHONPATH/mpmfast/$file"
  done
  expect "the Python example" /usr/bin/python3 "$source_dir/tools/examples/drag.py" scene.yaml 2000
  cp out drag_python.csv
  expect "C++ and Python agree" cmp drag_python.csv drag.csv
fi

if command -v dpkg-shlibdeps >/dev/null; then
  expect "the package" cpack --config "$build/CPackConfig.cmake" -B package
  expect "the package unpacks" dpkg -x package/mpmfast_*.deb unpacked
  program=$work/unpacked/usr/bin/mpmfast
  run 0 check "$work/unpacked/usr/share/mpmfast/configs/gap.yaml"
  if [[ -n $module ]]; then
    expect "the package's Python module" env PYTHONPATH="$work/unpacked/usr/lib/python3/dist-packages" \
      /usr/bin/python3 -c 'import mpmfast, sys; sys.exit(not mpmfast.__file__.startswith(sys.argv[1]))' "$work/unpacked"
  fi
  expect "the package says what it needs" dpkg-deb -f package/mpmfast_*.deb Depends
  says out libyaml-cpp
  says out libcairo2
fi
printf '%d checks, %d failures\n' "$checks" "$failures"
[[ $failures == 0 ]]
