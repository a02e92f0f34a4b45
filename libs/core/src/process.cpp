#include <priormap/core/process.hpp>

#include <elf.h>
#include <link.h>
#include <malloc.h>

#include <cstring>
#include <fstream>
#include <string>

namespace priormap {
namespace {

std::string hex(const unsigned char* bytes, std::size_t count) {
  constexpr const char* digits = "0123456789abcdef";
  std::string text;
  for (std::size_t i = 0; i < count; ++i) text += {digits[bytes[i] >> 4], digits[bytes[i] & 15]};
  return text;
}

/// Of one segment of notes: header, name and description, each padded to 4 bytes.
std::string build_id_among(const unsigned char* note, std::size_t size) {
  const auto padded = [](std::size_t n) { return (n + 3) / 4 * 4; };
  ElfW(Nhdr) head;
  while (size >= sizeof head) {
    std::memcpy(&head, note, sizeof head);
    const std::size_t description = sizeof head + padded(head.n_namesz), length = description + padded(head.n_descsz);
    if (length > size) break;
    if (head.n_type == NT_GNU_BUILD_ID && head.n_namesz == 4 && std::memcmp(note + sizeof head, "GNU", 4) == 0) return hex(note + description, head.n_descsz);
    note += length;
    size -= length;
  }
  return {};
}

int first_program(dl_phdr_info* program, std::size_t, void* result) {
  auto& id = *static_cast<std::string*>(result);
  for (int i = 0; i < program->dlpi_phnum && id.empty(); ++i) {
    const auto& segment = program->dlpi_phdr[i];
    if (segment.p_type == PT_NOTE) id = build_id_among(reinterpret_cast<const unsigned char*>(program->dlpi_addr + segment.p_vaddr), segment.p_memsz);
  }
  return 1;   // the program itself comes first; its libraries do not count
}

}  // namespace

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

void return_freed_memory() {
#ifdef __GLIBC__
  ::malloc_trim(0);
#endif
}

std::string build_id() {
  std::string id;
  ::dl_iterate_phdr(first_program, &id);
  return id;
}

}  // namespace priormap
