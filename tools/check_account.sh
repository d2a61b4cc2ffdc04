#!/usr/bin/env bash
# Holds the report of `vantage live --json` to account: what came in at each place on a frame's way is what went out or was
# counted as left out; two frames a rig may be on their way, and as many were lost with a daemon that was killed.
#   tools/check_account.sh REPORT.json
# A line a rig and place; closes with a line `N passed, N failed`.
set -euo pipefail
report=${1:?check_account.sh REPORT.json}
passed=0 failed=0
account() { # place, jq expression: in minus everything counted
  local line
  while read -r line; do
    local rig difference most
    read -r rig difference most <<<"$line"
    if [ "$difference" -ge 0 ] && [ "$difference" -le "$most" ]; then
      passed=$((passed + 1))
      echo "ok   $rig: $difference frames on their way $1"
    else
      failed=$((failed + 1))
      echo "FAIL $rig: $difference frames on their way $1"
    fi
  done < <(jq -r ".rigs[] | \"\(.name) \($2) \(2 + 2 * .outages.restarts)\"" "$report")
}
account "inside the rig" '.rig | .captured - .published - .late'
account "on the link" '.link | .offered - .sent - .send_dropped - .skipped'
account "from link to host" '.link.sent - .link.lost - .host.received'
account "inside the host" '.host | .received - .undecodable - .queue_dropped - .late - .duplicate - .unsynchronized - .out_of_step - .in_frame_sets'
account "from set to picture" '.host | .in_frame_sets - .fused - .replaced - .dropped_at_start'
echo "$passed passed, $failed failed"
[ $failed -eq 0 ] && [ $passed -gt 0 ]
