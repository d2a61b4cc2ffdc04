# Sourced by scripts that check what commands do, one line each. They set checks_log, the file for a command's output.
passed=0 failed=0

# Runs a command; it passes with status 0.
check() { # what command...
  local what=$1
  shift
  if "$@" >"$checks_log" 2>&1; then
    echo "ok    $what ($SECONDS s)"
    passed=$((passed + 1))
  else
    echo "FAIL  $what: $(tail -n 25 "$checks_log")"
    failed=$((failed + 1))
  fi
}
not() { ! "$@"; }

# The last line; its status is that of the script.
close_checks() {
  echo "$passed passed, $failed failed"
  [ "$failed" -eq 0 ]
}
