#!/usr/bin/env bash
# Compiles the shaders of a rig's frame with the compiler of a Raspberry Pi's GPU, without a Raspberry Pi: Mesa's V3D driver on
# a pretended device (drm-shim) compiles every program that tests/bench/rig_frame runs, and executes nothing. Mesa's Panfrost
# does the same for a Mali-G610 (RK3588).
#   tools/v3d.sh             builds Mesa where it is not built yet, and writes docs/results/v3d.md
#   tools/v3d.sh --check     compares with that page and its limits in place of writing it
#   tools/v3d.sh build       builds Mesa only (some ten minutes)
#   tools/v3d.sh run VERSION PROGRAM...    runs PROGRAM on the pretended GPU; VERSION 42 (Pi 4), 71 (Pi 5) or g610 (RK3588)
# Mesa's source is Debian's, and lies with what is built of it in $XDG_CACHE_HOME/vantage/v3d (by default ~/.cache). Says
# SKIPPED, and succeeds, where apt has no source of Mesa or this is no amd64. Without root.
set -euo pipefail
cd "$(dirname "$0")/.."
root=$PWD
cache=${XDG_CACHE_HOME:-$HOME/.cache}/vantage/v3d
bin=$root/build/release/bin
mesa_version=25.0.7
drivers=v3d,panfrost

skip() {
  echo "v3d.sh: SKIPPED, $1" >&2
  exit 0
}

apt_options=()
# Lists of its own, so that neither the computer's sources nor root are touched.
prepare_apt() {
  local mirror keyring=/usr/share/keyrings/debian-archive-keyring.gpg
  mirror=$(apt-get indextargets --format '$(ORIGIN)|$(REPO_URI)' 2>/dev/null | awk -F'|' '$1 == "Debian" && !/security/ {print $2; exit}')
  [ -n "$mirror" ] || skip "apt here knows no mirror of Debian"
  mkdir -p "$cache/apt/lists/partial" "$cache/apt/cache/archives/partial"
  local signed="[signed-by=$keyring]"
  printf '%s\n' "deb-src $signed $mirror trixie main" "deb-src $signed $mirror bookworm-backports main" \
    "deb $signed $mirror bookworm-backports main" "deb $signed $mirror bookworm main" >"$cache/apt/sources.list"
  apt_options=(-q -o "Dir::Etc::sourcelist=$cache/apt/sources.list" -o Dir::Etc::sourceparts=/dev/null
    -o "Dir::State::lists=$cache/apt/lists" -o "Dir::Cache=$cache/apt/cache")
  apt-get "${apt_options[@]}" update || skip "the mirror $mirror cannot be reached"
}

# What builds Mesa and is not among packages.txt, unpacked beside it.
fetch_tools() {
  mkdir -p debs tools
  (
    cd debs
    apt-get "${apt_options[@]}" download meson/bookworm-backports python3-mako python3-markupsafe bison flex m4 \
      libdrm{-dev,2,-common,-amdgpu1,-intel1,-nouveau2,-radeon1}/bookworm-backports
  ) || skip "the tools that build Mesa cannot be had"
  for package in debs/*.deb; do dpkg -x "$package" tools; done
  sed -i "s#^prefix=/usr\$#prefix=$cache/tools/usr#" tools/usr/lib/x86_64-linux-gnu/pkgconfig/*.pc
}

fetch_mesa() {
  # The mirror may have dropped the file that describes the package; the original source is all that is needed.
  apt-get "${apt_options[@]}" source --download-only "mesa/trixie" || true
  [ -f "mesa_$mesa_version.orig.tar.xz" ] || apt-get "${apt_options[@]}" source --download-only "mesa/bookworm-backports" || true
  [ -f "mesa_$mesa_version.orig.tar.xz" ] || skip "apt has no source of Mesa $mesa_version"
  rm -rf mesa
  mkdir mesa
  tar -xf "mesa_$mesa_version.orig.tar.xz" -C mesa --strip-components 1
  patch -d mesa -p1 <"$root/tools/v3d/drm_shim.patch"
}

build_mesa() {
  [ "$(dpkg --print-architecture)" = amd64 ] || skip "Mesa is compiled here for amd64 only"
  mkdir -p "$cache"
  cd "$cache"
  if [ "$(cat built 2>/dev/null)" != "$mesa_version $drivers" ]; then
    rm -rf built build
    prepare_apt
    [ -d tools ] || fetch_tools
    [ -d mesa ] || fetch_mesa
    (
      export PATH=$cache/tools/usr/bin:$PATH M4=$cache/tools/usr/bin/m4
      export PYTHONPATH=$cache/tools/usr/lib/python3/dist-packages:$cache/tools/usr/share/meson
      export BISON_PKGDATADIR=$cache/tools/usr/share/bison PKG_CONFIG_PATH=$cache/tools/usr/lib/x86_64-linux-gnu/pkgconfig
      [ -f build/build.ninja ] || nice meson setup build mesa -Dbuildtype=release -Db_ndebug=true -Dgallium-drivers="$drivers" \
        -Dvulkan-drivers= -Dtools=drm-shim -Dllvm=disabled -Dglx=disabled -Dplatforms= -Degl=enabled -Dgles1=disabled \
        -Dgles2=enabled -Dopengl=true -Dgbm=enabled -Dglvnd=disabled -Dgallium-va=disabled -Dgallium-vdpau=disabled \
        -Dshader-cache=enabled -Dzstd=disabled -Dvideo-codecs= -Dbuild-tests=false -Dlmsensors=disabled -Dlibunwind=disabled \
        -Dvalgrind=disabled
      nice ninja -C build
    )
    echo "$mesa_version $drivers" >built
  fi
  gcc -O1 -shared -fPIC -o libgl_trace.so "$root/tools/v3d/gl_trace.c" -ldl
  cd "$root"
}

# on_gpu VERSION PROGRAM...: the environment in which PROGRAM finds the pretended GPU, whose compiler prints what it makes.
on_gpu() {
  local version=$1 mesa=$cache/build shim
  local gpu=("V3D_SHIM=$version" MESA_LOADER_DRIVER_OVERRIDE=v3d V3D_DEBUG=shaderdb,qpu)
  shift
  shim=$mesa/src/broadcom/drm-shim/libv3d_noop_drm_shim.so
  if [ "$version" = g610 ]; then
    gpu=(PAN_GPU_ID=a867 MESA_LOADER_DRIVER_OVERRIDE=panthor BIFROST_MESA_DEBUG=shaderdb)
    shim=$mesa/src/panfrost/drm-shim/libpanfrost_noop_drm_shim.so
  fi
  env "${gpu[@]}" MESA_SHADER_CACHE_DISABLE=true \
    LD_LIBRARY_PATH="$mesa/src/egl:$mesa/src/mapi/es2api:$mesa/src/gbm:$mesa/src/gallium/targets/dri:$cache/tools/usr/lib/x86_64-linux-gnu" \
    GBM_BACKENDS_PATH="$mesa/src/gbm/backends/dri" LIBGL_DRIVERS_PATH="$mesa/src/gallium/targets/dri" \
    LD_PRELOAD="$shim:$cache/libgl_trace.so" "$@"
}

# run_frame VERSION NAME OPTION...: a rig's frame, whose facts and compiler's lines get into the folder of runs.
run_frame() {
  local version=$1 name=$2
  shift 2
  echo "v3d.sh: $version, $*" >&2
  on_gpu "$version" nice "$bin/rig_frame" "$@" >"$runs/$name.json" 2>"$runs/$name.err" || {
    grep -v -E '^(0x|TRACE|SHADER-DB|MESA_SHADER)' "$runs/$name.err" | tail -n 5 >&2
    echo "v3d.sh: rig_frame failed on the pretended $version; its output is $runs/$name.err" >&2
    exit 1
  }
}

run_all() {
  local version shape size disparities preset format match_width
  runs=$cache/runs
  rm -rf "$runs"
  mkdir -p "$runs"
  echo "$mesa_version" >"$runs/mesa_version"
  for version in 71 42; do
    for shape in 640x400,64,fast,nv12 640x400,64,balanced,nv12 640x400,64,quality,nv12 640x400,64,fast,yuyv \
      960x720,64,balanced,nv12 960x720,64,balanced,nv12,640 1280x800,128,fast,nv12 1280x800,128,balanced,nv12; do
      IFS=, read -r size disparities preset format match_width <<<"$shape"
      run_frame "$version" "v${version}_${size}_${preset}_$format${match_width:+_to_$match_width}" --size "$size" \
        --disparities "$disparities" --preset "$preset" --format "$format" ${match_width:+--match-width "$match_width"}
    done
  done
  for preset in fast balanced quality; do
    run_frame g610 "g610_$preset" --size 640x400 --disparities 64 --preset "$preset" --frames 2
  done
}

case "${1-}" in
  build) build_mesa ;;
  run)
    shift
    build_mesa
    on_gpu "$@"
    ;;
  '' | --check)
    [ -x "$bin/rig_frame" ] || {
      echo "v3d.sh: $bin/rig_frame is not built: run tools/build.sh release rig_frame first" >&2
      exit 1
    }
    build_mesa
    run_all
    python3 tools/v3d/report.py "$cache/runs" docs/results/v3d.md ${1+"$1"}
    ;;
  *)
    sed -n '5,8s/^# \{0,1\}//p' "$0" >&2
    exit 2
    ;;
esac
