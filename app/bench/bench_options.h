#pragma once
/// Command line options of a measurement.

#include <string>

namespace neve::app::bench {

struct BenchOptions {
  int rounds = 0;        ///< 0: as many as are usual
  double particles = 0;  ///< 0: the common case, or the end of the curve
  bool is_curve = false;
  std::string only;  ///< name of a scene; "": all that are shipped
  int frames = 0;    ///< of a scene's film; 0: all
  int threads = 0;   ///< 0: one per core
  std::string backend = "auto";
  bool is_quick = false;
  bool is_json = false;
  bool is_markdown = false;
};

}  // namespace neve::app::bench
