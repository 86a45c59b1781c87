#pragma once

#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace tachylite::test {

/// A file of the plugin gridvolume (version 3, float32) with the box [-1, 1]^3. values: `channels` numbers a voxel, x
/// fastest.
std::string vol_file(const glm::ivec3& voxels, int channels, const std::vector<float>& values);

}  // namespace tachylite::test
