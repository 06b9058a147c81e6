#!/bin/sh
# Error against cost of the contact methods on configs/uniaxial.yaml, as a table:
#   bench/uniaxial.sh build/release/mpmfast [CELL_MM [PLANE_MM...]]
# Error: largest difference of the mean axial stress from one velocity field with the same particles and update, from 1 %
# strain on. PLANE_MM: heights of the contact plane; by default on a grid line and in the middle of a cell of 5 mm, so
# "5 51 51.7 53.6" gives three other places, "2.5" half the cell size.
set -eu
program=$(realpath "$1")
shift
cell=5
[ $# -eq 0 ] || { cell=$1; shift; }
[ $# -gt 0 ] || set -- 50 52.5
planes=$*
scene="$(cd "$(dirname "$0")/.." && pwd)/configs/uniaxial.yaml"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# simulate FOLDER OVERRIDE...: one run on one thread; a run that fails keeps its history.
simulate() {
  folder=$1
  shift
  set -- $(printf -- '--set %s ' "$@")
  "$program" run "$scene" --threads 1 --progress none --force --out "$work/$folder" --set output.frames=0 --set grid.cell="$cell mm" "$@" \
    > "$work/log" 2>&1 || true
}

# compare FOLDER REFERENCE: "error to 10 %, error to the end, last strain"
compare() {
  awk -F, -v speed=0.9622 -v height=0.1 '
    FNR == 1 { for (i = 1; i <= NF; i++) column[$i] = i; file++; next }
    file == 1 { n++; t[n] = $2; s[n] = $column["all.mean_stress_yy_Pa"]; next }
    {
      strain = $2 * speed / height; last = strain
      if (strain < 0.01) next
      k = 2
      while (k < n && t[k] < $2) k++
      reference = s[k - 1] + ($2 - t[k - 1]) / (t[k] - t[k - 1]) * (s[k] - s[k - 1])
      e = $column["all.mean_stress_yy_Pa"] / reference - 1
      if (e < 0) e = -e
      if (strain <= 0.1 && e > early) early = e
      if (strain <= 0.2 && e > late) late = e
    }
    END { printf "%.2f %% | %.2f %% | %.1f %%", 100 * early, 100 * late, 100 * last }' "$work/$2/history.csv" "$work/$1/history.csv"
}

value() { sed -n "s/^ *\"$2\": \([-0-9.e+]*\).*/\1/p" "$work/$1/run.json" | head -n 1; }

echo "| update | contact | plane | error to 10 % | error to 20 % | reaches | wall s | energy error |"
echo "|---|---|---|---|---|---|---|---|"
for plane in $planes; do
  height=$(awk "BEGIN { print $plane / 1000 }")
  lower="bodies.0.box.to=[0.04,$height]"
  upper="bodies.1.box.from=[0,$height]"
  for update in flip "xpic(2)" "xpic(5)"; do
    simulate one "method.update=$update" contact=none "$lower" "$upper"
    for contact in logistic_regression smoothed_logistic_regression average_gradient; do
      simulate two "method.update=$update" "contact.normal=$contact" "$lower" "$upper"
      echo "| $update | $contact | $plane mm | $(compare two one) | $(printf "%.1f" "$(value two wall_s)") | $(printf "%.1e" "$(value two energy_error)") |"
    done
  done
done
