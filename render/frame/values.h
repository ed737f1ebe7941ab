#pragma once
/// The arrays of a frame, as caches can keep them.

#include <cstddef>
#include <cstring>
#include <initializer_list>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

namespace neve::render {

/// An array that its copies share until one of them is edited, so that a cache holds its inputs
/// without a copy of them. Equality is that of bytes: not-a-number equals itself, and 0 is not -0.
template <class T>
class Values {
 public:
  static_assert(std::is_trivially_copyable_v<T>);

  Values() = default;
  Values(std::vector<T> values) : shared_(std::make_shared<std::vector<T>>(std::move(values))) {}
  Values(std::initializer_list<T> values) : Values(std::vector<T>(values)) {}

  operator const std::vector<T>&() const { return all(); }
  bool empty() const { return all().empty(); }
  std::size_t size() const { return all().size(); }
  const T* data() const { return all().data(); }
  const T& operator[](std::size_t k) const { return (*shared_)[k]; }
  const T& at(std::size_t k) const { return all().at(k); }
  const T& front() const { return shared_->front(); }
  const T& back() const { return shared_->back(); }
  auto begin() const { return all().begin(); }
  auto end() const { return all().end(); }

  /// The array to fill or change. Others that share it keep theirs, as long as no other thread
  /// drops its copy meanwhile.
  std::vector<T>& edit() {
    if (!shared_ || shared_.use_count() > 1) shared_ = std::make_shared<std::vector<T>>(all());
    return *shared_;
  }

  friend bool operator==(const Values& a, const Values& b) {
    return a.shared_ == b.shared_ ||
           (a.size() == b.size() &&
            (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0));
  }

 private:
  const std::vector<T>& all() const { return shared_ ? *shared_ : none; }

  inline static const std::vector<T> none;
  std::shared_ptr<std::vector<T>> shared_;
};

}  // namespace neve::render
