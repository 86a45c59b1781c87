#include "bench/build.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <stdexcept>

#include <embree3/rtcore.h>

#include "accel/bvh.h"
#include "base/timer.h"
#include "bench/scenes.h"

namespace tachylite::bench {
namespace {

using test::TestMesh;

constexpr BuildSeconds kNever{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};

TestMesh make_mesh(const std::string& name) {
  constexpr uint32_t kSoupTriangles = 1000000;
  return name == "soup" ? test::make_triangle_soup(kSoupTriangles, 0.01f, 1) : make_scene(name).mesh;
}

/// Runs `build` and keeps its time if it took less CPU time than `best`.
template <class Build>
void keep_best(BuildSeconds& best, const Build& build) {
  const Timer wall;
  const CpuTimer cpu;
  build();
  const BuildSeconds seconds{cpu.seconds(), wall.seconds()};
  if (seconds.cpu < best.cpu) best = seconds;
}

template <class T>
void fill_buffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format, const std::vector<T>& values) {
  void* buffer = rtcSetNewGeometryBuffer(geometry, type, 0, format, sizeof(T), values.size());
  std::memcpy(buffer, values.data(), values.size() * sizeof(T));
}

void time_embree(RTCDevice device, const TestMesh& mesh, RTCBuildQuality quality, BuildSeconds& best) {
  RTCScene scene = rtcNewScene(device);
  rtcSetSceneBuildQuality(scene, quality);
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  fill_buffer(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, mesh.vertices);
  fill_buffer(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, mesh.triangles);
  rtcSetGeometryBuildQuality(geometry, quality);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
  keep_best(best, [&] { rtcCommitScene(scene); });
  rtcReleaseScene(scene);
}

void time_ours(const TestMesh& mesh, BuildResult& result) {
  BvhInput input;
  input.vertices = mesh.vertices;
  input.triangles = mesh.triangles;
  Bvh8 bvh;
  keep_best(result.ours, [&] { bvh = build_bvh8(input); });
  const BvhStatistics& s = bvh.statistics;
  result.pair = std::min(result.pair, s.pair_seconds);
  result.tree = std::min(result.tree, s.build_seconds);
  result.optimise = std::min(result.optimise, s.optimise_seconds);
  result.flatten = std::min(result.flatten, s.flatten_seconds);
  result.sah_cost = s.sah_cost8;
}

}  // namespace

std::vector<BuildResult> bench_build(const std::string& only, int repetitions) {
  RTCDevice device = rtcNewDevice("threads=2");
  if (!device) throw std::runtime_error("rtcNewDevice failed");
  std::vector<BuildResult> results;
  for (const std::string& name : build_mesh_names()) {
    if (!only.empty() && name != only) continue;
    const TestMesh mesh = make_mesh(name);
    BuildResult result;
    result.mesh = name;
    result.triangles = mesh.triangles.size();
    result.ours = result.medium = result.high = kNever;
    result.pair = result.tree = result.optimise = result.flatten = kNever.wall;
    for (int i = 0; i < repetitions; ++i) {
      time_ours(mesh, result);
      time_embree(device, mesh, RTC_BUILD_QUALITY_MEDIUM, result.medium);
      time_embree(device, mesh, RTC_BUILD_QUALITY_HIGH, result.high);
    }
    results.push_back(result);
  }
  rtcReleaseDevice(device);
  return results;
}

std::vector<std::string> build_mesh_names() { return {"room", "big", "soup"}; }

}  // namespace tachylite::bench
