#pragma once
/// The standard output of this program is text: what a stranger's file puts into it does nothing to
/// a terminal.

#include <ostream>
#include <streambuf>
#include <string>

namespace neve::app {

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

/// Lets a stream pass its text through a PrintableBuffer, to the end of the program.
void make_printable(std::ostream& out);

}  // namespace neve::app
