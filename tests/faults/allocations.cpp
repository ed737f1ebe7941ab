/// Allocations above 64 KiB that fail on demand, for programs that are started with this library in
/// LD_PRELOAD:
///
///   NEVE_ALLOCATIONS  SKIP:FILE  FILE begins with a number of 8 bytes, how many there were so far
///   in all processes that share it. The one after SKIP of them fails, once, and FILE.trace says
///   who asked for it. Allocations of the OpenGL driver are not counted and do not fail.

#include <dlfcn.h>
#include <execinfo.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <initializer_list>

// Other names of glibc's own malloc and its relatives.
extern "C" {
void* __libc_malloc(size_t size);
void* __libc_calloc(size_t count, size_t size);
void* __libc_realloc(void* old, size_t size);
void* __libc_memalign(size_t alignment, size_t size);
}

namespace {

constexpr std::size_t large = 64 << 10;
constexpr int deepest = 64;

using Counter = std::atomic<std::uint64_t>;

struct Plan {
  Counter* count = nullptr;  ///< null: nothing fails
  std::uint64_t skip = 0;
  char trace[256] = "";
};

Plan plan;
thread_local bool is_inside = false;

/// Reads the plan before main() begins. Until then nothing fails.
[[gnu::constructor]] void read_plan() {
  const char* text = std::getenv("NEVE_ALLOCATIONS");
  const char* colon = text ? std::strchr(text, ':') : nullptr;
  // Programs that it starts, as ffmpeg, are not meant.
  if (!colon || std::strcmp(program_invocation_short_name, "neve") != 0) return;
  const int fd = ::open(colon + 1, O_RDWR);
  if (fd < 0) return;
  void* place = ::mmap(nullptr, sizeof(Counter), PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
  ::close(fd);
  if (place == MAP_FAILED) return;
  void* frames[1];
  ::backtrace(frames, 1);  // loads what it needs
  plan.skip = std::strtoull(text, nullptr, 10);
  std::snprintf(plan.trace, sizeof plan.trace, "%s.trace", colon + 1);
  plan.count = static_cast<Counter*>(place);
}

bool has_any(const char* text, std::initializer_list<const char*> parts) {
  for (const char* part : parts)
    if (std::strstr(text, part)) return true;
  return false;
}

/// True where the OpenGL driver asked for it, itself or through another library.
bool is_of_driver(void* const* frames, int count) {
  for (int k = 0; k < count; ++k) {
    Dl_info info{};
    if (!::dladdr(frames[k], &info) || !info.dli_fname) continue;
    const char* slash = std::strrchr(info.dli_fname, '/');
    const char* name = slash ? slash + 1 : info.dli_fname;
    if (std::strcmp(name, "neve") == 0) return false;
    if (has_any(name, {"GL", "OSMesa", "LLVM", "gallium", "_dri", "drm", "X11", "xcb", "ld-linux"}))
      return true;
  }
  return false;
}

/// True where this allocation fails; errno is set then.
bool allocation_fails(std::size_t size) {
  if (size <= large || !plan.count || is_inside) return false;
  is_inside = true;
  void* frames[deepest];
  const int depth = ::backtrace(frames, deepest);
  const bool is_meant = !is_of_driver(frames, depth);
  const bool is_due = is_meant && plan.count->fetch_add(1) == plan.skip;
  if (is_due) {
    const int fd = ::open(plan.trace, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    char line[64];
    const int length = std::snprintf(line, sizeof line, "%zu bytes, asked for by\n", size);
    (void)!::write(fd, line, static_cast<std::size_t>(length));
    ::backtrace_symbols_fd(frames, depth, fd);
    ::close(fd);
    errno = ENOMEM;
  }
  is_inside = false;
  return is_due;
}

}  // namespace

extern "C" {

void* malloc(size_t size) {
  return allocation_fails(size) ? nullptr : __libc_malloc(size);
}

void* calloc(size_t count, size_t size) {
  return allocation_fails(count * size) ? nullptr : __libc_calloc(count, size);
}

void* realloc(void* old, size_t size) {
  return allocation_fails(size) ? nullptr : __libc_realloc(old, size);
}

void* aligned_alloc(size_t alignment, size_t size) {
  return allocation_fails(size) ? nullptr : __libc_memalign(alignment, size);
}

void* memalign(size_t alignment, size_t size) {
  return allocation_fails(size) ? nullptr : __libc_memalign(alignment, size);
}

int posix_memalign(void** place, size_t alignment, size_t size) {
  if (allocation_fails(size)) return ENOMEM;
  void* memory = __libc_memalign(alignment, size);
  if (!memory) return ENOMEM;
  *place = memory;
  return 0;
}

}  // extern "C"
