#include "command_compare.h"

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "image/compare.h"
#include "image/exr.h"

namespace tachylite {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const ZTest& test, const std::vector<std::string>& names) {
  Json means = Json::array();
  for (size_t c = 0; c < test.means.size(); ++c) {
    const MeanTest& m = test.means[c];
    means.push_back({{"channel", names[c]},
                     {"difference", m.difference},
                     {"standard_error", m.standard_error},
                     {"p", m.p},
                     {"detectable", m.detectable}});
  }
  const BlockTest& b = test.blocks;
  return {
      {"level", test.options.level},
      {"tolerance", test.options.tolerance},
      {"variance_from", test.variance_from},
      {"means", means},
      {"blocks",
       {{"edge", b.block},
        {"count", b.count},
        {"beyond", b.beyond},
        {"worst_t", b.worst_t},
        {"worst_p", b.worst_p},
        {"x", b.x},
        {"y", b.y},
        {"channel", names[static_cast<size_t>(b.channel)]},
        {"difference", b.difference},
        {"detectable", b.detectable}}},
      {"pixels",
       {{"count", test.pixels.count},
        {"beyond", test.pixels.beyond},
        {"share", test.pixels.share()},
        {"allowed", kPixelShare}}},
      {"agree", {{"means", test.means_agree}, {"blocks", test.blocks_agree}, {"pixels", test.pixels_agree}}}};
}

Json to_json(const Comparison& comparison) {
  Json channels = Json::array();
  std::vector<std::string> names;
  for (const ChannelDifference& c : comparison.channels) {
    names.push_back(c.name);
    channels.push_back({{"name", c.name},
                        {"mean_a", c.mean_a},
                        {"mean_b", c.mean_b},
                        {"ratio", c.ratio},
                        {"mse", c.mse},
                        {"relmse", c.rel_mse},
                        {"largest", c.largest},
                        {"x", c.x},
                        {"y", c.y}});
  }
  return {{"width", comparison.width},
          {"height", comparison.height},
          {"channels", channels},
          {"mse", comparison.mse},
          {"relmse", comparison.rel_mse},
          {"relmse_epsilon", comparison.epsilon},
          {"nonfinite", comparison.nonfinite},
          {"test", comparison.test ? to_json(*comparison.test, names) : Json()},
          {"agree", comparison.agree()}};
}

}  // namespace

int run_compare(const CompareArguments& arguments) {
  const Image a = read_exr(arguments.a), b = read_exr(arguments.b);
  const std::optional<DifferenceVariance> variance =
      arguments.variance ? sample_variance(read_exr(*arguments.variance), arguments.samples)
                         : layer_variance(a, b);
  const Comparison comparison = compare_images(a, b, variance);
  fmt::print("{}", arguments.json ? to_json(comparison).dump(2) + "\n" : describe(comparison));
  return comparison.agree() ? 0 : 1;
}

}  // namespace tachylite
