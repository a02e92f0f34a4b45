#include "osm_xml_notes.hpp"

#include <charconv>
#include <optional>
#include <osmium/io/file.hpp>
#include <string_view>

#include "byte_source.hpp"

namespace priormap {
namespace {

bool is_readable_xml(const std::filesystem::path& file) {
  const osmium::io::File described(file.string());
  return described.format() == osmium::io::file_format::xml && described.compression() != osmium::io::file_compression::bzip2;
}

/// The value of an attribute in the text of a start tag; empty where it has none.
std::string_view attribute(std::string_view tag, std::string_view name) {
  for (std::size_t at = tag.find(name); at != std::string_view::npos; at = tag.find(name, at + 1)) {
    const std::size_t quote = at + name.size() + 1;
    if (at == 0 || tag[at - 1] != ' ' || quote >= tag.size() || tag[quote - 1] != '=' || (tag[quote] != '"' && tag[quote] != '\'')) continue;
    return tag.substr(quote + 1, tag.find(tag[quote], quote + 1) - quote - 1);
  }
  return {};
}

void note_deleted(std::string_view tag, OsmXmlNotes& notes) {
  if (attribute(tag, "action") != "delete") return;
  const std::string_view id = attribute(tag, "id");
  std::int64_t number = 0;
  if (std::from_chars(id.data(), id.data() + id.size(), number).ec == std::errc()) notes.deleted.emplace(tag.substr(1, tag.find(' ') - 1), number);
}

/// Whole elements of a file; what is rare is looked for, the rest passed over.
void note(std::string_view text, OsmXmlNotes& notes) {
  constexpr std::string_view remark = "<remark>";
  if (const std::size_t at = text.find(remark); at != std::string_view::npos && notes.remark.empty()) {
    const std::size_t first = at + remark.size();
    notes.remark = text.substr(first, text.find('<', first) - first);
  }
  constexpr std::string_view action = " action=";
  for (std::size_t at = text.find(action); at != std::string_view::npos; at = text.find(action, at + 1)) {
    const std::size_t start = text.rfind('<', at);
    if (start != std::string_view::npos) note_deleted(text.substr(start, text.find('>', start) - start), notes);
  }
}

}  // namespace

OsmXmlNotes read_osm_xml_notes(const std::filesystem::path& file) {
  OsmXmlNotes notes;
  if (!is_readable_xml(file)) return notes;
  ByteSource bytes(file);
  constexpr std::size_t chunk = std::size_t(1) << 20;
  std::string text;
  for (bool more = true; more;) {
    const std::size_t kept = text.size();
    text.resize(kept + chunk);
    const std::size_t read = bytes.read(std::span(text).subspan(kept));
    text.resize(kept + read);
    more = read == chunk;
    const std::size_t open = more ? text.rfind("\n", text.size()) : text.size();   // writers put an element and a remark on a line
    const std::size_t end = open == std::string::npos ? text.size() : open;
    note(std::string_view(text).substr(0, end), notes);
    text.erase(0, end);
  }
  return notes;
}

}  // namespace priormap
