// The statistics of `tachylite bench`.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "base/error.h"
#include "image/compare.h"
#include "measure/convergence.h"
#include "measure/estimate.h"
#include "measure/external.h"
#include "measure/image_error.h"
#include "measure/report_json.h"
#include "measure/svg_plot.h"

namespace tachylite {
namespace {

Image noisy_image(int size, double deviation, uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0, deviation);
  Image image;
  image.width = image.height = size;
  for (const char* name : {"R", "G", "B"}) {
    std::vector<float>& channel = image.add(name);
    for (size_t i = 0; i < channel.size(); ++i)
      channel[i] = static_cast<float>(0.1 + static_cast<double>(i % 7) + noise(random));
  }
  return image;
}

double sum_of(const std::vector<double>& blocks) {
  double sum = 0;
  for (double b : blocks) sum += b;
  return sum;
}

TEST(Measure, RelMseIsThatOfCompare) {
  const Image reference = noisy_image(37, 0, 1), image = noisy_image(37, 0.5, 2);
  const double expected = compare_images(image, reference, std::nullopt).rel_mse;
  EXPECT_NEAR(sum_of(errors_against(std::vector{image}, reference, ErrorScale(reference))[0]), expected, 1e-6 * expected);
}

TEST(Measure, NoiseOfTheReferenceIsTakenOff) {
  const Image truth = noisy_image(64, 0, 1), image = noisy_image(64, 0.5, 2);
  Image reference = noisy_image(64, 0.3, 3);
  const ErrorScale scale(truth);
  const double noisy = sum_of(errors_against(std::vector{image}, reference, scale)[0]);
  for (const char* name : {"variance.R", "variance.G", "variance.B"})
    for (float& v : reference.add(name)) v = 0.09f;
  const double corrected = sum_of(errors_against(std::vector{image}, reference, scale)[0]);
  const double expected = sum_of(errors_against(std::vector{image}, truth, scale)[0]);
  EXPECT_NEAR(corrected, expected, 0.1 * expected);
  EXPECT_GT(noisy, 1.2 * expected);
}

TEST(Measure, DeviationsAreThoseOfAllPairs) {
  std::vector<Image> images;
  for (uint64_t s = 0; s < 4; ++s) images.push_back(noisy_image(33, 0.5, s));
  const ErrorScale scale(images[0]);
  double pairs = 0;
  for (size_t a = 0; a < 4; ++a)
    for (size_t b = 0; b < a; ++b) pairs += sum_of(errors_against(std::vector{images[a]}, images[b], scale)[0]) / 2 / 6;
  double mean = 0;
  for (const std::vector<double>& blocks : deviations(images, scale)) mean += sum_of(blocks) / 4;
  EXPECT_NEAR(mean, pairs, 1e-6 * pairs);
}

// 400 experiments: with a true coverage of 0.95 fewer than 0.91 or more than 0.985 cover with probability below 0.001;
// an interval half as wide as it must be (coverage 0.67) never passes.
template <class Experiment>
double coverage(const Experiment& covers) {
  int covered = 0;
  for (uint64_t e = 0; e < 400; ++e) covered += covers(e);
  return covered / 400.0;
}

TEST(Measure, IntervalsOfFewTimesCoverTheMean) {
  const double covered = coverage([](uint64_t e) {
    std::mt19937_64 random(1000 + e);
    std::normal_distribution<double> noise(0, 0.05);
    std::vector<double> times(5);
    for (double& t : times) t = 2 + noise(random);
    const Estimate interval = estimate(bootstrap_mean(times, e));
    return interval.low <= 2 && 2 <= interval.high;
  });
  EXPECT_GT(covered, 0.91);
  EXPECT_LT(covered, 0.985);
}

TEST(Measure, IntervalsOfErrorsCoverTheVariance) {
  // Squared deviations of normal pixels, whose variance differs from block to block by a factor of 50.
  const double covered = coverage([](uint64_t e) {
    std::mt19937_64 random(5000 + e);
    std::normal_distribution<double> noise;
    const size_t seeds = 4, blocks = 60;
    std::vector<std::vector<double>> errors(seeds, std::vector<double>(blocks, 0.0));
    double truth = 0;
    for (size_t b = 0; b < blocks; ++b) {
      const double variance = std::pow(50, static_cast<double>(b) / blocks);
      truth += 8 * variance;
      for (int pixel = 0; pixel < 8; ++pixel) {
        std::vector<double> x(seeds);
        double mean = 0;
        for (double& v : x) mean += (v = std::sqrt(variance) * noise(random)) / seeds;
        for (size_t s = 0; s < seeds; ++s) errors[s][b] += (x[s] - mean) * (x[s] - mean) * seeds / (seeds - 1);
      }
    }
    const Estimate interval = estimate(bootstrap_blocks(errors, 2, e));
    return interval.low <= truth && truth <= interval.high;
  });
  EXPECT_GT(covered, 0.91);
  EXPECT_LT(covered, 0.985);
}

TEST(Measure, RatiosAddTheErrorsOfLogarithms) {
  const Estimate r = ratio({6, 0, 0, 0.03}, {2, 0, 0, 0.04});
  EXPECT_DOUBLE_EQ(r.value, 3);
  EXPECT_NEAR(r.log_error, 0.05, 1e-12);
  EXPECT_NEAR(r.high, 3 * std::exp(1.96 * 0.05), 1e-4);
  EXPECT_NEAR(r.low * r.high, 9, 1e-9);
}

TEST(Measure, TimeToAnErrorIsInterpolatedInLogarithms) {
  const std::vector<TimedError> curve = {{1, 1e-1}, {2, 4e-2}, {4, 2e-2}, {8, 1e-2}, {16, 5e-3}};
  const TimeToError within = time_to_error(curve, std::sqrt(4e-2 * 2e-2));
  EXPECT_NEAR(within.seconds, std::sqrt(8.0), 1e-12);
  EXPECT_FALSE(within.extrapolated);
  EXPECT_NEAR(time_to_error(curve, 1e-2).seconds, 8, 1e-12);
  const TimeToError beyond = time_to_error(curve, 5e-4);  // slope -1 at the end
  EXPECT_NEAR(beyond.seconds, 160, 1e-9);
  EXPECT_TRUE(beyond.extrapolated);
  EXPECT_TRUE(time_to_error(curve, 1).extrapolated);
  EXPECT_LT(time_to_error(curve, 1).seconds, 1);
  // A curve that rises for a while: the last crossing counts.
  const std::vector<TimedError> bumpy = {{1, 1e-1}, {2, 1e-3}, {4, 1e-2}, {8, 1e-4}};
  EXPECT_NEAR(time_to_error(bumpy, 1e-3).seconds, std::sqrt(32.0), 1e-9);
  EXPECT_TRUE(std::isinf(time_to_error(std::vector<TimedError>{{1, 0.1}, {2, 0.2}}, 1e-3).seconds));
}

TEST(Measure, ExternalRenderersAreRead) {
  const ExternalRenderer r = parse_external("name=other;spp=64;command=a; b {samples} {seed} {out} {scene}");
  EXPECT_EQ(r.name, "other");
  EXPECT_EQ(r.most_samples, 64u);
  EXPECT_EQ(fill_command(r, {{"samples", "8"}, {"seed", "3"}, {"out", "/tmp/it's.exr"}, {"scene", "$HOME"}}),
            "a; b '8' '3' '/tmp/it'\\''s.exr' '$HOME'");
  EXPECT_EQ(fill_command({"x", "{unknown} {seed", 0}, {{"seed", "3"}}), "{unknown} {seed");
  for (const char* bad : {"", "name=x", "name=x;command=a {samples} {seed}", "command={samples} {seed} {out}", "x",
                          "name=x;spp=0;command={samples} {seed} {out}", "name=x;spp=4y;command={samples} {seed} {out}",
                          "name=x;colour=1;command={samples} {seed} {out}", "name=tachylite;command={samples} {seed} {out}"})
    EXPECT_THROW(parse_external(bad), InputError) << bad;
}

TEST(Measure, PlotsEscapeNamesAndLeaveOutWhatHasNoLogarithm) {
  Plot plot;
  plot.series = {{"a<b&\"c\"", {{1, 2, 1, 3, "x>y"}, {0, 1, 0, 0, ""}, {10, INFINITY, 0, 0, ""}, {10, 20, 0, 0, ""}}, 0, false}};
  const std::string svg = svg_plot(plot);
  EXPECT_NE(svg.find("a&lt;b&amp;&quot;c&quot;"), std::string::npos);
  EXPECT_NE(svg.find("x&gt;y"), std::string::npos);
  for (const char* word : {"inf", "nan"}) EXPECT_EQ(svg.find(word), std::string::npos) << word;
  size_t circles = 0;
  for (size_t at = 0; (at = svg.find("<circle", at)) != std::string::npos; ++at) ++circles;
  EXPECT_EQ(circles, 2u);
}

TEST(Measure, PlotsHoldIntervalsAndLongLegends) {
  Plot plot;
  plot.series = {{"one", {{1, 2, 0.01, 100, ""}, {10, 3, 0, 0, ""}}, 0, false}};
  const std::string svg = svg_plot(plot);
  const auto number = [&](const std::string& name) {
    return std::stod(svg.substr(svg.find(name, svg.find("\"bar\"")) + 4));
  };
  EXPECT_GT(number("y2="), 30);  // the top
  EXPECT_LT(number("y1="), plot.height - 40);
  EXPECT_EQ(svg.find("y=\"38\""), std::string::npos);
  for (int i = 0; i < 9; ++i) plot.series.push_back({"a name of some length", {}, 1, false});
  EXPECT_NE(svg_plot(plot).find("y=\"38\""), std::string::npos);  // the second line
}

}  // namespace
}  // namespace tachylite
