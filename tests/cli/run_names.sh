#!/usr/bin/env bash
# Names and texts are never commands: those of files, titles, labels, bodies, columns, variants and conditions.
# usage: run_names.sh MPMFAST SOURCE_DIR
source "$(dirname "$0")/helpers.sh"

# Each would make the file `taken` where it stands as the name of a picture, in quotes of either kind, in a comment,
# in a block of data or in an expression of gnuplot.
attacks=(
  '|touch taken'
  '|touch taken; cat > y'
  "'; system 'touch taken'; '"
  "''; system 'touch taken'; ''"
  "a''; system 'touch taken'; #"
  '"; system "touch taken"; "'
  '`touch taken`'
  '$(touch taken)'
  '@ARG0 ${GNUTERM} <touch taken'
  "'.system('touch taken').'"
  '\'
)
broken=(
  $'x\nsystem "touch taken"\n'
  $'x\nEOD\nsystem "touch taken"\n$x << EOD\n'
  $'x\rsystem "touch taken"\r'
)

is_free() {
  checks=$((checks + 1))
  [[ -z $(find . -name taken) ]] || fail "$1 is executed"
  find . -name taken -delete
}

# In HTML and SVG: what a browser would show.
shows() {
  checks=$((checks + 1))
  /usr/bin/python3 - "$1" "$2" <<'PYTHON' || fail "$1 does not show '$2'"
import sys, xml.etree.ElementTree as tree
texts = ["".join(e.itertext()).strip() for e in tree.parse(sys.argv[1]).iter() if e.tag.endswith("}text")]
sys.exit(not any(sys.argv[2].strip() in text for text in texts))
PYTHON
}

check_file_names() {
  local attack
  for attack in "${attacks[@]}"; do
    run 0 plot plotted --columns kinetic_J --out "$attack.svg"
    is_free "--out $attack.svg"
    checks=$((checks + 1))
    [[ -s "$attack.svg" && -s "$attack.svg.gp" ]] || fail "there is no picture '$attack.svg'"
    mkdir "folder of $attack"
    run 0 plot plotted --columns kinetic_J --out "folder of $attack"
    is_free "--out 'folder of $attack'"
    checks=$((checks + 1))
    [[ -s "folder of $attack/plot_columns.png" ]] || fail "there is no picture in 'folder of $attack'"
  done
  for attack in "${broken[@]}"; do
    run 2 plot plotted --columns kinetic_J --out "$attack.svg"
    says err 'holds a control character'
    run 2 plot plotted --columns kinetic_J --out "$attack"
    run 2 plot "$attack" --columns kinetic_J
    run 2 run scene.yaml --out "$attack"
    run 2 run "$attack.yaml"
    run 2 study "$attack.yaml"
    run 2 study study.yaml --out "$attack"
    run 2 report plotted --out "$attack"
    run 2 resume "$attack"
    run 2 new "$attack"
    is_free 'a name with a line that ends'
  done
  ln -s 'real.svg' '|link.svg'
  run 0 plot plotted --columns kinetic_J --out '|link.svg'
  checks=$((checks + 1))
  [[ -L '|link.svg' && -s real.svg ]] || fail 'a link is not followed'
}

check_texts() {
  local attack
  for attack in "${attacks[@]}"; do
    run 0 plot plotted --columns kinetic_J --title "$attack" --label "l $attack" --x-label "x $attack" \
      --y-label "$attack y" --out texts.svg
    is_free "a text '$attack'"
    shows texts.svg "$attack"
    shows texts.svg "l $attack"
    shows texts.svg "x $attack"
  done
  for attack in "${broken[@]}"; do
    run 0 plot plotted --columns kinetic_J --title "$attack" --label "$attack" --x-label "$attack" --out texts.svg
    is_free 'a text with a line that ends'
  done
  run 0 plot plotted --columns kinetic_J --title "'first" --label "two '' quotes" --out texts.svg
  shows texts.svg "'first"
  shows texts.svg "two '' quotes"
}

# Names of bodies are names of columns.
check_columns() {
  local attack folder name
  for attack in "${attacks[@]}" "${broken[@]}"; do
    folder=body_$RANDOM$RANDOM
    name=$(/usr/bin/python3 -c 'import json, sys; print(json.dumps(sys.argv[1]))' "$attack")
    sed "s/name: block/name: __NAME__/" scene.yaml >named.yaml
    /usr/bin/python3 - "$name" <<'PYTHON'
import pathlib, sys
scene = pathlib.Path("named.yaml")
scene.write_text(scene.read_text().replace("__NAME__", sys.argv[1]).replace("a falling block", "a block"))
PYTHON
    checks=$((checks + 1))
    "$program" run named.yaml --steps 2 --out "$folder" --progress none >out 2>err || continue  # it is no name
    run 0 plot "$folder"
    is_free "a body '$attack'"
    run 0 plot "$folder" --columns "$(head -1 "$folder/history.csv" | tr ',' '\n' | grep -m1 'mass_kg' | tr -d '"')" \
      --out column.svg
    is_free "a column '$attack'"
  done
}

# The titles, axes, variants, conditions and labels of a study.
check_study() {
  /usr/bin/python3 - "${attacks[@]}" "${broken[@]}" <<'PYTHON'
import json, sys
names = sys.argv[1:]
variants = [{"name": name, "set": {"time.cfl": 0.3 + 0.01 * k}} for k, name in enumerate(names)]
base = {"scene": "scene.yaml", "title": names[2], "set": {"output.picture": "none"}, "variants": variants,
        "vary": {names[4]: {names[3]: {"set": {"output.history": 2}}}, names[12]: {names[5]: {}, "50 % of %s": {}}}}
curve = {"name": "curve", "x": "time_s", "y": "kinetic_J", "title": names[2], "x_label": names[6], "y_label": names[12]}
charts = dict(base, error={"quantity": "block.vy", "compare": "final", "expected": -1, "relative": "no"},
              curves=[curve, dict(curve, name="panels", panels=names[12])])
holds = [{"name": name, "quantity": "kinetic_J", "at_most": -1, "only": {"variants": name}} for name in names]
maps = dict(base, holds=holds, map={"panels": names[4], "columns": names[12]})
small = dict(base, variants=variants[:1], holds=[{"name": "a", "quantity": "kinetic_J", "at_most": -1}],
             vary={"case": {"small": {}}, "x": {"'a ''": {}, "50 % of %s": {}}}, map={"panels": "case", "columns": "x"})
for file, study in (("charts.yaml", charts), ("maps.yaml", maps), ("small.yaml", small)):
    json.dump(study, open(file, "w"))
PYTHON
  run 0 study charts.yaml --out charts --progress none
  is_free 'a text of a study'
  for name in study curve panels; do
    checks=$((checks + 1))
    [[ -s charts/$name.svg && -s charts/$name.png ]] || fail "a study of odd names has no chart $name"
  done
  shows charts/curve.svg "''; system 'touch taken'; ''"
  shows charts/panels.svg "'; system 'touch taken'; '"
  run 0 study maps.yaml --out maps --progress none
  is_free 'a text of a map'
  set -- maps/map_*.svg
  checks=$((checks + 1))
  [[ -s $1 ]] || fail 'a study of odd names has no map'
  shows "$1" '`touch taken`'
  run 0 study small.yaml --out small --progress none
  shows small/map_small.svg '50 % of %s'
  shows small/map_small.svg "'a ''"
  # A program's path stands in a comment of the scene that it runs.
  printf '#!/bin/sh\nexit 0\n' >$'p\nspace: line'
  chmod +x $'p\nspace: line'
  printf '%s\n' 'scene: scene.yaml' 'variants: [{name: a, program: "p\nspace: line"}]' 'quantities: {v: block.vy}' \
    >program.yaml
  run 2 study program.yaml --out program
  says err 'holds a control character'
}

write_good_scene
if ! command -v gnuplot >/dev/null; then
  echo 'no gnuplot: nothing to check'
  exit 77
fi
mkdir temporary
export TMPDIR=$work/temporary
run 0 run scene.yaml --steps 4 --out plotted --progress none
printf '%s\n' 'scene: scene.yaml' 'variants: [{name: a}]' 'quantities: {v: block.vy}' >study.yaml
check_file_names
check_texts
check_columns
check_study
checks=$((checks + 1))
[[ -z $(ls "$TMPDIR") ]] || fail 'a folder that gnuplot drew in is left'
printf '%d checks, %d failures\n' "$checks" "$failures"
[[ $failures == 0 ]]
