/// Apart, so that what only shows images needs no OpenGL.

#include "app/view/web_front.h"
#include "render/screen.h"

namespace neve::app {

void WebFront::show(render::Screen& screen) {
  show_image(screen.pixels());
}

}  // namespace neve::app
