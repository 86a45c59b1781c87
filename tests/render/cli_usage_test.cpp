// Wrong command lines: exit code 2, one line on stderr, nothing on stdout, no file.
#include <algorithm>

#include "support/run_program.h"

namespace tachylite::test {
namespace {

const char* const kBlackScene = R"(<scene version="3.0.0">
  <integrator type="path"/>
  <sensor type="perspective"><float name="fov" value="40"/>
    <film type="hdrfilm"><integer name="width" value="8"/><integer name="height" value="8"/></film>
  </sensor>
  <shape type="sphere"/>
</scene>)";

class CliUsage : public ProgramTest {
 protected:
  ProgramResult tachylite(const std::vector<std::string>& arguments) {
    ProgramOptions options;
    options.folder = folder;
    return run_program(TACHYLITE_PROGRAM, arguments, options);
  }

  void expect_refused(const std::vector<std::string>& arguments, const std::string& reason) {
    std::string line;
    for (const std::string& argument : arguments) line += argument + " ";
    SCOPED_TRACE(line);
    const std::vector<std::string> before = files();
    const ProgramResult result = tachylite(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_NE(result.err.find(reason), std::string::npos) << result.err;
    EXPECT_EQ(files(), before);
  }
};

TEST_F(CliUsage, NoOrUnknownCommand) {
  expect_refused({}, "subcommand");
  expect_refused({"paint"}, "paint");
  expect_refused({"--colour"}, "--colour");
}

TEST_F(CliUsage, HelpAndVersionSucceed) {
  for (const char* word : {"render", "reference", "verify", "compare", "bench", "info", "devices"}) {
    const ProgramResult help = tachylite({word, "--help"});
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_NE(help.out.find(word), std::string::npos);
  }
  EXPECT_EQ(tachylite({"--help"}).exit_code, 0);
  const ProgramResult version = tachylite({"--version"});
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_EQ(version.out.rfind("tachylite ", 0), 0u);
}

TEST_F(CliUsage, OptionsOfRenderAndReference) {
  write("s.xml", kBlackScene);
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{"--spp", "0"}, "--spp"},
      {{"--spp", "-4"}, "--spp"},
      {{"--spp", "1e9"}, "--spp"},
      {{"--spp", "many"}, "--spp"},
      {{"--spp", "99999999999999999999"}, "--spp"},
      {{"--spp"}, "--spp"},
      {{"--seed", "-1"}, "--seed"},
      {{"--seed", "4294967296"}, "--seed"},
      {{"--time", "0"}, "--time"},
      {{"--time", "-1"}, "--time"},
      {{"--time", "nan"}, "--time"},
      {{"--error", "0"}, "--error"},
      {{"--error", "-0.1"}, "--error"},
      {{"--error", "nan"}, "--error"},
      {{"--sampler", "halton"}, "--sampler"},
      {{"--max-paths", "0"}, "--max-paths"},
      {{"--side-by-side", "0"}, "--side-by-side"},
      {{"--side-by-side", "65"}, "--side-by-side"},
      {{"--max-paths", "-1"}, "--max-paths"},
      {{"--max-paths", "4000000000"}, "--max-paths"},
      {{"--threads", "-1"}, "--threads"},
      {{"--threads", "100000"}, "--threads"},
      {{"--sensor", "-1"}, "--sensor"},
      {{"--sensor", "1"}, "--sensor"},
      {{"--first-sample", "-4"}, "--first-sample"},
      {{"--first-sample", "6"}, "multiple"},
      {{"--aov", "beauty"}, "beauty"},
      {{"-D", "novalue"}, "novalue"},
      {{"-D", "=1"}, "=1"},
      {{"--colour"}, "--colour"},
      {{"second.xml"}, "second.xml"},
      {{"-o", "out.jpg"}, "out.jpg"},
      {{"-o", "out"}, "out"},
      {{"-o", "nowhere/out.exr"}, "nowhere"},
      {{"-o", "s.xml/out.exr"}, "s.xml"},
      {{"-o", "/proc/out.exr"}, "/proc"},
      {{"-o", "good.exr", "-o", "nowhere/out.png"}, "nowhere"},
      {{"--stats", "nowhere/stats.json"}, "nowhere"},
  };
  for (const char* command : {"render", "reference"}) {
    for (const auto& [options, reason] : cases) {
      std::vector<std::string> arguments = {command, "s.xml"};
      arguments.insert(arguments.end(), options.begin(), options.end());
      expect_refused(arguments, reason);
    }
    expect_refused({command}, "scene");
    expect_refused({command, "absent.xml"}, "absent.xml");
    expect_refused({command, "."}, ".");
  }
  std::filesystem::create_directory(folder / "folder.exr");
  expect_refused({"render", "s.xml", "-o", "folder.exr"}, "folder.exr");
}

TEST_F(CliUsage, Devices) {
  write("s.xml", kBlackScene);
  for (const char* command : {"render", "verify", "info"}) {
    expect_refused({command, "s.xml", "--device", "99"}, "99");
    expect_refused({command, "s.xml", "--device", "no such device"}, "no such device");
  }
}

TEST_F(CliUsage, BrokenScenesNameTheLine) {
  write("cut.xml", "<scene version=\"3.0.0\">\n  <sensor type=\"perspective\">\n");
  write("word.xml",
        "<scene version=\"3.0.0\">\n  <integrator type=\"path\"/>\n  <shape type=\"torus\"/>\n</scene>\n");
  for (const char* command : {"render", "reference", "verify", "info"}) {
    expect_refused({command, "cut.xml"}, "cut.xml:");
    expect_refused({command, "word.xml"}, "word.xml:3:");
  }
}

TEST_F(CliUsage, Compare) {
  write("text.exr", "not an image");
  expect_refused({"compare"}, "a");
  expect_refused({"compare", "text.exr"}, "b");
  expect_refused({"compare", "absent.exr", "text.exr"}, "absent.exr");
  expect_refused({"compare", "text.exr", "text.exr"}, "text.exr");
  expect_refused({"compare", "a.exr", "b.exr", "--variance", "v.exr"}, "--spp");
  expect_refused({"compare", "a.exr", "b.exr", "--spp", "16"}, "--variance");
  expect_refused({"compare", "a.exr", "b.exr", "--variance", "v.exr", "--spp", "0"}, "--spp");
}

}  // namespace
}  // namespace tachylite::test
