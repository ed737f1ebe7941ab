#pragma once
/// Ctrl-C: the first one asks, the second one quits.

namespace neve::app {

/// From now on SIGINT and SIGTERM set a flag; the second of them ends the process with code 130.
void catch_interrupts();

/// True after a request to stop.
bool is_interrupted();

}  // namespace neve::app
