#pragma once
/// Encodes and writes pictures and other files on a worker thread while the next frame is
/// simulated.

#include <condition_variable>
#include <deque>
#include <exception>
#include <filesystem>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "app/output/file_hash.h"
#include "render/image/image.h"

namespace neve::app::output {

struct Picture {
  std::filesystem::path file;
  render::Image image;
  render::PngText text;
};

/// Writes files. @return them
using WriteTask = std::function<std::vector<WrittenFile>()>;

/// Pictures that may wait for the worker; memory is planned for these and the one it holds.
inline constexpr std::size_t picture_queue_capacity = 3;

class PictureWriter {
 public:
  PictureWriter();
  /// Writes the waiting pictures; errors not requested are dropped.
  ~PictureWriter();
  PictureWriter(const PictureWriter&) = delete;
  PictureWriter& operator=(const PictureWriter&) = delete;

  /// Waits while the queue is full. @throws the error of an earlier picture
  void write(Picture picture);

  /// The same for any other file. @param task  encodes and writes it, or several
  void write(WriteTask task);

  /// Waits until everything is written. @throws the error of a picture
  void finish();

  /// Returns the files that were written since the last call.
  std::vector<WrittenFile> take_written();

 private:
  void work();
  void rethrow_failure();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<WriteTask> queue_;
  std::vector<WrittenFile> written_;
  bool is_writing_ = false, is_closing_ = false;
  std::exception_ptr failure_;
  std::thread worker_;
};

}  // namespace neve::app::output
