#pragma once

namespace tachylite {

/// From here on SIGINT and SIGTERM end the process at once with exit code 130.
void install_interrupt_handler();

/// While it lives, the first SIGINT or SIGTERM is only noted, so that what is finished can be written; the
/// second ends the process.
class InterruptScope {
 public:
  InterruptScope();
  ~InterruptScope();
  InterruptScope(const InterruptScope&) = delete;
  InterruptScope& operator=(const InterruptScope&) = delete;
  bool requested() const;
};

constexpr int kExitInterrupted = 130;

}  // namespace tachylite
