#!/usr/bin/env bash
# Makes simulated drives and their priors, maps them and prints one row of a Markdown table per drive and preset.
#   tests/bench/drives/run.sh WORK [--cases a,b,..] [--presets default,paper] [--scans N] [--first N] [--seed N] [--bin DIR] [--keep]
# Drives are made once under WORK and taken again while their options are the same. The scans of a scored drive are deleted (1000 of a HDL-64 are
# 1.8 GB) unless --keep is given; `--presets ''` only makes the drives. Drives along KITTI 00 need $PRIORMAP_SHARED_DATA or ../shared/data.
set -euo pipefail
root=$(cd "$(dirname "$0")/../../.." && pwd)
source "$root/examples/lib.sh"

# name, path (kitti: along KITTI 00; route: along the streets), sources that the prior is made of (none: odometry), options of drivesim
all_cases() {
  sed 's/ *#.*//' <<'END'
town             kitti  osm,dsm
odometry         kitti  none
osm_only         kitti  osm,dtm                                          # buildings on a good terrain model, its points as ground
osm_10m_terrain  kitti  osm      --dsm-resolution 10 --dtm-sigma 0.5     # buildings alone, on a poor terrain
dsm_only         kitti  dsm
missing30        kitti  osm,dsm  --missing-share 0.3
outlines_1m      kitti  osm,dsm  --outline-sigma 1
shifted_block    kitti  osm,dsm  --shifted-block 3
dsm_5m           kitti  osm,dsm  --dsm-resolution 5
dsm_bias         kitti  osm,dsm  --dsm-bias -0.5
gap300           kitti  osm,dsm  --prior-gap 300
rural            kitti  osm,dsm  --rural 300
far_start        kitti  osm,dsm  --start-error 5 --start-error-yaw 10
distortion       kitti  osm,dsm  --motion-distortion
traffic          kitti  osm,dsm  --traffic-spacing 30
os1_128          kitti  osm,dsm  --sensor os1-128
rig4             kitti  osm,dsm  --sensor rig4
kidnap           kitti  osm,dsm  --kidnap-at 200 --kidnap-scans 60       # scored on the own street
kidnap_drives_on kitti  osm,dsm  --kidnap-at 200 --kidnap-scans 60 --kidnap-drives-on
hdl32            route  osm,dsm  --sensor hdl32 --speed 1.4 --mount-height 1.2 --wobble 4 --wobble-frequency 0.8   # NCLT-like
hdl32_steady     kitti  osm,dsm  --sensor hdl32
vlp16            kitti  osm,dsm  --sensor vlp16 --motion-distortion
there_and_back   route  osm,dsm  --there-and-back
END
}

die() { echo "run.sh: $*" >&2; exit 2; }

work='' cases=$(all_cases | awk '{ print $1 }' | paste -sd,) presets=default,paper scans=1000 first=0 seed=1 bin=$root/build/release/bin keep=''
while [ $# -gt 0 ]; do
  case $1 in
    --cases) cases=$2; shift ;;
    --presets) presets=$2; shift ;;
    --scans) scans=$2; shift ;;
    --first) first=$2; shift ;;
    --seed) seed=$2; shift ;;
    --bin) bin=$2; shift ;;
    --keep) keep=yes ;;
    -*) die "unknown option $1" ;;
    *) work=$1 ;;
  esac
  shift
done
[ -n "$work" ] || die "name a work folder"
[ -x "$bin/mapper" ] || die "no programs in $bin; build first or give --bin"
PATH="$(cd "$bin" && pwd):$PATH"
kitti=${PRIORMAP_SHARED_DATA:-$root/../shared/data}/poses/kitti_odometry_gt/00.txt

# Reads the numbers of an indented JSON file: figure[a.b.c].
declare -A figure
read_figures() {
  local name value
  while read -r name value; do figure[$name]=$value; done < <(awk '
    match($0, /^ *"[^"]*":/) {
      indent = match($0, /"/) - 1
      if (!unit) unit = indent
      depth = indent / unit
      split($0, words, "\"")
      key[depth] = words[2]
      name = key[1]
      for (i = 2; i <= depth; ++i) name = name "." key[i]
      sub(/^[^:]*: */, "")
      sub(/,$/, "")
      if ($0 ~ /^-?[0-9]/) print name, $0
    }' "$1")
}

# Scans that another drive has byte for byte take no second place on the disk: most cases differ in their sources alone.
share_scans() {
  local other scan
  for other in "$work"/*/drive/velodyne; do
    [ "$other" -ef "$1" ] || ! cmp -s "$other/000000.bin" "$1/000000.bin" || break
  done
  [ ! "$other" -ef "$1" ] || return 0
  for scan in "$1"/*.bin; do
    ! cmp -s "$scan" "$other/${scan##*/}" || ln -f "$other/${scan##*/}" "$scan"
  done
}

# The drive and its prior, unless they are there with these options.
make_drive() {
  local folder=$1 path=$2 sources=$3 source priors=()
  shift 3
  local options=(--seed "$seed" --scans "$scans" "$@")
  if [ "$path" = kitti ]; then
    [ -e "$kitti" ] || die "$kitti is absent; set PRIORMAP_SHARED_DATA"
    options+=(--trajectory "$kitti" --first "$first")
  fi
  [ "$(cat "$folder/made" 2>/dev/null)" != "${options[*]} $sources" ] || return 0
  rm -rf "$folder"
  mkdir -p "$folder"
  drivesim "${options[@]}" -o "$folder/drive" >"$folder/drive.log"
  share_scans "$folder/drive/velodyne"
  local crs
  crs=$(drive_crs "$folder/drive")
  for source in ${sources//,/ }; do
    case $source in
      osm) osm2prior "$folder/drive/sources/town.osm.pbf" --terrain "$folder/drive/sources/dtm.tif" --crs "$crs" -o "$folder/prior-osm" ;;
      dsm) dsm2prior "$folder/drive/sources/dsm.tif" --crs "$crs" -o "$folder/prior-dsm" ;;
      dtm) dsm2prior --kind terrain "$folder/drive/sources/dtm.tif" --crs "$crs" -o "$folder/prior-dtm" ;;
      none) continue ;;
    esac >>"$folder/drive.log"
    priors+=("$folder/prior-$source")
  done
  if [ "${#priors[@]}" -gt 0 ]; then
    priormerge "${priors[@]}" -o "$folder/prior" >>"$folder/drive.log"
    rm -rf "${priors[@]}"
  fi
  echo "${options[*]} $sources" >"$folder/made"
}

# The truth without the scans of a kidnapping: where an estimate should be is known there, but nobody can map there.
own_street() {
  awk -F, 'NR == 1 { marked = $NF == "kidnapped" } !marked || $NF != 1' "$1/trajectory.csv" >"$1/own_street.csv"
  echo "$1/own_street.csv"
}

# How many scans after a kidnapping the first is called lost, how many after its end the first is anchored.
kidnap_note() {
  awk -F, 'NR == FNR { if (FNR > 1 && $NF == 1) { if (!last) first = $1; last = $1 }; next }
           FNR == 1 { for (i = 1; i <= NF; ++i) if ($i == "verdict") v = i; next }
           $1 >= first && $v == "lost" && lost == "" { lost = $1 - first + 1 }
           $1 > last && $v == "anchored" && back == "" { back = $1 - last }
           END { if (last) printf " (lost in scan %s, anchored in scan %s after it)", lost == "" ? "none" : lost, back == "" ? "none" : back }' "$1" "$2"
}

# Maps the drive and prints its row.
score() {
  local folder=$1 name=$2 preset=$3 truth=$1/drive/truth
  local out=$folder/out-$preset against=()
  if [ -d "$folder/prior" ]; then
    mapper --preset "$preset" --scans "$folder/drive/velodyne" --prior "$folder/prior" --initial-pose "$(cat "$truth/initial_pose.txt")" \
      -o "$out" --overwrite >"$out.log"
    against=(--reference "$(own_street "$truth")" --estimate "$out/trajectory.csv")
  else
    mapper --preset "$preset" --scans "$folder/drive/velodyne" -o "$out" --overwrite >"$out.log"
    against=(--reference "$truth/poses_kitti.txt" --estimate "$out/poses_kitti.txt" --align first)
    name+=" (from the first pose)"
  fi
  evaltraj "${against[@]}" --json --quiet >"$out.json"
  name+=$(kidnap_note "$truth/trajectory.csv" "$out/trajectory.csv")
  rm -rf "$out/map"
  figure=()
  read_figures "$out.json"
  read_figures "$out/run.json"
  local scans_mapped=${figure[totals.scans]} verdict verdicts=
  for verdict in anchored weak dead-reckoned outside-prior lost; do verdicts+="/${figure[totals.verdicts.$verdict]}"; done
  printf '| %s | %s | %d | %.3f / %.3f | %.3f | %.3f, %.3f | %.1f / %.1f / %.1f | %.1f | %.0f | %s |\n' "$name" "$preset" "$scans_mapped" \
    "${figure[ate.mean_m]}" "${figure[ate.max_m]}" "${figure[ate.vertical.mean_m]}" \
    "${figure[rte.translation_percent]}" "${figure[rte.rotation_deg_per_100m]}" \
    "${figure[totals.ms_a_scan.median]}" "${figure[totals.ms_a_scan.mean]}" "${figure[totals.ms_a_scan.p95]}" \
    "$(awk -v s="${figure[totals.seconds.total]}" -v n="$scans_mapped" 'BEGIN { print s * 1000 / n }')" \
    "$(awk -v b="${figure[totals.peak_memory_bytes]}" 'BEGIN { print b / 1e6 }')" "${verdicts#/}"
}

mkdir -p "$work"
if [ -n "$presets" ]; then
  echo "| drive (seed $seed) | preset | scans | ATE mean / max [m] | vertical mean [m] | RTE [%], [deg/100 m] | ms a scan, median / mean / p95 | whole run, ms a scan | peak MB | anchored/weak/dead-reckoned/outside/lost |"
  echo "|---|---|---|---|---|---|---|---|---|---|"
fi
for name in ${cases//,/ }; do
  read -r -a row <<<"$(all_cases | awk -v name="$name" '$1 == name')"
  [ "${#row[@]}" -gt 0 ] || die "no case $name; there are: $(all_cases | awk '{ print $1 }' | paste -sd' ')"
  folder=$work/$name-seed$seed-first$first-$scans
  make_drive "$folder" "${row[@]:1}"
  for preset in ${presets//,/ }; do score "$folder" "$name" "$preset"; done
  [ -n "$keep" ] || rm -rf "$folder"
done
