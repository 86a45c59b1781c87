#include "support/vol_file.h"

#include <cstdint>

namespace tachylite::test {

std::string vol_file(const glm::ivec3& voxels, int channels, const std::vector<float>& values) {
  const int32_t header[5] = {1, voxels.x, voxels.y, voxels.z, channels};
  const float box[6] = {-1, -1, -1, 1, 1, 1};
  std::string bytes("VOL\x03", 4);
  bytes.append(reinterpret_cast<const char*>(header), sizeof header);
  bytes.append(reinterpret_cast<const char*>(box), sizeof box);
  return bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float));
}

}  // namespace tachylite::test
