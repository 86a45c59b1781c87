#include "command_interrupt.h"

#include <unistd.h>
#include <csignal>

#include "base/atomic_file.h"

namespace tachylite {
namespace {

enum : int { kEndAtOnce, kNote, kNoted };
volatile std::sig_atomic_t state = kEndAtOnce;

void handle(int) {
  if (state != kNote) {
    unlink(unfinished_file());
    _exit(kExitInterrupted);
  }
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
  signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is an error of write()
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
