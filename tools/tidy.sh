#!/usr/bin/env bash
# Runs clang-tidy with .clang-tidy over all C++ files, over those that changed since a revision, or over those named. A
# file that was found clean is looked at again only once it, a header of ours that it includes, or what is asked of it
# has changed.
#   tools/tidy.sh [REVISION | FILE.cpp...]
set -euo pipefail
cd "$(dirname "$0")/.."
tools/build.sh release
# How each source is compiled alone, without the precompiled headers of another compiler; so what a file forgot to include
# shows as well. What is generated lies in the build.
mkdir -p build/tidy/clean
cmake --preset release -B build/tidy/alone -D VANTAGE_TESTS=ON -D VANTAGE_UNITY=OFF -D VANTAGE_PRECOMPILE=OFF \
  >build/tidy/configure.log 2>&1 || { cat build/tidy/configure.log >&2; exit 1; }
sed 's#/build/tidy/alone/#/build/release/#g' build/tidy/alone/compile_commands.json >build/tidy/compile_commands.json

# A line a source: it, then what it, and those compiled together with it, include of ours, all as seen from the build folder.
sources_and_headers() {
  ninja -C build/release -t deps | awk '
    function tell() {for (i = 1; i <= count; i++) print sources[i] headers; count = 0; headers = ""}
    /^[^ ]/ {tell()}
    /^ / && $1 !~ /^\// && $1 !~ /cmake_pch|unity_/ {
      if ($1 ~ /\.cpp$/) sources[++count] = $1; else headers = headers " " $1}
    END {tell()}'
}

look_at() { # source, the stamp that says it is clean
  clang-tidy -p build/tidy --quiet --extra-arg=-Wno-unknown-warning-option --extra-arg=-Qunused-arguments "$1" 2>/dev/null && : >"$2"
}
export -f look_at

declare -A headers_of
while read -r source headers; do headers_of[${source#../../}]=$headers; done < <(sources_and_headers)
asked=$(clang-tidy --version && cat .clang-tidy)
asked_of_tests=$(cat tests/.clang-tidy)
wanted() {
  if [ $# -eq 0 ]; then git ls-files '*.cpp'; elif [ -f "$1" ]; then printf '%s\n' "$@"; else
    git diff --name-only --diff-filter=d "$1" -- '*.cpp'; fi
}
count=0 work=()
while read -r source; do
  count=$((count + 1))
  # shellcheck disable=SC2086 # several headers
  seen=$(cd build/release && {
    echo "$asked"
    [[ $source != tests/* ]] || echo "$asked_of_tests"
    cat "../../$source" ${headers_of[$source]:-} 2>/dev/null || true
  } | sha256sum)
  stamp=build/tidy/clean/${seen:0:40}
  [ -e "$stamp" ] || work+=("$source" "$stamp")
done < <(wanted "$@")
echo "tidy: $((${#work[@]} / 2)) of $count files have to be looked at"
[ ${#work[@]} -eq 0 ] || printf '%s\0' "${work[@]}" | xargs -0 -P "$(nproc)" -n 2 bash -c 'look_at "$@"' look_at
echo "tidy: clean"
