# Sourced by the examples.
say() { printf '\n--- %s\n' "$*"; }

# Field "crs" of a simulated drive's truth.
drive_crs() { sed -n 's/^ *"crs": *"\([^"]*\)".*/\1/p' "$1/truth/frame.json"; }
