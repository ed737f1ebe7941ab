#include "render/gl/context.h"

#include <algorithm>
#include <cstdlib>

#include "gl_test.h"
#include "render/self_test.h"

namespace neve::render {
namespace {

TEST(Context, UnknownNameIsRefusedWithTheValidNames) {
  try {
    render::gl::open_context("vulkan");
    FAIL() << "no exception";
  } catch (const std::invalid_argument& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("\"vulkan\""), std::string::npos) << message;
    for (const std::string& name : render::gl::backend_names())
      EXPECT_NE(message.find(name), std::string::npos) << message;
  }
}

TEST(Context, EglOpensAndNamesItsRenderer) {
  OPEN_OR_SKIP(context, "egl");
  EXPECT_TRUE(context->backend == "egl_device" || context->backend == "egl_surfaceless");
  EXPECT_FALSE(context->renderer.empty());
  EXPECT_GE(std::atof(context->version.c_str()), 3.3);
}

TEST(Context, OsmesaOpensAndIsSoftware) {
  OPEN_OR_SKIP(context, "osmesa");
  EXPECT_EQ(context->backend, "osmesa");
  EXPECT_TRUE(context->is_software);
}

TEST(Context, ContextOpensAgainAndAgain) {
  for (int round = 0; round < 6; ++round) {
    for (const char* backend : {"egl_device", "egl_surfaceless", "osmesa"}) {
      OPEN_OR_SKIP(context, backend);
      EXPECT_NE(context->get_proc("glClear"), nullptr);
    }
  }
}

TEST(Context, ClosingOneLeavesAnotherOfTheSameDisplayUsable) {
  OPEN_OR_SKIP(first, "egl");
  { OPEN_OR_SKIP(second, "egl"); }
  EXPECT_EQ(self_test(*first), "");
}

TEST(Context, WindowWithoutDisplayExplainsItself) {
  const auto keep = [](const char* name) {
    const char* value = std::getenv(name);
    return value ? std::string(value) : std::string();
  };
  const std::string display = keep("DISPLAY"), wayland = keep("WAYLAND_DISPLAY");
  unsetenv("DISPLAY");
  unsetenv("WAYLAND_DISPLAY");
  try {
    render::gl::open_context("window");
    ADD_FAILURE() << "a window without a display";
  } catch (const render::gl::ContextError& error) {
    ASSERT_EQ(error.attempts.size(), 1u);
    EXPECT_EQ(error.attempts[0].backend, "window");
    EXPECT_FALSE(error.attempts[0].available);
    EXPECT_NE(std::string(error.what()).find(error.attempts[0].reason), std::string::npos);
  }
  if (!display.empty()) setenv("DISPLAY", display.c_str(), 1);
  if (!wayland.empty()) setenv("WAYLAND_DISPLAY", wayland.c_str(), 1);
}

TEST(Context, EveryBackendWorksOrSaysWhyNot) {
  const std::vector<render::gl::Attempt> attempts = render::gl::try_all_backends();
  ASSERT_EQ(attempts.size(), 4u);
  for (const render::gl::Attempt& attempt : attempts)
    EXPECT_NE(attempt.available, !attempt.reason.empty()) << attempt.backend;
}

TEST(SelfTest, SelfTestPassesOnEgl) {
  OPEN_OR_SKIP(context, "egl");
  EXPECT_EQ(self_test(*context), "");
}

TEST(SelfTest, SelfTestPassesOnOsmesa) {
  OPEN_OR_SKIP(context, "osmesa");
  EXPECT_EQ(self_test(*context), "");
}

TEST(Renderer, EglAndOsmesaAgreeWhileBothAreAlive) {
  OPEN_OR_SKIP(egl, "egl");
  OPEN_OR_SKIP(osmesa, "osmesa");
  Frame frame = small_frame();
  frame.grounds.push_back({.point = {0, -0.3f, 0}});
  add_ball(frame, {0, 0, 0}, 0.2f, 0.03f);
  frame.caption = {"Boule de névé"};
  frame.legends.push_back({.title = "speed", .unit = "m/s"});
  Renderer on_egl(*egl), on_osmesa(*osmesa);
  const Difference difference = compare(on_egl.draw(frame), on_osmesa.draw(frame));
  // The same arithmetic on the same driver; on a GPU edges of spheres may fall into the next pixel.
  EXPECT_LT(difference.mean, egl->is_software ? 0.01 : 1.0);
}

}  // namespace
}  // namespace neve::render
