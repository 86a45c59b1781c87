#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace tachylite {

/// The figures of --stats, under the names of its JSON.
struct RunStatistics {
  struct Kernel {
    std::string name;
    uint64_t dispatches = 0;
    double seconds = 0;
  };
  std::map<std::string, std::string> device;  // name, driver, type...
  uint64_t spp = 0, paths = 0;
  struct Seconds {
    double load = 0, bvh = 0, pack = 0, upload = 0, compile = 0, render = 0, write = 0, total = 0;
  } seconds;
  uint64_t closest_rays = 0, shadow_rays = 0, nonfinite = 0, overflow = 0, triangles = 0, device_bytes = 0;
  std::vector<std::string> stages_run, stages_skipped;
  std::vector<Kernel> kernels;

  double mpaths_per_s() const;
};

/// Throws RenderError when the file cannot be written.
void write_statistics(const std::filesystem::path& file, const RunStatistics& statistics);

}  // namespace tachylite
