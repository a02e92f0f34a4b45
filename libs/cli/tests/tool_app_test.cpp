#include <priormap/cli/tool_app.hpp>

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <thread>

#include <priormap/core/error.hpp>

namespace fs = std::filesystem;
using priormap::OptionField;
using priormap::cli::ToolApp;
using priormap::cli::ToolContext;

namespace {

struct DemoOptions {
  double default_height_m = 8;
  int count = 3;
  bool roofs = true;
  std::vector<double> bbox;
  std::vector<std::string> classes;
  std::optional<double> ground_height_m;
  std::optional<std::string> crs;
  std::uint64_t seed = 1;

  template <class Visitor>
  void describe(Visitor& visit) {
    visit("default-height", default_height_m, OptionField{"Height without tag", "m", 0.1, 1000});
    visit("count", count, OptionField{"How many", "", 1, 9});
    visit("roofs", roofs, OptionField{"Make roofs"});
    visit("bbox", bbox, OptionField{"Box"});
    visit("class", classes, OptionField{"Class, repeatable"});
    visit("ground-height", ground_height_m, OptionField{"Ground", "m"});
    visit("crs", crs, OptionField{"CRS of the prior"});
    visit("seed", seed, OptionField{"Seed"});
  }
};

/// The program's options and what one run of it did.
struct Demo {
  DemoOptions options;
  std::vector<std::string> inputs;
  std::string output, kind = "surface";
  ToolContext context;
  bool ran = false;
  int exit_code = -1;
  std::string out, err;

  explicit Demo(std::vector<std::string> arguments, std::function<void()> body = [] {}) {
    ToolApp app("demo", "A demonstration");
    app.positional("INPUT", inputs, "Files", true);
    app.required("-o,--output", output, "Output");
    app.choice("--kind", kind, {"surface", "terrain"}, "Kind");
    app.options(options, "Outlines");
    arguments.insert(arguments.begin(), "demo");
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    ::testing::internal::CaptureStdout();
    ::testing::internal::CaptureStderr();
    exit_code = app.run(static_cast<int>(argv.size()), argv.data(), [&](const ToolContext& given) {
      context = given;
      ran = true;
      given.events.warn("careful");
      given.events.advance("reading", 0.5);
      body();
    });
    out = ::testing::internal::GetCapturedStdout();
    err = ::testing::internal::GetCapturedStderr();
  }
};

class ConfigFile {
 public:
  explicit ConfigFile(const std::string& text) { std::ofstream(path_) << text; }
  ~ConfigFile() { fs::remove(path_); }
  std::string path() const { return path_.string(); }

 private:
  fs::path path_ = fs::temp_directory_path() / ("priormap_config_" + std::to_string(::getpid()) + ".toml");
};

TEST(ToolAppTest, ReadsEveryKindOfOption) {
  const Demo demo({"a.osm", "-o", "out", "--default-height", "12.5", "b.osm", "--roofs=false", "--bbox", "-0.1,51.5,0,52",
                   "--class", "x", "c.osm", "--class", "y", "--ground-height", "-3", "--kind", "terrain", "--threads", "3",
                   "--overwrite", "--seed", "18446744073709551615"});
  EXPECT_EQ(demo.exit_code, 0) << demo.err;
  EXPECT_EQ(demo.inputs, (std::vector<std::string>{"a.osm", "b.osm", "c.osm"}));
  EXPECT_EQ(demo.options.default_height_m, 12.5);
  EXPECT_FALSE(demo.options.roofs);
  EXPECT_EQ(demo.options.bbox, (std::vector<double>{-0.1, 51.5, 0, 52}));
  EXPECT_EQ(demo.options.classes, (std::vector<std::string>{"x", "y"}));
  EXPECT_EQ(demo.options.ground_height_m, -3.0);
  EXPECT_EQ(demo.options.crs, std::nullopt);
  EXPECT_EQ(demo.options.seed, 18446744073709551615u);
  EXPECT_EQ(demo.kind, "terrain");
  EXPECT_EQ(demo.context.threads, 3);
  EXPECT_EQ(demo.context.overwrite, priormap::Overwrite::allow);
  EXPECT_EQ(demo.err, "demo: warning: careful\n");
}

TEST(ToolAppTest, HelpVersionAndDumpNeedNoRequiredOptions) {
  const Demo help({"--help"}), version({"--version"}), dump({"--dump-config", "--count", "5"});
  for (const Demo* demo : {&help, &version, &dump}) {
    EXPECT_EQ(demo->exit_code, 0);
    EXPECT_FALSE(demo->ran);
    EXPECT_EQ(demo->err, "");
  }
  for (const char* text : {"--default-height", "Outlines", "8", "--kind surface|terrain", "--threads", "REQUIRED", "--dump-config"})
    EXPECT_NE(help.out.find(text), std::string::npos) << text << "\n" << help.out;
  EXPECT_EQ(version.out, "demo 0.1.0\n");
  EXPECT_NE(dump.out.find("count = 5\n"), std::string::npos) << dump.out;
}

TEST(ToolAppTest, WrongUsageIsOneLineAndExitCode2) {
  const std::vector<std::vector<std::string>> wrong = {
      {},
      {"a.osm"},
      {"a", "-o", "out", "--unknown"},
      {"a", "-o", "out", "--default-height", "0"},
      {"a", "-o", "out", "--default-height", "8m"},
      {"a", "-o", "out", "--default-height", "nan"},
      {"a", "-o", "out", "--count", "1.5"},
      {"a", "-o", "out", "--count", "10"},
      {"a", "-o", "out", "--seed", "-1"},
      {"a", "-o", "out", "--bbox", "1,,2"},
      {"a", "-o", "out", "--kind", "both"},
      {"a", "-o", "out", "--config", "/nonexistent.toml"},
      {"a", "-o"},
  };
  for (const auto& arguments : wrong) {
    const Demo demo(arguments);
    EXPECT_EQ(demo.exit_code, 2);
    EXPECT_FALSE(demo.ran);
    EXPECT_EQ(demo.out, "");
    EXPECT_TRUE(demo.err.starts_with("demo: ")) << demo.err;
    EXPECT_EQ(std::count(demo.err.begin(), demo.err.end(), '\n'), 1) << demo.err;
  }
  EXPECT_NE(Demo({"a", "-o", "out", "--default-height", "0"}).err.find("--default-height: 0 is outside 0.1 to 1000 m"),
            std::string::npos);
}

TEST(ToolAppTest, NumbersOfAListArePartedByCommasOrSpaces) {
  for (const std::string text : {"1 -2.5 3 4", "1,-2.5, 3 ,4", " 1, -2.5 3\t4 "})
    EXPECT_EQ(Demo({"a", "-o", "out", "--bbox", text}).options.bbox, (std::vector<double>{1, -2.5, 3, 4})) << text;
  for (const std::string text : {"1,,2", "1,2,", "", ",", "1 two"})
    EXPECT_NE(Demo({"a", "-o", "out", "--bbox", text}).err.find("is not a number"), std::string::npos) << text;
  const Demo with_positional({"-o", "out", "--bbox", "1,2,3,4", "5"});
  EXPECT_EQ(with_positional.inputs, (std::vector<std::string>{"5"}));
}

TEST(ToolAppTest, ATakerOfNoPositionalsTakesNumbersOneByOne) {
  std::vector<double> pose;
  bool flagged = false;
  ToolApp app("demo", "A demonstration");
  app.option("--pose", pose, OptionField{"Pose"});
  app.flag("--flag", flagged, "Flag");
  std::vector<std::string> arguments{"demo", "--pose", "455394.6", "-0.0069", "1e-3", "--flag"};
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  EXPECT_EQ(app.run(static_cast<int>(argv.size()), argv.data(), [](const ToolContext&) {}), 0);
  EXPECT_EQ(pose, (std::vector<double>{455394.6, -0.0069, 1e-3}));
  EXPECT_TRUE(flagged);
}

TEST(ToolAppTest, CommandLineWinsOverConfigFile) {
  const ConfigFile config("INPUT = [\"a, b.osm\", 'c.osm']\noutput = \"out\"\ncount = 7\ndefault-height = 20\nroofs = false\nbbox = [1, 2.5]\nquiet = true\n");
  const Demo demo({"--config", config.path(), "--count", "2"});
  EXPECT_EQ(demo.exit_code, 0) << demo.err;
  EXPECT_EQ(demo.inputs, (std::vector<std::string>{"a, b.osm", "c.osm"}));
  EXPECT_EQ(demo.options.count, 2);
  EXPECT_EQ(demo.options.default_height_m, 20);
  EXPECT_FALSE(demo.options.roofs);
  EXPECT_EQ(demo.options.bbox, (std::vector<double>{1, 2.5}));
  EXPECT_EQ(demo.err, "");
}

TEST(ToolAppTest, DumpedConfigGivesTheSameRun) {
  const Demo dump({"a \"b\".osm", "-o", "out", "--bbox=-1,2", "--crs", "EPSG:25832#\\", "--ground-height", "0.1", "--class", "x",
                   "--log-json", "--dump-config"});
  const ConfigFile config(dump.out);
  EXPECT_EQ(Demo({"--config", config.path(), "--dump-config"}).out, dump.out);
  const Demo run({"--config", config.path()});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.inputs, std::vector<std::string>{"a \"b\".osm"});
  EXPECT_EQ(run.options.crs, "EPSG:25832#\\");
}

TEST(ToolAppTest, AMisspeltOptionIsNamedWithTheOneThatIsNear) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> wrong = {
      {{"--otuput", "out", "a"}, "there is no option --otuput; did you mean --output?"},   // not that --output is missing
      {{"a", "-o", "out", "--default-hight=3"}, "there is no option --default-hight; did you mean --default-height?"},
      {{"a", "-o", "out", "--ground", "3"}, "there is no option --ground; did you mean --ground-height?"},
      {{"a", "-o", "out", "-seed", "3"}, "there is no option -seed; did you mean --seed?"},
      {{"a", "-o", "out", "--first", "--second"}, "there is no option --first (see"},
      {{"--dump-config", "--thread", "3"}, "there is no option --thread; did you mean --threads?"},
  };
  for (const auto& [arguments, text] : wrong) {
    const Demo demo(arguments);
    EXPECT_EQ(demo.exit_code, 2);
    EXPECT_NE(demo.err.find(text), std::string::npos) << demo.err;
  }
}

TEST(ToolAppTest, FaultyConfigIsWrongUsageThatNamesFileAndLine) {
  const std::vector<std::pair<std::string, std::string>> wrong = {
      {"count = 1\nnonsense = 1\n", ": line 2: nonsense is no option that a configuration sets (see demo"},
      {"cuont = 1\n", ": line 1: cuont is no option that a configuration sets; did you mean count?"},
      {"# few\ncount = 99\n", ": line 2: --count: 99 is outside 1 to 9"},
      {"INPUT = \"a\"\nkind = \"both\"\n", ": line 2: --kind: 'both' is none of"},
      {"count = [1\n", ": line 2: expected , or ] in the array"},
      {"count = [1, 2]\n", ": line 1: count takes one value"},
      {"bbox = []\n", ": line 1: bbox has no value"},
      {"quiet = 3\n", ": line 1: quiet is true or false, not '3'"},
      {"help = true\n", ": line 1: help is no option that a configuration sets"},
      {"[section]\ncount = 1\n", ": line 1: sections are not used here"},
  };
  for (const auto& [text, cause] : wrong) {
    const ConfigFile config(text);
    const Demo demo({"a", "-o", "out", "--config", config.path()});
    EXPECT_EQ(demo.exit_code, 2) << text;
    EXPECT_EQ(std::count(demo.err.begin(), demo.err.end(), '\n'), 1) << demo.err;
    EXPECT_TRUE(demo.err.starts_with("demo: " + config.path() + cause)) << demo.err;
  }
  const ConfigFile config("count = 99\n");
  EXPECT_EQ(Demo({"a", "-o", "out", "--count", "3", "--config", config.path()}).exit_code, 0) << "the command line wins";
  EXPECT_NE(Demo({"a", "-o", "out", "--count", "0", "--config", config.path()}).err.find("demo: --count: 0 is outside"), std::string::npos);
}

TEST(ToolAppTest, ExceptionsBecomeExitCodes) {
  const std::vector<std::string> arguments = {"a", "-o", "out", "--quiet"};
  const Demo failed(arguments, [] { throw priormap::IoError("a.osm", "cannot\nbe read"); });
  EXPECT_EQ(failed.exit_code, 1);
  EXPECT_EQ(failed.err, "demo: a.osm: cannot be read\n");
  const Demo usage(arguments, [] { throw priormap::UsageError("--x and --y exclude each other"); });
  EXPECT_EQ(usage.exit_code, 2);
  const Demo json({"a", "-o", "out", "--log-json"}, [] { throw std::runtime_error("bad \"x\""); });
  EXPECT_EQ(json.err,
            "{\"tool\":\"demo\",\"level\":\"warning\",\"message\":\"careful\"}\n"
            "{\"tool\":\"demo\",\"level\":\"progress\",\"stage\":\"reading\",\"fraction\":0.5}\n"
            "{\"tool\":\"demo\",\"level\":\"error\",\"message\":\"bad \\\"x\\\"\",\"exit_code\":1}\n");
}

TEST(ToolAppTest, WrongUsageIsJsonWhereAskedFor) {
  const Demo demo({"a", "-o", "out", "--log-json", "--count", "x"});
  EXPECT_TRUE(demo.err.starts_with("{\"tool\":\"demo\",\"level\":\"error\"")) << demo.err;
  EXPECT_EQ(demo.exit_code, 2);
}

TEST(ToolAppTest, TerminationLeavesNoPartialOutput) {
  const fs::path folder = fs::temp_directory_path() / ("priormap_signal_" + std::to_string(::getpid()));
  fs::create_directories(folder);
  const pid_t child = ::fork();
  if (child == 0) {
    char name[] = "demo";
    char* argv[] = {name, nullptr};
    ToolApp app("demo", "");
    app.run(1, argv, [&](const ToolContext&) {
      const priormap::AtomicDirectory output(folder / "prior", priormap::Overwrite::refuse, "prior.json");
      std::ofstream(output.temporary_path() / "half") << "half";
      for (;;) std::this_thread::sleep_for(std::chrono::seconds(1));
    });
    ::_exit(99);
  }
  while (fs::is_empty(folder) || fs::is_empty(fs::directory_iterator(folder)->path()))
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  ::kill(child, SIGTERM);
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 128 + SIGTERM);
  EXPECT_TRUE(fs::is_empty(folder));
  fs::remove_all(folder);
}

}  // namespace
