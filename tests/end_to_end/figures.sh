# Figures of `evaltraj --json` in ./stdout.
figure() { awk -v key="\"$1\":" '$1 == key { sub(/,$/, "", $2); print $2; exit }' stdout; }   # the first one of that name: ATE's before RPE's
below() { awk -v value="$2" -v bound="$3" 'BEGIN { exit !(value + 0 == value && value < bound) }' || die "$1 is $2, not below $3"; }
