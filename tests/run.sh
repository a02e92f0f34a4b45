#!/usr/bin/env bash
# Installs what is missing, builds the dev preset (warnings are errors) and runs every test. Arguments go to ctest.
#   ./tests/run.sh                     everything
#   ./tests/run.sh -R evaltraj         tests whose name fits
set -euo pipefail
cd "$(dirname "$0")/.."
source cmake/build-environment.sh

cmake/install-deps.sh
cmake --preset dev
cmake --build build/dev --parallel "$PRIORMAP_JOBS"
cmake --build build/dev --parallel "$PRIORMAP_JOBS" --target all_verify_interface_header_sets
ctest --test-dir build/dev --parallel "$PRIORMAP_JOBS" --output-on-failure "$@"
