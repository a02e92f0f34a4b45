// Prints what register_drive gives on the machine that it was compiled for, one registration a line: pose (12), information (36), correspondences.
#include <cstdio>

#include "street_drive.hpp"

int main() {
  using namespace priormap;
  for (const street::Registered& r : street::register_drive()) {
    for (int i = 0; i < 12; ++i) std::printf("%.17g ", r.T_map_scan(i / 4, i % 4));
    for (int i = 0; i < 36; ++i) std::printf("%.17g ", r.information(i / 6, i % 6));
    std::printf("%.17g\n", r.correspondences);
  }
}
