#pragma once
/// Works `neve view` from a script, without a display: the same every time, in tests and for the
/// pictures of the documentation.

#include <condition_variable>
#include <deque>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>

#include "app/view/frontend/frontend.h"
#include "app/view/panels/labels.h"
#include "app/view/replay/replay_script.h"

namespace neve::app::view::replay {

/// Each wait() is one frame of the panels and brings the events in it; for the panels it should
/// be 1/60 s long however long it takes. A frame without input lets that time pass, unless wait()
/// is not to take any, so that other threads can work.
class ReplayFrontend : public frontend::Frontend {
 public:
  struct Options {
    std::filesystem::path folder = ".";  ///< of screenshots and dropped files
    int frames = 0;                      ///< so many, then close; 0: until the script ends
    frontend::ScreenSize size{};
  };

  /// @param file of the script, for messages
  ReplayFrontend(std::vector<ReplayStep> steps, std::string file, Options options);

  std::string where() const override { return "replay of " + file_; }
  frontend::ScreenSize size() const override { return options_.size; }
  /// @throws Error of exit code 9 at a step that cannot be done: no such label, or the simulation
  /// does not get there in time, or the frames end before the script does
  std::vector<frontend::InputEvent> wait(double seconds) override;
  void wake() override;
  bool is_ready() const override { return true; }
  /// True for a screenshot, and while a step waits for a label.
  bool is_picture_wanted() const override;
  /// @throws IoError when a screenshot cannot be written
  void show(render::Screen& screen) override;
  void set_progress(int frame, bool is_running) override;
  void set_clipboard(const std::string& text) override { clipboard_ = text; }
  std::string clipboard() const override { return clipboard_; }

 private:
  struct NextFrame {
    std::vector<frontend::InputEvent> events{};
    const ReplayStep* screenshot = nullptr;  ///< that the picture of this frame is for
  };

  bool begin(const ReplayStep& step);
  bool begin_on_places(const ReplayStep& step);
  bool is_in_time(const ReplayStep& step);
  bool is_reached(const ReplayGoal& goal) const;
  bool find(const std::string& label, panels::LabelPlace& place);
  [[noreturn]] void give_up(const ReplayStep& step, const std::string& message,
                            const std::string& hint) const;
  [[noreturn]] void give_up_label(const ReplayStep& step, const std::string& label) const;
  std::vector<frontend::InputEvent> closing() const;

  std::vector<ReplayStep> steps_;
  std::string file_;
  Options options_;
  std::size_t next_ = 0;  ///< step
  int frame_ = 0;
  std::deque<NextFrame> frames_;
  const ReplayStep* screenshot_ = nullptr;  ///< that the next picture is for

  int frames_waited_ = 0;                           ///< for the step that cannot begin yet
  double waiting_since_ = 0;                        ///< s
  bool is_idle_ = false;                            ///< nothing happens in this frame
  std::map<std::string, panels::LabelPlace> seen_;  ///< labels of the step, a frame ago

  std::string clipboard_;
  std::optional<int> simulation_frame_;
  bool is_simulation_running_ = false;

  std::mutex mutex_;
  std::condition_variable woken_;
  bool is_woken_ = false;
};

}  // namespace neve::app::view::replay
