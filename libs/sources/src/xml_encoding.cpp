#include "xml_encoding.hpp"

#include <expat.h>
#include <iconv.h>

#include <cerrno>
#include <memory>

namespace priormap {
namespace {

class Converter {
 public:
  explicit Converter(const std::string& encoding) : handle_(iconv_open("UTF-32LE", encoding.c_str())) {}
  ~Converter() {
    if (is_open()) iconv_close(handle_);
  }
  Converter(const Converter&) = delete;
  Converter& operator=(const Converter&) = delete;

  bool is_open() const { return handle_ != reinterpret_cast<iconv_t>(-1); }

  enum class Outcome { character, undefined, no_single_byte };
  Outcome convert(char byte, int& code_point) const {
    std::array<unsigned char, 8> out{};
    char *from = &byte, *to = reinterpret_cast<char*>(out.data());
    std::size_t from_left = 1, to_left = out.size();
    iconv(handle_, nullptr, nullptr, nullptr, nullptr);
    if (iconv(handle_, &from, &from_left, &to, &to_left) == static_cast<std::size_t>(-1)) return errno == EILSEQ ? Outcome::undefined : Outcome::no_single_byte;
    if (to_left != out.size() - 4) return Outcome::no_single_byte;   // a shift, or several characters
    code_point = static_cast<int>(out[0] | (out[1] << 8) | (out[2] << 16) | (out[3] << 24));
    return Outcome::character;
  }

 private:
  iconv_t handle_;
};

}  // namespace

std::optional<SingleByteTable> single_byte_table(const std::string& encoding) {
  const Converter converter(encoding);
  if (!converter.is_open()) return std::nullopt;
  SingleByteTable table;
  for (int byte = 0; byte < 256; ++byte) {
    int& code_point = table[static_cast<std::size_t>(byte)] = -1;
    if (converter.convert(static_cast<char>(byte), code_point) == Converter::Outcome::no_single_byte) return std::nullopt;
    const bool fits_expat = byte < 128 ? code_point == byte : code_point <= 0xffff;
    if (!fits_expat) return std::nullopt;
  }
  return table;
}

std::string foreign_xml_encoding(std::string_view start) {
  const std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)> parser(XML_ParserCreate(nullptr), &XML_ParserFree);
  std::string foreign;
  XML_SetUnknownEncodingHandler(
      parser.get(),
      [](void* name_of_it, const XML_Char* name, XML_Encoding*) {
        *static_cast<std::string*>(name_of_it) = name;
        return static_cast<int>(XML_STATUS_ERROR);
      },
      &foreign);
  XML_Parse(parser.get(), start.data(), static_cast<int>(start.size()), false);
  return foreign;
}

std::string encoding_fault(const std::string& encoding) {
  return "the encoding '" + encoding + "' is none that is read; write it anew in UTF-8 (iconv -f " + encoding + " -t UTF-8) and say so in its first line (encoding=\"UTF-8\")";
}

}  // namespace priormap
