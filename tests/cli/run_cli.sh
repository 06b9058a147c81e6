#!/usr/bin/env bash
# Checks the command line as a user meets it: exit codes, messages, and that nothing is written when something is wrong.
# usage: run_cli.sh MPMFAST SOURCE_DIR
#
# A broken scene states what it must provoke in lines "# expect: LINE: path: fragment"; the path is empty where the file
# as a whole is meant.
source "$(dirname "$0")/helpers.sh"

# Only the streams may lie in the work folder, beside what the caller names.
wrote_nothing() {
  checks=$((checks + 1))
  local extra
  extra=$(find . -mindepth 1 -not -name out -not -name err -not -name 'scene*.yaml' | head -n 3)
  [[ -z $extra ]] || fail "$1 left $extra behind"
}

# Some line of err is FILE:LINE:COLUMN: path: …fragment….
reports() {
  local file=$1 line=$2 path=$3 fragment=$4 text
  checks=$((checks + 1))
  while IFS= read -r text; do
    [[ $text == "$file:$line:"*": ${path:+$path: }"*"$fragment"* ]] && return
  done <err
  fail "$file: expected line $line, '$path', '$fragment'"
}

check_broken_scenes() {
  local file expectation line path fragment found
  for file in "$source_dir"/tests/cli/broken/*.yaml; do
    run 2 run "$file"
    wrote_nothing "$file"
    found=0
    while IFS= read -r expectation; do
      found=1
      line=${expectation%%: *}
      expectation=${expectation#*: }
      path=${expectation%%: *}
      fragment=${expectation#*: }
      if [[ $expectation == ": "* ]]; then
        path=''
        fragment=${expectation#: }
      fi
      reports "$file" "$line" "$path" "$fragment"
    done < <(sed -n 's/^# expect: //p' "$file")
    [[ $found == 1 ]] || fail "$file states no expectation"
    run 2 check "$file"
  done
}

check_unreadable_scenes() {
  : >scene_empty.yaml
  run 2 check scene_empty.yaml
  says err 'scene_empty.yaml: empty (a scene was expected)'
  printf 'title: a\nspa\0ce: 3d\n' >scene_nul.yaml
  run 2 check scene_nul.yaml
  says err 'scene_nul.yaml:2:4: not UTF-8 text, got the byte 0x00'
  printf 'title: a\n' | iconv -t UTF-16 >scene_utf16.yaml
  run 2 check scene_utf16.yaml
  says err 'scene_utf16.yaml:1:1: not UTF-8 text'
  run 4 run scene_nowhere.yaml
  says err 'scene_nowhere.yaml: cannot read the scene: no such file'
  run 4 check .
  says err 'it is a folder'
  wrote_nothing 'an unreadable scene'
}

check_words() {
  run 0 --version
  says out 'mpmfast '
  run 0 --help
  says out 'run'
  run 2
  run 2 rnu scene.yaml
  says err "unknown command 'rnu' (one of new, run, resume, "
  says err "). Did you mean 'run'?"
  run 2 run
  says err 'SCENE is required'
  run 2 run scene.yaml --thread 2
  says err "Did you mean '--threads'?"
  run 2 run scene.yaml --threads x
  says err "--threads: not a number of threads (1 to 4096), got 'x'"
  run 2 run scene.yaml --threads 0
  run 2 run scene.yaml --steps=-1
  run 2 run scene.yaml --until '5 mm'
  says err "--until: 'mm' is a length"
  run 2 run scene.yaml --progress loud
  says err 'one of auto, plain, none'
  run 2 run scene.yaml --set cfl
  says err '--set: not an override (KEY=VALUE'
  run 2 check scene.yaml another.yaml
  run 2 resume
  says err 'DIR is required'
  run 2 resume folder --until now
  wrote_nothing 'a wrong command line'
}

check_lists() {
  run 0 list
  for word in neo_hookean lcpdi 'xpic(m)' logistic_regression position_offset coulomb polygon piston; do
    says out "$word"
  done
  run 0 list laws
  says out frictionless
  grep -q neo_hookean out && fail 'list laws lists materials'
  run 2 list law
  says err "Did you mean 'laws'?"
  run 0 list contact
  says out '- `N20`: normal: logistic_regression'
  says out '| `friction` |'
  grep -q '| `cfl` |' out && fail 'list contact lists the keys of time'
}

check_schema() {
  run 0 schema
  says out '"$schema": "http://json-schema.org/draft-07/schema#"'
  run 0 schema --markdown
  cmp -s out "$source_dir/tools/manual/scene.md" || fail 'tools/manual/scene.md is not what schema --markdown prints'
  run 2 schema scene.yaml
  run 2 schema --markdwon
  says err "Did you mean '--markdown'?"
}

check_overrides() {
  run 0 check scene.yaml
  run 0 check --set time.cfl=0.3 scene.yaml --set 'grid.size=[12 mm, 12 mm]'
  run 2 check scene.yaml --set time.cfl=0.3 --set time.clf=0.3
  says err "--set time.clf=0.3: time.clf: unknown key. Did you mean 'cfl'?"
  run 2 check scene.yaml --set bodies.1.material=steel
  says err '--set bodies.1.material=steel: bodies.1: no such entry'
  wrote_nothing check
}

check_output_folder() {
  run 0 run scene.yaml --steps 2 --progress none
  says out 'checksum'
  [[ -f runs/scene/run.json ]] || fail 'runs/scene/run.json is missing'
  local before
  before=$(md5sum runs/scene/run.json)
  run 2 run scene.yaml --steps 2
  says err 'the output folder runs/scene exists (--force replaces a run'
  [[ $(md5sum runs/scene/run.json) == "$before" ]] || fail 'a refused run wrote into the folder'
  run 0 run scene.yaml --steps 2 --force --progress none
  run 0 run runs/scene/scene.yaml --out again --steps 2 --progress none
  cmp -s runs/scene/scene.yaml again/scene.yaml || fail 'the resolved scene, run again, resolves to another'
  rm -rf runs again
}

# What --force removes lies in the folder itself: links go, what they lead to stays.
check_force_and_links() {
  local kept link
  run 0 run scene.yaml --steps 2 --out there --progress none
  kept=$(find there -type f | sort | xargs md5sum)
  ln -s there link
  for link in link link/ ./link//; do
    run 4 run scene.yaml --steps 2 --out "$link" --force --progress none
    says err 'is a symbolic link, and --force removes nothing behind one'
  done
  rm -rf here/particles here/history.csv
  ln -s ../there/particles here/particles
  ln -s ../there/history.csv here/history.csv
  ln -sf ../there/picture_first_body.png here/picture_first_body.png
  run 0 run scene.yaml --steps 2 --out here --force --progress none
  [[ ! -L here/particles && -e here/particles/000000.vtu && ! -L here/history.csv ]] ||
    fail '--force left links in the folder'
  [[ $(find there -type f | sort | xargs md5sum) == "$kept" ]] || fail '--force changed what is behind a link'
  rm -rf there link
}

# --force replaces a run, never what a user wrote.
check_force() {
  mkdir own
  { echo '# my own words'; cat scene.yaml; } >own/scene.yaml
  cp own/scene.yaml own_scene.copy
  run 4 run own/scene.yaml --steps 2 --out own --force --progress none
  says err 'own/scene.yaml is the scene that is to run: --force would replace it'
  run 4 run scene.yaml --steps 2 --out own --force --progress none
  says err 'own holds no run (none of run.json, run.log, history.csv, checkpoint.h5), and --force replaces nothing else'
  cmp -s own/scene.yaml own_scene.copy || fail '--force replaced a scene'
  [[ $(ls own) == scene.yaml ]] || fail 'a refused run wrote into a folder'
  run 0 run scene.yaml --steps 2 --out here --progress none
  run 0 run here/scene.yaml --steps 2 --out here --force --progress none
  sed -i '1i # my own words' here/scene.yaml
  run 4 run here/scene.yaml --steps 2 --out here --force --progress none
  grep -q 'my own words' here/scene.yaml || fail '--force replaced the scene that was to run'
  run 0 run scene.yaml --steps 2 --out here --force --progress none
  echo edited | tee here/plot_energy.gp >here/plot_thesis.gp
  touch here/plot_energy.png here/plot_columns.pdf here/plot_mine.png
  run 0 run scene.yaml --steps 2 --out here --force --progress none
  [[ $(cat here/plot_energy.gp here/plot_thesis.gp) == $'edited\nedited' && -e here/plot_mine.png ]] ||
    fail '--force removed what is not of the program, or a script that was edited'
  [[ ! -e here/plot_energy.png && ! -e here/plot_columns.pdf ]] || fail '--force left a chart of the earlier run'
  mkdir nothing
  run 0 run scene.yaml --steps 2 --out nothing --force --progress none
  check_force_and_links
  rm -rf own here nothing own_scene.copy
}

# The block falls out of the grid, which has no floor.
check_failed_run() {
  run 3 run scene.yaml --set 'time.end=10 ms' --out fallen --progress none
  says err "body 'block'"
  says err 'left the grid'
  says err 'the place        fallen/failed.vtu'
  says err 'report           mpmfast report fallen'
  grep -q '"failed"' fallen/run.json || fail 'run.json does not say failed'
  run 4 run scene.yaml --out /dev/null/folder
  rm -rf fallen
}

# A strip is drawn out until its grips leave the grid: the console says why, before where to look.
check_failed_run_says_why() {
  cat >drawn.yaml <<'END'
space: plane_strain
grid: {size: [24 mm, 6 mm], cell: 1 mm}
time: {end: 4 ms}
materials:
  rubber: {model: logarithmic_neo_hookean, density: 1000 kg/m^3, young: 1 MPa, poisson: 0.3}
  grip: {model: rigid}
bodies:
  - {name: strip, box: {from: [9 mm, 2 mm], to: [15 mm, 4 mm]}, material: rubber}
  - {name: l, box: {from: [7 mm, 1 mm], to: [9 mm, 5 mm]}, material: grip, velocity: [-4 m/s, 0]}
  - {name: r, box: {from: [15 mm, 1 mm], to: [17 mm, 5 mm]}, material: grip, velocity: [4 m/s, 0]}
contact: {law: perfect}
output: {frames: 0, history: 20, picture: none}
END
  run 3 run drawn.yaml --out drawn --progress none
  says err "warning          particles of body 'strip' came "
  says err 'split: {edge: 1.5}'
  [[ $(grep -n '^warning' err | head -n 1) == 2:* ]] || fail 'what failed is not followed by the cause that is likely'
  run 0 run drawn.yaml --out drawn --steps 20 --force --progress none
  says out 'strain_force '
  says out 'contact_resolve '
  ! grep -qE '^ +(heat|xpic|extension|surfaces) ' out drawn/run.log || fail 'a pass that did not run is listed'
  grep -q '"heat": 0.0' drawn/run.json || fail 'run.json lacks a pass that did not run'
  rm -rf drawn drawn.yaml
}

# Streams that are closed, full or that nobody reads end the program with an exit code, never by abort(), and a study
# not at all.
check_streams() {
  local code kept
  checks=$((checks + 5))
  "$program" bogus 2>&- >out
  code=$?
  [[ $code == 2 ]] || fail "a wrong word with stderr closed: exit $code"
  "$program" bogus 2>/dev/full >out
  code=$?
  [[ $code == 2 ]] || fail "a wrong word with stderr full: exit $code"
  "$program" man >/dev/full 2>err
  code=$?
  [[ $code == 4 ]] || fail "the man page on a full device: exit $code"
  says err 'the output could not be written'
  "$program" run scene.yaml --steps 2 --out closed --progress none --set contact.friction=30 >&- 2>&-
  kept=$(cat closed/history.csv closed/run.log)
  [[ $kept != *'checksum  '* && $(head -n 1 closed/history.csv) == step,* ]] ||
    fail 'with stdout and stderr closed the messages went into a file of the run'
  write_good_study
  {
    "$program" study scene_study.yaml --out study >out
    echo $? >code
  } 2>&1 | true
  [[ $(cat code) == 0 && $(wc -l <study/study.csv) == 5 ]] ||
    fail "a study whose messages nobody reads: exit $(cat code)"
  rm -rf closed study code
}

# A page or a scene goes where a link or a pipe leads, which stay what they are.
check_special_files() {
  run 0 run scene.yaml --steps 2 --out reported --progress none
  ln -s there.html link.html
  run 0 report reported --out link.html
  [[ -L link.html && -s there.html ]] || fail 'report --out replaced a link'
  mkfifo pipe
  cat pipe >read.html &
  run 0 report reported --out pipe
  wait $!
  [[ -p pipe ]] && grep -q '^</html>$' read.html || fail 'report --out replaced a pipe'
  rm -rf reported link.html there.html pipe read.html
}

# A run takes what check says, to a tenth; up to a quarter less where pictures may come to have more pixels than they do
# (bench/memory has more of these, most without).
tell_memory() {
  local told taken steps=$1
  shift
  run 0 check "$@"
  told=$(sed -n 's/.*; about \([0-9.]*\) MiB at the peak$/\1/p' out)
  run 0 run "$@" --steps "$steps" --out large --force --progress none
  taken=$(sed -n 's/^memory  *\([0-9.]*\) MiB at most$/\1/p' out)
  checks=$((checks + 1))
  awk -v told="$told" -v taken="$taken" 'BEGIN { exit !(told > 0.9 * taken && told < 1.25 * taken) }' ||
    fail "check $* tells $told MiB, the run took $taken"
  rm -rf large
}

# Spheres that touch their neighbours and are thrown together: fields, slots and contact nodes are the most there.
write_spheres() {
  local i j k
  cat >spheres.yaml <<'SPHERES'
space: 3d
grid: {size: [34 mm, 34 mm, 34 mm], cell: 1 mm}
time: {end: 1 ms}
materials: {rubber: {model: neo_hookean, density: 1.2 g/cm^3, young: 80 MPa, poisson: 0.33}}
contact: {law: coulomb, friction: 0.3}
method: {strain: first}
bodies:
SPHERES
  for i in -1 0 1; do
    for j in -1 0 1; do
      for k in -1 0 1; do
        echo "  - {name: s$((i + 1))$((j + 1))$((k + 1)), sphere: {centre: [$((17 + 10 * i)) mm, $((17 + 10 * j)) mm, $((17 + 10 * k)) mm]," \
          "radius: 5 mm}, material: rubber, velocity: [$((-10 * i)) m/s, $((-10 * j)) m/s, $((-10 * k)) m/s]}"
      done
    done
  done >>spheres.yaml
}

check_told_memory() {
  local frames
  tell_memory 3 "$source_dir/configs/sand_column.yaml"
  tell_memory 3 "$source_dir/configs/starters/sphere3d.yaml"
  tell_memory 3 "$source_dir/configs/starters/impact.yaml" --set output.picture=none
  for frames in 0 1; do
    tell_memory 1 scene.yaml --set grid.cell=0.01mm --set "output={frames: $frames, history: 1}"
  done
  write_spheres
  tell_memory 40 spheres.yaml --set "output={frames: 0, history: 1, picture: none}"
  tell_memory 40 spheres.yaml --set "output={frames: 1, history: 1}" --set contact.normal=smoothed_logistic_regression
  tell_memory 10 spheres.yaml --set "output={frames: 0, history: 1}" --set "contact={family: penalty}" \
    --set "method={basis: bspline2, extension: {occupation: 0.8}}"
  tell_memory 40 "$source_dir/configs/ellipses.yaml" --set "output={frames: 1, history: 1}"
  tell_memory 40 "$source_dir/configs/hard/twenty_fields.yaml" --set grid.cell=0.1mm --set "output={frames: 0}"
  tell_memory 5 "$source_dir/configs/bench/block-3d.yaml" --set "grid.cell=1/23 m"
  rm -f spheres.yaml
}

# What is printed to be typed can be typed where a name has a blank.
check_quoting() {
  run 0 run scene.yaml --steps 2 --out "two words/it's" --progress none
  says out "report           mpmfast report 'two words/it'\\''s'"
  rm -rf 'two words'
}

# Two variants x two values; one variant throws its block out of the grid.
write_good_study() {
  cat >scene_study.yaml <<'STUDY'
scene: scene.yaml
variants:
  - {name: slow}
  - {name: fallen, set: {"bodies.0.velocity": [0, -20 km/s]}}
vary: {method.update: [flip, pic]}
error: {quantity: block.vy, compare: final, expected: -1}
STUDY
}

check_study() {
  local before
  write_good_study
  run 0 study scene_study.yaml --out study
  says err '[4/4] fallen, pic'
  says err "failed: step"
  says out 'failed           2 of 4 variants (study.csv says why)'
  [[ $(head -n 1 study/study.csv) == variant,error,particle_steps,wall_s,particle_steps_per_s,pareto,* ]] ||
    fail 'study.csv does not begin with the columns of the contract'
  [[ $(grep -c ',finished,' study/study.csv) == 2 && $(grep -c '^"fallen, .*,failed,' study/study.csv) == 2 ]] ||
    fail 'study.csv does not keep two finished and two failed variants'
  before=$(cat study/*/run.json | md5sum)
  cp study/study.csv study_before.csv
  run 0 study scene_study.yaml --out study
  [[ $(grep -c ' kept: ' err) == 4 && $(cat study/*/run.json | md5sum) == "$before" ]] ||
    fail 'a second study repeats what has ended'
  cmp -s study/study.csv study_before.csv || fail 'a second study writes another study.csv'
  sed -i 's/\[flip, pic\]/[flip, pic, xpic(2)]/' scene_study.yaml
  run 0 study scene_study.yaml --out study
  [[ $(grep -c ' kept: ' err) == 4 && $(wc -l <study/study.csv) == 7 ]] ||
    fail 'a study that grew runs more than what is new'
  says out 'runs             2 now, 4 kept (--force runs all again)'
  sed -i 's/"git": "[^"]*"/"git": "0ther"/' study/slow_flip/run.json
  run 0 study scene_study.yaml --out study
  says out 'runs             1 now, 5 kept'
  says err "(again: the program's git was 0ther)"
  run 0 study scene_study.yaml --out study --force
  [[ $(grep -c ' kept: ' err) == 0 ]] || fail '--force keeps results'
  rm -rf study study_before.csv
}

# A table of quantities, whose runs are called after the key of their numbers and found again.
check_plain_study() {
  cat >scene_study.yaml <<'STUDY'
scene: scene.yaml
vary: {time.cfl: [0.2, 0.4], method.update: [flip]}
quantities: {fall: -block.vy, least: {quantity: block.vy, over: min}}
STUDY
  run 0 study scene_study.yaml --out study
  says out '| time.cfl | method.update | fall (m/s) | least (m/s) | reached (µs) |'
  says err '[2/2] cfl=0.4, flip'
  [[ -f study/cfl=0.2_flip/run.json && ! -e study/study.gp ]] || fail 'a plain study has other folders, or a chart of cost'
  [[ $(head -n 1 study/study.csv) == *,reason,fall,least ]] || fail 'study.csv does not end with the quantities'
  run 0 study scene_study.yaml --out study
  says out 'runs             0 now, 2 kept'
  rm -rf study
}

# The second of two variants takes for ever and is stopped; what had finished is kept.
check_stopped_study() {
  local process code
  cat >scene_study.yaml <<'STUDY'
scene: scene.yaml
variants:
  - {name: quick}
  - {name: endless, set: {time.end: 1 s, "bodies.0.velocity": [0, 0]}}
error: {quantity: block.vy, compare: final, expected: -1}
STUDY
  for _ in 1 2; do
    "$program" study scene_study.yaml --out study >out 2>err &
    process=$!
    for _ in $(seq 100); do
      [[ -f study/endless/history.csv ]] && grep -q '2/2' err && break
      sleep 0.1
    done
    sleep 0.3
    kill -s INT "$process"
    wait "$process"
    code=$?
    checks=$((checks + 1))
    [[ $code == 130 && $(wc -l <study/study.csv) == 2 ]] || fail "a stopped study: exit $code"
  done
  says err '    kept: finished'
  says err '(again: it was stopped before)'
  rm -rf study
}

# Another build of the program that a signal stopped leaves a stopped study, as our own does.
check_stopped_program() {
  printf '#!/bin/sh\nexit 129\n' >stopped_program
  chmod +x stopped_program
  cat >scene_study.yaml <<'STUDY'
scene: scene.yaml
variants: [{name: other, program: stopped_program}, {name: ours}]
error: {quantity: block.vy, compare: final, expected: -1}
STUDY
  run 143 study scene_study.yaml --out study
  says err '    stopped'
  rm -rf study stopped_program
}

# Where nothing can be compared there is no chart, and gnuplot is not asked for one.
check_study_without_error() {
  cat >scene_study.yaml <<'STUDY'
scene: scene.yaml
variants: [{name: slow}]
error: {quantity: block.vy, compare: crossing, above: 5, expected: 1}
STUDY
  run 0 study scene_study.yaml --out study
  says err 'mpmfast: no chart of the error against wall_s: no variant has an error'
  grep -q gnuplot err && fail 'gnuplot was asked for a chart of nothing'
  rm -rf study
}

# Without gnuplot the numbers are there, and a message says why no chart is.
check_study_without_gnuplot() {
  write_good_study
  mkdir empty
  PATH=$PWD/empty run 0 study scene_study.yaml --out study
  says err 'no picture of study/study.gp: gnuplot is not installed'
  [[ $(wc -l <study/study.csv) == 5 && -s study/study.md ]] || fail 'a study without gnuplot leaves no table'
  rm -rf study empty
}

check_wrong_study() {
  write_good_study
  sed -i -e 's/compare: final/comprae: final/' -e 's/\[flip, pic\]/[flip, pik]/' scene_study.yaml
  run 2 study scene_study.yaml
  reports scene_study.yaml 6 error.comprae "unknown key. Did you mean 'compare'?"
  wrote_nothing 'a study with a wrong key'
  write_good_study
  sed -i -e 's/\[flip, pic\]/[flip, pik]/' -e 's/block.vy/blok.vy/' scene_study.yaml
  run 2 study scene_study.yaml
  reports scene_study.yaml 5 vary.method.update.1 "the scene says: method.update: "
  reports scene_study.yaml 6 error.quantity "no column of the history 'blok.vy'. Did you mean 'block.vy'?"
  wrote_nothing 'a study that the scene refuses'
  write_good_study
  mkdir other && touch other/precious
  run 2 study scene_study.yaml --out other
  says err 'the output folder other holds something else than a study'
  [[ $(ls other) == precious ]] || fail 'a refused study wrote into the folder'
  rm -rf other
  mkdir other && echo '# my own study' >other/study.yaml
  run 2 study scene_study.yaml --out other
  says err 'other/study.yaml is another study, none of whose runs is one of this (--force replaces it'
  [[ $(ls other) == study.yaml && $(<other/study.yaml) == '# my own study' ]] || fail 'a study replaced another unasked'
  run 0 study scene_study.yaml --out other --force
  cmp -s scene_study.yaml other/study.yaml || fail 'study --force did not replace another study'
  rm -rf other
  run 4 study scene_nowhere.yaml
}

# A study comes with its scene, whose name follows its own; neither replaces a file unasked.
check_new_study() {
  local starters=$source_dir/configs/starters
  run 0 new study --like study
  says out 'mpmfast study study.yaml'
  says out 'mpmfast check study_scene.yaml'
  sed 's|\.\./impact\.yaml|study_scene.yaml|' "$starters/study/study.yaml" | cmp -s study.yaml ||
    fail 'new --like study writes another study'
  cmp -s study_scene.yaml "$starters/impact.yaml" || fail 'new --like study writes another scene'
  rm study.yaml
  run 2 new study --like study
  says err 'study_scene.yaml exists (--force replaces it)'
  [[ ! -e study.yaml ]] || fail 'a refused new wrote a study'
  mkdir sub
  run 0 new 'sub/#one"' --like study
  run 0 check 'sub/#one"_scene.yaml'
  sed -i 's/end: 300 us/end: 30 us/' 'sub/#one"_scene.yaml'
  sed -i 's/^  grid.cell: .*/  grid.cell: [1 mm]/; s/0.125 mm/0.5 mm/' 'sub/#one".yaml'
  run 0 study 'sub/#one".yaml' --out sub/out --progress none
  says out '| variant | grid.cell | error (%) | value (m/s) | energy left in % | reached (µs) | wall time (s) |'
  [[ $(grep -c finished sub/out/study.csv) == 4 ]] || fail 'the study that new writes does not run'
  [[ -s sub/out/study.gp && -s sub/out/energy.gp ]] || fail 'the study that new writes draws no charts'
  run 0 new 'sub/a${x}$b' --like study
  sed -i 's/^  grid.cell: .*/  grid.cell: [1 mm]/; s/0.125 mm/0.5 mm/' 'sub/a${x}$b.yaml'
  sed -i 's/end: 300 us/end: 3 us/' 'sub/a${x}$b_scene.yaml'
  run 0 study 'sub/a${x}$b.yaml' --out sub/dollars --progress none
  rm -rf study.yaml study_scene.yaml sub
}

# Every starter is written as it is, runs for a few steps and gives no warning.
check_new() {
  local kind
  for kind in impact press sphere3d axisymmetric soil; do
    run 0 new "scenes_$kind" --like "$kind"
    cmp -s "scenes_$kind.yaml" "$source_dir/configs/starters/$kind.yaml" || fail "new --like $kind writes another text"
    run 0 check "scenes_$kind.yaml"
    grep -q warning err && fail "a starter gives warnings"
    run 0 run "scenes_$kind.yaml" --steps 3 --progress none
  done
  check_new_study
  run 0 new plain
  says out 'mpmfast run plain.yaml'
  cmp -s plain.yaml "$source_dir/configs/starters/impact.yaml" || fail 'the first starter is not the default'
  echo precious >plain.yaml
  run 2 new plain.yaml
  says err 'plain.yaml exists (--force replaces it)'
  [[ $(cat plain.yaml) == precious ]] || fail 'a refused new wrote into the file'
  run 0 new plain.yaml --force
  cmp -s plain.yaml "$source_dir/configs/starters/impact.yaml" || fail 'new --force does not replace'
  for kind in '' . .. 'a b' '-x' 'a/' $'a\tb' $'a\xffb' $'\xc3'; do
    run 2 new -- "$kind"
  done
  run 2 new other --like impcat
  says err "one of impact, press, sphere3d, axisymmetric, soil, study), got 'impcat'. Did you mean 'impact'?"
  run 2 new
  says err 'NAME is required'
  run 4 new nowhere/scene
  [[ ! -e other.yaml && ! -e nowhere ]] || fail 'a refused new wrote something'
  rm -rf plain.yaml scenes_*.yaml runs
}

# What is likely a mistake is told once, and the scene runs all the same.
check_warnings() {
  local command
  for command in check 'run --steps 2 --progress none --out suspicious'; do
    # shellcheck disable=SC2086
    run 0 $command scene.yaml --set contact.friction=30
    says err '--set contact.friction=30: warning: contact.friction: 30 is a lot of friction'
    [[ $(grep -c warning: err) == 1 ]] || fail 'a warning is not told once'
  done
  run 0 resume suspicious --until 2us --progress none
  grep -q '"--set contact.friction=30: warning: contact.friction: 30 is a lot' suspicious/run.json ||
    fail 'run.json of a run that went on lost a warning of the scene'
  grep -q '^--set contact.friction=30: warning: ' suspicious/run.log || fail 'run.log lacks a warning of the scene'
  run 0 run scene.yaml --steps 2 --progress none --out suspicious --force \
    --set bodies='[{name: block, material: steel, box: {from: [1mm, 1mm], to: [4mm, 3mm]}},
    {name: floor, material: steel, box: {from: [2mm, 2mm], to: [7mm, 5mm]}}]'
  says err 'mpmfast: warning: bodies overlap before anything moves: '
  says err "particles lie inside another body, '"
  grep -q '"bodies overlap before' suspicious/run.json || fail 'run.json does not say that bodies overlap'
  rm -rf suspicious
}

# Several runs, one picture, and what does not go together.
check_plot_of_several() {
  local format
  run 0 run scene.yaml --steps 4 --out other/plotted --progress none
  run 2 plot plotted other/plotted
  says err 'several runs in one chart: --columns says what of each is drawn'
  run 2 plot plotted other/plotted --field speed
  says err '--field, --frame and --range draw the particles of one run'
  run 2 plot plotted other/plotted --columns blok.vy --columns kinetic_j
  [[ $(grep -c . err) == 2 ]] || fail 'a wrong column is told once a run'
  says err "no column 'kinetic_j' in plotted, got 'kinetic_j'. Did you mean 'kinetic_J'?"
  run 2 plot plotted --title energy
  says err '--title is that of the chart of --columns, which is missing'
  run 2 plot plotted --y-label energy
  says err '--y-label is that of the chart of --columns, which is missing'
  run 2 plot plotted other/plotted --columns block.vy --label one
  says err '--label: one for each of the 2 runs, got 1'
  run 2 plot plotted --field speed --x block.vy
  says err '--x is for charts of the history'
  run 2 plot plotted --out figure.svg
  says err "--out: one file holds one picture (--columns, or one --field), got 'figure.svg'"
  run 2 plot plotted --columns block.vy --out figure.jpg
  says err "--out: a picture is drawn as svg, png or pdf, got 'figure.jpg'"
  run 2 plot plotted --field speed --out figure.jpg
  says err "--out: a picture is drawn as svg, png or pdf, got 'figure.jpg'"
  [[ ! -e figure.svg && ! -e figure.jpg ]] || fail 'a refused plot drew something'
  run 2 plot plotted --columns blok.vy --out newdir
  run 2 plot plotted --field speed --frame 99 --out newdir
  run 2 plot plotted --field speed --range 5:1 --out newdir
  run 2 plot plotted --field speed --field body --range 0:1 --out newdir
  [[ ! -e newdir ]] || fail 'a refused plot made its folder'
  run 0 plot plotted --field stress_yy --frame last --range '1:3 MPa' --out bare.png
  run 0 plot plotted --field stress_yy --frame last --range '1 MPa:3 MPa' --out units.png
  run 0 plot plotted --field stress_yy --frame last --range '1 Pa:3 MPa' --out pascal.png
  cmp -s bare.png units.png || fail 'the bare end of a range does not have the unit of the other'
  cmp -s bare.png pascal.png && fail 'the bare end of a range is Pa'
  rm bare.png units.png pascal.png
  run 0 plot plotted --field speed --frame last --out pictures/speed.png
  [[ $(head -c 4 pictures/speed.png) == $'\x89PNG' ]] || fail '--out FILE is no picture of the particles'
  for format in pdf svg; do
    run 0 plot plotted --field speed --frame last --out "pictures/last.$format"
    run 0 plot plotted --field speed --out "pictures/speed.$format"
    cmp -s pictures/{last,speed}.$format || fail "--out FILE.$format is not the last frame, or not twice the same"
    run 0 plot plotted --field speed --frame first --out "pictures/first.$format"
    cmp -s pictures/{last,first}.$format && fail "--out FILE.$format is of any frame the same"
  done
  [[ $(head -c 4 pictures/speed.pdf) == %PDF ]] || fail '--out FILE.pdf of the particles is no PDF'
  grep -q '>speed at [^<]*</text>' pictures/speed.svg || fail 'an SVG of the particles has no text'
  run 4 plot plotted --field speed --out /dev/null/speed.pdf
  if command -v gnuplot >/dev/null; then
    echo precious >figure.gp
    run 0 plot plotted other/plotted --columns kinetic_J --title 'Energy left' --out figure.svg
    for words in 'Energy left' '>plotted<' '>other/plotted<' 'time (ns)' 'kinetic (mJ/m)'; do
      grep -qF "$words" figure.svg || fail "the chart of two runs lacks '$words'"
    done
    run 0 run scene.yaml --set 'thickness=2 mm' --steps 4 --out thin --progress none
    run 0 plot plotted thin --columns kinetic_J --out figure.svg
    grep -q '>kinetic<' figure.svg || fail 'the chart of runs of different thickness names no axis, or a unit'
    run 0 plot plotted other/plotted --columns block.vy --columns kinetic_J --label coarse --label fine \
      --x-label 'since the start' --y-label 'what is left' --out figure.svg
    for words in 'coarse: block.vy' 'fine: kinetic_J' 'since the start (ns)' 'what is left'; do
      grep -qF "$words" figure.svg || fail "the chart of two runs with names lacks '$words'"
    done
    [[ $(cat figure.gp) == precious && ! -e figure.png ]] || fail '--out FILE writes more than it should'
    run 0 plot plotted --columns kinetic_J --out pictures/figure.pdf
    [[ $(head -c 4 pictures/figure.pdf) == %PDF ]] || fail '--out FILE.pdf is no PDF'
    run 0 plot plotted --columns kinetic_J --out pictures
    [[ -s pictures/plot_columns.svg ]] || fail '--out DIR holds no chart'
  fi
  mkdir study && echo variant >study/study.csv && cp -r plotted study/flip
  run 4 plot study
  says err 'study is the folder of a study: its charts are there already (.svg, .png). Plot its runs: study/flip'
  rm -rf other thin pictures figure.* study
}

check_plot() {
  local chart
  run 0 run scene.yaml --steps 4 --out plotted --progress none
  run 2 plot plotted --columns blok.vy
  says err "no column 'blok.vy', got 'blok.vy'. Did you mean 'block.vy'?"
  run 4 plot nowhere
  says err 'nowhere: no such folder'
  check_plot_of_several
  if command -v gnuplot >/dev/null; then
    run 0 plot plotted
    run 0 plot plotted --columns block.vy --columns='-block.vy * 2'
    for chart in energy momentum stress columns; do
      [[ $(head -c 4 "plotted/plot_$chart.png") == $'\x89PNG' ]] || fail "plot_$chart.png is no picture"
      grep -q '</svg>' "plotted/plot_$chart.svg" || fail "plot_$chart.svg is not whole"
    done
  else
    run 4 plot plotted
    says err 'gnuplot is not installed'
  fi
  rm -rf plotted
}

# Where no font is installed Cairo's own has no µ, and letters show that stand for it.
check_without_fonts() {
  local title
  echo '<fontconfig></fontconfig>' >no_fonts.conf
  for title in 'down 3 µm, 5 cm² at 2°' 'down 3 um, 5 cm^2 at 2deg' 'down 3 ?m, 5 cm? at 2?'; do
    run 0 run scene.yaml --set title="$title" --steps 2 --out plain --force --progress none
    FONTCONFIG_FILE=$PWD/no_fonts.conf run 0 plot plain --field speed --frame last --out "${title%%,*}.png"
  done
  cmp -s 'down 3 µm.png' 'down 3 um.png' || fail 'without fonts µ, ² and ° are not drawn as u, ^2 and deg'
  cmp -s 'down 3 ?m.png' 'down 3 um.png' && fail 'without fonts no title is drawn'
  rm -rf plain down*.png no_fonts.conf
}

# What the page shows is the business of browse_report.py.
check_report() {
  run 0 run scene.yaml --steps 4 --out reported --progress none
  says out 'report           mpmfast report reported'
  run 0 report reported
  says out 'report           reported/report.html ('
  grep -q '^</html>$' reported/report.html || fail 'report.html is not whole'
  run 0 report reported --out elsewhere.html
  [[ -s elsewhere.html ]] || fail 'report --out wrote nothing'
  echo precious >elsewhere.html
  run 2 report reported --out elsewhere.html
  says err 'elsewhere.html exists (--force replaces it)'
  [[ $(<elsewhere.html) == precious ]] || fail 'a refused report wrote into the file'
  run 0 report reported --out elsewhere.html --force
  grep -q '^</html>$' elsewhere.html || fail 'report --force did not replace the file'
  run 0 report reported
  run 4 report nowhere
  says err 'nowhere: no such folder (the output folder of a run was expected)'
  mkdir empty
  run 4 report empty
  says err 'empty is not the output folder of a run: it holds no scene.yaml'
  cp reported/scene.yaml empty/
  run 4 report empty
  says err 'it holds no history.csv'
  [[ $(ls empty) == scene.yaml ]] || fail 'a refused report wrote into the folder'
  run 4 report reported --out /dev/null/page.html
  printf 'cut' >reported/particles/000000.vtu
  run 0 report reported
  says err 'A frame is left out: cannot read reported/particles/000000.vtu'
  rm reported/particles.pvd
  run 0 report reported
  says err 'There are no particle files'
  printf '{"status":' >reported/run.json
  run 4 report reported
  says err 'reported/run.json is no run.json of a run'
  run 2 report
  says err 'DIR is required'
  rm -rf reported empty elsewhere.html
}

# Threads that are to be bound are each to a processor of their own.
check_bound_threads() {
  (($(nproc) > 1)) || return 0
  local bound=0 pid
  OMP_PROC_BIND=true "$program" run "$source_dir/configs/ellipses.yaml" --threads 2 --out bound >out 2>err &
  pid=$!
  while ((bound < 2)) && kill -0 $pid 2>/dev/null; do
    bound=$(grep -h Cpus_allowed_list /proc/$pid/task/*/status 2>/dev/null | sort -u | wc -l)
    sleep 0.05
  done
  kill -TERM $pid 2>/dev/null
  wait $pid
  checks=$((checks + 1))
  ((bound > 1)) || fail 'all threads are bound to one processor'
  rm -rf bound
}

check_broken_scenes
check_unreadable_scenes
write_good_scene
check_bound_threads
check_words
check_lists
check_schema
check_overrides
check_output_folder
check_force
check_failed_run
check_failed_run_says_why
check_streams
check_special_files
check_quoting
check_told_memory
check_study
check_plain_study
check_stopped_study
check_stopped_program
check_study_without_error
check_study_without_gnuplot
check_wrong_study
check_new
check_warnings
check_plot
check_without_fonts
check_report
printf '%d checks, %d failures\n' "$checks" "$failures"
[[ $failures == 0 ]]
