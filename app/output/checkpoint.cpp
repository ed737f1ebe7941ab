#include "app/output/checkpoint.h"

#include <fcntl.h>
#include <unistd.h>
#include <zlib.h>

#include <fmt/core.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <system_error>

#include "app/output/atomic_file.h"
#include "app/output/descriptor.h"
#include "app/output/sequence.h"
#include "app/output/temporary.h"
#include "app/support/errors.h"
#include "app/support/out_folder.h"
#include "app/support/room.h"
#include "app/support/text.h"

namespace neve::app::output {

namespace {

namespace fs = std::filesystem;

// Layout: magic, length of the JSON (8 bytes), JSON, state, CRC-32 of all before (8 bytes).
constexpr char magic[8] = {'N', 'E', 'V', 'E', 'C', 'K', 'P', '1'};
constexpr std::size_t number_bytes = 8;
constexpr std::size_t kept = 2;
constexpr std::uint64_t largest_file = std::uint64_t{1} << 40;
/// Each byte of the JSON takes so much memory: a frame has about a kilobyte, and takes some ten.
constexpr double bytes_of_json = 10;
constexpr const char* no_memory = "needs more memory than may be used";
constexpr const char* no_checkpoint = "is not a checkpoint of this version";

fs::path folder_of(const fs::path& folder) {
  return folder / "checkpoint";
}

void append_bytes(std::vector<std::uint8_t>& bytes, const void* data, std::size_t size) {
  const auto* first = static_cast<const std::uint8_t*>(data);
  bytes.insert(bytes.end(), first, first + size);
}

std::uint64_t checksum(std::span<const std::uint8_t> bytes) {
  return crc32_z(crc32_z(0, nullptr, 0), bytes.data(), bytes.size());
}

/// Names sort by frame, then by steps.
std::string file_name(const Checkpoint& c) {
  return fmt::format("{:06}-{:012}.ckpt", c.frame, c.steps);
}

/// Returns the frame that a file is named after; -1 for other names.
int frame_of(const fs::path& file) {
  int frame = -1;
  const std::string stem = file.stem().string();
  const auto end = std::from_chars(stem.data(), stem.data() + stem.size(), frame);
  return end.ec == std::errc() && frame >= 0 && frame <= max_frame ? frame : -1;
}

/// Lists checkpoints, the newest first; none behind a link, where they are another's.
std::vector<fs::path> checkpoints_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error, ignored;
  if (fs::is_symlink(fs::symlink_status(folder, ignored))) return files;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
    if (it->path().extension() == ".ckpt" && it->is_regular_file(ignored))
      files.push_back(it->path());
  if (error && error != std::errc::no_such_file_or_directory && error != std::errc::not_a_directory)
    throw UnreadableError(folder.string() + ": cannot read: " + error.message(), folder.string());
  std::sort(files.rbegin(), files.rend());
  return files;
}

std::vector<fs::path> list(const fs::path& folder) {
  return checkpoints_in(folder_of(folder));
}

fs::path states_folder(const fs::path& folder) {
  return folder / "states";
}

fs::path state_path(const fs::path& folder, int frame) {
  return folder / state_name(frame);
}

/// A file is judged by its first bytes and its size before there is memory for it.
void check_start(const fs::path& file) {
  std::error_code error;
  char start[sizeof magic] = {};
  const Descriptor in(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
  if (in.get() < 0) return;  // reading it says why
  const ssize_t count = ::read(in.get(), start, sizeof start);
  if (count < 0)
    throw UnreadableError(file.string() + ": cannot read: " + std::strerror(errno), file.string());
  if (count == sizeof start && std::memcmp(start, magic, sizeof magic) != 0)
    throw std::runtime_error(no_checkpoint);
  if (static_cast<double>(fs::file_size(file, error)) > memory_room() && !error)
    throw std::runtime_error(no_memory);
}

/// @return whether the file is whole; its damage is noted where it is not
bool read_into(FoundCheckpoint& found, const fs::path& file) {
  try {
    check_start(file);
    found.checkpoint = parse_checkpoint(read_file(file, largest_file));
    found.checkpoint->file = file;
    return true;
  } catch (const UnreadableError&) {
    throw;
  } catch (const std::exception& error) {
    rethrow_no_memory(error);
    found.damaged.push_back(file.string() + ": " + error.what());
    return false;
  }
}

}  // namespace

void tidy_checkpoint_folder(const fs::path& folder) {
  const fs::path path = folder_of(folder);
  std::error_code error;
  if (!fs::exists(fs::symlink_status(path, error))) return;
  if (fs::is_directory(fs::symlink_status(path, error))) return remove_abandoned(path);
  throw IoError(path.string() + ": cannot write checkpoints here: not a folder", path.string(),
                or_other_place("rename it, use --checkpoint-every 0"));
}

std::vector<std::uint8_t> encode_checkpoint(const Checkpoint& checkpoint) {
  const std::string text = to_text({{"identity", checkpoint.identity},
                                    {"simd", checkpoint.simd},
                                    {"sources", checkpoint.sources},
                                    {"frame", checkpoint.frame},
                                    {"steps", checkpoint.steps},
                                    {"progress", checkpoint.progress}},
                                   -1);
  std::vector<std::uint8_t> bytes;
  bytes.reserve(checkpoint.state.size() + text.size() + 64);
  append_bytes(bytes, magic, sizeof magic);
  const std::uint64_t length = text.size();
  append_bytes(bytes, &length, number_bytes);
  append_bytes(bytes, text.data(), text.size());
  append_bytes(bytes, checkpoint.state.data(), checkpoint.state.size());
  const std::uint64_t sum = checksum(bytes);
  append_bytes(bytes, &sum, number_bytes);
  return bytes;
}

Checkpoint parse_checkpoint(std::vector<std::uint8_t> bytes) {
  const auto refuse = [](const char* why) { throw std::runtime_error(why); };
  if (bytes.size() < sizeof magic + 2 * number_bytes) refuse("is truncated");
  if (std::memcmp(bytes.data(), magic, sizeof magic) != 0) refuse(no_checkpoint);
  const std::size_t body = bytes.size() - number_bytes;
  std::uint64_t length = 0, sum = 0;
  std::memcpy(&length, bytes.data() + sizeof magic, number_bytes);
  std::memcpy(&sum, bytes.data() + body, number_bytes);
  if (sum != checksum({bytes.data(), body})) refuse("is damaged: its checksum is wrong");
  const std::size_t json_start = sizeof magic + number_bytes;
  if (length > body - json_start) refuse("is damaged");
  if (bytes_of_json * static_cast<double>(length) > memory_room()) refuse(no_memory);
  const Json json = parse_json(std::span(bytes).subspan(json_start, length));
  Checkpoint c;
  c.identity = json.at("identity").get<std::string>();
  c.simd = json.at("simd").get<std::string>();
  c.sources = json.value("sources", "");
  c.frame = whole_number<int>(json.at("frame"));
  c.steps = whole_number<std::size_t>(json.at("steps"));
  if (c.frame < 0 || c.frame > max_frame) refuse("has an invalid frame number");
  c.progress = json.at("progress");
  // The state is not copied: it may take most of the memory.
  bytes.resize(body);
  bytes.erase(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(json_start + length));
  c.state = std::move(bytes);
  return c;
}

void write_checkpoint(const fs::path& folder, const Checkpoint& checkpoint) {
  const std::vector<std::uint8_t> bytes = encode_checkpoint(checkpoint);
  std::error_code error;
  const bool is_new = !fs::exists(folder_of(folder), error);
  make_own_folder(folder_of(folder));
  if (is_new) sync_folder(folder);
  write_file(folder_of(folder) / file_name(checkpoint), bytes, Durability::synced);
  remove_abandoned(folder_of(folder));
  const std::vector<fs::path> files = list(folder);
  for (std::size_t k = kept; k < files.size(); ++k) fs::remove(files[k], error);
}

FoundCheckpoint find_checkpoint(const fs::path& folder, int before) {
  FoundCheckpoint found;
  for (const fs::path& file : list(folder))
    if (frame_of(file) < before && read_into(found, file)) {
      if (found.checkpoint->frame < before) break;
      found.checkpoint.reset();
    }
  return found;
}

std::uint64_t write_state(const fs::path& folder, const Checkpoint& checkpoint) {
  make_own_folder(states_folder(folder));
  // Its checksum marks a file that a power cut left unfinished.
  const std::vector<std::uint8_t> bytes = encode_checkpoint(checkpoint);
  write_file(state_path(folder, checkpoint.frame), bytes);
  return bytes.size();
}

std::uint64_t state_bytes(const fs::path& folder, int frame) {
  std::error_code error;
  const std::uint64_t bytes = fs::file_size(state_path(folder, frame), error);
  return error ? 0 : bytes;
}

void tidy_states_folder(const fs::path& folder) {
  std::error_code error;
  if (fs::is_directory(fs::symlink_status(states_folder(folder), error)))
    remove_abandoned(states_folder(folder));
}

void remove_state(const fs::path& folder, int frame) {
  std::error_code error;
  fs::remove(state_path(folder, frame), error);
}

std::vector<int> kept_states(const fs::path& folder) {
  std::vector<int> frames;
  for (const fs::path& file : checkpoints_in(states_folder(folder)))
    if (const int frame = frame_of(file); frame >= 0 && file == state_path(folder, frame))
      frames.push_back(frame);
  std::sort(frames.begin(), frames.end());
  return frames;
}

std::map<int, std::size_t> checkpoint_steps(const fs::path& folder) {
  std::map<int, std::size_t> steps;
  for (const fs::path& file : list(folder)) {
    const std::string name = file.stem().string();
    const auto count = number_of<std::size_t>(std::string_view(name).substr(name.find('-') + 1));
    if (const int frame = frame_of(file); frame >= 0 && count) steps.emplace(frame, *count);
  }
  return steps;
}

FoundCheckpoint read_state(const fs::path& folder, int frame) {
  FoundCheckpoint found;
  const fs::path file = state_path(folder, frame);
  std::error_code error;
  if (!fs::is_regular_file(file, error) || !read_into(found, file)) return found;
  if (found.checkpoint->frame == frame) return found;
  return {std::nullopt, {file.string() + ": is the state of another frame"}};
}

std::string state_name(int frame) {
  return fmt::format("states/{:06}.ckpt", frame);
}

KeptFiles check_kept(const fs::path& folder) {
  KeptFiles kept;
  std::error_code error;
  const auto note = [&](const fs::path& file, const FoundCheckpoint& found,
                        const std::string& why) {
    // A run that is under way may have thinned it out meanwhile.
    if (!fs::exists(file, error)) return;
    ++kept.count;
    const std::string what =
        !why.empty() || found.damaged.empty()
            ? why
            : found.damaged.front().substr(file.string().size() + 2);  // after "FILE: "
    if (!what.empty()) kept.damaged[file.lexically_relative(folder).generic_string()] = what;
  };
  const auto check = [&](const fs::path& file, const auto& read) {
    try {
      note(file, read(), "");
    } catch (const UnreadableError& unreadable) {
      note(file, {}, unreadable.what());
    }
  };
  kept.has_states = fs::is_directory(states_folder(folder), error);
  kept.states = kept_states(folder);
  for (const int frame : kept.states)
    check(state_path(folder, frame), [&] { return read_state(folder, frame); });
  for (const fs::path& file : list(folder))
    check(file, [&] {
      FoundCheckpoint found;
      read_into(found, file);
      return found;
    });
  return kept;
}

void remove_states(const fs::path& folder) {
  std::error_code error;
  for (const int frame : kept_states(folder)) remove_state(folder, frame);
  remove_abandoned(states_folder(folder));
  ::rmdir(states_folder(folder).c_str());
}

void remove_checkpoints(const fs::path& folder) {
  std::error_code error;
  for (const fs::path& file : list(folder)) fs::remove(file, error);
  remove_abandoned(folder_of(folder));
  // This removes a folder only, and only when nothing else is in it.
  ::rmdir(folder_of(folder).c_str());
}

}  // namespace neve::app::output
