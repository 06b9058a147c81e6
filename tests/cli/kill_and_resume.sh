#!/usr/bin/env bash
# A run that is killed at random moments and resumed each time ends as the one that was never stopped: the same
# checksum, the same history and particle files to the byte.
# usage: kill_and_resume.sh MPMFAST [KILLS [SEED]]
set -u
program=$(realpath "$1")
kills=${2:-${MPMFAST_KILLS:-6}}
RANDOM=${3:-$$}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1

cat >scene.yaml <<'SCENE'
title: three bodies between walls, under a piston, stirred by a paddle
space: plane_strain
grid: {size: [24 mm, 24 mm], cell: 0.4 mm}
time: {end: 300 us}
materials:
  soft: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}
  metal: {model: j2_plasticity, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa, yield: 2 MPa, hardening: 5 MPa}
  tool: {model: rigid}
bodies:
  - {name: a, disk: {centre: [6 mm, 6 mm], radius: 4 mm}, material: soft, velocity: [20 m/s, 20 m/s]}
  - {name: b, disk: {centre: [13 mm, 13 mm], radius: 5 mm}, material: metal, velocity: [-20 m/s, -20 m/s]}
  - {name: c, ellipse: {centre: [15 mm, 6 mm], radii: [5 mm, 2 mm], angle: 0.4 rad}, material: soft, velocity: [-30 m/s, 10 m/s]}
  - {name: paddle, box: {from: [3 mm, 13 mm], to: [4 mm, 16 mm]}, material: tool, rotation: {about: [3.5 mm, 14.5 mm], speed: 500 rad/s}}
boundaries: {left: wall, bottom: wall, right: wall, top: {piston: 10 m/s, direction: down, position: 19 mm}}
contact: {law: coulomb, friction: 0.3, pairs: [{between: [a, b], friction: 0.1}]}
gravity: [0, -9.81 m/s^2]
method: {basis: lcpdi, update: xpic(3)}
output: {frames: 12, history: 60, checkpoint: {steps: 5}, overlap: true}
SCENE

# What depends on the wall clock, the threads and the number of stops.
figures() {
  grep -vE '"(threads|command|resumes|wall_s|particle_steps_per_s|peak_memory_bytes)"' "$1/run.json" |
    sed '/"seconds": {/,/}/d'
}

compare() {
  local file
  diff <(figures whole) <(figures "$1") || return 1
  for file in history.csv particles.pvd scene.yaml picture_last_body.png picture_last_pressure.png; do
    cmp "whole/$file" "$1/$file" || return 1
  done
  diff -r whole/particles "$1/particles" || return 1
  [[ -z $(find "$1" -name '*.tmp') ]] || { echo "$1 holds what a kill left"; return 1; }
}

"$program" run scene.yaml --out whole --progress none --threads 1 >out 2>&1 || { cat out; exit 1; }
killed=0
runs=0
while ((killed < kills)); do
  runs=$((runs + 1))
  folder=stopped_$runs
  ended=0
  until ((ended)); do
    words=(resume "$folder")
    [[ -f $folder/checkpoint.h5 ]] || words=(run scene.yaml --out "$folder" --force)
    "$program" "${words[@]}" --progress none --threads $((RANDOM % 3 + 1)) >out 2>&1 &
    process=$!
    if ((killed < kills)); then
      sleep "0.$(printf '%03d' $((RANDOM % 350 + 20)))"
      kill -KILL "$process" 2>/dev/null
    fi
    wait "$process" 2>/dev/null
    code=$?
    case $code in
      0) ended=1 ;;
      137) killed=$((killed + 1)) ;;
      *)
        echo "mpmfast ${words[*]}: exit $code after $killed kills"
        cat out
        exit 1
        ;;
    esac
  done
  compare "$folder" || { echo "$folder is not the run that was never stopped, after $killed kills"; exit 1; }
done
grep -o '"resumes": [0-9]*' "$folder/run.json"
printf '%d kills in %d runs: each ended as the run that was never stopped\n' "$killed" "$runs"
