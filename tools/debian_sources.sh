#!/usr/bin/env bash
# Prints, as lines for apt, where this computer's apt gets Debian from, for another release; backports are left out.
#   tools/debian_sources.sh bookworm|trixie
# Fails where apt knows no mirror of Debian.
set -euo pipefail
wanted=${1:?debian_sources.sh: say a release, bookworm or trixie}
here=$(. /etc/os-release && echo "${VERSION_CODENAME:-unknown}")
sources() {
  apt-get indextargets --format '$(ORIGIN)|$(REPO_URI)|$(CODENAME)|$(IDENTIFIER)' |
    awk -F'|' -v here="$here" -v wanted="$wanted" \
      '$1 == "Debian" && index($3, here) == 1 && $3 !~ /-backports/ && $4 == "Packages" {
        sub("^" here, wanted, $3); print "deb " $2 " " $3 " main" }' | sort -u
}
found=$(sources)
if [ -z "$found" ]; then
  as_root=()
  [ "$(id -u)" -eq 0 ] || as_root=(sudo)
  "${as_root[@]}" apt-get -qq update >&2
  found=$(sources)
fi
if [ -z "$found" ]; then
  echo "debian_sources.sh: apt here knows no mirror of Debian $here, so there is nothing to take $wanted from" >&2
  exit 1
fi
echo "$found"
