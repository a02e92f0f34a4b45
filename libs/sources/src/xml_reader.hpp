#pragma once
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

struct XML_ParserStruct;

namespace priormap {

/// Streams an XML file, plain or compressed, by expat. Memory is bounded whatever the file holds: entity declarations and single tags of more than 16 MB are refused.
class XmlReader {
 public:
  explicit XmlReader(const std::filesystem::path& file) : file_(file) {}
  virtual ~XmlReader() = default;
  XmlReader(const XmlReader&) = delete;
  XmlReader& operator=(const XmlReader&) = delete;

  /// @throws IoError, and FormatError naming the line
  void run();

 protected:
  /// @param attributes  names and values in turn, ended by a null pointer
  virtual void start(const char* qualified_name, const char** attributes) = 0;
  virtual void end() = 0;
  /// Part of the text between tags, in UTF-8.
  virtual void characters(std::string_view text) = 0;

  /// Makes `run` throw, as soon as expat comes back, a FormatError with the first cause that was given.
  void stop(std::string cause);
  bool is_stopped() const { return !cause_.empty(); }

 private:
  [[noreturn]] void fail() const;

  const std::filesystem::path file_;
  XML_ParserStruct* parser_ = nullptr;
  std::string cause_;
};

}  // namespace priormap
