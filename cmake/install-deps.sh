#!/usr/bin/env bash
# The one list of system packages (Debian 12). Installs only what is missing; run as root or with sudo.
#   cmake/install-deps.sh           what the build and the tests need
#   cmake/install-deps.sh --arm64   and what the arm64 test needs, which is skipped otherwise
#   cmake/install-deps.sh --extra   all this, and what fuzzing and clang-tidy need
set -euo pipefail

packages=(
  # toolchain
  g++ cmake ninja-build ccache pkg-config git ca-certificates
  # geodesy: PROJ with its data (the EGM96 grid is in proj-data), GeographicLib
  libproj-dev proj-data libgeographiclib-dev
  # sources: GDAL, libosmium with its readers' needs, expat
  libgdal-dev libosmium2-dev libprotozero-dev libexpat1-dev zlib1g-dev libbz2-dev
  # geometry and estimation: CGAL, PCL, Eigen, Ceres, Embree
  libcgal-dev libpcl-dev libeigen3-dev libceres-dev libembree-dev
  # core and cli: hashes, JSON and its schemas, options
  libssl-dev nlohmann-json3-dev libvalijson-dev libcli11-dev
  # tests: GoogleTest, benchmarks, libcitygml as an oracle, tools of the test scripts
  libgtest-dev libbenchmark-dev libcitygml-dev xz-utils
)
arm64=(g++-aarch64-linux-gnu qemu-user)
extra=(clang-16 libclang-rt-16-dev clang-tidy-16 clang-format)

case "${1:-}" in
  --arm64) packages+=("${arm64[@]}") ;;
  --extra) packages+=("${arm64[@]}" "${extra[@]}") ;;
esac

missing=()
for package in "${packages[@]}"; do
  dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null | grep -qx installed || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || { echo "install-deps.sh: missing packages: ${missing[*]}; run as root, or install sudo" >&2; exit 1; }
  as_root=(sudo)
fi
export DEBIAN_FRONTEND=noninteractive
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
