#include "image/verify.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/check.h"

namespace tachylite {
namespace {

constexpr double kMostBlocks = 1024;

/// What one renderer has rendered so far.
struct Estimate {
  Image image;
  uint64_t samples = 0;

  void add(const Image& more, uint64_t count) {
    image = samples == 0 ? more : combine_estimates(image, samples, more, count);
    samples += count;
  }
};

bool has_power(const ZTest& test, const VerifyOptions& options) {
  const bool means = std::all_of(test.means.begin(), test.means.end(),
                                 [&](const MeanTest& m) { return m.detectable <= options.mean_bias; });
  return means && test.blocks.detectable <= options.block_bias;
}

/// By what factor more samples seem to be missing, as a power of two from 2 to 16. Where error ~ samples^(-1/2) the
/// square of what is missing would do; stratified samples converge faster.
uint64_t growth(const ZTest& test, const VerifyOptions& options) {
  double missing = test.blocks.detectable / options.block_bias;
  for (const MeanTest& m : test.means) missing = std::max(missing, m.detectable / options.mean_bias);
  const double factor = std::pow(missing, 1.5);
  return factor >= 2 ? std::bit_floor(static_cast<uint64_t>(std::min(factor, 16.0))) : 2;
}

Comparison compare_estimates(const Image& tested, const Image& judge, const ZTestOptions& options) {
  return compare_images(tested, judge, layer_variance(tested, judge), options);
}

}  // namespace

Image combine_estimates(const Image& a, uint64_t samples_a, const Image& b, uint64_t samples_b) {
  CHECK(a.width == b.width && a.height == b.height);
  const double n = static_cast<double>(samples_a + samples_b);
  const double wa = static_cast<double>(samples_a) / n, wb = static_cast<double>(samples_b) / n;
  Image result;
  result.width = a.width;
  result.height = a.height;
  for (const std::string name : {"R", "G", "B", "variance.R", "variance.G", "variance.B"}) {
    const std::vector<float>*va = a.find(name), *vb = b.find(name);
    CHECK(va && vb);
    const bool is_variance = name.size() > 1;
    const double fa = is_variance ? wa * wa : wa, fb = is_variance ? wb * wb : wb;
    std::vector<float>& out = result.add(name);
    for (size_t i = 0; i < out.size(); ++i) out[i] = static_cast<float>(fa * (*va)[i] + fb * (*vb)[i]);
  }
  return result;
}

Verification verify(const RenderRound& tested, const RenderRound& judge, const VerifyOptions& options,
                    const std::function<void(const Verification&)>& report) {
  Verification result;
  Estimate a, b;
  ZTestOptions test = options.test;
  uint64_t next = options.first_samples;
  int round = 0;

  // More samples until the power is there, or a difference is beyond doubt.
  for (;; ++round) {
    const std::optional<Image> more_a = tested(next, round),
                               more_b = more_a ? judge(next, round) : std::nullopt;
    if (!more_b) return result;
    a.add(*more_a, next);
    b.add(*more_b, next);
    const double pixels = static_cast<double>(a.image.width) * a.image.height;
    test.block = std::max(options.test.block, static_cast<int>(std::ceil(std::sqrt(pixels / kMostBlocks))));
    result.samples = a.samples;
    result.comparison = compare_estimates(a.image, b.image, test);
    if (report) report(result);
    ZTestOptions early = test;
    early.level = kEarlyLevel;
    if (!compare_estimates(a.image, b.image, early).agree()) {
      result.verdict = Verification::Verdict::kDiffer;
      return result;
    }
    if (has_power(*result.comparison.test, options)) break;
    if (2 * a.samples > options.most_samples) return result;
    next = std::min(growth(*result.comparison.test, options) * a.samples, options.most_samples) - a.samples;
  }
  if (result.comparison.agree()) {
    result.verdict = Verification::Verdict::kAgree;
    return result;
  }

  // A difference counts if a fresh pair shows it, too.
  const std::optional<Image> fresh_a = tested(a.samples, round + 1);
  const std::optional<Image> fresh_b = fresh_a ? judge(a.samples, round + 1) : std::nullopt;
  if (!fresh_b) return result;
  result.comparison = compare_estimates(*fresh_a, *fresh_b, test);
  result.confirmed = true;
  result.verdict = result.comparison.agree() ? Verification::Verdict::kAgree : Verification::Verdict::kDiffer;
  if (report) report(result);
  return result;
}

}  // namespace tachylite
