#!/usr/bin/env bash
# Pictures of a prior (or of a map: the same kind of folder): every point shaded by its normal, ground green, walls grey, roofs red; points
# without a normal by their height, darker below.
#   examples/render_prior.sh PRIOR PICTURE.png [ELEVATION [AZIMUTH]]     90: from above (default); 35 200: obliquely, looking to 200 degrees
# Needs gdaldem (Debian: gdal-bin).
set -euo pipefail
PATH="${PRIORMAP_BIN:-$(dirname "$0")/../build/release/bin}:$PATH"
[ $# -ge 2 ] || { sed -n '2,5s/^# *//p' "$0" >&2; exit 2; }
command -v gdaldem >/dev/null || { echo "render_prior.sh: gdaldem is not installed (Debian: apt-get install gdal-bin)" >&2; exit 1; }
prior=$1 picture=$2 elevation=${3:-90} azimuth=${4:-0}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

spacing=$(priorinfo "$prior" | awk '$1 == "spacing" { print $2 }')
priorexport "$prior" -o "$work/points.xyz" >"$work/log"

# An ASCII grid whose cells hold 1000 times the colour's number and the shade, 0 to 255, of the nearest point; twice over the points, for the extent first.
awk -v elevation="$elevation" -v azimuth="$azimuth" -v spacing="$spacing" '
  function view() {
    across = $1 * cos_a - $2 * sin_a
    away = $1 * sin_a + $2 * cos_a
    up = $3 * cos_e + away * sin_e
  }
  BEGIN {
    degree = atan2(0, -1) / 180
    cos_a = cos(azimuth * degree); sin_a = sin(azimuth * degree)
    cos_e = cos(elevation * degree); sin_e = sin(elevation * degree)
    columns = 1400
  }
  FNR == 1 {   # the header names the columns
    for (i = 2; i <= NF; ++i) column[$i] = i - 1
    nx = column["normal_x"]; ny = column["normal_y"]; nz = column["normal_z"]; class = column["classification"]
    next
  }
  { view() }
  NR == FNR {
    if (NR == 2) { west = east = across; south = north = up; low = high = $3 }
    if ($3 < low) low = $3
    if ($3 > high) high = $3
    if (across < west) west = across
    if (across > east) east = across
    if (up < south) south = up
    if (up > north) north = up
    next
  }
  FNR == 2 {
    cell = (east - west) / columns
    if (cell < 1.2 * spacing) cell = 1.2 * spacing   # no holes between the points
    columns = int((east - west) / cell) + 1
    rows = int((north - south) / cell) + 1
    zoom = columns > 900 ? 1 : int(900 / columns)
  }
  {
    pixel = int((north - up) / cell) * columns + int((across - west) / cell)
    depth = away * cos_e - $3 * sin_e
    if (pixel in nearest && nearest[pixel] <= depth) next
    nearest[pixel] = depth
    has_normal = nx && ($nx != 0 || $ny != 0 || $nz != 0)
    light = has_normal ? 0.4 * $nx - 0.5 * $ny + 0.75 * $nz : high > low ? sqrt(($3 - low) / (high - low)) : 0.7
    colour = $class == 2 ? 1 : $class != 6 ? 3 : $nz > 0.2 ? 4 : 2   # LAS classes: 2 ground, 6 building
    value[pixel] = 1000 * colour + int(90 + 165 * (light < 0 ? 0 : light > 1 ? 1 : light))
  }
  END {
    printf "ncols %d\nnrows %d\nxllcorner 0\nyllcorner 0\ncellsize 1\n", zoom * columns, zoom * rows
    for (r = 0; r < rows; ++r) {
      line = ""
      for (c = 0; c < zoom * columns; ++c) line = line " " (value[r * columns + int(c / zoom)] + 0)
      for (copy = 0; copy < zoom; ++copy) print line
    }
  }' "$work/points.xyz" "$work/points.xyz" >"$work/shades.asc"

cat >"$work/colours.txt" <<'END'
0 255 255 255
1000 0 0 0
1255 150 200 130
2000 0 0 0
2255 225 220 210
3000 0 0 0
3255 170 180 200
4000 0 0 0
4255 230 120 95
END
gdaldem color-relief -q -of PNG "$work/shades.asc" "$work/colours.txt" "$picture"
rm -f "$picture.aux.xml"
