# Every program explains itself, and has a man page that names every option of its --help.
version=$(sed -n 's/.*version = "\(.*\)".*/\1/p' "$PRIORMAP_SOURCE/libs/core/include/priormap/core/version.hpp")
for folder in "$PRIORMAP_SOURCE"/tools/*/; do
  tool=$(basename "$folder")
  succeeds "$tool" --version
  expect_in stdout "$tool $version"
  succeeds "$tool" --help
  [ ! -s stderr ] || die "$tool --help wrote to stderr"
  page="$PRIORMAP_SOURCE/docs/man/$tool.1.md"
  [ -f "$page" ] || die "docs/man/$tool.1.md is missing"
  grep -oE -- '(^|[ ,])--[a-z][a-z0-9-]+' stdout | tr -d ' ,' | sort -u >options
  while read -r option; do
    grep -qE -- "$option\b" "$page" || die "docs/man/$tool.1.md does not describe $option"
  done <options
done
