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

const std::vector<uint32_t>* Image::find_words(const std::string& name) const {
  for (size_t i = 0; i < word_names.size(); ++i)
    if (word_names[i] == name) return &words[i];
  return nullptr;
}

std::vector<uint32_t>& Image::add_words(const std::string& name) {
  word_names.push_back(name);
  words.emplace_back(static_cast<size_t>(width) * static_cast<size_t>(height), 0u);
  return words.back();
}

}  // namespace tachylite
