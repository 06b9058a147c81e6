#!/usr/bin/env bash
# Files, names and limits that nobody means well with: they are refused at once, and printed as text.
# usage: run_hostile.sh MPMFAST SOURCE_DIR [CHECK]
source "$(dirname "$0")/helpers.sh"

# ends CODE COMMAND…: the program ends, with this exit code; a minute is for ever.
ends() {
  local code=$1 found
  shift
  checks=$((checks + 1))
  timeout 60 "$program" "$@" >out 2>err
  found=$?
  [[ $found == "$code" ]] || fail "mpmfast $*: exit $found in place of $code: $(head -c 300 err)"
}

# What may never end is no scene, no study and no picture.
check_endless_files() {
  local file
  mkfifo scene_pipe.yaml
  ln -s /dev/zero scene_link.yaml
  for file in /dev/zero /dev/stdin scene_pipe.yaml scene_link.yaml; do
    ends 4 check "$file"
    says err 'cannot read the scene: it is not a file but a device, a pipe or a socket'
    ends 4 run "$file" --out never
    ends 4 study "$file" --out never
    says err 'cannot read the study: it is not a file but a device, a pipe or a socket'
  done </dev/zero
  sed "s|^bodies:|include: $PWD/scene_pipe.yaml\nbodies:|" scene.yaml >scene_include.yaml
  ends 2 check scene_include.yaml
  says err 'it is not a file but a device, a pipe or a socket'
  truncate -s 17M scene_large.yaml
  ends 4 check scene_large.yaml
  says err 'cannot read the scene: it is larger than 16 MiB'
  ends 4 study scene_large.yaml
  says err 'cannot read the study: it is larger than 16 MiB'
  ends 4 study .
  says err 'cannot read the study: it is a folder'
  [[ ! -e never ]] || fail 'a run of what is no scene made a folder'
  rm -f scene_pipe.yaml scene_link.yaml scene_include.yaml scene_large.yaml
}

# A file that the system cannot read is no output that could not be written.
check_read_errors() {
  local file
  ends 4 check /proc/self/mem
  says err 'cannot read the scene: Input/output error'
  ends 4 study /proc/self/mem
  says err 'cannot read the study: Input/output error'
  sed "s|^bodies:|include: /proc/self/mem\nbodies:|" scene.yaml >scene_include.yaml
  ends 2 check scene_include.yaml
  says err 'cannot include /proc/self/mem: Input/output error'
  run 0 run scene.yaml --steps 2 --out ours --progress none
  for file in run.json history.csv scene.yaml checkpoint.h5; do
    cp -r ours theirs
    ln -sf /proc/self/mem "theirs/$file"
    timeout 60 "$program" report theirs >out 2>err
    timeout 60 "$program" plot theirs >>out 2>>err
    timeout 60 "$program" resume theirs --until '2 us' --progress none >>out 2>>err
    checks=$((checks + 1))
    ! grep -q 'could not be written\|internal error' err || fail "an unreadable $file: $(<err)"
    rm -rf theirs
  done
  rm -rf ours scene_include.yaml
}

# What stands in the folder of a run in place of its files.
check_endless_output() {
  local file
  run 0 run scene.yaml --steps 2 --out ours --progress none
  for file in scene.yaml run.json history.csv checkpoint.h5 particles/000000.vtu; do
    cp -r ours theirs
    rm "theirs/$file"
    mkfifo "theirs/$file"
    timeout 60 "$program" report theirs >out 2>err
    [[ $? != 124 ]] || fail "report waits for the pipe $file"
    timeout 60 "$program" resume theirs --until '2 us' --progress none >out 2>err
    [[ $? != 124 ]] || fail "resume waits for the pipe $file"
    timeout 60 "$program" run scene.yaml --steps 2 --out theirs --force --progress none >out 2>err
    [[ $? != 124 ]] || fail "run --force waits for the pipe $file"
    checks=$((checks + 3))
    rm -rf theirs
  done
  rm -rf ours
}

# Nested so deeply that whoever writes it by calling itself runs out of stack.
check_deep_json() {
  local open close
  run 0 run scene.yaml --steps 2 --out deep --progress none
  for open in '{"a":' '['; do
    close='}'
    [[ $open == '[' ]] && close=']'
    {
      printf '{"status": "finished", "a": '
      printf "%0100000d" 0 | sed "s|0|$open|g"
      printf 1
      printf "%0100000d" 0 | sed "s|0|$close|g"
      printf '}'
    } >deep/run.json
    ends 4 report deep
    says err 'deep/run.json is no run.json of a run'
  done
  printf '{"status": "finished", "reason": "%s"}' "$(printf '%01000d' 0 | sed 's|0|{[|g')" >deep/run.json
  ends 0 report deep
  rm -rf deep
}

# A picture of a thousand pixels a byte takes no memory before it is refused; the program may have 700 MB here.
check_large_picture() {
  python3 - <<'PYTHON'
import struct, zlib
def chunk(name, data):
    return struct.pack('>I', len(data)) + name + data + struct.pack('>I', zlib.crc32(name + data))
for name, width, height in (('huge', 32768, 32768), ('long', 32768, 4096)):
    packer = zlib.compressobj(9)
    data = b''.join(packer.compress(bytes(width + 1)) for _ in range(height if name == 'long' else 2048))
    open(name + '.png', 'wb').write(b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', struct.pack('>IIBBBBB', width, height, 8, 0, 0, 0, 0))
        + chunk(b'IDAT', data + packer.flush()) + chunk(b'IEND', b''))
PYTHON
  local picture
  for picture in huge long; do
    sed -e '/^bodies:/,/^[a-z]/ { /^ /d }' scene.yaml |
      sed "s|^bodies:.*|bodies: [{bitmap: $picture.png, extent: [3 mm, 3 mm], material: steel}]|" >scene_picture.yaml
    (ulimit -v 700000; ends 2 check scene_picture.yaml)
    says err 'along an edge, 67108864 in all'
  done
  rm -f huge.png long.png scene_picture.yaml
}

# Titles, names of files and values are printed as what they are.
check_escapes() {
  local escape=$'\x1b' stream
  printf 'title: "a\\e]0;owned\\a\\e[31mred\\u202eder \\x9b2J"\n' | cat - scene.yaml >scene_title.yaml
  sed -i '2{/^title/d}' scene_title.yaml
  run 0 check scene_title.yaml
  says out 'a\x1b]0;owned\x07\x1b[31mred\u202eder \x9b2J'
  for stream in out err; do
    ! LC_ALL=C grep -q "[$escape"$'\x07\x9b'"]" "$stream" || fail "check sends commands to the terminal ($stream)"
  done
  run 2 check "scene$escape[31m.yaml"
  says err 'a name holds a control character'
  ! grep -q "$escape" err || fail 'a message about a name sends commands to the terminal'
  run 2 check scene.yaml --set "time.cfl=$escape[5m"
  says err 'time.cfl=\x1b[5m'
  ! grep -q "$escape" err || fail 'a message sends commands to the terminal'
  run 2 run scene.yaml --progress "$escape[31m"
  ! grep -q "$escape" err || fail 'a message about an option sends commands to the terminal'
  run 2 run scene_title.yaml --steps 2 --out "out$escape[31m" --progress none
  says err 'a name holds a control character'
  run 0 run scene_title.yaml --steps 2 --out titled --progress none
  ! grep -q "$escape" out titled/run.log || fail 'a run or its log sends commands to the terminal'
  rm -rf scene_title.yaml titled
}

# offers EXPECTED… -- WORD…: what the shell offers for the last word, a line each.
check_completion() {
  run 0 completion
  mv out completion.bash
  offers() {
    checks=$((checks + 1))
    bash -c 'source "$0"; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _mpmfast; printf "%s\n" "${COMPREPLY[@]}"' \
      ./completion.bash "$@" >out 2>err
  }
  mkdir -p 'two words' 'st*r'
  touch 'a scene.yaml' 'a.yaml'
  offers mpmfast report 'tw'
  [[ $(<out) == 'two words' ]] || fail "a folder with a blank is offered as $(<out)"
  offers mpmfast report 'st'
  [[ $(<out) == 'st*r' ]] || fail "a folder with a star is offered as $(<out)"
  offers mpmfast check 'a'
  [[ $(sort out) == $'a scene.yaml\na.yaml' ]] || fail "scenes with blanks are offered as $(<out)"
  offers mpmfast run a.yaml --out 'two'
  [[ $(<out) == 'two words' ]] || fail "after --out a folder with a blank is offered as $(<out)"
  rm -rf 'two words' 'st*r' 'a scene.yaml' a.yaml completion.bash
}

# Many bodies at one place: check tells so at once, and what would not fit is refused before it is tried.
write_crowd() {
  local k
  cat <<'CROWD'
space: plane_strain
grid: {size: [10 mm, 10 mm], cell: 1 mm}
time: {end: 10 us}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
contact: {law: coulomb, friction: 0.3}
bodies:
CROWD
  for k in $(seq "$1"); do
    echo "  - {name: b$k, box: {from: [2 mm, 2 mm], to: [8 mm, 8 mm]}, material: m}"
  done
}

check_crowd() {
  write_crowd 500 >scene_crowd.yaml
  ends 0 check scene_crowd.yaml
  says out 'overlap         more than 100 pairs of bodies have particles in each other'
  says out 'unknown: up to 500 bodies lie in one cell'
  write_crowd 2000 >scene_crowd.yaml
  (
    ulimit -v 4000000
    ends 2 check scene_crowd.yaml
    grep -q 'bodies: up to 2000 bodies lie in one cell' err && grep -q 'left by the limit on address space' err
  ) || fail "2000 bodies at one place: $(head -c 300 err)"
  rm -f scene_crowd.yaml
}

check_memory_limits() {
  checks=$((checks + 2))
  (
    ulimit -v 1500000
    "$program" check "$source_dir/configs/bench/block-2d.yaml" --set 'grid.cell=1/3000 m' >out 2>err
  )
  [[ $? == 2 ]] || fail "a scene beyond ulimit -v: $(head -c 300 err)"
  says err 'left by the limit on address space, ulimit -v'
}

# A speed beyond all numbers ends with what it did, not with a step of -nan.
check_speeds() {
  local speed collapse
  for speed in 1e30 1e155 1e200 1e300; do
    for collapse in 0 0.001; do
      timeout 60 "$program" run scene.yaml --set "bodies.0.velocity=[$speed, 0]" --set "time.collapse=$collapse" \
        --out fast --force --progress none >out 2>err
      checks=$((checks + 1))
      [[ $? != 124 ]] || fail "a speed of $speed never ends"
      ! grep -qi 'step collapsed to -\?nan\|nan of the first\| 1 of the first\|()' err || fail "a speed of $speed: $(grep -i 'nan\|()' err)"
    done
  done
  rm -rf fast
}

write_good_scene
if (($# > 2)); then
  "${@:3}"
  printf '%d checks, %d failures\n' "$checks" "$failures"
  exit "$failures"
fi
check_endless_files
check_read_errors
check_endless_output
check_deep_json
check_large_picture
check_escapes
check_completion
check_crowd
check_memory_limits
check_speeds
printf '%d checks, %d failures\n' "$checks" "$failures"
[[ $failures == 0 ]]
