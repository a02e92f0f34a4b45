#include "xml_reader.hpp"

#include <expat.h>

#include <algorithm>
#include <memory>

#include <priormap/core/error.hpp>

#include "byte_source.hpp"
#include "xml_encoding.hpp"

namespace priormap {
namespace {

constexpr std::size_t max_token = std::size_t{16} << 20;

std::string fault(XML_Error code) {
  const std::string words = XML_ErrorString(code);
  switch (code) {
    case XML_ERROR_NO_ELEMENTS:
    case XML_ERROR_UNCLOSED_TOKEN:
    case XML_ERROR_UNCLOSED_CDATA_SECTION:
    case XML_ERROR_PARTIAL_CHAR: return "the file ends too early (" + words + "); fetch it again";
    default: return words;
  }
}

int XMLCALL fill_table(void* fault_of_reader, const XML_Char* name, XML_Encoding* encoding) {
  const std::optional<SingleByteTable> table = single_byte_table(name);
  if (!table) {
    *static_cast<std::string*>(fault_of_reader) = encoding_fault(name);
    return XML_STATUS_ERROR;
  }
  std::ranges::copy(*table, encoding->map);
  return XML_STATUS_OK;
}

}  // namespace

void XmlReader::run() {
  const std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)> parser(XML_ParserCreate(nullptr), &XML_ParserFree);
  parser_ = parser.get();
  XML_SetUserData(parser_, this);
  XML_SetElementHandler(
      parser_,
      [](void* self, const char* name, const char** attributes) {
        if (auto* reader = static_cast<XmlReader*>(self); !reader->is_stopped()) reader->start(name, attributes);
      },
      [](void* self, const char*) {
        if (auto* reader = static_cast<XmlReader*>(self); !reader->is_stopped()) reader->end();
      });
  XML_SetCharacterDataHandler(parser_, [](void* self, const char* text, int length) {
    if (auto* reader = static_cast<XmlReader*>(self); !reader->is_stopped()) reader->characters({text, static_cast<std::size_t>(length)});
  });
  XML_SetEntityDeclHandler(parser_, [](void* self, const char*, int, const char*, int, const char*, const char*, const char*, const char*) {
    static_cast<XmlReader*>(self)->stop("entity declarations are refused");
  });
  XML_SetUnknownEncodingHandler(parser_, fill_table, &cause_);

  ByteSource bytes(file_);
  constexpr int chunk = 1 << 16;
  std::size_t fed = 0;
  for (bool last = false; !last;) {
    char* buffer = static_cast<char*>(XML_GetBuffer(parser_, chunk));
    if (!buffer) throw FormatError(file_, "too large to parse");
    const std::size_t n = bytes.read({buffer, chunk});
    last = n < chunk;
    fed += n;
    if (XML_ParseBuffer(parser_, static_cast<int>(n), last) != XML_STATUS_OK) fail();
    if (fed > max_token && static_cast<std::size_t>(std::max<XML_Index>(0, XML_GetCurrentByteIndex(parser_))) < fed - max_token) {
      stop("a single tag of more than 16 MB");
      fail();
    }
  }
}

void XmlReader::fail() const {
  throw FormatError(file_, "line " + std::to_string(XML_GetCurrentLineNumber(parser_)) + ": " + (cause_.empty() ? fault(XML_GetErrorCode(parser_)) : cause_));
}

void XmlReader::stop(std::string cause) {
  if (cause_.empty()) cause_ = std::move(cause);
  XML_StopParser(parser_, XML_FALSE);
}

}  // namespace priormap
