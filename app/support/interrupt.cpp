#include "app/support/interrupt.h"

#include <unistd.h>

#include <csignal>
#include <utility>

#include "app/support/errors.h"

namespace neve::app {

namespace {

volatile std::sig_atomic_t interrupt_count = 0;
volatile std::sig_atomic_t nothing_to_keep = 0;

struct LastWords {
  std::string errors{"neve: error: interrupted before anything was made\n"}, output;
};

LastWords& last_words() {
  static LastWords words;
  return words;
}

/// Ends the process as a signal handler may: without allocating, and without what others hold.
[[noreturn]] void end_at_once() {
  const LastWords& words = last_words();
  [[maybe_unused]] auto written = ::write(STDERR_FILENO, words.errors.data(), words.errors.size());
  written = ::write(STDOUT_FILENO, words.output.data(), words.output.size());
  ::_exit(exit_interrupted);
}

void on_signal(int signal) {
  if (signal == SIGHUP && interrupt_count > 0) return;
  interrupt_count = interrupt_count + 1;
  if (nothing_to_keep > 0 && interrupt_count == 1) end_at_once();
  // Some send two at once: what the first one says is said.
  if (interrupt_count > (nothing_to_keep > 0 ? 2 : 1)) ::_exit(exit_interrupted);
}

}  // namespace

void set_last_words(std::string errors, std::string output) {
  last_words() = {std::move(errors), std::move(output)};
}

void catch_interrupts() {
  last_words();  // a signal handler must not be the first to ask for them
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
