#include "image/image.h"

#include <algorithm>

namespace tachylite {
namespace {

template <class T>
const std::vector<T>* find_channel(const std::vector<std::string>& names, const std::vector<std::vector<T>>& channels,
                                   const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? nullptr : &channels[static_cast<size_t>(found - names.begin())];
}

}  // namespace

const std::vector<float>* Image::find(const std::string& name) const { return find_channel(names, channels, name); }

std::vector<float>& Image::add(const std::string& name) {
  names.push_back(name);
  return channels.emplace_back(static_cast<size_t>(width) * static_cast<size_t>(height), 0.0f);
}

const std::vector<uint32_t>* Image::find_words(const std::string& name) const {
  return find_channel(word_names, words, name);
}

std::vector<uint32_t>& Image::add_words(const std::string& name) {
  word_names.push_back(name);
  return words.emplace_back(static_cast<size_t>(width) * static_cast<size_t>(height), 0u);
}

}  // namespace tachylite
