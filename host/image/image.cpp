#include "image/image.h"

namespace tachylite {

const std::vector<float>* Image::find(const std::string& name) const {
  for (size_t i = 0; i < names.size(); ++i)
    if (names[i] == name) return &channels[i];
  return nullptr;
}

std::vector<float>& Image::add(const std::string& name) {
  names.push_back(name);
  channels.emplace_back(static_cast<size_t>(width) * static_cast<size_t>(height), 0.0f);
  return channels.back();
}

}  // namespace tachylite
