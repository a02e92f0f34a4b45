# Every program explains itself, and its man page holds its --help as it is now.
version=$(sed -n 's/.*version = "\(.*\)".*/\1/p' "$PRIORMAP_SOURCE/libs/core/include/priormap/core/version.hpp")
for folder in "$PRIORMAP_SOURCE"/tools/*/; do
  tool=$(basename "$folder")
  succeeds "$tool" --version
  expect_in stdout "$tool $version"
  succeeds "$tool" --help
  [ ! -s stderr ] || die "$tool --help wrote to stderr"
  page="$PRIORMAP_SOURCE/docs/man/$tool.1.md"
  [ -f "$page" ] || die "docs/man/$tool.1.md is missing"
  sed '1,/^<!-- --help -->$/d; /^<!-- end of --help -->$/,$d' "$page" | grep -v '^```$' >in_page
  diff -q stdout in_page >/dev/null || die "docs/man/$tool.1.md is not up to date: run docs/man/update.sh"
done
