/// Calls of the C library that fail on demand and are listed, for programs that are started with
/// this library in LD_PRELOAD:
///
///   NEVE_FAULT  OPERATION:ERRNO:PART[:SKIP[:TIMES]]  the operation (open, write, truncate, fsync,
///               rename, remove, mkdir, close, flock; look, which opens a file or folder for
///               reading, and read) fails with this number on files with this part in their path,
///               after SKIP times, TIMES of them (all). The operation short is a write of a half.
///               Of ERRNO 0 it succeeds 0.3 s late, as on a slow disk
///   NEVE_FAULT_COUNT  FILE  begins with a number of 8 bytes: the calls of the operation by all
///               processes that share it. Without it each process counts for itself
///   NEVE_FAULT_WHILE  FILE  nothing fails but while it exists
///   NEVE_CALLS  FILE  gets a line for each: "fsync /path"
///   NEVE_JOURNAL  FILE  gets all that changes the disk, see tests/support/power_cut.h

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

namespace {

template <class Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

using Counter = std::atomic<std::uint64_t>;

struct Fault {
  std::string operation, part;
  int error = 0;
  std::uint64_t skip = 0, times = ~std::uint64_t{0};
  Counter own{0};
  Counter* count = &own;
  const char* only_while = std::getenv("NEVE_FAULT_WHILE");

  Fault() {
    const char* text = std::getenv("NEVE_FAULT");
    char name[32] = "", where[256] = "";
    if (!text ||
        std::sscanf(text, "%31[^:]:%d:%255[^:]:%lu:%lu", name, &error, where, &skip, &times) < 3)
      return;
    operation = name;
    part = where;
    if (const char* file = std::getenv("NEVE_FAULT_COUNT")) share(file);
  }

 private:
  void share(const char* file) {
    const int fd = next<int(const char*, int, ...)>("open")(file, O_RDWR | O_CLOEXEC);
    if (fd < 0) return;
    void* place = ::mmap(nullptr, sizeof(Counter), PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
    next<int(int)>("close")(fd);
    if (place != MAP_FAILED) count = static_cast<Counter*>(place);
  }
};

Fault& fault() {
  static Fault instance;
  return instance;
}

std::string path_of(int fd) {
  char link[64], path[PATH_MAX];
  std::snprintf(link, sizeof link, "/proc/self/fd/%d", fd);
  const ssize_t size = ::readlink(link, path, sizeof path);
  return size > 0 ? std::string(path, static_cast<std::size_t>(size)) : std::string();
}

void note(const char* operation, const std::string& path) {
  static const char* file = std::getenv("NEVE_CALLS");
  if (!file || path == file) return;
  const int fd =
      next<int(const char*, int, ...)>("open")(file, O_WRONLY | O_CREAT | O_APPEND, 0666);
  const std::string line = std::string(operation) + " " + path + "\n";
  (void)!next<ssize_t(int, const void*, size_t)>("write")(fd, line.data(), line.size());
  next<int(int)>("close")(fd);
}

std::string absolute(const char* path) {
  char here[PATH_MAX];
  if (path[0] == '/' || !::getcwd(here, sizeof here)) return path;
  return std::string(here) + "/" + path;
}

/// Returns the whole path of one that may begin at an open folder.
std::string absolute(int folder, const char* path) {
  return folder == AT_FDCWD || path[0] == '/' ? absolute(path) : path_of(folder) + "/" + path;
}

/// One record at a time, whatever the threads do: "OPERATION BYTES\nPATH\n", and so many bytes.
void journal(const char* operation, const std::string& path, const std::string& bytes = {}) {
  static const char* file = std::getenv("NEVE_JOURNAL");
  if (!file || path == file) return;
  const int fd =
      next<int(const char*, int, ...)>("open")(file, O_WRONLY | O_CREAT | O_APPEND, 0666);
  const std::string record =
      std::string(operation) + " " + std::to_string(bytes.size()) + "\n" + path + "\n" + bytes;
  (void)!next<ssize_t(int, const void*, size_t)>("write")(fd, record.data(), record.size());
  next<int(int)>("close")(fd);
}

/// True where this call fails; errno is set then.
bool fails(const char* operation, const std::string& path) {
  Fault& f = fault();
  if (f.operation != operation || path.find(f.part) == std::string::npos) return false;
  if (f.only_while && ::access(f.only_while, F_OK) != 0) return false;
  const std::uint64_t number = f.count->fetch_add(1);
  if (number < f.skip || number - f.skip >= f.times) return false;
  if (f.error == 0) {
    ::usleep(300'000);
    return false;
  }
  errno = f.error;
  return true;
}

/// The same of an open file, whose path is looked for only if it matters.
bool fails(const char* operation, int fd) {
  return fault().operation == operation && fails(operation, path_of(fd));
}

int open_file(const char* name, const char* path, int flags, unsigned mode) {
  const bool writes = (flags & O_ACCMODE) != O_RDONLY;
  if (fails(writes ? "open" : "look", absolute(path))) return -1;
  const int fd = next<int(const char*, int, ...)>(name)(path, flags, mode);
  if (fd >= 0 && (flags & O_CREAT) != 0) journal("create", absolute(path));
  return fd;
}

/// Streams of C and C++ open their files here.
FILE* open_stream(const char* name, const char* path, const char* mode) {
  const bool writes = std::strpbrk(mode, "wa+") != nullptr;
  if (fails(writes ? "open" : "look", absolute(path))) return nullptr;
  return next<FILE*(const char*, const char*)>(name)(path, mode);
}

}  // namespace

extern "C" {

FILE* fopen(const char* path, const char* mode) {
  return open_stream("fopen", path, mode);
}

FILE* fopen64(const char* path, const char* mode) {
  return open_stream("fopen64", path, mode);
}

ssize_t read(int fd, void* data, size_t size) {
  return fails("read", fd) ? -1 : next<ssize_t(int, void*, size_t)>("read")(fd, data, size);
}

int open(const char* path, int flags, ...) {
  va_list list;
  va_start(list, flags);
  const unsigned mode = va_arg(list, unsigned);
  va_end(list);
  return open_file("open", path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  va_list list;
  va_start(list, flags);
  const unsigned mode = va_arg(list, unsigned);
  va_end(list);
  return open_file("open64", path, flags, mode);
}

/// Folders are opened so, to list what is in them.
int openat(int folder, const char* path, int flags, ...) {
  va_list list;
  va_start(list, flags);
  const unsigned mode = va_arg(list, unsigned);
  va_end(list);
  return fails("look", absolute(folder, path))
             ? -1
             : next<int(int, const char*, int, ...)>("openat")(folder, path, flags, mode);
}

ssize_t write(int fd, const void* data, size_t size) {
  if (fails("write", fd)) return -1;
  if (size > 1 && fails("short", fd)) size /= 2;
  const ssize_t written = next<ssize_t(int, const void*, size_t)>("write")(fd, data, size);
  if (written > 0 && std::getenv("NEVE_JOURNAL"))
    journal("write", path_of(fd),
            std::string(static_cast<const char*>(data), static_cast<std::size_t>(written)));
  return written;
}

/// Long pieces of C++ streams.
ssize_t writev(int fd, const iovec* pieces, int count) {
  return fails("write", fd) ? -1
                            : next<ssize_t(int, const iovec*, int)>("writev")(fd, pieces, count);
}

int ftruncate(int fd, off_t size) {
  return fails("truncate", fd) ? -1 : next<int(int, off_t)>("ftruncate")(fd, size);
}

int fsync(int fd) {
  const std::string path = path_of(fd);
  note("fsync", path);
  const int result = fails("fsync", fd) ? -1 : next<int(int)>("fsync")(fd);
  if (result == 0) journal("fsync", path);
  return result;
}

int rename(const char* from, const char* to) {
  if (fails("rename", absolute(to))) return -1;
  const int result = next<int(const char*, const char*)>("rename")(from, to);
  note("rename", to);
  if (result == 0) journal("rename", absolute(from), absolute(to));
  return result;
}

int unlink(const char* path) {
  if (fails("remove", absolute(path))) return -1;
  const int result = next<int(const char*)>("unlink")(path);
  if (result == 0) journal("remove", absolute(path));
  return result;
}

int remove(const char* path) {
  if (fails("remove", absolute(path))) return -1;
  const int result = next<int(const char*)>("remove")(path);
  if (result == 0) journal("remove", absolute(path));
  return result;
}

/// Whole folders are removed so.
int unlinkat(int folder, const char* path, int flags) {
  return fails("remove", absolute(folder, path))
             ? -1
             : next<int(int, const char*, int)>("unlinkat")(folder, path, flags);
}

int mkdir(const char* path, mode_t mode) {
  if (fails("mkdir", absolute(path))) return -1;
  const int result = next<int(const char*, mode_t)>("mkdir")(path, mode);
  if (result == 0) journal("folder", absolute(path));
  return result;
}

int flock(int fd, int operation) {
  return fails("flock", fd) ? -1 : next<int(int, int)>("flock")(fd, operation);
}

/// The file is closed nevertheless, as Linux does.
int close(int fd) {
  const bool is_failing = fails("close", fd);
  const int error = errno;
  const int result = next<int(int)>("close")(fd);
  if (!is_failing) return result;
  errno = error;
  return -1;
}

}  // extern "C"
