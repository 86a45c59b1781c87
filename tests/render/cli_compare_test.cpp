// compare and verify as a user runs them.
#include <nlohmann/json.hpp>

#include "image/exr.h"
#include "support/run_program.h"

namespace tachylite::test {
namespace {

const std::string kScene = TACHYLITE_SOURCE_DIR "/scenes/cornell-box/scene.xml";

class CliCompare : public ProgramTest {
 protected:
  ProgramResult tachylite(const std::vector<std::string>& arguments) {
    ProgramOptions options;
    options.folder = folder;
    options.seconds = 280;
    return run_program(TACHYLITE_PROGRAM, arguments, options);
  }
  void render(const std::string& file, const std::string& seed, const std::string& sampler = "sobol",
              const std::string& depth = "8") {
    const ProgramResult result = tachylite({"render", kScene, "-D", "size=48", "-D", "max_depth=" + depth,
                                            "--spp", "64", "--seed", seed, "--sampler", sampler, "-o", file});
    ASSERT_EQ(result.exit_code, 0) << result.err;
  }
};

TEST_F(CliCompare, SeedsAndSamplersOfOneSceneAgree) {
  render("a.exr", "1");
  render("b.exr", "2");
  render("c.exr", "3", "independent");
  for (const char* other : {"a.exr", "b.exr", "c.exr"}) {
    const ProgramResult result = tachylite({"compare", "a.exr", other});
    EXPECT_EQ(result.exit_code, 0) << result.out;
    EXPECT_EQ(result.err, "");
    EXPECT_EQ(result.out.substr(result.out.size() - 6), "agree\n") << result.out;
  }
}

TEST_F(CliCompare, ImagesOfDifferentScenesDiffer) {
  render("a.exr", "1");
  render("b.exr", "2", "sobol", "5");  // without the light of later bounces
  const ProgramResult result = tachylite({"compare", "a.exr", "b.exr"});
  EXPECT_EQ(result.exit_code, 1) << result.out;
  EXPECT_NE(result.out.find("differ: means"), std::string::npos) << result.out;
}

TEST_F(CliCompare, Json) {
  render("a.exr", "1");
  render("b.exr", "2", "sobol", "5");
  const ProgramResult result = tachylite({"compare", "a.exr", "b.exr", "--json"});
  EXPECT_EQ(result.exit_code, 1);
  const nlohmann::json json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json.at("agree"), false);
  EXPECT_EQ(json.at("channels").size(), 3u);
  EXPECT_GT(json.at("channels")[0].at("ratio").get<double>(), 1.01);
  EXPECT_GT(json.at("mse").get<double>(), 0);
  EXPECT_GT(json.at("relmse").get<double>(), 0);
  EXPECT_EQ(json.at("nonfinite"), 0);
  EXPECT_EQ(json.at("test").at("level"), 0.01);
}

TEST_F(CliCompare, WithoutVarianceThereIsNoVerdict) {
  Image image;
  image.width = image.height = 4;
  for (const char* name : {"R", "G", "B"}) image.add(name).assign(16, 1.0f);
  write_exr(folder / "a.exr", image);
  image.channels[0][3] = 9;
  write_exr(folder / "b.exr", image);
  const ProgramResult result = tachylite({"compare", "a.exr", "b.exr"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.out.find("agree"), std::string::npos) << result.out;
}

TEST_F(CliCompare, VarianceOfOneSampleFromAFile) {
  Image image;
  image.width = image.height = 32;
  for (const char* name : {"R", "G", "B"}) image.add(name).assign(32 * 32, 1.0f);
  write_exr(folder / "reference.exr", image);
  write_exr(folder / "variance.exr", image);
  for (auto& channel : image.channels)
    for (float& value : channel) value = 1.1f;  // one standard deviation off with 100 samples, everywhere
  write_exr(folder / "a.exr", image);
  const auto verdict = [&](const char* samples) {
    return tachylite({"compare", "a.exr", "reference.exr", "--variance", "variance.exr", "--spp", samples})
        .exit_code;
  };
  EXPECT_EQ(verdict("100"), 1);
  image.channels = std::vector(3, std::vector<float>(32 * 32));
  for (auto& channel : image.channels)
    for (size_t i = 0; i < channel.size(); ++i) channel[i] = i % 2 == 0 ? 1.1f : 0.9f;
  write_exr(folder / "a.exr", image);
  EXPECT_EQ(verdict("100"), 0);
  EXPECT_EQ(verdict("10000"), 1);
}

TEST_F(CliCompare, DifferentSizesAreRefused) {
  Image image;
  for (const int size : {4, 5}) {
    image = {};
    image.width = image.height = size;
    for (const char* name : {"R", "G", "B"}) image.add(name);
    write_exr(folder / (std::to_string(size) + ".exr"), image);
  }
  EXPECT_EQ(tachylite({"compare", "4.exr", "5.exr"}).exit_code, 2);
}

TEST_F(CliCompare, VerifyAgrees) {
  const ProgramResult result = tachylite({"verify", kScene, "-D", "size=48"});
  EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
  EXPECT_EQ(result.out.substr(result.out.size() - 6), "agree\n") << result.out;
}

TEST_F(CliCompare, VerifyWithoutTimeHasNoVerdict) {
  const ProgramResult result = tachylite({"verify", kScene, "-D", "size=64", "--time", "0.05"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.out, "");
  EXPECT_NE(result.err.find("no verdict"), std::string::npos) << result.err;
}

TEST_F(CliCompare, InfoAndDevices) {
  const ProgramResult info = tachylite({"info", kScene});
  EXPECT_EQ(info.exit_code, 0) << info.err;
  for (const char* word : {"36 triangles", "512 x 512", "area", "diffuse", "SAH", "memory plan", "needs not"})
    EXPECT_NE(info.out.find(word), std::string::npos) << word << "\n" << info.out;
  EXPECT_EQ(files(), std::vector<std::string>{});
  const ProgramResult devices = tachylite({"devices"});
  EXPECT_EQ(devices.exit_code, 0) << devices.err;
  EXPECT_EQ(devices.out.rfind("0: ", 0), 0u) << devices.out;
}

}  // namespace
}  // namespace tachylite::test
