#include "app/support/interrupt.h"

#include <unistd.h>

#include <csignal>

#include "app/support/errors.h"

namespace neve::app {

namespace {

volatile std::sig_atomic_t interrupt_count = 0;

void on_signal(int signal) {
  if (signal == SIGHUP && interrupt_count > 0) return;
  interrupt_count = interrupt_count + 1;
  if (interrupt_count > 1) ::_exit(exit_interrupted);
}

}  // namespace

void catch_interrupts() {
  struct sigaction action {};
  action.sa_handler = on_signal;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  struct sigaction before {};
  if (sigaction(SIGHUP, nullptr, &before) == 0 && before.sa_handler != SIG_IGN)
    sigaction(SIGHUP, &action, nullptr);
}

bool is_interrupted() {
  return interrupt_count > 0;
}

}  // namespace neve::app
