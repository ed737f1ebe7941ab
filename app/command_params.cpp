#include <iostream>

#include "app/commands.h"
#include "app/errors.h"
#include "app/scene/params.h"

namespace neve::app {

int run_params(bool is_json) {
  std::cout << (is_json ? params_json() : params_table());
  return exit_ok;
}

}  // namespace neve::app
