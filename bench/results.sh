#!/bin/sh
# Runs the studies and makes bench/results/README.md of them: bench/results.sh build/ci/mpmfast [FOLDER OF STUDIES]
# What was finished in the folder is not run again. A page is made of each study's title, its opening comment, its chart
# and its table.
set -eu
program=$(realpath "$1")
root=$(cd "$(dirname "$0")/.." && pwd)
work=${2:-$root/runs/studies}
page=$root/bench/results/README.md
mkdir -p "$work"
{
  echo "# Measured"
  echo
  echo "Speed against error of the methods on the reference cases. Made by \`bench/results.sh\`; the scenes and the studies"
  echo "are in \`configs/\`, the goals and the tests in \`tests/validation/\`."
} > "$page.new"
for study in "$root"/configs/studies/*.yaml; do
  name=$(basename "$study" .yaml)
  "$program" study "$study" --out "$work/$name" --threads 1 > "$work/$name.log" 2>&1 || { cat "$work/$name.log"; exit 1; }
  for chart in "$work/$name"/*.svg; do
    part=$(basename "$chart" .svg)
    [ "$part" = study ] && part=$name
    cp "$chart" "$root/bench/results/$part.svg"
  done
  {
    echo
    echo "## $(sed -n 's/^title: *"\{0,1\}\(.*[^"]\)"\{0,1\} *$/\1/p' "$study" | head -n 1)"
    echo
    sed -n '/^#/!q; s/^# *//p' "$study"
    echo
    for chart in "$work/$name"/*.svg; do
      part=$(basename "$chart" .svg)
      [ "$part" = study ] && part=$name
      echo "![$part]($part.svg)"
    done
    echo
    cat "$work/$name/study.md"
  } >> "$page.new"
done
if [ -f "$root/bench/results/notes.md" ]; then { echo; cat "$root/bench/results/notes.md"; } >> "$page.new"; fi
mv "$page.new" "$page"
