#pragma once
/// Stars and notes that a person gave to runs of a sweep, in DIR/stars.json.

#include <filesystem>

#include "app/sweep/store/manifest.h"

namespace neve::app::sweep::store {

/// None where there is no such file. @throws Error if it is broken, IoError
Marks read_marks(const std::filesystem::path& folder);

/// Those of a file that the report has made. @throws Error if it is broken or names runs that the
/// sweep does not have, IoError
Marks read_marks_file(const std::filesystem::path& file, const Manifest& manifest);

/// Removes the file where nothing is marked. @throws IoError
void write_marks(const std::filesystem::path& folder, const Marks& marks);

Json to_json(const Marks& marks);

}  // namespace neve::app::sweep::store
