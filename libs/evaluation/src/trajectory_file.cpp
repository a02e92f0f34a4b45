#include <priormap/evaluation/trajectory_file.hpp>

#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <span>

#include "crs_beside.hpp"
#include "oxts.hpp"
#include "text_rows.hpp"
#include <priormap/core/error.hpp>

namespace priormap {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& file, const TextRow& row, const std::string& cause) {
  throw FormatError(file, "line " + std::to_string(row.line) + ": " + cause);
}

/// What to do about a row with too few values: a last one was cut.
std::string if_cut(const TextRow& row, std::span<const TextRow> rows) { return &row == &rows.back() ? "; the file may end too early: fetch or copy it again" : ""; }

Eigen::Isometry3d pose_of(const Eigen::Vector3d& position, double qx, double qy, double qz, double qw, const fs::path& file, const TextRow& row) {
  const Eigen::Quaterniond q(qw, qx, qy, qz);
  constexpr double written_coarsely = 1e-2;
  if (!(std::abs(q.norm() - 1) < written_coarsely)) fail(file, row, "the quaternion qx qy qz qw is not of unit length");
  return Eigen::Translation3d(position) * q.normalized();
}

std::int64_t index_of(double value, const fs::path& file, const TextRow& row) {
  constexpr double largest_exact = 9007199254740992;   // 2^53
  if (value != std::floor(value) || std::abs(value) > largest_exact) fail(file, row, "the index is no whole number");
  return static_cast<std::int64_t>(value);
}

std::vector<double> numbers_of(const fs::path& file, const TextRow& row) {
  std::vector<double> numbers;
  for (const std::string_view field : split(row.text, ' ')) {
    const std::optional<double> value = number(field);
    if (!value || !std::isfinite(*value)) fail(file, row, "'" + std::string(field.substr(0, 40)) + "' is no finite number");
    numbers.push_back(*value);
  }
  return numbers;
}

Trajectory read_tum(const fs::path& file, std::span<const TextRow> rows) {
  Trajectory trajectory;
  for (const TextRow& row : rows) {
    const std::vector<double> n = numbers_of(file, row);
    if (n.size() != 8) fail(file, row, std::to_string(n.size()) + " numbers instead of TUM's 8 (t x y z qx qy qz qw)" + (n.size() < 8 ? if_cut(row, rows) : ""));
    trajectory.stamps_s.push_back(n[0]);
    trajectory.poses.push_back(pose_of({n[1], n[2], n[3]}, n[4], n[5], n[6], n[7], file, row));
  }
  return trajectory;
}

Trajectory read_kitti(const fs::path& file, std::span<const TextRow> rows) {
  Trajectory trajectory;
  for (const TextRow& row : rows) {
    std::vector<double> n = numbers_of(file, row);
    if (n.size() == 13) {
      trajectory.indices.push_back(index_of(n[0], file, row));
      n.erase(n.begin());
    } else {
      trajectory.indices.push_back(static_cast<std::int64_t>(trajectory.size()));
    }
    if (n.size() != 12) fail(file, row, std::to_string(n.size()) + " numbers instead of KITTI's 12 (a 3x4 matrix), or 13 with the index first");
    const Eigen::Matrix<double, 3, 4> matrix = Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(n.data());
    const Eigen::Matrix3d R = matrix.leftCols<3>();
    constexpr double written_coarsely = 1e-2;
    if (!(R.transpose() * R).isIdentity(written_coarsely) || R.determinant() < 0) fail(file, row, "the first three columns are no rotation");
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.matrix().topRows<3>() = matrix;
    trajectory.poses.push_back(pose);
  }
  return trajectory;
}

/// The columns of a csv by their names.
class Header {
 public:
  explicit Header(const TextRow& row) {
    const std::vector<std::string_view> names = split(row.text, ',');
    for (std::size_t i = 0; i < names.size(); ++i) column_of_.emplace(names[i], i);
    width_ = names.size();
  }
  std::size_t width() const { return width_; }
  bool has(std::span<const std::string_view> names) const {
    for (const std::string_view name : names)
      if (!column_of_.contains(name)) return false;
    return true;
  }
  std::size_t column(std::string_view name) const { return column_of_.find(name)->second; }
  std::optional<std::size_t> first_of(std::string_view name, std::string_view other) const {
    for (const std::string_view n : {name, other})
      if (column_of_.contains(n)) return column(n);
    return std::nullopt;
  }

 private:
  std::map<std::string_view, std::size_t> column_of_;
  std::size_t width_ = 0;
};

constexpr std::array<std::string_view, 7> grid_columns{"east_m", "north_m", "height_m", "grid_qx", "grid_qy", "grid_qz", "grid_qw"};
constexpr std::array<std::string_view, 7> pose_columns{"x_m", "y_m", "z_m", "qx", "qy", "qz", "qw"};
constexpr std::array<std::string_view, 6> oxts_columns{"lat_deg", "lon_deg", "alt_m", "roll_rad", "pitch_rad", "yaw_rad"};
constexpr std::array<std::string_view, 2> lon_lat_columns{"lon_deg", "lat_deg"};

/// The fields of one line; numbers by column.
class CsvLine {
 public:
  CsvLine(const fs::path& file, const TextRow& row, std::span<const TextRow> rows, std::size_t width) : file_(file), row_(row), fields_(split(row.text, ',')) {
    if (fields_.size() != width)
      fail(file, row, std::to_string(fields_.size()) + " fields under a header of " + std::to_string(width) + (fields_.size() < width ? if_cut(row, rows) : ""));
  }
  double at(std::size_t column) const {
    const std::optional<double> value = number(fields_[column]);
    if (!value || !std::isfinite(*value)) fail(file_, row_, "'" + std::string(fields_[column].substr(0, 40)) + "' is no finite number");
    return *value;
  }

 private:
  const fs::path& file_;
  const TextRow& row_;
  std::vector<std::string_view> fields_;
};

Trajectory read_csv(const fs::path& file, std::span<const TextRow> rows, const std::string& default_crs) {
  const Header header(rows.front());
  const std::optional<std::string> declared = crs_beside(file);
  const std::string crs = declared.value_or(default_crs);
  const bool on_grid = header.has(grid_columns) && !crs.empty();
  const bool oxts = !on_grid && !header.has(pose_columns);
  if (oxts && !header.has(oxts_columns))
    throw FormatError(file, header.has(grid_columns) ? "holds projected coordinates, but their CRS is not known; give it with --crs"
                                                     : "its header has no poses (x_m,y_m,z_m,qx,qy,qz,qw or lat_deg,lon_deg,alt_m,roll_rad,pitch_rad,yaw_rad)");
  if (!declared && !on_grid && !oxts && crs.empty() && !header.has(grid_columns) && header.has(lon_lat_columns))
    throw CrsError(file.string() + ": holds georeferenced poses, but no CRS stands in run.json or frame.json beside it; give it with --crs");

  const auto index = header.first_of("index", "frame");
  const auto stamp = header.first_of("stamp_s", "unix_time_s");
  Trajectory trajectory;
  std::vector<OxtsPose> oxts_poses;
  for (const TextRow& row : rows.subspan(1)) {
    const CsvLine line(file, row, rows, header.width());
    if (index) trajectory.indices.push_back(index_of(line.at(*index), file, row));
    if (stamp) trajectory.stamps_s.push_back(line.at(*stamp));
    if (oxts) {
      const auto value = [&](std::size_t k) { return line.at(header.column(oxts_columns[k])); };
      oxts_poses.push_back({{value(0), value(1), value(2)}, value(3), value(4), value(5)});
    } else {
      const auto value = [&](std::size_t k) { return line.at(header.column(on_grid ? grid_columns[k] : pose_columns[k])); };
      trajectory.poses.push_back(pose_of({value(0), value(1), value(2)}, value(3), value(4), value(5), value(6), file, row));
    }
  }
  if (oxts) {
    if (!oxts_poses.empty()) to_utm(oxts_poses, trajectory);
  } else if (on_grid || !header.has(grid_columns)) {
    trajectory.crs = crs;
  }
  return trajectory;
}

TrajectoryFormat format_of(const fs::path& file, const TextRow& first) {
  if (first.text.find(',') != std::string_view::npos) return TrajectoryFormat::csv;
  switch (split(first.text, ' ').size()) {
    case 8: return TrajectoryFormat::tum;
    case 12:
    case 13: return TrajectoryFormat::kitti;
    default: throw FormatError(file, "its first line is neither TUM (8 numbers), nor KITTI (12 or 13), nor a csv header; see --format");
  }
}

void require_order_of_time(const fs::path& file, const Trajectory& trajectory) {
  for (std::size_t i = 1; i < trajectory.stamps_s.size(); ++i)
    if (trajectory.stamps_s[i] < trajectory.stamps_s[i - 1]) throw FormatError(file, "stamps run backwards at pose " + std::to_string(i));
}

}  // namespace

TrajectoryFormat trajectory_format(const std::string& word) {
  if (word == "auto") return TrajectoryFormat::automatic;
  if (word == "tum") return TrajectoryFormat::tum;
  if (word == "kitti") return TrajectoryFormat::kitti;
  if (word == "csv") return TrajectoryFormat::csv;
  throw UsageError("'" + word + "' is no trajectory format; it is one of auto, tum, kitti, csv");
}

Trajectory read_trajectory(const fs::path& file, TrajectoryFormat format, const std::string& default_crs) {
  const std::string text = read_text(file);
  const std::vector<TextRow> rows = text_rows(text);
  if (rows.empty()) throw FormatError(file, "holds no poses");
  if (format == TrajectoryFormat::automatic) format = format_of(file, rows.front());
  Trajectory trajectory = format == TrajectoryFormat::tum     ? read_tum(file, rows)
                          : format == TrajectoryFormat::kitti ? read_kitti(file, rows)
                                                              : read_csv(file, rows, default_crs);
  if (trajectory.poses.empty()) throw FormatError(file, "holds no poses");
  require_order_of_time(file, trajectory);
  return trajectory;
}

Eigen::Isometry3d read_kitti_calibration(const fs::path& file) {
  const std::string text = read_text(file);
  for (TextRow row : text_rows(text)) {
    for (const std::string_view key : {"Tr:", "Tr_velo_to_cam:"}) {
      if (!row.text.starts_with(key)) continue;
      row.text.remove_prefix(key.size());
      return read_kitti(file, std::span(&row, 1)).poses.front();
    }
  }
  throw FormatError(file, "has no line 'Tr:' (velodyne to camera 0)");
}

void camera_to_velodyne(Trajectory& trajectory, const Eigen::Isometry3d& T_cam0_velodyne) {
  for (Eigen::Isometry3d& pose : trajectory.poses) pose = T_cam0_velodyne.inverse() * pose * T_cam0_velodyne;
}

}  // namespace priormap
