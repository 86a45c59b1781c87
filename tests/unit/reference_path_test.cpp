// Whole images of the reference with known answers. Means of images are held to 5 standard errors (level 6e-7
// each, two-sided), which must be below the stated fraction of the mean; 7.3 of them are seen with power
// 0.99.

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/parallel.h"
#include "unit/reference_support.h"

namespace tachylite {
namespace {

using namespace reference;
using namespace test;

void expect_image(const Scene& scene, uint64_t samples, double expected, double resolution, int channel = 1) {
  const Rendered r = render_mean(scene, samples, 1, channel);
  EXPECT_LE(r.standard_error, resolution * expected);
  EXPECT_NEAR(r.mean, expected, 5 * r.standard_error + 1e-9);
}

/// A closed box around the camera that emits L and reflects rho: every path sums to L (1 + rho + rho^2 ...).
Scene closed_box(double rho, int max_depth) {
  SceneBuilder b;
  const int box = b.add_shape(CubeShape{}, scaled({3, 2, 2.5}), b.add(DiffuseBsdf{rho}));
  b.scene.shapes[static_cast<size_t>(box)].flip_normals = true;
  b.add_area_light(box, dvec3(0.5, 1, 2));
  b.scene.integrator.max_depth = max_depth;
  b.look({0.3, 0.2, 0.1}, {1, 0.4, 2});
  return b.scene;
}

TEST(ReferencePath, ClosedBoxSumsTheGeometricSeries) {
  for (const int max_depth : {1, 2, 3, 5}) {
    expect_image(closed_box(0.6, max_depth), 200, (1 - std::pow(0.6, max_depth)) / 0.4, 0.01);
    expect_image(closed_box(0.6, max_depth), 200, 2 * (1 - std::pow(0.6, max_depth)) / 0.4, 0.01, 2);
  }
}

TEST(ReferencePath, RussianRouletteIsUnbiased) {
  Scene scene = closed_box(0.7, -1);
  scene.integrator.rr_depth = 1;
  for (const auto kind : {Integrator::Kind::kPath, Integrator::Kind::kVolpath}) {
    scene.integrator.kind = kind;
    expect_image(scene, 400, 1 / 0.3, 0.01);
  }
}

TEST(ReferencePath, StrategiesAgree) {
  Scene scene = closed_box(0.6, 4);
  const double expected = (1 - std::pow(0.6, 4)) / 0.4;
  for (const auto kind : {Integrator::Kind::kPath, Integrator::Kind::kVolpath}) {
    scene.integrator.kind = kind;
    scene.integrator.strategy = Integrator::Strategy::kBsdfOnly;
    expect_image(scene, 20, expected, 0.01);  // no variance at all here
    scene.integrator.strategy = Integrator::Strategy::kEmitterOnly;
    expect_image(scene, 1500, expected, 0.01);
  }
}

/// A convex body of any lossless material vanishes in a white furnace; a diffuse one shows its reflectance.
TEST(ReferencePath, WhiteFurnace) {
  const std::vector<std::pair<BsdfKind, double>> cases = {
      {DiffuseBsdf{0.7}, 0.7},
      {ConductorBsdf{}, 1},
      {DielectricBsdf{1.5}, 1},
      {DielectricBsdf{1 / 1.5}, 1},
      {ThinDielectricBsdf{1.5}, 1},
      {PaperBsdf{1.0, 0.4}, 1},
      {NullBsdf{}, 1},
      {RoughConductorBsdf{{MicrofacetDistribution::kGgx, 1e-4, 1e-4}}, 1},
      {RoughDielectricBsdf{1.5, {MicrofacetDistribution::kBeckmann, 1e-4, 1e-4}}, 1}};
  for (const auto kind : {Integrator::Kind::kPath, Integrator::Kind::kVolpathMis}) {
    for (const auto& [bsdf, expected] : cases) {
      SCOPED_TRACE(bsdf.index());
      SceneBuilder b;
      b.add_shape(SphereShape{}, dmat4(1), b.add(bsdf));
      b.add_light(ConstantEmitter{dvec3(1)});
      b.look({0, 0, 5}, {0, 0, 0});
      b.scene.sensors[0].x_fov = 0.25;  // all rays hit
      b.scene.integrator.kind = kind;
      b.scene.integrator.max_depth = 200;
      expect_image(b.scene, 400, expected, 0.01);
    }
  }
}

/// A medium of albedo 1 in a white furnace vanishes, behind a null boundary and behind glass; one of albedo 0
/// shows exp(-sigma_t 2 r) at the middle of a sphere. Also of a grid.
TEST(ReferenceVolpath, FurnaceAndBeerLambert) {
  for (const bool glass : {false, true}) {
    SceneBuilder b;
    const int sphere =
        b.add_shape(SphereShape{}, dmat4(1), glass ? b.add(DielectricBsdf{1.3}) : b.add(NullBsdf{}));
    Shape& shape = b.scene.shapes[static_cast<size_t>(sphere)];
    shape.interior = 0;
    shape.is_medium_boundary = true;
    b.scene.media.push_back(
        {{}, "", HomogeneousMedium{{0.5, 2, 4}, dvec3(1)}, {{}, HenyeyGreensteinPhase{0.5}}});
    b.add_light(ConstantEmitter{dvec3(1)});
    b.look({0, 0, 5}, {0, 0, 0});
    b.scene.integrator.kind = Integrator::Kind::kVolpath;
    b.scene.integrator.max_depth = 500;
    b.scene.sensors[0].x_fov = 0.25;
    for (const int channel : {0, 2}) {
      const Rendered r = render_mean(b.scene, 300, 1, channel);
      EXPECT_LE(r.standard_error, 0.02);
      EXPECT_NEAR(r.mean, 1, 5 * r.standard_error) << glass;
    }
    if (glass) continue;

    // Absorbing: through the middle, 2 radii long. Only light from straight behind arrives.
    b.scene.media[0].kind = HomogeneousMedium{{0.5, 2, 4}, dvec3(0)};
    b.scene.sensors[0].x_fov = 1e-4;
    expect_image(b.scene, 2000, std::exp(-1.0), 0.02, 0);
    expect_image(b.scene, 2000, std::exp(-4.0), 0.06, 1);
  }
}

/// Light through a slab of absorbing fog, a mask and a thin dielectric onto a diffuse floor, found by shadow
/// rays.
TEST(ReferenceVolpath, ShadowRaysPassNullLobes) {
  SceneBuilder b;
  b.add_shape(RectangleShape{}, scaled(dvec3(10)), b.add(DiffuseBsdf{0.5}));
  const int slab = b.add_shape(CubeShape{}, moved({0, 0, 2}) * scaled({10, 10, 0.5}), b.add(NullBsdf{}));
  b.scene.shapes[static_cast<size_t>(slab)].interior = 0;
  b.scene.shapes[static_cast<size_t>(slab)].is_medium_boundary = true;
  b.scene.media.push_back({{}, "", HomogeneousMedium{dvec3(0.7), dvec3(0)}, {}});
  b.add_shape(RectangleShape{}, moved({0, 0, 3}) * scaled(dvec3(10)),
              b.add(MaskBsdf{b.add(DiffuseBsdf{0.0}), 0.3}));
  b.add_shape(RectangleShape{}, moved({0, 0, 4}) * scaled(dvec3(10)), b.add(ThinDielectricBsdf{1.5}));
  b.add_light(DirectionalEmitter{{0, 0, -1}, dvec3(2)});
  b.look({0, 0, 1}, {0, 0, 0});
  b.scene.integrator.kind = Integrator::Kind::kVolpath;
  b.scene.integrator.max_depth = 2;
  const double sheet = 2 * 0.04 / 1.04;
  const double expected = 2 * std::exp(-0.7) * 0.7 * (1 - sheet) * 0.5 / kPi;
  expect_image(b.scene, 16, expected, 1e-6);
  // path: they are blocked.
  b.scene.integrator.kind = Integrator::Kind::kPath;
  EXPECT_EQ(render_mean(b.scene, 16).mean, 0);
}

/// Single scattering of a point light in fog seen by a camera in it, against quadrature along the middle ray.
TEST(ReferenceVolpath, SingleScatteringInFog) {
  SceneBuilder b;
  b.scene.media.push_back(
      {{}, "", HomogeneousMedium{dvec3(0.3), dvec3(0.8)}, {{}, HenyeyGreensteinPhase{0.4}}});
  b.add_shape(RectangleShape{}, moved({0, 0, -6}) * scaled(dvec3(10)));  // black
  const dvec3 light(1, 0, -2);
  b.add_light(PointEmitter{light, dvec3(5)});
  b.look({0, 0, 0}, {0, 0, -1});
  b.scene.sensors[0].medium = 0;
  b.scene.sensors[0].x_fov = 1e-6;
  b.scene.sensors[0].near_clip = 1e-9;
  b.scene.integrator.kind = Integrator::Kind::kVolpath;
  b.scene.integrator.max_depth = 2;
  double expected = 0;
  constexpr int kSteps = 100000;
  for (int i = 0; i < kSteps; ++i) {
    const double t = 6 * (i + 0.5) / kSteps;
    const dvec3 p(0, 0, -t), d = light - p;
    const double r2 = glm::dot(d, d), r = std::sqrt(r2), c = -d.z / r, q = 1 + 0.16 - 0.8 * c;
    const double phase = (1 - 0.16) / (4 * kPi * q * std::sqrt(q));
    expected += 0.3 * 0.8 * std::exp(-0.3 * (t + r)) * phase * 5 / r2 * 6 / kSteps;
  }
  expect_image(b.scene, 4000, expected, 0.01);
}

/// A grid medium of one value is the homogeneous medium.
TEST(ReferenceVolpath, ConstantGridEqualsHomogeneous) {
  Rendered results[2];
  for (const int grid : {0, 1}) {
    SceneBuilder b;
    const int cube = b.add_shape(CubeShape{}, dmat4(1), b.add(NullBsdf{}));
    b.scene.shapes[static_cast<size_t>(cube)].interior = 0;
    b.scene.shapes[static_cast<size_t>(cube)].is_medium_boundary = true;
    Medium medium{{}, "", HomogeneousMedium{dvec3(1.5), dvec3(0.8)}, {}};
    if (grid) {
      HeterogeneousMedium h;
      auto values = std::make_shared<Grid>();
      values->nx = values->ny = values->nz = 2;
      values->channels = 1;
      values->values.assign(8, 0.5f);
      values->values[3] = 0.5f;
      h.sigma_t.grid = values;
      h.sigma_t.to_world = moved(dvec3(-1)) * scaled(dvec3(2));
      h.albedo.constant = dvec3(0.8);
      h.scale = 3;
      medium.kind = h;
    }
    b.scene.media.push_back(medium);
    b.add_light(PointEmitter{{2, 3, 1}, dvec3(10)});
    b.look({0, 0, 5}, {0, 0, 0});
    b.scene.integrator.kind = Integrator::Kind::kVolpath;
    b.scene.integrator.max_depth = 20;
    results[grid] = render_mean(b.scene, 600, static_cast<uint32_t>(7 + grid));
  }
  const double sigma = std::hypot(results[0].standard_error, results[1].standard_error);
  EXPECT_LE(sigma, 0.02 * results[0].mean);
  EXPECT_NEAR(results[0].mean, results[1].mean, 5 * sigma);
}

// ------------------------------------------------------------------------------------------ the machinery

TEST(ReferenceRendering, DoesNotDependOnThreadsOrRanges) {
  const Scene scene = closed_box(0.5, 4);
  const auto render = [&](int threads, uint64_t split) {
    set_thread_count(threads);
    ReferenceRenderer renderer(scene, 0, 3);
    renderer.add_samples(0, split);
    renderer.add_samples(split, 12 - split);
    set_thread_count(0);
    return renderer.image();
  };
  const ReferenceImage a = render(1, 12), b = render(2, 12), c = render(2, 5);
  EXPECT_EQ(a.samples, 12u);
  EXPECT_EQ(a.mean, b.mean);
  EXPECT_EQ(a.mean, c.mean);
  EXPECT_EQ(a.variance, c.variance);
  EXPECT_GT(a.closest_rays, 0u);
  ReferenceRenderer other(scene, 0, 4);
  other.add_samples(0, 12);
  EXPECT_NE(other.image().mean, a.mean);
}

TEST(ReferenceRendering, VarianceIsThatOfTheMean) {
  const Scene scene = closed_box(0.5, 3);
  // The spread of 64 independent images of 8 samples against the mean of their own variances.
  Mean own, spread;
  std::vector<dvec3> means;
  for (uint32_t seed = 0; seed < 64; ++seed) {
    ReferenceRenderer renderer(scene, 0, seed);
    renderer.add_samples(0, 8);
    const ReferenceImage image = renderer.image();
    for (const dvec3& v : image.variance) own.add(v.y);
    for (const dvec3& m : image.mean) spread.add(m.y);
  }
  // 1024 values: the variance of a variance of nearly normal values is 2 / 1023 of its square.
  const double measured = sqr(spread.standard_error()) * 1024;
  EXPECT_NEAR(own.mean() / measured, 1, 5 * std::sqrt(2.0 / 1023));
}

TEST(ReferenceRendering, StopsWhenAsked) {
  const Scene scene = closed_box(0.5, 2);
  ReferenceOptions options;
  options.samples = 1000;
  options.progress = [](const ReferenceProgress& p) { return p.samples_done < 8; };
  EXPECT_EQ(render_reference(scene, options).samples, 8u);
  options.progress = nullptr;
  options.seconds = 0;
  EXPECT_EQ(render_reference(scene, options).samples, 0u);
  options.sensor = 1;
  EXPECT_THROW(render_reference(scene, options), InputError);
}

TEST(ReferenceRendering, HidesEmittersFromTheCameraOnly) {
  SceneBuilder b;
  b.add_shape(RectangleShape{}, scaled(dvec3(5)), b.add(DiffuseBsdf{0.5}));
  const int lamp = b.add_shape(RectangleShape{}, moved({0, 0, 1}));
  b.add_area_light(lamp, dvec3(3));
  b.look({0, 0, 3}, {0, 0, 0});
  b.scene.integrator.max_depth = 1;
  EXPECT_NEAR(render_mean(b.scene, 4).mean, 3, 1e-12);
  b.scene.integrator.hide_emitters = true;
  EXPECT_EQ(render_mean(b.scene, 4).mean, 0);
  // Lit from below the lamp's back: nothing; the lamp turned over lights the floor that is seen through it.
  b.scene.integrator.max_depth = 2;
  EXPECT_EQ(render_mean(b.scene, 4).mean, 0);
  b.scene.shapes[static_cast<size_t>(lamp)].flip_normals = true;
  EXPECT_GT(render_mean(b.scene, 64).mean, 0.2);
}

TEST(ReferenceRendering, AovsHaveMitsubasChannels) {
  SceneBuilder b;
  b.add_shape(RectangleShape{}, scaled(dvec3(5)), b.add(DiffuseBsdf{dvec3(0.1, 0.2, 0.3)}));
  b.look({0, 0, 3}, {0, 0, 0});
  b.scene.integrator.aovs = {"albedo:albedo", "nn:sh_normal", "dd:depth"};
  ReferenceOptions options;
  options.samples = 2;
  options.aovs = {"depth", "uv", "shape_index"};
  b.scene.integrator.moment = true;
  const Image image = to_image(render_reference(b.scene, options));
  const std::vector<std::string> names{
      "R",    "G",    "B",    "variance.R", "variance.G", "variance.B", "albedo.R",      "albedo.G", "albedo.B", "nn.X",
      "nn.Y", "nn.Z", "dd.T", "depth.Z",    "uv.U",       "uv.V",       "shape_index.I", "m2_R",     "m2_G",     "m2_B"};
  EXPECT_EQ(image.names, names);
  EXPECT_NEAR(image.find("albedo.G")->at(0), 0.2, 1e-7);
  EXPECT_NEAR(image.find("nn.Z")->at(5), 1, 1e-7);
  EXPECT_NEAR(image.find("depth.Z")->at(5), 2.99, 0.1);
  options.aovs = {"nonsense"};
  EXPECT_THROW(render_reference(b.scene, options), InputError);
}

}  // namespace
}  // namespace tachylite
