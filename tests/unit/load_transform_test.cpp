#include "load_support.h"

#include "scene/parse_transform.h"

namespace tachylite {
namespace {

class LoadTransform : public LoadTest {
 protected:
  dmat4 transform(const std::string& operations) const {
    return load_body("<shape type=\"rectangle\"><transform name=\"to_world\">" + operations +
                     "</transform></shape>")
        .shapes[0]
        .to_world;
  }
  static dvec3 apply(const dmat4& m, const dvec3& p) { return dvec3(m * glm::dvec4(p, 1)); }
};

TEST_F(LoadTransform, FirstListedActsFirst) {
  const dmat4 m = transform("<scale value=\"2\"/><translate x=\"1\"/><rotate z=\"1\" angle=\"90\"/>");
  expect_near(apply(m, {1, 0, 0}), {0, 3, 0}, 1e-14);
  const dmat4 other = transform("<rotate z=\"1\" angle=\"90\"/><translate x=\"1\"/><scale value=\"2\"/>");
  expect_near(apply(other, {1, 0, 0}), {2, 2, 0}, 1e-14);
}

TEST_F(LoadTransform, Matrices) {
  const dmat4 m = transform("<matrix value=\"1 0 0 4, 0 2 0 5, 0 0 3 6, 0 0 0 1\"/>");
  expect_near(apply(m, {1, 1, 1}), {5, 7, 9}, 0);
  expect_near(apply(transform("<matrix value=\"0 -1 0 1 0 0 0 0 1\"/>"), {1, 0, 0}), {0, 1, 0}, 0);
}

TEST_F(LoadTransform, LookAtColumnsAreLeftUpForward) {
  const dmat4 m = transform("<lookat origin=\"1, 2, 3\" target=\"1, 2, -5\" up=\"0, 1, 0\"/>");
  expect_near(dvec3(m[2]), {0, 0, -1}, 1e-15);
  expect_near(dvec3(m[1]), {0, 1, 0}, 1e-15);
  expect_near(dvec3(m[0]), {-1, 0, 0}, 1e-15);  // up x forward
  expect_near(dvec3(m[3]), {1, 2, 3}, 0);
}

TEST_F(LoadTransform, RotationAboutAnyAxisIsRightHanded) {
  const dmat4 m = transform("<rotate value=\"1, 1, 1\" angle=\"120\"/>");
  expect_near(apply(m, {1, 0, 0}), {0, 1, 0}, 1e-14);
  expect_near(apply(m, {0, 1, 0}), {0, 0, 1}, 1e-14);
}

TEST_F(LoadTransform, PartialAxes) {
  expect_near(apply(transform("<scale y=\"3\"/>"), {1, 1, 1}), {1, 3, 1}, 0);
  expect_near(apply(transform("<translate value=\"1 2 3\"/>"), {0, 0, 0}), {1, 2, 3}, 0);
}

TEST_F(LoadTransform, Similarities) {
  EXPECT_TRUE(
      is_similarity(transform("<rotate value=\"1, 2, 3\" angle=\"50\"/><scale value=\"7\"/>"), 1e-12));
  EXPECT_TRUE(is_similarity(transform("<scale x=\"-2\" y=\"2\" z=\"2\"/>"), 1e-12));
  EXPECT_FALSE(is_similarity(transform("<scale x=\"1.01\"/>")));
  EXPECT_FALSE(is_similarity(transform("<matrix value=\"1 0.1 0 0 1 0 0 0 1\"/>")));
}

}  // namespace
}  // namespace tachylite
