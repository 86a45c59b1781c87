#pragma once

#include <fmt/format.h>

namespace tachylite {

/// Prints the failed condition with its place and aborts: a bug of ours, never bad input.
[[noreturn]] void check_failed(const char* file, int line, const std::string& what);

}  // namespace tachylite

/// CHECK(x): x must hold, else our code has a bug. CHECK_OP prints both values (they need fmt formatters).
#define CHECK(condition)                                                                 \
  do {                                                                                   \
    if (!(condition)) ::tachylite::check_failed(__FILE__, __LINE__, #condition);         \
  } while (0)
#define CHECK_OP(a, op, b)                                                               \
  do {                                                                                   \
    if (!((a)op(b)))                                                                     \
      ::tachylite::check_failed(__FILE__, __LINE__,                                      \
                                fmt::format("{} {} {} ({} against {})", #a, #op, #b, (a), (b))); \
  } while (0)
#define CHECK_EQ(a, b) CHECK_OP(a, ==, b)
#define CHECK_NE(a, b) CHECK_OP(a, !=, b)
#define CHECK_LT(a, b) CHECK_OP(a, <, b)
#define CHECK_LE(a, b) CHECK_OP(a, <=, b)
