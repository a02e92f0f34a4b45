# Links between the documents lead somewhere, in the source tree and where they are installed.
succeeds cmake --install "$PRIORMAP_BIN/.." --prefix "$PWD/installed" --component documentation
check_links() {
  local page link
  while read -r page; do
    for link in $(grep -o '](\([^)#]*\)' "$page" | sed 's/^](//'); do
      case $link in *://*) continue ;; esac
      [ -e "$(dirname "$page")/$link" ] || die "$page: $link is not there"
    done
  done < <(find "$@" -name '*.md')
}
check_links "$PRIORMAP_SOURCE"/*.md "$PRIORMAP_SOURCE/docs" "$PRIORMAP_SOURCE/examples"
check_links installed
[ "$(find installed -name '*.1.md' | wc -l)" -eq "$(ls "$PRIORMAP_SOURCE/tools" | grep -cv CMakeLists)" ] || die "pages are missing"
