#!/usr/bin/env bash
# From a fresh Debian 12 to a georeferenced LiDAR map: installs what is missing, builds the programs, runs examples/01_quickstart.
set -euo pipefail
cd "$(dirname "$0")/.."
source cmake/build-environment.sh

cmake/install-deps.sh
cmake --preset release -DBUILD_TESTING=OFF
cmake --build build/release --parallel "$PRIORMAP_JOBS"
examples/01_quickstart/run.sh
