/// Includes and shared functions of kernel files, read from the sources and the objects.

#include <gtest/gtest.h>

#include <cstdio>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/structure/sources.h"

namespace neve::test {
namespace {

/// Headers of kernels include neither Eigen nor the standard library, so that no copy of a shared
/// inline function compiled for one instruction set can serve another.
TEST(Structure, KernelsIncludeOnlyEachOther) {
  const std::set<std::string> allowed{"cstdint", "cstddef", "immintrin.h"};
  std::set<std::string> seen;
  std::vector<std::string> open{"sim/kernels/instruction_sets/baseline.cpp",
                                "sim/kernels/instruction_sets/implicit_baseline.cpp",
                                "sim/kernels/instruction_sets/contact_baseline.cpp",
                                "sim/kernels/instruction_sets/laws_baseline.cpp"};
  while (!open.empty()) {
    const std::string file = open.back();
    open.pop_back();
    if (!seen.insert(file).second) continue;
    const std::vector<SourceLine> lines = lines_of(file);
    ASSERT_FALSE(lines.empty()) << file;
    // Kernels define NEVE_LANES_ALONE: a law has its numbers for everybody else in one file with
    // what it does in lanes.
    bool is_left_out = false;
    for (const SourceLine& line : lines) {
      if (line.text == "#ifndef NEVE_LANES_ALONE") is_left_out = true;
      if (line.text == "#endif") is_left_out = false;
      if (is_left_out) continue;
      const std::string name = include_of(line.text).name;
      if (name.empty()) continue;
      if (name.starts_with("sim/"))
        open.push_back(name);
      else
        EXPECT_TRUE(allowed.contains(name)) << file << " includes " << name;
    }
  }
  EXPECT_GT(seen.size(), 8u);
}

/// Functions that a linker would merge with those of another file must name their instruction set.
TEST(Structure, KernelFilesShareNoFunction) {
  std::stringstream objects(NEVE_KERNEL_OBJECTS);
  int files = 0;
  for (std::string object; std::getline(objects, object, ':'); ++files) {
    const std::string set = object.find("avx512") != std::string::npos ? "Avx512Set" : "Avx2Set";
    FILE* symbols = popen(("nm -C --defined-only '" + object + "'").c_str(), "r");
    ASSERT_TRUE(symbols);
    int shared = 0;
    char line[4096];
    while (std::fgets(line, sizeof line, symbols)) {
      const std::string symbol = line;
      // The kind follows the address. Linkers merge the kinds W, V and u.
      const std::size_t kind = symbol.find_first_of("WVu", 16);
      if (kind != 17) continue;
      ++shared;
      EXPECT_NE(symbol.find(set), std::string::npos) << object << ": " << symbol;
    }
    EXPECT_EQ(pclose(symbols), 0) << "nm failed";
    EXPECT_GT(shared, 20) << object;
  }
#if defined(__x86_64__) && \
    !defined(__SANITIZE_ADDRESS__)  // sanitized builds have the baseline only
  // Four a set, and of a build for this machine alone one set.
  EXPECT_TRUE(files == 8 || files == 4) << files;
#endif
}

}  // namespace
}  // namespace neve::test
