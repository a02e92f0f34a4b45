#pragma once
#include <filesystem>
#include <string>

namespace priormap {

/// SHA-256 of a file's bytes; of a folder (a file geodatabase) the names and bytes of its files, but for the locks that readers leave; of the name of what is neither
/// (a /vsi... path, a database).
std::string content_hash(const std::filesystem::path& path);

}  // namespace priormap
