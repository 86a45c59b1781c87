#include "bench/rays.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "accel/bvh.h"
#include "base/timer.h"
#include "bench/diffuse_scene.h"
#include "bench/embree_scene.h"
#include "bench/ray_sets.h"
#include "bench/scenes.h"
#include "support/tracer.h"
#include "vulkan/device.h"
#include "vulkan/vector_width.h"

namespace tachylite::bench {
namespace {

using test::TraceHit;
using test::Tracer;

constexpr int kCores = 2;

size_t count_mismatches(const std::vector<TraceHit>& ours, const std::vector<TraceHit>& theirs, bool any_hit) {
  size_t mismatches = 0;
  for (size_t i = 0; i < ours.size(); ++i) {
    const bool a = ours[i].id != gpu::kNoHit, b = theirs[i].id != gpu::kNoHit;
    mismatches += a != b || (a && !any_hit && std::abs(ours[i].t - theirs[i].t) > 1e-4f * theirs[i].t);
  }
  return mismatches;
}

RaysResult bench_set(const RaySet& set, const EmbreeScene& embree, Tracer& tracer, int repetitions) {
  RaysResult result;
  result.rays = set.name;
  const auto query = set.any_hit ? Tracer::Query::kAny : Tracer::Query::kClosest;
  std::vector<TraceHit> theirs(set.rays.size());
  tracer.set_rays(set.rays);
  tracer.run(query);  // compiles
  double seconds = std::numeric_limits<double>::infinity(), embree_seconds = seconds;
  for (int i = 0; i < repetitions; ++i) {
    CpuTimer timer;
    if (set.any_hit)
      embree.occluded(set.rays, theirs, kCores);
    else
      embree.closest(set.rays, theirs, kCores);
    embree_seconds = std::min(embree_seconds, timer.seconds());
    timer = CpuTimer();
    tracer.run(query);
    seconds = std::min(seconds, timer.seconds());
  }
  result.mrays = 1e-6 * kCores * static_cast<double>(set.rays.size()) / seconds;
  result.embree_mrays = 1e-6 * kCores * static_cast<double>(set.rays.size()) / embree_seconds;
  result.mismatches = count_mismatches(tracer.hits(), theirs, set.any_hit);
  return result;
}

void bench_sets(const BenchScene& scene, Tracer& tracer, int repetitions, std::vector<RaysResult>& results) {
  const EmbreeScene embree(scene.mesh);
  for (const RaySet& set : make_ray_sets(scene, embree)) {
    results.push_back(bench_set(set, embree, tracer, repetitions));
    results.back().scene = scene.name;
  }
}

}  // namespace

std::vector<RaysResult> bench_rays(const std::string& only, int repetitions) {
  std::vector<RaysResult> results;
  vulkan::Device device;
  for (const std::string& name : scene_names()) {
    if (!only.empty() && name != only) continue;
    const BenchScene scene = make_scene(name);
    BvhInput input;
    input.vertices = scene.mesh.vertices;
    input.triangles = scene.mesh.triangles;
    Tracer tracer(device, build_bvh8(input));
    bench_sets(scene, tracer, repetitions, results);
  }
  return results;
}

std::vector<RaysResult> bench_baked_rays(const std::string& only, int repetitions) {
  std::vector<RaysResult> results;
  vulkan::prefer_wide_vectors();
  vulkan::Device device;
  for (const std::string& name : only.empty() ? tiny_scene_names() : std::vector{only}) {
    const BenchScene scene = make_scene(name);
    Tracer tracer(device, bake_scene(scene));
    bench_sets(scene, tracer, repetitions, results);
  }
  return results;
}

}  // namespace tachylite::bench
