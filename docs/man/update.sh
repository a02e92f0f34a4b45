#!/usr/bin/env bash
# Puts each program's --help into its man page, between the two marks. Usage: docs/man/update.sh [BIN]   (default build/dev/bin)
set -euo pipefail
cd "$(dirname "$0")"
bin=$(cd "${1:-../../build/dev/bin}" && pwd)
for folder in ../../tools/*/; do
  tool=$(basename "$folder")
  page=$tool.1.md
  [ -x "$bin/$tool" ] || { echo "update.sh: no $tool in $bin; build it first" >&2; exit 1; }
  "$bin/$tool" --help >"$page.help"
  awk -v help="$page.help" '
    /^<!-- end of --help -->$/ { skipping = 0 }
    !skipping { print }
    /^<!-- --help -->$/ { skipping = 1; print "```"; while ((getline line < help) > 0) print line; print "```" }
  ' "$page" >"$page.new"
  mv "$page.new" "$page"
  rm "$page.help"
done
