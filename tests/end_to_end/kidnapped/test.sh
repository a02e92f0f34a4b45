# Scans of another street are spliced into a drive: the mapper says that it is lost there, leaves them out of the map, and goes on when the old street comes back.
succeeds drivesim --town generated --scans 60 --kidnap-at 30 --kidnap-scans 20 --seed 5 -o drive
succeeds mapper --scans drive/velodyne --no-map -o out
lost() { awk -F, -v first="$1" -v last="$2" 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i == "verdict") v = i; next } $1 >= first && $1 <= last && $v == "lost"' out/trajectory.csv | wc -l; }
[ "$(lost 30 49)" -eq 20 ] || die "only $(lost 30 49) of the 20 scans of the other street are called lost"
[ "$(lost 0 29)" -eq 0 ] || die "$(lost 0 29) scans before them are called lost"
[ "$(lost 55 79)" -eq 0 ] || die "$(lost 55 79) scans after them are called lost"
