#include <priormap/mapping/verdict.hpp>

namespace priormap {

std::string to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::anchored: return "anchored";
    case Verdict::weak: return "weak";
    case Verdict::dead_reckoned: return "dead-reckoned";
    case Verdict::outside_prior: return "outside-prior";
    case Verdict::lost: return "lost";
  }
  return {};
}

}  // namespace priormap
