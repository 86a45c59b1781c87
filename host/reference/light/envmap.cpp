#include "reference/light/envmap.h"

#include "reference/texture/bitmap.h"

namespace tachylite::reference {

Envmap::Envmap(const EnvironmentEmitter& emitter)
    : emitter_(emitter),
      to_local_(glm::inverse(dmat3(emitter.to_world))),
      to_world_(emitter.to_world),
      width_(emitter.bitmap->width),
      height_(std::max(2, emitter.bitmap->height)) {  // a single row serves as two
  double sum = 0;
  for (int y = 0; y + 1 < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      const dvec3 mean = 0.25 * (texel(x, y) + texel(x + 1, y) + texel(x, y + 1) + texel(x + 1, y + 1));
      sum += std::max(0.0, luminance(mean)) * cell_solid_angle(y);
      sums_.push_back(sum);
    }
  }
}

dvec3 Envmap::texel(int x, int y) const {
  const TexelFormat format = emitter_.srgb ? TexelFormat::kUnorm8Srgb : TexelFormat::kUnorm8Linear;
  return emitter_.scale *
         texel_color(*emitter_.bitmap, format, x % width_, std::min(y, emitter_.bitmap->height - 1));
}

double Envmap::cell_solid_angle(int y) const {
  const double step = kPi / (height_ - 1);
  return 2 * kPi / width_ * (std::cos(y * step) - std::cos((y + 1) * step));
}

Envmap::Place Envmap::place(const dvec3& direction) const {
  const dvec3 d = glm::normalize(to_local_ * direction);
  double u = std::atan2(d.x, -d.z) / (2 * kPi);
  u -= std::floor(u);
  const double v = std::atan2(std::hypot(d.x, d.z), d.y) / kPi;
  const double x = u * width_ - 0.5, y = v * (height_ - 1);
  const double x0 = std::floor(x), y0 = std::clamp(std::floor(y), 0.0, height_ - 2.0);
  return {(static_cast<int>(x0) + width_) % width_, static_cast<int>(y0), {x - x0, y - y0}};
}

dvec3 Envmap::radiance(const dvec3& direction) const {
  const auto [x, y, f] = place(direction);
  return glm::mix(glm::mix(texel(x, y), texel(x + 1, y), f.x),
                  glm::mix(texel(x, y + 1), texel(x + 1, y + 1), f.x), f.y);
}

dvec3 Envmap::sample_direction(Random& random) const {
  const auto chosen = std::upper_bound(sums_.begin(), sums_.end(), random.uniform() * sums_.back());
  const int cell = static_cast<int>(std::min(chosen - sums_.begin(), std::ptrdiff_t(sums_.size()) - 1));
  const int x = cell % width_, y = cell / width_;
  const dvec2 r = random.uniform2();
  const double phi = 2 * kPi * (x + 0.5 + r.x) / width_, step = kPi / (height_ - 1);
  const double cos_theta = lerp(std::cos(y * step), std::cos((y + 1) * step), r.y);
  const double sin_theta = std::sqrt(std::max(0.0, 1 - sqr(cos_theta)));
  return glm::normalize(to_world_ * dvec3(sin_theta * std::sin(phi), cos_theta, -sin_theta * std::cos(phi)));
}

double Envmap::pdf_direction(const dvec3& direction) const {
  if (!(sums_.back() > 0)) return 0;
  const auto [x, y, f] = place(direction);
  const size_t cell = static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x);
  const double weight = sums_[cell] - (cell > 0 ? sums_[cell - 1] : 0);
  return weight / sums_.back() / cell_solid_angle(y);
}

}  // namespace tachylite::reference
