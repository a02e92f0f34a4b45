#include "osm_xml_notes.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <osmium/io/file.hpp>
#include <span>
#include <sstream>
#include <string_view>
#include <vector>

#include "byte_source.hpp"
#include "xml_reader.hpp"

namespace priormap {
namespace {

/// Of all elements only the action of objects and the text of a remark.
class NotesReader : public XmlReader {
 public:
  NotesReader(const std::filesystem::path& file, OsmXmlNotes& notes) : XmlReader(file), notes_(notes) {}

 private:
  void start(const char* name, const char** attributes) override {
    ++depth_;
    if (depth_ != object_depth) return;
    in_remark_ = std::strcmp(name, "remark") == 0 && notes_.remark.empty();
    const char *id = nullptr, *action = nullptr;
    for (const char** attribute = attributes; *attribute; attribute += 2) {
      if (std::strcmp(attribute[0], "id") == 0) id = attribute[1];
      if (std::strcmp(attribute[0], "action") == 0) action = attribute[1];
    }
    if (id && action && std::strcmp(action, "delete") == 0) note_deleted(name, id);
  }
  void end() override {
    in_remark_ = false;
    --depth_;
  }
  void characters(std::string_view text) override {
    constexpr std::size_t longest_remark = 1000;
    if (in_remark_) notes_.remark += text.substr(0, longest_remark - std::min(longest_remark, notes_.remark.size()));
  }

  void note_deleted(std::string_view type, std::string_view id) {
    std::int64_t number = 0;
    if (type != "node" && type != "way" && type != "relation") return;
    if (std::from_chars(id.data(), id.data() + id.size(), number).ec == std::errc()) notes_.deleted.emplace(type, number);
  }

  static constexpr int object_depth = 2;   // below <osm>
  OsmXmlNotes& notes_;
  int depth_ = 0;
  bool in_remark_ = false;
};

bool is_space(char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r'; }

/// As a name of its own: "attraction" holds the word too.
bool has_attribute(std::string_view text, std::string_view name) {
  for (std::size_t at = text.find(name); at != std::string_view::npos; at = text.find(name, at + 1)) {
    const std::size_t end = at + name.size();
    if (at > 0 && is_space(text[at - 1]) && end < text.size() && (text[end] == '=' || is_space(text[end]))) return true;
  }
  return false;
}

/// Whether the file holds the words without which there is nothing to note: looking for them takes a small part of the time of parsing.
bool may_hold_notes(const std::filesystem::path& file) {
  constexpr std::size_t overlap = 16;   // more than a word and what stands around it
  ByteSource bytes(file);
  std::vector<char> chunk(overlap + (std::size_t(1) << 16));
  std::size_t kept = 0;   // of the chunk before
  for (bool is_first = true, is_last = false; !is_last; is_first = false) {
    const std::size_t n = bytes.read(std::span(chunk).subspan(kept));
    const std::string_view text(chunk.data(), kept + n);
    is_last = kept + n < chunk.size();
    const bool two_bytes_a_character = is_first && text.substr(0, 4).find_first_of(std::string_view("\0\xfe\xff", 3)) != std::string_view::npos;
    if (two_bytes_a_character || text.find("<remark") != std::string_view::npos || has_attribute(text, "action")) return true;
    kept = std::min(overlap, text.size());
    std::ranges::copy(text.substr(text.size() - kept), chunk.begin());
  }
  return false;
}

/// Messages are of one line.
std::string on_one_line(const std::string& text) {
  std::istringstream words(text);
  std::string line, word;
  while (words >> word) line += (line.empty() ? "" : " ") + word;
  return line;
}

}  // namespace

OsmXmlNotes read_osm_xml_notes(const std::filesystem::path& file) {
  OsmXmlNotes notes;
  if (osmium::io::File(file.string()).format() == osmium::io::file_format::xml && may_hold_notes(file)) NotesReader(file, notes).run();
  notes.remark = on_one_line(notes.remark);
  return notes;
}

}  // namespace priormap
