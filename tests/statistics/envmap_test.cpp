// Environment maps: the lookup, the density of the samples (against the image, in double), and the identities.
//
// Each chi2 test draws 1e5 samples; the bins are cells of the texel grid (or blocks of them), over which the bilinear
// density is integrated exactly: mean of the corners times the solid angle. Together they have a level of 1 %; each
// sees a relative deviation of the density of a few per cent with a power of 0.99 (see its message).

#include <cmath>
#include <functional>

#include <fmt/format.h>

#include "base/pi.h"
#include "shared/features.h"
#include "statistics/light_harness.h"
#include "support/chi2.h"

namespace tachylite::test {
namespace {

using glm::dvec2;
using glm::dvec3;
constexpr size_t kSamples = 100000;
constexpr int kChi2Tests = 10;

using Pixel = std::function<dvec3(int x, int y)>;

std::shared_ptr<const Bitmap> bitmap_of(int width, int height, const Pixel& pixel) {
  auto bitmap = std::make_shared<Bitmap>();
  bitmap->width = width;
  bitmap->height = height;
  bitmap->channels = 3;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c) bitmap->floats.push_back(static_cast<float>(pixel(x, y)[c]));
  return bitmap;
}

Scene environment_scene(std::shared_ptr<const Bitmap> bitmap, double scale = 1, const glm::dmat4& to_world = glm::dmat4(1)) {
  Scene scene;
  add_shape(scene, SphereShape{}, glm::dmat4(1));
  add_emitter(scene, EnvironmentEmitter{std::move(bitmap), false, scale, to_world});
  return scene;
}

/// The image in double: bilinear in (phi, theta), columns centred at x + 0.5, rows on the grid pi y / (H - 1).
struct ExactMap {
  const Bitmap& bitmap;
  int width = bitmap.width, height = bitmap.height;

  dvec3 texel(int x, int y) const {
    const int i = 3 * (std::min(y, height - 1) * width + ((x % width) + width) % width);
    const auto at = [&](int c) { return double{bitmap.floats[static_cast<size_t>(i + c)]}; };
    return {at(0), at(1), at(2)};
  }
  double value(int x, int y) const {
    const dvec3 c = texel(x, y);
    return (c.x + c.y + c.z) / 3;
  }
  int rows() const { return std::max(height, 2); }
  double cos_row(int y) const { return std::cos(kPi * y / (rows() - 1)); }

  dvec3 lookup(const dvec3& d) const {
    const double x = std::atan2(d.x, -d.z) / (2 * kPi) * width - 0.5;
    const double y = std::atan2(std::hypot(d.x, d.z), d.y) / kPi * (rows() - 1);
    const int x0 = static_cast<int>(std::floor(x)), y0 = std::clamp(static_cast<int>(y), 0, rows() - 2);
    const double fx = x - x0, fy = y - y0;
    return (1 - fy) * ((1 - fx) * texel(x0, y0) + fx * texel(x0 + 1, y0)) +
           fy * ((1 - fx) * texel(x0, y0 + 1) + fx * texel(x0 + 1, y0 + 1));
  }
  /// Integral over the part [fx0, fx1] x [fs0, fs1] of the cell between texels (x, y) and (x + 1, y + 1) of the
  /// interpolant, bilinear in phi and cos(theta), of max(value - subtracted, 0): its value in the middle times the
  /// solid angle.
  double cell(int x, int y, double subtracted, dvec2 low = dvec2(0), dvec2 high = dvec2(1)) const {
    const auto above = [&](int i, int j) { return std::max(value(i, j) - subtracted, 0.0); };
    const dvec2 f = 0.5 * (low + high), size = high - low;
    const double mean = (1 - f.y) * ((1 - f.x) * above(x, y) + f.x * above(x + 1, y)) +
                        f.y * ((1 - f.x) * above(x, y + 1) + f.x * above(x + 1, y + 1));
    return mean * (2 * kPi / width) * (cos_row(y) - cos_row(y + 1)) * size.x * size.y;
  }
  double total(double subtracted) const {
    double sum = 0;
    for (int y = 0; y + 1 < rows(); ++y)
      for (int x = 0; x < width; ++x) sum += cell(x, y, subtracted);
    return sum;
  }
};

struct MapCase {
  const char* name;
  int width, height;
  Pixel pixel;
};

dvec3 sky(int x, int y) { return dvec3(0.2 + 0.1 * ((7 * x + 3 * y) % 5), 0.3, 0.4 + 0.05 * ((x * y) % 7)); }

std::vector<MapCase> map_cases() {
  return {{"1x1", 1, 1, [](int, int) { return dvec3(0.7); }},
          {"3x5", 3, 5, [](int x, int y) { return dvec3(1 + x, 0.5 * y, (x * y) % 3); }},
          {"2x1", 2, 1, [](int x, int) { return dvec3(x == 0 ? 0.1 : 2, 1, 1); }},
          {"4x3 pole", 4, 3, [](int x, int y) { return dvec3(y == 0 ? 10.0 + x : 0.1); }},
          {"black half", 64, 32, [](int x, int y) { return x < 32 ? dvec3(0) : sky(x, y); }},
          {"bright corner", 64, 32, [](int x, int y) { return x == 0 && y == 31 ? dvec3(1e5) : sky(x, y); }},
          {"sun", 1024, 512, [](int x, int y) {
             const double dx = std::min(x + 1, 1023 - x), dy = y - 200, r = std::sqrt(dx * dx + dy * dy);
             return (r == 0 ? dvec3(1e5) : dvec3(200 * std::exp(-r / 12), 0, 0)) + sky(x, y);
           }}};
}

std::vector<LightQuery> random_queries(size_t count, uint32_t seed) {
  Uniform uniform(seed);
  std::vector<LightQuery> queries(count);
  for (LightQuery& q : queries) q = {{0, 0, 0}, {0, 0, 0}, uniform.two(), uniform()};
  return queries;
}

std::vector<LightHit> escapes(std::span<const dvec3> directions) {
  std::vector<LightHit> hits(directions.size());
  for (size_t i = 0; i < hits.size(); ++i) hits[i].d = glm::vec3(directions[i]);
  return hits;
}

class Envmap : public DeviceTest {};

TEST_F(Envmap, SamplesFollowTheBilinearImage) {
  uint32_t seed = 1;
  for (const bool compensate : {true, false}) {
    for (const MapCase& c : map_cases()) {
      // A constant image is sampled only where nothing is subtracted.
      if (compensate ? c.width == 1 : c.width == 64) continue;
      SCOPED_TRACE(fmt::format("{}, {}", c.name, compensate ? "compensated" : "plain"));
      const auto bitmap = bitmap_of(c.width, c.height, c.pixel);
      const ExactMap exact{*bitmap};
      Scene scene = environment_scene(bitmap);
      if (!compensate) scene.integrator.strategy = Integrator::Strategy::kEmitterOnly;
      LightHarness harness(scene);
      const double subtracted = compensate ? exact.total(0) / (4 * kPi) : 0, total = exact.total(subtracted);

      // Bins: blocks of 16 cells, cells, or 64 parts of a cell.
      const int rows = exact.rows() - 1, block = c.width > 100 ? 4 : 1, parts = c.width < 10 ? 8 : 1;
      const int nx = (c.width * parts + block - 1) / block, ny = (rows * parts + block - 1) / block;
      std::vector<double> observed(static_cast<size_t>(nx * ny)), expected(observed.size());
      const auto bin = [&](int x, int y) { return static_cast<size_t>(y / block * nx + x / block); };
      for (int y = 0; y < rows * parts; ++y)
        for (int x = 0; x < c.width * parts; ++x) {
          const dvec2 low = dvec2(x % parts, y % parts) / double(parts);
          expected[bin(x, y)] +=
              kSamples * exact.cell(x / parts, y / parts, subtracted, low, low + 1.0 / parts) / total;
        }
      for (const LightAnswer& a : harness.sample(random_queries(kSamples, seed++))) {
        ASSERT_GT(a.pdf, 0);
        ASSERT_NEAR(glm::length(a.wi), 1, 1e-6);
        const dvec3 d(a.wi);
        const double turns = std::atan2(d.x, -d.z) / (2 * kPi) - 0.5 / c.width;
        const int row = std::clamp(static_cast<int>(std::atan2(std::hypot(d.x, d.z), d.y) / kPi * rows), 0, rows - 1);
        const double s = (exact.cos_row(row) - d.y) / (exact.cos_row(row) - exact.cos_row(row + 1));
        const int x = static_cast<int>((turns - std::floor(turns)) * c.width * parts);
        const int y = row * parts + std::clamp(static_cast<int>(s * parts), 0, parts - 1);
        ++observed[bin(std::min(x, c.width * parts - 1), y)];
      }
      // A direction's rounding may carry a sample over a cell's border into a cell of density 0.
      for (size_t i = 0; i < observed.size(); ++i)
        if (expected[i] == 0 && observed[i] < 5) observed[i] = 0;
      double kept = 0;
      for (double o : observed) kept += o;
      for (double& e : expected) e *= kept / kSamples;
      const Chi2Result result = chi2_test(observed, expected, sidak(0.01, kChi2Tests));
      EXPECT_TRUE(result.accepted) << result.message;
    }
  }
}

TEST_F(Envmap, LookupAndDensityAgreeWithTheImageEverywhere) {
  Uniform uniform(3);
  std::vector<dvec3> directions = {{0, 1, 0}, {0, -1, 0}, {0, 0, -1}, {1e-4, 1, 1e-5}, {-1e-7, 0, -1}, {1e-7, 0, -1},
                                   {0, 0, 1}, {1e-3, -1, 0}, {1, 0, 0}};
  for (int i = 0; i < 5000; ++i) {
    const double z = 2 * uniform() - 1.0, phi = 2 * kPi * double{uniform()}, r = std::sqrt(1 - z * z);
    directions.emplace_back(r * std::cos(phi), z, r * std::sin(phi));
  }
  for (dvec3& d : directions) d = dvec3(glm::vec3(glm::normalize(d)));
  const glm::dmat4 turn = placed({0, 0, 0}, dvec3(1), glm::normalize(dvec3(1, 2, -1)), 77);
  for (const MapCase& c : map_cases()) {
    if (c.width == 1) continue;
    SCOPED_TRACE(c.name);
    const auto bitmap = bitmap_of(c.width, c.height, c.pixel);
    const ExactMap exact{*bitmap};
    const double mean = exact.total(0) / (4 * kPi), total = exact.total(mean);
    LightHarness harness(environment_scene(bitmap, 2.5, turn));
    std::vector<dvec3> world;
    for (const dvec3& d : directions) world.push_back(glm::dmat3(turn) * d);
    const std::vector<LightValue> values = harness.evaluate(escapes(world));
    double largest = 0;
    for (int y = 0; y < c.height; ++y)
      for (int x = 0; x < c.width; ++x) largest = std::max(largest, exact.value(x, y));
    for (size_t i = 0; i < values.size(); ++i) {
      const dvec3 map_d = glm::transpose(glm::dmat3(turn)) * dvec3(glm::vec3(world[i]));
      // A direction is known to 1e-7: times the steepest slope of the image. At the poles any value of the row is as
      // good as another.
      const double sine = std::hypot(map_d.x, map_d.z), slope = 3e-7 / std::max(sine, 1e-9) * c.width * largest;
      for (int k = 0; k < 3; ++k)
        ASSERT_NEAR(double{values[i].radiance[k]}, 2.5 * exact.lookup(map_d)[k], 2.5 * (slope + 1e-6 * largest)) << i;
      ASSERT_GE(values[i].pdf, 0);
    }
    // The density integrates to 1: midpoints in each cell, where it is bilinear.
    if (c.width > 100) continue;
    std::vector<dvec3> points;
    std::vector<double> weights;
    constexpr int kPoints = 2;
    const int rows = exact.rows() - 1;
    for (int y = 0; y < rows * kPoints; ++y)
      for (int x = 0; x < c.width * kPoints; ++x) {
        const int row = y / kPoints;
        const double s = (y % kPoints + 0.5) / kPoints, phi = 2 * kPi * (0.5 + (x + 0.5) / kPoints) / c.width;
        const double cosine = (1 - s) * exact.cos_row(row) + s * exact.cos_row(row + 1);
        const double sine = std::sqrt(1 - cosine * cosine);
        points.push_back(glm::dmat3(turn) * dvec3(std::sin(phi) * sine, cosine, -std::cos(phi) * sine));
        weights.push_back((exact.cos_row(row) - exact.cos_row(row + 1)) / kPoints * 2 * kPi / (c.width * kPoints));
      }
    double integral = 0;
    const std::vector<LightValue> densities = harness.evaluate(escapes(points));
    for (size_t i = 0; i < densities.size(); ++i) integral += double{densities[i].pdf} * weights[i];
    EXPECT_NEAR(integral, 1, 2e-5);
    EXPECT_GT(total, 0);
  }
}

TEST_F(Envmap, BothSidesOfMisAgree) {
  for (const MapCase& c : map_cases()) {
    if (c.width == 1) continue;
    LightHarness harness(environment_scene(bitmap_of(c.width, c.height, c.pixel), 3,
                                           placed({0, 0, 0}, dvec3(1), {0, 1, 0}, 33)));
    const std::vector<LightAnswer> answers = harness.sample(random_queries(5000, 9));
    std::vector<dvec3> directions;
    for (const LightAnswer& a : answers) directions.emplace_back(a.wi);
    const std::vector<LightValue> values = harness.evaluate(escapes(directions));
    double largest = 0;
    for (const LightAnswer& a : answers) largest = std::max(largest, double{a.pdf});
    for (size_t i = 0; i < answers.size(); ++i) {
      ASSERT_NEAR(values[i].pdf, answers[i].pdf, 3e-7 * c.width * largest) << c.name;
      ASSERT_EQ(answers[i].target, 0xffffffffu);
      ASSERT_EQ(answers[i].to_light, answers[i].wi);
    }
  }
}

TEST_F(Envmap, ConstantImageIsTheConstantEmitter) {
  for (const glm::ivec2 size : {glm::ivec2(1, 1), glm::ivec2(2, 1), glm::ivec2(3, 5), glm::ivec2(64, 32)}) {
    LightHarness map(environment_scene(bitmap_of(size.x, size.y, [](int, int) { return dvec3(0.5, 0.7, 0.9); }), 2));
    Scene constant;
    add_shape(constant, SphereShape{}, glm::dmat4(1));
    add_emitter(constant, ConstantEmitter{{1.0, 1.4, 1.8}});
    LightHarness uniform(constant);
    // Neither is sampled where the material's samples meet it anyway.
    EXPECT_EQ(map.lights().selection, gpu::kSelectNone);
    EXPECT_EQ(uniform.lights().selection, gpu::kSelectNone);
    std::vector<dvec3> directions;
    Uniform random(5);
    for (int i = 0; i < 1000; ++i)
      directions.push_back(glm::normalize(dvec3(random(), random(), random()) - 0.5));
    const auto a = map.evaluate(escapes(directions)), b = uniform.evaluate(escapes(directions));
    for (size_t i = 0; i < a.size(); ++i)
      for (int k = 0; k < 3; ++k) ASSERT_NEAR(a[i].radiance[k], b[i].radiance[k], 2.4e-7f * b[i].radiance[k]);
  }
}

TEST_F(Envmap, SunIsFoundByEverySample) {
  // One pixel of 1e5 over a black sky: radiance over density is the same for all samples, as the density is the
  // image up to theta against cos(theta) within a pixel.
  const auto bitmap = bitmap_of(512, 256, [](int x, int y) { return x == 300 && y == 90 ? dvec3(1e5) : dvec3(0); });
  LightHarness harness(environment_scene(bitmap));
  const double exact = ExactMap{*bitmap}.total(0);
  for (const LightAnswer& a : harness.sample(random_queries(20000, 11)))
    if (a.radiance.x > 1) {
      ASSERT_NEAR(double{a.radiance.x} / double{a.pdf}, exact, 0.01 * exact);
    }
}

TEST_F(Envmap, ConstantIsSampledWhereNothingElseFindsIt) {
  // Emitter sampling only: by the cosine over a surface, uniformly over a point in a medium.
  Scene scene;
  add_shape(scene, SphereShape{}, glm::dmat4(1));
  add_emitter(scene, ConstantEmitter{dvec3(2)});
  scene.integrator.strategy = Integrator::Strategy::kEmitterOnly;
  LightHarness harness(scene);
  const glm::vec3 n = glm::normalize(glm::vec3(1, -2, 0.5f));
  std::vector<LightQuery> queries = random_queries(1000, 21);
  for (LightQuery& q : queries) q.n = n;
  for (const LightAnswer& a : harness.sample(queries)) {
    const double cosine = glm::dot(dvec3(n), dvec3(a.wi));
    if (cosine > 1e-2) {
      ASSERT_NEAR(2 * cosine / double{a.pdf}, 2 * kPi, 1e-4);
    }
    ASSERT_GT(cosine, -1e-6);
  }
  double everywhere = 0;
  for (const LightAnswer& a : harness.sample(random_queries(1000, 22))) everywhere += 2 / double{a.pdf} / 1000;
  EXPECT_NEAR(everywhere, 8 * kPi, 1e-4);
}

}  // namespace
}  // namespace tachylite::test
