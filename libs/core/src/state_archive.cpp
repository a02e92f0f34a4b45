#include <priormap/core/state_archive.hpp>

#include <cstring>

#include <priormap/core/error.hpp>

namespace priormap {

void StateArchive::move(void* data, std::size_t size) {
  if (size == 0) return;
  if (!reading_) {
    bytes_.append(static_cast<const char*>(data), size);
    return;
  }
  if (size > bytes_.size() - place_) refuse();
  std::memcpy(data, bytes_.data() + place_, size);
  place_ += size;
}

void StateArchive::refuse() { throw FormatError("the state is not of this program"); }

}  // namespace priormap
