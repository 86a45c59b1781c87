#include "measure/color_map.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "image/ldr.h"

namespace tachylite {
namespace {

// sRGB stops at equal distances; lightness rises evenly from one to the next.
constexpr std::array<std::array<float, 3>, 6> kStops = {{{0.02f, 0.02f, 0.06f},
                                                         {0.24f, 0.08f, 0.40f},
                                                         {0.56f, 0.16f, 0.42f},
                                                         {0.87f, 0.32f, 0.26f},
                                                         {0.98f, 0.63f, 0.22f},
                                                         {0.99f, 0.97f, 0.72f}}};

}  // namespace

Image color_map(int width, int height, std::span<const float> errors) {
  Image image;
  image.width = width;
  image.height = height;
  for (const char* name : {"R", "G", "B"}) image.add(name);
  for (size_t i = 0; i < errors.size(); ++i) {
    const float t = std::log(std::max(errors[i], kLeastMappedError) / kLeastMappedError) /
                    std::log(kMostMappedError / kLeastMappedError);
    const float place = std::min(t, 1.0f) * (kStops.size() - 1);
    const size_t stop = std::min(static_cast<size_t>(place), kStops.size() - 2);
    const float part = place - static_cast<float>(stop);
    for (size_t c = 0; c < 3; ++c)
      image.channels[c][i] = srgb_to_linear(kStops[stop][c] + part * (kStops[stop + 1][c] - kStops[stop][c]));
  }
  return image;
}

}  // namespace tachylite
