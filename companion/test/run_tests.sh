#!/usr/bin/env bash
# Builds and packs the module in a folder of its own, and runs its tests: run_tests.sh VANTAGE FOLDER.
# Packages come from companion/node_modules, or once from the npm registry. Says SKIPPED, with the reason, without
# Node.js and npm, and where the packages cannot be had.
set -euo pipefail
vantage=$(realpath "$1") folder=$2
cd "$(dirname "$0")/.."
for program in node npm; do
  if ! command -v "$program" >/dev/null; then
    echo "SKIPPED: the Companion module: there is no $program (package $([ $program = node ] && echo nodejs || echo npm))"
    exit 0
  fi
done
mkdir -p "$folder"
rm -rf "$folder"/{companion,src,scripts,test,dist,pkg} "$folder"/*.tgz
cp -r companion src scripts test package.json tsconfig.json eslint.config.mjs .prettierrc.json README.md "$folder"
if [ -d node_modules/@companion-module/base ]; then
  ln -sfn "$PWD/node_modules" "$folder/node_modules"
fi
cd "$folder"
fetch() { # npm's arguments
  timeout 200 npm install --no-audit --no-fund --no-package-lock --fetch-retries=0 --fetch-timeout=20000 "$@" >npm.log 2>&1 && return
  echo "SKIPPED: the Companion module: npm cannot fetch its packages: $(grep -m 1 -iE 'code|error' npm.log || tail -n 1 npm.log)"
  exit 0
}
# The packages are fetched again where those of an earlier run do not fit.
if [ ! -L node_modules ] && ! cmp -s package.json node_modules/of_package.json; then
  fetch
  cp package.json node_modules/of_package.json
fi
# Companion runs modules with Node.js 22, which distributions may not have.
runtime=$(command -v node)
if ! "$runtime" -e 'process.exit(Number(process.versions.node.split(".")[0]) >= 22 ? 0 : 1)'; then
  arch=$(node -p process.arch)
  runtime=$PWD/runtime/node_modules/node-linux-$arch/bin/node
  if [ ! -x "$runtime" ]; then
    mkdir -p runtime
    fetch --no-save --prefix runtime "node-linux-$arch@22"
  fi
fi
export VANTAGE=$vantage
"$runtime" scripts/write_table.mjs
"$runtime" node_modules/typescript/bin/tsc -p tsconfig.json
"$runtime" node_modules/eslint/bin/eslint.js src
"$runtime" node_modules/@companion-module/tools/dist/scripts/build-connection.js >build.log 2>&1 || { cat build.log; exit 1; }
VANTAGE_PACKAGE=$(ls "$PWD"/*.tgz) VANTAGE_TAKE=$(realpath "$OLDPWD/../tests/takes/version_1.mkv") exec "$runtime" --test test/*.test.mjs
