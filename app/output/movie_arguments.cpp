#include "app/output/movie.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "app/support/film_rate.h"

namespace neve::app::output {

namespace {

using FfmpegWords = std::vector<std::string>;

/// Pictures are named relative to their folder: its path may hold a '%', a pattern character.
FfmpegWords input_arguments(const MovieRequest& request) {
  FfmpegWords arguments;
  append_words(arguments, "-nostdin -v error -y -f image2 -framerate");
  arguments.push_back(rate_text(movie_fps(request)));
  arguments.insert(arguments.end(), {"-start_number", std::to_string(request.first_frame)});
  append_words(arguments, "-i %04d.png");
  return arguments;
}

void append_frames(const MovieRequest& request, FfmpegWords& arguments) {
  arguments.push_back("-frames:v");
  arguments.push_back(std::to_string(request.last_frame - request.first_frame + 1));
}

/// True for WebM, QuickTime and WebP.
bool keeps_alpha(MovieFormat format) {
  return format == MovieFormat::vp9 || format == MovieFormat::prores || format == MovieFormat::webp;
}

/// The constant rate factor of quality 80 is `usual`; half as much per step is lost.
std::string rate_factor(const MovieStyle& style, double usual, double per_step, int most) {
  const long factor = std::lround(usual + per_step * (80 - style.quality));
  return std::to_string(std::clamp(factor, 0L, static_cast<long>(most)));
}

/// Profiles proxy, LT, standard and HQ; 4444 has alpha.
std::string prores_words(const MovieStyle& style, bool has_alpha) {
  const int profile = style.quality < 40 ? 0 : style.quality < 65 ? 1 : style.quality < 80 ? 2 : 3;
  return "-profile:v " + std::to_string(has_alpha ? 4 : profile) + " -vendor apl0 -pix_fmt " +
         (has_alpha ? "yuva444p10le" : "yuv422p10le") + " -f mov";
}

std::string encoder_words(const MovieRequest& request) {
  const MovieStyle& style = request.style;
  const std::string bt709 = " -colorspace bt709 -color_primaries bt709 -color_trc bt709 ";
  const std::string at_once = "-movflags +faststart -f mp4";
  switch (style.format) {
    case MovieFormat::h264:
      // Half the time of the usual preset, at the same size and similarity.
      return "-preset faster -crf " + rate_factor(style, 18, 0.5, 51) + " -pix_fmt yuv420p" +
             bt709 + at_once;
    case MovieFormat::h265:
      return "-crf " + rate_factor(style, 22, 0.5, 51) +
             " -pix_fmt yuv420p -tag:v hvc1 -x265-params log-level=error" + bt709 + at_once;
    case MovieFormat::vp9:
      return "-crf " + rate_factor(style, 24, 0.6, 63) +
             " -b:v 0 -row-mt 1 -deadline good -cpu-used 2" + bt709 +
             (request.has_alpha ? "-pix_fmt yuva420p -auto-alt-ref 0" : "-pix_fmt yuv420p") +
             " -f webm";
    case MovieFormat::prores:
      return prores_words(style, request.has_alpha) + bt709;
    case MovieFormat::gif:
      return "-loop 0 -f gif";
    case MovieFormat::webp:
      return "-quality " + std::to_string(style.quality) +
             " -compression_level 4 -loop 0 -pix_fmt bgra -f webp";
  }
  return {};
}

/// Most formats have no alpha: transparent pictures are laid over a plain colour. (ffmpeg 5.1
/// crashes when drawbox is to replace alpha, so the plain one has none.)
std::string over_plain(const MovieRequest& request) {
  if (!request.has_alpha || keeps_alpha(request.style.format)) return {};
  return "split[a][b];[a]format=rgb24,drawbox=c=0x454b55:t=fill[plain];[plain][b]overlay=format="
         "gbrp,";
}

}  // namespace

void append_words(std::vector<std::string>& arguments, const std::string& text) {
  std::istringstream words(text);
  for (std::string word; words >> word;) arguments.push_back(word);
}

double movie_fps(const MovieRequest& request) {
  return request.style.fps > 0 ? request.style.fps : request.fps;
}

/// Players take high definition for BT.709 and ignore the file.
std::vector<std::string> movie_arguments(const MovieRequest& request,
                                         const std::filesystem::path& target,
                                         const std::filesystem::path& palette) {
  const MovieFormat format = request.style.format;
  FfmpegWords arguments = input_arguments(request);
  const bool is_gif = format == MovieFormat::gif;
  if (is_gif)
    arguments.insert(arguments.end(), {"-i", std::filesystem::absolute(palette).string()});
  append_frames(request, arguments);
  if (is_gif)
    arguments.insert(arguments.end(),
                     {"-lavfi", "[0:v]" + over_plain(request) +
                                    "format=rgb24[x];[x][1:v]paletteuse=dither=sierra2_4a"});
  else if (is_video(format))
    arguments.insert(
        arguments.end(),
        {"-vf",
         over_plain(request) +
             "pad=ceil(iw/2)*2:ceil(ih/2)*2,"
             "scale=out_color_matrix=bt709:out_range=tv,"
             // Encoders take them from the pictures; -color_trc alone leaves a QuickTime without.
             "setparams=color_primaries=bt709:color_trc=bt709:colorspace=bt709"});
  if (is_video(format) && !request.time_code.empty())
    arguments.insert(arguments.end(), {"-timecode", request.time_code});
  arguments.insert(arguments.end(), {"-c:v", info_of(format).encoder});
  append_words(arguments, encoder_words(request));
  arguments.push_back(std::filesystem::absolute(target).string());
  return arguments;
}

std::vector<std::string> palette_arguments(const MovieRequest& request,
                                           const std::filesystem::path& palette) {
  const int colours = std::clamp(16 + 3 * request.style.quality, 16, 256);
  FfmpegWords arguments = input_arguments(request);
  // One more is the frame of the palette; the input ends by itself, or where its count is reached.
  arguments.insert(
      arguments.end(),
      {"-vf",
       "trim=end_frame=" + std::to_string(request.last_frame - request.first_frame + 1) + "," +
           over_plain(request) +
           "format=rgb24,palettegen=reserve_transparent=0:max_colors=" + std::to_string(colours)});
  append_words(arguments, "-frames:v 1 -update 1 -f image2 -c:v png");
  arguments.push_back(std::filesystem::absolute(palette).string());
  return arguments;
}

}  // namespace neve::app::output
