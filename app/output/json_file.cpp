#include "app/output/json_file.h"

#include "app/output/atomic_file.h"
#include "app/support/room.h"

namespace neve::app::output {

namespace {

/// Bytes of memory for each byte of a text: its own, 16 for a value of two characters, "0,", and as
/// much again while their list grows. Objects of one short key, the next worst, take 20.
constexpr double bytes_of_values = 25;

}  // namespace

std::vector<std::uint8_t> read_json_bytes(const std::filesystem::path& file, std::uint64_t limit) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (!error && size <= limit)
    require_room(bytes_of_values * static_cast<double>(size), "what it lists", file.string());
  return read_file(file, limit);
}

Json read_json(const std::filesystem::path& file, std::uint64_t limit) {
  return parse_json(read_json_bytes(file, limit));
}

}  // namespace neve::app::output
