# A project that finds the installed package builds and runs against its libraries, headers and targets alone.
succeeds cmake --install "$PRIORMAP_BUILD" --prefix "$PWD/installed"
for tool in "$PRIORMAP_SOURCE"/tools/*/; do
  [ -x "installed/bin/$(basename "$tool")" ] || die "$(basename "$tool") is not installed"
  page="installed/share/man/man1/$(basename "$tool").1"
  expect_in "$page" ".SH SYNOPSIS"
  expect_in "$page" "\\-\\-config FILE"
  command -v groff >/dev/null || continue
  succeeds groff -man -Tutf8 -ww -z "$page"
  [ ! -s stderr ] || die "groff warns of $page"
done
for file in README.md CHANGELOG.md LICENSE NOTICE docs/file-formats.md; do
  cmp -s "installed/share/doc/priormap/$file" "$PRIORMAP_SOURCE/$file" || die "$file is not installed"
done
flags=${PRIORMAP_SANITIZE:+-fsanitize=$PRIORMAP_SANITIZE}
succeeds cmake -S "$CASE/project" -B build -G Ninja -DCMAKE_CXX_COMPILER="$PRIORMAP_CXX" -DCMAKE_PREFIX_PATH="$PWD/installed" -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS="$flags"
succeeds cmake --build build
succeeds build/consumer
expect_in stdout "scale above 1 at height: yes"
