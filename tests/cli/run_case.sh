#!/usr/bin/env bash
# Runs tests/cli/<tool>/<case>/test.sh in an empty folder, with the programs on PATH and these helpers:
#   succeeds CMD...            exit 0; stdout in ./stdout, stderr in ./stderr
#   fails_with CODE TEXT CMD...  exits CODE, stderr is one line that holds TEXT, stdout is empty
#   expect_in FILE TEXT        FILE holds TEXT
#   skip REASON                ends the case as skipped
# $CASE is the case's folder, $PRIORMAP_SOURCE the source tree, $SHARED_DATA the real inputs (may be absent: needs_shared_data).
set -euo pipefail
export CASE="$PRIORMAP_SOURCE/tests/cli/$1"
export PATH="$PRIORMAP_BIN:$PATH"
export SHARED_DATA="${PRIORMAP_SHARED_DATA:-$PRIORMAP_SOURCE/../shared/data}"

die() { echo "FAILED: $*" >&2; [ -s stderr ] && { echo "--- stderr"; cat stderr; } >&2; exit 1; }
skip() { echo "SKIPPED: $*"; exit 77; }
needs_shared_data() { [ -e "$SHARED_DATA/$1" ] || skip "the real inputs are absent ($1)"; }
succeeds() {
  local code=0
  "$@" >stdout 2>stderr </dev/null || code=$?
  [ $code -eq 0 ] || die "exit $code instead of 0: $*"
}
fails_with() {
  local expected=$1 text=$2 code=0
  shift 2
  "$@" >stdout 2>stderr </dev/null || code=$?
  [ $code -eq "$expected" ] || die "exit $code instead of $expected: $*"
  [ ! -s stdout ] || die "wrote to stdout: $*"
  [ "$(wc -l <stderr)" -eq 1 ] || die "stderr is not one line: $*"
  grep -qF -- "$text" stderr || die "stderr does not say '$text': $*"
}
expect_in() { grep -qF -- "$2" "$1" || die "$1 does not hold '$2'"; }
expect_absent() { [ ! -e "$1" ] || die "$1 exists"; }
export -f die

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
source "$CASE/test.sh"
