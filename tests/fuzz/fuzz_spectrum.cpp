// The text of a .spd file, and of the value of a <spectrum>.
#include <fstream>

#include "fuzz/fuzz_target.h"
#include "scene/load_xml.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace tachylite;
  static const std::filesystem::path scene = [] {
    const std::filesystem::path path = test::fuzz_folder() / "scene.xml";
    std::ofstream(path) << "<scene version=\"3.0.0\"><sensor type=\"perspective\"/><shape type=\"sphere\">"
                           "<bsdf type=\"diffuse\"><spectrum name=\"reflectance\" filename=\"m.spd\"/></bsdf></shape>"
                           "</scene>";
    return path;
  }();
  test::fuzz_file("m.spd", data, size, [](const std::filesystem::path&) { load_scene(scene); });
  return 0;
}
