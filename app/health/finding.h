#pragma once
/// A sentence about a scene or a run, and what to do about it.

#include <string>

namespace neve::app::health {

enum class Severity { note, warning, error };

/// Result of a check; `address` names the parameter, or is empty.
struct Finding {
  Severity severity = Severity::warning;
  std::string address, what, hint;
};

/// "ADDRESS: WHAT; HINT"
inline std::string sentence(const Finding& finding) {
  return (finding.address.empty() ? "" : finding.address + ": ") + finding.what +
         (finding.hint.empty() ? "" : "; " + finding.hint);
}

}  // namespace neve::app::health
