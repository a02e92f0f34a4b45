#pragma once
#include <cstddef>
#include <filesystem>
#include <span>

namespace priormap {

/// Creates or truncates `file` and writes all bytes. @throws IoError, on a full disk as well.
void write_bytes(const std::filesystem::path& file, std::span<const std::byte> bytes);

}  // namespace priormap
