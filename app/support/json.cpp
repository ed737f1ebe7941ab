#include "app/support/json.h"

#include <cstdio>
#include <unordered_map>
#include <vector>

namespace neve::app {

namespace {

constexpr std::size_t deepest = 64;

/// Builds what the parser reads. A Json object looks its keys up one by one, which makes the parser
/// of the library take the square of their number.
class Builder {
 public:
  using number_integer_t = Json::number_integer_t;
  using number_unsigned_t = Json::number_unsigned_t;
  using number_float_t = Json::number_float_t;
  using string_t = Json::string_t;
  using binary_t = Json::binary_t;

  bool null() { return add(nullptr); }
  bool boolean(bool value) { return add(value); }
  bool number_integer(number_integer_t value) { return add(value); }
  bool number_unsigned(number_unsigned_t value) { return add(value); }
  bool number_float(number_float_t value, const string_t&) { return add(value); }
  bool string(string_t& value) { return add(std::move(value)); }
  bool binary(binary_t&) { return false; }  // not in texts
  bool key(string_t& value) {
    if (dropped_ == 0) open_.back().key = std::move(value);
    return true;
  }
  bool start_object(std::size_t) { return start(Json::object()); }
  bool start_array(std::size_t) { return start(Json::array()); }
  bool end_object() { return end(); }
  bool end_array() { return end(); }
  template <class Error>
  bool parse_error(std::size_t, const std::string&, const Error& error) {
    throw error;
  }

  Json take() { return std::move(root_); }

 private:
  /// An object or an array that is being read, with the places of the keys of the former.
  struct Open {
    Json value;
    std::string key;
    std::unordered_map<std::string, std::size_t> place;
  };

  bool add(Json value) {
    if (dropped_ > 0) return true;
    if (open_.empty()) {
      root_ = std::move(value);
      return true;
    }
    Open& open = open_.back();
    if (open.value.is_array()) {
      open.value.get_ref<Json::array_t&>().push_back(std::move(value));
      return true;
    }
    // The members are used as a list: adding to an object would search it.
    Json::object_t::Container& members = open.value.get_ref<Json::object_t&>();
    const auto [known, is_new] = open.place.emplace(open.key, members.size());
    if (is_new)
      members.emplace_back(open.key, std::move(value));
    else
      members[known->second].second = std::move(value);
    return true;
  }

  bool start(Json value) {
    if (dropped_ > 0 || open_.size() == deepest)
      ++dropped_;
    else
      open_.push_back({std::move(value), {}, {}});
    return true;
  }

  bool end() {
    if (dropped_ > 0) {
      --dropped_;
      return true;
    }
    Json value = std::move(open_.back().value);
    open_.pop_back();
    return add(std::move(value));
  }

  std::vector<Open> open_;   ///< from the root on
  std::size_t dropped_ = 0;  ///< opened below the deepest level
  Json root_;
};

}  // namespace

Json parse_json(std::string_view text) {
  Builder builder;
  Json::sax_parse(text.begin(), text.end(), &builder);
  return builder.take();
}

Json parse_json(std::span<const std::uint8_t> bytes) {
  return parse_json({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

std::string to_text(const Json& json, int indent) {
  const std::string text = json.dump(indent, ' ', false, Json::error_handler_t::replace);
  // Controls that JSON allows and terminals obey.
  std::string plain;
  std::size_t done = 0;
  for (std::size_t k = 0; k < text.size(); ++k) {
    const auto next = k + 1 < text.size() ? static_cast<unsigned char>(text[k + 1]) : 0;
    const bool is_long = text[k] == '\xc2' && next >= 0x80 && next < 0xa0;
    if (!is_long && text[k] != 0x7f) continue;
    char code[8];
    std::snprintf(code, sizeof code, "\\u%04x", is_long ? next : 0x7f);
    plain.append(text, done, k - done).append(code);
    k += is_long;
    done = k + 1;
  }
  return plain.append(text, done);
}

}  // namespace neve::app
