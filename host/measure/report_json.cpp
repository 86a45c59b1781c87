#include "measure/report_json.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/read_file.h"
#include "measure/contest.h"

namespace tachylite {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const Estimate& e) {
  return {{"value", e.value}, {"low", e.low}, {"high", e.high}, {"log_error", e.log_error}};
}

Json to_json(const Seconds& s) {
  return {{"cpu", s.cpu}, {"wall", s.wall}};
}

Json to_json(const RendererMeasurement& r) {
  Json levels = Json::array(), times = Json::array();
  for (const LevelMeasurement& l : r.levels)
    levels.push_back({{"spp", l.samples},
                      {"relmse", to_json(l.rel_mse)},
                      {"seconds", to_json(l.seconds)},
                      {"total_seconds", to_json(l.total_seconds)},
                      {"efficiency", to_json(l.efficiency)},
                      {"render", to_json(l.render)},
                      {"total", to_json(l.total)}});
  for (const TargetTime& t : r.times)
    times.push_back({{"relmse", t.rel_mse}, {"seconds", to_json(t.seconds)}, {"extrapolated", t.extrapolated}});
  return {{"name", r.name}, {"levels", levels}, {"times", times}, {"exponent", r.exponent}, {"mean", r.mean}};
}

Json to_json(const Contest& contest) {
  Json levels = Json::array(), times = Json::array();
  for (const LevelRatio& l : contest.levels)
    levels.push_back({{"spp", l.samples},
                      {"relmse", to_json(l.rel_mse)},
                      {"seconds", to_json(l.seconds)},
                      {"efficiency", to_json(l.efficiency)}});
  for (const TargetTime& t : contest.times)
    times.push_back({{"relmse", t.rel_mse}, {"seconds", to_json(t.seconds)}, {"extrapolated", t.extrapolated}});
  return {{"scene", contest.scene}, {"of", contest.of}, {"to", contest.to}, {"levels", levels}, {"times", times}};
}

Json to_json(const SceneMeasurement& s) {
  Json renderers = Json::array(), stages = Json::array(), start = Json::object(), ratios = Json::array();
  for (const RendererMeasurement& r : s.renderers) renderers.push_back(to_json(r));
  for (const StageTime& t : s.stages)
    stages.push_back({{"name", t.name}, {"dispatches", t.dispatches}, {"seconds", t.seconds}});
  for (const auto& [name, seconds] : s.start) start[name] = seconds;
  for (size_t r = 1; r < s.renderers.size(); ++r)
    ratios.push_back(to_json(compare_renderers(s.name, s.renderers[0], s.renderers[r])));
  return {{"name", s.name},           {"file", s.file},     {"width", s.width},       {"height", s.height},
          {"seeds", s.seeds},         {"error", s.error_from}, {"epsilon", s.epsilon}, {"renderers", renderers},
          {"ratios", ratios},         {"stages", stages},   {"start_seconds", start}};
}

Json to_json(const ScalingSeries& s) {
  Json points = Json::array();
  for (const ScalingPoint& p : s.points) {
    Json point = {{"x", p.x}};
    for (const auto& [name, value] : p.values) point[name] = value;
    points.push_back(point);
  }
  return {{"name", s.name}, {"x", s.x_label}, {"columns", s.columns}, {"points", points}, {"note", s.note}};
}

Estimate estimate_of(const Json& json) {
  return {json.at("value").get<double>(), json.at("low").get<double>(), json.at("high").get<double>(),
          json.at("log_error").get<double>()};
}

}  // namespace

std::string report_json(const Report& report) {
  Json scenes = Json::array(), scaling = Json::array(), against = Json::array();
  for (const Contest& c : report.against) against.push_back(to_json(c));
  for (const SceneMeasurement& s : report.scenes) scenes.push_back(to_json(s));
  for (const ScalingSeries& s : report.scaling) scaling.push_back(to_json(s));
  const Json json = {{"bench", 1},
                     {"version", report.version},
                     {"device", report.device},
                     {"driver", report.driver},
                     {"clock", report.clock},
                     {"cores", report.cores},
                     {"scenes", scenes},
                     {"scaling", scaling},
                     {"against", against}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Report read_report(const std::filesystem::path& file) {
  const FileBytes bytes = read_file(file, uint64_t{1} << 28);
  Report report;
  try {
    const Json json = Json::parse(bytes.view());
    if (json.at("bench").get<int>() != 1) throw InputError(locate_file(file), "a report of another version");
    report.clock = json.at("clock").get<std::string>();
    report.device = json.at("device").get<std::string>();
    for (const Json& s : json.at("scenes")) {
      SceneMeasurement& scene = report.scenes.emplace_back();
      scene.name = s.at("name").get<std::string>();
      scene.width = s.at("width").get<int>();
      scene.height = s.at("height").get<int>();
      for (const Json& r : s.at("renderers")) {
        RendererMeasurement& renderer = scene.renderers.emplace_back();
        renderer.name = r.at("name").get<std::string>();
        for (const Json& l : r.at("levels")) {
          LevelMeasurement& level = renderer.levels.emplace_back();
          level.samples = l.at("spp").get<uint64_t>();
          level.rel_mse = estimate_of(l.at("relmse"));
          level.seconds = estimate_of(l.at("seconds"));
          level.total_seconds = estimate_of(l.at("total_seconds"));
          level.efficiency = estimate_of(l.at("efficiency"));
        }
        // An infinite time is null in JSON: there was none.
        for (const Json& t : r.at("times"))
          if (t.at("seconds").at("value").is_number() && t.at("seconds").at("log_error").is_number() &&
              t.at("seconds").at("low").is_number() && t.at("seconds").at("high").is_number())
            renderer.times.push_back(
                {t.at("relmse").get<double>(), estimate_of(t.at("seconds")), t.at("extrapolated").get<bool>()});
      }
    }
  } catch (const Json::exception& error) {
    throw InputError(locate_file(file), fmt::format("not a report of tachylite bench: {}", error.what()));
  }
  return report;
}

}  // namespace tachylite
