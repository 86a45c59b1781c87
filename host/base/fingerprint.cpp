#include "base/fingerprint.h"

#include <cstring>
#include <fstream>
#include <vector>

#include "base/error.h"
#include "base/read_file.h"

namespace tachylite {

// The finaliser of Stafford 2011, "Better Bit Mixing", Mix13, over a running state.
void Fingerprint::mix(uint64_t word) {
  uint64_t x = state_ + 0x9e3779b97f4a7c15u + word;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  state_ = x ^ (x >> 31);
}

void Fingerprint::add(std::string_view bytes) {
  mix(bytes.size());
  for (size_t i = 0; i < bytes.size(); i += sizeof(uint64_t)) {
    uint64_t word = 0;
    std::memcpy(&word, bytes.data() + i, std::min(sizeof word, bytes.size() - i));
    mix(word);
  }
}

void Fingerprint::add_file(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::vector<char> part(size_t{1} << 20);
  while (stream) {
    stream.read(part.data(), static_cast<std::streamsize>(part.size()));
    add({part.data(), static_cast<size_t>(stream.gcount())});
  }
  if (!stream.eof()) throw InputError(locate_file(file), "cannot be read");
}

std::string Fingerprint::text() const { return fmt::format("{:016x}", state_); }

}  // namespace tachylite
