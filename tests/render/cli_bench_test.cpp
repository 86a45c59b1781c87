// `tachylite bench` as a user runs it.
#include <cstdlib>
#include <fstream>
#include <sstream>

#include <nlohmann/json.hpp>

#include "support/run_program.h"

namespace tachylite::test {
namespace {

using Json = nlohmann::json;
const std::string kBox = TACHYLITE_SOURCE_DIR "/scenes/cornell-box/scene.xml";
// The same program as another renderer: its images are those of `bench`, seed by seed.
const std::string kItself = "name=itself;command=" TACHYLITE_PROGRAM
                            " render {scene} -D size=24 --spp {samples} --seed {seed} -o {out} --quiet";

class CliBench : public ProgramTest {
 protected:
  ProgramResult bench(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"bench", "--quiet"});
    ProgramOptions options;
    options.folder = folder;
    options.seconds = 280;
    return run_program(TACHYLITE_PROGRAM, arguments, options);
  }
  std::string read(const std::string& name) const {
    std::ifstream in(folder / name, std::ios::binary);
    return (std::ostringstream() << in.rdbuf()).str();
  }
  void expect_refused(const std::vector<std::string>& arguments, const std::string& reason) {
    const ProgramResult result = bench(arguments);
    EXPECT_EQ(result.exit_code, 2) << reason << ": " << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_NE(result.err.find(reason), std::string::npos) << result.err;
  }
};

TEST_F(CliBench, MeasuresItselfAndAnother) {
  const std::vector<std::string> run = {kBox, "-D", "size=24", "--min-spp", "8", "--spp", "16", "--seeds", "3"};
  std::vector<std::string> arguments = run;
  arguments.insert(arguments.end(), {"--external", kItself, "--json", "-o", "b.json", "-o", "b.html"});
  const ProgramResult result = bench(arguments);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  const Json json = Json::parse(result.out);
  EXPECT_EQ(json, Json::parse(read("b.json")));
  const Json& scene = json.at("scenes")[0];
  EXPECT_EQ(scene.at("name"), "cornell-box");
  EXPECT_EQ(scene.at("error"), "seed pairs");
  for (const Json& renderer : scene.at("renderers")) {
    ASSERT_EQ(renderer.at("levels").size(), 2u);
    double before = 1e9;
    for (const Json& level : renderer.at("levels")) {
      const Json& error = level.at("relmse");
      EXPECT_LT(error.at("low"), error.at("value"));
      EXPECT_GT(error.at("high"), error.at("value"));
      EXPECT_LT(error.at("value"), before);
      before = error.at("value");
      EXPECT_NEAR(level.at("efficiency").at("value").get<double>() * before * level.at("seconds").at("value").get<double>(),
                  1, 1e-9);
      EXPECT_GE(level.at("total_seconds").at("value"), level.at("seconds").at("value"));
    }
    EXPECT_EQ(renderer.at("times").size(), 3u);
    EXPECT_TRUE(renderer.at("times")[2].at("extrapolated"));
  }
  for (const Json& level : scene.at("ratios")[0].at("levels"))
    EXPECT_NEAR(level.at("relmse").at("value").get<double>(), 1, 1e-6);  // the other's file is in float, too
  EXPECT_FALSE(scene.at("stages").empty());

  // The page holds all it needs: no address but that of the SVG standard may stand in it.
  const std::string page = read("b.html");
  EXPECT_NE(page.find("data:image/png;base64,"), std::string::npos);
  for (const char* word : {"http", "src=\"/", "@import", "url(\""}) EXPECT_EQ(page.find(word), std::string::npos) << word;

  // Against itself: the same images, so the same errors.
  arguments = run;
  arguments.insert(arguments.end(), {"--against", "b.json", "--json"});
  const ProgramResult again = bench(arguments);
  ASSERT_EQ(again.exit_code, 0) << again.err;
  const Json against = Json::parse(again.out).at("against");
  ASSERT_EQ(against.size(), 1u);
  for (const Json& level : against[0].at("levels")) {
    EXPECT_DOUBLE_EQ(level.at("relmse").at("value").get<double>(), 1);
    EXPECT_LT(level.at("relmse").at("low"), 1);
  }
}

TEST_F(CliBench, PageWorksInABrowser) {
  if (std::system("command -v chromium >/dev/null") != 0) GTEST_SKIP() << "chromium is not installed";
  ASSERT_EQ(bench({kBox, "-D", "size=16", "--spp", "8", "--seeds", "3", "-o", "b.html"}).exit_code, 0);
  ProgramOptions options;
  options.folder = folder;
  const ProgramResult browser = run_program(
      "/bin/sh", {"-c", "exec chromium --headless --no-sandbox --disable-gpu --user-data-dir=profile --dump-dom b.html"},
      options);
  ASSERT_EQ(browser.exit_code, 0) << browser.err;
  EXPECT_NE(browser.out.find("data-ready=\"2\""), std::string::npos) << "the script has not shown two images";
  EXPECT_NE(browser.out.find("--at: 50%"), std::string::npos) << "the slider does not stand in the middle";
}

TEST_F(CliBench, ErrorsAgainstAReference) {
  ProgramOptions options;
  options.folder = folder;
  ASSERT_EQ(run_program(TACHYLITE_PROGRAM, {"render", kBox, "-D", "size=24", "--spp", "4096", "--seed", "77", "-o", "r.exr",
                                            "--quiet"}, options).exit_code, 0);
  const ProgramResult result =
      bench({kBox, "-D", "size=24", "--min-spp", "16", "--spp", "16", "--seeds", "4", "--reference", "r.exr", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const ProgramResult pairs = bench({kBox, "-D", "size=24", "--min-spp", "16", "--spp", "16", "--seeds", "4", "--json"});
  const auto error = [](const ProgramResult& r) {
    return Json::parse(r.out).at("scenes")[0].at("renderers")[0].at("levels")[0].at("relmse").at("value").get<double>();
  };
  EXPECT_EQ(Json::parse(result.out).at("scenes")[0].at("error"), "r.exr");
  EXPECT_NEAR(error(result) / error(pairs), 1, 0.25);  // relative to other images of the same scene
}

TEST_F(CliBench, Scaling) {
  const ProgramResult result =
      bench({"--scaling", "depth,materials", "--scaling-seconds", "0.001", "--json", "-o", "b.svg"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Json scaling = Json::parse(result.out).at("scaling");
  ASSERT_EQ(scaling.size(), 2u);
  for (const Json& series : scaling) {
    ASSERT_EQ(series.at("points").size(), 1u);
    EXPECT_NE(series.at("note").get<std::string>().find("ended at 1"), std::string::npos);
    EXPECT_GT(series.at("points")[0].at("16 samples [s]"), 0);
  }
  const std::string plots = read("b.svg");
  EXPECT_TRUE(plots.starts_with("<svg xmlns=")) << plots.substr(0, 100);
  for (const char* title : {"seconds against segments of a path", "memory [MiB] against classes of material"})
    EXPECT_NE(plots.find(title), std::string::npos) << title;
}

TEST_F(CliBench, WrongUseIsRefused) {
  write("broken.json", "{\"bench\": 1}");
  write("other.json", R"({"bench": 1, "clock": "wall", "device": "x", "scenes": []})");
  write("word.xml", "<scene version=\"3.0.0\">\n  <integrator type=\"path\"/>\n  <shape type=\"torus\"/>\n</scene>\n");
  expect_refused({}, "scene");
  expect_refused({"absent.xml"}, "absent.xml");
  expect_refused({kBox, "word.xml"}, "word.xml:3:");
  expect_refused({kBox, "--spp", "0"}, "--spp");
  expect_refused({kBox, "--min-spp", "64", "--spp", "32"}, "--min-spp");
  expect_refused({kBox, "--seeds", "2"}, "--seeds");
  expect_refused({kBox, "-o", "report.txt"}, "report.txt");
  expect_refused({kBox, "-o", "nowhere/report.json"}, "nowhere");
  expect_refused({kBox, "--against", "absent.json"}, "absent.json");
  expect_refused({kBox, "--against", "broken.json"}, "broken.json");
  expect_refused({kBox, "--reference", "absent.exr"}, "absent.exr");
  expect_refused({kBox, kBox, "--reference", "absent.exr"}, "--reference");
  expect_refused({kBox, "--external", "name=x"}, "{samples}");
  expect_refused({kBox, "--scaling", "weight"}, "weight");
  expect_refused({kBox, "--scaling", "depth", "--scaling-seconds", "nan"}, "--scaling-seconds");
  expect_refused({kBox, "--clock", "sun"}, "--clock");
  expect_refused({kBox, "-D", "size=16", "--spp", "4", "--seeds", "3", "--clock", "cpu", "--against", "other.json"}, "clock");
}

TEST_F(CliBench, OthersThatFailAreNamed) {
  const auto with = [this](const std::string& command) {
    return bench({kBox, "-D", "size=16", "--spp", "4", "--seeds", "3", "--external", "name=other;command=" + command});
  };
  for (const auto& [command, reason] : std::vector<std::pair<std::string, std::string>>{
           {"echo no licence >&2; exit 3 # {samples} {seed} {out}", "other: ended with exit code 3: no licence"},
           {"kill -9 $$ # {samples} {seed} {out}", "other: ended by signal 9"},
           {"true {samples} {seed} {out}", "other: left no image"},
           {"echo {samples} {seed} > {out}", "other: "}}) {
    const ProgramResult result = with(command);
    EXPECT_EQ(result.exit_code, 1) << command;
    EXPECT_EQ(result.out, "");
    EXPECT_NE(result.err.find(reason), std::string::npos) << result.err;
  }
  const ProgramResult result = with(TACHYLITE_PROGRAM " render " + kBox +
                                    " -D size=8 --spp {samples} --seed {seed} -o {out} --quiet");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("8 x 8"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace tachylite::test
