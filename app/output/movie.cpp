#include "app/output/movie.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <sstream>
#include <system_error>
#include <vector>

#include "app/output/atomic_file.h"
#include "app/output/process.h"
#include "app/output/sequence.h"
#include "app/output/temporary.h"

namespace neve::app::output {

namespace fs = std::filesystem;

namespace {

/// Shortest text that reads back as the same number, with a point in every locale.
std::string decimal(double value) {
  char buffer[64];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed);
  return {buffer, end.ptr};
}

std::string last_line(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) text.pop_back();
  const std::size_t start = text.find_last_of("\r\n");
  return start == std::string::npos ? text : text.substr(start + 1);
}

/// Appends the words of a constant text.
void append_words(std::vector<std::string>& arguments, const char* text) {
  std::istringstream words(text);
  for (std::string word; words >> word;) arguments.push_back(word);
}

/// A frame of 16384x16384 takes about 10 s to encode on one core.
double longest_time(const MovieRequest& request) {
  constexpr double start = 60, per_frame = 20;
  if (request.longest > 0) return request.longest;
  return start + per_frame * (request.last_frame - request.first_frame + 1);
}

/// Pictures are named relative to their folder: its path may hold a '%', a pattern character.
/// yuv420p needs even sides; players take high definition for BT.709 and ignore the file.
ProcessResult encode(const fs::path& ffmpeg, const MovieRequest& request, const fs::path& target) {
  std::vector<std::string> arguments;
  append_words(arguments, "-nostdin -v error -y -f image2 -framerate");
  arguments.push_back(decimal(request.fps));
  arguments.insert(arguments.end(), {"-start_number", std::to_string(request.first_frame)});
  append_words(arguments, "-i %04d.png -frames:v");
  arguments.push_back(std::to_string(request.last_frame - request.first_frame + 1));
  // Movies have no alpha: transparent pictures are laid over a plain colour. (ffmpeg 5.1 crashes
  // when drawbox is to replace alpha, so the plain one has none.)
  const std::string over_plain =
      "split[a][b];[a]format=rgb24,drawbox=c=0x454b55:t=fill[plain];[plain][b]overlay=format=gbrp,";
  arguments.insert(arguments.end(), {"-vf", (request.has_alpha ? over_plain : "") +
                                                "pad=ceil(iw/2)*2:ceil(ih/2)*2,"
                                                "scale=out_color_matrix=bt709:out_range=tv"});
  append_words(arguments,
               "-c:v libx264 -crf 18 -pix_fmt yuv420p "
               "-colorspace bt709 -color_primaries bt709 -color_trc bt709 "
               "-movflags +faststart -f mp4");
  arguments.push_back(fs::absolute(target).string());
  return run_process(ffmpeg, arguments, request.picture_folder, longest_time(request));
}

struct FrameCount {
  long frames = -1;  ///< that can be decoded, -1 when ffmpeg could not say
  std::string said;
};

FrameCount count_frames(const fs::path& ffmpeg, const fs::path& movie, double longest) {
  std::vector<std::string> arguments{"-nostdin", "-v", "error", "-i", fs::absolute(movie).string()};
  append_words(arguments, "-map 0:v:0 -f null -progress pipe:1 /dev/null");
  const ProcessResult result = run_process(ffmpeg, arguments, "/", longest);
  FrameCount count{-1, result.errors};
  const std::string key = "frame=";
  const std::size_t found = result.output.rfind(key);
  if (!result.has_started || result.exit_code != 0 || found == std::string::npos) return count;
  const char* begin = result.output.data() + found + key.size();
  std::from_chars(begin, result.output.data() + result.output.size(), count.frames);
  return count;
}

/// Whether a message is about the disk, or the machine, rather than about the pictures.
bool is_disk_error(const std::string& message) {
  const auto names = [&](int reason) {
    return message.find(std::strerror(reason)) != std::string::npos;
  };
  return names(ENOSPC) || names(EDQUOT) || names(EIO) || names(EFBIG) || names(EROFS) ||
         names(EMFILE) || names(ENFILE);
}

/// The one about the disk, or the last one.
std::string telling_line(const std::string& text) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    if (is_disk_error(line)) return line;
  return last_line(text);
}

/// Removes the movie of an earlier run. @throws IoError where something else has the name
void remove_movie(const fs::path& file) {
  std::error_code error;
  const fs::file_status status = fs::symlink_status(file, error);
  if (!fs::exists(status)) return;
  if (!fs::is_regular_file(status))
    throw IoError(file.string() + ": is no regular file, where a movie is to be written",
                  file.string());
  if (!fs::remove(file, error))
    throw IoError(file.string() + ": cannot remove the earlier movie: " + error.message(),
                  file.string());
}

struct Attempt {
  std::string failure;  ///< empty: there is a movie
  bool may_be_repeated = true;
};

Attempt try_movie(const fs::path& ffmpeg, const MovieRequest& request, const fs::path& temporary) {
  const ProcessResult result = encode(ffmpeg, request, temporary);
  if (!result.has_started) return {"ffmpeg does not start: " + result.errors};
  if (result.is_too_slow) return {"ffmpeg was stopped: it took far too long", false};
  if (result.exit_code != 0)
    return {"ffmpeg failed (" + std::to_string(result.exit_code) +
            "): " + telling_line(result.errors)};
  const long expected = request.last_frame - request.first_frame + 1;
  const FrameCount count = count_frames(ffmpeg, temporary, longest_time(request));
  if (count.frames == expected) return {};
  const std::string said = telling_line(result.errors + count.said);
  return {"ffmpeg made " + std::to_string(std::max(count.frames, 0L)) + " of " +
          std::to_string(expected) + " frames" + (said.empty() ? "" : ": " + said)};
}

/// Why a picture cannot be read, which ffmpeg does not say; empty where all can.
std::string unreadable_picture(const MovieRequest& request) {
  try {
    for (int frame = request.first_frame; frame <= request.last_frame; ++frame)
      read_file(frame_path(request.picture_folder, ".", frame));
  } catch (const UnreadableError& error) {
    return error.what();
  } catch (const IoError&) {
    // It is not there.
  }
  return {};
}

}  // namespace

MovieResult write_movie(const MovieRequest& request) {
  const auto ffmpeg = find_program("ffmpeg");
  if (!ffmpeg) return {MovieOutcome::no_ffmpeg, {}};

  const fs::path temporary = temporary_name(request.file);
  try {
    remove_movie(request.file);
    // Whether the folder takes a file at all: ffmpeg would not say why in a way that can be told.
    replace_file(temporary, {}, Durability::cached);
  } catch (const IoError& error) {
    return {MovieOutcome::unwritable, error.what()};
  }
  Attempt attempt = try_movie(*ffmpeg, request, temporary);
  // A machine that fails once need not fail again.
  if (!attempt.failure.empty() && attempt.may_be_repeated && !is_disk_error(attempt.failure))
    attempt = try_movie(*ffmpeg, request, temporary);
  if (!attempt.failure.empty()) {
    std::error_code error;
    fs::remove(temporary, error);
    if (is_disk_error(attempt.failure)) return {MovieOutcome::unwritable, attempt.failure};
    const std::string unreadable = unreadable_picture(request);
    if (!unreadable.empty()) return {MovieOutcome::unwritable, unreadable};
    return {MovieOutcome::failed, attempt.failure};
  }
  try {
    move_into_place(temporary, request.file);
    sync_files({request.file});
  } catch (const IoError& error) {
    std::error_code ignored;
    fs::remove(temporary, ignored);
    return {MovieOutcome::unwritable, error.what()};
  }
  return {MovieOutcome::written, {}};
}

}  // namespace neve::app::output
