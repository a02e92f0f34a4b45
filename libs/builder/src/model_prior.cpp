#include <priormap/builder/model_prior.hpp>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <sstream>

#include <priormap/builder/bbox_filter.hpp>
#include <priormap/builder/outline_prior.hpp>
#include <priormap/builder/prior_crs.hpp>
#include <priormap/core/error.hpp>
#include <priormap/pointcloud/slope.hpp>
#include <priormap/prior/prior_writer.hpp>
#include <priormap/sources/citygml_reader.hpp>
#include <priormap/sources/cityjson_reader.hpp>
#include <priormap/tessellation/sample.hpp>
#include <priormap/tessellation/triangulate.hpp>

#include "chunks.hpp"
#include "face_index.hpp"
#include "model_axes.hpp"
#include "model_faces.hpp"
#include "model_frame.hpp"
#include "model_groups.hpp"
#include "model_sight.hpp"
#include "point_buffer.hpp"
#include "report_text.hpp"
#include "visible_points.hpp"

namespace priormap {
namespace {

constexpr std::size_t batch_size = 512, batch_vertices = 2'000'000;   // what is in memory at a time: buildings, and one more than fills it

void read_models(const std::filesystem::path& file, const BuildingModelOptions& options, const BuildingModelSink& sink) {
  const std::string extension = file.extension();
  if (extension == ".json" || extension == ".jsonl" || extension == ".ndjson") return read_cityjson(file, cityjson_layout(file), options, sink);
  read_citygml(file, options, sink);
}

BuildingModelOptions reader_options(const ModelOptions& options) {
  return {options.lod > 0 ? std::optional(options.lod) : std::nullopt, options.bridges, options.vegetation};
}

PointClass class_of(ModelKind kind) {
  switch (kind) {
    case ModelKind::bridge: return PointClass::bridge;
    case ModelKind::vegetation: return PointClass::vegetation;
    case ModelKind::terrain: return PointClass::ground;
    default: return PointClass::building;
  }
}

std::size_t& count_of(ModelKind kind, ModelReport& report) {
  switch (kind) {
    case ModelKind::bridge: return report.bridges;
    case ModelKind::vegetation: return report.plants;
    case ModelKind::terrain: return report.terrain_models;
    default: return report.buildings;
  }
}

/// Of a terrain model only steps hide walls: what stands on the ground covers it, but the ground is wanted whole.
bool may_be_hidden(const ModelFace& face, ModelKind kind) { return kind != ModelKind::terrain || is_wall(face.normal.z()); }

std::vector<ModelFace> hiding_faces(std::vector<ModelFace> faces, ModelKind kind) {
  std::erase_if(faces, [&](const ModelFace& face) { return !may_be_hidden(face, kind); });
  return faces;
}

/// First pass: the CRS of the prior, and the faces of all.
class Survey {
 public:
  Survey(const PriorOptions& prior_options, const ModelOptions& model_options, const Events& events)
      : prior_options_(prior_options), model_options_(model_options), events_(events), groups_(prior_options), sight_(model_options.sight) {}
  /// Where it is known that some are strays.
  Survey(const PriorOptions& prior_options, const ModelOptions& model_options, ModelGroups groups, const Events& events)
      : prior_options_(prior_options), model_options_(model_options), events_(events), groups_(std::move(groups)), groups_are_known_(true), sight_(model_options.sight) {
    frames_ = std::make_unique<ModelFrames>(groups_.frames(events));
    groups_.leave_out_beyond(frames_->prior(), events);
  }

  void read(const HashedFile& hashed) {
    const std::string file = hashed.path.string();
    read_models(hashed.path, reader_options(model_options_), [&](BuildingModel&& model) {
      if (model.polygons.empty()) return;
      if (leaves_out(model, hashed)) {
        with_strays_.insert(file);
        return strays_.add(DiagnosticCode::far_from_the_rest, model.id, "lies far from the rest, outside the domain of the prior's CRS; left out");
      }
      if (!groups_are_known_) groups_.add(model, file);
      const std::uint32_t number = num_models_++;
      if (!frames_) frames_ = std::make_unique<ModelFrames>(prior_options_, model.srs_name, first_point(model, file), file, DecidingPlaces{}, events_);
      file_frame_.try_emplace(file, frames_->source(model, file));
      // Under, behind and through bridges and plants much is seen.
      const bool hides_views = model_options_.sight.is_active() && model.kind == ModelKind::building;
      if (!model_options_.visible_faces_only() && !hides_views) return;
      frames_->to_prior(model, file);
      Diagnostics ignored;
      std::vector<ModelFace> faces = model_faces(model, ignored);
      if (hides_views) sight_.add(faces);
      if (!model_options_.visible_faces_only() || model.kind == ModelKind::vegetation) return;
      faces_.add(number, hiding_faces(std::move(faces), model.kind));
    });
  }

  ModelGroups take_groups() { return std::move(groups_); }
  /// Far from all others, where the prior's CRS is not made for.
  bool leaves_out(const BuildingModel& model, const HashedFile& file) const { return groups_.leaves_out(model, file.path.string()); }
  bool has_strays(const HashedFile& file) const { return with_strays_.contains(file.path.string()); }
  /// What was left out, also of files that hold nothing else.
  const Diagnostics& strays() const { return strays_; }
  /// Once, after the last `read`.
  void finish() { faces_.finish(); }
  /// Once, after the last `read`. Nothing without --visible-from.
  std::optional<LineOfSight> line_of_sight() {
    return model_options_.sight.is_active() ? std::optional(sight_.finish(frames_->prior())) : std::nullopt;
  }

  const FaceIndex& faces() const { return faces_; }
  ModelFrames* frames() { return frames_.get(); }
  const ModelSourceFrame* frame_of(const HashedFile& file) const {
    const auto found = file_frame_.find(file.path.string());
    return found == file_frame_.end() ? nullptr : &found->second;
  }

 private:
  const PriorOptions& prior_options_;
  const ModelOptions& model_options_;
  const Events& events_;
  ModelGroups groups_;
  bool groups_are_known_ = false;
  std::set<std::string> with_strays_;   ///< files
  Diagnostics strays_;
  std::unique_ptr<ModelFrames> frames_;
  std::map<std::string, ModelSourceFrame> file_frame_;
  std::uint32_t num_models_ = 0;
  FaceIndex faces_;
  ModelSight sight_;
};

/// Warnings that wait until it is certain that they hold.
class HeldWarnings {
 public:
  explicit HeldWarnings(const Events& events) : events_(events) {
    held_.warning = [this](const std::string& message) { is_released_ ? events_.warn(message) : messages_.push_back(message); };
  }
  HeldWarnings(const HeldWarnings&) = delete;
  const Events& held() const { return held_; }
  void release() {
    is_released_ = true;
    for (const std::string& message : messages_) events_.warn(message);
  }

 private:
  const Events& events_;
  Events held_;
  std::vector<std::string> messages_;
  bool is_released_ = false;
};

/// Where the models lie, read for nothing else: a stray in front of them may be out of reach of its own CRS.
ModelGroups find_groups(const std::vector<HashedFile>& files, const PriorOptions& prior_options, const ModelOptions& model_options) {
  ModelGroups groups(prior_options);
  for (const HashedFile& file : files)
    read_models(file.path, reader_options(model_options), [&](const BuildingModel& model) { groups.add(model, file.path.string()); });
  return groups;
}

/// Nothing where no model lies far from the rest.
std::optional<ModelGroups> groups_with_strays(Survey& survey, const std::vector<HashedFile>& files, const PriorOptions& prior_options, const ModelOptions& model_options) {
  try {
    for (const HashedFile& file : files) survey.read(file);
    ModelGroups groups = survey.take_groups();
    return groups.finish() ? std::optional(std::move(groups)) : std::nullopt;
  } catch (const CrsError&) {
    ModelGroups groups = find_groups(files, prior_options, model_options);
    if (!groups.finish()) throw;
    return groups;
  }
}

/// The first building decides on the CRS, unless it, or another, turns out to lie far from the rest: then the rest decides, in one more pass.
/// @param warnings  live as long as the survey; released unless the first building was no guide. Where this fails they may say why
std::unique_ptr<Survey> survey_of(const std::vector<HashedFile>& files, const PriorOptions& prior_options, const ModelOptions& model_options, HeldWarnings& warnings, const Events& events) {
  try {
    auto survey = std::make_unique<Survey>(prior_options, model_options, warnings.held());
    if (auto groups = groups_with_strays(*survey, files, prior_options, model_options)) {
      survey = std::make_unique<Survey>(prior_options, model_options, std::move(*groups), events);
      for (const HashedFile& file : files) survey->read(file);
    } else {
      warnings.release();
    }
    survey->finish();
    return survey;
  } catch (...) {
    warnings.release();
    throw;
  }
}

/// One thread's way from a building in the prior's CRS to its points.
class ModelSampler {
 public:
  ModelSampler(const FaceIndex& faces, const LineOfSight* sight, const Crs& prior, const PriorOptions& prior_options, const ModelOptions& model_options, PriorWriter& writer)
      : faces_(faces), sight_(sight), bbox_(prior_options, prior), visible_only_(model_options.visible_faces_only()), model_sigma_m_(model_options.sigma_m),
        vegetation_sigma_m_(model_options.vegetation_sigma_m), writer_(writer),
        sampler_(prior_options.spacing_or(0.5)), buffer_(writer) {}

  /// @param number  of the model in the survey
  SightCounts sample(const BuildingModel& model, std::uint32_t model_number, const std::string& source_id, std::uint16_t source, Diagnostics& diagnostics) {
    const std::vector<ModelFace> faces = model_faces(model, diagnostics);
    const bool is_terrain = model.kind == ModelKind::terrain, seen_as_a_whole = sight_ && !is_terrain;   // a terrain model may cover a city: face by face
    const double sigma_m = model.kind == ModelKind::vegetation ? vegetation_sigma_m_ : model_sigma_m_;
    SightCounts counts;
    std::optional<std::uint32_t> feature;
    const auto write_collected = [&] {
      counts += for_each_visible(collected_, bbox_, sight_, LineOfSight::Skin::open, [&](const Eigen::Vector3d& p, const Eigen::Vector3d& normal) {
        if (!feature) {
          feature = is_terrain ? PointCloud::no_feature : writer_.add_feature(feature_of(model, faces, source_id, sigma_m));
          buffer_.begin(source, *feature, class_of(model.kind));
        }
        buffer_.add(p, normal, sigma_m);
      });
      collected_.clear();
    };
    for (std::uint32_t number = 0; number < faces.size(); ++number) {
      collect_points(faces[number], number, model.kind, model_number);
      if (!seen_as_a_whole) write_collected();
    }
    if (seen_as_a_whole) write_collected();
    return counts;
  }
  void flush() { buffer_.flush(); }

 private:
  void collect_points(const ModelFace& face, std::uint32_t number, ModelKind kind, std::uint32_t model_number) {
    if (face.repeated || (visible_only_ && !can_be_seen(face, kind))) return;
    points_.clear();
    normals_.clear();
    if (face.planar) {
      sampler_.sample(face.polygon, points_);
      normals_.assign(points_.size(), face.normal);
    } else {
      sampler_.sample(triangulate(face.polygon), points_, normals_);
    }
    if (visible_only_ && may_be_hidden(face, kind)) faces_.remove_hidden(model_number, face, points_, normals_);
    collected_.points.insert(collected_.points.end(), points_.begin(), points_.end());
    collected_.normals.insert(collected_.normals.end(), normals_.begin(), normals_.end());
    collected_.faces.resize(collected_.points.size(), number);
  }

  Feature feature_of(const BuildingModel& model, const std::vector<ModelFace>& faces, const std::string& source_id, double sigma_m) const {
    Feature feature;
    feature.source = source_id;
    feature.id = model.id;
    feature.height_rule = "model";
    feature.sigma_m = sigma_m;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const ModelFace& face : faces) {
      for (const Eigen::Vector3d& p : face.polygon.exterior) {
        low = std::min(low, p.z());
        high = std::max(high, p.z());
      }
    }
    feature.ground_z = low;
    feature.height_m = high - low;
    if (model.kind == ModelKind::building) feature.outline = footprint_of(faces);   // priormerge leaves out rasters inside: under a bridge there is a street
    return feature;
  }

  const FaceIndex& faces_;
  const LineOfSight* sight_;
  BboxFilter bbox_;
  bool visible_only_;
  double model_sigma_m_, vegetation_sigma_m_;
  PriorWriter& writer_;
  FaceSampler sampler_;
  PointBuffer buffer_;
  FacePoints collected_;
  std::vector<Eigen::Vector3d> points_, normals_;
};

/// Second pass: buildings in batches, each batch sampled by all threads.
class Sampling {
 public:
  Sampling(const Survey& survey, const LineOfSight* sight, ModelFrames& frames, const PriorOptions& prior_options, const ModelOptions& model_options, PriorWriter& writer, int threads)
      : survey_(survey), sight_(sight), frames_(frames), prior_options_(prior_options), model_options_(model_options), writer_(writer), threads_(threads) {}

  SightCounts read(const HashedFile& file, const std::string& source_id, std::uint16_t source, ModelReport& report) {
    SightCounts points;
    const auto finish_batch = [&] {
      std::vector<Diagnostics> diagnostics(batch_.size());
      std::vector<SightCounts> of_building(batch_.size());
      const std::uint32_t first_number = num_models_;
      num_models_ += static_cast<std::uint32_t>(batch_.size());
      for_each_chunk(
          batch_.size(), 16, threads_,
          [&] { return std::make_unique<ModelSampler>(survey_.faces(), sight_, frames_.prior(), prior_options_, model_options_, writer_); },
          [&](auto& sampler, std::size_t, std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) of_building[i] = sampler->sample(batch_[i], first_number + static_cast<std::uint32_t>(i), source_id, source, diagnostics[i]);
            sampler->flush();
          });
      for (std::size_t i = 0; i < batch_.size(); ++i) {
        report.diagnostics.merge(diagnostics[i]);
        if (of_building[i].sampled > 0) ++count_of(batch_[i].kind, report);
        points += of_building[i];
      }
      batch_.clear();
      num_vertices_ = 0;
    };
    read_models(file.path, reader_options(model_options_), [&](BuildingModel&& model) {
      if (model.unresolved_references > 0) {
        report.diagnostics.add(DiagnosticCode::unresolved_reference, model.id,
                               std::to_string(model.unresolved_references) + " references to what the file does not hold");
      }
      if (model.polygons.empty()) return;
      if (survey_.leaves_out(model, file)) return;
      report.polygons += static_cast<std::size_t>(std::ranges::count(model.polygons, false, &ModelPolygon::repeated));
      frames_.to_prior(model, file.path.string());
      for (const ModelPolygon& polygon : model.polygons) for_each_ring(polygon.polygon, [&](const Ring3& ring) { num_vertices_ += ring.size(); });
      batch_.push_back(std::move(model));
      if (batch_.size() == batch_size || num_vertices_ > batch_vertices) finish_batch();
    });
    finish_batch();
    return points;
  }

 private:
  const Survey& survey_;
  const LineOfSight* sight_;
  ModelFrames& frames_;
  const PriorOptions& prior_options_;
  const ModelOptions& model_options_;
  PriorWriter& writer_;
  int threads_;
  std::uint32_t num_models_ = 0;   ///< sampled before the batch; the survey counted in the same order
  std::vector<BuildingModel> batch_;
  std::size_t num_vertices_ = 0;     ///< of the batch
};

PriorSource source_of(const HashedFile& file, const ModelSourceFrame& frame, const PriorOptions& prior_options, const ModelOptions& model_options) {
  PriorSource source;
  const std::string extension = file.path.extension();
  source.kind = extension == ".json" || extension == ".jsonl" || extension == ".ndjson" ? "cityjson" : "citygml";
  source.id = source.kind + "-" + file.sha256.substr(0, 8);
  source.file_name = file.path.filename().string();
  source.sha256 = file.sha256;
  source.license = prior_options.license;
  source.attribution = prior_options.attribution;
  source.date = prior_options.date;
  source.crs = frame.crs_name;
  source.assumed_vertical = frame.assumed_vertical;
  source.operation = frame.operation;
  source.sigma_m = model_options.sigma_m;
  source.facts = {{"faces", model_options.faces}};
  if (model_options.lod > 0) source.facts.emplace_back("lod", std::to_string(model_options.lod));
  if (!model_options.bridges) source.facts.emplace_back("bridges", "left out");
  if (model_options.vegetation) source.facts.emplace_back("vegetation_sigma_m", (std::ostringstream() << model_options.vegetation_sigma_m).str());
  return source;
}

PriorManifest manifest_of(const Crs& prior, const PriorOptions& options, const std::vector<PriorSource>& sources, const std::string& generator) {
  PriorManifest manifest;
  manifest.crs = prior.name();
  manifest.vertical = vertical_name(prior);
  manifest.tile_size = options.tile_size_m;
  manifest.spacing_m = options.spacing_or(0.5);
  manifest.sources = sources;
  manifest.generator = generator;
  return manifest;
}

std::vector<HashedFile> files_with_models(const std::vector<HashedFile>& files, const Survey& survey, const Events& events) {
  std::vector<HashedFile> kept;
  for (const HashedFile& file : files) {
    if (survey.frame_of(file))
      kept.push_back(file);
    else if (!survey.has_strays(file))
      events.warn(file.path.string() + ": holds no building with surfaces");
  }
  return kept;
}

/// Writes the points of all files, counts in `report`, and tells each source what it gave. @param sources  as many as files
SightCounts write_models(const std::vector<HashedFile>& files, Survey& survey, const PriorOptions& prior_options, const ModelOptions& model_options, PriorWriter& writer,
                         std::vector<PriorSource>& sources, ModelReport& report, int threads) {
  const std::optional<LineOfSight> sight = survey.line_of_sight();
  Sampling sampling(survey, sight ? &*sight : nullptr, *survey.frames(), prior_options, model_options, writer, threads);
  SightCounts points;
  for (std::size_t i = 0; i < files.size(); ++i) {
    const std::size_t buildings_before = report.buildings, bridges_before = report.bridges, plants_before = report.plants;
    const SightCounts points_here = sampling.read(files[i], sources[i].id, static_cast<std::uint16_t>(i), report);
    points += points_here;
    auto& facts = sources[i].facts;
    facts.emplace_back("buildings", std::to_string(report.buildings - buildings_before));
    if (report.bridges > bridges_before) facts.emplace_back("bridges", std::to_string(report.bridges - bridges_before));
    if (report.plants > plants_before) facts.emplace_back("plants", std::to_string(report.plants - plants_before));
    std::ranges::move(sight_facts(model_options.sight, points_here), std::back_inserter(facts));
  }
  return points;
}

/// Of all models, in the prior's CRS. Reads the files once more: for what a failure says.
Bounds2 extent_of(const std::vector<HashedFile>& files, ModelFrames& frames, const ModelOptions& model_options) {
  Eigen::AlignedBox3d box;
  for (const HashedFile& file : files) {
    read_models(file.path, reader_options(model_options), [&](BuildingModel&& model) {
      if (model.polygons.empty()) return;
      frames.to_prior(model, file.path.string());
      for (ModelPolygon& polygon : model.polygons) {
        for_each_ring(polygon.polygon, [&](Ring3& ring) {
          for (const Eigen::Vector3d& p : ring) box.extend(p);
        });
      }
    });
  }
  return {box.min().x(), box.min().y(), box.max().x(), box.max().y()};
}

}  // namespace

void ModelOptions::validate() const {
  if (faces != "visible" && faces != "all") throw UsageError("--faces must be visible or all, not '" + faces + "'");
}

ModelReport build_model_prior(const std::vector<std::filesystem::path>& inputs, const PriorOptions& prior_options, const ModelOptions& model_options,
                              const std::filesystem::path& output, Overwrite overwrite, const std::string& generator, int threads, const Events& events) {
  prior_options.validate(events);
  model_options.validate();
  const std::vector<HashedFile> files = distinct_files(inputs);
  HeldWarnings warnings(events);
  const std::unique_ptr<Survey> surveyed = survey_of(files, prior_options, model_options, warnings, events);
  Survey& survey = *surveyed;
  if (!survey.frames()) throw FormatError(files.front().path, "holds no building with surfaces" + (model_options.lod > 0 ? " of LoD" + std::to_string(model_options.lod) : std::string()));
  const std::vector<HashedFile> with_models = files_with_models(files, survey, events);
  std::vector<PriorSource> sources;
  for (const HashedFile& file : with_models) sources.push_back(source_of(file, *survey.frame_of(file), prior_options, model_options));
  PriorWriter writer(output, manifest_of(survey.frames()->prior(), prior_options, sources, generator), overwrite);

  ModelReport report;
  report.diagnostics.merge(survey.strays());
  const SightCounts points = write_models(with_models, survey, prior_options, model_options, writer, sources, report, threads);
  if (report.buildings + report.bridges + report.plants + report.terrain_models == 0) {
    throw FormatError(files.front().path, prior_options.bbox.empty() ? "none of its buildings could be built"
                                                                     : "no building " + missed_by_bbox(prior_options, extent_of(with_models, *survey.frames(), model_options), survey.frames()->prior()));
  }
  if (prior_options.bbox.empty()) model_options.sight.refuse_blindness(points);   // a box may well hold nothing that is seen
  if (model_options.sight.is_active()) report.sight = points;
  writer.set_sources(sources);
  report.manifest = writer.finish(threads, events);
  return report;
}

std::string to_text(const ModelReport& report) {
  ReportText text;
  text.line("buildings", report.buildings);
  if (report.bridges > 0) text.line("bridges", report.bridges);
  if (report.plants > 0) text.line("plants", report.plants);
  text.line("polygons", report.polygons);
  text.line("terrain models", report.terrain_models);
  text.lines_of(report.manifest, report.sight);
  text.lines_of(report.diagnostics);
  return text.text();
}

}  // namespace priormap
