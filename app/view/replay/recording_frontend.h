#pragma once
/// Records the input of another frontend as a script that `neve view --replay` plays.

#include <chrono>
#include <filesystem>

#include "app/view/frontend/frontend.h"
#include "app/view/replay/input_recorder.h"

namespace neve::app::view::replay {

class RecordingFrontend : public frontend::Frontend {
 public:
  /// @param front must live longer
  /// @param file of the script; rewritten while it grows, so that a crash loses nothing
  /// @throws IoError when it cannot be written
  RecordingFrontend(frontend::Frontend& front, std::filesystem::path file);
  ~RecordingFrontend() override;

  std::string where() const override { return front_.where(); }
  frontend::ScreenSize size() const override { return front_.size(); }
  /// @throws IoError when the script cannot be written any more
  std::vector<frontend::InputEvent> wait(double seconds) override;
  void hold_input(bool is_held) override { front_.hold_input(is_held); }
  void wake() override { front_.wake(); }
  bool is_ready() const override { return front_.is_ready(); }
  bool is_picture_wanted() const override { return front_.is_picture_wanted(); }
  void show(render::Screen& screen) override { front_.show(screen); }
  void set_progress(int frame, bool is_running) override;
  void set_typing(bool is_wanted) override { front_.set_typing(is_wanted); }
  void set_scrolling(const std::vector<frontend::ScrollPlace>& places) override {
    front_.set_scrolling(places);
  }
  bool takes_files() const override { return front_.takes_files(); }
  void offer(const std::filesystem::path& folder, const std::filesystem::path& file) override {
    front_.offer(folder, file);
  }
  void set_clipboard(const std::string& text) override { front_.set_clipboard(text); }
  std::string clipboard() const override { return front_.clipboard(); }

  /// Writes all of it. @throws IoError
  void save();

 private:
  frontend::Frontend& front_;
  std::filesystem::path file_;
  InputRecorder recorder_;
  std::chrono::steady_clock::time_point start_, saved_;
  std::size_t saved_steps_ = 0;
};

}  // namespace neve::app::view::replay
