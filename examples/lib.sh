# Sourced by the examples.
say() { printf '\n--- %s\n' "$*"; }

# Field "crs" of a simulated drive's truth.
drive_crs() { sed -n 's/^ *"crs": *"\([^"]*\)".*/\1/p' "$1/truth/frame.json"; }

# First true pose of a simulated drive in its CRS, moved by 0.5 m: a start as a user would give it.
start_beside_truth() {
  awk -F, 'NR == 1 { for (i = 1; i <= NF; ++i) column[$i] = i; next }
    { printf "%.3f,%.3f,%s,%s,%s,%s,%s\n", $column["x_m"] + 0.4, $column["y_m"] - 0.3, $column["z_m"], $column["qx"], $column["qy"], $column["qz"], $column["qw"]; exit }' \
    "$1/truth/trajectory.csv"
}
