// Runs a fuzz target over a corpus without libFuzzer, and over each of its files cut short and with single bytes changed.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

using Bytes = std::vector<std::uint8_t>;

void run(const Bytes& bytes) { LLVMFuzzerTestOneInput(bytes.data(), bytes.size()); }

void run_with_variations(Bytes bytes) {
  run(bytes);
  constexpr std::size_t variations = 64;
  const std::size_t step = bytes.size() / variations + 1;
  for (std::size_t i = 0; i < bytes.size(); i += step) {
    run({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(i)});
    for (const std::uint8_t flip : {0x01, 0x80, 0xff}) {
      bytes[i] ^= flip;
      run(bytes);
      bytes[i] ^= flip;
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::size_t files = 0;
  for (int i = 1; i < argc; ++i) {
    std::vector<std::filesystem::path> paths;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(argv[i]))
      if (entry.is_regular_file()) paths.push_back(entry.path());
    std::sort(paths.begin(), paths.end());
    for (const auto& path : paths) {
      std::ifstream stream(path, std::ios::binary);
      run_with_variations({std::istreambuf_iterator<char>(stream), {}});
      ++files;
    }
  }
  std::printf("%zu files replayed, each cut short and with bytes changed\n", files);
  return files > 0 ? 0 : 1;
}
