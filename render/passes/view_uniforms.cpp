#include "render/passes/view_uniforms.h"

namespace neve::render::passes {

void set_view(const gl::Program& program, const View& view) {
  program.set("view_right", view.right);
  program.set("view_up", view.up);
  program.set("view_forward", view.forward);
  program.set("view_size", static_cast<float>(view.width), static_cast<float>(view.height));
  program.set("pixels_per_slope", view.pixels_per_slope);
  program.set("near_distance", view.near_distance);
}

}  // namespace neve::render::passes
