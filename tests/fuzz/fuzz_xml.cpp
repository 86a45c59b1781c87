// A whole scene: read, and packed for the device. Files that it may name: m.obj, m.vol, m.hdr, m.spd and other.xml.
#include <algorithm>
#include <fstream>

#include "fuzz/fuzz_target.h"
#include "pack/pack_scene.h"
#include "scene/load_xml.h"

namespace {

void write_companions() {
  const std::filesystem::path& folder = tachylite::test::fuzz_folder();
  const auto write = [&](const char* name, const std::string& content) {
    std::ofstream(folder / name, std::ios::binary) << content;
  };
  write("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  write("m.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 2\n" + std::string(16, 'a'));
  write("m.spd", "400 0.5\n700 0.25\n");
  write("other.xml", "<scene version=\"3.0.0\"><include filename=\"scene.xml\"/></scene>");
  std::string grid("VOL\3\1\0\0\0\1\0\0\0\1\0\0\0\1\0\0\0\1\0\0\0", 24);
  grid += std::string("\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x80\x3f\0\0\x80\x3f\0\0\x80\x3f", 24);  // 0 0 0 1 1 1
  write("m.vol", grid + std::string("\0\0\0\x3f", 4));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace tachylite;
  static const bool written = (write_companions(), true);
  static_cast<void>(written);
  test::fuzz_file("scene.xml", data, size, [](const std::filesystem::path& file) {
    const Scene scene = load_scene(file);
    const Film& film = scene.sensors.front().film;
    if (static_cast<size_t>(film.width) * static_cast<size_t>(film.height) <= test::kFuzzPixels) pack_scene(scene);
  });
  return 0;
}
