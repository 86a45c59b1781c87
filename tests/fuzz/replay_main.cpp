// Runs the target on every file of the given folders; fails where one takes longer than 10 s. The memory of a process
// is limited, so that an allocation that runs away fails, too.

#include <sys/resource.h>

#include <fstream>
#include <iterator>

#include <fmt/format.h>

#include "base/timer.h"
#include "fuzz/fuzz_target.h"

namespace {

constexpr double kMostSeconds = 10;
#ifndef __SANITIZE_ADDRESS__  // which reserves terabytes of address space
constexpr rlim_t kMostBytes = rlim_t{4} << 30;
#endif

/// Returns the number of files, or -1.
int replay(const std::filesystem::path& folder) {
  int count = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    std::ifstream stream(entry.path(), std::ios::binary);
    const std::string content{std::istreambuf_iterator<char>(stream), {}};
    fmt::print("{}\n", entry.path().string());
    std::fflush(stdout);  // a crash must show which file it was
    const tachylite::Timer timer;
    LLVMFuzzerTestOneInput(reinterpret_cast<const uint8_t*>(content.data()), content.size());
    if (timer.seconds() > kMostSeconds) {
      fmt::print("took {:.1f} s\n", timer.seconds());
      return -1;
    }
    ++count;
  }
  return count;
}

}  // namespace

int main(int argc, char** argv) {
#ifndef __SANITIZE_ADDRESS__
  const rlimit limit{kMostBytes, kMostBytes};
  setrlimit(RLIMIT_AS, &limit);
#endif
  int count = 0;
  for (int i = 1; i < argc; ++i) {
    const int more = replay(argv[i]);
    if (more < 0) return 1;
    count += more;
  }
  fmt::print("{} inputs\n", count);
  return count > 0 ? 0 : 1;
}
