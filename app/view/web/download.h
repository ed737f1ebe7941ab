#pragma once
/// Files that a page may fetch, each once: the program opens them, and the page gets a ticket,
/// never a path.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/output/descriptor.h"

namespace neve::app::view::web {

/// An open file that closes itself.
class OpenFile {
 public:
  /// Opens a regular file that lies in a folder, wherever links on the way lead.
  /// @throws IoError
  OpenFile(const std::filesystem::path& folder, const std::filesystem::path& file);

  std::uint64_t size() const { return size_; }  ///< bytes, when it was opened
  const std::string& name() const { return name_; }
  /// @return at most so many of the next bytes; "" at the end and after an error
  std::string read(std::size_t most);

 private:
  output::Descriptor file_;
  std::uint64_t size_ = 0;
  std::string name_;
};

/// Tickets that no page has used yet. The oldest end where there are too many.
class Tickets {
 public:
  static constexpr std::size_t most = 8;
  static constexpr double seconds = 60;  ///< that a ticket is valid

  /// @return the path to ask the server for: "/file/<ticket>/<name>"
  std::string add(std::unique_ptr<OpenFile> file, double now);
  /// The file of a path, which has no ticket after that; null if it has none.
  std::unique_ptr<OpenFile> take(std::string_view path, double now);

 private:
  struct Ticket {
    std::string secret;
    double end = 0;
    std::unique_ptr<OpenFile> file;
  };
  std::vector<Ticket> tickets_;
};

inline constexpr std::string_view download_path = "/file/";

/// Letters, digits, '.', '_' and '-' of a name; others become '_'. Safe in headers and addresses.
std::string plain_name(const std::string& name);

}  // namespace neve::app::view::web
