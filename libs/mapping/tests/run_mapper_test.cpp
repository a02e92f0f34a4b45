#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>

#include <priormap/core/error.hpp>
#include <priormap/core/resumable_output.hpp>
#include <priormap/core/state_archive.hpp>
#include <priormap/mapping/run_mapper.hpp>
#include <priormap/pointcloud/point_formats.hpp>

#include "scan_folder.hpp"
#include "town.hpp"

namespace priormap {
namespace {

std::string schema_violations(const nlohmann::json& document) {
  std::ifstream file(PRIORMAP_SOURCE_DIR "/schemas/run-report.schema.json");
  const nlohmann::json schema_json = nlohmann::json::parse(file);
  valijson::Schema schema;
  valijson::SchemaParser().populateSchema(valijson::adapters::NlohmannJsonAdapter(schema_json), schema);
  valijson::ValidationResults results;
  valijson::Validator().validate(schema, valijson::adapters::NlohmannJsonAdapter(document), &results);
  std::string text;
  for (valijson::ValidationResults::Error error; results.popError(error);) {
    for (const auto& part : error.context) text += part;
    text += ": " + error.description + "\n";
  }
  return text;
}

class Run : public testing::Test {
 protected:
  Run() {
    for (int k = 0; k < 3; ++k) {
      std::vector<float> records;
      for (const auto& p : test::scan_from(10, test::pose(1.2 * k, 0, 1.7, 0), static_cast<std::size_t>(k)).points.xyz)
        records.insert(records.end(), {p.x(), p.y(), p.z(), 0.5f});
      test::write_raw(folder_.path() / "scans" / (std::to_string(k) + ".bin"), records);
    }
    PointCloud prior;
    for (const auto& p : test::street(10, 1)) prior.xyz.push_back(p.cast<float>());
    write_point_cloud(folder_.path() / "prior.ply", prior);
    options_.preset = "paper";
    options_.scans = folder_.path() / "scans";
    options_.output = folder_.path() / "out";
  }

  nlohmann::json report() const {
    std::ifstream file(options_.output / "run.json");
    return nlohmann::json::parse(file);
  }

  const test::Folder folder_;
  RunOptions options_;
};

TEST_F(Run, OdometryReportHoldsItsSchema) {
  options_.no_map = true;
  run_mapper(options_, 1, Overwrite::refuse, {});
  EXPECT_EQ(schema_violations(report()), "");
  EXPECT_EQ(report()["scans"].size(), 3u);
}

TEST_F(Run, GeoreferencedReportHoldsItsSchema) {
  options_.prior = folder_.path() / "prior.ply";
  options_.prior_options = {"EPSG:25832+7837", {640000, 5359000, 490}, ""};
  options_.initial.pose = {640000.2, 5359000, 491.7, 0, 0, 0, 1};
  const RunSummary summary = run_mapper(options_, 1, Overwrite::refuse, {}).value();
  EXPECT_EQ(schema_violations(report()), "");
  EXPECT_EQ(summary.num_anchored, 3u) << report()["scans"].dump();
  EXPECT_EQ(report()["totals"]["map_points"], summary.num_map_points);
  EXPECT_GT(summary.num_map_points, 1000u);
  // UTM zone 32 near 10.89 E: grid north lies 1.41 degrees clockwise of true north, a metre of map is 0.99977 m of grid.
  EXPECT_NEAR(report()["frame"]["grid_rotation_deg"], 1.41, 0.02);
  EXPECT_NEAR(report()["frame"]["grid_scale"], 0.99977, 2e-5);
}

TEST_F(Run, AStartFarAboveThePriorsGroundIsBlamedOnHeights) {
  std::string warnings;
  const Events events{[&](const std::string& message) { warnings += message + "\n"; }, {}, {}};
  options_.no_map = true;
  options_.prior = folder_.path() / "prior.ply";
  options_.initial.pose = {640000.2, 5359000, 491.7, 0, 0, 0, 1};
  options_.prior_options = {"EPSG:25832+7837", {640000, 5359000, 490}, ""};
  run_mapper(options_, 1, Overwrite::refuse, events);
  EXPECT_EQ(warnings, "");
  options_.prior_options = {"EPSG:25832", {640000, 5359000, 0}, ""};   // buildings raised without terrain
  run_mapper(options_, 1, Overwrite::allow, events);
  EXPECT_NE(warnings.find("the start lies 492 m above the ground of prior.ply there, whose heights are undeclared"), std::string::npos) << warnings;
}

TEST_F(Run, TimesThatThePaperDoesNotHearAreWarnedOf) {
  std::string warnings;
  const Events events{[&](const std::string& message) { warnings += message + "\n"; }, {}, {}};
  options_.no_map = true;
  options_.limit = 1;
  options_.dataset.point_times = "none";
  run_mapper(options_, 1, Overwrite::refuse, events);
  EXPECT_EQ(warnings, "");
  options_.dataset.point_times = "clockwise";
  run_mapper(options_, 1, Overwrite::allow, events);
  EXPECT_NE(warnings.find("--point-times has no effect"), std::string::npos) << warnings;
}

TEST_F(Run, StretchesOfADriveInOnePieceAreWarnedOf) {
  std::string warnings;
  const Events events{[&](const std::string& message) { warnings += message + "\n"; }, {}, {}};
  options_.no_map = true;
  options_.limit = 1;
  options_.stretches.scans = 100;
  run_mapper(options_, 1, Overwrite::refuse, events);
  EXPECT_NE(warnings.find("--stretch and --stretch-overlap have no effect without --jobs above 1"), std::string::npos) << warnings;
}

TEST_F(Run, TheSchemaSeesAFault) {
  run_mapper(options_, 1, Overwrite::refuse, {});
  auto broken = report();
  broken["scans"][1]["verdict"] = "fine";
  EXPECT_NE(schema_violations(broken), "");
}

/// A run that ends when it has mapped `num_scans`, as if by a fault.
void interrupted_run(const RunOptions& options, int num_scans) {
  Events events;
  events.progress = [&](const std::string& stage, double) {
    if (stage == "mapping" && --num_scans == 0) throw Error("interrupted");
  };
  EXPECT_THROW(run_mapper(options, 1, Overwrite::refuse, events), Error);
}

std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST_F(Run, GoesOnFromItsCheckpoint) {
  options_.checkpoint_s = 1e-9;
  const std::filesystem::path unfinished = options_.output.parent_path() / ".out.unfinished";
  for (const char* preset : {"paper", "default"}) {
    options_.preset = preset;
    options_.output = folder_.path() / (std::string("whole-") + preset);
    run_mapper(options_, 1, Overwrite::refuse, {});
    const RunOptions uncut = options_;
    options_.output = folder_.path() / "out";
    interrupted_run(options_, 2);
    EXPECT_TRUE(std::filesystem::exists(unfinished / "checkpoint"));
    EXPECT_FALSE(std::filesystem::exists(options_.output));

    std::vector<std::string> told;
    Events events;
    events.info = [&](const std::string& text) { told.push_back(text); };
    options_.resume = true;
    run_mapper(options_, 1, Overwrite::refuse, events);
    ASSERT_FALSE(told.empty());
    EXPECT_EQ(told.front(), "going on after 1 of 3 scans");
    for (const char* file : {"trajectory.csv", "poses_online_tum.txt", "map/prior.json", "map/tiles.idx"}) EXPECT_EQ(text_of(options_.output / file), text_of(uncut.output / file)) << file;
    EXPECT_FALSE(std::filesystem::exists(unfinished));
    std::filesystem::remove_all(options_.output);
    options_.resume = false;
  }
}

std::string refusal(const RunOptions& options) {
  try {
    run_mapper(options, 1, Overwrite::refuse, {});
  } catch (const UsageError& error) {
    return error.what();
  }
  return {};
}

TEST_F(Run, ACheckpointOfOtherInputsIsRefusedInWords) {
  namespace fs = std::filesystem;
  const fs::path priors = folder_.path();
  options_.prior = priors / "prior.ply";
  options_.initial.pose = {0, 0, 1.7, 0, 0, 0, 1};
  options_.checkpoint_s = 1e-9;
  options_.resume = true;
  interrupted_run(options_, 2);
  const auto expect_words = [&](const std::string& words, const RunOptions& options) {
    EXPECT_NE(refusal(options).find("is another one: " + words + "; leave out"), std::string::npos) << refusal(options);
  };

  PointCloud other_prior = read_point_cloud(options_.prior).points;
  other_prior.xyz.pop_back();
  write_point_cloud(priors / "other.ply", other_prior);
  fs::copy_file(options_.prior, priors / "renamed.ply");
  RunOptions other = options_;
  other.prior = priors / "renamed.ply";
  expect_words("the prior has another name: was \"prior.ply\", is \"renamed.ply\"", other);
  other.prior = priors / "other.ply";
  expect_words("the prior is another: was \"prior.ply\", is \"other.ply\"", other);
  other.prior.clear();
  expect_words("the prior is another: was \"prior.ply\", is not given", other);
  fs::rename(options_.prior, priors / "kept.ply");
  fs::rename(priors / "other.ply", options_.prior);
  expect_words("the prior is another", options_);
  fs::rename(priors / "kept.ply", options_.prior);

  other = options_;
  other.scans = folder_.path() / "drive";
  fs::copy(options_.scans, other.scans);
  expect_words("the recording has another name: was \"scans\", is \"drive\"", other);
  test::write_text(other.scans / "times.txt", "0\n0.1\n0.2\n");
  EXPECT_NE(refusal(other).find("the stamps of the scans come from elsewhere: was "), std::string::npos) << refusal(other);
  fs::copy_file(options_.scans / "2.bin", other.scans / "3.bin");
  fs::remove(other.scans / "times.txt");
  expect_words("the recording has another number of scans: was 3, is 4", other);
}

TEST_F(Run, ACheckpointOfAnotherRunIsRefusedByName) {
  options_.checkpoint_s = 1e-9;
  options_.resume = true;
  interrupted_run(options_, 2);
  RunOptions other = options_;
  other.preset = "default";
  EXPECT_NE(refusal(other).find("is another one: --preset was \"paper\", is \"default\"; leave out"), std::string::npos) << refusal(other);
  other = options_;
  other.limit = 2;
  other.map.voxel_m *= 2;
  EXPECT_NE(refusal(other).find("--limit was 0, is 2, --map-voxel was 0.2, is 0.4;"), std::string::npos) << refusal(other);
  other = options_;
  other.no_map = true;
  EXPECT_NE(refusal(other).find("--no-map was not given, is given;"), std::string::npos) << refusal(other);
  other = options_;
  other.map.voxel_m *= 2;
  EXPECT_NE(refusal(other).find("--map-voxel was"), std::string::npos) << refusal(other);
  other = options_;
  other.initial.pose = {0, 0, 0, 0, 0, 0, 1};
  EXPECT_NE(refusal(other).find("--initial-pose was "), std::string::npos) << refusal(other);
  test::write_text(options_.scans / "times.txt", "0\n0.1\n0.25\n");
  EXPECT_NE(refusal(options_).find("stamps"), std::string::npos) << refusal(options_);
  std::filesystem::remove(options_.scans / "times.txt");
  test::write_raw(options_.scans / "2.bin", std::vector<float>{1, 2, 3, 0});
  EXPECT_NE(refusal(options_).find("names, sizes or number of the scans' files differ"), std::string::npos) << refusal(options_);
}

TEST_F(Run, OtherTimesOfThePointsAreAnotherRun) {
  const auto write_times = [&](float time_s) {
    for (const char* name : {"0", "1", "2"}) {
      const auto num_points = std::filesystem::file_size(options_.scans / (std::string(name) + ".bin")) / 16;
      test::write_raw(options_.scans / "point_times" / (std::string(name) + ".f32"), std::vector<float>(num_points, time_s));
    }
  };
  write_times(0);
  options_.checkpoint_s = 1e-9;
  interrupted_run(options_, 2);
  write_times(0.01f);
  options_.resume = true;
  EXPECT_THROW(run_mapper(options_, 1, Overwrite::refuse, {}), UsageError);
  write_times(0);
  EXPECT_TRUE(run_mapper(options_, 1, Overwrite::refuse, {}));
}

TEST_F(Run, AWrongOrHastyStartLosesNoCheckpoint) {
  options_.checkpoint_s = 1e-9;
  interrupted_run(options_, 2);
  const std::filesystem::path checkpoint = folder_.path() / ".out.unfinished/checkpoint";
  const std::string kept = text_of(checkpoint);
  RunOptions mistyped = options_;
  mistyped.scans = folder_.path() / "scan";
  EXPECT_THROW(run_mapper(mistyped, 1, Overwrite::refuse, {}), IoError);
  mistyped = options_;
  mistyped.jobs = 2;   // not with --preset paper
  EXPECT_THROW(run_mapper(mistyped, 1, Overwrite::refuse, {}), UsageError);
  EXPECT_EQ(text_of(checkpoint), kept);

  std::string told;
  Events events;
  events.info = [&](const std::string& text) { told += text; };
  run_mapper(options_, 1, Overwrite::refuse, events);
  EXPECT_NE(told.find("beginning with the first scan"), std::string::npos) << told;
  EXPECT_FALSE(std::filesystem::exists(checkpoint.parent_path()));
}

TEST_F(Run, AWholeOutputIsLeftAsItIsByTheSameRunAlone) {
  run_mapper(options_, 1, Overwrite::refuse, {});
  const std::string report = text_of(options_.output / "run.json");
  const std::filesystem::path unfinished = folder_.path() / ".out.unfinished";
  test::write_text(unfinished / "checkpoint", "left by a kill after the output was put in place");
  options_.resume = true;
  RunOptions other = options_;
  other.limit = 2;
  EXPECT_THROW(run_mapper(other, 1, Overwrite::refuse, {}), UsageError);
  EXPECT_FALSE(run_mapper(options_, 2, Overwrite::refuse, {}));
  EXPECT_FALSE(std::filesystem::exists(unfinished));
  EXPECT_EQ(text_of(options_.output / "run.json"), report);
}

TEST_F(Run, ACheckpointOfAnotherBuildIsRefusedAsSuch) {
  StateArchive state;
  std::string build = "another";
  state(build);
  ResumableDirectory(options_.output, Overwrite::refuse, "run.json").keep(state.take());
  options_.resume = true;
  try {
    run_mapper(options_, 1, Overwrite::refuse, {});
    ADD_FAILURE();
  } catch (const UsageError& error) {
    EXPECT_NE(std::string(error.what()).find("of another build of mapper"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace priormap
