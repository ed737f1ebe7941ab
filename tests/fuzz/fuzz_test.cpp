/// Every reader gets its corpus and some mutations of it, the same ones each time. The search for
/// new ones is libFuzzer's: tests/fuzz/search.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <random>

#include "tests/fuzz/readers.h"

namespace neve::test::fuzz {
namespace {

using Clock = std::chrono::steady_clock;

/// Much more than the longest input takes with sanitizers on a busy machine.
constexpr double longest = 5;  // s
#ifdef __SANITIZE_ADDRESS__
constexpr int mutations = 300;  // each takes up to a tenth of a second
#else
constexpr int mutations = 3000;
#endif

class Mutator {
 public:
  explicit Mutator(const std::vector<Bytes>& corpus) : corpus_(corpus) {}

  Bytes next() {
    Bytes bytes = corpus_[below(corpus_.size())];
    for (std::size_t count = 1 + below(4); count > 0; --count) mutate(bytes);
    return bytes;
  }

 private:
  std::size_t below(std::size_t end) { return end > 0 ? random_() % end : 0; }

  void mutate(Bytes& bytes) {
    const std::size_t at = below(bytes.size() + 1);
    const auto place = bytes.begin() + static_cast<std::ptrdiff_t>(at);
    switch (below(6)) {
      case 0:  // another byte
        if (at < bytes.size()) bytes[at] = static_cast<std::uint8_t>(random_());
        return;
      case 1:  // a word of all ones, zeros or the largest number
        for (std::size_t k = at; k < std::min(at + 8, bytes.size()); ++k)
          bytes[k] = k == at + 7 ? 0x7f : static_cast<std::uint8_t>(random_() % 2 ? 0xff : 0);
        return;
      case 2:  // less
        bytes.erase(place, place + static_cast<std::ptrdiff_t>(below(bytes.size() - at + 1)));
        return;
      case 3: {  // a number, where texts have them
        const std::string_view word = words[below(std::size(words))];
        bytes.insert(place, word.begin(), word.end());
        return;
      }
      case 4: {  // a part again
        const Bytes part(place, place + static_cast<std::ptrdiff_t>(below(
                                            std::min<std::size_t>(bytes.size() - at, 64) + 1)));
        const std::size_t to = below(bytes.size() + 1);
        bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(to), part.begin(), part.end());
        return;
      }
      default: {  // the end of another input
        const Bytes& other = corpus_[below(corpus_.size())];
        const std::size_t from = below(other.size() + 1);
        bytes.resize(at);
        bytes.insert(bytes.end(), other.begin() + static_cast<std::ptrdiff_t>(from), other.end());
      }
    }
  }

  static constexpr std::string_view words[] = {
      "-1",         "1e308", "nan",      "inf",     "99999999999999999999",
      "2147483648", "null",  "[[[[",     "{\"a\":", "\"\"",
      "\n",         "\r\n",  "\xff\xfe", ".....",   "'''",
      "\"\"\""};

  const std::vector<Bytes>& corpus_;
  std::mt19937 random_{1};
};

class Fuzz : public testing::TestWithParam<Reader> {};

TEST_P(Fuzz, AnyBytesAreReadOrRefused) {
  const std::vector<Bytes> corpus = corpus_of(GetParam());
  ASSERT_FALSE(corpus.empty()) << "tests/fuzz/corpus/" << GetParam().name;
  const auto try_out = [&](const Bytes& bytes) {
    const auto start = Clock::now();
    try {
      GetParam().read(bytes);
    } catch (const std::exception& error) {
      ADD_FAILURE() << error.what() << "\n" << text_of(bytes);
    }
    EXPECT_LT(std::chrono::duration<double>(Clock::now() - start).count(), longest)
        << text_of(bytes);
  };
  for (const Bytes& bytes : corpus) try_out(bytes);
  Mutator mutator(corpus);
  for (int k = 0; k < mutations && !HasFailure(); ++k) try_out(mutator.next());
}

INSTANTIATE_TEST_SUITE_P(Readers, Fuzz, testing::ValuesIn(readers()),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace neve::test::fuzz
