#!/usr/bin/env bash
# Configures the build on a computer without libmicrohttpd, GnuTLS and libsrt, and compiles what stands in for them.
#   without_options.sh SOURCES COMPILER
set -euo pipefail
sources=$1 compiler=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# Answers as pkg-config does where the two are not installed.
cat >"$work/pkg-config" <<'END'
#!/usr/bin/env bash
case " $* " in *" libmicrohttpd"* | *" gnutls"* | *" srt"*) exit 1 ;; esac
exec pkg-config "$@"
END
chmod +x "$work/pkg-config"
configure() { # folder, options
  cmake -S "$sources" -B "$work/$1" -G Ninja -DCMAKE_CXX_COMPILER="$compiler" -DPKG_CONFIG_EXECUTABLE="$work/pkg-config" \
    -DVANTAGE_UNITY=OFF -DVANTAGE_PRECOMPILE=OFF "${@:2}" >"$work/$1.log" 2>&1
}
fault() {
  echo "FAILED  $1" >&2
  exit 1
}

! "$work/pkg-config" --exists libmicrohttpd gnutls srt || fault "the stand-in for pkg-config finds what it must not"
configure without -DVANTAGE_SRT=OFF -DVANTAGE_WEB=OFF -DVANTAGE_METRICS=OFF -DVANTAGE_PYTHON=OFF ||
  fault "the core cannot be configured: $(tail -n 20 "$work/without.log")"
commands=$work/without/compile_commands.json
for gone in common/datagrams/srt host_app/web/http host_app/metrics/http; do
  ! grep -q "$gone" "$commands" || fault "$gone is compiled"
done
! grep -qE 'libmicrohttpd|libgnutls|libsrt|python3-vantage' "$work/without/build.ninja" || fault "the core links what it must not"
! grep -q 'CPACK_COMPONENTS_ALL.*python' "$work/without/CPackConfig.cmake" || fault "the Python module is packed"
for instead in common/datagrams/none/datagram_server.cpp common/datagrams/none/datagram_link.cpp host_app/web/none/web_server.cpp host_app/metrics/none/metrics_server.cpp; do
  command=$(jq -r --arg file "$sources/$instead" '.[] | select(.file == $file) | .command' "$commands")
  [ -n "$command" ] || fault "$instead is not compiled"
  (cd "$work/without" && bash -c "${command% -c *} -fsyntax-only '$sources/$instead'") || fault "$instead does not compile"
done
echo "the core is configured without libmicrohttpd, GnuTLS, libsrt and Python"
