#pragma once
/// Ctrl-C: the first one asks, the second one quits.

#include <string>

namespace neve::app {

/// Sets the words of a request to stop while nothing is being made, to stderr and to stdout. They
/// are set before catch_interrupts().
void set_last_words(std::string errors, std::string output);

/// Lets SIGINT, SIGTERM and SIGHUP set a flag; a second SIGINT or SIGTERM ends the process with
/// code 130. A terminal that closes may send several SIGHUP; under nohup it has no effect.
void catch_interrupts();

/// True after a request to stop.
bool is_interrupted();

/// While one of these lives, nothing is being made: a request to stop ends the process at once,
/// with code 130, wherever it is. It is for reading, placing and forecasting, which may take long
/// and ask nobody.
class NothingToKeep {
 public:
  NothingToKeep();
  ~NothingToKeep();
  NothingToKeep(const NothingToKeep&) = delete;
  NothingToKeep& operator=(const NothingToKeep&) = delete;
};

}  // namespace neve::app
