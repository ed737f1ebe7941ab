/// Apart, so that programs that only show images need no OpenGL.

#include "app/view/web/web_frontend.h"
#include "render/screen.h"

namespace neve::app::view::web {

void WebFrontend::show(render::Screen& screen) {
  show_image(screen.pixels());
}

}  // namespace neve::app::view::web
