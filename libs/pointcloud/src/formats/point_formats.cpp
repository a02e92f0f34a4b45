#include <priormap/pointcloud/point_formats.hpp>

#include <algorithm>
#include <array>
#include <cctype>

#include <priormap/core/error.hpp>
#include <priormap/core/output_file.hpp>
#include <priormap/pointcloud/kitti_bin.hpp>

#include "formats/georeference_file.hpp"
#include "formats/point_format.hpp"

namespace priormap {
namespace {

CloudFile read_kitti_cloud(const std::filesystem::path& file) { return {read_kitti_bin(file), {}}; }

/// The one list of formats.
const std::array<PointFormat, 5>& point_formats() {
  static const std::array<PointFormat, 5> formats = {{
      {{".las", ".laz"}, read_las_cloud, write_las_cloud, true},
      {{".pcd"}, read_pcd, write_pcd},
      {{".ply"}, read_ply, write_ply},
      {{".xyz", ".txt", ".csv"}, read_xyz, write_xyz},
      {{".bin"}, read_kitti_cloud},
  }};
  return formats;
}

/// Listed so that the reader can say what is wrong with it.
bool is_refused(const std::string& extension) { return extension == ".laz"; }

std::string extension_of(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

const PointFormat* find_format(const std::filesystem::path& file) {
  for (const PointFormat& format : point_formats())
    if (std::count(format.extensions.begin(), format.extensions.end(), extension_of(file))) return &format;
  return nullptr;
}

std::vector<std::string> list_extensions(bool writable) {
  std::vector<std::string> extensions;
  for (const PointFormat& format : point_formats())
    for (const std::string& extension : format.extensions)
      if (!is_refused(extension) && (!writable || format.write)) extensions.push_back(extension);
  return extensions;
}

/// Writes the file beside the cloud, or removes the one that belonged to the cloud replaced.
void replace_georeference(const std::filesystem::path& file, const Georeference& georeference, Overwrite overwrite) {
  if (!georeference.origin.isZero(0) || !georeference.crs.empty()) {
    AtomicFile target(file, overwrite);
    write_georeference(target.temporary_path(), georeference);
    target.commit();
  } else if (std::filesystem::exists(file)) {
    if (overwrite == Overwrite::refuse) throw IoError(file, "exists already and would move the new cloud; --overwrite removes it");
    std::filesystem::remove(file);
  }
}

std::string join(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

}  // namespace

std::filesystem::path georeference_path(const std::filesystem::path& file) { return file.string() + ".georef.json"; }

CloudFile read_point_cloud(const std::filesystem::path& file) {
  const PointFormat* format = find_format(file);
  if (!std::filesystem::exists(file)) throw IoError(file, "does not exist");
  if (!format) throw FormatError(file, "is no point cloud that priormap reads; known are " + join(readable_cloud_extensions()));
  CloudFile cloud = format->read(file);
  if (format->holds_georeference) return cloud;
  if (const auto georeference = read_georeference(georeference_path(file))) {
    cloud.points.origin += georeference->origin;
    cloud.crs = georeference->crs;
  }
  return cloud;
}

void write_point_cloud(const std::filesystem::path& file, const PointCloud& points, const CloudWriteOptions& options) {
  const PointFormat* format = find_format(file);
  if (!format || !format->write || is_refused(extension_of(file)))
    throw UsageError(file.string() + ": point clouds are written as " + join(writable_cloud_extensions()));
  points.check_columns();

  AtomicFile target(file, options.overwrite);
  OutputFile out(target.temporary_path());
  format->write(out, points, options);
  out.close();
  if (!format->holds_georeference) replace_georeference(georeference_path(file), {points.origin, options.crs}, options.overwrite);
  target.commit();
}

const std::vector<std::string>& readable_cloud_extensions() {
  static const std::vector<std::string> extensions = list_extensions(false);
  return extensions;
}

const std::vector<std::string>& writable_cloud_extensions() {
  static const std::vector<std::string> extensions = list_extensions(true);
  return extensions;
}

}  // namespace priormap
