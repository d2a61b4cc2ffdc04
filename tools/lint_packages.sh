#!/usr/bin/env bash
# Holds Debian packages to lintian: neither errors nor warnings.
#   tools/lint_packages.sh PACKAGE.deb...
set -euo pipefail
[ $# -gt 0 ] || { echo "lint_packages.sh: which packages?" >&2; exit 2; }
command -v lintian >/dev/null || { echo "lint_packages.sh: lintian is missing; ./test installs it" >&2; exit 1; }
exec lintian --allow-root --fail-on error,warning --tag-display-limit 0 "$@"
