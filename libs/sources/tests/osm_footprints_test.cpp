#include <bzlib.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <fstream>
#include <functional>
#include <tuple>

#include <priormap/core/error.hpp>
#include <priormap/sources/osm_footprints.hpp>
#include <priormap/sources/osm_streets.hpp>
#include <priormap/tessellation/normalize.hpp>

namespace priormap {
namespace {

namespace fs = std::filesystem;

/// An OSM file of nodes on a lattice (node id = 100 y + x at x, y in 1e-5 degrees), ways and relations.
class OsmText {
 public:
  OsmText& way(int id, const std::vector<int>& nodes, const std::string& tags) {
    ways_ += "<way id='" + std::to_string(id) + "' version='1'>";
    for (const int node : nodes) ways_ += "<nd ref='" + std::to_string(node) + "'/>";
    ways_ += tags + "</way>\n";
    return *this;
  }
  OsmText& relation(int id, const std::string& members_and_tags) {
    relations_ += "<relation id='" + std::to_string(id) + "' version='1'>" + members_and_tags + "</relation>\n";
    return *this;
  }
  static std::string tag(const std::string& key, const std::string& value) { return "<tag k='" + key + "' v='" + value + "'/>"; }
  static std::string member(int way, const std::string& role) {
    return "<member type='way' ref='" + std::to_string(way) + "' role='" + role + "'/>";
  }
  std::string text() const {
    std::string nodes;
    for (int y = 0; y < 20; ++y)
      for (int x = 0; x < 20; ++x)
        nodes += "<node id='" + std::to_string(100 * y + x) + "' version='1' lat='" + std::to_string(y * 1e-5) + "00' lon='" + std::to_string(x * 1e-5) + "00'/>\n";
    return file_of(nodes + ways_ + relations_);
  }
  std::string nodes_last() const {
    const std::string sorted = text(), nodes = sorted.substr(sorted.find("<node"), sorted.find("<way") - sorted.find("<node"));
    return file_of(relations_ + ways_ + nodes);
  }

 private:
  static std::string file_of(const std::string& objects) { return "<?xml version='1.0' encoding='UTF-8'?>\n<osm version='0.6'>\n" + objects + "</osm>\n"; }
  std::string ways_, relations_;
};

std::string bzip2(const std::string& text) {
  std::string packed(text.size() + 1000, ' ');
  auto size = static_cast<unsigned>(packed.size());
  EXPECT_EQ(BZ2_bzBuffToBuffCompress(packed.data(), &size, const_cast<char*>(text.data()), static_cast<unsigned>(text.size()), 9, 0, 0), BZ_OK);
  return packed.substr(0, size);
}

class OsmFootprints : public testing::Test {
 protected:
  OsmFootprints() : folder_(fs::path(testing::TempDir()) / testing::UnitTest::GetInstance()->current_test_info()->name()) { fs::create_directories(folder_); }
  ~OsmFootprints() override { fs::remove_all(folder_); }
  fs::path write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  FootprintList read(const OsmText& text) { return read_osm_footprints({write("town.osm", text.text())}, 2, diagnostics_); }
  std::size_t count(DiagnosticCode code) const { return diagnostics_.counts().contains(code) ? diagnostics_.counts().at(code) : 0; }
  /// In lattice cells.
  double cells(const Footprint& footprint) {
    double sum = 0;
    std::vector<Ring2> rings = footprint.rings;
    for (Ring2& ring : rings) for (auto& p : ring) p *= 1e5;
    Diagnostics ignored;
    for (const Polygon2& polygon : normalize(rings, footprint.id, ignored)) sum += area(polygon);
    return sum;
  }

  fs::path folder_;
  Diagnostics diagnostics_;
};

const std::string building = OsmText::tag("building", "yes"), multipolygon = OsmText::tag("type", "multipolygon");

TEST_F(OsmFootprints, AClosedWay) {
  const auto footprints = read(OsmText().way(7, {0, 4, 304, 300, 0}, building + OsmText::tag("height", "12 m")).way(8, {0, 5, 505, 0}, OsmText::tag("landuse", "grass")));
  ASSERT_EQ(footprints.size(), 1u);
  EXPECT_EQ(footprints[0].id, "way/7");
  EXPECT_EQ(footprints[0].attributes.height_m, 12);
  ASSERT_EQ(footprints[0].rings.size(), 1u);
  EXPECT_EQ(footprints[0].rings[0].size(), 4u);
  EXPECT_NEAR(cells(footprints[0]), 12, 1e-6);
}

TEST_F(OsmFootprints, AMultipolygonOfPiecesWithTwoTouchingHoles) {
  const auto footprints = read(OsmText()
      .way(1, {0, 10, 1010}, "").way(2, {0, 1000, 1010}, "")                    // the outer ring in two pieces, one against the direction
      .way(3, {202, 204, 404, 402, 202}, "").way(4, {204, 206, 406, 404, 204}, "")  // share the edge 204-404
      .relation(9, OsmText::member(3, "inner") + OsmText::member(1, "outer") + OsmText::member(4, "inner") + OsmText::member(2, "outer") + multipolygon + building));
  ASSERT_EQ(footprints.size(), 1u);
  EXPECT_EQ(footprints[0].id, "relation/9");
  EXPECT_EQ(footprints[0].rings.size(), 2u) << "the two holes melt";
  EXPECT_NEAR(cells(footprints[0]), 100 - 8, 1e-6);
  EXPECT_EQ(diagnostics_.total(), 0u);
}

TEST_F(OsmFootprints, ObjectsMayStandBeforeWhatTheyReferTo) {
  OsmText town;
  town.way(1, {0, 9, 909, 900, 0}, "").way(2, {101, 108, 808, 801, 101}, "").way(5, {10, 12, 212, 10}, building);
  town.relation(9, OsmText::member(1, "outer") + OsmText::member(2, "inner") + multipolygon + building);
  const auto footprints = read_osm_footprints({write("unsorted.osm", town.nodes_last())}, 2, diagnostics_);
  ASSERT_EQ(footprints.size(), 2u);
  EXPECT_NEAR(cells(footprints[0]), 81 - 49, 1e-6);
  EXPECT_NEAR(cells(footprints[1]), 2, 1e-6);
  EXPECT_EQ(diagnostics_.total(), 0u);
}

TEST_F(OsmFootprints, AMemberGivenTwiceCountsOnce) {
  const OsmText rings = OsmText().way(1, {0, 9, 909, 900, 0}, "").way(2, {101, 108, 808, 801, 101}, "").way(3, {808, 108, 101, 801, 808}, "");   // 3: as 2, from elsewhere and the other way round
  const std::string outer = OsmText::member(1, "outer"), inner = OsmText::member(2, "inner"), same_inner = OsmText::member(3, "inner");
  for (const std::string& members : {outer + outer + inner, outer + inner + inner, inner + outer + same_inner}) {
    diagnostics_ = {};
    const auto footprints = read(OsmText(rings).relation(9, members + multipolygon + building));
    ASSERT_EQ(footprints.size(), 1u);
    EXPECT_NEAR(cells(footprints[0]), 81 - 49, 1e-6);
    EXPECT_EQ(count(DiagnosticCode::duplicated_rings), 1u);
  }
}

TEST_F(OsmFootprints, AnOpenMemberGivenTwiceCountsOnceUnlessItLiesBetweenTwoRings) {
  const OsmText ways = OsmText().way(1, {0, 4, 404}, "").way(2, {0, 400, 404}, "").way(3, {4, 8, 408, 404}, "").way(4, {4, 404}, "");
  const auto members = [](const std::vector<int>& ids) {
    std::string text;
    for (const int id : ids) text += OsmText::member(id, "outer");
    return text + multipolygon + building;
  };
  EXPECT_NEAR(cells(read(OsmText(ways).relation(9, members({1, 2, 1})))[0]), 16, 1e-6);
  EXPECT_EQ(count(DiagnosticCode::duplicated_rings), 1u);
  const OsmText halves = OsmText(ways).way(5, {0, 4}, "").way(6, {404, 400, 0}, "");
  EXPECT_NEAR(cells(read(OsmText(halves).relation(9, members({5, 4, 6, 3, 4})))[0]), 32, 1e-6);
  EXPECT_EQ(count(DiagnosticCode::duplicated_rings), 1u);
}

TEST_F(OsmFootprints, TwoOuterRingsAndAnIsland) {
  const auto footprints = read(OsmText()
      .way(1, {0, 9, 909, 900, 0}, "").way(2, {101, 108, 808, 801, 101}, "").way(3, {303, 305, 505, 503, 303}, "").way(4, {12, 14, 214, 212, 12}, "")
      .relation(9, OsmText::member(1, "outer") + OsmText::member(2, "inner") + OsmText::member(3, "outer") + OsmText::member(4, "outer") + multipolygon + building));
  ASSERT_EQ(footprints.size(), 1u);
  EXPECT_NEAR(cells(footprints[0]), 81 - 49 + 4 + 4, 1e-6);
}

TEST_F(OsmFootprints, BrokenRingsAreCountedAndTheRestGoesOn) {
  const auto footprints = read(OsmText()
      .way(1, {0, 9, 909, 900, 0}, "").way(2, {101, 108, 808}, "").way(3, {303, 305, 505, 503, 303}, "")
      .relation(9, OsmText::member(1, "outer") + OsmText::member(2, "inner") + OsmText::member(3, "inner") + multipolygon + building)
      .way(5, {10, 12, 212}, building).way(6, {14, 16, 216, 14}, building));
  ASSERT_EQ(footprints.size(), 2u);
  EXPECT_NEAR(cells(footprints[0]), 81 - 4, 1e-6);
  EXPECT_EQ(footprints[1].id, "way/6");
  EXPECT_EQ(count(DiagnosticCode::ring_not_closed), 2u);
  ASSERT_EQ(diagnostics_.entries().size(), 2u);
  EXPECT_EQ(diagnostics_.entries()[0].feature, "relation/9");
  EXPECT_EQ(diagnostics_.entries()[1].feature, "way/5");
}

TEST_F(OsmFootprints, MissingMembersNodesAndMisplacedInnersAreCounted) {
  const auto footprints = read(OsmText()
      .way(1, {0, 9, 909, 900, 0}, "").way(3, {1212, 1213, 1313, 1212}, "").way(4, {0, 77777, 909, 0}, building)
      .relation(9, OsmText::member(1, "outer") + OsmText::member(2, "outer") + OsmText::member(3, "inner") + multipolygon + building));
  ASSERT_EQ(footprints.size(), 1u);
  EXPECT_NEAR(cells(footprints[0]), 81, 1e-6);
  EXPECT_EQ(count(DiagnosticCode::unresolved_reference), 2u);
  EXPECT_EQ(count(DiagnosticCode::inner_ring_outside), 1u);
}

TEST_F(OsmFootprints, AWayThatBridgesTwoRingsDoesNotHarmThem) {
  const auto footprints = read(OsmText()
      .way(1, {0, 3, 303, 300, 0}, "").way(2, {303, 606}, "").way(3, {606, 609, 909, 906, 606}, "")
      .relation(9, OsmText::member(1, "outer") + OsmText::member(2, "outer") + OsmText::member(3, "outer") + multipolygon + building));
  ASSERT_EQ(footprints.size(), 1u);
  EXPECT_NEAR(cells(footprints[0]), 18, 1e-6);
  EXPECT_EQ(count(DiagnosticCode::ring_not_closed), 1u);
}

TEST_F(OsmFootprints, TagsOnTheOuterWayAreTheRelationsAndTheBuildingCountsOnce) {
  const OsmText rings = OsmText().way(1, {0, 9, 909, 900, 0}, building + OsmText::tag("height", "9")).way(2, {101, 103, 303, 301, 101}, "");
  const std::string members = OsmText::member(1, "outer") + OsmText::member(2, "inner") + multipolygon;
  for (const std::string& tags : {std::string(), building}) {
    const auto footprints = read(OsmText(rings).relation(9, members + tags));
    ASSERT_EQ(footprints.size(), 1u);
    EXPECT_EQ(footprints[0].id, "relation/9");
    EXPECT_EQ(footprints[0].attributes.height_m, 9);
    EXPECT_NEAR(cells(footprints[0]), 81 - 4, 1e-6);
  }
}

TEST_F(OsmFootprints, ABuildingInACourtyardIsItsOwn) {
  const auto footprints = read(OsmText().way(1, {0, 9, 909, 900, 0}, "").way(2, {101, 103, 303, 301, 101}, building)
      .relation(9, OsmText::member(1, "outer") + OsmText::member(2, "inner") + multipolygon + building));
  EXPECT_EQ(footprints.size(), 2u);
}

TEST_F(OsmFootprints, ABuildingRelationTiesPartsToTheirOutline) {
  const auto footprints = read(OsmText()
      .way(1, {0, 9, 909, 900, 0}, "").way(2, {0, 4, 904, 900, 0}, OsmText::tag("building:part", "yes")).way(3, {12, 14, 214, 12}, building)
      .relation(9, OsmText::member(1, "outline") + OsmText::member(2, "part") + OsmText::tag("type", "building") + building + OsmText::tag("building:levels", "4")));
  ASSERT_EQ(footprints.size(), 3u);
  EXPECT_EQ(footprints[0].kind, Footprint::Kind::outline);
  EXPECT_EQ(footprints[0].attributes.levels, 4) << "what the relation says holds for the outline";
  EXPECT_EQ(footprints[1].kind, Footprint::Kind::part);
  EXPECT_NE(footprints[0].building, Footprint::no_building);
  EXPECT_EQ(footprints[0].building, footprints[1].building);
  EXPECT_EQ(footprints[2].building, Footprint::no_building);
}

TEST_F(OsmFootprints, TheOutlineOfABuildingRelationMayHaveAnotherRoleOrNone) {
  for (const std::string role : {"outline", "outer", ""}) {
    const auto footprints = read(OsmText()
        .way(1, {0, 9, 909, 900, 0}, building).way(2, {0, 4, 904, 900, 0}, OsmText::tag("building:part", "yes")).way(3, {1010, 1012, 1212, 1010}, OsmText::tag("building:part", "yes"))
        .relation(9, OsmText::member(1, role) + OsmText::member(2, "part") + OsmText::member(3, "") + OsmText::tag("type", "building") + OsmText::tag("height", "12")));
    ASSERT_EQ(footprints.size(), 3u);
    EXPECT_EQ(footprints[0].attributes.height_m, 12) << role;
    EXPECT_NE(footprints[0].building, Footprint::no_building) << role;
    for (const int part : {1, 2}) {
      EXPECT_EQ(footprints[part].kind, Footprint::Kind::part);
      EXPECT_FALSE(footprints[part].attributes.height_m);
      EXPECT_EQ(footprints[part].building, footprints[0].building) << role;
    }
  }
}

TEST_F(OsmFootprints, AnOutlineThatIsTheOuterWayOfAMultipolygonTiesTheMultipolygon) {
  const auto footprints = read(OsmText()
      .way(1, {0, 9, 909, 900, 0}, "").way(2, {101, 103, 303, 301, 101}, "").way(3, {0, 4, 904, 900, 0}, OsmText::tag("building:part", "yes"))
      .relation(8, OsmText::member(1, "outer") + OsmText::member(2, "inner") + multipolygon + building)
      .relation(9, OsmText::member(1, "outline") + OsmText::member(3, "part") + OsmText::tag("type", "building")));
  ASSERT_EQ(footprints.size(), 2u);
  EXPECT_EQ(footprints[0].id, "relation/8");
  EXPECT_NE(footprints[0].building, Footprint::no_building);
  EXPECT_EQ(footprints[0].building, footprints[1].building);
}

TEST_F(OsmFootprints, SeveralFilesAreOneDataSetInAnyOrder) {
  const fs::path a = write("a.osm", OsmText().way(1, {0, 4, 304, 300, 0}, building).way(2, {10, 12, 212, 10}, building).text());
  const fs::path b = write("b.osm", OsmText().way(2, {10, 12, 212, 10}, building).way(3, {505, 507, 707, 505}, building).text());
  const auto ab = read_osm_footprints({a, b}, 2, diagnostics_), ba = read_osm_footprints({b, a}, 1, diagnostics_);
  ASSERT_EQ(ab.size(), 3u);
  ASSERT_EQ(ba.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(ab[i].id, ba[i].id);
    EXPECT_EQ(ab[i].rings, ba[i].rings);
  }
}

/// A house of nodes 1 to 4, way 9, at a version of its own; `attributes` of the way's tag.
std::string house(int version, const std::string& height, const std::string& attributes = "", const std::string& tag = building) {
  return "<way id='9' version='" + std::to_string(version) + "' " + attributes + "><nd ref='1'/><nd ref='2'/><nd ref='3'/><nd ref='4'/><nd ref='1'/>" + tag + OsmText::tag("height", height) + "</way>\n";
}
std::string node(int id, int version, double lat, double lon, const std::string& attributes = "") {
  return "<node id='" + std::to_string(id) + "' version='" + std::to_string(version) + "' lat='" + std::to_string(lat) + "' lon='" + std::to_string(lon) + "' " + attributes + "/>\n";
}
std::string osm(const std::string& objects) { return "<?xml version='1.0'?>\n<osm version='0.6'>\n" + objects + "</osm>\n"; }
const std::string corners = node(1, 1, 0, 0) + node(2, 1, 0, 0.001) + node(3, 1, 0.001, 0.001) + node(4, 1, 0.001, 0);

TEST_F(OsmFootprints, TheHighestVersionCountsWhateverTheOrderOfFilesAndObjects) {
  const std::string gone = "visible='false'";
  const auto height_of = [&](const std::vector<std::string>& texts) -> std::optional<double> {
    std::vector<fs::path> files;
    for (const std::string& text : texts) files.push_back(write(std::to_string(files.size()) + ".osm", osm(text)));
    const auto footprints = read_osm_footprints(files, 2, diagnostics_);
    return footprints.empty() ? std::nullopt : footprints[0].attributes.height_m;
  };
  EXPECT_EQ(height_of({corners + house(1, "5") + house(2, "10")}), 10);
  EXPECT_EQ(height_of({corners + house(2, "10") + house(1, "5")}), 10);
  EXPECT_EQ(height_of({corners + house(1, "5") + house(2, "10", gone)}), std::nullopt);
  EXPECT_EQ(height_of({corners + house(1, "5") + house(2, "10", "", OsmText::tag("landuse", "grass"))}), std::nullopt) << "no building any more";
  for (const auto& [first, second, height] : {std::tuple(house(1, "5"), house(2, "10"), std::optional(10.0)), {house(1, "5"), house(2, "10", gone), std::nullopt}}) {
    EXPECT_EQ(height_of({corners + first, corners + second}), height);
    EXPECT_EQ(height_of({corners + second, corners + first}), height);
  }
}

TEST_F(OsmFootprints, ANodeThatMovedLiesWhereItsHighestVersionSays) {
  const fs::path monday = write("monday.osm", osm(corners + house(1, "5"))), tuesday = write("tuesday.osm", osm(node(3, 2, 0.002, 0.002) + house(1, "5")));
  for (const auto& files : {std::vector{monday, tuesday}, {tuesday, monday}})
    EXPECT_NEAR(read_osm_footprints(files, 2, diagnostics_)[0].rings[0][2].x(), 0.002, 1e-9);
}

TEST_F(OsmFootprints, WhatIsDeletedInJosmIsNoBuilding) {
  EXPECT_EQ(read_osm_footprints({write("a.osm", osm(corners + house(3, "5", "action='modify'")))}, 2, diagnostics_).size(), 1u);
  EXPECT_TRUE(read_osm_footprints({write("b.osm", osm(corners + house(3, "5", "action='delete' visible='true'")))}, 2, diagnostics_).empty());
}

TEST_F(OsmFootprints, ARemarkOfOverpassAndHistoryAreWarnedOf) {
  std::vector<std::string> warnings;
  Events events;
  events.warning = [&](const std::string& text) { warnings.push_back(text); };
  read_osm_footprints({write("a.osm", osm(corners + house(1, "5")))}, 2, diagnostics_, events);
  EXPECT_TRUE(warnings.empty());
  read_osm_footprints({write("b.osm", osm(corners + house(1, "5") + house(2, "5") + "<remark>runtime error: Query timed out</remark>"))}, 2, diagnostics_, events);
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_NE(warnings[0].find("b.osm: Overpass broke off: \"runtime error: Query timed out\""), std::string::npos) << warnings[0];
  EXPECT_NE(warnings[1].find("several versions"), std::string::npos) << warnings[1];
}

TEST_F(OsmFootprints, CompressedFilesTellOfRemarksAndDeletionsToo) {
  std::vector<std::string> warnings;
  Events events;
  events.warning = [&](const std::string& text) { warnings.push_back(text); };
  // Attributes in any order and on any line, a remark of several lines with an entity, and what looks like a deletion inside of a value.
  const std::string text = osm(corners + house(1, "5", "\n action=\"delete\"\n visible='true'") + "<remark>\nruntime error:\n&quot;timed out&quot;</remark>");
  const std::string harmless = osm(corners + house(1, "5", "", building + OsmText::tag("note", "&lt;way id=&apos;9&apos; action=&apos;delete&apos;>&lt;remark>none")));
  const fs::path zipped = folder_ / "town.osm.gz";
  {
    const auto file = gzopen(zipped.c_str(), "wb");
    gzwrite(file, text.data(), static_cast<unsigned>(text.size()));
    gzclose(file);
  }
  for (const fs::path& file : {write("town.osm", text), write("town.osm.bz2", bzip2(text)), zipped}) {
    warnings.clear();
    EXPECT_TRUE(read_osm_footprints({file}, 2, diagnostics_, events).empty()) << file;
    ASSERT_EQ(warnings.size(), 1u) << file;
    EXPECT_NE(warnings[0].find("runtime error: \"timed out\""), std::string::npos) << warnings[0];
  }
  warnings.clear();
  EXPECT_EQ(read_osm_footprints({write("harmless.osm.bz2", bzip2(harmless))}, 2, diagnostics_, events).size(), 1u);
  EXPECT_TRUE(warnings.empty());
}

TEST_F(OsmFootprints, WhatWasDeletedIsNotedWhereverItStandsInTheFile) {
  const std::string deleted = corners + house(1, "5", " action='delete'");
  const std::size_t at = osm(deleted).find("action") + std::string("<!---->").size();
  for (const std::size_t before_boundary : {0, 1, 3, 6, 7, 8, 15, 16, 17, 30}) {
    const std::string padding = "<!--" + std::string((std::size_t{1} << 18) - at - before_boundary, '.') + "-->";
    EXPECT_TRUE(read_osm_footprints({write("town.osm", osm(padding + deleted))}, 2, diagnostics_).empty()) << before_boundary;
  }
}

TEST_F(OsmFootprints, DamagedCompressionIsNamed) {
  const std::string packed = bzip2(osm(corners + house(1, "5")));
  std::string odd = packed;
  odd[odd.size() / 3] ^= 0x55;
  for (const auto& [text, cause] : {std::pair(packed.substr(0, packed.size() - 9), "cut short"), {odd, "damaged"}, {packed + "tail", "damaged"}, {packed + std::string(600, '\0') + "tail", "damaged"}}) {
    try {
      read_osm_footprints({write("town.osm.bz2", text)}, 1, diagnostics_);
      ADD_FAILURE() << cause << " is not noticed";
    } catch (const FormatError& error) {
      EXPECT_NE(std::string(error.what()).find(cause), std::string::npos) << error.what();
    }
  }
}

TEST_F(OsmFootprints, StreamsOfBzip2ThatFollowEachOtherAreOneText) {
  const std::string text = osm(corners + house(1, "5"));
  for (const std::size_t length : {std::size_t{50}, text.size() / 2, text.size()}) {
    std::string packed;
    for (std::size_t i = 0; i < text.size(); i += length) packed += bzip2(text.substr(i, length));
    for (const std::string& after : {std::string(), bzip2(""), std::string(512, '\0')}) {
      const fs::path file = write("town.osm.bz2", packed + after);
      EXPECT_EQ(read_osm_footprints({file}, 2, diagnostics_).size(), 1u) << length << " bytes a stream, " << after.size() << " after them";
      EXPECT_TRUE(read_osm_streets(file).empty());
    }
  }
}

TEST_F(OsmFootprints, AnEmptyFileIsCalledEmpty) {
  for (const fs::path& file : {write("empty.osm", ""), write("empty.osm.bz2", ""), write("nothing.osm.bz2", bzip2("")), write("empty.osm.pbf", "")})
    for (const std::function<void()>& read : {std::function<void()>([&] { read_osm_footprints({file}, 2, diagnostics_); }), {[&] { read_osm_streets(file); }}}) {
      try {
        read();
        ADD_FAILURE() << file << " was read";
      } catch (const FormatError& error) {
        EXPECT_EQ(error.what(), file.string() + ": is empty; fetch it again");
      }
    }
}

TEST_F(OsmFootprints, ZeroBytesAfterACompressedFileArePadding) {
  const std::string packed = bzip2(osm(corners + house(1, "5")));
  for (const std::size_t padding : {std::size_t{1}, std::size_t{512}, std::size_t{1} << 20}) {
    const fs::path file = write("town.osm.bz2", packed + std::string(padding, '\0'));
    EXPECT_EQ(read_osm_footprints({file}, 2, diagnostics_).size(), 1u) << padding;
    EXPECT_TRUE(read_osm_streets(file).empty());
  }
}

TEST_F(OsmFootprints, WhatUnpacksToFarMoreThanAMapIsNotCopied) {
  const std::string declared = "<?xml version='1.0' encoding='windows-1252'?><osm version='0.6'>";
  const fs::path bomb = write("bomb.osm.bz2", bzip2(declared + std::string(std::size_t{65} << 20, ' ') + "</osm>"));
  ASSERT_LT(fs::file_size(bomb), 1000u);
  for (const std::function<void()>& read : {std::function<void()>([&] { read_osm_footprints({bomb}, 2, diagnostics_); }), {[&] { read_osm_streets(bomb); }}}) {
    try {
      read();
      ADD_FAILURE() << "read";
    } catch (const FormatError& error) {
      EXPECT_NE(std::string(error.what()).find("unpacks to more than"), std::string::npos) << error.what();
    }
  }
}

TEST_F(OsmFootprints, EncodingsOfOneByteACharacterAreRead) {
  const std::string declared = "<?xml version='1.0' encoding='windows-1252'?>", undeclared = "<?xml version='1.0'?>";
  std::string text = osm(corners + house(1, "5", "", building + OsmText::tag("name", "Caf\xe9 \x80")) + "<way id='10' version='1'><nd ref='1'/><nd ref='3'/>" +
                         OsmText::tag("highway", "residential") + OsmText::tag("name", "Stra\xdf" "e") + "</way>");
  text.replace(0, undeclared.size(), declared);
  for (const fs::path& file : {write("town.osm", text), write("town.osm.bz2", bzip2(text))}) {
    EXPECT_EQ(read_osm_footprints({file}, 2, diagnostics_).size(), 1u) << file;
    const auto streets = read_osm_streets(file);
    ASSERT_EQ(streets.size(), 1u) << file;
    EXPECT_EQ(streets[0].name, "Stra\u00dfe");
  }
  text.replace(0, declared.size(), "<?xml version='1.0' encoding='Shift_JIS'?>");
  const fs::path file = write("odd.osm", text);
  for (const std::function<void()>& read : {std::function<void()>([&] { read_osm_footprints({file}, 2, diagnostics_); }), {[&] { read_osm_streets(file); }}}) {
    try {
      read();
      ADD_FAILURE() << "read";
    } catch (const FormatError& error) {
      EXPECT_NE(std::string(error.what()).find("'Shift_JIS'"), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("iconv"), std::string::npos) << error.what();
    }
  }
}

TEST_F(OsmFootprints, WaysMaySayWhereTheirNodesLie) {
  const std::string way = "<way id='9' version='1'><nd ref='1' lat='0' lon='0'/><nd ref='2' lat='0' lon='0.001'/><nd ref='3' lat='0.001' lon='0.001'/><nd ref='1' lat='0' lon='0'/>" + building + "</way>";
  const auto footprints = read_osm_footprints({write("a.osm", osm(way))}, 2, diagnostics_);
  ASSERT_EQ(footprints.size(), 1u);
  EXPECT_NEAR(footprints[0].rings[0][2].y(), 0.001, 1e-9);
  EXPECT_EQ(diagnostics_.total(), 0u);
}

TEST_F(OsmFootprints, UnusableFilesAreNamed) {
  EXPECT_THROW(read_osm_footprints({folder_ / "absent.osm"}, 1, diagnostics_), IoError);
  const std::string whole = OsmText().way(1, {0, 4, 304, 300, 0}, building).text();
  for (const auto& file : {write("cut.osm", whole.substr(0, whole.size() / 2)), write("text.osm", "no xml"), write("empty.osm", ""), write("noise.osm.pbf", "noise"), write("town.txt", whole)}) {
    try {
      read_osm_footprints({file}, 2, diagnostics_);
      ADD_FAILURE() << file << " was read";
    } catch (const FormatError& error) {
      EXPECT_NE(std::string(error.what()).find(file.string()), std::string::npos) << error.what();
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace priormap
