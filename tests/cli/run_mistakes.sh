#!/usr/bin/env bash
# The mistakes that people make, and all that the program says of each: the whole text, as a newcomer reads it.
# usage: run_mistakes.sh MPMFAST SOURCE_DIR [--print]      --print shows the table with what the program says now
#
# mistakes/table.txt holds, for each, what is changed in mistakes/scene.yaml:
#   * what was done wrong
#   - text of the scene       + what stands there instead (\n and \t as in printf)
#   ! a shell command before  $ the command line, if it is not `check scene.yaml`
#   = the exit code, if it is not 2
#   > a line that the program says
source "$(dirname "$0")/helpers.sh"
print=${3:-}
mistakes=$source_dir/tests/cli/mistakes
good=$(cat "$mistakes/scene.yaml")

reset() {
  name='' from='' command='check scene.yaml' code=2 expected='' edits=''
  text=$good
  find . -mindepth 1 -delete
}

# Puts the text that was read last with '-' aside for the one read with '+'.
replace() {
  local to
  printf -v to '%b' "$1"
  [[ $text == *"$from"* ]] || fail "$name: the scene does not hold '$from'"
  text=${text/"$from"/"$to"}
}

judge() {
  [[ -n $name ]] || return
  printf '%s\n' "$text" >scene.yaml
  [[ -z $prepare ]] || eval "$prepare"
  local got
  eval "set -- $command"
  run "$code" "$@"
  got=$(grep -vE '^[0-9]+ errors?$|^Try ' err)
  got=${got//$source_dir/SOURCE}
  got=${got//$work/WORK}
  checks=$((checks + 1))
  if [[ $print == --print ]]; then
    printf '* %s\n%s' "$name" "$edits"
    [[ $code == 2 ]] || printf '= %s\n' "$code"
    sed 's/^/> /' <<<"$got"
    printf '\n'
  elif [[ $got != "${expected%$'\n'}" ]]; then
    fail "$name: expected
${expected%$'\n'}
got
$got"
  fi
}

reset
prepare=''
while IFS= read -r line || [[ -n $line ]]; do
  rest=${line:2}
  [[ ${line:0:2} == '= ' || ${line:0:2} == '> ' || ${line:0:2} == '* ' || -z $line ]] || edits+="$line"$'\n'
  case ${line:0:2} in
    '* ')
      judge
      reset
      prepare=''
      edits=''
      name=$rest
      ;;
    '- ') from=$rest ;;
    '+ ' | '+') replace "$rest" ;;
    '! ') prepare=$rest ;;
    '$ ') command=$rest ;;
    '= ') code=$rest ;;
    '> ') expected+="$rest"$'\n' ;;
    '' | '# ') ;;
    *) fail "table.txt: '$line'" ;;
  esac
done <"$mistakes/table.txt"
judge
[[ $print == --print ]] || printf '%d checks, %d failures\n' "$checks" "$failures"
[[ $failures == 0 ]]
