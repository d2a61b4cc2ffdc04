#!/usr/bin/env bash
# Puts packages into a signed repository that apt installs from, and makes it where there is none.
#   tools/apt_repository.sh FOLDER --key KEY PACKAGE.deb...
# KEY is a name, an address or a fingerprint of a secret key that gpg has. A web server offers FOLDER/public; the key
# that computers check it by lies there as vantage.gpg. A package goes to the release of Debian that its version names
# (0.1.0~deb13: trixie). All versions stay, so that apt can go back to one. Never changes a package that is there.
set -euo pipefail
folder= key= packages=()
while [ $# -gt 0 ]; do
  case "$1" in
    --key) key=${2:?--key needs a name}; shift 2 ;;
    -h | --help) sed -n '2,7s/^# \{0,1\}//p' "$0"; exit 0 ;;
    -*) echo "apt_repository.sh: '$1' is not an option; --help lists them" >&2; exit 2 ;;
    *.deb) packages+=("$1"); shift ;;
    *)
      [ -z "$folder" ] || { echo "apt_repository.sh: '$1' is no package: its name must end in .deb" >&2; exit 2; }
      folder=$1
      shift
      ;;
  esac
done
if [ -z "$folder" ] || [ -z "$key" ] || [ ${#packages[@]} -eq 0 ]; then
  echo "apt_repository.sh: it takes a folder, --key KEY and packages; --help says more" >&2
  exit 2
fi
for tool in aptly gpg; do
  command -v $tool >/dev/null ||
    { echo "apt_repository.sh: $tool is missing (sudo apt install aptly gnupg)" >&2; exit 1; }
done
gpg --batch --list-secret-keys "$key" >/dev/null 2>&1 || {
  echo "apt_repository.sh: gpg has no secret key '$key'; make one: gpg --quick-generate-key '$key' ed25519 sign never" >&2
  exit 1
}

# All are looked at before anything is changed.
declare -A packages_of
for package in "${packages[@]}"; do
  version=$(dpkg-deb -f "$package" Version) || { echo "apt_repository.sh: $package is no package of Debian" >&2; exit 1; }
  case "$version" in
    *~deb12*) release=bookworm ;;
    *~deb13*) release=trixie ;;
    *)
      echo "apt_repository.sh: $package has version $version, which names no release of Debian (~deb12, ~deb13)" >&2
      exit 1
      ;;
  esac
  packages_of[$release]+=$(realpath "$package")$'\n'
done

mkdir -p "$folder"
folder=$(realpath "$folder")
settings=$folder/aptly.conf
[ -e "$settings" ] || cat >"$settings" <<END
{"rootDir": "$folder", "architectures": ["amd64", "arm64"], "gpgProvider": "gpg"}
END
aptly_here() { aptly -config="$settings" "$@"; }
log=$(mktemp)
trap 'rm -f "$log"' EXIT
quietly() { # command...
  "$@" >"$log" 2>&1 || { cat "$log" >&2; exit 1; }
}

for release in "${!packages_of[@]}"; do
  aptly_here repo show "$release" >/dev/null 2>&1 ||
    quietly aptly_here repo create -distribution="$release" -component=main "$release"
  mapfile -t added <<<"${packages_of[$release]%$'\n'}"
  quietly aptly_here repo add "$release" "${added[@]}"
  if aptly_here publish list -raw | grep -qx ". $release"; then
    quietly aptly_here publish update -batch -skip-contents -gpg-key="$key" "$release"
  else
    quietly aptly_here publish repo -batch -skip-contents -gpg-key="$key" -origin=Vantage -label=Vantage \
      -architectures=amd64,arm64 "$release"
  fi
  echo "$release: ${#added[@]} added, $(aptly_here repo show -with-packages "$release" | grep -c '_\(amd64\|arm64\)$') there"
done
gpg --batch --yes --output "$folder/public/vantage.gpg.new" --export "$key"
mv "$folder/public/vantage.gpg.new" "$folder/public/vantage.gpg"
