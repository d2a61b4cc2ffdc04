#!/usr/bin/env bash
# Documents stay within two pages: fails on one with more than 1600 words. Tables in docs/results may be as long as they are.
#   tests/documents/check_length.sh DOCUMENT...
set -euo pipefail
most=1600
status=0
for document in "$@"; do
  words=$(wc -w <"$document")
  [ "$words" -gt $most ] || continue
  echo "$(basename "$document") has $words words, and $most are two pages: say it shorter, or move long tables to docs/results"
  status=1
done
[ $status -ne 0 ] || echo "$# documents, each within $most words"
exit $status
