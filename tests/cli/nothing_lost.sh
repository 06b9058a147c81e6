#!/usr/bin/env bash
# Checks that nothing is lost, and nothing is written where it should not be, when the world is against a run: folders that
# cannot be written, a disk that is really full, writes that are slow, short and interrupted, two interrupts, names that look
# like paths. What this machine cannot do (mount, preload) is left out, and said.
# usage: nothing_lost.sh MPMFAST SOURCE_DIR
source "$(dirname "$0")/helpers.sh"

# left_only WORDS…: nothing but these, the streams and scene*.yaml lies in the work folder.
left_only() {
  checks=$((checks + 1))
  local name extra=''
  for name in * .[!.]*; do
    [[ -e $name ]] || continue
    [[ " out err $* " == *" $name "* || $name == scene*.yaml ]] || extra+=" $name"
  done
  [[ -z $extra ]] || fail "left behind:$extra"
}

# The checksum that a run of the good scene ends with.
checksum() { grep '"checksum"' "$1/run.json"; }

# None of these can be written, by root neither.
check_unwritable_folders() {
  echo precious >file
  run 4 run scene.yaml --out file/below --progress none
  says err 'cannot make the folder file/below: Not a directory'
  run 2 run scene.yaml --out file --progress none
  [[ $(cat file) == precious ]] || fail 'a file in the place of the output folder was touched'
  for folder in /proc/mpmfast_output /sys/mpmfast_output; do
    [[ -d ${folder%/*} ]] || continue
    run 4 run scene.yaml --out "$folder" --progress none
    says err "cannot make the folder $folder: "
    run 4 study "$PWD/scene_study.yaml" --out "$folder"
  done
  if [[ $(id -u) != 0 ]]; then
    mkdir locked && chmod 555 locked
    run 4 run scene.yaml --out locked/run --progress none
    says err 'cannot make the folder locked/run: Permission denied'
    rmdir locked
  fi
  left_only file
  rm file
}

# in_namespace COMMAND…: with mounts of its own, which end with it.
in_namespace() {
  if [[ $(id -u) == 0 ]]; then unshare -m "$@"; else unshare -rm "$@"; fi
}

# A file system of 400 KiB: the kernel itself says that it is full; a folder that is mounted read-only.
check_mounts() {
  if ! in_namespace mount -t tmpfs -o size=64k none /mnt 2>/dev/null; then
    echo 'left out: a full disk and a read-only mount (no mounts here)'
    return
  fi
  checks=$((checks + 4))
  in_namespace env PROGRAM="$program" bash -c '
    mkdir disk && mount -t tmpfs -o size=400k none disk || exit 1
    "$PROGRAM" run scene.yaml --out disk/run --progress none --steps 3 >>out 2>&1 || exit 2
    before=$(grep checksum disk/run/run.json)
    "$PROGRAM" run scene.yaml --out disk/large --progress none --set "grid.cell=0.05 mm" >out 2>err
    [[ $? == 4 ]] || exit 3
    grep -q "cannot write disk/large/.*: No space left on device" err || exit 4
    [[ -z $(find disk -name "*.tmp") ]] || exit 5
    head -c 1M /dev/zero >disk/filler 2>/dev/null   # not a byte is left
    "$PROGRAM" resume disk/run --progress none >out 2>err
    [[ $? == 4 ]] || exit 6
    grep -q "No space left on device" err || exit 7
    rm disk/filler && rm -r disk/large
    "$PROGRAM" resume disk/run --progress none >out 2>err || exit 8
    cp -r disk/run finished
    mount -o remount,ro disk || exit 9
    "$PROGRAM" run scene.yaml --out disk/another --progress none >out 2>err
    [[ $? == 4 ]] || exit 10
    grep -q "cannot make the folder disk/another: Read-only file system" err || exit 11
    "$PROGRAM" run scene.yaml --out disk/run --force --progress none >out 2>err
    [[ $? == 4 ]] || exit 12
    cmp disk/run/run.json finished/run.json || exit 13
  ' || fail "a full disk, then a read-only one: stage $?"
  [[ $(checksum finished) == "$(checksum whole)" ]] || fail 'a run resumed after a full disk has another checksum'
  cmp -s whole/history.csv finished/history.csv || fail 'a run resumed after a full disk has another history'
  rmdir disk
  rm -rf finished
}

compile_slow_writes() {
  cc -O1 -shared -fPIC -o slow_writes.so "$source_dir/tests/cli/slow_writes.c" -ldl 2>err &&
    LD_PRELOAD=$PWD/slow_writes.so "$program" --version >out 2>err && [[ ! -s err ]]
}

# slowly MICROSECONDS BYTES WORDS…: the program, whose writes are slow.
slowly() { SLOW_WRITE_US=$1 SLOW_WRITE_BYTES=$2 LD_PRELOAD=$PWD/slow_writes.so exec "$program" "${@:3}"; }

check_slow_writes() {
  checks=$((checks + 3))
  (slowly 100 700 run scene.yaml --out slow --progress none) >out 2>err || fail "slow writes: exit $?"
  [[ $(checksum slow) == "$(checksum whole)" ]] || fail 'slow, short and interrupted writes change the result'
  cmp -s whole/history.csv slow/history.csv || fail 'slow writes change the history'
  diff -r whole/particles slow/particles >/dev/null || fail 'slow writes change the particle files'
  rm -rf slow
}

# While the last checkpoint is written, slowly, a second signal comes: the process ends at once, by the signal, and the
# checkpoint before is whole.
check_two_signals() {
  local signal process code begin
  for signal in INT TERM; do
    (slowly 100000 2000 run scene.yaml --out "twice_$signal" --progress none --set 'time.end=20 ms' --set \
      'bodies.0.velocity=[0, 0]' --set 'output={frames: 0, history: 1, checkpoint: {steps: 40}}') >out 2>err &
    process=$!
    for _ in $(seq 200); do
      [[ -f twice_$signal/checkpoint.h5 ]] && break
      sleep 0.1
    done
    kill -s "$signal" "$process"
    sleep 0.3
    kill -0 "$process" 2>/dev/null || fail "SIG$signal: the run ended before the second"
    begin=$EPOCHREALTIME
    kill -s "$signal" "$process"
    wait "$process"
    code=$?
    checks=$((checks + 3))
    [[ $code == $((128 + $(kill -l "$signal"))) ]] || fail "SIG$signal twice: exit $code"
    ((${EPOCHREALTIME/./} - ${begin/./} < 1000000)) || fail "SIG$signal twice: the run went on"
    [[ ! -e twice_$signal/run.json ]] || fail "SIG$signal twice: the run ended in order"
    run 0 resume "twice_$signal" --progress none --until '0.2 ms'
    run 0 run scene.yaml --out straight --progress none --set 'time.end=20 ms' --set 'bodies.0.velocity=[0, 0]' --set \
      'output={frames: 0, history: 1, checkpoint: {steps: 40}}' --until '0.2 ms'
    [[ $(checksum "twice_$signal") == "$(checksum straight)" ]] ||
      fail "SIG$signal twice: the checkpoint does not lead where the run went"
    [[ -z $(find "twice_$signal" -name '*.tmp') ]] || fail "SIG$signal twice: half a file is left after resume"
    rm -rf "twice_$signal" straight
  done
}

# Names become columns, files and folders: none leads out of the output folder.
check_names_that_are_paths() {
  local name
  mkdir inside
  for name in ../evil /tmp/mpmfast_evil a/b .. . 'a b' '"a\\0b"' '~/evil' "''"; do
    sed "s|name: block|name: $name|" scene.yaml >scene_name.yaml
    run 2 run scene_name.yaml --out inside/run --progress none
    says err 'bodies.0.name: not a name'
    sed "s|name: block|name: block, field: $name|" scene.yaml >scene_field.yaml
    run 2 run scene_field.yaml --out inside/run --progress none
    { cat scene.yaml && printf 'boundaries: {%s: {box: {from: [0, 0], to: [1 mm, 1 mm]}, direction: x, speed: 1}}\n' "$name"; } \
      >scene_boundary.yaml
    run 2 run scene_boundary.yaml --out inside/run --progress none
    run 2 run scene.yaml --out inside/run --progress none --set "output.picture=$name"
  done
  [[ -z $(ls -A inside) && ! -e /tmp/mpmfast_evil ]] || fail 'a refused name left something behind'
  sed -e 's|name: slow|name: "../../evil"|' -e 's|name: fallen|name: /tmp/mpmfast_evil|' scene_study.yaml >scene_paths.yaml
  run 0 study scene_paths.yaml --out inside/study
  says out inside/study
  [[ $(find inside/study -mindepth 1 -maxdepth 1 -type d | wc -l) == 4 ]] || fail 'a study has other folders than its runs'
  [[ $(ls inside) == study && ! -e /tmp/mpmfast_evil ]] || fail 'a study wrote beside its folder'
  sed -i 's|^error:|curves: [{name: ../curve, y: block.vy}]\nerror:|' scene_paths.yaml
  run 2 study scene_paths.yaml --out inside/study2
  says err 'curves.0.name: not a name'
  left_only inside whole slow_writes.so
  rm -rf inside
}

write_good_scene
cat >scene_study.yaml <<'STUDY'
scene: scene.yaml
variants: [{name: slow}, {name: fallen, set: {"bodies.0.velocity": [0, -2]}}]
vary: {method.update: [flip, pic]}
error: {quantity: block.vy, compare: final, expected: -1}
STUDY
check_unwritable_folders
run 0 run scene.yaml --out whole --progress none
check_mounts
check_names_that_are_paths
if compile_slow_writes; then
  check_slow_writes
  check_two_signals
else
  echo 'left out: slow writes and two signals (no compiler, or nothing can be preloaded)'
fi
printf '%d checks, %d failures\n' "$checks" "$failures"
[[ $failures == 0 ]]
