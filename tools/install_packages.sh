#!/usr/bin/env bash
# Installs the packages of packages.txt that are missing, and nothing else.
#   tools/install_packages.sh run|test|bare
# Works as root and with sudo. Where everything is there already it asks neither apt nor the network.
# On Debian 12 it adds bookworm-backports from the mirror that this computer already uses. A failure to get a newer version
# of what is there already is reported and changes nothing.
set -euo pipefail
cd "$(dirname "$0")/.."

purpose=${1:-run}
case "$purpose" in
  run | test | bare) ;;
  *)
    echo "install_packages.sh: '$purpose' is neither run nor test nor bare" >&2
    exit 2
    ;;
esac
if ! command -v apt-get >/dev/null; then
  echo "Vantage installs its packages with apt-get (Debian 12, 13, Raspberry Pi OS), and this system has none." >&2
  exit 1
fi

codename=$(. /etc/os-release && echo "${VERSION_CODENAME:-unknown}")
architecture=$(dpkg --print-architecture)
declare -A version
while read -r name status v; do
  [ "$status" = installed ] && version[$name]=$v
done < <(dpkg-query -W -f '${Package} ${db:Status-Status} ${Version}\n')

missing=() missing_backports=() better=()
while read -r name flags; do
  case "$name" in '' | '#'*) continue ;; esac
  case "$purpose: $flags " in
    test:*' test '* | bare:*' bare '*) ;;
    run:*' test '* | *' bare '* | bare:*) continue ;;
  esac
  case " $flags " in *' amd64 '*) [ "$architecture" = amd64 ] || continue ;; esac
  have=${version[$name]:-}
  case " $flags " in
    *' backports '*)
      # The release's own version is too old on Debian 12; backports and Raspberry Pi's builds are not.
      if [ "$codename" = bookworm ]; then
        case "$have" in *~bpo12* | *+rpt*) ;; *) missing_backports+=("$name") ;; esac
        continue
      fi
      ;;
    *' newer '*)
      if [ "$codename" = bookworm ]; then
        case "$have" in *~bpo12* | *+rpt*) ;; *) better+=("$name") ;; esac
      fi
      ;;
  esac
  [ -n "$have" ] || missing+=("$name")
done <packages.txt

# Those of $better that apt knows in backports.
in_backports() {
  local name
  for name in "${better[@]}"; do
    if apt-cache policy "$name" | grep '~bpo12' >/dev/null; then echo "$name"; fi
  done
}
can_be_root() { [ "$(id -u)" -eq 0 ] || command -v sudo >/dev/null; }
# Takes them from there where apt can.
improve() {
  local names
  mapfile -t names < <(in_backports)
  [ ${#names[@]} -gt 0 ] || return 0
  echo "Vantage: taking a newer ${names[*]} from ${codename}-backports ..." >&2
  apt_get install -t "${codename}-backports" "${names[@]}" ||
    echo "Vantage: apt could not install ${names[*]} from ${codename}-backports; the installed version serves too." >&2
}

as_root() {
  if [ "$(id -u)" -eq 0 ]; then
    "$@"
  elif command -v sudo >/dev/null; then
    sudo "$@"
  else
    echo "Vantage needs these packages: ${missing[*]} ${missing_backports[*]}." >&2
    echo "You are not root and there is no sudo: ask an administrator to install them." >&2
    exit 1
  fi
}
apt_get() {
  as_root env DEBIAN_FRONTEND=noninteractive apt-get -q -y --no-install-recommends \
    -o Dpkg::Use-Pty=0 -o DPkg::Lock::Timeout=300 "$@"
}

if [ $((${#missing[@]} + ${#missing_backports[@]})) -eq 0 ]; then
  ! can_be_root || improve
  exit 0
fi
echo "Vantage: installing $((${#missing[@]} + ${#missing_backports[@]})) packages (and what they need) ..." >&2
if [ ${#missing_backports[@]} -gt 0 ] && ! apt-cache policy | grep -q "${codename}-backports"; then
  mirror=$(apt-get indextargets --format '$(REPO_URI) $(CODENAME)' | awk -v c="$codename" '$2 == c {print $1; exit}')
  if [ -z "$mirror" ]; then
    apt_get update
    mirror=$(apt-get indextargets --format '$(REPO_URI) $(CODENAME)' | awk -v c="$codename" '$2 == c {print $1; exit}')
  fi
  if [ -z "$mirror" ]; then
    echo "Vantage: apt knows no mirror of Debian $codename, so its backports cannot be added;" >&2
    echo "add ${codename}-backports to apt's sources and call this again." >&2
    exit 1
  fi
  printf 'Types: deb\nURIs: %s\nSuites: %s-backports\nComponents: main\nSigned-By: %s\n' \
    "$mirror" "$codename" /usr/share/keyrings/debian-archive-keyring.gpg |
    as_root tee /etc/apt/sources.list.d/vantage-backports.sources >/dev/null
fi
apt_get update
[ ${#missing[@]} -eq 0 ] || apt_get install "${missing[@]}"
[ ${#missing_backports[@]} -eq 0 ] || apt_get install -t "${codename}-backports" "${missing_backports[@]}"
improve
