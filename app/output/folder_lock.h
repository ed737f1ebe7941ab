#pragma once
/// One writer for a folder at a time.

#include <filesystem>
#include <optional>
#include <string>

#include "app/output/descriptor.h"

namespace neve::app::output {

/// Held until it is destroyed or the process ends, however that happens. The file stays; whether
/// the folder is locked is known to the system alone, so that a file left by a killed process is
/// none.
class FolderLock {
 public:
  enum class Kind {
    alone,
    shared  ///< with others of this kind
  };
  static constexpr const char* default_name = ".lock";

  /// Makes the folder if it is missing, and removes what killed processes left unfinished in it.
  /// @param holder  "neve render": what others are told, with process and host
  /// @throws IoError when another process has it, naming that one, and when it cannot be locked
  FolderLock(const std::filesystem::path& folder, const std::string& holder,
             Kind kind = Kind::alone);

  /// Locks as the constructor does; nothing when another process has the lock.
  static std::optional<FolderLock> try_lock(const std::filesystem::path& folder,
                                            const std::string& holder, Kind kind = Kind::alone,
                                            const char* name = default_name);

  /// Whether a process has it now. Changes nothing.
  static bool is_held(const std::filesystem::path& folder);

  /// Names its last holder: "neve render, process 4711 on snow, since 2026-01-31 12:00:00".
  static std::string holder_of(const std::filesystem::path& folder,
                               const char* name = default_name);

 private:
  explicit FolderLock(Descriptor file) : file_(std::move(file)) {}

  Descriptor file_;
};

}  // namespace neve::app::output
