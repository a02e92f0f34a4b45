#include "datasets/file_numbers.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <functional>

namespace priormap {
namespace {

namespace fs = std::filesystem;

std::size_t digits_begin(const std::string& stem) {
  return static_cast<std::size_t>(std::find_if(stem.rbegin(), stem.rend(), [](unsigned char c) { return !std::isdigit(c); }).base() - stem.begin());
}

}  // namespace

std::vector<std::uint64_t> file_numbers(std::span<const fs::path> files) {
  std::vector<std::uint64_t> numbers;
  std::string common;
  for (const fs::path& file : files) {
    const std::string stem = file.stem().string();
    const std::size_t begin = digits_begin(stem);
    if (numbers.empty()) common = stem.substr(0, begin);
    std::uint64_t number = 0;
    const auto [end, error] = std::from_chars(stem.data() + begin, stem.data() + stem.size(), number);
    if (error != std::errc() || stem.substr(0, begin) != common) return {};
    numbers.push_back(number);
  }
  if (!std::ranges::is_sorted(numbers, std::ranges::less_equal())) return {};
  std::size_t num_one_apart = 0;
  for (std::size_t i = 1; i < numbers.size(); ++i) num_one_apart += numbers[i] - numbers[i - 1] == 1;
  return 2 * num_one_apart + 1 >= numbers.size() ? numbers : std::vector<std::uint64_t>();
}

MissingFiles missing_files(std::span<const fs::path> files) {
  const std::vector<std::uint64_t> numbers = file_numbers(files);
  const auto before_gap = std::ranges::adjacent_find(numbers, [](std::uint64_t a, std::uint64_t b) { return b - a > 1; });
  if (before_gap == numbers.end()) return {};
  const std::string name = files[static_cast<std::size_t>(before_gap - numbers.begin())].filename().string(), stem = fs::path(name).stem().string();
  const std::size_t begin = digits_begin(stem);
  std::string number = std::to_string(*before_gap + 1);
  if (const std::size_t length = stem.size() - begin; number.size() < length) number.insert(0, length - number.size(), '0');
  return {numbers.back() - numbers.front() + 1 - numbers.size(), stem.substr(0, begin) + number + name.substr(stem.size())};
}

}  // namespace priormap
