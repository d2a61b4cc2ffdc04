#!/usr/bin/env bash
# Checks the documents and builds them as a site in build/site: sentences, links, anchors, pictures and navigation.
# Every warning of MkDocs is a failure. Says SKIPPED where python3 or MkDocs with its Material theme cannot be had.
#   tools/docs.sh            check and build
#   tools/docs.sh --serve    serve the site on http://127.0.0.1:8000 and rebuild it when a page changes
set -uo pipefail
cd "$(dirname "$0")/.."
if ! command -v python3 >/dev/null; then
  echo "SKIPPED: documents: there is no python3 (package python3)"
  exit 0
fi
tools/check_prose.py || exit 1
tools/check_links.py || exit 1
if ! command -v mkdocs >/dev/null || ! mkdocs build --help | grep -q material; then
  echo "SKIPPED: the site: MkDocs or its Material theme is missing (packages mkdocs and mkdocs-material)"
  exit 0
fi
[ "${1:-}" != --serve ] || exec mkdocs serve
mkdocs build --strict --quiet --clean || exit 1
echo "documents: built $(find build/site -name '*.html' | wc -l) pages in build/site"
