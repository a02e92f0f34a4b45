#include <priormap/core/process.hpp>

#include <fstream>
#include <string>

namespace priormap {

std::uint64_t peak_memory_bytes() {
  std::ifstream status("/proc/self/status");
  std::string line;
  std::uint64_t peak_kib = 0, file_kib = 0;
  while (std::getline(status, line)) {
    if (line.starts_with("VmHWM:")) peak_kib = std::stoull(line.substr(6));
    if (line.starts_with("RssFile:")) file_kib = std::stoull(line.substr(8));
  }
  return peak_kib > file_kib ? (peak_kib - file_kib) * 1024 : 0;
}

}  // namespace priormap
