#pragma once

// One fuzz target a format. Each .cpp file beside this one defines LLVMFuzzerTestOneInput for a program of its own:
// with libFuzzer (preset `fuzz`) it looks for new input; without, replay_main.cpp runs it on the files of
// tests/fuzz/corpus. A reader may return or throw InputError, in one line that starts with the file; all else ends the
// program.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);

namespace tachylite::test {

/// Largest image that the targets let be read, so that memory and time go into more inputs [pixels].
constexpr size_t kFuzzPixels = size_t{1} << 20;

/// A folder of this process, removed at its end.
const std::filesystem::path& fuzz_folder();

/// Writes the input to a file of that name in fuzz_folder() and has it read.
void fuzz_file(const char* name, const uint8_t* data, size_t size,
               const std::function<void(const std::filesystem::path&)>& read);

}  // namespace tachylite::test
