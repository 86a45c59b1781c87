// Texture lookups of the reference against values worked out by hand.

#include <gtest/gtest.h>

#include "reference/texture/texture.h"
#include "unit/reference_support.h"

namespace tachylite {
namespace {

using namespace reference;
using namespace test;

/// A row of greys in a bitmap of height 1 (or more rows).
Texture grey_texture(int width, int height, const std::vector<float>& texels, WrapMode wrap,
                     FilterType filter) {
  auto bitmap = std::make_shared<Bitmap>();
  bitmap->width = width;
  bitmap->height = height;
  bitmap->channels = 1;
  bitmap->floats = texels;
  Texture texture;
  texture.kind = BitmapTexture{bitmap, TexelFormat::kFloat, true, wrap, filter};
  return texture;
}

double look_up(const Texture& texture, dvec2 uv) {
  Scene scene;
  scene.textures.push_back(texture);
  ScalarInput input;
  input.texture = 0;
  return eval_scalar(scene, input, {.uv = uv});
}

TEST(ReferenceTexture, BilinearInterpolatesBetweenTexelCentres) {
  const Texture t = grey_texture(2, 2, {0, 1, 2, 4}, WrapMode::kClamp, FilterType::kBilinear);
  EXPECT_NEAR(look_up(t, {0.25, 0.25}), 0, 1e-12);
  EXPECT_NEAR(look_up(t, {0.75, 0.25}), 1, 1e-12);
  EXPECT_NEAR(look_up(t, {0.25, 0.75}), 2, 1e-12);  // v grows downwards: row 1
  EXPECT_NEAR(look_up(t, {0.5, 0.5}), 1.75, 1e-12);
  EXPECT_NEAR(look_up(t, {0, 0}), 0, 1e-12);
}

TEST(ReferenceTexture, WrapModesActOnTexelNumbers) {
  for (const auto& [mode, expected] :
       {std::pair(WrapMode::kRepeat, std::vector{3.0, 1.0, 2.0, 3.0, 1.0, 2.0}),
        std::pair(WrapMode::kClamp, std::vector{1.0, 1.0, 2.0, 3.0, 3.0, 3.0}),
        std::pair(WrapMode::kMirror, std::vector{1.0, 1.0, 2.0, 3.0, 3.0, 2.0})}) {
    const Texture nearest = grey_texture(3, 1, {1, 2, 3}, mode, FilterType::kNearest);
    const Texture bilinear = grey_texture(3, 1, {1, 2, 3}, mode, FilterType::kBilinear);
    for (int i = -1; i < 5; ++i) {
      const dvec2 centre((i + 0.5) / 3, 0.5);
      EXPECT_NEAR(look_up(nearest, centre), expected[static_cast<size_t>(i + 1)], 1e-12) << i;
      EXPECT_NEAR(look_up(bilinear, centre), expected[static_cast<size_t>(i + 1)], 1e-9) << i;
    }
    // Halfway between the texels -1 and 0.
    EXPECT_NEAR(look_up(bilinear, {0, 0.5}), 0.5 * (expected[0] + expected[1]), 1e-9);
  }
}

TEST(ReferenceTexture, BytesAreDecodedBeforeFiltering) {
  auto bitmap = std::make_shared<Bitmap>();
  bitmap->width = 2;
  bitmap->height = 1;
  bitmap->channels = 3;
  bitmap->bytes = {0, 0, 0, 255, 188, 10};
  Scene scene;
  for (const auto format : {TexelFormat::kUnorm8Srgb, TexelFormat::kUnorm8Linear}) {
    Texture texture;
    texture.kind = BitmapTexture{bitmap, format};
    scene.textures.push_back(texture);
  }
  const dvec3 srgb = eval_texture(scene, 0, {.uv = {0.5, 0.5}}),
              linear = eval_texture(scene, 1, {.uv = {0.5, 0.5}});
  EXPECT_NEAR(srgb.x, 0.5, 1e-12);
  EXPECT_NEAR(srgb.y, 0.5 * 0.502886458033, 1e-9);  // ((188/255 + .055) / 1.055)^2.4
  EXPECT_NEAR(srgb.z, 0.5 * 10 / 255.0 / 12.92, 1e-12);
  EXPECT_NEAR(linear.y, 0.5 * 188 / 255.0, 1e-12);
}

/// As a colour color0 is where both halves agree; as a scalar color1 is.
TEST(ReferenceTexture, CheckerboardSwapsAsAScalar) {
  Scene scene;
  Texture texture;
  texture.kind = CheckerboardTexture{dvec3(0.25), dvec3(0.75)};
  texture.to_uv = dmat3(2);  // two fields: (u, v) -> (2u, 2v)
  texture.to_uv[2][2] = 1;
  scene.textures.push_back(texture);
  ScalarInput scalar;
  scalar.texture = 0;
  for (const auto& [uv, equal] : {std::pair(dvec2(0.1, 0.1), true), std::pair(dvec2(0.3, 0.1), false),
                                  std::pair(dvec2(0.3, 0.4), true), std::pair(dvec2(0.6, 0.9), false)}) {
    EXPECT_EQ(eval_texture(scene, 0, {.uv = uv}).x, equal ? 0.25 : 0.75);
    EXPECT_NEAR(eval_scalar(scene, scalar, {.uv = uv}), equal ? 0.75 : 0.25, 1e-12);
  }
}

/// The square is chosen through the checkerboard's to_uv, what lies in it is looked up through its own alone. Asked for a
/// scalar, an inner checkerboard swaps its colours, too.
TEST(ReferenceTexture, SquaresOfACheckerboardMayBeTextures) {
  Scene scene;
  dmat3 twice(2), four_times(4);
  twice[2][2] = four_times[2][2] = 1;
  CheckerboardTexture outer{dvec3(0.25), dvec3(0.75)};
  outer.color0.texture = 1;
  outer.color1.texture = 2;
  Texture texture;
  texture.to_uv = twice;
  texture.kind = outer;
  scene.textures.push_back(texture);
  Texture bitmap = grey_texture(2, 1, {3, 5}, WrapMode::kRepeat, FilterType::kNearest);
  bitmap.to_uv = four_times;
  scene.textures.push_back(bitmap);
  texture.to_uv = four_times;
  texture.kind = CheckerboardTexture{dvec3(7), dvec3(9)};
  scene.textures.push_back(texture);
  ScalarInput scalar;
  scalar.texture = 0;
  // The outer one has halves of equal kind at the first point, the inner ones are asked at (0.4, 0.4) and (1.2, 0.4).
  EXPECT_EQ(eval_texture(scene, 0, {.uv = {0.1, 0.1}}), dvec3(3));
  EXPECT_NEAR(eval_scalar(scene, scalar, {.uv = {0.1, 0.1}}), 9, 1e-12);
  EXPECT_EQ(eval_texture(scene, 0, {.uv = {0.3, 0.1}}), dvec3(7));
  EXPECT_NEAR(eval_scalar(scene, scalar, {.uv = {0.3, 0.1}}), 3, 1e-12);
  // ... and at (0.6, 0.4), where the inner two differ.
  EXPECT_EQ(eval_texture(scene, 0, {.uv = {0.15, 0.1}}), dvec3(5));
  EXPECT_NEAR(eval_scalar(scene, scalar, {.uv = {0.15, 0.1}}), 7, 1e-12);
}

/// The gradient against central differences, through a rotation and scale of uv.
TEST(ReferenceTexture, GradientMatchesDifferences) {
  Texture t = grey_texture(4, 4, {1, 5, 2, 7, 3, 8, 1, 0, 9, 4, 4, 6, 2, 2, 7, 5}, WrapMode::kRepeat,
                           FilterType::kBilinear);
  t.to_uv = dmat3(dvec3(1.2, 0.5, 0), dvec3(-0.3, 0.8, 0), dvec3(0.1, 0.2, 1));
  Scene scene;
  scene.textures.push_back(t);
  Random random(1, 0, 0);
  for (int i = 0; i < 50; ++i) {
    const dvec2 uv = random.uniform2();
    const double h = 1e-7;
    const dvec2 expected((look_up(t, uv + dvec2(h, 0)) - look_up(t, uv - dvec2(h, 0))) / (2 * h),
                         (look_up(t, uv + dvec2(0, h)) - look_up(t, uv - dvec2(0, h))) / (2 * h));
    EXPECT_LT(glm::distance(eval_texture_gradient(scene, 0, {.uv = uv}), expected), 1e-5) << i;
  }
}

TEST(ReferenceTexture, MeshAttributesInterpolate) {
  Mesh mesh;
  mesh.triangles = {{0, 1, 2}, {2, 1, 3}};
  mesh.attributes = {{"vertex_c", 3, {1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1}}, {"face_w", 1, {0.25, 0.5}}};
  Scene scene;
  for (const char* name : {"vertex_c", "face_w", "vertex_none"}) {
    Texture texture;
    texture.kind = MeshAttributeTexture{name, 2};
    scene.textures.push_back(texture);
  }
  const TextureCoordinates at{.uv = {}, .mesh = &mesh, .triangle = 1, .barycentrics = {0.5, 0.3, 0.2}};
  EXPECT_LT(glm::distance(eval_texture(scene, 0, at), 2.0 * dvec3(0.2, 0.5, 0.7)), 1e-12);
  EXPECT_EQ(eval_texture(scene, 1, at), dvec3(1));
  EXPECT_EQ(eval_texture(scene, 2, at), dvec3(0));
}

}  // namespace
}  // namespace tachylite
