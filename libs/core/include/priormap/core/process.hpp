#pragma once
#include <cstdint>

namespace priormap {

/// VmHWM less clean file-mapped pages (RssFile) of this process, in bytes; 0 where /proc is absent.
std::uint64_t peak_memory_bytes();

}  // namespace priormap
