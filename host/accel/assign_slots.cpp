#include "accel/assign_slots.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

namespace tachylite {
namespace {

constexpr uint32_t kSets = 1u << kBvhWidth;

/// Number of members of each set (std::popcount is a function call where the processor is not known to have
/// it).
constexpr std::array<uint8_t, kSets> kSize = [] {
  std::array<uint8_t, kSets> size{};
  for (uint32_t set = 1; set < kSets; ++set) size[set] = static_cast<uint8_t>(size[set >> 1] + (set & 1));
  return size;
}();

class SlotAssignment {
 public:
  SlotAssignment(std::span<const BinaryNode> nodes, const WideChildren& inner, uint32_t count,
                 uint32_t free_sides)
      : count_(count), free_sides_(free_sides) {
    std::array<Box, kBvhWidth> boxes;
    for (uint32_t i = 0; i < count; ++i) boxes[i] = nodes[inner[i]].box();
    for (auto& axis : gain_)
      for (uint32_t i = 0; i < count; ++i) axis[i][i] = 0;
    for (uint32_t i = 0; i < count; ++i)
      for (uint32_t j = 0; j < i; ++j) compare(boxes[i], boxes[j], i, j);
  }

  /// slots[i] of child i. Slots are the leaves of a tree that halves sets of children along z, then y, then
  /// x, so the best halving of each set of at most 4, and of at most 2, is found once.
  std::array<uint32_t, kBvhWidth> solve() {
    const uint32_t all = (1u << count_) - 1;
    for (uint32_t axis = 0; axis < 3; ++axis)
      for (uint32_t set = 1; set <= all; ++set) {
        if (kSize[set] > 2u << axis || (axis == 2 && set != all)) continue;
        halve(set, axis);
      }
    std::array<uint32_t, kBvhWidth> slots{};
    place(all, 2, 0, slots);
    return slots;
  }

 private:
  /// gain_[axis][i][j]: what is gained if i lies on the negative side of the axis and j on the positive one.
  void compare(const Box& a, const Box& b, uint32_t i, uint32_t j) {
    const Lanes d = 0.5f * (centre2(b) - centre2(a));
    const float length2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2], length = std::sqrt(length2);
    // Proportional to the measure of lines that meet two small distant boxes; bounded for boxes that overlap.
    const float area_a = half_area(a), area_b = half_area(b), mean = std::sqrt(area_a) * std::sqrt(area_b);
    float weight = mean * (mean / (length2 + 0.25f * mean));
    if (!std::isfinite(weight)) weight = 0;  // areas that underflow
    for (int axis = 0; axis < 3; ++axis) {
      // Half the difference between right and wrong, over all directions: the sign of d . direction agrees
      // with that of the axis' component in all but angle / pi of them.
      float order = 0;
      if (a.hi[axis] <= b.lo[axis])
        order = 0.5f;
      else if (b.hi[axis] <= a.lo[axis])
        order = -0.5f;
      else if (length > 0)
        order = 0.5f - std::acos(std::clamp(d[axis] / length, -1.0f, 1.0f)) * std::numbers::inv_pi_v<float>;
      gain_[static_cast<size_t>(axis)][i][j] = order * weight;
      gain_[static_cast<size_t>(axis)][j][i] = -order * weight;
    }
  }

  void halve(uint32_t set, uint32_t axis) {
    const uint32_t room = 1u << axis;  // slots on each side
    // What a member gains on the negative side if all others were on the positive one. As the gains within the negative
    // side cancel each other (gain_ is antisymmetric), those of its members add up.
    std::array<float, kBvhWidth> alone;
    for (uint32_t l = set; l; l &= l - 1) {
      const auto i = static_cast<uint32_t>(std::countr_zero(l));
      alone[i] = 0;
      for (uint32_t h = set; h; h &= h - 1) alone[i] += gain_[axis][i][static_cast<uint32_t>(std::countr_zero(h))];
    }
    float best = -std::numeric_limits<float>::infinity();
    uint32_t best_low = 0;
    std::array<float, kSets> sums;
    sums[0] = 0;
    for (uint32_t low = 0;; low = (low - set) & set) {  // all subsets, upwards
      if (low) sums[low] = sums[low & (low - 1)] + alone[static_cast<uint32_t>(std::countr_zero(low))];
      const uint32_t high = set ^ low;
      if (kSize[low] <= room && kSize[high] <= room) {
        const float gain = sums[low] + (axis ? gains_[axis - 1][low] + gains_[axis - 1][high] : 0);
        if (gain > best) {
          best = gain;
          best_low = low;
        }
      }
      if (low == set) break;
    }
    gains_[axis][set] = best;
    lows_[axis][set] = static_cast<uint8_t>(best_low);
  }

  void place(uint32_t set, uint32_t axis, uint32_t slot, std::array<uint32_t, kBvhWidth>& slots) const {
    if (set == 0) return;
    uint32_t low = lows_[axis][set];
    if (low == 0 || low == set) low = free_sides_ >> axis & 1 ? 0 : set;  // not halved: either side will do
    const uint32_t high = set ^ low;
    if (axis == 0) {
      if (low) slots[static_cast<uint32_t>(std::countr_zero(low))] = slot;
      if (high) slots[static_cast<uint32_t>(std::countr_zero(high))] = slot | 1;
      return;
    }
    place(low, axis - 1, slot, slots);
    place(high, axis - 1, slot | 1u << axis, slots);
  }

  const uint32_t count_, free_sides_;
  std::array<std::array<std::array<float, kBvhWidth>, kBvhWidth>, 3> gain_;
  std::array<std::array<float, kSets>, 3> gains_{};   // of a set, halved along this axis and those below
  std::array<std::array<uint8_t, kSets>, 3> lows_{};  // the part on the negative side
};

}  // namespace

WideChildren assign_slots(std::span<const BinaryNode> nodes, const WideChildren& children) {
  // Where slots are free to choose, nodes choose differently, so that more of them can share a block of
  // addresses.
  const uint32_t free_sides = (children[0] * 0x9e3779b9u) >> 29;
  WideChildren inner{}, slots{};
  uint32_t count = 0;
  for (uint32_t child : children)
    if (child != kEmptySlot && !nodes[child].is_leaf) inner[count++] = child;
  if (count == 1) {
    slots[free_sides] = inner[0];
  } else if (count > 1) {
    const auto slot_of = SlotAssignment(nodes, inner, count, free_sides).solve();
    for (uint32_t i = 0; i < count; ++i) slots[slot_of[i]] = inner[i];
  }
  uint32_t slot = 0;
  for (uint32_t child : children) {
    if (child == kEmptySlot || !nodes[child].is_leaf) continue;
    while (slots[slot] != kEmptySlot) ++slot;
    slots[slot] = child;
  }
  return slots;
}

}  // namespace tachylite
