#include "app/support/interrupt.h"

#include <unistd.h>

#include <csignal>

#include "app/support/errors.h"

namespace neve::app {

namespace {

volatile std::sig_atomic_t interrupt_count = 0;
volatile std::sig_atomic_t nothing_to_keep = 0;

/// As a signal handler may: without allocating, and without what others hold.
[[noreturn]] void end_at_once() {
  constexpr char words[] = "neve: error: interrupted before anything was made\n";
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, words, sizeof words - 1);
  ::_exit(exit_interrupted);
}

void on_signal(int signal) {
  if (signal == SIGHUP && interrupt_count > 0) return;
  interrupt_count = interrupt_count + 1;
  if (nothing_to_keep > 0 && interrupt_count == 1) end_at_once();
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

NothingToKeep::NothingToKeep() {
  nothing_to_keep = nothing_to_keep + 1;
  // One that came before, and that nobody has asked for yet.
  if (interrupt_count > 0) end_at_once();
}

NothingToKeep::~NothingToKeep() {
  nothing_to_keep = nothing_to_keep - 1;
}

bool is_interrupted() {
  return interrupt_count > 0;
}

}  // namespace neve::app
