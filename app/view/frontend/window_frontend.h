#pragma once
/// `neve view` in a window on the desktop.

#include <memory>
#include <string>
#include <vector>

#include "app/view/frontend/frontend.h"

namespace neve::app::view::frontend {

class WindowFrontend : public Frontend {
 public:
  /// Opens the window. @throws render::ContextError
  explicit WindowFrontend(const std::string& title, const ScreenSize& size = {})
      : window_(render::Window::open({title, size.width, size.height})) {}

  /// Context for renderer and screen; valid as long as this object.
  render::gl::Context& context() { return window_->context(); }

  void set_title(const std::string& title) { window_->set_title(title); }

  std::string where() const override { return "window"; }
  ScreenSize size() const override {
    return {window_->width(), window_->height(), window_->scale()};
  }
  std::vector<InputEvent> wait(double seconds) override { return window_->wait(seconds); }
  void wake() override { window_->wake(); }
  bool is_ready() const override { return window_->is_shown(); }
  bool is_picture_wanted() const override { return window_->is_damaged() && window_->is_shown(); }
  void show(render::Screen& screen) override;
  void set_clipboard(const std::string& text) override { window_->set_clipboard(text); }
  std::string clipboard() const override { return window_->clipboard(); }

 private:
  std::unique_ptr<render::Window> window_;
};

}  // namespace neve::app::view::frontend
