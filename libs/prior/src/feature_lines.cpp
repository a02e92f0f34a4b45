#include "feature_lines.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <fstream>

#include <nlohmann/json.hpp>

#include <priormap/core/error.hpp>

namespace priormap {
namespace {

using Ring = std::vector<Eigen::Vector2d>;
using Polygon = std::vector<Ring>;

std::string json_string(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string json_number(double value) {
  if (!std::isfinite(value)) return "null";
  std::array<char, 32> text;
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

void append_fixed(std::string& out, double value, int decimals) {
  std::array<char, 48> text;
  out.append(text.data(), std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed, decimals).ptr);
}

bool is_counter_clockwise(const Ring& ring) {
  double doubled_area = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Eigen::Vector2d a = ring[i] - ring[0], b = ring[(i + 1) % ring.size()] - ring[0];
    doubled_area += a.x() * b.y() - a.y() * b.x();
  }
  return doubled_area > 0;
}

void append_ring(std::string& out, Ring ring, bool exterior, const OutlineFrame& frame) {
  if (is_counter_clockwise(ring) != exterior) std::reverse(ring.begin(), ring.end());
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector2d& p : ring) points.emplace_back(p.x(), p.y(), 0);
  if (!points.empty()) points.push_back(points.front());
  frame.to_file(points);
  out += '[';
  for (std::size_t i = 0; i < points.size(); ++i) {
    out += i == 0 ? "[" : ",[";
    append_fixed(out, points[i].x(), frame.decimals());
    out += ',';
    append_fixed(out, points[i].y(), frame.decimals());
    out += ']';
  }
  out += ']';
}

void append_polygon(std::string& out, const Polygon& polygon, const OutlineFrame& frame) {
  out += '[';
  for (std::size_t r = 0; r < polygon.size(); ++r) {
    if (r != 0) out += ',';
    append_ring(out, polygon[r], r == 0, frame);
  }
  out += ']';
}

std::string geometry_json(const std::vector<Polygon>& outline, const OutlineFrame& frame) {
  if (outline.empty()) return "null";
  std::string out = outline.size() == 1 ? R"({"type":"Polygon","coordinates":)" : R"({"type":"MultiPolygon","coordinates":[)";
  for (std::size_t i = 0; i < outline.size(); ++i) {
    if (i != 0) out += ',';
    append_polygon(out, outline[i], frame);
  }
  return out + (outline.size() == 1 ? "}" : "]}");
}

Ring ring_from(const nlohmann::json& json, const OutlineFrame& frame) {
  std::vector<Eigen::Vector3d> points;
  for (const nlohmann::json& p : json) points.emplace_back(p.at(0).get<double>(), p.at(1).get<double>(), 0);
  if (!points.empty()) points.pop_back();   // the first one again
  frame.to_prior(points);
  Ring ring;
  for (const Eigen::Vector3d& p : points) ring.emplace_back(p.head<2>());
  return ring;
}

Polygon polygon_from(const nlohmann::json& json, const OutlineFrame& frame) {
  Polygon polygon;
  for (const nlohmann::json& ring : json) polygon.push_back(ring_from(ring, frame));
  return polygon;
}

std::vector<Polygon> outline_from(const nlohmann::json& geometry, const OutlineFrame& frame) {
  std::vector<Polygon> outline;
  if (geometry.is_null()) return outline;
  const nlohmann::json& coordinates = geometry.at("coordinates");
  if (geometry.at("type") == "Polygon") {
    outline.push_back(polygon_from(coordinates, frame));
  } else {
    for (const nlohmann::json& polygon : coordinates) outline.push_back(polygon_from(polygon, frame));
  }
  return outline;
}

double number_from(const nlohmann::json& json) { return json.is_null() ? std::nan("") : json.get<double>(); }

Feature feature_from(const nlohmann::json& json, const OutlineFrame& frame) {
  const nlohmann::json& properties = json.at("properties");
  Feature feature;
  feature.source = properties.at("source");
  feature.id = properties.at("id");
  feature.height_m = number_from(properties.at("height_m"));
  feature.height_rule = properties.at("height_rule");
  feature.ground_z = number_from(properties.at("ground_z"));
  feature.sigma_m = number_from(properties.at("sigma_m"));
  feature.outline = outline_from(json.at("geometry"), frame);
  return feature;
}

}  // namespace

std::string feature_line(const Feature& feature, std::uint32_t index, const OutlineFrame& frame) {
  return R"({"type":"Feature","id":)" + std::to_string(index) + R"(,"properties":{"source":)" + json_string(feature.source) +
         R"(,"id":)" + json_string(feature.id) + R"(,"height_m":)" + json_number(feature.height_m) + R"(,"height_rule":)" +
         json_string(feature.height_rule) + R"(,"ground_z":)" + json_number(feature.ground_z) + R"(,"sigma_m":)" +
         json_number(feature.sigma_m) + R"(},"geometry":)" + geometry_json(feature.outline, frame) + "}\n";
}

void read_feature_lines(const std::filesystem::path& file, const OutlineFrame& frame,
                        const std::function<void(std::uint32_t, Feature)>& consume) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw IoError(file, "cannot be read");
  std::string line;
  for (std::uint32_t index = 0; std::getline(in, line); ++index) {
    Feature feature;
    try {
      const nlohmann::json json = nlohmann::json::parse(line);
      if (json.at("id") != index) throw FormatError("it is not numbered in order");
      feature = feature_from(json, frame);
    } catch (const nlohmann::json::exception&) {
      throw FormatError(file, "line " + std::to_string(index + 1) + " is no feature; make the prior again");
    } catch (const Error& error) {
      throw FormatError(file, "line " + std::to_string(index + 1) + " is no feature: " + error.what() + "; make the prior again");
    }
    consume(index, std::move(feature));
  }
}

}  // namespace priormap
