#!/usr/bin/env bash
# What ./run and ./test make of their words, in a copy of them that installs, builds and plays nothing.
#   tests/start/check_start.sh SOURCES
set -euo pipefail
sources=$(realpath "$1")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
copy="$work/a copy"
mkdir -p "$copy/tools" "$copy/build/release/bin" "$work/here"
cp "$sources/run" "$sources/test" "$copy"
for stub in tools/install_packages.sh tools/build.sh build/release/bin/vantage; do
  cat >"$copy/$stub" <<'END'
#!/bin/sh
case $0 in */vantage) printf '<%s>' "$@" ;; esac
END
  chmod +x "$copy/$stub"
done
cd "$work/here"

status=0
check() { # what expected actual
  [ "$2" = "$3" ] || { printf 'FAILED  %s:\n  expected %s\n  and had  %s\n' "$1" "$2" "$3"; status=1; }
}
refusal() { # program words...: what it says and its status
  local said code=0
  said=$("../a copy/$1" "${@:2}" 2>&1) || code=$?
  echo "$said; $code"
}

for option in seconds disparities rate; do
  check "--$option without a number" "run: --$option needs a number; 2" "$(refusal run --"$option")"
done
check "an option that is none" "run: '--secnds' is not an option; ./run --help lists them; 2" "$(refusal run --secnds 3)"
for option in label preset; do
  check "--$option without a name" "test: --$option needs a name; 2" "$(refusal test --"$option")"
done
check "a number" "<demo><--folder><out><--seconds><3>" "$("../a copy/run" --seconds 3)"
here=$(pwd -P)
check "--files from another folder" "<demo><--folder><out><--files><$here/l.png><$here/in/r.png>" \
  "$("../a copy/run" --files l.png in/r.png)"
check "--rig from another folder" "<demo><--folder><out><--rig><$here/c.yaml><$here/l.mkv><->" \
  "$("../a copy/run" --rig c.yaml l.mkv -)"
check "--help from another folder" "Installs what is missing, builds what is missing, and plays the demo stage." \
  "$("../a copy/run" --help | head -n 1)"
[ $status -ne 0 ] || echo "all is as it should be"
exit $status
