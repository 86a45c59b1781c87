#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "command_scene.h"
#include "measure/measure_scene.h"
#include "wavefront/renderer.h"

namespace tachylite {

/// What `bench` is told.
struct BenchArguments {
  std::vector<std::filesystem::path> scenes;
  SceneArguments scene;  // all but the file: for every scene
  std::vector<std::filesystem::path> outputs;  // .json, .html
  MeasureOptions measure;
  std::string clock = "auto";  // cpu, wall, auto: cpu on CPU devices
  std::filesystem::path reference;  // empty: SCENE.reference.exr where there is one, else seed pairs
  std::filesystem::path against;    // empty: none
  std::vector<std::string> externals;
  std::vector<std::string> scaling;  // names of series
  double scaling_seconds = 20;       // a point that takes longer by the clock is a series' last
  std::string device;
  bool adaptive = false;  // a contestant of its own
  SamplerKind sampler = SamplerKind::kSobol;
  Guiding guiding = Guiding::kAuto;
  uint32_t max_paths = RenderOptions{}.max_paths;
  bool json = false, quiet = false;
};

/// Error against time of each scene. Returns the exit code.
int run_bench(const BenchArguments& arguments);

}  // namespace tachylite
