#pragma once
/// Conditions between the parameters of a run, as in "a <= 2 * b".

#include <functional>
#include <string>
#include <vector>

#include "app/sweep/read/sweep.h"

namespace neve::app::sweep::read {

/// A condition of sweep.where.
class Condition {
 public:
  /// Names are addresses or labels of axes, or the end of an address that no other axis has.
  /// @throws std::invalid_argument with the message and, after "; ", what was expected
  Condition(const std::string& text, const Sweep& sweep);

  /// @param value_of  the value of an axis's parameter in a run
  bool holds(const std::function<std::string(const std::string& address)>& value_of) const;

 private:
  /// factor * parameter, or a number, or a text.
  struct Side {
    double factor = 1;
    std::string address;  ///< empty: a number or a text
    std::string text;
  };
  static Side read_side(const std::string& text, const Sweep& sweep);

  Side left_, right_;
  std::string comparison_;
};

/// The conditions of a sweep. @throws SceneError or UsageError for one that means nothing
std::vector<Condition> conditions_of(const Sweep& sweep);

}  // namespace neve::app::sweep::read
