#!/bin/sh
# How much the grains of configs/ellipses.yaml enter each other with each contact method, as a table:
#   bench/overlap.sh build/release/mpmfast [CELL [END]]
# CELL: half the scene's resolution by default, "1/35 mm"; END: "15 us", 75 % of the die. One thread, XPIC(5). Overlap: area that two
# grains both claim; inside: area of the particles whose centre lies in another grain. A run that fails shows how far it came.
set -eu
program=$(realpath "$1")
cell=${2:-1/35 mm}
end=${3:-15 us}
scene="$(cd "$(dirname "$0")/.." && pwd)/configs/ellipses.yaml"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

value() { sed -n "s/^ *\"$1\": \([-0-9.e+]*\).*/\1/p" "$work/run/run.json" | head -n 1; }

# last COLUMN: of history.csv
last() {
  awk -F, -v name="$1" 'FNR == 1 { for (i = 1; i <= NF; i++) if ($i == name) column = i } END { print $column }' "$work/run/history.csv"
}

# row NAME OVERRIDE...: a run and its line of the table
row() {
  name=$1
  shift
  # shellcheck disable=SC2046  # the overrides hold no spaces
  set -- $(printf -- '--set %s ' "$@")
  "$program" run "$scene" --threads 1 --progress none --force --out "$work/run" --set "grid.cell=$cell" --set "time.end=$end" --set "method.update=xpic(5)" \
    --set output.frames=0 --set output.overlap=true "$@" > "$work/log" 2>&1 || true
  awk -v name="$name" -v time="$(last time_s)" -v overlap="$(last overlap_m2)" -v inside="$(last inside_m2)" \
    -v stress="$(last all.mean_stress_yy_Pa)" -v energy="$(value energy_error)" -v steps="$(value steps)" -v wall="$(value wall_s)" \
    'BEGIN { printf "| %s | %.1f us | %.4f mm2 | %.4f mm2 | %.1f GPa | %.2g | %d | %.0f |\n", name, 1e6 * time, 1e6 * overlap, 1e6 * inside, 1e-9 * stress, energy, steps, wall }'
}

echo "| contact | reaches | overlap | inside | mean axial stress | energy error | steps | wall s |"
echo "|---|---|---|---|---|---|---|---|"
row "smoothed_max_margin (default)" contact.normal=smoothed_max_margin
row "smoothed_logistic_regression" contact.normal=smoothed_logistic_regression
row "logistic_regression (N20)" contact.as=N20
row "average_gradient, position_power (DF)" contact.as=DF
row "average_gradient, position_offset (CP)" contact.as=CP
