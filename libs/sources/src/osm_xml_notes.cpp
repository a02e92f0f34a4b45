#include "osm_xml_notes.hpp"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <osmium/io/file.hpp>
#include <sstream>
#include <string_view>

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
  if (osmium::io::File(file.string()).format() == osmium::io::file_format::xml) NotesReader(file, notes).run();
  notes.remark = on_one_line(notes.remark);
  return notes;
}

}  // namespace priormap
