#include "command_stats.h"

#include <sys/resource.h>

#include <fstream>

#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/error.h"

namespace tachylite {
namespace {

uint64_t peak_host_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<uint64_t>(usage.ru_maxrss) * 1024;
}

double millions_per_second(uint64_t count, double seconds) {
  return seconds > 0 ? 1e-6 * static_cast<double>(count) / seconds : 0;
}

}  // namespace

double RunStatistics::mpaths_per_s() const {
  return millions_per_second(paths, seconds.render);
}

void write_statistics(const std::filesystem::path& file, const RunStatistics& s) {
  using Json = nlohmann::ordered_json;
  Json kernels = Json::array();
  for (const RunStatistics::Kernel& k : s.kernels)
    kernels.push_back({{"name", k.name}, {"dispatches", k.dispatches}, {"seconds", k.seconds}});
  const Json json = {{"device", s.device},
                     {"spp", s.spp},
                     {"paths", s.paths},
                     {"seconds",
                      {{"load", s.seconds.load},
                       {"bvh", s.seconds.bvh},
                       {"pack", s.seconds.pack},
                       {"upload", s.seconds.upload},
                       {"compile", s.seconds.compile},
                       {"render", s.seconds.render},
                       {"write", s.seconds.write},
                       {"total", s.seconds.total}}},
                     {"rays", {{"closest", s.closest_rays}, {"shadow", s.shadow_rays}}},
                     {"mpaths_per_s", s.mpaths_per_s()},
                     {"mrays_per_s", millions_per_second(s.closest_rays + s.shadow_rays, s.seconds.render)},
                     {"nonfinite", s.nonfinite},
                     {"overflow", s.overflow},
                     {"triangles", s.triangles},
                     {"memory", {{"device", s.device_bytes}, {"host", peak_host_bytes()}}},
                     {"stages", {{"run", s.stages_run}, {"skipped", s.stages_skipped}}},
                     {"kernels", kernels}};
  write_atomically(file, [&](const std::filesystem::path& path) {
    std::ofstream out(path);
    out << json.dump(2) << '\n';
    out.close();
    if (!out) throw RenderError("cannot write " + file.string());
  });
}

}  // namespace tachylite
