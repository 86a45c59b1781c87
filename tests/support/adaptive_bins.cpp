#include "support/adaptive_bins.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/pi.h"
#include "support/chi2.h"

namespace tachylite::test {
namespace {

constexpr size_t kOrder = 6;        // of the quadrature of a cell, per side
constexpr int kDeepest = 60;        // halvings of a cell
constexpr size_t kMostPoints = 2'000'000;

double sqr(double x) { return x * x; }
bool is_direction(const glm::dvec3& d) { return glm::dot(d, d) > 0.25; }

}  // namespace

AdaptiveBins::Rectangle AdaptiveBins::Rectangle::half(int axis, double split, bool upper) const {
  const auto middle = std::partition(pilot.begin(), pilot.end(), [&](const glm::dvec3& p) { return p[axis] < split; });
  Rectangle result = *this;
  (upper ? result.low : result.high)[axis] = split;
  result.pilot = upper ? std::span(middle, pilot.end()) : std::span(pilot.begin(), middle);
  return result;
}

AdaptiveBins::AdaptiveBins(std::span<const glm::vec4> pilot, size_t fewest, const glm::dvec3& azimuth) {
  const double length = std::hypot(azimuth.x, azimuth.y);
  s_ = length > 0 ? glm::dvec3(azimuth.x / length, azimuth.y / length, 0) : glm::dvec3(1, 0, 0);
  t_ = {-s_.y, s_.x, 0};
  for (const glm::vec4& d : pilot)
    if (is_direction(glm::dvec3(d))) pilot_.emplace_back(place_of(glm::dvec3(d)), d.w);
  const double pole = std::sqrt(0.5 * kPi);
  const Rectangle sphere{{-pole, -kPi}, {pole, kPi}, pilot_};
  nodes_ = {{.axis = 0, .split = 0, .child = 1}, {}, {}};
  for (const bool below : {false, true}) divide(1 + below, sphere.half(0, 0, below), fewest);
}

// At the median, across the side along which the inner half of the directions spreads further.
void AdaptiveBins::divide(size_t node, const Rectangle& rectangle, size_t fewest) {
  std::span<glm::dvec3> points = rectangle.pilot;
  if (points.size() < 2 * fewest) {
    nodes_[node].child = bins_.size();
    bins_.push_back(rectangle);
    return;
  }
  const auto quantile = [&](int axis, double part) {
    const auto place = points.begin() + static_cast<ptrdiff_t>(part * static_cast<double>(points.size()));
    std::nth_element(points.begin(), place, points.end(),
                     [axis](const glm::dvec3& a, const glm::dvec3& b) { return a[axis] < b[axis]; });
    return (*place)[axis];
  };
  const double s = 0.5 * (rectangle.low.x + rectangle.high.x);
  const double spread_s = 2 * std::abs(s) * (quantile(0, 0.75) - quantile(0, 0.25));
  const bool along_phi = std::cos(s * s) * (quantile(1, 0.75) - quantile(1, 0.25)) > spread_s;
  const int axis = along_phi ? 1 : 0;
  const double split = quantile(axis, 0.5);
  const size_t child = nodes_.size();
  nodes_[node] = {.axis = axis, .split = split, .child = child};
  nodes_.resize(child + 2);
  for (const bool upper : {false, true}) divide(child + upper, rectangle.half(axis, split, upper), fewest);
}

glm::dvec2 AdaptiveBins::place_of(const glm::dvec3& d) const {
  const double elevation = std::atan2(d.z, std::hypot(d.x, d.y));
  return {std::copysign(std::sqrt(std::abs(elevation)), -d.z), std::atan2(glm::dot(d, t_), glm::dot(d, s_))};
}

std::vector<double> AdaptiveBins::count(std::span<const glm::vec4> directions) const {
  std::vector<double> counts(size());
  for (const glm::vec4& d : directions) {
    if (!is_direction(glm::dvec3(d))) {
      ++counts.back();
      continue;
    }
    const glm::dvec2 place = place_of(glm::dvec3(d));
    const Node* node = nodes_.data();
    while (node->axis >= 0) node = &nodes_[node->child + (place[node->axis] < node->split ? 0 : 1)];
    ++counts[node->child];
  }
  return counts;
}

std::vector<double> AdaptiveBins::expected(const Density& density, double samples, double tolerance) const {
  const GaussRule rule = gauss_legendre(kOrder);
  struct Estimate {
    double integral = 0, largest = 0;  // of the density
  };
  const auto integrate = [&](std::span<const Rectangle> cells) {
    std::vector<glm::dvec3> points;
    std::vector<double> weights;  // [sr]
    for (const Rectangle& cell : cells) {
      const glm::dvec2 size = cell.high - cell.low;
      for (size_t a = 0; a < kOrder; ++a) {
        for (size_t b = 0; b < kOrder; ++b) {
          const double s = cell.low.x + size.x * rule.nodes[a], phi = cell.low.y + size.y * rule.nodes[b];
          const double sine = std::cos(s * s);  // of theta
          points.push_back(sine * std::cos(phi) * s_ + sine * std::sin(phi) * t_ +
                           glm::dvec3(0, 0, std::copysign(std::sin(s * s), -s)));
          weights.push_back(size.x * size.y * 2 * std::abs(s) * sine * rule.weights[a] * rule.weights[b]);
        }
      }
    }
    const std::vector<double> values = density(points);
    std::vector<Estimate> estimates(cells.size());
    for (size_t i = 0; i < points.size(); ++i) {
      Estimate& estimate = estimates[i / (kOrder * kOrder)];
      estimate.integral += weights[i] * values[i];
      estimate.largest = std::max(estimate.largest, values[i]);
    }
    return estimates;
  };

  struct Cell {
    Rectangle rectangle;
    size_t bin;
    int agreed = -1;  // halving its parent across this axis changed nothing
  };
  std::vector<Cell> cells;
  for (size_t i = 0; i < bins_.size(); ++i) cells.push_back({bins_[i], i});
  std::vector<Estimate> coarse = integrate(bins_);
  std::vector<double> counts(size());
  double error2 = 0;
  size_t points = 0;
  for (int depth = 1; !cells.empty(); ++depth) {
    std::vector<Rectangle> halves;
    std::vector<int> axes;
    for (const Cell& cell : cells) {
      const Rectangle& r = cell.rectangle;
      const glm::dvec2 centre = 0.5 * (r.low + r.high), side = r.high - r.low;
      const bool wide = std::cos(sqr(centre.x)) * side.y > 2 * std::abs(centre.x) * side.x;
      axes.push_back(cell.agreed >= 0 ? 1 - cell.agreed : wide ? 1 : 0);
      for (const bool upper : {false, true}) halves.push_back(r.half(axes.back(), centre[axes.back()], upper));
    }
    const std::vector<Estimate> fine = integrate(halves);
    points += fine.size() * kOrder * kOrder;
    const bool last = depth == kDeepest || points > kMostPoints;
    std::vector<Cell> next;
    std::vector<Estimate> next_coarse;
    for (size_t i = 0; i < cells.size(); ++i) {
      const Estimate &low = fine[2 * i], &high = fine[2 * i + 1];
      const double sum = low.integral + high.integral, largest = std::max(low.largest, high.largest);
      const double change = std::abs(sum - coarse[i].integral);
      const auto is_peak = [&](const glm::dvec3& p) { return p.z > 2 * largest; };
      const bool agrees = change < tolerance && std::ranges::none_of(cells[i].rectangle.pilot, is_peak);
      if ((agrees && cells[i].agreed >= 0) || last) {
        counts[cells[i].bin] += sum;
        error2 += sqr(change);
        continue;
      }
      for (size_t k : {2 * i, 2 * i + 1}) {
        next.push_back({halves[k], cells[i].bin, agrees ? axes[i] : -1});
        next_coarse.push_back(fine[k]);
      }
    }
    cells = std::move(next);
    coarse = std::move(next_coarse);
  }
  double rest = 1;
  for (double& count : counts) {
    rest -= count;
    count *= samples;
  }
  counts.back() = samples * (std::abs(rest) < 1e-5 + 3 * std::sqrt(error2) ? 1e-9 : rest);
  return counts;
}

}  // namespace tachylite::test
