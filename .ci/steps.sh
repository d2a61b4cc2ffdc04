# Sourced by .ci/run and .ci/full: runs steps, counts their tests and closes with what failed and `N passed, N failed`.
set -uo pipefail
started=$SECONDS
passed=0 failed=0
failures=$(mktemp)
logs=$(mktemp -d)
background=()
finish() {
  [ ${#background[@]} -eq 0 ] || kill -- "${background[@]/#/-}" 2>/dev/null
  rm -rf "$failures" "$logs"
}
trap finish EXIT
trap 'exit 130' INT TERM

# Prints the failures of a step: the output of its failed tests, or its last lines where it ran none.
print_failures() { # name log
  local details
  details=$(awk -f tools/failed_tests.awk "$2")
  printf -- '--- failed: %s\n%s\n' "$1" "${details:-$(tail -n 40 "$2")}"
}

step() { # name command...
  local name=$1 log line status p f
  shift
  log=$(mktemp)
  echo "=== $name ($((SECONDS - started)) s)"
  "$@" 2>&1 | tee "$log"
  status=${PIPESTATUS[0]}
  line=$(grep -E '^[0-9]+ passed, [0-9]+ failed' "$log" | tail -1)
  [ "$status" -eq 0 ] || print_failures "$name" "$log" >>"$failures"
  rm -f "$log"
  p=0 f=0
  if [ -n "$line" ]; then
    read -r p _ f _ <<<"$line"
  elif [ "$status" -eq 0 ]; then
    p=1
  fi
  [ "$status" -eq 0 ] || [ "$f" -gt 0 ] || f=1
  passed=$((passed + p)) failed=$((failed + f))
}

# Runs a function in a process group of its own, which ends with this script. Its output goes to $logs/FUNCTION.
in_background() { # function
  set -m
  "$1" >"$logs/$1" 2>&1 &
  background+=($!)
  set +m
}

# Runs a command for a background function: its output and exit status are kept for `recorded`.
record() { # name command...
  local name=$1
  shift
  "$@" >"$logs/$name" 2>&1
  echo $? >"$logs/$name.status"
}
recorded() { # name
  cat "$logs/$1"
  return "$(cat "$logs/$1.status" 2>/dev/null || echo 1)"
}

close_with_counts() {
  echo "=== done ($((SECONDS - started)) s)"
  cat "$failures"
  echo "$passed passed, $failed failed"
  [ "$failed" -eq 0 ] && [ "$passed" -gt 0 ]
}
