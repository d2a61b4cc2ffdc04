#!/usr/bin/env bash
# Runs the fenced commands of documents, in their order, a document in a folder of its own, and fails on any that fails.
#   tests/documents/run_documents.sh PLACE EXCEPTIONS MATERIAL DOCUMENT...
# A fence without a word, or with `sh`, holds commands for PLACE `here`; with `sh rig` or `sh host` for PLACE `machine`,
# where the packages are installed and one computer is both. PLACE `nowhere` runs none. A fence with `toml rig FILE` or
# `toml host FILE` is what FILE has to hold there. `text`, `toml` and `ini` alone are only read. Any other word is refused.
# EXCEPTIONS lists the commands that are not simply run, a line each:  DOCUMENT | COMMAND | HOW | REASON
#   COMMAND is how the command begins;  HOW is `never`: not run;  `misses`: run, and it ends with status 1, since a file
#   or a device is missing that REASON names: its words fit all the same (they would end with 2).
# One that no command of a given document begins with is refused, and so is a `misses` whose command succeeds.
# The folder begins as a copy of MATERIAL.
set -uo pipefail
place=$1 exceptions=$(realpath "$2") material=$(realpath "$3")
shift 3
failures=0 commands=0
fault() {
  echo "FAILED  $1"
  failures=$((failures + 1))
}

# One line a fence's line: NUMBER <tab> the fence's words <tab> text.
fenced() {
  awk '/^```/ { if (inside) inside = 0; else { inside = 1; words = substr($0, 4); if (words == "") words = "sh" } next }
       inside { print NR "\t" words "\t" $0 }' "$1"
}

declare -A used
how= reason=
look_up() { # document command
  how=run reason=
  local d c h r
  while IFS='|' read -r d c h r; do
    d=${d%% *} c=${c# } c=${c% } h=${h// /}
    [ "$d" = "$1" ] && [[ $2 == "$c"* ]] || continue
    used["$d|$c"]=1 how=$h reason=${r# }
    return
  done < <(grep -vE '^(#|$)' "$exceptions")
}

run_one() { # document line command
  commands=$((commands + 1))
  look_up "$1" "$3"
  local status=0
  case $how in
    run) ;;
    misses) ;;
    never) echo "not run $1:$2: $3 ($reason)"; return ;;
    *) fault "exceptions: '$how' is neither never nor misses"; return ;;
  esac
  (cd "$folder" && timeout 300 bash -euo pipefail -c "$3") >"$work/output" 2>&1 </dev/null || status=$?
  if [ "$how" = misses ]; then
    if [ $status -eq 1 ]; then
      echo "misses  $1:$2: $3 ($reason)"
    elif [ $status -eq 0 ]; then
      fault "$1:$2: $3 succeeds: its exception is not needed any more"
    else
      fault "$1:$2: $3 ended with $status where $reason: $(tail -n 3 "$work/output")"
    fi
  elif [ $status -eq 0 ]; then
    echo "ok      $1:$2: $3"
  else
    fault "$1:$2: $3 ended with $status: $(tail -n 5 "$work/output")"
  fi
}

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for document in "$@"; do
  name=$(basename "$document")
  folder=$work/${name%.md}
  cp -r "$material" "$folder"
  pending= target=
  while IFS=$'\t' read -r line words text; do
    case $place:$words in
      here:sh | machine:'sh rig' | machine:'sh host')
        pending+=$text
        if [[ $pending == *\\ ]]; then
          pending=${pending%\\}
          continue
        fi
        [[ -z ${pending// /} || $pending == '#'* ]] || run_one "$name" "$line" "$pending"
        pending=
        ;;
      machine:'toml rig '* | machine:'toml host '*)
        file=${words#toml * }
        file=${file/#\~/$HOME}
        if [ "$file" != "$target" ]; then
          mkdir -p "$(dirname "$file")"
          : >"$file"
          target=$file
        fi
        echo "$text" >>"$file"
        ;;
      *:sh | *:'sh rig' | *:'sh host' | *:'toml rig '* | *:'toml host '* | *:text | *:toml | *:ini) ;;
      *) fault "$name:$line: a fence says '$words', which is none of the words of tests/documents/run_documents.sh" ;;
    esac
  done < <(fenced "$document")
done
names=" $(for document in "$@"; do basename "$document"; done | tr '\n' ' ')"
while IFS='|' read -r d c h r; do
  d=${d%% *} c=${c# } c=${c% }
  [[ $names == *" $d "* ]] || continue
  [ -n "${used["$d|$c"]:-}" ] || fault "exceptions: no command of $d begins with '$c'"
done < <(grep -vE '^(#|$)' "$exceptions")
echo "$commands commands of $# documents, $failures faults"
[ "$failures" -eq 0 ] && { [ "$commands" -gt 0 ] || [ "$place" = nowhere ]; }
