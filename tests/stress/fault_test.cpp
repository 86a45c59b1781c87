// What fails under the program: Vulkan calls (by a layer, tests/support/fault_layer), the disk, its own death. It ends
// with the right code and one line that names the call; no file is half-written; a lost device is retried once.

#include <algorithm>
#include <csignal>
#include <fstream>

#include <fmt/format.h>

#include "image/exr.h"
#include "support/run_program.h"

namespace tachylite::test {
namespace {

// Stages, with several buffers and kernels.
const char* const kScene = R"(<scene version="3.0.0"><default name="n" value="16"/><default name="mesh" value=""/>
<integrator type="path"><integer name="max_depth" value="4"/></integrator>
<sensor type="perspective"><float name="fov" value="50"/><transform name="to_world"><translate z="-4"/></transform>
<film type="hdrfilm"><integer name="width" value="$n"/><integer name="height" value="$n"/></film></sensor>
<shape type="sphere"><bsdf type="diffuse"><texture name="reflectance" type="checkerboard"/></bsdf></shape>
<emitter type="constant"/></scene>)";

class Faults : public ProgramTest {
 protected:
  Faults() { write("scene.xml", kScene); }

  ProgramResult render(const std::vector<std::string>& more, const std::string& fault = "", ProgramOptions options = {}) {
    std::vector<std::string> arguments = {options.largest_file > 0 ? "reference" : "render", "scene.xml"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    options.folder = folder;
    if (!fault.empty())
      options.environment = {{"VK_LAYER_PATH", TACHYLITE_FAULT_LAYER ":/usr/share/vulkan/explicit_layer.d"},
                             {"VK_INSTANCE_LAYERS", "VK_LAYER_TACHYLITE_fault"},
                             {"TACHYLITE_FAULT", fault}};
    return run_program(TACHYLITE_PROGRAM, arguments, options);
  }
  // With any of the faults the image is the same, after one more try; not when they go on.
  void expect_retried(const std::vector<std::string>& options, const std::vector<std::string>& faults) {
    ASSERT_EQ(render(options).exit_code, 0);
    const Image whole = read_exr(folder / "a.exr");
    for (const std::string& fault : faults) {
      SCOPED_TRACE(fault);
      std::filesystem::remove(folder / "a.exr");
      const ProgramResult result = render(options, fault);
      ASSERT_EQ(result.exit_code, 0) << result.err;
      EXPECT_NE(result.err.find("VK_ERROR_DEVICE_LOST"), std::string::npos) << result.err;
      EXPECT_NE(result.err.find("once more"), std::string::npos) << result.err;
      const Image image = read_exr(folder / "a.exr");
      EXPECT_EQ(image.channels, whole.channels);
      EXPECT_EQ(image.words, whole.words);
    }
    std::filesystem::remove(folder / "a.exr");
    const ProgramResult result = render(options, "vkWaitForFences:3:-4:1000");
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_NE(result.err.find("vkWaitForFences failed: VK_ERROR_DEVICE_LOST"), std::string::npos) << result.err;
    EXPECT_EQ(files(), std::vector<std::string>{"scene.xml"});
  }
  std::string content(const std::string& name) const {
    std::ifstream stream(folder / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
};

TEST_F(Faults, EveryVulkanCall) {
  struct Case {
    const char *call, *result;
    int code;
    std::vector<int> which;
  };
  const std::vector<Case> cases = {
      {"vkCreateInstance", "VK_ERROR_INITIALIZATION_FAILED", -3, {1}},
      {"vkCreateDevice", "VK_ERROR_OUT_OF_HOST_MEMORY", -1, {1}},
      {"vkCreateCommandPool", "VK_ERROR_OUT_OF_HOST_MEMORY", -1, {1}},
      {"vkAllocateCommandBuffers", "VK_ERROR_OUT_OF_DEVICE_MEMORY", -2, {1}},
      {"vkCreateFence", "VK_ERROR_OUT_OF_HOST_MEMORY", -1, {1}},
      {"vkCreateBuffer", "VK_ERROR_OUT_OF_DEVICE_MEMORY", -2, {1, 9}},
      {"vkAllocateMemory", "VK_ERROR_OUT_OF_DEVICE_MEMORY", -2, {1, 4, 12}},
      {"vkBindBufferMemory", "VK_ERROR_OUT_OF_DEVICE_MEMORY", -2, {3}},
      {"vkMapMemory", "VK_ERROR_MEMORY_MAP_FAILED", -5, {2}},
      {"vkCreateBufferView", "VK_ERROR_OUT_OF_HOST_MEMORY", -1, {2}},
      {"vkCreateDescriptorSetLayout", "VK_ERROR_OUT_OF_HOST_MEMORY", -1, {1}},
      {"vkCreatePipelineLayout", "VK_ERROR_OUT_OF_HOST_MEMORY", -1, {1}},
      {"vkCreateDescriptorPool", "VK_ERROR_FRAGMENTATION", -1000161000, {1}},
      {"vkAllocateDescriptorSets", "VK_ERROR_OUT_OF_POOL_MEMORY", -1000069000, {1}},
      {"vkCreateShaderModule", "VK_ERROR_OUT_OF_HOST_MEMORY", -1, {2}},
      {"vkCreateComputePipelines", "VK_ERROR_OUT_OF_DEVICE_MEMORY", -2, {1, 5}},
      {"vkResetCommandPool", "VK_ERROR_OUT_OF_DEVICE_MEMORY", -2, {2}},
      {"vkBeginCommandBuffer", "VK_ERROR_OUT_OF_HOST_MEMORY", -1, {2}},
      {"vkEndCommandBuffer", "VK_ERROR_OUT_OF_HOST_MEMORY", -1, {2}},
      {"vkResetFences", "VK_ERROR_OUT_OF_DEVICE_MEMORY", -2, {1}},
      {"vkQueueSubmit", "VK_ERROR_OUT_OF_DEVICE_MEMORY", -2, {1, 2}},
      {"vkWaitForFences", "VK_ERROR_OUT_OF_HOST_MEMORY", -1, {1, 2}},
  };
  for (const Case& c : cases)
    for (const int n : c.which) {
      const std::string fault = fmt::format("{}:{}:{}", c.call, n, c.code);
      SCOPED_TRACE(fault);
      const ProgramResult result = render({"--spp", "4", "--quiet"}, fault);
      EXPECT_EQ(result.exit_code, 1);
      EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
      EXPECT_NE(result.err.find(c.call), std::string::npos) << result.err;
      EXPECT_NE(result.err.find(c.result), std::string::npos) << result.err;
      EXPECT_EQ(files(), std::vector<std::string>{"scene.xml"});
    }
}

TEST_F(Faults, AnAdaptiveRenderGoesOn) {
  const std::vector<std::string> options = {"--spp", "64", "--max-paths", "2048", "--adaptive", "-o", "a.exr"};
  ASSERT_EQ(render(options).exit_code, 0);
  const Image whole = read_exr(folder / "a.exr");
  for (const char* fault : {"vkWaitForFences:3:-4", "vkWaitForFences:7:-4"}) {
    SCOPED_TRACE(fault);
    const ProgramResult result = render(options, fault);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.err.find("once more"), std::string::npos) << result.err;
    EXPECT_EQ(read_exr(folder / "a.exr").channels, whole.channels);
  }
}

TEST_F(Faults, ALostDeviceIsRetriedOnce) {
  // The first submissions copy and try each kernel; then each pass is one.
  expect_retried({"--spp", "24", "--max-paths", "1024", "-o", "a.exr"},
                 {"vkCreateDevice:1:-4", "vkQueueSubmit:1:-4", "vkWaitForFences:1:-4", "vkWaitForFences:2:-4",
                  "vkWaitForFences:5:-4", "vkQueueSubmit:4:-4", "vkQueueSubmit:12:-4", "vkWaitForFences:7:-4"});
}

// Either of two that render side by side; the other one ends, too.
TEST_F(Faults, OneOfTwoLostDevicesIsRetriedOnce) {
  expect_retried({"--spp", "24", "--max-paths", "1024", "--side-by-side", "2", "-o", "a.exr"},
                 {"vkCreateDevice:2:-4", "vkCreateDevice:3:-4", "vkWaitForFences:2:-4", "vkWaitForFences:9:-4",
                  "vkWaitForFences:12:-4", "vkQueueSubmit:17:-4"});
}

// By the reference, which writes as the device's render does: a limit on the process's files also hits Mesa 25.0.7, whose
// memory is a file, and which then dies of SIGBUS.
TEST_F(Faults, FullDisk) {
  const std::vector<std::string> exr = {"--spp", "4", "--quiet", "-o", "a.exr"}, png = {"--spp", "4", "--quiet", "-o", "a.png"};
  for (const auto& options : {exr, png}) {
    const std::string name = options.back();
    ProgramOptions unlimited;
    unlimited.largest_file = uint64_t{1} << 40;
    ASSERT_EQ(render(options, "", unlimited).exit_code, 0);
    const std::string before = content(name);
    for (const uint64_t most : {before.size() - 1, before.size() - 200, before.size() / 2, size_t{9}}) {
      SCOPED_TRACE(fmt::format("{} of {} bytes", most, before.size()));
      ProgramOptions limited;
      limited.largest_file = most;
      const ProgramResult result = render(options, "", limited);
      EXPECT_EQ(result.exit_code, 1) << result.err;
      EXPECT_NE(result.err.find("cannot write " + name), std::string::npos) << result.err;
      EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
      EXPECT_EQ(content(name), before);  // the file of before
    }
    std::filesystem::remove(folder / name);
    EXPECT_EQ(files(), std::vector<std::string>{"scene.xml"});
  }
}

TEST_F(Faults, StandardOutputIsFull) {
  ASSERT_EQ(render({"--spp", "4", "-o", "a.exr"}).exit_code, 0);
  const ProgramResult result =
      run_program("/bin/sh", {"-c", std::string(TACHYLITE_PROGRAM) + " compare a.exr a.exr > /dev/full"},
                  {.folder = folder, .environment = {}, .largest_file = 0, .seconds = 60, .signal = nullptr});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find("standard output"), std::string::npos) << result.err;
}

// The part that is being written has a name of its own; the old file stays until the new one is whole.
TEST_F(Faults, KilledWhileWriting) {
  ASSERT_EQ(render({"--spp", "1", "-o", "a.exr"}).exit_code, 0);
  const std::string before = content("a.exr");
  for (const int signal : {SIGKILL, SIGTERM, SIGINT}) {
    ProgramOptions options;
    options.signal = [&](const std::string&) {
      for (const std::string& name : files())
        if (name.find(".part") != std::string::npos) return signal;
      return 0;
    };
    const ProgramResult result = render({"--spp", "1", "-D", "n=400", "-o", "a.exr"}, "", options);
    if (signal == SIGKILL) {
      EXPECT_EQ(result.exit_code, 128 + SIGKILL) << "the image was written before the signal came";
      EXPECT_EQ(content("a.exr"), before);
      for (const std::string& name : files())
        if (name.find(".part") != std::string::npos) std::filesystem::remove(folder / name);
    } else {
      // The first signal lets writing end.
      EXPECT_TRUE(result.exit_code == 0 || result.exit_code == 130) << result.exit_code;
      EXPECT_EQ(read_exr(folder / "a.exr").width, 400);
    }
    EXPECT_EQ(files(), (std::vector<std::string>{"a.exr", "scene.xml"}));
  }
}

TEST_F(Faults, InterruptedAtEachStage) {
  // A height field of 320,000 triangles, so that reading, building and rendering take a while.
  constexpr int kSide = 401;
  std::ofstream mesh(folder / "field.ply", std::ios::binary);
  mesh << "ply\nformat binary_little_endian 1.0\nelement vertex " << kSide * kSide
       << "\nproperty float x\nproperty float y\nproperty float z\nelement face " << 2 * (kSide - 1) * (kSide - 1)
       << "\nproperty list uchar int vertex_indices\nend_header\n";
  for (int i = 0; i < kSide * kSide; ++i) {
    const float p[3] = {static_cast<float>(i % kSide) / 200 - 1, static_cast<float>(i / kSide) / 200 - 1,
                        0.01f * static_cast<float>((i * 7919) % 13)};
    mesh.write(reinterpret_cast<const char*>(p), sizeof p);
  }
  for (int y = 0; y + 1 < kSide; ++y)
    for (int x = 0; x + 1 < kSide; ++x)
      for (int half = 0; half < 2; ++half) {
        const int a = y * kSide + x;
        const int32_t corners[3] = {a, half ? a + kSide + 1 : a + 1, half ? a + kSide : a + kSide + 1};
        mesh.put(3);
        mesh.write(reinterpret_cast<const char*>(corners), sizeof corners);
      }
  mesh.close();
  std::string scene = kScene;
  scene.replace(scene.find("<emitter"), 0, R"(<shape type="ply"><string name="filename" value="field.ply"/></shape>)");
  write("scene.xml", scene);

  const std::vector<std::string> names = {"field.ply", "scene.xml"};
  for (const char* after : {"", "triangles", "skipped"})  // reading; building and compiling; rendering
    for (const int milliseconds : {0, 60}) {
      SCOPED_TRACE(fmt::format("{} ms after '{}'", milliseconds, after));
      ProgramOptions options;
      options.signal = [&, seen = -1](const std::string& err) mutable {
        if (seen < 0 && err.find(after) != std::string::npos) seen = 0;
        return seen >= 0 && 5 * seen++ >= milliseconds ? SIGINT : 0;
      };
      const ProgramResult result = render({"--spp", "100000", "-o", "a.exr"}, "", options);
      EXPECT_EQ(result.exit_code, 130) << result.err;
      if (std::filesystem::exists(folder / "a.exr")) {
        EXPECT_NE(read_exr(folder / "a.exr").metadata.at("spp"), "100000");
        std::filesystem::remove(folder / "a.exr");
      }
      EXPECT_EQ(files(), names);
    }
}

}  // namespace
}  // namespace tachylite::test
