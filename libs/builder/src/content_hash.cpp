#include "content_hash.hpp"

#include <algorithm>
#include <vector>

#include <priormap/core/hash.hpp>

namespace priormap {
namespace {

std::string sha256_folder(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.is_regular_file() && entry.path().extension() != ".lock") files.push_back(entry.path().lexically_relative(folder));
  std::ranges::sort(files);
  Sha256 hash;
  for (const std::filesystem::path& file : files) hash.update(file.generic_string() + " " + sha256_file(folder / file) + "\n");
  return hash.hex_digest();
}

}  // namespace

std::string content_hash(const std::filesystem::path& path) {
  if (std::filesystem::is_directory(path)) return sha256_folder(path);
  if (std::filesystem::is_regular_file(path)) return sha256_file(path);
  Sha256 hash;
  hash.update(path.string());
  return hash.hex_digest();
}

}  // namespace priormap
