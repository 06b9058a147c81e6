#!/bin/sh
# Runs the hard cases over time step, update and basis and makes bench/results/stability.md of them, a chart a case:
# bench/stability.sh PROGRAM [--out DIR] [--jobs N]. PROGRAM is build/ci/mpmfast. What the same program has finished in DIR
# (runs/stability) is not run again.
set -eu
program=$(realpath "$1")
shift
root=$(cd "$(dirname "$0")/.." && pwd)
work=$root/runs/stability
jobs=$(nproc)
while [ $# -gt 1 ]; do
  case $1 in
    --out) work=$2 ;;
    --jobs) jobs=$2 ;;
    *) echo "unknown option $1" >&2; exit 2 ;;
  esac
  shift 2
done
study=$root/configs/studies/stability.yaml
page=$root/bench/results/stability.md
mkdir -p "$work" "$root/bench/results/stability"
"$program" study "$study" --out "$work" --jobs "$jobs" > "$work.log" 2>&1 || { tail -n 20 "$work.log" >&2; exit 1; }
trap 'rm -f "$page.new"' EXIT
rm -f "$root"/bench/results/stability/*.svg
for chart in "$work"/map_*.svg; do
  cp "$chart" "$root/bench/results/stability/$(basename "$chart" | sed 's/^map_//')"
done
{
  echo "# Stability on hard cases"
  echo
  echo "Made by \`bench/stability.sh\`; the scenes are in \`configs/hard/\`, what must hold in each in"
  echo "\`configs/studies/stability.yaml\`; \`tests/stability/hard_cases.cpp\` runs the default method of each in CI."
  echo
  sed -n '/^#/!q; s/^# *//p' "$study"
  echo
  sed 's|](map_|](stability/|' "$work/study.md"
  if [ -f "$root/bench/results/stability_notes.md" ]; then echo; cat "$root/bench/results/stability_notes.md"; fi
} > "$page.new"
mv "$page.new" "$page"
