#include "command_interrupt.h"

#include <unistd.h>
#include <csignal>

namespace tachylite {
namespace {

enum : int { kEndAtOnce, kNote, kNoted };
volatile std::sig_atomic_t state = kEndAtOnce;

void handle(int) {
  if (state != kNote) _exit(kExitInterrupted);
  state = kNoted;
}

}  // namespace

void install_interrupt_handler() {
  struct sigaction action {};
  action.sa_handler = handle;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

InterruptScope::InterruptScope() {
  state = kNote;
}
InterruptScope::~InterruptScope() {
  state = kEndAtOnce;
}
bool InterruptScope::requested() const {
  return state == kNoted;
}

}  // namespace tachylite
