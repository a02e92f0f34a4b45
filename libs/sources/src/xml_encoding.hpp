#pragma once
#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace priormap {

/// The code point of each byte, -1 where the encoding has none.
using SingleByteTable = std::array<int, 256>;

/// The table of an encoding of one byte a character that keeps ASCII (windows-1252, ISO-8859-15, KOI8-R, ...), under any name that iconv knows. Nothing for others.
std::optional<SingleByteTable> single_byte_table(const std::string& encoding);

/// What the declaration of an XML file names, where expat by itself does not know it (it knows UTF-8, UTF-16, ISO-8859-1 and US-ASCII); else empty.
/// @param start  of the file
std::string foreign_xml_encoding(std::string_view start);

/// What to do about an encoding without a table.
std::string encoding_fault(const std::string& encoding);

}  // namespace priormap
