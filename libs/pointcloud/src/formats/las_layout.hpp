#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "formats/scalar_type.hpp"

namespace priormap::las {

// Field positions and lengths of ASPRS LAS 1.4 R15.
inline constexpr std::size_t header_size_1_2 = 227, header_size_1_3 = 235, header_size_1_4 = 375;
inline constexpr std::size_t vlr_header_size = 54, evlr_header_size = 60, extra_bytes_record_size = 192;
inline constexpr std::uint16_t wkt_encoding_bit = 1 << 4;
inline constexpr std::uint16_t wkt_record = 2112, geo_keys_record = 34735, extra_bytes_record = 4;

/// Bytes of a point without its extra bytes; 0 for the formats that are not supported (4, 5, 9, 10: wave packets).
inline constexpr std::size_t base_record_length(int point_format) {
  constexpr std::array<std::size_t, 11> lengths = {20, 28, 26, 34, 0, 0, 30, 36, 38, 0, 0};
  return point_format >= 0 && point_format < 11 ? lengths[static_cast<std::size_t>(point_format)] : 0;
}
inline constexpr bool is_extended(int point_format) { return point_format >= 6; }

/// One extra value a point: its meaning in the file and its place in the record.
struct ExtraField {
  std::string name;
  ScalarType type = ScalarType::uint8;
  double scale = 1, offset = 0;
  std::optional<double> no_data;
  std::size_t position = 0;  ///< from the start of the point record
};

// Names that priormap gives its own columns.
inline constexpr std::array<std::string_view, 3> normal_names = {"NormalX", "NormalY", "NormalZ"};
inline constexpr std::string_view sigma_name = "Sigma", source_name = "Source", feature_name = "Feature", intensity_name = "Intensity",
                                  time_name = "Time";

}  // namespace priormap::las
