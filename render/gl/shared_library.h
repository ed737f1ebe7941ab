#pragma once
/// A library opened at run time, so that neve starts where it is missing.

#include <dlfcn.h>

#include <initializer_list>
#include <string>

namespace neve::render::gl {

/// Stays loaded until the process ends: drivers leave threads and handlers behind.
class SharedLibrary {
 public:
  explicit SharedLibrary(std::initializer_list<const char*> names) {
    for (const char* name : names) {
      if (handle_) return;
      handle_ = dlopen(name, RTLD_NOW | RTLD_LOCAL);
      if (!handle_ && error_.empty()) error_ = dlerror();
    }
  }
  explicit operator bool() const { return handle_ != nullptr; }
  const std::string& error() const { return error_; }

  template <class Function>
  Function find(const char* symbol) const {
    return reinterpret_cast<Function>(dlsym(handle_, symbol));
  }

 private:
  void* handle_ = nullptr;
  std::string error_;
};

}  // namespace neve::render::gl
