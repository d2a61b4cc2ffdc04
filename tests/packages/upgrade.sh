#!/usr/bin/env bash
# The packages of an older revision and of this one, in one show that stays on air: a rig is upgraded while the others film,
# a second host of this revision takes over from the older one without a frame that no take has, the other rigs follow, and
# each version reads the files of the other.
#   tests/packages/upgrade.sh [OLD_REVISION]     default: the one before rigs sent frames over SRT
# After `tools/build.sh release`. Everything goes to out/upgrade/ but the older revision's packages, which are made once, in
# build/upgrade/. Closes with a line `N passed, N failed`.
set -euo pipefail
cd "$(dirname "$0")/../.."
old_revision=${1:-$(git log --diff-filter=A --reverse --format=%h -- common/datagrams | head -n 1)^}
commit=$(git rev-parse --verify --quiet "$old_revision^{commit}") ||
  { echo "upgrade.sh: '$old_revision' is no revision of this checkout; fetch its history, or name another" >&2; exit 2; }
for tool in jq oscsend; do
  command -v $tool >/dev/null || { echo "upgrade.sh: $tool is missing (./test installs it)" >&2; exit 2; }
done
out=$PWD/out/upgrade made=$PWD/build/upgrade/$commit
rm -rf "$out"
mkdir -p "$out"/{north,south,west} "$made"

declare -A process=()
source_tree=
finish() {
  kill "${process[@]}" 2>/dev/null || true
  wait 2>/dev/null || true
  [ -z "$source_tree" ] || git worktree remove --force "$source_tree"
}
trap finish EXIT
trap 'exit 130' INT TERM

checks_log=$out/check.log
. tests/support/checks.sh

# The packages of rigs and hosts alone: calibration takes as long to compile as a host.
pack() { # build folder, packages
  rm -rf "$2"
  (cd "$1" && cpack -B "$2" -D 'CPACK_COMPONENTS_ALL=rig;host') >"$out/cpack.log" 2>&1 || { tail -n 20 "$out/cpack.log" >&2; exit 1; }
}
if [ ! -e "$made/complete" ]; then
  echo "making the packages of ${commit:0:12}"
  source_tree=$made/source
  rm -rf "$source_tree"
  git worktree prune
  git worktree add --quiet --detach "$source_tree" "$commit"
  "$source_tree/tools/build.sh" release vantage-rig vantage >"$made/build.log" 2>&1 ||
    { tail -n 20 "$made/build.log" >&2; exit 1; }
  pack "$source_tree/build/release" "$made/packages"
  git worktree remove --force "$source_tree"
  source_tree=
  touch "$made/complete"
fi
pack build/release "$out/packages"
declare -A packages=([old]=$made/packages [new]=$out/packages)
unpack() { # old or new, folder
  mkdir -p "$2"
  local package
  for package in vantage-rig vantage; do dpkg-deb -x "${packages[$1]}/${package}"_*.deb "$2"; done
}
for version in old new; do unpack $version "$out/$version"; done
old=$out/old/usr/bin/vantage new=$out/new/usr/bin/vantage
check "the programs are of two revisions" test "$("$old" --version)" != "$("$new" --version)"

# The stage: three rigs, and two hosts with a key and a folder each, as on two computers.
rate_hz=5
read -r -a ports < <(/usr/bin/python3 -c '
import socket
sockets = [socket.socket(type=kind) for kind in 3 * [socket.SOCK_STREAM] + 2 * [socket.SOCK_DGRAM]]
for each in sockets:
    each.bind(("127.0.0.1", 0))
print(*(each.getsockname()[1] for each in sockets))')
declare -A port=([north]=${ports[0]} [south]=${ports[1]} [west]=${ports[2]} [first]=${ports[3]} [second]=${ports[4]})
rigs=(north south west)
mkdir "$out"/{first,second}
for host in first second; do
  "$old" keys new "$out/$host/host.key" >"$out/$host.pub"
  cat "$out/$host.pub" >>"$out/hosts.keys"
done
cat >"$out/first/stage.toml" <<TOML
version = 1
rate_hz = $rate_hz
latency_budget_ms = 1000
key_file = "host.key"
[view]
width_px = 96
height_px = 64
TOML
azimuth_deg=-20
for rig in "${rigs[@]}"; do
  "$old" keys new "$out/$rig/rig.key" >"$out/first/$rig.pub"
  cat >"$out/$rig/rig.toml" <<TOML
version = 1
name = "$rig"
[source]
rate_hz = $rate_hz
width_px = 96
height_px = 72
[virtual_rig]
azimuth_deg = $azimuth_deg
[match]
matcher = "exact"
disparities = 32
[stream]
bind = "tcp://127.0.0.1:${port[$rig]}"
key_file = "rig.key"
authorized_hosts = "../hosts.keys"
TOML
  printf '[[rigs]]\nname = "%s"\nendpoint = "tcp://127.0.0.1:%s"\npublic_key_file = "%s.pub"\n' "$rig" "${port[$rig]}" "$rig" \
    >>"$out/first/stage.toml"
  unpack old "$out/$rig/installed"
  azimuth_deg=$((azimuth_deg + 20))
done
for file in desk flight; do cp "tests/previous_version/stage.$file.toml" "$out/first/"; done
sed "s/^pulse_rate_hz = .*/pulse_rate_hz = $rate_hz/" tests/previous_version/stage.clips.toml >"$out/first/stage.clips.toml"

# Waits for an event; ends the test if the process ends before it, or after two minutes.
until_true() { # process what command...
  local process_name=$1 what=$2 limit=$((SECONDS + 120))
  shift 2
  until "$@" 2>/dev/null; do
    if ! kill -0 "${process[$process_name]}" 2>/dev/null || [ "$SECONDS" -ge "$limit" ]; then
      echo "upgrade.sh: waited in vain for $process_name: $what" >&2
      tail -n 5 "$out/$process_name.log" >&2
      exit 1
    fi
    sleep 0.1
  done
}
count_of() { grep -c -e "$2" "$out/$1.log" || true; } # process, words
has_said() { [ "$(count_of "$1" "$2")" -ge "$3" ]; }
until_says() { until_true "$1" "'$2', ${3:-1} times" has_said "$1" "$2" "${3:-1}"; } # process, words, times
start_rig() { # rig
  "$out/$1/installed/usr/bin/vantage-rig" run --config "$out/$1/rig.toml" --json >"$out/$1.json" 2>"$out/$1.log" &
  process[$1]=$!
  until_says "$1" 'publishing on'
}
# Ends a process in order; its status is the last answer.
end() { # process
  local status=0
  kill -TERM "${process[$1]}"
  wait "${process[$1]}" || status=$?
  unset "process[$1]"
  return $status
}
upgrade_rig() { # rig: as apt does it
  check "$1 of the older version ends in order" end "$1"
  unpack new "$out/$1/installed"
  # What only this version knows; the older host gets its frames over TCP.
  [ "$1" != west ] || echo 'road = "srt"' >>"$out/$1/rig.toml"
  start_rig "$1"
}
start_host() { # host, program, option...
  local host=$1 program=$2
  shift 2
  "$program" live --stage "$out/$host/stage.toml" --headless --wait 120 --synth fused --rate 10 --seconds 1000000 --json \
    --control "osc://127.0.0.1:${port[$host]}" --take "$out/$host.mkv" "$@" >"$out/$host.json" 2>"$out/$host.log" &
  process[$host]=$!
  # Each line of progress is a second of the programme.
  until_says "$host" ' frames, ' 2
}
# Lets the show go on for some lines of a host's progress.
let_play() { # host
  until_says "$1" ' frames, ' $(($(count_of "$1" ' frames, ') + 3))
}
osc() { oscsend 127.0.0.1 "${port[$1]}" "/vantage/$2" "${@:3}"; } # host, command, types, numbers

# 1. The older host plays and records, and one rig is upgraded under it.
for rig in "${rigs[@]}"; do start_rig "$rig"; done
start_host first "$old" --save-background "$out/first/stage.vset"
let_play first
upgrade_rig west
until_says first 'rig west is connected' 2
let_play first
# What an operator makes by hand.
osc first store i 5
osc first save_background
until_says first 'saved the background'
until_true first "shot 5 in its flight file" grep -q 'number = 5' "$out/first/stage.flight.toml"

# 2. The newer host takes over: it plays and records beside the older one, with the files of that, before that one leaves.
cp "$out"/first/{stage*.toml,stage.vset,*.pub} "$out/second/"
start_host second "$new" --background "$out/second/stage.vset" --save-background "$out/second/new.vset"
let_play second
check "the older host leaves in order" end first
let_play second

# 3. The other rigs follow, one by one.
for rig in north south; do
  upgrade_rig "$rig"
  until_says second "rig $rig is connected" 2
  let_play second
done
osc second store i 6
until_true second "shot 6 in its flight file" grep -q 'number = 6' "$out/second/stage.flight.toml"
check "the newer host leaves in order" end second
for rig in "${rigs[@]}"; do check "$rig of this version ends in order" end "$rig"; done

# What they counted.
json() { jq -e "$1" "$2"; }
for host in first second; do
  check "the $host host held its ticks" json '.pictures >= 20 and .missed_ticks <= 1 + 0.02 * .pictures' "$out/$host.json"
  check "it ended its take" json '.take.state == "ended"' "$out/$host.json"
  check "it accounts for every frame" tools/check_account.sh "$out/$host.json"
done
check "rigs that were not upgraded lost no frame on the way to the first host" \
  json 'all(.rigs[] | select(.name != "west"); .outages.restarts == 0 and .link.lost == 0 and .link.send_dropped == 0)' "$out/first.json"
check "the second host started with the background of the first" \
  json 'all(.rigs[]; .background.loaded)' "$out/second.json"
check "it took the upgraded rig's frames over SRT" json '.rigs[] | select(.name == "west") | .road == "srt"' "$out/second.json"

# What they recorded. A gap that a restart explains is the upgraded rig's.
for take in first second; do
  "$new" take info "$out/$take.mkv" --json >"$out/$take.info.json" 2>"$out/$take.info.log"
done
check "the second take begins before the first one ends" \
  jq -es '[.[0].rigs, .[1].rigs] | transpose | all(.[]; .[0].name == .[1].name and .[1].first_pulse <= .[0].last_pulse)' \
  "$out/first.info.json" "$out/second.info.json"
check "the takes are joined" "$new" take join "$out/first.mkv" "$out/second.mkv" -o "$out/whole.mkv"
gaps_are() { # take, rigs as JSON
  "$new" take check "$out/$1.mkv" --json >"$out/$1.check.json" 2>/dev/null || true
  jq -e "(.damage == []) and ([.gaps[].rig] | sort) == $2 and all(.gaps[]; .why == \"the rig was restarted\")" "$out/$1.check.json"
}
check "the first take lacks nothing but the restart of west" gaps_are first '["west"]'
check "the second nothing but the restarts of north and south" gaps_are second '["north", "south"]'
check "both together lack nothing else, so that no frame is lost between the hosts" gaps_are whole '["north", "south", "west"]'
check "each rig is back within 10 seconds" json "all(.gaps[]; .to_pulse - .from_pulse < 10 * $rate_hz)" "$out/whole.check.json"
jq -r ".gaps[] | \"      \(.rig) was away for \((.to_pulse - .from_pulse + 1) / $rate_hz) s\"" "$out/whole.check.json"

# What either version reads of the other: takes, and backgrounds, flights, clips and desks over them.
plays() { # program, take, background, folder of the stage
  "$1" play "$2" --headless --size 96x64 --synth fused --frames 5 --background "$3" --flight "$4/stage.flight.toml" \
    --clips "$4/stage.clips.toml" --desk "$4/stage.desk.toml" --json
}
reads_or_refuses() { # command...
  local status=0
  "$@" 2>"$out/refusal.log" || status=$?
  echo "      status $status: $(grep -m 1 'error:' "$out/refusal.log" || echo read)" >&3
  [ $status -eq 0 ] || { [ $status -eq 1 ] && grep -q '^vantage: error: ' "$out/refusal.log"; }
}
exec 3>&1
check "this version checks the older one's take" gaps_are first '["west"]'
check "it plays it with the older one's background, flight, clips and desk" \
  plays "$new" "$out/first.mkv" "$out/first/stage.vset" "$out/first"
check "the older version reads this one's take, or refuses it with a sentence" reads_or_refuses "$old" take info "$out/second.mkv"
check "and what both recorded" reads_or_refuses "$old" take info "$out/whole.mkv"
check "the older version plays it with this one's files, or refuses them with a sentence" \
  reads_or_refuses plays "$old" "$out/second.mkv" "$out/second/new.vset" "$out/second"
close_checks
