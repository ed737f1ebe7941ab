#include "app/output/movie.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <sstream>
#include <system_error>
#include <vector>

#include "app/output/atomic_file.h"
#include "app/output/process.h"
#include "app/output/sequence.h"
#include "app/output/temporary.h"
#include "app/support/errors.h"
#include "app/support/text.h"

namespace neve::app::output {

namespace fs = std::filesystem;

namespace {

/// A frame of 16384x16384 takes about 10 s to encode on one core.
double longest_time(const MovieRequest& request) {
  constexpr double start = 60, per_frame = 20;
  if (request.longest > 0) return request.longest;
  return start + per_frame * (request.last_frame - request.first_frame + 1);
}

/// Removes a file in the end.
struct Scratch {
  fs::path file;
  ~Scratch() {
    std::error_code error;
    fs::remove(file, error);
  }
};

/// A GIF has one palette, which is found first.
ProcessResult encode(const fs::path& ffmpeg, const MovieRequest& request, const fs::path& target) {
  const auto run = [&](const std::vector<std::string>& arguments) {
    return run_process(ffmpeg, arguments, request.picture_folder, longest_time(request));
  };
  const Scratch palette{temporary_name(request.file.parent_path() / "palette.png")};
  if (request.style.format == MovieFormat::gif) {
    ProcessResult found = run(palette_arguments(request, palette.file));
    if (!found.has_started || found.exit_code != 0) return found;
  }
  return run(movie_arguments(request, target, palette.file));
}

struct FrameCount {
  long frames = -1;  ///< that can be decoded, -1 when ffmpeg could not say
  std::string said;
};

/// ffmpeg writes animated WebP and reads none. Equal frames in a row are one that lasts longer, so
/// their times are counted.
FrameCount count_webp_frames(const fs::path& movie, double fps) {
  const std::vector<std::uint8_t> bytes = read_file(movie);
  const auto number = [&](std::size_t at, int size) {
    std::size_t value = 0;
    for (int k = size; k-- > 0;) value = value << 8 | bytes[at + static_cast<std::size_t>(k)];
    return value;
  };
  constexpr std::size_t head = 12, chunk_head = 8, duration_at = 12;
  const auto is_at = [&](std::size_t at, const char* word) {
    return std::memcmp(bytes.data() + at, word, 4) == 0;
  };
  if (bytes.size() < head || !is_at(0, "RIFF") || number(4, 4) + 8 != bytes.size())
    return {-1, "the file is incomplete"};
  double milliseconds = 0;
  for (std::size_t at = head; at + chunk_head <= bytes.size();) {
    const std::size_t size = number(at + 4, 4);
    if (is_at(at, "ANMF") && at + chunk_head + duration_at + 3 <= bytes.size())
      milliseconds += static_cast<double>(number(at + chunk_head + duration_at, 3));
    at += chunk_head + size + size % 2;
  }
  return {std::lround(milliseconds * fps / 1000), {}};
}

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

/// Links to the pictures, numbered from 0: ffmpeg reads no numbers below 0 as printf writes them.
class CountedPictures {
 public:
  explicit CountedPictures(const MovieRequest& request)
      : folder_(temporary_name(request.file.string() + ".pictures")), request_(request) {
    if (request.first_frame >= 0) return;
    make_folder(folder_);
    for (int frame = request.first_frame; frame <= request.last_frame; ++frame)
      fs::create_symlink(fs::absolute(frame_path(request.picture_folder, ".", frame)),
                         frame_path(folder_, ".", frame - request.first_frame));
    request_.picture_folder = folder_;
    request_.first_frame = 0;
    request_.last_frame = request.last_frame - request.first_frame;
  }
  ~CountedPictures() {
    std::error_code error;
    fs::remove_all(folder_, error);
  }
  CountedPictures(const CountedPictures&) = delete;
  CountedPictures& operator=(const CountedPictures&) = delete;

  const MovieRequest& request() const { return request_; }

 private:
  fs::path folder_;
  MovieRequest request_;
};

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

/// @throws IoError where something else than a movie has the name
void require_regular(const fs::path& file) {
  std::error_code error;
  const fs::file_status status = fs::symlink_status(file, error);
  if (fs::exists(status) && !fs::is_regular_file(status))
    throw IoError(file.string() + ": cannot write the movie here: this is not a regular file",
                  file.string());
}

struct Attempt {
  std::string failure;  ///< empty: there is a movie
  bool may_be_repeated = true;
};

Attempt try_movie(const fs::path& ffmpeg, const MovieRequest& request, const fs::path& temporary) {
  const ProcessResult result = encode(ffmpeg, request, temporary);
  if (!result.has_started) return {"ffmpeg does not start: " + result.errors};
  if (result.is_too_slow) return {"ffmpeg was stopped: it took too long", false};
  if (result.exit_code != 0)
    return {"ffmpeg failed (" + std::to_string(result.exit_code) +
            "): " + telling_line(result.errors)};
  const long expected = request.last_frame - request.first_frame + 1;
  const FrameCount count = request.style.format == MovieFormat::webp
                               ? count_webp_frames(temporary, movie_fps(request))
                               : count_frames(ffmpeg, temporary, longest_time(request));
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
    // The picture is missing.
  }
  return {};
}

}  // namespace

namespace {

/// Makes the movie of pictures whose numbers are not negative.
MovieResult write_counted(const fs::path& ffmpeg, const MovieRequest& request) {
  const fs::path temporary = temporary_name(request.file);
  try {
    require_regular(request.file);
    // This tells whether the folder takes a file at all: ffmpeg would not say why it does not.
    replace_file(temporary, {}, Durability::cached);
  } catch (const IoError& error) {
    return {MovieOutcome::unwritable, error.what()};
  }
  Attempt attempt = try_movie(ffmpeg, request, temporary);
  // A machine that fails once need not fail again.
  if (!attempt.failure.empty() && attempt.may_be_repeated && !is_disk_error(attempt.failure))
    attempt = try_movie(ffmpeg, request, temporary);
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

}  // namespace

MovieResult write_movie(const MovieRequest& request) {
  const auto ffmpeg = find_program("ffmpeg");
  if (!ffmpeg) return {MovieOutcome::no_ffmpeg, {}};
  try {
    const CountedPictures pictures(request);
    return write_counted(*ffmpeg, pictures.request());
  } catch (const fs::filesystem_error& error) {
    return {MovieOutcome::unwritable, error.what()};
  } catch (const IoError& error) {
    return {MovieOutcome::unwritable, error.what()};
  }
}

namespace {

/// Browsers show at most this many frames a second of a GIF.
constexpr double fastest_gif = 50;

void require_gif_rate(const MovieStyle& style, double fps) {
  const double rate = style.fps > 0 ? style.fps : fps;
  if (style.format == MovieFormat::gif && rate > fastest_gif)
    throw Error(exit_usage,
                "--movie gif: browsers show at most 50 frames a second of a GIF, and these are " +
                    rough_text(rate) + "; add --movie-fps 50 to slow it down, or use --movie webp",
                "--movie", "add --movie-fps 50, or use --movie webp");
}

/// Returns the formats that this ffmpeg has an encoder for.
std::vector<MovieFormat> formats_of(const fs::path& ffmpeg) {
  const ProcessResult listed = run_process(ffmpeg, {"-v", "error", "-encoders"}, "/", 60);
  std::vector<MovieFormat> formats(all_movie_formats.begin(), all_movie_formats.end());
  std::erase_if(formats, [&](MovieFormat format) {
    return listed.output.find(std::string(" ") + info_of(format).encoder + " ") ==
           std::string::npos;
  });
  return formats;
}

}  // namespace

MovieStyle available_movie(const MovieStyle& style, double fps) {
  if (!style.is_made) return style;
  if (style.is_chosen) require_gif_rate(style, fps);
  const std::string flag = std::string("--movie ") + name(style.format);
  const auto ffmpeg = find_program("ffmpeg");
  if (!ffmpeg && !style.is_chosen) return style;
  if (!ffmpeg)
    throw IoError(flag +
                      ": ffmpeg, which makes movies, is not in PATH; install it (Debian: "
                      "ffmpeg), or leave pictures with --movie none",
                  "ffmpeg", "--movie none");
  const std::vector<MovieFormat> formats = formats_of(*ffmpeg);
  const auto has = [&](MovieFormat format) {
    return std::ranges::find(formats, format) != formats.end();
  };
  if (has(style.format)) return style;
  MovieStyle other = style;
  for (const MovieFormat format : {MovieFormat::vp9, MovieFormat::prores, MovieFormat::gif}) {
    other.format = format;
    if (!style.has_format && has(format) && (format != MovieFormat::gif || fps <= fastest_gif))
      return other;
  }
  if (!style.is_chosen) return style;  // the pictures come with a warning
  std::string others;
  for (const MovieFormat format : formats)
    others += (others.empty() ? "" : ", ") + std::string(name(format));
  throw IoError(flag + ": " + ffmpeg->string() + " has no encoder " +
                    info_of(style.format).encoder + "; install a complete ffmpeg" +
                    (others.empty() ? ", or leave pictures with --movie none"
                                    : ", or choose a format that this one makes: " + others),
                ffmpeg->string(), others.empty() ? "--movie none" : "choose another format");
}

std::string other_format_text(const MovieStyle& wanted, const MovieStyle& available) {
  if (wanted.format == available.format) return {};
  return std::string("ffmpeg here makes no ") + name(wanted.format) + ": movies are " +
         name(available.format) + ", *" + info_of(available.format).suffix;
}

}  // namespace neve::app::output
