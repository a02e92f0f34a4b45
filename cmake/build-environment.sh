# Sourced by the scripts that build. One compiler cache serves all presets and checkouts: paths are taken relative to the source
# folder, and a warning flag does not change what is compiled.
export CCACHE_BASEDIR="$PWD" CCACHE_NOHASHDIR=1 CCACHE_IGNOREOPTIONS=-Werror
# Some files need 2 GiB to compile (CGAL, PCL, Ceres): no more jobs than the memory holds.
memory_jobs=$(awk '/^MemAvailable/ { print int($2 / 2097152) }' /proc/meminfo)
cores=$(nproc)
export PRIORMAP_JOBS="${PRIORMAP_JOBS:-$((memory_jobs < 1 ? 1 : memory_jobs < cores ? memory_jobs : cores))}"
