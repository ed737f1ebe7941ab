#pragma once
/// `neve view` as a person uses it, whose hand is a script.

#include <filesystem>
#include <string>
#include <vector>

#include "app/support/errors.h"
#include "tests/cli/run_neve.h"
#include "tests/support/needs.h"

namespace neve::test {

class ViewByScript : public Cli {
 protected:
  app::output::ProcessResult view(const std::string& script,
                                  const std::vector<std::string>& more = {}) {
    folder.write("clicks.json", script);
    std::vector<std::string> words{"view",  "scene.toml", "--replay", "clicks.json",
                                   "--out", "out",        "--quiet"};
    words.insert(words.end(), more.begin(), more.end());
    return neve(words);
  }

  /// Files of the output folder whose names begin and end so.
  std::vector<std::string> files(const std::string& begin, const std::string& end) {
    std::vector<std::string> found;
    for (const auto& entry : std::filesystem::directory_iterator(folder / "out")) {
      const std::string name = entry.path().filename().string();
      if (name.starts_with(begin) && name.ends_with(end)) found.push_back(name);
    }
    return found;
  }
};

#define SKIP_WITHOUT_GL(result) \
  if (result.exit_code == app::exit_no_backend) SKIP_OR_FAIL(result.errors)

}  // namespace neve::test
