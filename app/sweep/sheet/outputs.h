#pragma once
/// The pictures and movies that a collect has written into the folder of a sweep. Those that an
/// earlier one has left would be taken for results of the present runs.

#include <filesystem>
#include <set>

namespace neve::app::sweep::sheet {

class Outputs {
 public:
  explicit Outputs(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// @return the same path
  const std::filesystem::path& add(const std::filesystem::path& file) {
    return *written_.insert(file.lexically_normal()).first;
  }

  /// Removes sheets, strips, their frames and movies that were not added; nothing that has another
  /// name than those. @throws IoError
  void remove_others() const;

 private:
  void remove_frames(const std::filesystem::path& frames) const;
  void remove_unless_written(const std::filesystem::path& file) const;

  std::filesystem::path folder_;
  std::set<std::filesystem::path> written_;
};

/// Removes a result that the present runs do not have. @throws IoError
void remove_result(const std::filesystem::path& file);

}  // namespace neve::app::sweep::sheet
