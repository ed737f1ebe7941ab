#include "tests/fuzz/readers.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace neve::test::fuzz {

namespace {

namespace fs = std::filesystem;

std::vector<Bytes> no_seeds() {
  return {};
}

Bytes bytes_in(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

/// Returns the contents of all files, in the order of their names.
std::vector<Bytes> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (entry.is_regular_file()) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<Bytes> list;
  for (const fs::path& file : files) list.push_back(bytes_in(file));
  return list;
}

std::vector<Bytes> scenes() {
  std::vector<Bytes> list = files_in(NEVE_SOURCE_DIR "/scenes");
  for (Bytes& bytes : files_in(NEVE_SOURCE_DIR "/tests/corpus/toml"))
    list.push_back(std::move(bytes));
  return list;
}

}  // namespace

const std::vector<Reader>& readers() {
  static const std::vector<Reader> list{{"scene", read_scene, scenes},
                                        {"set", read_set, settings},
                                        {"sweep", read_sweep, no_seeds},
                                        {"mesh", read_mesh, no_seeds},
                                        {"points", read_points, no_seeds},
                                        {"heights", read_heights, no_seeds},
                                        {"script", read_script, no_seeds},
                                        {"checkpoint", read_checkpoint, checkpoints},
                                        {"run_json", read_run_json, run_records},
                                        {"manifest", read_manifest, no_seeds},
                                        {"picture", read_picture, pictures},
                                        {"exr", read_exr, exr_pictures},
                                        {"jpeg", read_jpeg, jpeg_pictures},
                                        {"lut", read_lut, no_seeds},
                                        {"clicks", read_clicks, no_seeds},
                                        {"http", read_http, no_seeds},
                                        {"web_socket", read_web_socket, no_seeds},
                                        {"page_message", read_page_message, no_seeds}};
  return list;
}

std::vector<Bytes> corpus_of(const Reader& reader) {
  std::vector<Bytes> corpus =
      files_in(fs::path(NEVE_SOURCE_DIR "/tests/fuzz/corpus") / reader.name);
  for (Bytes& seed : reader.seeds()) corpus.push_back(std::move(seed));
  for (Bytes& found : files_in(fs::path(NEVE_FUZZ_FOUND) / reader.name))
    corpus.push_back(std::move(found));
  return corpus;
}

}  // namespace neve::test::fuzz
