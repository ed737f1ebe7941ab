#pragma once
/// A disk after a power cut: the writes of a program, replayed up to some moment, without some of
/// what was not synced.
///
/// Contents of a file are kept as they were at its last fsync; later writes are whole, missing, or
/// partial. Names (files made, moved, removed) are kept in order, up to the last fsync of their
/// folder at least, and up to a random one of those since.

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "tests/support/temporary_folder.h"

namespace neve::test {

struct DiskCall {
  std::string operation, path;
  std::string bytes;  ///< written; of a rename the new name
};

/// Returns the calls of a journal that tests/faults wrote.
inline std::vector<DiskCall> read_journal(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::vector<DiskCall> calls;
  for (std::string head; std::getline(in, head);) {
    DiskCall call;
    const std::size_t blank = head.find(' ');
    call.operation = head.substr(0, blank);
    std::getline(in, call.path);
    call.bytes.resize(std::stoul(head.substr(blank + 1)));
    in.read(call.bytes.data(), static_cast<std::streamsize>(call.bytes.size()));
    calls.push_back(std::move(call));
  }
  return calls;
}

class PowerCut {
 public:
  /// @param end  calls that were made before the cut
  PowerCut(const std::vector<DiskCall>& calls, std::size_t end, unsigned seed) : random_(seed) {
    std::size_t least = 0;  // names up to here are on the disk
    for (std::size_t k = 0; k < end; ++k)
      if (calls[k].operation == "fsync" && folders_.contains(calls[k].path))
        least = k + 1;
      else if (calls[k].operation == "folder")
        folders_.insert({calls[k].path, {}});
    const std::size_t names_end = least + below(end - least + 1);
    for (std::size_t k = 0; k < end; ++k) change(calls[k], k < names_end);
  }

  /// Writes what is left below `from` to `to`.
  void restore(const std::string& from, const std::filesystem::path& to) {
    std::filesystem::create_directories(to);
    for (const auto& [folder, none] : on_disk_folders_)
      if (folder.starts_with(from + "/"))
        std::filesystem::create_directories(to / folder.substr(from.size() + 1));
    for (const auto& [path, content] : on_disk_) {
      if (!path.starts_with(from + "/")) continue;
      const std::filesystem::path file = to / path.substr(from.size() + 1);
      std::error_code error;
      std::filesystem::create_directories(file.parent_path(), error);
      std::ofstream(file, std::ios::binary) << after_cut(*content);
    }
  }

 private:
  struct Content {
    std::string written, synced;
    std::string left;  ///< chosen once, also where a file has two names
    bool is_chosen = false;
  };
  using Names = std::map<std::string, std::shared_ptr<Content>>;

  std::size_t below(std::size_t end) { return random_() % end; }

  /// @param is_kept  its name reaches the disk
  void change(const DiskCall& call, bool is_kept) {
    std::shared_ptr<Content>& now = names_[call.path];
    if (call.operation == "folder" && is_kept) on_disk_folders_.insert({call.path, {}});
    if (call.operation == "create" && !now) {
      now = std::make_shared<Content>();
      if (is_kept) on_disk_[call.path] = now;
    }
    if (call.operation == "write" && now) now->written += call.bytes;
    if (call.operation == "fsync" && now) now->synced = now->written;
    if (call.operation == "rename") {
      if (is_kept && on_disk_.contains(call.path)) {
        on_disk_[call.bytes] = on_disk_[call.path];
        on_disk_.erase(call.path);
      }
      names_[call.bytes] = names_[call.path];
      names_.erase(call.path);
    }
    if (call.operation == "remove") {
      if (is_kept) on_disk_.erase(call.path);
      names_.erase(call.path);
    }
  }

  const std::string& after_cut(Content& content) {
    if (content.is_chosen) return content.left;
    content.is_chosen = true;
    const std::size_t synced = content.synced.size(), all = content.written.size();
    const std::size_t some[] = {synced, all, synced + below(all - synced + 1)};
    content.left = content.written.substr(0, some[below(3)]);
    return content.left;
  }

  std::mt19937 random_;
  Names names_, on_disk_;
  std::map<std::string, int> folders_, on_disk_folders_;
};

}  // namespace neve::test
