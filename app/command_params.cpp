#include <iostream>

#include "app/commands.h"
#include "app/errors.h"
#include "app/scene/params.h"
#include "app/sweep/read_sweep.h"

namespace neve::app {

int run_params(bool is_sweep, bool is_json) {
  const std::vector<ParamInfo> list = is_sweep ? sweep_params() : params();
  std::cout << (is_json ? params_json(list) : params_table(list));
  return exit_ok;
}

}  // namespace neve::app
