#include <ostream>
#include <streambuf>

#include "app/support/text.h"

namespace neve::app {

namespace {

/// Controls of two bytes begin with this one.
constexpr char first_of_control = '\xc2';

/// Passes text on as printable_text() writes it.
class PrintableBuffer : public std::streambuf {
 public:
  explicit PrintableBuffer(std::streambuf& out) : out_(out) {}

 protected:
  int_type overflow(int_type c) override;
  std::streamsize xsputn(const char* text, std::streamsize count) override;
  int sync() override;

 private:
  bool put(std::string text);

  std::streambuf& out_;
  std::string begun_;  ///< the first byte of a character whose second one is to come
};

bool PrintableBuffer::put(std::string text) {
  text = begun_ + text;
  begun_.clear();
  if (text.ends_with(first_of_control)) {
    begun_ = first_of_control;
    text.pop_back();
  }
  const std::string printable = printable_text(text);
  const auto size = static_cast<std::streamsize>(printable.size());
  return out_.sputn(printable.data(), size) == size;
}

PrintableBuffer::int_type PrintableBuffer::overflow(int_type c) {
  if (traits_type::eq_int_type(c, traits_type::eof())) return traits_type::not_eof(c);
  return put(std::string(1, traits_type::to_char_type(c))) ? c : traits_type::eof();
}

std::streamsize PrintableBuffer::xsputn(const char* text, std::streamsize count) {
  return put({text, static_cast<std::size_t>(count)}) ? count : 0;
}

int PrintableBuffer::sync() {
  const bool is_written = begun_.empty() || out_.sputc(begun_.front()) != traits_type::eof();
  begun_.clear();
  return is_written && out_.pubsync() == 0 ? 0 : -1;
}

}  // namespace

void make_printable(std::ostream& out) {
  // Never destroyed: streams are used to the last moment.
  out.rdbuf(new PrintableBuffer(*out.rdbuf()));
}

}  // namespace neve::app
