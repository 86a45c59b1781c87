// merge and --resume: parts of a render come to the whole one, bit for bit; what does not fit together is refused.
#include <algorithm>
#include <csignal>

#include <fmt/format.h>

#include "base/timer.h"
#include "image/exr.h"
#include "support/run_program.h"

namespace tachylite::test {
namespace {

const std::string kScene = TACHYLITE_SOURCE_DIR "/scenes/cornell-box/scene.xml";

// Stages, a textured material, an environment, moments and all kinds of auxiliary channels.
const char* const kOtherScene = R"(<scene version="3.0.0"><default name="n" value="12"/>
<integrator type="moment"><integrator type="aov"><string name="aovs" value="p:position,d:depth,a:albedo,i:shape_index,n:sample_count"/>
<integrator type="path"><integer name="max_depth" value="5"/></integrator></integrator></integrator>
<sensor type="perspective"><float name="fov" value="50"/><transform name="to_world">
<lookat origin="900, 3, 2" target="900, 0, -4" up="0, 1, 0"/></transform>
<film type="hdrfilm"><integer name="width" value="$n"/><integer name="height" value="11"/></film></sensor>
<shape type="sphere"><point name="center" x="900" z="-4"/><bsdf type="roughconductor"/></shape>
<shape type="disk"><transform name="to_world"><scale value="5"/><rotate x="1" angle="-90"/>
<translate x="900" y="-1" z="-4"/></transform><bsdf type="diffuse"><texture name="reflectance" type="checkerboard"/></bsdf>
</shape><emitter type="constant"/></scene>)";

bool equal(const Image& a, const Image& b) {
  return a.names == b.names && a.channels == b.channels && a.word_names == b.word_names && a.words == b.words &&
         a.metadata.at("spp") == b.metadata.at("spp") && a.metadata.at("sample_ranges") == b.metadata.at("sample_ranges");
}

class CliMerge : public ProgramTest, public ::testing::WithParamInterface<const char*> {
 protected:
  CliMerge() { write("other.xml", kOtherScene); }

  ProgramResult run(const std::vector<std::string>& arguments, ProgramOptions options = {}) {
    options.folder = folder;
    return run_program(TACHYLITE_PROGRAM, arguments, options);
  }
  ProgramResult render(const std::string& scene, const std::vector<std::string>& options, ProgramOptions run_options = {}) {
    std::vector<std::string> arguments = {GetParam(), scene};
    if (scene == kScene) arguments.insert(arguments.end(), {"-D", "size=20"});
    arguments.insert(arguments.end(), options.begin(), options.end());
    return run(arguments, run_options);
  }
  Image image(const std::string& name) { return read_exr(folder / name); }

  void expect_refused(const std::vector<std::string>& arguments, const std::string& reason) {
    SCOPED_TRACE(fmt::format("{}", fmt::join(arguments, " ")));
    const std::vector<std::string> before = files();
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_NE(result.err.find(reason), std::string::npos) << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_EQ(files(), before);
  }
};

TEST_P(CliMerge, PartsComeToTheWhole) {
  for (const std::string& scene : {kScene, std::string("other.xml")}) {
    SCOPED_TRACE(scene);
    const auto part = [&](const char* name, const char* first, const char* count) {
      const ProgramResult result = render(scene, {"--first-sample", first, "--spp", count, "-o", name});
      ASSERT_EQ(result.exit_code, 0) << result.err;
    };
    part("whole.exr", "0", "26");
    part("a.exr", "0", "8");
    part("b.exr", "8", "4");
    part("c.exr", "12", "14");
    ASSERT_EQ(run({"merge", "a.exr", "b.exr", "c.exr", "-o", "abc.exr"}).exit_code, 0);
    ASSERT_EQ(run({"merge", "c.exr", "a.exr", "b.exr", "-o", "cab.exr", "-o", "cab.png"}).exit_code, 0);
    ASSERT_EQ(run({"merge", "c.exr", "a.exr", "-o", "ca.exr"}).exit_code, 0);
    ASSERT_EQ(run({"merge", "b.exr", "ca.exr", "-o", "bca.exr"}).exit_code, 0);
    EXPECT_EQ(image("ca.exr").metadata.at("sample_ranges"), "0-7,12-25");
    for (const char* merged : {"abc.exr", "cab.exr", "bca.exr"}) EXPECT_TRUE(equal(image(merged), image("whole.exr"))) << merged;
  }
}

TEST_P(CliMerge, ResumeComesToTheWhole) {
  for (const std::string& scene : {kScene, std::string("other.xml")}) {
    SCOPED_TRACE(scene);
    ASSERT_EQ(render(scene, {"--spp", "26", "-o", "whole.exr"}).exit_code, 0);
    ASSERT_EQ(render(scene, {"--spp", "8", "-o", "part.exr"}).exit_code, 0);
    ASSERT_EQ(render(scene, {"--spp", "12", "--resume", "part.exr"}).exit_code, 0);
    ASSERT_EQ(render(scene, {"--spp", "26", "-o", "part.exr", "--resume"}).exit_code, 0);
    EXPECT_TRUE(equal(image("part.exr"), image("whole.exr")));
    // Nothing is left to do.
    ASSERT_EQ(render(scene, {"--spp", "26", "--resume", "part.exr", "-o", "again.exr"}).exit_code, 0);
    EXPECT_TRUE(equal(image("again.exr"), image("whole.exr")));
  }
}

TEST_P(CliMerge, InterruptedAndResumed) {
  const std::string samples = std::string(GetParam()) == "render" ? "20000" : "400";  // a second or so
  ASSERT_EQ(render(kScene, {"--spp", samples, "-o", "whole.exr"}).exit_code, 0);
  const std::string trigger = std::string(GetParam()) == "render" ? "skipped" : "\n";  // the last line before it renders
  // Interrupted once it renders, again and again, until it is done.
  int interrupted = 0;
  for (int attempt = 0; attempt < 100; ++attempt) {
    ProgramOptions options;
    options.signal = [&, timer = Timer(), begun = -1.0](const std::string& err) mutable {
      if (begun < 0 && err.find(trigger) != std::string::npos) begun = timer.seconds();
      return begun >= 0 && timer.seconds() > begun + 0.1 + 0.2 * attempt ? SIGINT : 0;
    };
    std::vector<std::string> arguments = {"--spp", samples, "-o", "part.exr"};
    if (std::filesystem::exists(folder / "part.exr")) arguments.push_back("--resume");
    const ProgramResult result = render(kScene, arguments, options);
    if (result.exit_code == 0) break;
    ASSERT_EQ(result.exit_code, 130) << result.err;
    interrupted += std::filesystem::exists(folder / "part.exr");
  }
  EXPECT_GT(interrupted, 0);
  EXPECT_TRUE(equal(image("part.exr"), image("whole.exr")));
}

TEST_P(CliMerge, WhatDoesNotFitIsRefused) {
  const auto make = [&](const std::string& scene, std::vector<std::string> options) {
    ASSERT_EQ(render(scene, options).exit_code, 0);
  };
  make("other.xml", {"--spp", "8", "-o", "a.exr"});
  make("other.xml", {"--first-sample", "4", "--spp", "8", "-o", "overlap.exr"});
  make("other.xml", {"--first-sample", "8", "--spp", "4", "--seed", "3", "-o", "seed.exr"});
  make("other.xml", {"--first-sample", "8", "--spp", "4", "-D", "n=13", "-o", "size.exr"});
  make("other.xml", {"--first-sample", "8", "--spp", "4", "--aov", "normal", "-o", "aov.exr"});
  make(kScene, {"--first-sample", "8", "--spp", "4", "-o", "scene.exr"});
  make("other.xml", {"--first-sample", "8", "--spp", "4", "--no-sums", "-o", "bare.exr"});
  make("other.xml", {"--first-sample", "8", "--spp", "6", "-o", "b.exr"});
  const std::string command = GetParam();
  ASSERT_EQ(run({command == "render" ? "reference" : "render", "other.xml", "--first-sample", "8", "--spp", "4", "-o",
                 "judge.exr"}).exit_code, 0);

  const auto refused = [&](const std::string& file, const std::string& reason) {
    expect_refused({"merge", "a.exr", file, "-o", "c.exr"}, reason);
  };
  refused("overlap.exr", "samples 4-7");
  refused("a.exr", "samples 0-7");
  refused("seed.exr", "seed");
  refused("size.exr", "scene");
  refused("aov.exr", "channels");
  refused("scene.exr", "scene");
  refused("bare.exr", "sample_ranges");
  refused("judge.exr", "device");
  if (command == "render") {
    make("other.xml", {"--first-sample", "8", "--spp", "64", "--adaptive", "-o", "adaptive.exr"});
    EXPECT_NE(image("adaptive.exr").find("samples"), nullptr);
    refused("adaptive.exr", "sample_ranges");
    expect_refused({command, "other.xml", "--adaptive", "--resume", "a.exr"}, "--resume");
  }
  refused("absent.exr", "absent.exr");
  refused("other.xml", "other.xml");
  expect_refused({"merge", "-o", "c.exr"}, "inputs");
  expect_refused({"merge", "a.exr"}, "--output");
  expect_refused({"merge", "a.exr", "b.exr", "-o", "c.jpg"}, "c.jpg");

  const auto cannot_resume = [&](std::vector<std::string> options, const std::string& reason) {
    std::vector<std::string> arguments = {command, "other.xml", "--quiet"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    expect_refused(arguments, reason);
  };
  cannot_resume({"--spp", "16", "--resume", "seed.exr", "--first-sample", "8"}, "seed");
  cannot_resume({"--spp", "16", "--resume", "scene.exr", "--first-sample", "8"}, "scene");
  cannot_resume({"--spp", "16", "--resume", "b.exr"}, "--first-sample");
  cannot_resume({"--spp", "4", "--resume", "a.exr"}, "--spp");
  cannot_resume({"--spp", "16", "--resume", "absent.exr"}, "absent.exr");
  cannot_resume({"--spp", "16", "--resume", "-o", "x.png"}, ".exr");
  if (command == "render") cannot_resume({"--spp", "16", "--first-sample", "8", "--resume", "b.exr"}, "multiple of 4");

  // The scene's text has changed.
  write("other.xml", std::string(kOtherScene).replace(std::string(kOtherScene).find("\"5\""), 3, "\"6\""));
  cannot_resume({"--spp", "16", "--resume", "a.exr"}, "scene");
}

TEST_P(CliMerge, BrokenFilesAreRefused) {
  ASSERT_EQ(render(kScene, {"--spp", "8", "-o", "a.exr"}).exit_code, 0);
  const Image good = image("a.exr");
  const auto refused = [&](const std::string& reason, const std::function<void(Image&)>& spoil) {
    Image bad = good;
    spoil(bad);
    write_exr(folder / "bad.exr", bad);
    expect_refused({"merge", "bad.exr", "-o", "c.exr"}, reason);
    expect_refused({"merge", "a.exr", "bad.exr", "-o", "c.exr"}, reason);
  };
  for (const char* ranges : {"", "7", "0-", "8-7", "0-7,", "0-7,4-9", "0-7,8-9", "-1-7", "0-99999999999999999999", "a-b", "0-7 "})
    refused("sample_ranges", [&](Image& bad) { bad.metadata["sample_ranges"] = ranges; });
  for (const char* blocks : {"", "0", "-1", "9", "1.5", "x"})
    refused("blocks", [&](Image& bad) { bad.metadata["blocks"] = blocks; });
  for (const char* key : {"fingerprint", "seed", "sampler", "device", "driver", "version"})
    refused(key, [&](Image& bad) { bad.metadata.erase(key); });
  // More blocks than sums can hold, in two files that are right by themselves.
  Image full = good;
  full.metadata["sample_ranges"] = "8-4194311";
  full.metadata["blocks"] = "4194304";
  write_exr(folder / "full.exr", full);
  expect_refused({"merge", "a.exr", "full.exr", "-o", "c.exr"}, "at most 4194304");
  refused("squares.G.2", [](Image& bad) {
    const auto at = std::find(bad.word_names.begin(), bad.word_names.end(), "squares.G.2") - bad.word_names.begin();
    bad.word_names.erase(bad.word_names.begin() + at);
    bad.words.erase(bad.words.begin() + at);
  });
  refused("sums.R", [](Image& bad) {
    const auto at = std::find(bad.word_names.begin(), bad.word_names.end(), "sums.R.0") - bad.word_names.begin();
    bad.words[static_cast<size_t>(at)].assign(bad.words[0].size(), 0x7fffffff);
  });

  // A file cut short anywhere.
  const auto size = std::filesystem::file_size(folder / "a.exr");
  for (const auto keep : {size - 1, size / 2, size / 10, uintmax_t{100}, uintmax_t{3}, uintmax_t{0}}) {
    std::filesystem::copy_file(folder / "a.exr", folder / "bad.exr", std::filesystem::copy_options::overwrite_existing);
    std::filesystem::resize_file(folder / "bad.exr", keep);
    expect_refused({"merge", "bad.exr", "-o", "c.exr"}, "bad.exr");
  }
}

INSTANTIATE_TEST_SUITE_P(Commands, CliMerge, ::testing::Values("render", "reference"),
                         [](const auto& command) { return std::string(command.param); });

}  // namespace
}  // namespace tachylite::test
