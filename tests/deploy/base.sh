# The bare Debian that rigs of tests/deploy are layers over; sourced by fleet.sh. Uses $base, $work, $codename, $tools.

make_base() { # dependencies
  local stamp settings=$work/apt.conf sources
  stamp="$codename $(sha256sum <"${BASH_SOURCE[0]}") $1"
  if [ "$(cat "$base/stamp" 2>/dev/null)" != "$stamp" ]; then
    [ ! -e "$base" ] || rm -rf --one-file-system "$base"
    apt-config dump | grep -E '^Acquire::([a-z]+::([^ ]*::)?Proxy|Check-|Retries)' >"$settings" || true
    sources=$("$tools/debian_sources.sh" "$codename")
    local release=$codename
    if [ "$codename" = bookworm ]; then
      release=bookworm-backports
      sources+=$'\n'$(awk '$3 == "bookworm" {print $1, $2, "bookworm-backports main"; exit}' <<<"$sources")
    fi
    mmdebstrap --quiet --mode=root --variant=apt --aptopt="$settings" --skip=cleanup/apt/lists \
      --include=systemd-sysv,dbus,openssh-server,python3,python3-apt,sudo,iproute2,procps,kmod,init-system-helpers \
      --customize-hook="chroot \"\$1\" apt-get -q -y --no-install-recommends -t $release satisfy '$1'" \
      --customize-hook='rm -rf "$1"/etc/ssh/ssh_host_* "$1"/var/lib/apt/lists/*_dists_* && : >"$1/etc/apt/sources.list"' \
      "$codename" "$base" - <<<"$sources" >"$work/root.log" 2>&1 || return 1
    mkdir -p "$base/boot/firmware"
    echo '# as the maker ships it' >"$base/boot/firmware/config.txt"
    chroot "$base" useradd --create-home --shell /bin/bash technician
    echo 'technician ALL=(ALL) NOPASSWD: ALL' >"$base/etc/sudoers.d/technician"
    # A container has no leave to set the clock, which the units ask for.
    local unit=$base/etc/systemd/system/vantage-ptp-software.service.d
    mkdir -p "$unit"
    printf '[Service]\nAmbientCapabilities=\nAmbientCapabilities=CAP_NET_RAW CAP_NET_BIND_SERVICE\n' >"$unit/container.conf"
    chroot "$base" systemctl -q enable systemd-networkd ssh 2>>"$work/root.log"
    chroot "$base" systemctl -q mask systemd-networkd-wait-online apt-daily.timer apt-daily-upgrade.timer 2>>"$work/root.log"
    echo "$stamp" >"$base/stamp"
  fi
}
