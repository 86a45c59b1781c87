#pragma once

// What a bench run found out: plain data, from the measurements to the reports.

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "image/image.h"
#include "measure/estimate.h"

namespace tachylite {

constexpr std::array<double, 3> kTargetErrors = {1e-2, 1e-3, 1e-4};  // relMSE

struct Seconds {
  double cpu = 0, wall = 0;
};

/// One image, and what it took.
struct TimedImage {
  Image image;     // R G B
  Seconds render;  // samples alone
  Seconds total;   // and all that comes before them: reading, trees, kernels
};

/// All seeds of one number of samples.
struct LevelMeasurement {
  uint64_t samples = 0;  // per pixel
  Estimate rel_mse, seconds, total_seconds, efficiency;  // efficiency = 1 / (relMSE * seconds)
  Seconds render, total;                                 // means over the seeds
};

struct TargetTime {
  double rel_mse = 0;
  Estimate seconds;
  bool extrapolated = false;
};

/// A renderer's curve, levels in order of samples.
struct RendererMeasurement {
  std::string name;
  std::vector<LevelMeasurement> levels;
  std::vector<TargetTime> times;  // empty with a single level
  double exponent = 0;            // relMSE ~ seconds^exponent
  std::array<double, 3> mean{};   // of the image: R G B
};

struct StageTime {
  std::string name;
  uint64_t dispatches = 0;
  double seconds = 0;
};

/// An image for the page: a picture, or an error map.
struct Picture {
  std::string name;
  Image image;  // R G B, for the screen
};

struct SceneMeasurement {
  std::string name, file;
  int width = 0, height = 0;
  int seeds = 0;
  std::string error_from;  // "seed pairs", or the reference's file
  double epsilon = 0;      // of relMSE
  std::vector<RendererMeasurement> renderers;  // Tachylite first
  std::vector<StageTime> stages;               // of Tachylite, of the device's clock
  std::vector<std::pair<std::string, double>> start;  // steps until its first sample [s]
  std::vector<Picture> pictures;
};

/// Figures of one renderer over those of another, at equal numbers of samples.
struct LevelRatio {
  uint64_t samples = 0;
  Estimate rel_mse, seconds, efficiency;
};
/// Ratios of two renderers' figures in a scene.
struct Contest {
  std::string scene, of, to;
  std::vector<LevelRatio> levels;
  std::vector<TargetTime> times;
};

/// A figure as something grows: see scaling.h.
struct ScalingPoint {
  double x = 0;
  std::map<std::string, double> values;  // by column
};
struct ScalingSeries {
  std::string name, x_label;
  std::vector<std::string> columns;  // each with its unit: "BVH [s]"
  std::vector<ScalingPoint> points;
  std::string note;  // what ended it early, if anything did
};

struct Report {
  std::string version, device, driver, clock;  // clock: "CPU" or "wall"
  int cores = 1;                               // seconds are CPU seconds / cores with the clock CPU
  std::vector<SceneMeasurement> scenes;
  std::vector<ScalingSeries> scaling;
  std::vector<Contest> against;  // a baseline, where one was given
};

}  // namespace tachylite
