// render and reference as a user runs them: what is written where, and how they end.
#include <algorithm>
#include <cmath>
#include <csignal>
#include <fstream>

#include <stb/stb_image.h>
#include <nlohmann/json.hpp>

#include "base/read_file.h"
#include "base/timer.h"
#include "image/exr.h"
#include "support/run_program.h"

namespace tachylite::test {
namespace {

constexpr const char* kWidth = "LP_NATIVE_VECTOR_WIDTH";
const std::string kScene = TACHYLITE_SOURCE_DIR "/scenes/cornell-box/scene.xml";

class CliRender : public ProgramTest, public ::testing::WithParamInterface<const char*> {
 protected:
  ProgramResult render(std::vector<std::string> options, const std::string& scene = kScene,
                       ProgramOptions run = {}) {
    std::vector<std::string> arguments = {GetParam(), scene, "-D", "size=24"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    run.folder = folder;
    return run_program(TACHYLITE_PROGRAM, arguments, run);
  }
  bool on_device() const { return std::string(GetParam()) == "render"; }
};

TEST_P(CliRender, WritesTheSceneNameInTheCurrentFolder) {
  const ProgramResult result = render({"--spp", "8"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(files(), std::vector<std::string>{"scene.exr"});
}

TEST_P(CliRender, QuietIsSilent) {
  const ProgramResult result = render({"--spp", "8", "--quiet"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.out + result.err, "");
}

TEST_P(CliRender, SaysWhatRunsAndWhatIsSkipped) {
  const ProgramResult result = render({"--spp", "8"});
  EXPECT_NE(result.err.find("24 x 24"), std::string::npos) << result.err;
  if (on_device()) {
    EXPECT_NE(result.err.find("\nruns: "), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("\nskipped: "), std::string::npos) << result.err;
  }
}

TEST_P(CliRender, ExrHoldsImageVarianceAndMetadata) {
  ASSERT_EQ(render({"--spp", "16", "--seed", "7", "-o", "a.exr"}).exit_code, 0);
  const Image image = read_exr(folder / "a.exr");
  EXPECT_EQ(image.width, 24);
  EXPECT_EQ(image.height, 24);
  for (const char* name : {"R", "G", "B", "variance.R", "variance.G", "variance.B"}) {
    const std::vector<float>* channel = image.find(name);
    ASSERT_TRUE(channel) << name;
    double sum = 0;
    for (float value : *channel) {
      EXPECT_TRUE(std::isfinite(value) && value >= 0);
      sum += value;
    }
    EXPECT_GT(sum, 0) << name;
  }
  EXPECT_EQ(image.metadata.at("spp"), "16");
  EXPECT_EQ(image.metadata.at("seed"), "7");
  EXPECT_EQ(image.metadata.at("scene"), kScene);
  for (const char* name : {"device", "driver", "version"}) EXPECT_NE(image.metadata.at(name), "") << name;
  EXPECT_GT(std::stod(image.metadata.at("seconds")), 0);
}

TEST_P(CliRender, PngIsTheClampedImageInSrgb) {
  ASSERT_EQ(render({"--spp", "8", "-o", "a.exr", "-o", "a.png"}).exit_code, 0);
  EXPECT_EQ(files(), (std::vector<std::string>{"a.exr", "a.png"}));
  const Image image = read_exr(folder / "a.exr");
  const FileBytes file = read_file(folder / "a.png");
  int width = 0, height = 0, channels = 0;
  unsigned char* pixels = stbi_load_from_memory(reinterpret_cast<const unsigned char*>(file.data.get()),
                                                static_cast<int>(file.size), &width, &height, &channels, 3);
  ASSERT_TRUE(pixels);
  ASSERT_EQ(width * height, 24 * 24);
  for (size_t i = 0; i < 24 * 24; ++i) {
    for (size_t c = 0; c < 3; ++c) {
      const double linear = std::clamp<double>((*image.find(std::string(1, "RGB"[c])))[i], 0, 1);
      const double srgb = linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
      ASSERT_NEAR(pixels[3 * i + c], 255 * srgb, 0.51);
    }
  }
  stbi_image_free(pixels);
}

TEST_P(CliRender, SceneGivesTheSamplesAndAFlagWins) {
  ASSERT_EQ(render({"-D", "spp=12", "-o", "a.exr"}).exit_code, 0);
  EXPECT_EQ(read_exr(folder / "a.exr").metadata.at("spp"), "12");
  ASSERT_EQ(render({"-D", "spp=12", "--spp", "8", "-o", "b.exr"}).exit_code, 0);
  EXPECT_EQ(read_exr(folder / "b.exr").metadata.at("spp"), "8");
}

// What one kernel renders takes vectors of 512 bits where the CPU has them, from a shader cache of its own.
TEST_P(CliRender, WidthOfVectorsChangesNoBit) {
  if (!on_device()) GTEST_SKIP() << "the reference has no vectors";
  const auto run = [&](const std::string& name, std::vector<std::string> options, ProgramOptions how) {
    options.insert(options.end(), {"--spp", "8", "-o", name + ".exr"});
    how.environment.emplace_back("MESA_SHADER_CACHE_DIR", (folder / name).string());
    EXPECT_EQ(render(options, kScene, how).exit_code, 0);
    return read_exr(folder / (name + ".exr"));
  };
  const Image chosen = run("chosen", {}, {}), given = run("given", {}, {.environment = {{kWidth, "256"}}});
  run("stages", {"--aov", "depth"}, {});
  EXPECT_EQ(chosen.channels, given.channels);
  EXPECT_FALSE(std::filesystem::exists(folder / "given/vectors-512"));
  EXPECT_FALSE(std::filesystem::exists(folder / "stages/vectors-512"));
  const bool lavapipe = chosen.metadata.at("device").starts_with("llvmpipe");
  if (lavapipe && __builtin_cpu_supports("avx512f")) {
    EXPECT_FALSE(std::filesystem::is_empty(folder / "chosen/vectors-512"));
  }
}

TEST_P(CliRender, SeedDecidesTheImage) {
  ASSERT_EQ(render({"--spp", "8", "--seed", "3", "-o", "a.exr"}).exit_code, 0);
  ASSERT_EQ(
      render({"--spp", "8", "--seed", "3", "--threads", "1", "--max-paths", "1000", "-o", "b.exr"}).exit_code,
      0);
  ASSERT_EQ(render({"--spp", "8", "--seed", "4", "-o", "c.exr"}).exit_code, 0);
  EXPECT_EQ(read_exr(folder / "a.exr").channels, read_exr(folder / "b.exr").channels);
  EXPECT_NE(read_exr(folder / "a.exr").channels, read_exr(folder / "c.exr").channels);
}

TEST_P(CliRender, StatisticsHaveAllKeys) {
  ASSERT_EQ(render({"--spp", "8", "--stats", "s.json"}).exit_code, 0);
  std::ifstream file(folder / "s.json");
  const nlohmann::json stats = nlohmann::json::parse(file);
  for (const char* key : {"device", "spp", "paths", "seconds", "rays", "mpaths_per_s", "mrays_per_s",
                          "nonfinite", "overflow", "triangles", "memory", "stages", "kernels"})
    EXPECT_TRUE(stats.contains(key)) << key;
  for (const char* key : {"load", "bvh", "pack", "upload", "compile", "render", "write", "total"})
    EXPECT_GE(stats.at("seconds").at(key).get<double>(), 0) << key;
  EXPECT_EQ(stats.at("spp"), 8);
  EXPECT_EQ(stats.at("paths"), 8 * 24 * 24);
  EXPECT_EQ(stats.at("triangles"), 36);
  EXPECT_GE(stats.at("rays").at("closest").get<uint64_t>(), uint64_t{8 * 24 * 24});
  EXPECT_GT(stats.at("rays").at("shadow").get<uint64_t>(), 0u);
  EXPECT_EQ(stats.at("nonfinite"), 0);
  EXPECT_EQ(stats.at("overflow"), 0);
  EXPECT_GT(stats.at("memory").at("host").get<uint64_t>(), 0u);
  EXPECT_GT(stats.at("seconds").at("total").get<double>(), stats.at("seconds").at("render").get<double>());
  if (on_device()) {
    EXPECT_GT(stats.at("memory").at("device").get<uint64_t>(), 0u);
    EXPECT_FALSE(stats.at("stages").at("run").empty());
    EXPECT_FALSE(stats.at("stages").at("skipped").empty());
    ASSERT_FALSE(stats.at("kernels").empty());
    for (const auto& kernel : stats.at("kernels")) {
      EXPECT_NE(kernel.at("name"), "");
      EXPECT_GT(kernel.at("dispatches").get<uint64_t>(), 0u);
      EXPECT_GE(kernel.at("seconds").get<double>(), 0);
    }
  }
}

TEST_P(CliRender, AuxiliaryLayers) {
  ASSERT_EQ(render({"--spp", "8", "--aov", "albedo,normal", "--aov", "depth", "-o", "a.exr"}).exit_code, 0);
  const Image image = read_exr(folder / "a.exr");
  for (const char* name :
       {"albedo.R", "albedo.G", "albedo.B", "normal.X", "normal.Y", "normal.Z", "depth.Z"})
    EXPECT_TRUE(image.find(name)) << name;
  // The middle of the picture shows a wall or a box of albedo (0.885809, ...), at most 4.9 away.
  const size_t middle = 24 * 12 + 12;
  EXPECT_NEAR(image.find("albedo.R")->at(middle), 0.885809, 1e-5);
  EXPECT_GT(image.find("depth.Z")->at(middle), 3);
  EXPECT_LT(image.find("depth.Z")->at(middle), 4.9);
}

TEST_P(CliRender, TimeEndsIt) {
  ASSERT_EQ(render({"--time", "0.5", "-o", "a.exr", "--stats", "s.json"}).exit_code, 0);
  std::ifstream file(folder / "s.json");
  const nlohmann::json stats = nlohmann::json::parse(file);
  EXPECT_GE(stats.at("seconds").at("render").get<double>(), 0.4);
  EXPECT_LT(stats.at("seconds").at("render").get<double>(), 20);
  EXPECT_EQ(std::stoull(read_exr(folder / "a.exr").metadata.at("spp")), stats.at("spp").get<uint64_t>());
}

TEST_P(CliRender, ErrorEndsIt) {
  ASSERT_EQ(render({"--error", "0.4", "-o", "a.exr"}).exit_code, 0);
  const uint64_t coarse = std::stoull(read_exr(folder / "a.exr").metadata.at("spp"));
  ASSERT_EQ(render({"--error", "0.2", "-o", "a.exr"}).exit_code, 0);
  const uint64_t fine = std::stoull(read_exr(folder / "a.exr").metadata.at("spp"));
  EXPECT_GT(fine, coarse);
  EXPECT_LT(fine, 100000u);
}

TEST_P(CliRender, InterruptWritesWhatIsFinished) {
  for (const int signal : {SIGINT, SIGTERM}) {
    Timer timer;
    ProgramOptions run;
    // Two seconds after the line that comes when the scene is read, and the device's kernels are compiled.
    const char* const line = on_device() ? "skipped: " : "\n";
    run.signal = [&, begun = -1.0](const std::string& err) mutable {
      if (begun < 0 && err.find(line) != std::string::npos) begun = timer.seconds();
      return begun >= 0 && timer.seconds() > begun + 2 ? signal : 0;
    };
    const ProgramResult result = render({"--spp", "1000000", "-o", "a.exr"}, kScene, run);
    EXPECT_EQ(result.exit_code, 130) << result.err;
    EXPECT_EQ(files(), std::vector<std::string>{"a.exr"});
    const Image image = read_exr(folder / "a.exr");
    const uint64_t samples = std::stoull(image.metadata.at("spp"));
    EXPECT_GT(samples, 0u);
    EXPECT_LT(samples, 1000000u);
    double mean = 0;
    for (float value : *image.find("R")) mean += value / (24.0 * 24.0);
    EXPECT_NEAR(mean, 0.239, 0.02);
  }
}

TEST_P(CliRender, EarlyInterruptEndsAtOnce) {
  ProgramOptions run;
  run.seconds = 20;
  run.signal = [](const std::string&) { return SIGINT; };
  EXPECT_EQ(render({"--spp", "1000000"}, kScene, run).exit_code, 130);
}

TEST_P(CliRender, AFailedWriteLeavesTheOldFile) {
  // The name is free to be made when it is checked, and taken by a folder when the image is to be written.
  ProgramOptions run;
  run.signal = [&, made = false](const std::string& err) mutable {
    if (!made && err.find('\n') != std::string::npos) {
      std::filesystem::create_directory(folder / "a.exr");
      made = true;
    }
    return 0;
  };
  const ProgramResult result = render({"--time", "1", "-o", "a.exr"}, kScene, run);
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_NE(result.err.find("a.exr"), std::string::npos);
  EXPECT_EQ(files(), std::vector<std::string>{"a.exr"});
}

INSTANTIATE_TEST_SUITE_P(Commands, CliRender, ::testing::Values("render", "reference"),
                         [](const auto& command) { return std::string(command.param); });

}  // namespace
}  // namespace tachylite::test
