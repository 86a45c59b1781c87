#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace tachylite {

/// Named float channels of equal size; row 0 on top, x fastest.
struct Image {
  int width = 0, height = 0;
  std::vector<std::string> names;            // "R", "G", "B", "variance.R", "albedo.R", "depth.Z" ...
  std::vector<std::vector<float>> channels;  // one of width*height for each name
  std::vector<std::string> word_names;       // channels of 32-bit words (UINT in EXR files), beside those
  std::vector<std::vector<uint32_t>> words;
  std::map<std::string, std::string> metadata;
  bool half = false;  // set by read_exr: all channels were 16-bit floats in the file

  /// The channel of that name, or null.
  const std::vector<float>* find(const std::string& name) const;
  std::vector<float>& add(const std::string& name);  // a new channel of zeros
  const std::vector<uint32_t>* find_words(const std::string& name) const;
  std::vector<uint32_t>& add_words(const std::string& name);
};

}  // namespace tachylite
