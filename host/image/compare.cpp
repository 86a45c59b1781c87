#include "image/compare.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/error.h"

namespace tachylite {
namespace {

const std::vector<std::string> kColor = {"R", "G", "B"};
constexpr double kSmallestSampleVariance = 1e-4;

bool has_channels(const Image& image, const std::vector<std::string>& names, const std::string& prefix = "") {
  return std::all_of(names.begin(), names.end(),
                     [&](const std::string& name) { return image.find(prefix + name) != nullptr; });
}

std::vector<std::string> common_channels(const Image& a, const Image& b) {
  for (const std::vector<std::string>& names : {kColor, std::vector<std::string>{"Y"}})
    if (has_channels(a, names) && has_channels(b, names)) return names;
  throw InputError("the images have no channels in common: expected R, G and B in both, or Y");
}

ChannelDifference difference_of(const std::string& name, int width, const std::vector<float>& a,
                                const std::vector<float>& b, double epsilon) {
  ChannelDifference d;
  d.name = name;
  const double n = static_cast<double>(a.size());
  for (size_t i = 0; i < a.size(); ++i) {
    const double va = a[i], vb = b[i], square = (va - vb) * (va - vb);
    d.mean_a += va / n;
    d.mean_b += vb / n;
    d.mse += square / n;
    if (square > 0) d.rel_mse += square / (vb * vb + epsilon) / n;
    if (std::abs(va - vb) > d.largest) {
      d.largest = std::abs(va - vb);
      d.x = static_cast<int>(i % static_cast<size_t>(width));
      d.y = static_cast<int>(i / static_cast<size_t>(width));
    }
  }
  d.ratio = d.mean_a == d.mean_b ? 1 : d.mean_a / d.mean_b;
  return d;
}

}  // namespace

std::optional<DifferenceVariance> layer_variance(const Image& a, const Image& b) {
  const std::string prefix = "variance.";
  DifferenceVariance sum;
  const auto add = [&](const Image& image) {
    if (!has_channels(image, kColor, prefix)) return false;
    if (sum.channels.empty()) sum.channels.resize(kColor.size());
    for (size_t c = 0; c < kColor.size(); ++c) {
      const std::vector<float>& layer = *image.find(prefix + kColor[c]);
      sum.channels[c].resize(layer.size());
      for (size_t i = 0; i < layer.size(); ++i) sum.channels[c][i] += layer[i];
    }
    return true;
  };
  const bool first = add(a);
  if (first && (a.width != b.width || a.height != b.height)) return sum;  // compare_images says what is wrong
  const bool second = add(b);
  if (!first && !second) return std::nullopt;
  sum.partial = first != second;
  sum.from = first && second ? "the layers of both"
             : first         ? "the layers of the first and the scatter of the difference"
                             : "the layers of the second and the scatter of the difference";
  return sum;
}

DifferenceVariance sample_variance(const Image& variance, uint64_t samples) {
  if (!has_channels(variance, kColor)) throw InputError("the variance image needs the channels R, G and B");
  DifferenceVariance result;
  result.exact = true;
  result.from = fmt::format("that of one sample over {} samples", samples);
  for (const std::string& name : kColor) {
    std::vector<float> layer = *variance.find(name);
    for (float& v : layer) {
      if (!std::isfinite(v)) throw InputError("the variance image holds values that are not finite");
      v = static_cast<float>(std::max(kSmallestSampleVariance, double{v}) / static_cast<double>(samples));
    }
    result.channels.push_back(std::move(layer));
  }
  return result;
}

Comparison compare_images(const Image& a, const Image& b, const std::optional<DifferenceVariance>& variance,
                          const ZTestOptions& options) {
  if (a.width != b.width || a.height != b.height)
    throw InputError(
        fmt::format("the images differ in size: {}x{} and {}x{}", a.width, a.height, b.width, b.height));
  const std::vector<std::string> names = common_channels(a, b);
  Comparison result;
  result.width = a.width;
  result.height = a.height;

  // Values that are not finite are counted and set to 0 in both images.
  std::vector<std::vector<float>> va, vb;
  DifferenceVariance known = variance.value_or(DifferenceVariance{});
  for (size_t c = 0; c < names.size(); ++c) {
    va.push_back(*a.find(names[c]));
    vb.push_back(*b.find(names[c]));
    for (size_t i = 0; i < va[c].size(); ++i) {
      const bool bad_variance = c < known.channels.size() && !std::isfinite(known.channels[c][i]);
      const int bad = !std::isfinite(va[c][i]) + !std::isfinite(vb[c][i]) + bad_variance;
      if (bad == 0) continue;
      result.nonfinite += static_cast<uint64_t>(bad);
      va[c][i] = vb[c][i] = 0;
      if (variance && c < known.channels.size()) known.channels[c][i] = 0;
    }
  }

  double mean = 0;
  for (const std::vector<float>& channel : vb)
    for (float value : channel) mean += value / static_cast<double>(channel.size() * vb.size());
  result.epsilon = 0.01 * mean * mean;
  for (size_t c = 0; c < names.size(); ++c) {
    result.channels.push_back(difference_of(names[c], a.width, va[c], vb[c], result.epsilon));
    result.mse += result.channels[c].mse / static_cast<double>(names.size());
    result.rel_mse += result.channels[c].rel_mse / static_cast<double>(names.size());
  }
  if (variance) {
    if (names.size() != known.channels.size() || va[0].size() != known.channels[0].size())
      throw InputError("the variance does not fit the images: expected R, G and B of the same size");
    result.test = z_test(a.width, a.height, va, vb, known, options);
  }
  return result;
}

std::string describe(const ZTest& test, const std::vector<std::string>& names) {
  std::string text = fmt::format("test at level {:g}, variance from {}; differences below {:g} % are none\n",
                                 test.options.level, test.variance_from, 100 * test.options.tolerance);
  for (size_t c = 0; c < test.means.size(); ++c) {
    const MeanTest& m = test.means[c];
    text += fmt::format(
        "  mean {}: {:+.3f} % +- {:.3f} %, p = {:.2g}; a bias of {:.2f} % is seen with probability 0.95\n",
        names[c], 100 * m.difference, 100 * m.standard_error, m.p, 100 * m.detectable);
  }
  const BlockTest& blocks = test.blocks;
  text += fmt::format("  blocks of {0}x{0}: {1} of {2} beyond the limit", blocks.block, blocks.beyond,
                      blocks.count);
  if (blocks.worst_p < 1)
    text += fmt::format("; worst at ({}, {}) {}: {:+.2f} %, t = {:.2f}, p = {:.2g}", blocks.x, blocks.y,
                        names[static_cast<size_t>(blocks.channel)], 100 * blocks.difference, blocks.worst_t,
                        blocks.worst_p);
  text += fmt::format("; a bias of {:.1f} % is seen in the median block\n", 100 * blocks.detectable);
  text += fmt::format("  pixels: {:.3f} % beyond the limit, {:.2f} % allowed\n", 100 * test.pixels.share(),
                      100 * kPixelShare);
  std::string failed;
  const auto add = [&failed](bool agree, const char* what) {
    if (!agree) failed += failed.empty() ? what : fmt::format(", {}", what);
  };
  add(test.means_agree, "means");
  add(test.blocks_agree, "blocks");
  add(test.pixels_agree, "pixels");
  text += failed.empty() ? "agree\n" : fmt::format("differ: {}\n", failed);
  return text;
}

std::string describe(const Comparison& comparison) {
  std::string text = fmt::format("{:<8}{:>13}{:>13}{:>10}{:>12}{:>12}{:>12}\n", "channel", "mean A", "mean B",
                                 "A/B", "MSE", "relMSE", "largest");
  std::vector<std::string> names;
  for (const ChannelDifference& c : comparison.channels) {
    names.push_back(c.name);
    text += fmt::format("{:<8}{:>13.6g}{:>13.6g}{:>10.5f}{:>12.4g}{:>12.4g}{:>12.4g} at ({}, {})\n", c.name,
                        c.mean_a, c.mean_b, c.ratio, c.mse, c.rel_mse, c.largest, c.x, c.y);
  }
  text += fmt::format("{:<44}{:>12.4g}{:>12.4g}   relMSE = mean((A-B)^2 / (B^2 + {:.4g}))\n", "all",
                      comparison.mse, comparison.rel_mse, comparison.epsilon);
  if (comparison.nonfinite > 0) text += fmt::format("{} values are not finite\n", comparison.nonfinite);
  if (comparison.test) text += describe(*comparison.test, names);
  return text;
}

}  // namespace tachylite
