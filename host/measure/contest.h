#pragma once

#include <vector>

#include "measure/measurement.h"

namespace tachylite {

/// At equal numbers of samples.
std::vector<LevelRatio> level_ratios(const RendererMeasurement& a, const RendererMeasurement& b);

/// Ratios of the times to equal errors, where both have one that is finite; extrapolated where either is.
std::vector<TargetTime> time_ratios(const RendererMeasurement& a, const RendererMeasurement& b);

Contest compare_renderers(const std::string& scene, const RendererMeasurement& a, const RendererMeasurement& b);

/// Tachylite's figures now over those of the baseline, for scenes of the same name and size. Throws InputError where no
/// scene is in both, or the clocks differ.
std::vector<Contest> compare_reports(const Report& now, const Report& baseline);

/// The largest ratio of two renderers' mean colours, as |a / b - 1|, over the channels.
double largest_mean_difference(const RendererMeasurement& a, const RendererMeasurement& b);

}  // namespace tachylite
