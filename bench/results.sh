#!/bin/sh
# Runs the studies and makes bench/results/README.md of them: bench/results.sh PROGRAM [--out DIR] [STUDY]...
# PROGRAM is build/ci/mpmfast; a STUDY is a name in configs/studies/ without its .yaml. With names, only those are run and
# the page keeps what it says of the others. What the same program has finished in DIR (runs/studies) is not run again.
# The study `precision` asks for build/single too (cmake --preset single; cmake --build --preset single).
# A section is made of the study's title, its opening comment, its charts and its table.
set -eu
program=$(realpath "$1")
shift
root=$(cd "$(dirname "$0")/.." && pwd)
work=$root/runs/studies
if [ "${1:-}" = --out ]; then
  work=$2
  shift 2
fi
page=$root/bench/results/README.md
for name in "$@"; do
  [ -f "$root/configs/studies/$name.yaml" ] || { echo "no study configs/studies/$name.yaml" >&2; exit 2; }
done
mkdir -p "$work"
trap 'rm -f "$page.new"' EXIT

title_of() { sed -n 's/^title: *"\{0,1\}\(.*[^"]\)"\{0,1\} *$/\1/p' "$1" | head -n 1; }

# Copies the pictures of a study beside the page and names them there: study.svg takes the study's name.
copy_charts() {
  for chart in "$work/$1"/*.svg; do
    part=$(basename "$chart" .svg)
    [ "$part" = study ] && part=$1
    cp "$chart" "$root/bench/results/$part.svg"
    echo "![$part]($part.svg)"
  done
}

new_section() {
  study=$root/configs/studies/$1.yaml
  "$program" study "$study" --out "$work/$1" --threads 1 > "$work/$1.log" 2>&1 || { cat "$work/$1.log" >&2; exit 1; }
  echo
  echo "## $(title_of "$study")"
  echo
  sed -n '/^#/!q; s/^# *//p' "$study"
  echo
  copy_charts "$1"
  echo
  cat "$work/$1/study.md"
}

# What the page says of a study now, with the empty line before it.
old_section() {
  awk -v title="## $(title_of "$root/configs/studies/$1.yaml")" '
    /^## / { inside = $0 == title; if (inside) print "" }
    inside { lines[++count] = $0 }
    END { while (count > 0 && lines[count] == "") --count; for (n = 1; n <= count; ++n) print lines[n] }' "$page"
}

wanted() {
  [ -n "$names" ] || return 0
  case " $names " in *" $1 "*) return 0 ;; esac
  return 1
}

names="$*"
{
  echo "# Measured"
  echo
  echo "Speed against error of the methods on the reference cases. Made by \`bench/results.sh\`; the scenes and the studies"
  echo "are in \`configs/\`, the goals and the tests in \`tests/validation/\`."
  for study in "$root"/configs/studies/*.yaml; do
    grep -q "^map:" "$study" && continue  # bench/stability.sh
    name=$(basename "$study" .yaml)
    if wanted "$name"; then new_section "$name"; else old_section "$name"; fi
  done
  if [ -f "$root/bench/results/notes.md" ]; then echo; cat "$root/bench/results/notes.md"; fi
} > "$page.new"
mv "$page.new" "$page"
