#include "app/output/picture_writer.h"

#include <iterator>
#include <memory>
#include <utility>

namespace neve::app::output {

PictureWriter::PictureWriter() : worker_([this] { work(); }) {}

PictureWriter::~PictureWriter() {
  {
    const std::lock_guard lock(mutex_);
    is_closing_ = true;
  }
  changed_.notify_all();
  worker_.join();
}

void PictureWriter::write(Picture picture) {
  // Tasks are copied; pictures are large.
  const auto shared = std::make_shared<const Picture>(std::move(picture));
  write([shared] {
    return std::vector<WrittenFile>{
        write_hashed(shared->file, render::encode_png(shared->image, shared->text))};
  });
}

void PictureWriter::write(WriteTask task) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return failure_ || queue_.size() < picture_queue_capacity; });
  rethrow_failure();
  queue_.push_back(std::move(task));
  changed_.notify_all();
}

void PictureWriter::finish() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return failure_ || (queue_.empty() && !is_writing_); });
  rethrow_failure();
}

std::vector<WrittenFile> PictureWriter::take_written() {
  const std::lock_guard lock(mutex_);
  return std::exchange(written_, {});
}

void PictureWriter::work() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [&] { return is_closing_ || !queue_.empty(); });
    if (queue_.empty()) return;
    WriteTask task = std::move(queue_.front());
    queue_.pop_front();
    is_writing_ = true;
    lock.unlock();

    std::exception_ptr failure;
    std::vector<WrittenFile> written;
    try {
      written = task();
    } catch (...) {
      failure = std::current_exception();
    }
    task = nullptr;  // its memory is free before the next frame needs it

    lock.lock();
    is_writing_ = false;
    if (failure) {
      // Waiting pictures would most likely fail in the same way.
      if (!failure_) failure_ = failure;
      queue_.clear();
    } else {
      std::move(written.begin(), written.end(), std::back_inserter(written_));
    }
    changed_.notify_all();
  }
}

void PictureWriter::rethrow_failure() {
  if (failure_) std::rethrow_exception(failure_);
}

}  // namespace neve::app::output
