#pragma once
/// The program on a machine that fails: calls that fail, and power that is cut.

#include <filesystem>
#include <random>
#include <string>

#include "tests/support/power_cut.h"
#include "tests/support/resume.h"

namespace neve::test {

class FaultyCli : public Cli {
 protected:
  /// The program with calls that fail, see tests/faults/faults.cpp.
  /// @param variables  more of them for the library
  app::output::ProcessResult failing(const std::string& fault, const std::string& arguments,
                                     const std::string& variables = "") {
    return app::output::run_process(
        "/bin/bash",
        {"-c",
         "export NEVE_CALLS=$PWD/calls NEVE_FAULT='" + fault + "' " + variables +
             " LD_PRELOAD=" NEVE_FAULTS "; exec \"$0\" " + arguments,
         NEVE_BINARY},
        folder.path());
  }

  /// Cuts the power at random moments of one run, and resumes what each cut leaves.
  /// @return cuts that ended with the pictures and hashes of the run, and a folder that is whole
  int cut_power(int cuts, unsigned seed) {
    const std::string render =
        "render scene.toml --frames 0-3 --checkpoint-every 1 --no-movie --resume --out ";
    const auto run = failing("", render + "whole", "NEVE_JOURNAL=$PWD/journal");
    EXPECT_EQ(run.exit_code, 0) << run.errors;
    const RunFiles whole = files_of(folder / "whole");
    const std::vector<DiskCall> calls = read_journal(folder / "journal");
    EXPECT_GT(calls.size(), 50u);
    std::mt19937 random(seed);
    int same = 0;
    for (int k = 0; k < cuts; ++k) {
      std::filesystem::remove_all(folder / "cut");
      PowerCut cut(calls, random() % (calls.size() + 1), static_cast<unsigned>(random()));
      cut.restore((folder / "whole").string(), folder / "cut");
      const auto more = failing("", render + "cut");
      EXPECT_EQ(more.exit_code, 0) << more.errors;
      const auto verified = neve({"verify", "cut"});
      EXPECT_EQ(verified.exit_code, 0) << verified.output;
      const RunFiles found = files_of(folder / "cut");
      same += more.exit_code == 0 && verified.exit_code == 0 && found.hashes == whole.hashes &&
              found.pictures == whole.pictures;
    }
    return same;
  }
};

}  // namespace neve::test
