#pragma once
/// The plate of --plate, a picture behind each frame, and the look of --lut.

#include <filesystem>
#include <string>

#include "app/run/render_job.h"
#include "app/scene/scene.h"
#include "render/image/cube_lut.h"
#include "render/image/image.h"

namespace neve::app::run {

/// The file of a frame: "street/%04d.png" with the number in the place of %04d; a name without a
/// place is one picture for all frames. @throws UsageError for any other use of %
std::filesystem::path plate_path(const std::string& pattern, int frame);

/// That of a job: a PNG, a JPEG, or the RGB or Y of an OpenEXR file in linear light; alpha lies
/// over black. @return RGB @throws IoError; Error when it is none of them, not of the size of the
/// view, or a picture names it that was not made with it; LimitError
render::Image read_plate(const RenderJob& job, int frame, const std::string& view,
                         scene::PictureSize size);

/// The look of --lut. @throws IoError; Error when it is no .cube file
render::CubeLut read_lut(const std::string& file);

}  // namespace neve::app::run
