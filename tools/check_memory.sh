#!/usr/bin/env bash
# Holds samples of processes' memory to what it must be: the last third of the time must not lie above the second; the
# first is for filling pools and caches.
#   tools/check_memory.sh SAMPLES SECONDS    a sample is a line: second, name, process, resident KiB
# A line a process; closes with a line `N passed, N failed`.
set -euo pipefail
samples=${1:?check_memory.sh SAMPLES SECONDS} length_s=${2:?check_memory.sh SAMPLES SECONDS}
passed=0 failed=0
while read -r name pid second third; do
  said="$name $pid: resident $((second / 1024)) MiB at most in the second third, $((third / 1024)) MiB in the last"
  if [ "$third" -le $((second + second / 50 + 1024)) ]; then
    passed=$((passed + 1))
    echo "ok   $said"
  else
    failed=$((failed + 1))
    echo "FAIL $said"
  fi
done < <(awk -v length_s="$length_s" '
  { third = int(3 * $1 / length_s); key = $2 " " $3; if ($4 > most[key, third]) most[key, third] = $4; seen[key] = 1 }
  END { for (key in seen) if (most[key, 1] && most[key, 2]) print key, most[key, 1], most[key, 2] }' "$samples" | sort)
echo "$passed passed, $failed failed"
[ $failed -eq 0 ] && [ $passed -gt 0 ]
