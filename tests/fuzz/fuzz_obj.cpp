#include "fuzz/fuzz_target.h"
#include "scene/load_mesh.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace tachylite;
  test::fuzz_file("m.obj", data, size, [](const std::filesystem::path& file) {
    load_mesh({.file = file, .format = MeshRequest::Format::kObj, .flip_tex_coords = true});
  });
  return 0;
}
