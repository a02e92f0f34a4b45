#include <priormap/simulation/random.hpp>

#include <cmath>
#include <numbers>

namespace priormap {
namespace {

constexpr std::uint64_t increment = 0x9e3779b97f4a7c15u;

std::uint64_t mix(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

}  // namespace

Random::Random(std::uint64_t seed, std::initializer_list<std::uint64_t> stream) : state_(mix(seed + increment)) {
  for (const std::uint64_t part : stream) state_ = mix(state_ + increment * (part + 1));
}

std::uint64_t Random::next() { return mix(state_ += increment); }

double Random::uniform() { return static_cast<double>(next() >> 11) * 0x1.0p-53; }

double Random::normal() {
  const double radius = std::sqrt(-2 * std::log(1 - uniform()));
  return radius * std::cos(2 * std::numbers::pi * uniform());
}

float Random::quick_normal() {
  const std::uint64_t bits = next();
  const auto sum = static_cast<float>((bits & 0xffff) + ((bits >> 16) & 0xffff) + ((bits >> 32) & 0xffff) + (bits >> 48));
  // Four uniforms on 0 ... 65535: mean 131070, variance (65536^2 - 1) / 3.
  return (sum - 131070.0f) / 37837.2f;
}

}  // namespace priormap
