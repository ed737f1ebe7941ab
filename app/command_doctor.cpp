#include <algorithm>
#include <iostream>

#include "app/commands.h"
#include "app/errors.h"
#include "app/json.h"
#include "render/context.h"

namespace neve::app {

int run_doctor(bool is_json) {
  const std::vector<render::Attempt> attempts = render::try_all_backends();
  if (is_json) {
    Json json;
    json["backends"] = Json::array();
    for (const render::Attempt& attempt : attempts)
      json["backends"].push_back({{"name", attempt.backend},
                                  {"available", attempt.available},
                                  {"version", attempt.version},
                                  {"renderer", attempt.renderer},
                                  {"software", attempt.is_software},
                                  {"reason", attempt.reason},
                                  {"install", attempt.install}});
    json["physics"] = Json::array();
    std::cout << to_text(json) << "\n";
  }
  const bool any = std::any_of(attempts.begin(), attempts.end(),
                               [](const render::Attempt& attempt) { return attempt.available; });
  return any ? exit_ok : exit_no_backend;
}

}  // namespace neve::app
