# --index makes what is missing or damaged beside the tiles, and nothing else; the prior stays whole.
source "$PRIORMAP_SOURCE/tests/cli/make_raster_prior.sh"
make_raster_prior prior 691000 500
succeeds priorinfo prior --index
expect_in stderr "prior/lookup: made 1 of 1 files"
file=$(ls prior/lookup/*.cells)
cp "$file" first
succeeds priorinfo prior --index --threads 1
expect_in stderr "made 0 of 1"
printf '\377' | dd of="$file" bs=1 seek=3000 conv=notrunc status=none
succeeds priorinfo prior --index
expect_in stderr "made 1 of 1"
cmp "$file" first || die "the file differs"
succeeds priorinfo prior --check
rm -r prior/lookup
touch prior/lookup
fails_with 1 "prior/lookup" priorinfo prior --index
