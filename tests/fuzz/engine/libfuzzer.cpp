/// The entry of libFuzzer. NEVE_FUZZ_READER names the reader; tests/fuzz/search starts one after
/// the other. With --seeds DIR it writes the corpus into a folder instead, and the words in it as a
/// dictionary into DIR.words.

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <string_view>

#include "tests/fuzz/readers.h"

namespace {

using namespace neve::test::fuzz;

constexpr double longest = 1;  // s, with sanitizers

const Reader* chosen = nullptr;

const Reader* reader_called(std::string_view name) {
  for (const Reader& reader : readers())
    if (name == reader.name) return &reader;
  return nullptr;
}

/// Returns the time of this process, s: other work of the machine takes no time from a reader.
double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

bool is_of_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '.' || c == '-';
}

/// Keys, names and addresses: what is too long to be found by chance.
void add_words(std::string_view text, std::set<std::string>& words) {
  constexpr std::size_t shortest = 3, longest_word = 40;
  while (!text.empty()) {
    const auto begin = std::find_if(text.begin(), text.end(), is_of_word),
               end = std::find_if_not(begin, text.end(), is_of_word);
    const std::string word(begin, end);
    if (word.size() >= shortest && word.size() <= longest_word &&
        std::isalpha(static_cast<unsigned char>(word[0])))
      words.insert(word);
    text.remove_prefix(static_cast<std::size_t>(end - text.begin()));
  }
}

int write_seeds(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  int number = 0;
  std::set<std::string> words;
  for (const Bytes& bytes : corpus_of(*chosen)) {
    std::ofstream(folder / ("seed" + std::to_string(number++)), std::ios::binary) << text_of(bytes);
    add_words(text_of(bytes), words);
  }
  std::ofstream dictionary(folder.string() + ".words");
  for (const std::string& word : words) dictionary << '"' << word << "\"\n";
  return 0;
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  const char* name = std::getenv("NEVE_FUZZ_READER");
  chosen = reader_called(name ? name : "");
  if (!chosen) {
    std::fprintf(stderr, "NEVE_FUZZ_READER names one of:");
    for (const Reader& reader : readers()) std::fprintf(stderr, " %s", reader.name);
    std::fprintf(stderr, "\n");
    std::exit(2);
  }
  if (*argc == 3 && std::string_view((*argv)[1]) == "--seeds") std::exit(write_seeds((*argv)[2]));
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const double begin = processor_seconds();
  chosen->read({data, size});
  const double seconds = processor_seconds() - begin;
  if (seconds > longest) std::fprintf(stderr, "this input takes %.2f s\n", seconds);
  require(seconds <= longest);
  return 0;
}
