#pragma once
#include <cstdint>
#include <string>

namespace priormap {

/// VmHWM less clean file-mapped pages (RssFile) of this process, in bytes; 0 where /proc is absent.
std::uint64_t peak_memory_bytes();

/// Gives freed memory back to the system, as after a stage whose data the next one does not need: what one thread's allocator keeps, others cannot use.
void return_freed_memory();

/// The GNU build ID of the running program in hex: another build, another one. Empty where the linker gave none.
std::string build_id();

}  // namespace priormap
