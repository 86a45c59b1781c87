#include "base/check.h"

#include <cstdio>
#include <cstdlib>

namespace tachylite {

void check_failed(const char* file, int line, const std::string& what) {
  fmt::print(stderr, "tachylite: internal error: CHECK failed at {}:{}: {}\n", file, line, what);
  std::fflush(stderr);
  std::abort();
}

}  // namespace tachylite
