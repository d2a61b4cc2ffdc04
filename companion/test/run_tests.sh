#!/usr/bin/env bash
# Builds the module and runs its tests: run_tests.sh VANTAGE. Says SKIPPED without Node.js 20 or `npm install`.
set -euo pipefail
cd "$(dirname "$0")/.."
if ! node -e 'process.exit(Number(process.versions.node.split(".")[0]) >= 20 ? 0 : 1)' 2>/dev/null; then
  echo "SKIPPED: the Companion module: there is no Node.js 20 (package nodejs)"
  exit 0
fi
if [ ! -d node_modules/@companion-module/base ]; then
  echo "SKIPPED: the Companion module: its packages are missing (npm install in companion/)"
  exit 0
fi
export VANTAGE=$1
node scripts/write_table.mjs
node node_modules/typescript/bin/tsc -p tsconfig.json
node node_modules/eslint/bin/eslint.js src
exec node --test test/
