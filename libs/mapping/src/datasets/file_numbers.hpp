#pragma once
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace priormap {

/// What the names of scans count by, as 000030.bin and frame_30.pcd do. Ascending; empty where names do not end in digits after the same text, or where most of them are not one apart, as
/// times of clocks are not.
std::vector<std::uint64_t> file_numbers(std::span<const std::filesystem::path> files);

/// Numbers between the first and the last of a recording for which there is no file.
struct MissingFiles {
  std::uint64_t count = 0;
  std::string first;   ///< as it would be called
};

MissingFiles missing_files(std::span<const std::filesystem::path> files);

}  // namespace priormap
