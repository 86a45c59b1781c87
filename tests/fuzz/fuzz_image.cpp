// PNG, JPEG, BMP, TGA and Radiance HDR, told apart by their content.
#include "fuzz/fuzz_target.h"
#include "image/ldr.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace tachylite;
  test::fuzz_file("m.png", data, size,
                  [](const std::filesystem::path& file) { read_ldr(file, test::kFuzzPixels); });
  return 0;
}
