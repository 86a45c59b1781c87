#include "fuzz/fuzz_target.h"
#include "scene/load_grid.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace tachylite;
  test::fuzz_file("m.vol", data, size, [](const std::filesystem::path& file) { load_grid(file, false); });
  return 0;
}
