#include "image/film.h"

#include <algorithm>
#include <cmath>

namespace tachylite {

FilmBuffer::FilmBuffer(int width, int height)
    : width_(width),
      height_(height),
      sum_(static_cast<size_t>(width) * static_cast<size_t>(height), glm::dvec3(0)),
      square_(sum_.size(), glm::dvec3(0)) {}

glm::dvec3 FilmBuffer::variance_of_mean(size_t index) const {
  if (!has_variance()) return glm::dvec3(0);
  const double n = static_cast<double>(samples_);
  const glm::dvec3 scatter = square_[index] - sum_[index] * sum_[index] / n;
  return glm::max(scatter, glm::dvec3(0)) / (static_cast<double>(blocks_ - 1) * n);
}

double FilmBuffer::relative_error() const {
  if (!has_variance()) return 0;
  const glm::dvec3 luminance(0.212671, 0.715160, 0.072169);
  double mean_luminance = 0, variance = 0;
  for (size_t i = 0; i < sum_.size(); ++i) {
    mean_luminance += glm::dot(luminance, mean(i));
    variance += glm::dot(luminance * luminance, variance_of_mean(i));
  }
  const double pixels = static_cast<double>(sum_.size());
  return mean_luminance > 0 ? std::sqrt(variance / pixels) / (mean_luminance / pixels) : 0;
}

void FilmBuffer::set_extra_channels(std::vector<std::string> names, std::string count_name) {
  count_name_ = std::move(count_name);
  extra_names_ = std::move(names);
  extra_.assign(extra_names_.size(), std::vector<double>(sum_.size(), 0.0));
}

Image FilmBuffer::to_image() const {
  Image image;
  image.width = width_;
  image.height = height_;
  const char* names[] = {"R", "G", "B"};
  for (int c = 0; c < 3; ++c) {
    std::vector<float>& channel = image.add(names[c]);
    for (size_t i = 0; i < sum_.size(); ++i) channel[i] = static_cast<float>(samples_ ? mean(i)[c] : 0.0);
  }
  if (has_variance()) {
    for (int c = 0; c < 3; ++c) {
      std::vector<float>& channel = image.add(std::string("variance.") + names[c]);
      for (size_t i = 0; i < sum_.size(); ++i) channel[i] = static_cast<float>(variance_of_mean(i)[c]);
    }
  }
  for (size_t c = 0; c < extra_.size(); ++c) {
    std::vector<float>& channel = image.add(extra_names_[c]);
    for (size_t i = 0; i < sum_.size(); ++i)
      channel[i] = static_cast<float>(samples_ ? extra_[c][i] / static_cast<double>(samples_) : 0.0);
  }
  if (!count_name_.empty()) {
    std::vector<float>& channel = image.add(count_name_);
    std::fill(channel.begin(), channel.end(), static_cast<float>(samples_));
  }
  return image;
}

}  // namespace tachylite
