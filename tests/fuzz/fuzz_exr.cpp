#include "fuzz/fuzz_target.h"
#include "image/exr.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace tachylite;
  test::fuzz_file("m.exr", data, size,
                  [](const std::filesystem::path& file) { read_exr(file, test::kFuzzPixels); });
  return 0;
}
