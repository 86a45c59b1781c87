// base/math.glsl on the device against the host's double.

#include <cmath>
#include <cstdio>
#include <limits>
#include <random>

#include <boost/math/special_functions/erf.hpp>

#include "support/device_test.h"

namespace tachylite::test {
namespace {

class Math : public DeviceTest {};

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr double kPi = 3.14159265358979323846;

enum Function : uint32_t {
  kExp,
  kExpm1,
  kLog,
  kLog1p,
  kAcos,
  kAsin,
  kAtan2,
  kErf,
  kErfinv,
  kCosTurns,
  kSinTurns,
  kDifferenceOfSquares,
  kClass,
  kSafeSqrt,
  kSum
};

struct Point {
  float x, y = 0;
};

std::vector<float> evaluate(Function function, const std::vector<Point>& points) {
  return map_kernel<float>("math", std::span<const Point>(points), {{0, function}});
}
float evaluate(Function function, float x, float y = 0) {
  return evaluate(function, {{x, y}})[0];
}

/// Drivers may take what is below the normal numbers for 0 (Vulkan, "Precision and Operation of SPIR-V Instructions").
bool keeps_denormals() { return evaluate(kSum, 1e-44f, 1e-44f) == 2e-44f; }
/// The least positive number of the device.
double least() { return keeps_denormals() ? 1e-45 : 0x1p-126; }

/// `count` points: half uniform in [lo, hi]; half at a distance from `focus` whose logarithm is uniform, down
/// to `nearest`, on the sides that [lo, hi] has.
std::vector<Point> points(double lo, double hi, double focus = 0, double nearest = 1e-30,
                          size_t count = 1 << 17) {
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> uniform(lo, hi), sign(-1, 1);
  const double farthest = std::max(hi - focus, focus - lo);
  std::uniform_real_distribution<double> exponent(std::log(nearest), std::log(farthest));
  std::vector<Point> result;
  while (result.size() < count) {
    const double x = result.size() % 2
                         ? uniform(generator)
                         : focus + std::copysign(std::exp(exponent(generator)), sign(generator));
    const auto rounded = static_cast<float>(x);
    if (static_cast<double>(rounded) >= lo && static_cast<double>(rounded) <= hi) result.push_back({rounded});
  }
  return result;
}

/// The largest |f(x) - exact(x)| / |exact(x)|; below the normal numbers, relative to the smallest of them.
double largest_error(Function function, const std::vector<Point>& inputs, double (*exact)(double, double)) {
  const std::vector<float> values = evaluate(function, inputs);
  double largest = 0;
  for (size_t i = 0; i < inputs.size(); ++i) {
    const double want = exact(static_cast<double>(inputs[i].x), static_cast<double>(inputs[i].y));
    const auto got = static_cast<double>(values[i]);
    if (std::isnan(got)) {
      ADD_FAILURE() << "NaN at " << inputs[i].x << ", " << inputs[i].y;
      return 1;
    }
    if (std::abs(want) > static_cast<double>(std::numeric_limits<float>::max())) continue;
    largest = std::max(largest, std::abs(got - want) / std::max(std::abs(want), 0x1p-126));
  }
  std::printf("    largest relative error %.3g\n", largest);
  return largest;
}

// Bounds: what was measured on lavapipe 22.3.6 and 25.0.7 and on NVIDIA 580, which rounds sqrt and / otherwise and contracts
// to fma, with some room.
TEST_F(Math, Exp) {
  EXPECT_LT(largest_error(kExp, points(-87.3, 88.7), [](double x, double) { return std::exp(x); }), 1.2e-7);
  EXPECT_EQ(evaluate(kExp, 0), 1);
  EXPECT_EQ(evaluate(kExp, 89), kInf);
  EXPECT_EQ(evaluate(kExp, kInf), kInf);
  EXPECT_EQ(evaluate(kExp, -kInf), 0);
  EXPECT_EQ(evaluate(kExp, -105), 0);
  EXPECT_TRUE(std::isnan(evaluate(kExp, kNan)));
}

TEST_F(Math, Expm1) {
  EXPECT_LT(largest_error(kExpm1, points(-20, 88.7), [](double x, double) { return std::expm1(x); }), 2e-7);
  EXPECT_LT(largest_error(kExpm1, points(-2, 2), [](double x, double) { return std::expm1(x); }), 2e-7);
  EXPECT_EQ(evaluate(kExpm1, 0), 0);
  EXPECT_EQ(evaluate(kExpm1, 89), kInf);
  EXPECT_EQ(evaluate(kExpm1, kInf), kInf);
  EXPECT_EQ(evaluate(kExpm1, -kInf), -1);
  EXPECT_TRUE(std::isnan(evaluate(kExpm1, kNan)));
}

TEST_F(Math, Log) {
  const auto exact = [](double x, double) { return std::log(x); };
  EXPECT_LT(largest_error(kLog, points(1e-6, 10, 1, 1e-7), exact), 1.2e-7);
  EXPECT_LT(largest_error(kLog, points(least(), 3.4e38, 0, least()), exact), 1.2e-7);
  EXPECT_EQ(evaluate(kLog, 1), 0);
  EXPECT_EQ(evaluate(kLog, 0), -kInf);
  EXPECT_EQ(evaluate(kLog, kInf), kInf);
  EXPECT_TRUE(std::isnan(evaluate(kLog, -1)));
  EXPECT_TRUE(std::isnan(evaluate(kLog, kNan)));
}

TEST_F(Math, Log1p) {
  const auto exact = [](double x, double) { return std::log1p(x); };
  EXPECT_LT(largest_error(kLog1p, points(-0.99999994, 10), exact), 2e-7);
  EXPECT_LT(largest_error(kLog1p, points(-0.99999994, 0, -1, 6e-8), exact), 2e-7);
  EXPECT_LT(largest_error(kLog1p, points(least(), 3.4e38, 0, std::max(1e-40, least())), exact), 2e-7);
  EXPECT_EQ(evaluate(kLog1p, 0), 0);
  EXPECT_EQ(evaluate(kLog1p, -1), -kInf);
  EXPECT_EQ(evaluate(kLog1p, kInf), kInf);
  EXPECT_TRUE(std::isnan(evaluate(kLog1p, -1.5f)));
  EXPECT_TRUE(std::isnan(evaluate(kLog1p, kNan)));
}

TEST_F(Math, Acos) {
  const auto exact = [](double x, double) { return std::acos(x); };
  EXPECT_LT(largest_error(kAcos, points(-1, 1), exact), 2e-7);
  EXPECT_LT(largest_error(kAcos, points(-1, 1, 1, 6e-8), exact), 2e-7);
  EXPECT_LT(largest_error(kAcos, points(-1, 1, -1, 6e-8), exact), 2e-7);
  EXPECT_EQ(evaluate(kAcos, 1), 0);
  EXPECT_EQ(evaluate(kAcos, 1.0000002f), 0);
  EXPECT_EQ(evaluate(kAcos, -2), static_cast<float>(kPi));
  EXPECT_TRUE(std::isnan(evaluate(kAcos, kNan)));
}

TEST_F(Math, Asin) {
  const auto exact = [](double x, double) { return std::asin(x); };
  const double bound = device().is_cpu() ? 2.6e-7 : 2.7e-7;  // NVIDIA's square root is less accurate
  EXPECT_LT(largest_error(kAsin, points(-1, 1), exact), bound);
  EXPECT_LT(largest_error(kAsin, points(-1, 1, 1, 6e-8), exact), bound);
  EXPECT_EQ(evaluate(kAsin, 0), 0);
  EXPECT_EQ(evaluate(kAsin, -1.0000002f), static_cast<float>(-kPi / 2));
  EXPECT_TRUE(std::isnan(evaluate(kAsin, kNan)));
}

TEST_F(Math, Atan2) {
  std::vector<Point> inputs = points(-1, 1);
  const std::vector<Point> others = points(-10, 10, 0, 1e-35);
  std::mt19937 generator(2);
  for (Point& point : inputs) point.y = others[generator() % others.size()].x;
  EXPECT_LT(largest_error(kAtan2, inputs, [](double x, double y) { return std::atan2(y, x); }), 2.5e-7);
  EXPECT_EQ(evaluate(kAtan2, 0, 0), 0);
  EXPECT_EQ(evaluate(kAtan2, -0.0f, 0), static_cast<float>(kPi));
  EXPECT_EQ(evaluate(kAtan2, -1, -0.0f), -static_cast<float>(kPi));
  EXPECT_EQ(evaluate(kAtan2, 0, 2), static_cast<float>(kPi / 2));
  EXPECT_EQ(evaluate(kAtan2, 0, -2), static_cast<float>(-kPi / 2));
  EXPECT_EQ(evaluate(kAtan2, -1, 1), static_cast<float>(3 * kPi / 4));
  EXPECT_EQ(evaluate(kAtan2, kInf, kInf), static_cast<float>(kPi / 4));
  EXPECT_EQ(evaluate(kAtan2, kInf, 3), keeps_denormals() ? static_cast<float>(3 / 1.7e38) : 0);
  EXPECT_TRUE(std::isnan(evaluate(kAtan2, kNan, 1)));
  EXPECT_TRUE(std::isnan(evaluate(kAtan2, 1, kNan)));
}

TEST_F(Math, Erf) {
  EXPECT_LT(largest_error(kErf, points(-5, 5), [](double x, double) { return std::erf(x); }), 2e-7);
  EXPECT_EQ(evaluate(kErf, 0), 0);
  EXPECT_EQ(evaluate(kErf, kInf), 1);
  EXPECT_EQ(evaluate(kErf, -kInf), -1);
  EXPECT_TRUE(std::isnan(evaluate(kErf, kNan)));
}

TEST_F(Math, Erfinv) {
  const auto exact = [](double x, double) { return boost::math::erf_inv(x); };
  EXPECT_LT(largest_error(kErfinv, points(-0.99999994, 0.99999994), exact), 4e-7);
  EXPECT_LT(largest_error(kErfinv, points(-0.99999994, 0.99999994, 1, 6e-8), exact), 4e-7);
  EXPECT_EQ(evaluate(kErfinv, 0), 0);
  EXPECT_EQ(evaluate(kErfinv, 1), kInf);
  EXPECT_EQ(evaluate(kErfinv, -1), -kInf);
  EXPECT_TRUE(std::isnan(evaluate(kErfinv, 1.01f)));
  EXPECT_TRUE(std::isnan(evaluate(kErfinv, kNan)));
}

TEST_F(Math, CosSinTurns) {
  // Absolute errors: neither is small where the other is not near 1. Up to 3/2 turns.
  const std::vector<Point> inputs = points(-1.5, 1.5);
  const std::vector<float> c = evaluate(kCosTurns, inputs), s = evaluate(kSinTurns, inputs);
  double largest = 0;
  for (size_t i = 0; i < inputs.size(); ++i) {
    const double angle = 2 * kPi * static_cast<double>(inputs[i].x);
    largest = std::max({largest, std::abs(static_cast<double>(c[i]) - std::cos(angle)),
                        std::abs(static_cast<double>(s[i]) - std::sin(angle))});
  }
  std::printf("    largest absolute error %.3g\n", largest);
  EXPECT_LT(largest, 1.2e-7);
  for (int quarter = -6; quarter <= 6; ++quarter) {
    const float turns = 0.25f * static_cast<float>(quarter);
    EXPECT_EQ(evaluate(kCosTurns, turns), std::round(std::cos(kPi / 2 * quarter))) << turns;
    EXPECT_EQ(evaluate(kSinTurns, turns), std::round(std::sin(kPi / 2 * quarter))) << turns;
  }
}

TEST_F(Math, DifferenceOfProducts) {
  // x^2 - y^2 with y within 1e-7 to 1 of x: the plain form has a relative error of up to 1.
  std::vector<Point> inputs = points(0.5, 2);
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> exponent(-16, 0);
  for (Point& point : inputs)
    point.y = static_cast<float>(static_cast<double>(point.x) * (1 + std::exp(exponent(generator))));
  const auto exact = [](double x, double y) { return (x - y) * (x + y); };
  EXPECT_LT(largest_error(kDifferenceOfSquares, inputs, exact), 1.3e-7);
}

TEST_F(Math, Classes) {
  const std::vector<Point> inputs{{0}, {-1}, {1e-45f}, {3e38f}, {kInf}, {-kInf}, {kNan}, {-kNan}};
  EXPECT_EQ(evaluate(kClass, inputs), (std::vector<float>{0, 0, 0, 0, 2, 2, 1, 1}));
  EXPECT_EQ(evaluate(kSafeSqrt, {{4}, {-1e-9f}, {kNan}}), (std::vector<float>{2, 0, 0}));
}

}  // namespace
}  // namespace tachylite::test
