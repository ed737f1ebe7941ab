#pragma once
/// JSON from files that may come from strangers.

#include <filesystem>
#include <vector>

#include "app/support/json.h"

namespace neve::app::output {

/// Bytes. Lists of a hundred thousand frames or files are shorter.
inline constexpr std::uint64_t max_json = std::uint64_t{128} << 20;

/// The bytes of a file that are to be read as JSON, after asking for the memory that its values may
/// take.
/// @throws IoError, also for files longer than the limit; UnreadableError; LimitError
std::vector<std::uint8_t> read_json_bytes(const std::filesystem::path& file,
                                          std::uint64_t limit = max_json);

/// Reads those bytes as JSON. @throws nlohmann::json::exception, too
Json read_json(const std::filesystem::path& file, std::uint64_t limit = max_json);

}  // namespace neve::app::output
