#include "app/output/movie_format.h"

#include <algorithm>
#include <array>

namespace neve::app::output {

namespace {

struct FormatInfo {
  MovieFormat format;
  const char *name, *suffix, *encoder;
};

/// The first of a suffix is the format of files that are only named by it.
constexpr std::array formats{FormatInfo{MovieFormat::h264, "h264", ".mp4", "libx264"},
                             FormatInfo{MovieFormat::h265, "h265", ".mp4", "libx265"},
                             FormatInfo{MovieFormat::vp9, "vp9", ".webm", "libvpx-vp9"},
                             FormatInfo{MovieFormat::prores, "prores", ".mov", "prores_ks"},
                             FormatInfo{MovieFormat::gif, "gif", ".gif", "gif"},
                             FormatInfo{MovieFormat::webp, "webp", ".webp", "libwebp_anim"}};

const FormatInfo& info_of(MovieFormat format) {
  return *std::find_if(formats.begin(), formats.end(),
                       [&](const FormatInfo& info) { return info.format == format; });
}

}  // namespace

const char* name(MovieFormat format) {
  return info_of(format).name;
}

const std::vector<MovieFormat>& all_movie_formats() {
  static const std::vector<MovieFormat> all = [] {
    std::vector<MovieFormat> list;
    for (const FormatInfo& info : formats) list.push_back(info.format);
    return list;
  }();
  return all;
}

std::optional<MovieFormat> movie_format_named(const std::string& word) {
  for (const FormatInfo& info : formats)
    if (info.name == word || info.suffix == "." + word) return info.format;
  return std::nullopt;
}

const char* movie_suffix(MovieFormat format) {
  return info_of(format).suffix;
}

const char* movie_encoder(MovieFormat format) {
  return info_of(format).encoder;
}

}  // namespace neve::app::output
