#!/usr/bin/env bash
# A bare Debian, made for this and removed after it: what Vantage does on a computer where nobody has installed anything.
# An ordinary user with sudo clones this checkout's HEAD to /tmp, into a folder whose name has a space, and works there.
#   tools/bare.sh [12|13] [STEP...]
# Steps: run (./run --headless --seconds 5, and a look at what it wrote), test (./test), all (./test --all), ci (.ci/run);
# without any, run and test. VANTAGE_BARE_KEEP=1 in the environment keeps the root and says where it is.
# From outside come Debian's packages, from the mirror that apt here uses, the compiler cache, and the data of the tests.
# Needs root or sudo. Closes with a line `N passed, N failed`.
set -euo pipefail
cd "$(dirname "$0")/.."

release=12
case "${1-}" in
  12 | 13) release=$1; shift ;;
esac
[ $# -gt 0 ] || set -- run test
for step in "$@"; do
  case "$step" in
    run | test | all | ci) ;;
    *) echo "bare.sh: '$step' is not a step: run, test, all or ci" >&2; exit 2 ;;
  esac
done
codename=$([ "$release" = 12 ] && echo bookworm || echo trixie)
cache=${CCACHE_DIR:-$(ccache -k cache_dir 2>/dev/null || echo ~/.cache/ccache)}
data=${VANTAGE_DATA:-$PWD/../shared/data}
if [ "$(id -u)" -ne 0 ]; then
  exec sudo env CCACHE_DIR="$cache" VANTAGE_DATA="$data" VANTAGE_BARE_KEEP="${VANTAGE_BARE_KEEP-}" "$0" "$release" "$@"
fi
tools/install_packages.sh bare

sources=$(tools/debian_sources.sh "$codename")
root=$(mktemp -d "${TMPDIR:-/var/tmp}/vantage-bare-$release.XXXXXX")
chmod 755 "$root"
settings=$(mktemp)
finish() {
  rm -f "$settings"
  if [ -n "${VANTAGE_BARE_KEEP-}" ]; then
    echo "bare: the root is kept in $root" >&2
  else
    rm -rf --one-file-system "$root"
  fi
}
trap finish EXIT
trap 'exit 130' INT TERM

started=$SECONDS
say() { echo "=== bare: $* ($((SECONDS - started)) s)"; }
say "a root of Debian $release ($codename)"
# How this computer reaches its mirror (a proxy, say) holds in the root too.
apt-config dump | grep -E '^Acquire::([a-z]+::([^ ]*::)?Proxy|Check-|Retries)' >"$settings" || true
echo 'Acquire::Retries "3";' >>"$settings"
mmdebstrap --quiet --mode=root --variant=minbase --include=sudo,git,ca-certificates --aptopt="$settings" \
  "$codename" "$root" - <<<"$sources"

folder='/tmp/a folder/vantage'
git clone -q --no-hardlinks . "$root$folder"
chroot "$root" useradd --create-home --shell /bin/bash --user-group somebody
echo 'somebody ALL=(ALL) NOPASSWD: ALL' >"$root/etc/sudoers.d/somebody"
echo bare >"$root/etc/hostname"
echo '127.0.0.1 localhost bare' >"$root/etc/hosts"
mkdir -p "$root/home/somebody/.cache/ccache" "$root/mnt/data"
# A build beside this one may write there, and a file vanish between its listing and its copy.
[ ! -d "$cache" ] || cp -r "$cache/." "$root/home/somebody/.cache/ccache/" 2>/dev/null || true
chroot "$root" chown -R somebody: "${folder%/*}" /home/somebody
[ -d "$data" ] || data=

# Runs a command in the clone, as the user, in namespaces of its own: when it ends, so does all that it started.
inside() { # command...
  local enter
  enter=$(cat <<'END'
    set -e
    root=$1 data=$2 folder=$3
    shift 3
    mount -t proc proc "$root/proc"
    mount --rbind -o ro /sys "$root/sys"
    mount -t tmpfs -o mode=755 tmpfs "$root/dev"
    for node in null:3 zero:5 full:7 random:8 urandom:9; do
      mknod -m 666 "$root/dev/${node%:*}" c 1 "${node#*:}"
    done
    mknod -m 666 "$root/dev/tty" c 5 0
    mkdir "$root/dev/pts" "$root/dev/shm"
    mount -t devpts -o newinstance,ptmxmode=0666,mode=0620,gid=5 devpts "$root/dev/pts"
    mount -t tmpfs -o mode=1777 tmpfs "$root/dev/shm"
    ln -s pts/ptmx "$root/dev/ptmx"
    ln -s /proc/self/fd "$root/dev/fd"
    for stream in stdin:0 stdout:1 stderr:2; do ln -s "/proc/self/fd/${stream#*:}" "$root/dev/${stream%:*}"; done
    [ -z "$data" ] || mount --bind -o ro "$data" "$root/mnt/data"
    hostname bare
    exec chroot "$root" setpriv --reuid somebody --regid somebody --init-groups env -i \
      HOME=/home/somebody USER=somebody PATH=/usr/local/bin:/usr/bin:/bin LANG=C.UTF-8 VANTAGE_BARE=1 ${data:+VANTAGE_DATA=/mnt/data} \
      bash -c 'cd "$1" && shift && exec "$@"' bash "$folder" "$@"
END
  )
  unshare --mount --pid --ipc --uts --fork --kill-child bash -c "$enter" bash "$root" "$data" "$folder" "$@" </dev/null
}

passed=0 failed=0
check() { # what it must be, status
  if [ "$2" -eq 0 ]; then passed=$((passed + 1)); else failed=$((failed + 1)); fi
  printf '%-4s %s\n' "$([ "$2" -eq 0 ] && echo ok || echo FAIL)" "$1"
}

look_at_flight() { # the log of ./run
  local out=$root$folder/out pictures told status=0
  grep '^{' "$1" | tail -n 1 >"$root/report.json" || true
  told=$(jq .film.pictures "$root/report.json" || echo 0)
  pictures=$(ffprobe -v error -count_frames -select_streams v:0 -show_entries stream=nb_read_frames -of csv=p=0 "$out/flight.mkv" || echo 0)
  [ "$pictures" -gt 0 ] && [ "$pictures" = "$told" ] || status=1
  check "the film opens and has $pictures pictures, and the summary says $told" $status
  status=0
  ffprobe -v error "$out/contact_sheet.png" >&2 || status=1
  check "the contact sheet opens" $status
  counted tools/check_account.sh "$root/report.json"
}

counted() { # command...: one that closes with N passed, N failed
  local log=$root/counted.log status=0 line p f
  "$@" 2>&1 | tee "$log" || status=${PIPESTATUS[0]}
  line=$(grep -E '^[0-9]+ passed, [0-9]+ failed' "$log" | tail -n 1 || true)
  read -r p _ f _ <<<"${line:-0 passed, 0 failed}"
  [ "$status" -eq 0 ] || [ "$f" -gt 0 ] || f=1
  passed=$((passed + p)) failed=$((failed + f))
}

run_it() {
  local log=$root/run.log status=0
  inside ./run --headless --seconds 5 --json 2>&1 | tee "$log" || status=${PIPESTATUS[0]}
  check "./run --headless --seconds 5 --json" "$status"
  status=0
  grep -q '^VANTAGE_TESTS:BOOL=OFF' "$root$folder/build/release/CMakeCache.txt" && [ ! -e "$root/usr/include/gtest" ] || status=1
  check "nothing of the tests was installed or configured" $status
  [ ! -e "$root$folder/out/flight.mkv" ] || look_at_flight "$log"
}

for step in "$@"; do
  say "$step"
  case "$step" in
    run) run_it ;;
    test) counted inside ./test ;;
    all) counted inside ./test --all ;;
    ci) counted inside .ci/run ;;
  esac
done
# What was compiled in there need not be compiled again out here.
mkdir -p "$cache"
cp -ru "$root/home/somebody/.cache/ccache/." "$cache/"
say "done"
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ] && [ "$passed" -gt 0 ]
