#pragma once
#include <cstdint>

/// Names of the random streams. A number once given keeps its meaning: changing one changes every world.
namespace priormap::stream {
inline constexpr std::uint64_t relief = 1, streets = 2, lots = 3, facade = 4, trees = 5, parked_cars = 6, poles = 7, barriers = 8,
                               lawn = 9, leaves = 10, outline_error = 11, raster_noise = 12, route = 13, wobble = 14,
                               laser_bias = 15, scan = 16, initial_pose = 17, osm_building = 18, moving_cars = 19, yards = 20,
                               block_shift = 21;
}  // namespace priormap::stream
