#pragma once
/// The readers of everything that may come from somebody else, each as a function of bytes. A
/// reader reads or refuses: what else it throws, and whatever a sanitizer finds, is a mistake.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace neve::test::fuzz {

using Bytes = std::vector<std::uint8_t>;

struct Reader {
  const char* name;
  void (*read)(std::span<const std::uint8_t> bytes);
  /// Inputs that depend on the program, beside the files of tests/fuzz/corpus/NAME.
  std::vector<Bytes> (*seeds)();
};

const std::vector<Reader>& readers();

/// The files of the corpus, then the seeds, then what earlier searches found (found.tar.xz).
std::vector<Bytes> corpus_of(const Reader& reader);

// Readers of files, in readers_of_files.cpp.
void read_scene(std::span<const std::uint8_t> bytes);
void read_set(std::span<const std::uint8_t> bytes);
std::vector<Bytes> settings();
void read_sweep(std::span<const std::uint8_t> bytes);
void read_mesh(std::span<const std::uint8_t> bytes);
void read_points(std::span<const std::uint8_t> bytes);
void read_heights(std::span<const std::uint8_t> bytes);
void read_script(std::span<const std::uint8_t> bytes);
void read_clicks(std::span<const std::uint8_t> bytes);

// Readers of runs, in readers_of_runs.cpp.
void read_checkpoint(std::span<const std::uint8_t> bytes);
void read_run_json(std::span<const std::uint8_t> bytes);
void read_manifest(std::span<const std::uint8_t> bytes);
std::vector<Bytes> checkpoints();
std::vector<Bytes> run_records();

// Readers of pictures, plates and looks, in readers_of_pictures.cpp.
void read_picture(std::span<const std::uint8_t> bytes);
void read_exr(std::span<const std::uint8_t> bytes);
void read_jpeg(std::span<const std::uint8_t> bytes);
void read_lut(std::span<const std::uint8_t> bytes);
std::vector<Bytes> pictures();
std::vector<Bytes> exr_pictures();
std::vector<Bytes> jpeg_pictures();

// Readers of the web page, in readers_of_web.cpp.
void read_http(std::span<const std::uint8_t> bytes);
void read_web_socket(std::span<const std::uint8_t> bytes);
void read_page_message(std::span<const std::uint8_t> bytes);

inline std::string_view text_of(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}
inline Bytes bytes_of(std::string_view text) {
  return {text.begin(), text.end()};
}

/// Ends the program: a reader has broken a promise.
inline void require(bool is_kept) {
  if (!is_kept) __builtin_trap();
}

}  // namespace neve::test::fuzz
